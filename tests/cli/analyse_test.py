"""`gumshoe analyse`: the same samples, other questions; refusals of samples that are not the scenario's.

usage: analyse_test.py path/to/gumshoe [unittest options]
"""
import json
import shutil
import unittest

import h5py
import numpy as np

from program import SCENARIO, InOneFolder, complaint, gumshoe
from sealed import reseal

RUN = "[run]\nsamples = 20_000\n"
STUDIES = "[analysis]\nsensitivity = { given_data = 20_000, morris = 16, dgsm = 64 }\n"


class Analyse(InOneFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.plain = cls.folder / "plain.toml"
        cls.plain.write_text(SCENARIO + RUN)
        cls.result = cls.folder / "plain.h5"
        run = gumshoe("run", cls.plain, "--out", cls.result)
        assert run.returncode == 0, run.stderr

    def scenario(self, text):
        path = self.folder / "other.toml"
        path.write_text(text)
        return path

    def refused(self, words, run):
        self.assertIsNone(complaint(run))
        self.assertIn(words, run.stderr)

    def test_from_another_folder_the_scenario_is_not_found(self):
        run = gumshoe("run", "plain.toml", "--out", "here.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        there = self.folder / "there"
        there.mkdir()
        for command, more in (("replay", ("--sample", 1)), ("analyse", ())):
            with self.subTest(command):
                self.refused("its scenario plain.toml is not there (the result names it as seen from the folder where it was made)",
                             gumshoe(command, "../here.h5", *more, cwd=there))
        run = gumshoe("analyse", "../here.h5", "--scenario", "../plain.toml", "--out", "again.h5", cwd=there)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_an_adaptive_run_keeps_its_record_and_all_studies_are_in_the_json(self):
        scenario = self.scenario(SCENARIO + "[run]\nadaptive = { rule = \"stein\", digits = 1 }\n" + STUDIES)
        result, again = self.folder / "adaptive.h5", self.folder / "adaptive_again.h5"
        run = gumshoe("run", scenario, "--out", result, "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        anew = gumshoe("analyse", result, "--out", again, "--format", "json")
        self.assertEqual(anew.returncode, 0, anew.stderr)
        for before, after in zip(json.loads(run.stdout), json.loads(anew.stdout)):
            self.assertEqual(before["stopping"], after["stopping"])
            self.assertLessEqual({"stopping", "morris", "dgsm", "given_data"}, set(after))
        with h5py.File(result) as a, h5py.File(again) as b:
            self.assertEqual(a["stopping"].attrs["statement"], b["stopping"].attrs["statement"])
            np.testing.assert_array_equal(a["stopping/tolerance"], b["stopping/tolerance"])

    def test_the_same_scenario_gives_the_same_numbers_in_a_new_file(self):
        before = self.result.read_bytes()
        run = gumshoe("analyse", self.result)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(self.result.read_bytes(), before)
        with h5py.File(self.result) as a, h5py.File(self.folder / "plain.analysed.h5") as b:
            self.assertEqual(a.attrs["design_hash"], b.attrs["design_hash"])
            self.assertEqual(len(a.attrs["design_hash"]), 16)
            self.assertEqual(b.attrs["complete"], 1)
            for name in ("laser_z", "bottom_height", "status"):
                self.assertTrue(np.array_equal(a["outputs"][name], b["outputs"][name], equal_nan=name != "status"))
            for name in ("estimate", "standard_uncertainty"):
                self.assertTrue(np.array_equal(a["summary"][name], b["summary"][name]))

    def test_other_questions_and_a_report(self):
        out = self.folder / "studies.h5"
        file = self.scenario(SCENARIO + RUN + STUDIES)
        run = gumshoe("analyse", self.result, "--scenario", file, "--out", out, "--threads", 1)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(gumshoe("report", out).returncode, 0)

    def test_refusals(self):
        wider = self.scenario((SCENARIO + RUN).replace('u = "1 um"', 'u = "2 um"'))
        self.refused("samples have another design", gumshoe("analyse", self.result, "--scenario", wider))
        self.refused("file that is read", gumshoe("analyse", self.result, "--out", self.result))
        empty = self.folder / "empty.h5"
        file = self.scenario(SCENARIO + RUN + "store_samples = false\n")
        self.assertEqual(gumshoe("run", file, "--out", empty).returncode, 0)
        self.refused("holds no samples", gumshoe("analyse", empty))
        half = shutil.copy(self.result, self.folder / "half.h5")
        reseal(half, complete=False)
        self.refused("not finished", gumshoe("analyse", half))
        formula = ('schema = 1\n[model]\nname = "expression"\n[model.measurands]\ny = "a + b"\n[quantities]\n'
                   'a = { value = "1 mm", u = "1 um" }\nb = { value = "2 mm", u = "1 um" }\n')
        moved = self.folder / "moved.h5"
        self.assertEqual(gumshoe("run", self.scenario(formula), "--samples", 1000, "--out", moved).returncode, 0)
        self.scenario(formula.replace("a + b", "a - b"))
        self.refused("another model", gumshoe("analyse", moved))


if __name__ == "__main__":
    unittest.main()
