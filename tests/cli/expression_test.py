"""Models stated as formulas, from outside: run, published numbers, and what is said of bad formulas.

usage: expression_test.py path of gumshoe [unittest options]
"""
import json
import os
import unittest

from program import InFolder, complaint, gumshoe, places

# GUM H.2 as JCGM 102 evaluates it: resistance, reactance and impedance from V, I and phi.
H2 = """schema = 1
[model]
name = "expression"
[model.intermediates]
ratio = "V / I"
[model.measurands]
R = "ratio * cos(phi)"
X = { formula = "ratio * sin(phi)", unit = "ohm" }
Z = "ratio"
[quantities.V]
value = "4.9990 V"
u = "3.20936 mV"
[quantities.I]
value = "19.6610 mA"
u = "0.00947101 mA"
[quantities.phi]
value = "1.04446 rad"
u = "0.000752064 rad"
[[correlations]]
quantities = ["V", "I", "phi"]
kind = "pearson"
matrix = [[1, -0.355311, 0.857624], [-0.355311, 1, -0.645111], [0.857624, -0.645111, 1]]
[run]
samples = 200_000
seed = 1
"""


class Expression(InFolder):
    def scenario(self, text, name="s.toml"):
        file = self.folder / name
        file.write_text(text)
        return file

    def refused(self, text, line, column, *words):
        file = self.scenario(text)
        run = gumshoe("check", file)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn((line, column), places(run, file), run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)

    def test_resistance_of_the_gum(self):
        file = self.scenario(H2)
        run = gumshoe("run", file, "--out", self.folder / "r.h5", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        # GUM table H.4: 127.732(71), 219.847(295), 254.260(236); the estimate's standard error is u/sqrt(M).
        summary = {s["output"]: s for s in json.loads(run.stdout)}
        for name, y, u in (("R", 127.732170, 0.0710714), ("X", 219.846512, 0.295582), ("Z", 254.259702, 0.236336)):
            self.assertEqual(summary[name]["unit"], "ohm")
            self.assertAlmostEqual(summary[name]["estimate"], y, delta=5 * u / 200_000**0.5 + 1e-3)
            self.assertAlmostEqual(summary[name]["standard_uncertainty"] / u, 1, delta=5 / (2 * 200_000) ** 0.5)

    def test_gauge_block_of_jcgm_101(self):
        text = """schema = 1
[model]
name = "expression"
[model.measurands]
dL = { formula = "LS + D + d1 + d2 - LS * (da * (th0 + Delta) + aS * dt) - nominal", unit = "nm" }
[quantities]
nominal = "50 mm"
LS = { value = "50.000623 mm", distribution = "t", u = "25 nm", degrees_of_freedom = 18 }
D = { value = "215 nm", distribution = "t", u = "6 nm", degrees_of_freedom = 24 }
d1 = { value = "0 nm", distribution = "t", u = "4 nm", degrees_of_freedom = 5 }
d2 = { value = "0 nm", distribution = "t", u = "7 nm", degrees_of_freedom = 8 }
aS = { distribution = "rectangular", low = "9.5 um/m/K", high = "13.5 um/m/K" }
th0 = { value = "-0.1 K", u = "0.2 K" }
Delta = { distribution = "arcsine", low = "-0.5 K", high = "0.5 K" }
da = { distribution = "curvilinear_trapezoid", low = "-1 um/m/K", high = "1 um/m/K", inexactness = "0.1 um/m/K" }
dt = { distribution = "curvilinear_trapezoid", low = "-0.05 K", high = "0.05 K", inexactness = "0.025 K" }
[run]
samples = 1_000_000
[analysis]
coverage_probability = 0.99
"""
        run = gumshoe("run", self.scenario(text), "--out", self.folder / "g.h5", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        # JCGM 101 9.5, to digits that it does not print: 838.00, 35.806, [744.39, 931.70]. Standard errors at 1e6:
        # u/1000 of the mean, 0.03 of u, 0.2 of the ends (sqrt(0.005 * 0.995 / M) over the density there, 3.6e-4 / nm).
        d = json.loads(run.stdout)[0]
        self.assertAlmostEqual(d["estimate"], 838.00, delta=5 * 0.036)
        self.assertAlmostEqual(d["standard_uncertainty"], 35.806, delta=5 * 0.03)
        self.assertAlmostEqual(d["symmetric"][0], 744.39, delta=5 * 0.2)
        self.assertAlmostEqual(d["symmetric"][1], 931.70, delta=5 * 0.2)

    def test_threads_and_instruction_sets_give_the_same_bits(self):
        file = self.scenario(H2)
        outputs = set()
        for threads, isa in ((1, "sse2"), (2, "sse2"), (2, "avx2"), (1, "avx512")):  # a wish: what is there is taken
            run = gumshoe("run", file, "--out", self.folder / f"{threads}{isa}.h5", "--threads", threads, "--format", "csv",
                          env={**os.environ, "GUMSHOE_ISA": isa})
            self.assertEqual(run.returncode, 0, run.stderr)
            outputs.add("\n".join(line for line in run.stdout.splitlines() if ".h5" not in line))
        self.assertEqual(len(outputs), 1)

    def test_explain_prints_the_formulas(self):
        run = gumshoe("check", "--explain", self.scenario(H2))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("R = ratio * cos(phi)", run.stdout)
        self.assertIn("ratio = V / I", run.stdout)

    def test_a_measurand_with_the_name_of_a_quantity(self):
        """Other formulas mean the quantity by it; only the quantity itself may be a measurand of its name."""
        text = H2.replace("Z = \"ratio\"", "V = \"2 * V\"")
        self.refused(text, 9, 6, "'V' is a quantity, too", "means the quantity", "Rename one of them")
        run = gumshoe("check", self.scenario(H2.replace("Z = \"ratio\"", "V = \"V\"")))
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_unknown_name(self):
        self.refused(H2.replace("ratio * cos(phi)", "ratio * cos(phy)"), 7, 18, "'phy'", "Did you mean 'phi'?")

    def test_division_by_zero_at_the_estimates(self):
        self.refused(H2.replace("19.6610 mA", "0 mA"), 5, 12, "division by zero at the estimates", "I = 0 mA")

    def test_logarithm_of_a_negative_number(self):
        self.refused(H2.replace('"V / I"', '"V / I * log(-I / I)"'), 5, 18,
                     "the logarithm of a negative number")

    def test_length_plus_angle(self):
        self.refused(H2.replace('Z = "ratio"', 'Z = "V + phi"'), 9, 8, "a voltage plus an angle")

    def test_a_value_that_is_no_number_is_told_and_no_formula(self):
        """Without a unit the formula would add a length to a plain number."""
        text = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "a + b"
[quantities]
a = { value = "1 mm", u = "1 um" }
b = "20,0 mm"
"""
        self.refused(text, 8, 5, "quantities.b: '20,0 mm'")
        self.refused(text.replace('"20,0 mm"', '{ u = "1 um", value = "20,0 mm" }'), 8, 27, "quantities.b.value: '20,0 mm'")
        self.refused(text.replace("[quantities]", "[conditions]\nc = \"3,0 mm\"\n[quantities]").replace("a + b", "a + c"),
                     7, 5, "conditions.c: '3,0 mm'")

    def test_circle(self):
        self.refused(H2.replace('"V / I"', '"V / I * R / R"'), 7, 6, "'ratio' depends on itself", "R -> ratio")

    def test_failed_samples_are_counted(self):
        text = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "sqrt(a)"
[quantities]
a = { value = 1, u = 0.6 }
[run]
samples = 20000
max_failed_share = 0.2
"""
        run = gumshoe("run", self.scenario(text), "--out", self.folder / "f.h5")
        self.assertIn("not_finite", run.stdout + run.stderr)

    def test_values_beyond_double_precision_are_no_constant(self):
        """Above 709.8 the exponential overflows, and those samples fail; the mean of the others is no number either."""
        text = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "%s"
[quantities]
x = { value = %s, u = %s }
[run]
samples = 10_000
max_failed_share = 0.5
"""
        for y, value, u, failed, why in (
                ("exp(1000 * x)", 0.7, 0.01, True, "the framework's uncertainty is not finite"),
                ("x * 1e200 * 1e150", 1e-60, 1e-43, False, "the contribution of x is not finite")):
            with self.subTest(y):
                run = gumshoe("run", self.scenario(text % (y, value, u)), "--out", self.folder / "f.h5", "--force")
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertNotIn("the same in every sample", run.stdout)
                self.assertIn("without a standard uncertainty (the values are too large for it in double precision", run.stdout)
                self.assertIn(f"not applicable ({why}): y", run.stdout)
                self.assertNotIn("none to first order", run.stdout)
                self.assertNotIn("U = inf", run.stdout)
                self.assertLess(max(map(len, run.stdout.split())), 40)  # no numbers of 300 digits
                self.assertEqual("failed: not_finite: 1794 samples" in run.stdout, failed)

    def test_a_constant_is_told_once(self):
        """Beside a measurand that varies and alone: no digits of a u that is zero, no sections without contents."""
        text = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "2 * a"
[quantities]
a = "1.5 mm"
b = { value = "1 mm", u = "1 um" }
[run]
samples = 1000
"""
        for more in ("", 'z = "a + b"\n'):
            out = self.folder / "c.h5"
            run = gumshoe("run", self.scenario(text.replace("[quantities]", more + "[quantities]")), "--out", out, "--force")
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn("y = 3 mm, the same in every sample.\n", run.stdout)
            self.assertEqual(gumshoe("report", out).returncode, 0)
            page = out.with_suffix(".html").read_text(encoding="utf-8")
            self.assertEqual(page.count("Uncertainty budget</h3>"), bool(more))
            self.assertEqual(page.count("Distribution</h3>"), bool(more))
            self.assertNotIn("0.000000", page)

    def test_unused_quantity_is_a_note(self):
        run = gumshoe("check", self.scenario(H2.replace("[quantities.V]", "[quantities.idle]\nvalue = 1\n[quantities.V]")))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("note: quantities.idle: no formula uses this quantity", run.stdout)

    def test_virtual_experiment_sees_what_the_evaluation_leaves_out(self):
        text = """schema = 1
[model]
name = "expression"
method = "virtual_experiment"
[model.indications]
spindle_z = "laser_z + L + scale * L"
[model.measurands]
laser_z = "spindle_z - L"
[quantities]
laser_z = { value = "-500 mm", u = "1 mm" }
L = { value = "180 mm", u = "1 um" }
scale = { value = "0 um/m", u = "10 um/m" }
[run]
samples = 100_000
"""
        run = gumshoe("run", self.scenario(text), "--out", self.folder / "v.h5", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        # Error = (L - L_est) + scale L, the height itself cancels: u = sqrt(1 + 1.8^2) um; sampling error u/sqrt(2 M).
        u = json.loads(run.stdout)[0]["standard_uncertainty"]
        self.assertAlmostEqual(u / (1 + 1.8**2) ** 0.5 * 1e3, 1, delta=5 / (2 * 100_000) ** 0.5)

    def test_where_nothing_is_measured_the_readings_are_predicted(self):
        text = """schema = 1
[model]
name = "expression"
[model.indications]
y = "a * x"
[quantities]
a = 2
[conditions]
x = 1
[indications.y]
readings = [2.1]
"""
        file = self.scenario(text)
        self.assertEqual(gumshoe("check", file).returncode, 0)
        run = gumshoe("run", file, "--samples", 1000, "--format", "json", "--out", self.folder / "n.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        predicted, = json.loads(run.stdout)
        self.assertEqual((predicted["estimate"], predicted["standard_uncertainty"], predicted["predicted"]["read"]), (2, 0, 2.1))

    # a model without indications

    CONDITION = """schema = 1
[model]
name = "expression"
[model.measurands]
y = { formula = "a + c", unit = "mm" }
[quantities]
a = { value = "1 mm", u = "1 um" }
[conditions]
c = %s
"""

    def outputs(self, text, *more):
        run = gumshoe("run", self.scenario(text), "--samples", 20000, "--out", self.folder / "r.h5", "--force", "--format", "json", *more)
        self.assertEqual(run.returncode, 0, run.stderr)
        return {s["output"]: s for s in json.loads(run.stdout)}

    def test_conditions_count_without_indications(self):
        one = self.outputs(self.CONDITION % '"5 mm"')
        self.assertAlmostEqual(one["y"]["estimate"], 6, delta=5e-3 / 20000**0.5)
        two = self.outputs(self.CONDITION % '["5 mm", "10 mm"]')
        self.assertEqual(len(two), 2)
        for (name, row), y in zip(two.items(), (6, 11)):
            self.assertIn(f"{y - 1} mm", name)
            self.assertAlmostEqual(row["estimate"], y, delta=5e-3 / 20000**0.5)

    def test_points_of_a_table_without_indications(self):
        table = self.folder / "p.csv"
        table.write_text("a (mm),c (mm)\n2,3\n4,5\n")
        run = gumshoe("evaluate", self.scenario(self.CONDITION % '"5 mm"'), "--table", table)
        self.assertEqual(run.returncode, 0, run.stderr)
        lines = run.stdout.splitlines()
        self.assertEqual(lines[0], "a (mm),c (mm),y (mm),status")
        self.assertEqual([float(line.split(",")[2]) for line in lines[1:]], [5, 9])

    # what is said

    SUM = """schema = 1
[model]
name = "expression"
[model.measurands]
y = { formula = "%s", unit = "%s" }
[quantities]
%s
"""

    def said(self, *parts, more=""):
        run = gumshoe("run", self.scenario(self.SUM % parts + more), "--samples", 20000, "--budget", "--out", self.folder / "r.h5", "--force")
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def test_a_limit_that_chance_decides_is_told(self):
        limit = '[[analysis.conformity]]\nmeasurand = "y"\nupper = "%s mm"\nrule = "simple_acceptance"\n'
        length = ("a", "mm", 'a = { value = "10.008 mm", u = "2 um" }')
        self.assertIn("by chance", self.said(*length, more=limit % "10.008"))
        self.assertNotIn("by chance", self.said(*length, more=limit % "10.009"))  # 71 standard errors away

    def test_inputs_that_cancel_or_do_not_count_are_uncertain(self):
        text = self.said("a * b", "1", "a = { value = 0, u = 1 }\nb = { value = 0, u = 1 }")
        self.assertNotIn("no input is uncertain", text)
        self.assertIn("every sensitivity coefficient is zero", text)
        text = self.said("a + b", "1", "a = { value = 0, u = 1 }\nb = { value = 0, u = 1 }",
                         more='[[correlations]]\nquantities = ["a", "b"]\nkind = "pearson"\nmatrix = [[1, -1], [-1, 1]]\n')
        self.assertNotIn("no input is uncertain", text)

    def test_a_page_speaks_of_correlations_where_there_are_some(self):
        """Shapley effects asked for of independent inputs are no sign of any."""
        inputs = ("a + 2 * b", "1", "a = { value = 1, u = 0.1 }\nb = { value = 2, u = 0.2 }")
        shapley = "[analysis]\nsensitivity = { shapley = 1000 }\n"
        tied = '[[correlations]]\nquantities = ["a", "b"]\nkind = "pearson"\nmatrix = [[1, 0.5], [0.5, 1]]\n'
        for more, correlated in ((shapley, False), (tied + shapley, True)):
            self.said(*inputs, more=more)
            report = gumshoe("report", self.folder / "r.h5", "--out", self.folder / "r.html", "--force")
            self.assertEqual(report.returncode, 0, report.stderr)
            page = (self.folder / "r.html").read_text()
            self.assertEqual("The inputs depend on each other" in page, correlated)
            self.assertEqual(">correlations</th>" in page, correlated)

    def test_units_of_coefficients_are_units(self):
        text = self.said("l * alpha * t", "um", 'l = { value = "1 m", u = "1 mm" }\nalpha = { value = "10 um/m/K", u = "1 um/m/K" }\n'
                         't = { value = "1 K", u = "0.1 K" }')
        self.assertIn("um/(um/m/K)", text)
        self.assertNotIn("um/um/m/K", text)

    def test_estimates_have_the_digits_that_u_leaves(self):
        text = self.said("f", "Hz", 'f = { value = "9999999.98765 Hz", u = "0.3 mHz" }')
        self.assertRegex(text, r"f +9999999\.98765 Hz")

    def test_a_share_of_a_ratio_is_told(self):
        text = self.said("l * (1 + k)", "mm", 'l = { value = "100 mm", u = "1 um" }\nk = { value = "100 ppm", u = "10 %" }')
        self.assertIn("'10 %' is taken as 100000 ppm, and not as a share of '100 ppm'", text)

    def test_a_result_that_is_not_there_is_told_and_no_dimension(self):
        text = self.SUM % ("a + b", "ohm", 'a = { from = "missing.h5:R" }\nb = { value = "1 ohm", u = "1 mohm" }')
        file = self.scenario(text)
        run = gumshoe("check", file)
        self.assertEqual([line for line, _ in places(run, file)], [7], run.stderr)
        self.assertIn("missing.h5", run.stderr)
        self.assertNotIn("dimension", run.stderr)

    def test_a_value_beside_other_observations_is_told(self):
        observed = 'b = { value = "%s mm", observations = ["2.00 mm", "2.10 mm", "2.20 mm", "2.15 mm", "2.05 mm"] }'
        self.assertIn("the mean of the observations is not used", self.said("b", "mm", observed % 5))
        self.assertNotIn("the mean of the observations is not used", self.said("b", "mm", observed % 2.1))

    def test_scatter_that_is_not_used_is_told(self):
        read = '[indications.z]\nreadings = ["10.00 mm", "10.01 mm", "10.02 mm"]\nresolution = "%s"\n'
        self.assertIn("indications scatter by s = 10 um", self.said("z", "mm", "", more=read % "1 um"))
        self.assertNotIn("indications scatter", self.said("z", "mm", "", more=read % "30 um"))

    def test_screening_of_correlated_inputs_is_refused_at_its_line(self):
        text = self.SUM % ("a + b", "1", "a = { value = 0, u = 1 }\nb = { value = 0, u = 1 }")
        text += '[[correlations]]\nquantities = ["a", "b"]\nkind = "pearson"\nmatrix = [[1, 0.5], [0.5, 1]]\n'
        text += "[analysis]\nsensitivity = { morris = 100 }\n"
        self.refused(text, text[: text.index("[analysis]")].count("\n") + 2, 26, "the inputs are correlated", "shapley")

    def test_virtual_experiment_needs_formulas_of_indications(self):
        text = H2.replace('name = "expression"', 'name = "expression"\nmethod = "virtual_experiment"')
        run = gumshoe("check", self.scenario(text))
        self.assertIsNone(complaint(run), run.stderr)


if __name__ == "__main__":
    unittest.main()
