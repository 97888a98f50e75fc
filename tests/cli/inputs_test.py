"""No output replaces a file that the same command reads, by whatever name, also with --force.

usage: inputs_test.py path/to/gumshoe [unittest options]
"""
import os
import shutil
import unittest

from program import ROOT, InFolder, complaint, gumshoe

SUM = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "a + b"
[quantities]
a = { value = "1 mm", u = "1 um" }
b = %s
"""
STATED = '{ value = "2 mm", u = "1 um" }'
COMMAND = """schema = 1
[model]
name = "command"
command = ["python3", "model.py"]
[model.measurands]
y = "mm"
[quantities]
a = { value = "1 mm", u = "1 um" }
"""
PROGRAM = """import sys
print("y (mm)", *sys.stdin.read().split()[2:], sep="\\n")
"""


class Inputs(InFolder):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SUM % STATED)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def done(self, *words):
        run = gumshoe(*words, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)

    def kept(self, name, *words):
        """The command is refused because it reads the file, which stays as it is, and so does its folder."""
        before, there = (self.folder / name).read_bytes(), sorted(self.folder.rglob("*"))
        run = gumshoe(*words, "--force", cwd=self.folder)
        self.assertIsNone(complaint(run), (words, run.stderr))
        self.assertIn("this is the file that is read", run.stderr, words)
        self.assertEqual((self.folder / name).read_bytes(), before, words)
        self.assertEqual(sorted(self.folder.rglob("*")), there, words)
        return run.stderr

    def axis(self):
        (self.folder / "data").mkdir()
        for name in ("trace_linear_axis.toml", "plan_axis.toml", "data/linear_axis.csv"):
            shutil.copy(ROOT / "scenarios" / name, self.folder / name)
        return "trace", "trace_linear_axis.toml", "--draws", "19", "--out", "t.h5"

    def test_the_scenario(self):
        self.write("p.csv", "a (mm)\n1\n")
        self.done("run", "s.toml", "--samples", "2000", "--out", "b.h5")
        for k in (1, 2):
            self.done("run", "s.toml", "--samples", "2000", "--shard", f"{k}/2", "--out", f"s{k}.h5")
        for words in (("run", "s.toml", "--samples", "2000"),
                      ("run", "s.toml", "--samples", "2000", "--shard", "1/2"),
                      ("evaluate", "s.toml", "--table", "p.csv"),
                      ("merge", "s1.h5", "s2.h5"),
                      ("analyse", "b.h5", "--scenario", "s.toml"),
                      ("analyse", "b.h5"),
                      ("report", "b.h5")):
            self.kept("s.toml", *words, "--out", "s.toml")

    def test_results_and_tables(self):
        self.write("p.csv", "a (mm)\n1\n")
        self.done("run", "s.toml", "--samples", "2000", "--out", "b.h5")
        for k in (1, 2):
            self.done("run", "s.toml", "--samples", "2000", "--shard", f"{k}/2", "--out", f"s{k}.h5")
        self.write("t.toml", SUM % '{ from = "b.h5:y" }')
        self.done("run", "t.toml", "--samples", "2000", "--out", "c.h5")
        self.write("u.toml", SUM % STATED.replace("1 um", "2 um"))
        self.done("run", "u.toml", "--samples", "2000", "--out", "u.h5")
        self.kept("b.h5", "run", "t.toml", "--out", "b.h5")
        self.kept("b.h5", "analyse", "b.h5", "--out", "b.h5")
        self.kept("b.h5", "report", "b.h5", "--out", "b.h5")
        self.kept("b.h5", "combine", "b.h5", "u.h5", "--out", "b.h5")
        self.kept("s2.h5", "merge", "s1.h5", "s2.h5", "--out", "s2.h5")
        self.kept("p.csv", "evaluate", "s.toml", "--table", "p.csv", "--out", "p.csv")

    def test_measured_data(self):
        trace, data = self.axis(), "data/linear_axis.csv"
        self.kept(data, "plan", "plan_axis.toml", "--out", data)
        self.kept(data, *trace[:-1], data)
        self.kept(data, *trace, "--json", data)
        self.kept(data, *trace, "--report", data)
        self.kept(data, *trace, "--append", data)
        self.kept(data, *trace, "--data", data, "--json", data)
        self.kept(data, "estimate", "trace_linear_axis.toml", "--scenario-out", data)
        self.kept(data, "new", "--from", data, "--out", data)

    def test_measured_data_of_a_table_for_a_control(self):
        self.axis()
        data = "data/linear_axis.csv"
        self.write("c.toml", (self.folder / "trace_linear_axis.toml").read_text() + """
[stated_effects.bend]
indication = "deviation"
formula = "position^2"
unit = "um/m2"
size = { value = "3 um/m2", u = "0.1 um/m2" }
""")
        self.done("compensate", "c.toml", "--out", "table.csv")
        for out in (data, "c.toml"):
            self.kept(out, "compensate", "c.toml", "--out", out)

    def test_the_program_of_a_model(self):
        self.write("m.toml", COMMAND)
        self.write("model.py", PROGRAM)
        self.done("run", "m.toml", "--samples", "100", "--out", "m.h5")
        self.kept("model.py", "run", "m.toml", "--samples", "100", "--out", "model.py")

    def test_links_and_other_names(self):
        (self.folder / "sub").mkdir()
        os.symlink("s.toml", self.folder / "soft.h5")
        os.link(self.folder / "s.toml", self.folder / "hard.h5")
        for out in ("soft.h5", "hard.h5", "sub/../s.toml", self.folder / "s.toml"):
            said = self.kept("s.toml", "run", "s.toml", "--samples", "100", "--out", out)
        self.assertIn("it would be overwritten", said)
        self.assertIn("s.toml, which would be overwritten", self.kept("s.toml", "run", "s.toml", "--out", "hard.h5"))

    def test_an_own_result_is_replaced_and_a_history_extended(self):
        for _ in range(2):
            self.done("run", "s.toml", "--samples", "100", "--out", "o.h5", "--force")
        trace = self.axis()
        self.done(*trace, "--append", "h.h5")
        data = self.folder / "data/linear_axis.csv"
        head, *rows = [line.split(",") for line in data.read_text().splitlines()]
        for row in rows:  # of another campaign
            row[-1] = str(float(row[-1]) + 0.01)
        data.write_text("".join(",".join(row) + "\n" for row in [head, *rows]))
        self.done(*trace, "--append", "h.h5")


if __name__ == "__main__":
    unittest.main()
