"""`gumshoe new` on a terminal asks for what its options leave open.

usage: new_terminal_test.py path/to/gumshoe [unittest options]
"""
import os
import pty
import subprocess
import unittest

from program import GUMSHOE, InFolder, gumshoe


class Asked(InFolder):
    def answer(self, *words, answers):
        """What the program says to a user who types the answers."""
        ours, theirs = pty.openpty()
        with subprocess.Popen([GUMSHOE, "new", *words], stdin=theirs, stdout=theirs, stderr=subprocess.PIPE, cwd=self.folder) as program:
            os.close(theirs)
            os.write(ours, "".join(a + "\n" for a in answers).encode())
            said = b""
            try:
                while block := os.read(ours, 4096):
                    said += block
            except OSError:  # the other end is closed
                pass
            os.close(ours)
            self.assertEqual(program.wait(60), 0, program.stderr.read())
        return said.decode()

    def setUp(self):
        super().setUp()
        rows = ["run,position,error"] + [f"{r},{x},{x % 7 + r}" for r in range(1, 5) for x in range(0, 100, 10)]
        (self.folder / "log.csv").write_text("\n".join(rows) + "\n")

    def test_the_file_and_its_units(self):
        said = self.answer(answers=["", "log.csv", "mm", "um"])
        for question in ("model (", "data file, empty for none:", "unit of the column 'position' (position)", "unit of the column 'error' (reading)"):
            self.assertIn(question, said)
        self.assertIn("log.toml: ready. Next: gumshoe trace log.toml", said)
        text = (self.folder / "log.toml").read_text()
        self.assertIn('"position" = "mm"', text)
        self.assertIn('"error" = "um"', text)
        self.assertEqual(gumshoe("check", "log.toml", cwd=self.folder).returncode, 0)

    def test_an_empty_answer_leaves_a_question_mark(self):
        said = self.answer("--from", "log.csv", "--unit", "position=mm", answers=[""])
        self.assertNotIn("'position' (position)", said)
        self.assertIn("log.toml: to fill in", said)
        self.assertIn('"error" = "?"', (self.folder / "log.toml").read_text())

    def test_a_model(self):
        self.assertIn("rod_gauging.toml: ready", self.answer(answers=["rod_gauging", ""]))


if __name__ == "__main__":
    unittest.main()
