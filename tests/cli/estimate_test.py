"""gumshoe estimate from outside: what it prints and writes, and how it refuses.

usage: estimate_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import shutil
import subprocess
import tomllib
import unittest

from program import GUMSHOE, ROOT, InFolder, complaint, gumshoe

GAUGE = ROOT / "scenarios" / "gauge"

LINE = """schema = 1
title = "a line"
[model]
name = "expression"
indications = { y = "a + b * x" }
measurands = { at_10 = "a + 10 * b" }
[conditions]
x = 0
[quantities.a]
estimated = true
value = 0
[quantities.b]
estimated = true
value = 1
[indications.y]
readings = { file = "line.csv", column = "y", unit = "1", conditions = { x = { column = "x" } } }
"""
DATA = "x,y\n0,1.1\n1,2.9\n2,5.2\n3,6.8\n4,9.1\n"


class Estimate(InFolder):
    def scenario(self, text=LINE, data=DATA):
        (self.folder / "line.csv").write_text(data)
        file = self.folder / "line.toml"
        file.write_text(text)
        return file

    def fit(self, *words, code=0, **options):
        run = gumshoe("estimate", self.scenario(*words, **options), "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, code, run.stderr)
        return json.loads(run.stdout)

    def refusal(self, *words, **options):
        run = gumshoe("estimate", self.scenario(*words, **options), cwd=self.folder)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertFalse((self.folder / "results/line.estimated.toml").exists())
        return run.stderr

    def test_a_line_by_hand(self):
        # Normal equations: mean x 2, mean y 5.02, Sxx 10, Sxy 19.9; b = 1.99, a = 1.04; RSS = Syy - b Sxy.
        fit = self.fit()
        a, b = fit["parameters"]["a"], fit["parameters"]["b"]
        y = [1.1, 2.9, 5.2, 6.8, 9.1]
        s2 = sum((v - 1.04 - 1.99 * x) ** 2 for x, v in enumerate(y)) / 3
        self.assertAlmostEqual(a["value"], 1.04, 12)
        self.assertAlmostEqual(b["value"], 1.99, 12)
        self.assertAlmostEqual(b["standard_uncertainty"], math.sqrt(s2 / 10), 12)
        self.assertAlmostEqual(a["standard_uncertainty"], math.sqrt(s2 * (1 / 5 + 4 / 10)), 12)
        self.assertAlmostEqual(fit["correlation"][0][1], -2 / math.sqrt(6), 12)
        self.assertEqual((fit["rank"], fit["degrees_of_freedom"], fit["converged"]), (2, 3, True))

    def test_a_predicted_reading_has_the_scatter_about_the_fit(self):
        """u^2 = s^2 (1 + 1/n + (x - 2)^2 / Sxx); of measurands that no reading enters, u stays that of the parameters."""
        fit = self.fit()
        for words, expected in ((("--predict",), [fit["s"] * math.sqrt(1 + 1 / 5 + (x - 2) ** 2 / 10) for x in range(5)]),
                                ((), [fit["s"] * math.sqrt(1 / 5 + 8**2 / 10)] * 5)):
            run = gumshoe("run", self.folder / "results/line.estimated.toml", *words, "--samples", "20000", "--format", "json",
                          "--out", self.folder / "r.h5", "--force")
            self.assertEqual(run.returncode, 0, run.stderr)
            found = [o["gum"]["combined_standard_uncertainty"] for o in json.loads(run.stdout)]
            self.assertEqual(len(found), 5)
            for u, wanted in zip(found, expected):
                self.assertAlmostEqual(u, wanted, 12)

    def written(self):
        with open(self.folder / "results/line.estimated.toml", "rb") as file:
            return tomllib.load(file)

    def test_a_declared_s_of_few_degrees_of_freedom_makes_a_t(self):
        """One s for all readings, known from four: so are all that follow from it."""
        fit = self.fit(LINE + "repeatability = { s = 0.15, degrees_of_freedom = 3 }\n")
        a = self.written()["quantities"]["a"]
        self.assertEqual((a["distribution"], a["degrees_of_freedom"]), ("t", 3))
        self.assertAlmostEqual(a["u"], 0.15 * math.sqrt(1 / 5 + 4 / 10), 12)
        # A quarter of the variance is known exactly: nu / (3/4)^2.
        self.fit(LINE + "repeatability = { s = 0.15, degrees_of_freedom = 3 }\n"
                 f"components = [{{ u = {0.15 / math.sqrt(3)}, per = 'reading' }}]\n")
        self.assertAlmostEqual(self.written()["quantities"]["a"]["degrees_of_freedom"], 3 / 0.75**2, 9)
        self.fit(LINE + "repeatability = { s = 0.15 }\n")
        self.assertNotIn("degrees_of_freedom", self.written()["quantities"]["a"])
        self.assertEqual(fit["notes"], [])

    def test_weights_by_few_repeats_are_chance(self):
        """Over many such fits the estimates scatter by several of their u: that must be said."""
        data = "x,y\n" + "".join(f"{x},{y + d}\n" for x, y in enumerate((1.1, 2.9, 5.2, 6.8, 9.1))
                                 for d in (0.1 * (x + 1), 0, -0.05 * (x + 2)))
        own = self.fit(LINE + 'repeatability = "readings"\n', data=data)
        self.assertTrue(any("of 2 degrees of freedom: such weights are chance" in n for n in own["notes"]), own["notes"])
        pooled = self.fit(LINE + "repeatability = { pooled = true }\n", data=data)
        self.assertFalse(any("such weights are chance" in n for n in pooled["notes"]))
        self.assertEqual(self.written()["quantities"]["a"]["degrees_of_freedom"], 10)

    def test_what_is_said_of_the_data_is_said_of_the_fit(self):
        text = LINE.replace('unit = "1", conditions = { x = { column = "x" } }', 'unit = "um", conditions = { x = { column = "x" } }') \
                   .replace('column = "y"', 'column = "y_mm"').replace("value = 0", 'value = "0 um"').replace("value = 1", 'value = "1 um"')
        fit = self.fit(text, data=DATA.replace("x,y", "x,y_mm"))
        self.assertTrue(any("column 'y_mm' is read in um, but its name states mm" in note for note in fit["notes"]), fit["notes"])

    def test_readings_that_serve_twice_are_told(self):
        """The residual of a reading and its own fit is smaller than both are apart."""
        self.fit(LINE.replace('at_10 = "a + 10 * b"', 'left = "y - a - b * x"'))
        run = gumshoe("run", self.folder / "results/line.estimated.toml", "--samples", "20000", "--out", self.folder / "r.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("and 1 more: the readings and what was estimated are taken as independent", run.stdout)

    def test_the_written_scenario_runs(self):
        self.fit()
        written = self.folder / "results/line.estimated.toml"
        with open(written, "rb") as file:
            document = tomllib.load(file)
        self.assertIn("hash", document["quantities"]["a"]["source"])
        self.assertNotIn("estimated", document["quantities"]["a"])
        run = gumshoe("run", written, "--samples", "200000", "--out", self.folder / "r.h5", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        out = json.loads(run.stdout)[0]
        # u of a + 10 b = s sqrt(1/5 + 64/10), with 3 degrees of freedom: the interval is +-t_0.975(3) u = 3.182446 u. The
        # density of t_3 there is 0.0176: a standard error of sqrt(0.025 0.975 / N) / 0.0176 = 0.02 u. A normal: 1.96 u.
        y = [1.1, 2.9, 5.2, 6.8, 9.1]
        s = math.sqrt(sum((v - 1.04 - 1.99 * x) ** 2 for x, v in enumerate(y)) / 3)
        u = s * math.sqrt(6.6)
        for end, sign in zip(out["symmetric"], (-1, 1)):
            self.assertAlmostEqual((end - 20.94) / u, sign * 3.182446, delta=0.08)
        self.assertAlmostEqual(out["estimate"], 20.94, delta=5 * u * math.sqrt(3 / 200000))

    def test_another_folder_keeps_its_data(self):
        other = self.folder / "other" / "deep"
        other.mkdir(parents=True)
        run = gumshoe("estimate", self.scenario(), "--scenario-out", other / "w.toml")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(gumshoe("check", other / "w.toml").returncode, 0)
        self.assertFalse((self.folder / "results/line.estimated.toml").exists())

    def test_equal_bits_again(self):
        self.assertEqual(self.fit(), self.fit())

    def test_nist(self):
        for file in sorted(GAUGE.glob("strd_*.toml")):
            with self.subTest(file.name):
                run = gumshoe("estimate", file, "--scenario-out", self.folder / "w.toml", "--force", "--format", "json")
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertTrue(json.loads(run.stdout)["converged"])

    def test_a_failure_is_no_answer(self):
        # 1 - exp(-b x) nears data above 1 for ever: no minimum.
        text = LINE.replace("a + b * x", "1 - exp(-b * (x + 1)) + 0 * a").replace("[quantities.a]\nestimated = true", "[quantities.a]")
        file = self.scenario(text, data="x,y\n0,1\n1,1.1\n2,1.2\n")
        run = gumshoe("estimate", file, "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertFalse(json.loads(run.stdout)["converged"])
        self.assertIn("did not converge", run.stderr)
        self.assertFalse((self.folder / "results/line.estimated.toml").exists())

    def test_no_estimated_quantity(self):
        self.assertIn("no quantity is marked estimated", self.refusal(LINE.replace("estimated = true\n", "")))

    def test_fewer_readings_than_unknowns(self):
        self.assertIn("1 readings cannot determine 2", self.refusal(data="x,y\n0,1.1\n"))

    def test_no_simulation_formula(self):
        text = LINE.replace('indications = { y = "a + b * x" }', "").replace('"a + 10 * b"', '"a + 10 * b + y"')
        self.assertIn("cannot simulate", self.refusal(text))

    def test_nan_in_the_data(self):
        said = self.refusal(data="x,y\n0,1.1\n1,nan\n2,5.2\n")
        self.assertIn("line.csv:3:3: error:", said)

    def test_text_in_a_number(self):
        self.assertIn("line.csv:3:3: error:", self.refusal(data="x,y\n0,1.1\n1,abc\n2,5.2\n"))

    def test_missing_column(self):
        self.assertIn("'y'", self.refusal(data="x,z\n0,1.1\n1,2\n2,5.2\n"))

    def test_estimated_that_is_no_truth_value(self):
        self.assertIn("quantities.a.estimated", self.refusal(LINE.replace("true", '"yes"', 1)))

    def test_unknown_loss(self):
        self.assertIn("Did you mean 'huber'", self.refusal(LINE + '[estimate]\nloss = "hubber"\n'))

    def test_one_valued_column(self):
        data = "x,y\n" + "".join(f"{2},{v}\n" for v in (1, 2, 3, 4, 5))
        # Equal conditions are repeats of one reading: one reading for two unknowns.
        self.assertIn("1 readings cannot determine 2", self.refusal(data=data))

    def test_one_valued_column_beside_labels(self):
        text = LINE.replace("conditions = { x", 'labels = { n = "n" }, conditions = { x')
        fit = self.fit(text, data="n,x,y\na,2,1\nb,2,2\nc,2,3\nd,2,4\n", code=2)
        self.assertEqual(fit["rank"], 1)
        self.assertIn("indistinguishable", fit["indistinguishable"][0])
        self.assertIsNone(fit["parameters"]["a"]["standard_uncertainty"])
        self.assertTrue(any("x is 2 in every reading" in note for note in fit["notes"]))
        self.assertIsNone(fit["scenario_out"])

    def test_wrong_unit_shows_in_the_residuals(self):
        noisy = LINE + "repeatability = { s = 0.15 }\n"
        self.assertEqual([n for n in self.fit(noisy)["notes"] if "declared noise" in n], [])
        fit = self.fit(noisy, data=DATA.replace("5.2", "0.0052"))
        self.assertTrue(any("declared noise explains" in n for n in fit["notes"]), fit["notes"])

    def test_readings_without_noise_or_without_one_to_spare(self):
        exact = "x,y\n" + "".join(f"{x},{1 + 2 * x}\n" for x in range(5))
        self.assertTrue(any("lie on the model but for rounding" in n for n in self.fit(data=exact)["notes"]))
        two = gumshoe("estimate", self.scenario(data="x,y\n0,1\n1,3\n"), cwd=self.folder)
        self.assertIn("no degrees of freedom: no reading is left to check the fit", two.stdout)
        self.assertNotIn("nan", two.stdout)

    def test_outliers_are_counted(self):
        rows = [f"{x},{1 + 2 * x + 0.01 * (-1) ** x}" for x in range(20)]
        rows[4], rows[11], rows[15] = "4,12", "11,20", "15,34"
        note, = [n for n in self.fit(LINE + '[estimate]\nloss = "tukey"\n', data="x,y\n" + "\n".join(rows) + "\n")["notes"] if "stands out" in n]
        self.assertIn("; so do 2 more", note)

    def test_what_is_held_stands_in_the_written_scenario(self):
        """Whoever runs it reads the budget, and not the notes of the fit."""
        text = LINE.replace('"a + b * x"', '"a + b * x + o"').replace("[indications.y]", "[quantities.o]\nvalue = 0\nu = 0.5\n[indications.y]")
        self.assertTrue(any(n.startswith("o is held at its estimate") for n in self.fit(text)["notes"]))
        self.assertIn("5 readings, without the uncertainty of o, hash", (self.folder / "results/line.estimated.toml").read_text())

    def test_components_of_means_are_told(self):
        """Four rows of one x are one reading; its mean has the component's noise, not half of it."""
        data = "x,y\n" + "".join(f"{x},{1.04 + 1.99 * x + 0.1 * k:.3f}\n" for x in range(4) for k in range(4))
        said = lambda more: [n for n in self.fit(LINE + more, data=data)["notes"] if "of up to 4 indications here" in n]
        self.assertEqual(len(said('components = [{ u = 0.2, per = "reading" }]\n')), 1)
        self.assertEqual(said("repeatability = { s = 0.2 }\n"), [])

    def test_a_prior_that_the_readings_contradict_is_told(self):
        """Without a declared noise it makes s large, and no chi-squared is left to tell."""
        fine = "x,y\n" + "".join(f"{x},{1.04 + 1.99 * x + 0.001 * (-1) ** x:.4f}\n" for x in range(6))
        contradicted = lambda fit: [n for n in fit["notes"] if "the readings alone give b = 1.98" in n and "one of the two is wrong" in n]
        prior = "[quantities.b]\nestimated = true\nvalue = {}\nu = 0.02\n"
        of_b = LINE[LINE.index("[quantities.b]"):LINE.index("[indications.y]")]
        self.assertEqual(len(contradicted(self.fit(LINE.replace(of_b, prior.format(1)), data=fine))), 1)
        self.assertEqual(contradicted(self.fit(LINE.replace(of_b, prior.format(1.97)), data=fine)), [])
        self.assertEqual(contradicted(self.fit(data=fine)), [])

    def test_a_start_at_which_nothing_depends_on_a_quantity(self):
        """exp(-t / tau) has decayed where tau starts a thousand times too short, and the data know it nevertheless."""
        text = LINE.replace('"a + b * x"', '"a * exp(-x / b)"').replace('measurands = { at_10 = "a + 10 * b" }', 'measurands = { tau = "b" }')
        data = "x,y\n0,5.01\n1,3.58\n2,2.57\n4,1.32\n8,0.345\n"
        near = self.fit(text.replace("value = 1", "value = 3"), data)
        for start in ("0.001", "0.0005"):
            far = self.fit(text.replace("value = 1", f"value = {start}"), data)
            for name in ("a", "b"):
                for key in ("value", "standard_uncertainty"):
                    self.assertAlmostEqual(far["parameters"][name][key] / near["parameters"][name][key], 1, delta=1e-6)
            self.assertTrue(any(f"from {start}, as stated, the indications do not depend on it" in n for n in far["notes"]), far["notes"])
        # What no reading knows stays unknown.
        (self.folder / "results/line.estimated.toml").unlink()
        unknown = self.refusal(text.replace('"a * exp(-x / b)"', '"a * exp(-x / 3) + 0 * b"'), data)
        self.assertIn("b: the data do not determine it", unknown)

    def test_will_not_write_over_its_scenario(self):
        file = self.scenario()
        run = gumshoe("estimate", file, "--scenario-out", file)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertEqual(file.read_text(), LINE)

    def test_a_missing_or_damaged_part_of_the_program_is_said_where_it_is_needed(self):
        program, module = self.folder / "bin/gumshoe", self.folder / "lib/gumshoe/gumshoe_ceres.so"
        for file in (program, module):
            file.parent.mkdir(parents=True)
        shutil.copy(GUMSHOE, program)
        words = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "cwd": self.folder}
        for damage in (None, "no library"):
            if damage:
                module.write_text(damage)
            fit = subprocess.run([program, "estimate", self.scenario()], **words)
            self.assertIsNone(complaint(fit), fit.stderr)
            self.assertIn("the part of this program that fits cannot be opened", fit.stderr)
            self.assertIn("gumshoe_ceres.so", fit.stderr)
        self.assertEqual(subprocess.run([program, "check", self.scenario()], **words).returncode, 0)


if __name__ == "__main__":
    unittest.main()
