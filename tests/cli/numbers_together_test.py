"""Numbers that a result states side by side fit each other: temperatures and their errors, U and k and u, the certificate
and what is compared with it, and indices of what has no variance.

usage: numbers_together_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import pathlib
import re
import sys
import tempfile
import unittest

from program import ROOT, gumshoe

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from gumshoe_report import page, read, workbook

HEAD = 'schema = 1\n[model]\nname = "expression"\n'
SPHERE = (  # centres of a sphere on a table that tilts about B and turns about C, made with noise of 3 um
    (-269.7854, 287.4007, 469.695), (-350.5288, 274.1332, 469.7056), (-427.7462, 247.0402, 469.7016),
    (-499.0895, 206.946, 469.6917), (-562.3816, 155.0934, 469.664), (-615.7071, 93.0146, 469.63),
    (-657.4475, 22.6349, 469.5801), (-686.327, -53.9391, 469.5364), (-701.4753, -134.3524, 469.4741),
    (-702.4307, -216.1744, 469.4064), (-781.0499, -217.04, 230.5657), (-752.1894, -216.5616, 353.4314),
    (-702.428, -216.1752, 469.4102), (-633.2858, -215.9067, 574.991), (-546.859, -215.7581, 666.9525),
    (-445.776, -215.7305, 742.5241), (-273.4902, -215.9224, 820.2347))


class NumbersTogether(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.path = pathlib.Path(temporary.name)

    def run_command(self, *words, code=0):
        run = gumshoe(*words, cwd=self.path)
        self.assertEqual(run.returncode, code, run.stderr)
        return run.stdout

    def result(self, text, name="s", samples=20000, head=HEAD):
        """Text and JSON of a scenario."""
        (self.path / f"{name}.toml").write_text(head + text)
        words = ("run", f"{name}.toml", "--out", f"{name}.h5", "--force", "--samples", samples)
        return self.run_command(*words), json.loads(self.run_command(*words, "--format", "json"))

    def test_an_error_of_a_temperature_is_a_difference(self):
        text, said = self.result('''method = "virtual_experiment"
[model.indications]
r = "T + b"
[model.measurands]
Tm = { formula = "r", unit = "degC" }
[quantities]
T = { value = "30 degC" }
b = { value = "0 K", u = "0.2 K" }
[indications.r]
components = [{ u = "0.1 K", per = "reading" }]
[[analysis.conformity]]
measurand = "Tm"
lower = "-0.5 K"
upper = "0.5 K"
''')
        output, = said
        self.assertEqual(output["unit"], "K")
        self.assertLess(abs(output["estimate"]), 0.01)
        self.assertLess(abs(sum(output["shortest"])), 0.05)
        self.assertIn("tolerance from -0.50 K to 0.50 K", text)
        self.assertNotIn("273", text)

    def test_a_mean_of_temperatures_that_share_an_input_runs_to_the_same(self):
        for unit, value in (("degC", 20.1), ("degF", 71.0)):
            for seed, name in ((1, "a"), (2, "b")):
                self.result(f'''[model.measurands]
T = {{ formula = "x + ref", unit = "{unit}" }}
[quantities]
x = {{ value = "{value + seed} {unit}", u = "0.1 K" }}
ref = {{ value = "0 K", u = "0.05 K" }}
[run]
seed = {seed}
''', name)
            mean = json.loads(self.run_command("combine", "a.h5", "b.h5", "--same", "ref", "--out", "mean.toml", "--force",
                                               "--format", "json"))["means"][0]
            words = ("run", "mean.toml", "--out", "mean.h5", "--force", "--samples", 20000, "--format", "json")
            again, = json.loads(self.run_command(*words))
            self.assertEqual((again["unit"], mean["unit"]), (unit, unit))
            self.assertAlmostEqual(again["estimate"], mean["estimate"], delta=0.01)
            self.assertAlmostEqual(again["standard_uncertainty"], mean["standard_uncertainty"], delta=0.005)

    def test_the_u_of_which_the_framework_states_k_times(self):
        """Of a t of 5 degrees of freedom the samples have u sqrt(5 / 3), u_c has u."""
        text, said = self.result('''[model.measurands]
y = { formula = "x", unit = "mm" }
[quantities]
x = { value = "10 mm", u = "0.15 mm", degrees_of_freedom = 5 }
''', samples=4_000_000)
        self.assertIn("u = 0.19 mm;", text)
        self.assertIn("U and k of the GUM framework, validated by Monte Carlo, of u_c = 0.15 mm", text)
        output, = said
        self.assertAlmostEqual(output["expanded_uncertainty"] / output["coverage_factor"], 0.15, delta=1e-6)

    def test_a_difference_without_a_mean_is_one_of_medians(self):
        """Two readings a rod: a t with 1 degree of freedom. What both share cancels; that does not give it a mean."""
        (self.path / "z.csv").write_text("rod,z (mm)\nA,2.000\nA,2.002\nB,2.010\nB,2.016\n")
        scenario = '''[model.measurands]
h = { formula = "z - ref", unit = "mm" }
[quantities.ref]
value = "1 mm"
u = "1 um"
[indications.z]
repeatability = "readings"
readings = { file = "z.csv", column = "z (mm)", unit = "mm", labels = { rod = "rod" } }
[[analysis.comparisons]]
measurand = "h"
between = "rod"
'''
        text, _ = self.result(scenario)
        self.assertRegex(text, r"h: A - B = -0\.01\d* mm, without U and E_n\n")
        html = page.render(read.result(self.path / "s.h5"))
        self.assertIn("<td>no U</td>", html)
        self.assertNotIn("not consistent", html)
        row, = read.result(self.path / "s.h5").comparisons
        self.assertTrue(math.isnan(row.standard_uncertainty) and math.isnan(row.expanded_uncertainty))
        self.assertTrue(math.isnan(row.normalised_error))
        # The scales are 1 um and 3 um; the median of 20,000 is known to about pi (1 + 3) um / (2 sqrt(20000)).
        self.assertAlmostEqual(row.difference, -12e-6, delta=5 * 0.045e-6)
        # One unknown error in both: its t, without a variance, is in neither difference.
        self.result(scenario.replace('u = "1 um"', 'u = "1 um"\ndegrees_of_freedom = 1')
                    .replace('repeatability = "readings"', 'components = [{ u = "2 um", per = "reading" }]'))
        row, = read.result(self.path / "s.h5").comparisons
        self.assertAlmostEqual(row.standard_uncertainty, math.hypot(2e-6, 2e-6), delta=0.05e-6)

    def test_an_angle_across_the_cut_is_stated_on_the_circle(self):
        """About 180 deg: mean, u and interval on the line are those of two heaps 360 deg apart."""
        text, said = self.result('''[model.measurands]
th = { formula = "atan2(y, x)", unit = "deg" }
[quantities]
x = { value = "-10 mm", u = "0.01 mm" }
y = { value = "0.1 mm", u = "1 mm" }
''')
        output, = said
        self.assertEqual(output["certificate"], "")
        self.assertIsNone(output["expanded_uncertainty"])
        self.assertIn("lie across the cut of the circle", output["warning"])
        self.assertRegex(text, r"th: mean direction (-?17\d|180)\.?\d* deg with a standard deviation of 5\.\d+ deg on the circle; the shortest arc of "
                               r"95 % goes from 16\d\.?\d* up to 19\d")
        html = page.render(read.result(self.path / "s.h5"))
        self.assertRegex(html, r'<span class="symbol">th</span> = −?(17\d|180)\.?\d*\S* on the circle')
        across, = json.loads(self.run_command("run", "s.toml", "--out", "s.h5", "--force", "--samples", 20000, "--format", "json"))
        self.assertAlmostEqual(across["circular"]["standard_deviation"], math.degrees(0.1), delta=0.2)

    def test_failed_samples_stand_next_to_a_conformance_probability(self):
        """Those that fail are all beyond the limit: x < 0, 1 of 214 samples, known to 11 % (one standard deviation)."""
        text, _ = self.result('''[model.measurands]
y = "sqrt(x)"
[quantities]
x = { value = 2.6, u = 1 }
[[analysis.conformity]]
measurand = "y"
lower = 0
''')
        self.assertIn("conformance probability > 99", text)
        moved, = re.findall(r"  warning: \d+ failed samples are left out; they could move the conformance probability by (0\.\d+) % at most", text)
        self.assertAlmostEqual(float(moved), 100 / 214, delta=4 * 0.11 * 100 / 214)

    def test_of_many_decisions_those_of_which_least_is_sure(self):
        """Forty parts, 1 um apart, u = 3 um: those within 6 um of the limit."""
        (self.path / "z.csv").write_text("part,z (um)\n" + "".join(f"{k},{k}\n" for k in range(40)))
        text, _ = self.result('''[model.measurands]
d = { formula = "z", unit = "um" }
[indications.z]
u = "3 um"
readings = { file = "z.csv", column = "z (um)", unit = "um", labels = { part = "part" } }
[[analysis.conformity]]
measurand = "d"
upper = "20.1 um"
''')
        self.assertIn("conformity: 21 of 40 accepted, 19 rejected; the 12 least certain (--all prints all):\n", text)
        told = re.findall(r"conformity of d\[part (\d+)\]", text)
        self.assertEqual(len(told), 12)
        self.assertTrue(all(14 < int(part) < 27 for part in told), told)
        every = self.run_command("run", "s.toml", "--out", "s.h5", "--force", "--samples", 20000, "--all")
        self.assertEqual(len(re.findall("conformity of d", every)), 40)

    def test_an_allowed_uncertainty_says_how_well_it_is_known(self):
        """U^2 of y = 2 a + b + 3 c may have little of b: its allowed u follows from a small difference of large U^2."""
        self.result('''[model.measurands]
y = "2*a + b + 3*c"
[quantities]
a = { value = "0 um", u = "1 um" }
b = { value = "0 um", u = "1.732 um" }
c = { value = "0 um", u = "0.5 um" }
[[analysis.targets]]
measurand = "y"
U = "5 um"
''')
        target, = read.result(self.path / "s.h5").targets
        errors = dict(re.findall(r"(\w) ([\d.]+) %", target.statement))
        self.assertGreater(float(errors["b"]), 5)
        self.assertLess(float(errors["a"]), float(errors["b"]))

    def test_printed_results_are_compared_by_the_certificate(self):
        """Exponential of mean 2: U = 2 (ln 20 - 1) about the estimate, and not half of the shortest interval, ln 20."""
        text, said = self.result('''[model.measurands]
y = { formula = "x", unit = "mm" }
[quantities]
x = { distribution = "exponential", mean = "2 mm" }
[[analysis.printed]]
measurand = "y"
value = "2.1 mm"
source = "S"
''')
        output, = said
        result = read.result(self.path / "s.h5")
        self.assertEqual(result.printed[0].expanded_uncertainty, result.outputs[0].expanded_uncertainty)
        self.assertAlmostEqual(output["expanded_uncertainty"], 2 * (math.log(20) - 1), delta=0.15)
        rows = workbook.budget_rows(result.budgets[0], 0.95, "not validated")
        self.assertEqual(rows[-1], ["GUM framework: not validated by Monte Carlo, whose U and k the result states"])

    def test_differences_that_one_label_does_not_tell_apart(self):
        text, _ = self.result('''[model.measurands]
L = { formula = "z", unit = "mm" }
[indications.z]
components = [{ u = "1 um", per = "reading" }]
rows = [
{ rod = "1", setup = "a", values = ["21 mm"] },
{ rod = "1", setup = "b", values = ["22 mm"] },
{ rod = "2", setup = "a", values = ["31 mm"] },
{ rod = "2", setup = "b", values = ["33 mm"] },
]
[analysis]
comparisons = [{ measurand = "L", between = "rod", within = "setup" }, { measurand = "L", between = "setup" }]
''')
        self.assertIn("L: 1 - 2, setup a = -10.0000 mm", text)
        for a, b, difference in (("rod 1, setup a", "rod 1, setup b", -1), ("rod 1, setup a", "rod 2, setup b", -12),
                                 ("rod 1, setup b", "rod 2, setup a", -9), ("rod 2, setup a", "rod 2, setup b", -2)):
            self.assertIn(f"L[{a}] - L[{b}] = {difference}.0000 mm", text)

    def test_indices_of_what_has_no_variance(self):
        text, _ = self.result('''[model.measurands]
y = "x / z"
[quantities]
x = { value = 0, u = 1 }
z = { value = 0.1, u = 2 }
[analysis]
sensitivity = { sobol = 4096, shapley = 2048 }
''')
        self.assertIn("note: y: Sobol' indices and Shapley effects are shares of a variance, which does not exist here", text)
        result = read.result(self.path / "s.h5")
        self.assertEqual({i.total_verdict for i in result.sensitivities[0].rows}, {"not converged"})

    def test_the_residuals_of_the_readings_themselves(self):
        """Samples of a fit's residuals hold the noise of the readings and that which is drawn."""
        angles = [(0, 10 * k) for k in range(10)] + [(b, 90) for b in (-20, -10, 0, 10, 20, 30, 45)]
        said = lambda values, unit="": json.dumps([f"{v}{unit}" if unit else v for v in values])
        text, _ = self.result(f"""[conditions]
B = {said([b for b, _ in angles], " deg")}
C = {said([c for _, c in angles], " deg")}
pattern = {said([1] * 10 + [2] * 7)}
repeat = {said(range(17))}
""" + "".join(f"""[indications.{axis}]
readings = {said(values, " mm")}
components = [{{ u = "3 um", per = "reading" }}]
""" for axis, values in zip("XYZ", zip(*SPHERE))), samples=2000, head=HEAD.replace("expression", "sphere_calibration")
            + 'evaluation = "joint"\n')
        self.assertIn("residual_rms: 2.6 um for the readings themselves", text)  # by scipy 2.603 um

    def test_an_estimate_that_its_prior_excludes(self):
        for start, said in ((0.9, True), (0.1, False)):
            (self.path / "r.csv").write_text("x,y\n" + "".join(f"{x},{start + 0.5 * x}\n" for x in range(6)))
            (self.path / "f.toml").write_text(HEAD + """[model.indications]
y = "a + b * x"
[quantities]
a = { estimated = true, value = 0, distribution = "rectangular", half_width = 0.2 }
b = { estimated = true, value = 1 }
[data]
file = "r.csv"
conditions = { x = "x" }
[indications.y]
readings = "y"
u = 0.01
""")
            text = self.run_command("estimate", "f.toml", "--scenario-out", "e.toml", "--force")
            self.assertEqual("a lies outside of what is stated for it, -0.2 to 0.2" in text, said, text)
            self.assertNotIn("stands out", text)  # residuals are rounding

    def test_what_cancels_exactly_is_a_constant(self):
        text, said = self.result('''[model.measurands]
a = "x + y - 1.4142135623730951 * z"
[quantities]
x = { value = 0, u = 1 }
y = { value = 0, u = 1 }
z = { value = 0, u = 1 }
[[correlations]]
quantities = ["x", "y", "z"]
kind = "pearson"
matrix = [[1, 0, 0.7071067811865476], [0, 1, 0.7071067811865476], [0.7071067811865476, 0.7071067811865476, 1]]
''')
        self.assertEqual(said[0]["standard_uncertainty"], 0)

    def test_a_temperature_in_degC_that_was_meant_as_a_difference(self):
        quantities = '[quantities]\na = { value = "11.5 um/m/K" }\ndT = { value = "2 UNIT", u = "0.1 K" }\n'
        head = '[model.measurands]\ny = { formula = "0.1 * a * dT", unit = "um/m" }\n'
        text, _ = self.result(head + quantities.replace("UNIT", "degC"))
        self.assertIn("note: y: proportional to dT, counted from 0 K; state a difference of temperatures in K", text)
        text, _ = self.result(head + quantities.replace("UNIT", "K"))
        self.assertNotIn("proportional", text)


if __name__ == "__main__":
    unittest.main()
