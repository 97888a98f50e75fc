"""What the program prints into Markdown files is up to date.

usage: generated_test.py PROGRAM [unittest options]
"""
import json
import subprocess
import unittest

from program import GUMSHOE, ROOT, gumshoe

README = ROOT / "engine/effects/README.md"


class Generated(unittest.TestCase):
    def test_parts_are_as_the_program_prints_them(self):
        run = subprocess.run([ROOT / "scripts/update-generated", "--check", GUMSHOE], capture_output=True, text=True)
        self.assertEqual((run.stdout, run.stderr, run.returncode), ("", "", 0))

    def test_table_of_effects_has_a_row_for_each(self):
        table = gumshoe("effects", "--format", "markdown").stdout
        self.assertIn(table, README.read_text())
        for effect in json.loads(gumshoe("effects", "--format", "json").stdout):
            row = [line for line in table.splitlines() if line.startswith(f"| `{effect['name']}` |")]
            self.assertEqual(len(row), 1, effect["name"])
            for text in (f"| {effect['stage']} |", f"| {effect['adds']} |", f"| {effect['confused_with']} |",
                         f"`{effect['quantities'][0]['name']}`", f"`{effect['quantities'][-1]['name']}`"):
                self.assertIn(text, row[0])

    def test_table_holds_all_effects_or_none(self):
        run = gumshoe("effects", "z_scale", "--format", "markdown")
        self.assertEqual(run.returncode, 2)
        self.assertIn("markdown", run.stderr)


if __name__ == "__main__":
    unittest.main()
