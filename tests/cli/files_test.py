"""Output files: nothing is overwritten without a word, one process writes a file at a time, and what appears is whole.

usage: files_test.py path/to/gumshoe [unittest options]
"""
import fcntl
import os
import resource
import signal
import subprocess
import time
import unittest

import h5py

from program import GUMSHOE, InFolder, complaint, gumshoe
from choose_test import TEXT as CHOOSE
from trace_closing_test import Rods

FORMULA = """schema = 1
title = "{title}"
[model]
name = "expression"
[model.measurands]
y = "a + b"
[quantities]
a = {{ value = "1 mm", u = "1 um" }}
b = {{ value = "2 mm", u = "1 um" }}
"""
SLOW = """schema = 1
[model]
name = "command"
command = ["python3", "slow.py"]
[model.measurands]
y = "mm"
[quantities]
a = { value = "1 mm", u = "1 um" }
"""
# Echoes its input after a while; at the estimates, and in the derivatives, at once.
SLOW_PROGRAM = """import sys, time
rows = sys.stdin.read().split()[2:]
time.sleep(0.3 if len(rows) > 100 else 0)
print("y (mm)", *rows, sep="\\n")
"""
ESTIMATE = """schema = 1
[model]
name = "rod_gauging"
[quantities.rod_length]
value = "150 mm"
estimated = true
[quantities.laser_z]
value = "-480 mm"
[indications.spindle_z]
readings = ["-329.932 mm", "-329.931 mm"]
components = [ { u = "1 um", per = "reading" } ]
"""


class Files(InFolder):
    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return name

    def run_in(self, *words, **options):
        return gumshoe(*words, cwd=self.folder, **options)

    def done(self, *words, **options):
        run = self.run_in(*words, **options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run

    def refused(self, *words, kept=None):
        """The command refuses to overwrite, leaves the file as it is, and replaces it with --force."""
        before = (self.folder / kept).read_bytes()
        run = self.run_in(*words)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn("not overwritten", run.stderr)
        self.assertIn("--force", run.stderr)
        self.assertEqual((self.folder / kept).read_bytes(), before)
        self.done(*words, "--force")
        self.assertNotEqual((self.folder / kept).read_bytes(), before)
        return run.stderr

    def litter(self):
        return [p.name for p in self.folder.rglob("*") if ".gumshoe-" in p.name]

    # nothing is overwritten without a word

    def test_the_result_of_another_scenario(self):
        for name in ("a/s.toml", "b/s.toml"):
            self.write(name, FORMULA.format(title=name))
        self.done("run", "a/s.toml", "--samples", 1000)
        self.done("run", "a/s.toml", "--samples", 2000)  # its own
        said = self.refused("run", "b/s.toml", "--samples", 1000, kept="results/s.h5")
        self.assertIn("the result of another scenario, a/s.toml", said)
        self.write("b/s.toml", FORMULA.format(title="edited"))
        self.done("run", "b/s.toml", "--samples", 1000)  # edited, and still the same scenario
        os.chdir(self.folder / "b")  # by another name, from another folder
        self.addCleanup(os.chdir, "/")
        self.assertEqual(gumshoe("run", "s.toml", "--samples", 1000, "--out", "../results/s.h5").returncode, 0)

    def test_the_same_file_name_and_relative_path_in_another_folder(self):
        out = self.folder / "r.h5"
        for name in ("a", "b"):
            self.write(f"{name}/s.toml", FORMULA.format(title=name))
        self.assertEqual(gumshoe("run", "s.toml", "--samples", 100, "--out", out, cwd=self.folder / "a").returncode, 0)
        run = gumshoe("run", "s.toml", "--samples", 100, "--out", out, cwd=self.folder / "b")
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn("another scenario", run.stderr)

    def test_the_result_of_another_command(self):
        self.write("s.toml", FORMULA.format(title="t"))
        self.done("run", "s.toml", "--samples", 1000)
        self.done("analyse", "results/s.h5")
        self.assertIn("gumshoe analyse", self.refused("run", "s.toml", "--samples", 1000, "--out", "results/s.analysed.h5",
                                                      kept="results/s.analysed.h5"))

    def test_run_and_choose_have_names_of_their_own(self):
        self.write("s.toml", CHOOSE)
        self.done("choose", "s.toml")
        self.assertTrue((self.folder / "results/s.choose.h5").exists())
        self.assertFalse((self.folder / "results/s.h5").exists())

    def test_a_scenario_written_by_hand(self):
        self.write("s.toml", ESTIMATE)
        self.write("results/s.estimated.toml", "schema = 1 # mine\n")
        self.assertIn("was not written by gumshoe estimate", self.refused("estimate", "s.toml", kept="results/s.estimated.toml"))
        self.done("estimate", "s.toml")  # its own
        written = self.folder / "results/s.estimated.toml"
        self.done("check", written)
        written.write_text(written.read_text().replace('"rod_gauging"', '"rod_gauging" # mine'))
        self.assertIn("was edited after", self.refused("estimate", "s.toml", kept="results/s.estimated.toml"))
        self.write("other/s.toml", ESTIMATE.replace("150 mm", "151 mm"))
        self.assertIn("another scenario", self.refused("estimate", "other/s.toml", kept="results/s.estimated.toml"))

    def test_a_table(self):
        self.write("p.csv", "beam_pitch (deg)\n0.1\n")
        self.done("evaluate", "rod_gauging", "--table", "p.csv", "--out", "out.csv")
        self.done("evaluate", "rod_gauging", "--table", "p.csv", "--out", "out.csv")  # the same table
        self.write("p.csv", "beam_pitch (deg)\n0.2\n")
        self.refused("evaluate", "rod_gauging", "--table", "p.csv", "--out", "out.csv", kept="out.csv")

    def test_a_report(self):
        for name in ("a", "b"):
            self.write(f"{name}.toml", FORMULA.format(title=name))
            self.done("run", f"{name}.toml", "--samples", 1000)
        self.write("results/a_summary.csv", "mine\n")
        self.refused("report", "results/a.h5", kept="results/a_summary.csv")
        self.done("report", "results/a.h5")
        self.assertIn("not the report of this scenario",
                      self.refused("report", "results/b.h5", "--out", "results/a.html", kept="results/a.html"))
        self.write("mine.html", "mine")
        self.refused("report", "results/a.h5", "--out", "mine.html", kept="mine.html")

    def test_a_verdict(self):
        rods = Rods()
        rods.write(self.folder, rods.latency(0.5))
        self.write("v.json", '{"mine": 1}')
        self.refused("trace", "s.toml", "--json", "v.json", kept="v.json")
        self.done("trace", "s.toml", "--json", "v.json")
        self.assertEqual(self.done("run", "results/s.traced.toml", "--samples", 1000).stderr, "")
        self.assertTrue((self.folder / "results/s.traced.run.h5").exists())

    def test_something_that_is_no_result(self):
        self.write("s.toml", FORMULA.format(title="t"))
        self.write("there.h5", "a letter to a friend, long enough to be no accident\n")
        self.refused("run", "s.toml", "--samples", 100, "--out", "there.h5", kept="there.h5")

    def test_a_file_in_place_of_the_folder_of_results(self):
        self.write("s.toml", FORMULA.format(title="t"))
        self.write("results", "")
        run = self.run_in("run", "s.toml", "--samples", 100)
        self.assertEqual(run.returncode, 2)
        self.assertIn("the folder 'results' cannot be made (", run.stderr)

    def test_an_unfinished_run_of_other_settings_is_not_dropped_in_silence(self):
        self.slow_run(signal.SIGINT)
        run = self.done("run", "s.toml", "--samples", 100)
        self.assertIn("of an unfinished run with other settings", run.stderr)

    # one process at a time

    def slow_run(self, number=None):
        """A run that takes its time, begun; with a signal once it has samples."""
        self.write("s.toml", SLOW)
        self.write("slow.py", SLOW_PROGRAM)
        run = subprocess.Popen([GUMSHOE, "run", "s.toml", "--samples", "100000", "--threads", "1"], cwd=self.folder,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: (run.kill(), run.communicate()))
        until = time.monotonic() + 30
        while time.monotonic() < until:
            time.sleep(0.02)
            try:
                with h5py.File(self.folder / "results/s.h5", locking=False) as file:
                    if number is None or file["samples_done"][0] > 0:
                        break
            except OSError:
                self.assertIsNone(run.poll(), "it ended too soon")
        if number is not None:
            run.send_signal(number)
            run.communicate(timeout=30)
        return run

    def test_a_file_that_is_being_written(self):
        first = self.slow_run()
        for words in (["run", "s.toml"], ["run", "s.toml", "--force"]):
            second = self.run_in(*words)
            self.assertIsNone(complaint(second), second.stderr)
            self.assertIn("another process is writing this file", second.stderr)
            self.assertIn(str(first.pid), second.stderr)
        first.kill()
        first.communicate()
        self.write("slow.py", SLOW_PROGRAM.replace("0.3", "0"))  # another model: from the start
        self.done("run", "s.toml", "--samples", 5000)  # a dead process holds nothing
        self.assertEqual(self.litter(), [])

    def test_of_two_that_begin_at_once_one_wins(self):
        self.write("a.toml", FORMULA.format(title="a"))
        for attempt in range(10):
            with self.subTest(attempt):
                runs = [subprocess.Popen([GUMSHOE, "run", "a.toml", "--samples", "300000", "--seed", str(seed), "--out", "x.h5"],
                                         cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                        for seed in (1, 2)]
                said = [run.communicate(timeout=60) for run in runs]
                codes = [run.returncode for run in runs]
                self.assertIn(sorted(codes), ([0, 2], [0, 0]), said)
                if codes == [0, 0]:
                    continue  # one after the other
                self.assertIn("another process is writing this file", said[codes.index(2)][1])
                with h5py.File(self.folder / "x.h5") as file:
                    self.assertEqual(file.attrs["seed"], codes.index(0) + 1)
                    self.assertEqual(file.attrs["complete"], 1)
        self.assertEqual(self.litter(), [])

    def test_estimate_and_report_wait_for_nobody(self):
        self.write("s.toml", ESTIMATE)
        self.write("r.toml", FORMULA.format(title="t"))
        self.done("run", "r.toml", "--samples", 1000)
        for words, out in ((["estimate", "s.toml"], "results/s.estimated.toml"), (["report", "results/r.h5"], "results/r.html")):
            with self.subTest(words[0]):
                with open(self.folder / f"{out}.gumshoe-lock", "w") as lock:
                    fcntl.flock(lock, fcntl.LOCK_EX)
                    run = self.run_in(*words)
                    self.assertIsNone(complaint(run), run.stderr)
                    self.assertIn("another process is writing this file", run.stderr)
                self.done(*words)
        self.assertEqual(self.litter(), [])

    # whole or not at all

    def test_what_killed_processes_left_is_removed_by_every_command(self):
        self.write("s.toml", ESTIMATE)
        self.write("results/anything.h5.999999.gumshoe-new", "x" * 1000)
        self.write("results/anything.h5.gumshoe-lock", "process 999999\n")
        with open(self.folder / self.write("results/alive.h5.1.gumshoe-new", "x")) as alive:
            fcntl.flock(alive, fcntl.LOCK_EX)
            self.done("estimate", "s.toml")
            self.assertEqual(self.litter(), ["alive.h5.1.gumshoe-new"])

    def test_links_in_place_of_a_draft_are_not_followed(self):
        self.write("s.toml", ESTIMATE)
        self.write("victim", "mine")
        (self.folder / "results").mkdir()
        (self.folder / "results/s.estimated.toml.gumshoe-lock").symlink_to(self.folder / "victim")
        run = self.run_in("estimate", "s.toml")
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn("cannot create", run.stderr)
        self.assertEqual((self.folder / "victim").read_text(), "mine")

    def test_a_full_disk_leaves_the_pair_as_it_was(self):
        rods = Rods()
        rods.write(self.folder, rods.latency(0.5))
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1500, 1500))  # like a disk with so much left
        for again in (False, True):
            run = self.run_in("trace", "s.toml", "--json", "v.json", preexec_fn=limit)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertIn("File too large", run.stderr)
            self.assertFalse((self.folder / "v.json").exists())
            self.assertEqual([p.name for p in (self.folder / "results").iterdir()], [])
        self.done("trace", "s.toml", "--json", "v.json")
        before = {p: p.read_bytes() for p in (self.folder / "results").iterdir()}
        self.assertEqual(len(before), 2)
        rods.write(self.folder, rods.latency(0.7))
        run = self.run_in("trace", "s.toml", preexec_fn=limit)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertEqual({p: p.read_bytes() for p in (self.folder / "results").iterdir()}, before)

    def test_a_report_on_a_full_disk(self):
        self.write("s.toml", FORMULA.format(title="t"))
        self.done("run", "s.toml", "--samples", 1000)
        run = self.run_in("report", "results/s.h5", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000)))
        self.assertIsNone(complaint(run), run.stderr)
        self.assertEqual([p.name for p in (self.folder / "results").iterdir()], ["s.h5"])


if __name__ == "__main__":
    unittest.main()
