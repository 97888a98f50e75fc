"""A program that is a model may read files of its own: a run does not go on with others, and `replay` notices them.

usage: changed_model_test.py path/to/gumshoe [unittest options]
"""
import unittest

import h5py

from program import InFolder, complaint, gumshoe

SCENARIO = """schema = 1
[model]
name = "command"
command = ["python3", "model.py"]
batch = 2048
[model.measurands]
y = "mm"
[quantities]
a = { value = "1 mm", u = "0.1 mm" }
[run]
samples = 20_000
"""
# Dies in its fourth block while the file `broken` is there.
PROGRAM = """import os, sys
factor = float(open("factor.txt").read())
rows = sys.stdin.read().split()[2:]
if len(rows) > 100 and os.path.exists("broken"):
    open("broken", "a").write("x")
    if os.path.getsize("broken") > 3: sys.exit("no licence")
print("y (mm)", *(f"{factor * float(row):.9g}" for row in rows), sep="\\n")
"""


class ChangedModel(InFolder):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SCENARIO)
        self.write("model.py", PROGRAM)
        self.write("factor.txt", "2")

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def gumshoe(self, *words):
        return gumshoe(*words, cwd=self.folder)

    def refused(self, run, *words):
        self.assertIsNone(complaint(run), run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)

    def unfinished(self, *words):
        self.write("broken", "")
        run = self.gumshoe("run", "s.toml", "--threads", "1", "--out", "r.h5", *words)
        self.refused(run, "no licence", "samples are kept")
        (self.folder / "broken").unlink()
        with h5py.File(self.folder / "r.h5") as file:
            self.assertGreater(file["samples_done"][0], 0)

    def test_a_run_goes_on_with_the_same_model_alone(self):
        for words in ((), ("--shard", "2/2")):
            with self.subTest(words):
                self.write("factor.txt", "2")
                (self.folder / "r.h5").unlink(missing_ok=True)
                self.unfinished(*words)
                before = (self.folder / "r.h5").read_bytes()
                self.write("factor.txt", "3")
                run = self.gumshoe("run", "s.toml", "--out", "r.h5", *words)
                self.refused(run, "r.h5: the samples there come from another model (y of sample ", " in the file and ",
                             "Restore what the model was then, or remove the file to start again.")
                self.assertEqual((self.folder / "r.h5").read_bytes(), before)
                self.write("factor.txt", "2")
                run = self.gumshoe("run", "s.toml", "--out", "r.h5", *words)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertIn("resuming after", run.stderr)

    def test_replay_compares_with_the_file(self):
        self.assertEqual(self.gumshoe("run", "s.toml", "--out", "r.h5").returncode, 0)
        for sample in (0, 5, 19_999):
            run = self.gumshoe("replay", "r.h5", "--sample", sample)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.write("factor.txt", "2.000001")
        run = self.gumshoe("replay", "r.h5", "--sample", "5")
        self.refused(run, "r.h5: the sample comes from another model (y of sample 5 is ")
        self.assertIn("\nstatus ok\n", run.stdout)  # what it is now is shown

    def test_replay_says_where_there_is_nothing_to_compare_with(self):
        self.write("s.toml", SCENARIO + "store_samples = false\n")
        self.assertEqual(self.gumshoe("run", "s.toml", "--out", "r.h5").returncode, 0)
        run = self.gumshoe("replay", "r.h5", "--sample", "5")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("note: the file does not hold this sample", run.stderr)


if __name__ == "__main__":
    unittest.main()
