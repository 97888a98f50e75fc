"""`gumshoe run --predict`: the readings before they are taken.

usage: predict_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import re
import unittest

from program import SCENARIO, InFolder, gumshoe

LINE = """schema = 1
[model]
name = "expression"
[model.indications]
d = "gain * x + offset"
[conditions]
x = "0 mm"
[quantities]
gain = { value = "20 um/m", u = "3 um/m" }
offset = { value = "2 um", u = "0.5 um" }
[[correlations]]
quantities = ["gain", "offset"]
coefficient = -0.5
kind = "pearson"
[indications.d]
components = [ { u = "1 um", per = "reading" }, { u = "0.7 um", per = "cycle" } ]
[indications.d.readings]
file = "r.csv"
column = "d"
unit = "um"
labels = { cycle = "cycle" }
conditions = { x = { column = "x", unit = "mm" } }
"""
ROWS = "cycle,x,d\n1,0,2.5\n1,100,30\n2,300,8.5\n"


class Predict(InFolder):
    def test_a_name_that_the_result_file_has(self):
        """An indication may be called reading; what is predicted may not."""
        (self.folder / "r.csv").write_text(ROWS)
        (self.folder / "s.toml").write_text(LINE.replace('\nd = ', '\nreading = ').replace("[indications.d", "[indications.reading"))
        self.assertEqual(gumshoe("check", "s.toml", cwd=self.folder).returncode, 0)
        run = gumshoe("run", "s.toml", "--predict", "--samples", 1000, "--out", "o.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 2)
        self.assertIn("'reading' cannot be the name of a measurand or of what is predicted (a dataset of the result file has "
                      "this name). Choose another name.", run.stderr)
        self.assertFalse((self.folder / "o.h5").exists())

    def predict(self, file, *words):
        run = gumshoe("run", file, *words, "--out", self.folder / "r.h5", "--force", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def line(self, *words):
        (self.folder / "s.toml").write_text(LINE)
        (self.folder / "r.csv").write_text(ROWS)
        return self.predict(self.folder / "s.toml", *words)

    def test_mean_and_u_of_a_line(self):
        """u^2 = (x u_g)^2 + u_o^2 + 2 r x u_g u_o + noise^2, the draw of a cycle and that of a reading."""
        samples = 200_000
        for o, (x, read, inside) in zip(self.line("--samples", samples), ((0, 2.5, 1), (0.1, 30, 0), (0.3, 8.5, 1)), strict=True):
            u = math.sqrt((3 * x) ** 2 + 0.25 - 3 * x * 0.5 + 1 + 0.49)
            self.assertAlmostEqual(o["gum"]["estimate"], 20 * x + 2, delta=1e-12)
            self.assertAlmostEqual(o["gum"]["combined_standard_uncertainty"], u, delta=1e-12)
            self.assertAlmostEqual(o["estimate"], 20 * x + 2, delta=5 * u / samples ** 0.5)
            self.assertAlmostEqual(o["standard_uncertainty"], u, delta=5 * u / (2 * samples) ** 0.5)
            self.assertAlmostEqual(o["predicted"]["read"], read, delta=1e-12)
            self.assertEqual(bool(o["predicted"]["inside"]), bool(inside))
            self.assertEqual(o["run"]["method"], "prediction")

    def test_a_scenario_without_measurands_predicts_and_says_so(self):
        for o in self.line("--samples", "1e4"):
            self.assertIn("no measurands: the readings are predicted", o["run"]["notes"])
            self.assertFalse(any("those of the model alone" in note for note in o["run"]["notes"]))

    def test_intervals_without_noise_are_those_of_the_model(self):
        (self.folder / "r.csv").write_text(ROWS)
        quiet = "\n".join(line for line in LINE.splitlines() if not line.startswith("components")) + "\n"
        (self.folder / "s.toml").write_text(quiet)
        for o in self.predict(self.folder / "s.toml", "--samples", "1e4"):
            self.assertTrue(any("no noise of a reading is declared: fewer readings lie in them" in note for note in o["run"]["notes"]))

    def test_a_sample_again_and_another_analysis(self):
        outputs = self.line("--samples", "1e4")
        again = gumshoe("replay", self.folder / "r.h5", "--sample", 7)
        self.assertEqual(again.returncode, 0, again.stderr)
        for o in outputs:
            self.assertIn(o["output"], again.stdout)
        analysed = gumshoe("analyse", self.folder / "r.h5", "--format", "json")
        self.assertEqual(analysed.returncode, 0, analysed.stderr)
        for a, b in zip(outputs, json.loads(analysed.stdout), strict=True):
            self.assertEqual((a["output"], a["shortest"], a["predicted"]), (b["output"], b["shortest"], b["predicted"]))

    def test_what_a_model_predicts_its_evaluation_takes_back(self):
        """The laser's height that follows from the reading predicted at the estimates is the height that was put in."""
        (self.folder / "s.toml").write_text(SCENARIO + '[quantities.laser_z]\nvalue = "10 mm"\n')
        predicted, = self.predict(self.folder / "s.toml", "--predict", "--samples", "1e4")
        self.assertEqual((predicted["measurand"], predicted["unit"]), ("spindle_z", "mm"))
        reading = f"{predicted['gum']['estimate']:.15g} mm"
        (self.folder / "s.toml").write_text(re.sub(r'readings = .*', f'readings = ["{reading}"]', SCENARIO))
        evaluated, = (o for o in self.predict(self.folder / "s.toml", "--samples", "1e4") if o["measurand"] == "laser_z")
        self.assertAlmostEqual(evaluated["gum"]["estimate"], 10, delta=1e-9)

    def test_stated_effects_are_part_of_a_reading(self):
        (self.folder / "s.toml").write_text(LINE + '[stated_effects.warm]\nindication = "d"\nformula = "x"\nunit = "um/m"\n'
                                            'size = { value = "10 um/m", u = "4 um/m" }\n')
        (self.folder / "r.csv").write_text(ROWS)
        for o, x in zip(self.predict(self.folder / "s.toml", "--samples", "1e4"), (0, 0.1, 0.3), strict=True):
            self.assertAlmostEqual(o["gum"]["estimate"], 20 * x + 2 + 10 * x, delta=1e-12)
            u = math.sqrt((3 * x) ** 2 + 0.25 - 3 * x * 0.5 + 1 + 0.49 + (4 * x) ** 2)
            self.assertAlmostEqual(o["gum"]["combined_standard_uncertainty"], u, delta=1e-12)
            self.assertAlmostEqual(o["standard_uncertainty"], u, delta=5 * u / 2e4 ** 0.5)

    def test_noise_is_no_further_temperature(self):
        """In degC as in K; the sum of two temperatures is noted all the same."""
        for formula, unit, noted in (("a", "degC", False), ("a + d", "degC", False), ("a + b", "degC", True),
                                     ("a + d", "K", False)):
            (self.folder / "s.toml").write_text(
                f'schema = 1\n[model]\nname = "expression"\n[model.indications]\nT = "{formula}"\n[quantities]\n'
                + "".join(f'{q} = {{ value = "20 {"K" if q == "d" else "degC"}", u = "1 K" }}\n' for q in formula[::4])
                + f'[indications.T]\nreadings = ["300 {unit}"]\ncomponents = [ {{ u = "0.1 {unit}", per = "reading" }} ]\n')
            o, = self.predict(self.folder / "s.toml", "--predict", "--samples", "1e4")
            self.assertEqual([n for n in o["run"]["notes"] if "difference of temperatures" in n] != [], noted, formula)


if __name__ == "__main__":
    unittest.main()
