"""What the documentation shows is what the program does: outputs in README.md, links, command lines.

usage: readme_test.py path/to/gumshoe [unittest options]
"""
import os
import re
import shlex
import subprocess
import unittest

from program import ROOT, InOneFolder, gumshoe

DOCUMENTS = sorted(p for p in ROOT.rglob("*.md") if not {"build", ".git"} & set(p.relative_to(ROOT).parts))


def blocks(text):
    """(language, content) of every fenced block."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", text, re.S | re.M)


def block(text, after):
    """The first fenced block after a line."""
    return blocks(text.split(after, 1)[1])[0][1]


def command_lines(text):
    """Every `gumshoe ...` line of the fenced blocks, without its comment."""
    lines = "".join(content for _, content in blocks(text)).splitlines()
    return [line.split(" #")[0].strip() for line in lines if re.match(r"(build/release/)?gumshoe \w", line)]


class Readme(InOneFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.text = (ROOT / "README.md").read_text()

    def test_output_of_the_main_job(self):  # scripts/run, with every sample
        shown = block(self.text, "<!-- output: run scenarios/rod_gauging.toml -->")
        lines = re.findall(r"^build/release/gumshoe (.*)$", (ROOT / "scripts/run").read_text(), re.M)
        self.assertEqual([line.split()[0] for line in lines], ["run", "report"])
        (self.folder / "results").mkdir()
        for name in ("scenarios", "reports"):
            os.symlink(ROOT / name, self.folder / name)
        said = "".join(gumshoe(*shlex.split(line), cwd=self.folder).stdout for line in lines)
        self.assertEqual(said.splitlines(), shown.splitlines())
        # The Python lines that read the samples.
        python = block(self.text, "The samples are stored in HDF5")
        run = subprocess.run(["/usr/bin/python3", "-c", python], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        mean, u = map(float, run.stdout.split("\n")[0].split())
        stated = re.search(r"laser_z\[.*?\] = \((\S+) \+- \S+\) mm, .*\n  u = (\S+) um", shown)
        self.assertEqual((f"{mean:.4f}", f"{1000 * u:.1f}"), stated.groups())

    def test_output_of_evaluate(self):
        (self.folder / "points.csv").write_text(block(self.text, "With `points.csv`"))
        run = gumshoe("evaluate", "rod_gauging", "--table", self.folder / "points.csv")
        self.assertEqual(run.stdout, block(self.text, "<!-- output: evaluate rod_gauging -->"))

    def test_commands_are_accepted(self):
        commands = {p: command_lines(p.read_text()) for p in DOCUMENTS}
        self.assertGreater(len(commands[ROOT / "README.md"]), 10)
        listed = re.findall(r"^  (\w+)  +\w", gumshoe("--help").stdout.split("Subcommands:")[1], re.M)
        shown = [shlex.split(line)[1] for line in commands[ROOT / "README.md"]]
        self.assertEqual(sorted(shown), sorted(listed), "README.md shows every command once")
        for path, lines in commands.items():
            for line in lines:
                words = shlex.split(line)[1:]
                with self.subTest(f"{path.relative_to(ROOT)}: {line}"):
                    known = gumshoe(words[0], "--help")
                    self.assertEqual(known.returncode, 0)
                    options = re.findall(r"--[\w-]+", known.stdout)
                    self.assertLessEqual({w.split("=")[0] for w in words if w.startswith("--")}, set(options))
                    for word in words:
                        if word.startswith("scenarios/") and "*" not in word and "plugin/" not in word:  # built first
                            self.assertEqual(gumshoe("check", ROOT / word).returncode, 0)

    def test_links_lead_somewhere(self):
        for path in DOCUMENTS:
            text = re.sub(r"^```.*?^```$", "", path.read_text(), flags=re.S | re.M)
            for target in re.findall(r"\]\(([^)\s]+)\)", text):
                if not re.match(r"https?:|mailto:|#", target):
                    with self.subTest(f"{path.relative_to(ROOT)}: {target}"):
                        self.assertTrue((path.parent / target.split("#")[0]).exists())

    def test_named_files_exist(self):
        """Paths in code marks that begin with a folder of the top level; those of the walks stand in tests/walk."""
        walks = {"engine/effects": ROOT / "tests/walk/effect", "engine/models": ROOT / "tests/walk/model"}
        for path in DOCUMENTS:
            for name in re.findall(r"`((?:engine|scenarios|reports|scripts|tests)/[\w./-]+)`", path.read_text()):
                if "NAME" in name:
                    continue
                places = [ROOT / name] + [walk / name[len(top) + 1:] for top, walk in walks.items() if name.startswith(top)]
                with self.subTest(f"{path.relative_to(ROOT)}: {name}"):
                    self.assertTrue(any(p.exists() for p in places) or list(ROOT.glob(name + ".*")), "no such file")


if __name__ == "__main__":
    unittest.main()
