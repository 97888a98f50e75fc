"""Requests at the edge: a finished result replaced by one that is interrupted, shards mixed up, sizes that nothing holds, names that are no UTF-8, numbers whose squares are none.

usage: odd_requests_test.py path/to/gumshoe [unittest options]
"""
import json
import os
import shutil
import signal
import subprocess
import time
import unittest

from program import GUMSHOE, InFolder, gumshoe

FORMULA = """schema = 1
[model]
name = "expression"
[model.measurands]
{measurand} = "a"
[quantities]
a = {a}
[run]
samples = {samples}
"""


class OddRequests(InFolder):
    def scenario(self, name="s.toml", measurand="y", a="{ value = 1, u = 0.1 }", samples=1000, more=""):
        (self.folder / name).write_text(FORMULA.format(measurand=measurand, a=a, samples=samples) + more)
        return name

    def told(self, *words, code=2):
        run = gumshoe(*words, cwd=self.folder)
        self.assertEqual(run.returncode, code, run.stderr)
        return run.stderr

    def shard(self, part, out):
        return ("run", self.scenario(), "--shard", part, "-o", out)

    def test_an_interrupted_run_loses_no_finished_result(self):
        slow = " + ".join(f"sin({k} * a)" for k in range(1, 201)) # no run of ten million ends before its signal
        (self.folder / "s.toml").write_text(FORMULA.format(measurand="y", a="{ value = 1, u = 0.1 }", samples=2000).replace('"a"', f'"{slow}"'))
        self.told("run", "s.toml", "-o", "a.h5", code=0)
        finished, kept = (self.folder / "a.h5").read_bytes(), self.folder / "a.h5.gumshoe-earlier"
        again = subprocess.Popen([GUMSHOE, "run", "s.toml", "--samples", "1e7", "-o", "a.h5"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(again.kill)
        deadline = time.monotonic() + 60
        while not kept.exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        time.sleep(0.2)
        again.send_signal(signal.SIGINT)
        self.assertIn("; the finished result before it is kept as 'a.h5.gumshoe-earlier'. Repeat the command to resume.", again.communicate()[1])
        self.assertEqual(kept.read_bytes(), finished)
        self.assertIn("(it was interrupted; the finished result before it is kept as 'a.h5.gumshoe-earlier')", self.told("report", "a.h5"))
        self.told("run", "s.toml", "-o", "a.h5", code=0)
        self.assertFalse(kept.exists())
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["a.h5", "s.toml"])

    def test_one_shard_does_not_replace_another(self):
        self.told(*self.shard("2/2", "a.h5"), code=0)
        self.assertIn("'a.h5': not overwritten (it holds shard 2/2, and not 1/2)", self.told(*self.shard("1/2", "a.h5")))
        self.told(*self.shard("1/2", "a.h5"), "--force", code=0)

    def test_a_damaged_file_does_no_harm_where_all_shards_are_there(self):
        for k in (1, 2):
            self.told(*self.shard(f"{k}/2", f"{k}.h5"), code=0)
        (self.folder / "cut.h5").write_bytes((self.folder / "1.h5").read_bytes()[:9000])
        said = self.told("merge", "1.h5", "2.h5", "cut.h5", "-o", "m.h5", code=0)
        self.assertRegex(said, r"'cut.h5' is not a Gumshoe result .*: it is left out, as all shards are there without it")
        os.remove(self.folder / "1.h5")
        self.assertIn("Remove it, and make the shard again", self.told("merge", "2.h5", "cut.h5", "-o", "n.h5"))

    def test_shards_are_merged_from_another_folder(self):
        for k in (1, 2):
            self.told(*self.shard(f"{k}/2", f"{k}.h5"), code=0)
        (self.folder / "other").mkdir()
        merge = ("merge", "../1.h5", "../2.h5", "-o", "m.h5")
        run = gumshoe(*merge, cwd=self.folder / "other")
        self.assertIn("../1.h5: its scenario s.toml is not there", run.stderr)
        self.assertIn("or name it with --scenario", run.stderr)
        self.assertEqual(gumshoe(*merge, "--scenario", "../s.toml", cwd=self.folder / "other").returncode, 0)

    def test_sizes_that_nothing_holds(self):
        study = "[analysis]\nsensitivity = {{ {} = 1e12 }}\n"
        for name in ("sobol", "shapley", "morris", "dgsm"):
            self.assertIn(f"{name}: 1000000000000 must lie between 0 and 1073741824",
                          self.told("check", self.scenario(more=study.format(name))))
        self.assertIn("run.samples: 1e+18 must lie between 2 and", self.told("check", self.scenario(samples="1e18")))
        self.assertIn("--draws: '1e12' is not a whole number of at least 19 and at most 1000000",
                      self.told("trace", self.scenario(), "--draws", "1e12"))
        many = "\n".join(f"y{k} = 'a'" for k in range(5000))
        (self.folder / "many.toml").write_text(f"schema = 1\n[model]\nname = 'expression'\n[model.measurands]\n{many}\n[quantities]\na = 1\n")
        self.assertIn("5000 measurands are too many (a result file holds at most 4000)", self.told("check", "many.toml"))

    def test_a_name_with_a_dot_is_none(self):
        self.assertIn("model.measurands.y.z: 'y.z' cannot be the name of a formula", self.told("check", self.scenario(measurand='"y.z"')))

    def test_numbers_without_a_square(self):
        """What varies is never the same in every sample; numbers of which there is no square are refused."""
        self.assertIn("the distribution reaches -1e+160 (must be at least -1e+150)",
                      self.told("check", self.scenario(a='{ distribution = "rectangular", low = -1e160, high = 1e160 }')))
        self.scenario(measurand="y", a='{ distribution = "rectangular", low = 0, high = 1e100 }')
        text = (self.folder / "s.toml").read_text().replace('y = "a"', 'y = "a^2"')
        (self.folder / "s.toml").write_text(text)
        run = gumshoe("run", "s.toml", cwd=self.folder)
        self.assertIn("the values are too large for it in double precision", run.stdout)
        self.assertNotIn("the same in every sample", run.stdout)

    def test_tables_of_points_that_say_too_little(self):
        for text, said in (("rod_length,beam_yaw (deg)\n100,0\n", "p.csv:1:1: error: the column 'rod_length' states no unit. Write it behind the name: rod_length (mm)."),
                           ("colour\n1\n", "p.csv:1:1: error: unknown column 'colour'. Use one of rod_radius, fillet_radius, "),
                           ("rod_length (mm)\nnan\n", "p.csv:2:1: error: rod_length: 'nan' is not a number")):
            (self.folder / "p.csv").write_text(text)
            self.assertIn(said, self.told("evaluate", "rod_gauging", "--table", "p.csv"))
        self.assertIn("unknown evaluation 'better'. Use one of full, conventional.",
                      self.told("evaluate", "rod_gauging", "--table", "p.csv", "--evaluation", "better"))
        self.assertIn("unknown model 'nothing'. See what gumshoe models lists.", self.told("evaluate", "nothing", "--table", "p.csv"))
        self.assertIn("'mX' is not a unit. Write one such as mm", self.told("check", self.scenario(a='{ value = "1 mX", u = 1 }')))
        os.symlink("loop", self.folder / "loop")
        self.assertIn("error: 'loop': Too many levels of symbolic links", self.told("report", "loop"))

    def test_names_that_are_no_utf8(self):
        folder = os.fsencode(self.folder) + b"/b\xff"
        os.mkdir(folder)
        shutil.copy(self.folder / self.scenario(), os.fsdecode(folder))
        run = gumshoe("run", os.fsdecode(folder + b"/s.toml"), "--format", "json", "-o", os.fsdecode(folder + b"/s.h5"), cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(json.loads(run.stdout)[0]["output"], "y")

    def test_pages_of_odd_results(self):
        """Three equal samples; an environment that leads Python astray."""
        for a, samples in (("{ value = 1, u = 1e-20 }", 3), ('{ distribution = "rectangular", low = 0, high = 1e149 }', 1000)):
            self.told("run", self.scenario(a=a, samples=samples), "-o", "odd.h5", "--force", code=0)
            for astray in ({}, {"PYTHONSAFEPATH": "1", "MPLBACKEND": "none", "PYTHONHOME": "/nowhere"}):
                run = gumshoe("report", "odd.h5", "--force", cwd=self.folder, env={**os.environ, **astray})
                self.assertEqual((run.returncode, run.stderr), (0, ""), (a, astray))


if __name__ == "__main__":
    unittest.main()
