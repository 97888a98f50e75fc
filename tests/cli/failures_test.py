"""Where failed samples lie among the inputs.

usage: failures_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import re
import unittest

from program import FORMULA, InFolder, gumshoe

SCENARIO = """schema = 1
[model]
name = "expression"
[model.measurands]
root = "sqrt(a * b)"
[quantities]
a = { value = "1 mm", u = "0.5 mm" }
b = { value = "2 mm", u = "0.1 mm" }
middle = "1 mm"
[run]
samples = 40_000
max_failed_share = 0.1
"""


class Failures(InFolder):
    def failures(self, text, *options):
        path = self.folder / "s.toml"
        path.write_text(text)
        run = gumshoe("run", path, "--out", self.folder / "r.h5", "--format", "json", *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)[0]["run"]["failures"]

    def test_the_input_that_makes_samples_fail_is_named_with_its_range(self):
        """A square root fails where a < 0: in Phi(-2) of the samples, whatever b is."""
        share = math.erfc(2 / math.sqrt(2)) / 2
        for design in ("monte_carlo", "sobol", "latin_hypercube"):
            with self.subTest(design):
                told, = self.failures(SCENARIO + f'design = "{design}"\n')
                low, high, percent = map(float, re.search(r"; a is (\S+) to (\S+) mm in them, as in about (\S+) % of", told).groups())
                self.assertLess(-1.5, low)  # 5 standard deviations below 1 mm
                self.assertLess(low, -0.3)
                self.assertTrue(-0.01 < high <= 0, high)
                self.assertAlmostEqual(percent / 100, share, delta=5 * math.sqrt(share / 16384))
                self.assertNotIn("; b is", told)

    def test_a_narrow_range_has_the_digits_that_show_its_ends(self):
        """acos(x) fails where x > 1: of 0.99997 to 1.00001 in the last quarter."""
        told, = self.failures("""schema = 1
[model]
name = "expression"
[model.measurands]
y = "acos(x)"
[quantities]
x = { value = 0.99999, distribution = "rectangular", half_width = 2e-5 }
[run]
samples = 40_000
max_failed_share = 1
""")
        low, high = map(float, re.search(r"; x is (\S+) to (\S+) in them, as in about 2\d % of", told).groups())
        self.assertTrue(1 <= low < 1.0000001, low)
        self.assertTrue(1.0000099 < high <= 1.00001, high)

    def test_what_is_stated_holds_for_the_others(self):
        """a + b never fails, and has no value where sqrt(a) has none."""
        (self.folder / "two.toml").write_text(FORMULA)
        run = gumshoe("run", self.folder / "two.toml", "--out", self.folder / "two.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        failed = int(re.search(r"not_finite: (\d+) samples", run.stdout)[1])
        self.assertIn(f"failed samples count for no output: what is stated holds for the {20_001 - failed} others\n", run.stdout)

    def test_rare_failures(self):
        """4 standard deviations: 3e-5 of the samples, none among those that are looked at for the share."""
        told, = self.failures(SCENARIO.replace('u = "0.5 mm"', 'u = "0.25 mm"'), "--samples", "1e6")
        self.assertIn("in them, as in less than 0.02 % of all samples", told)

    def test_a_few_failures_tell_nothing(self):
        told, = self.failures(SCENARIO, "--samples", "500")  # 11 expected, 20 are needed
        self.assertIn("not_finite: ", told)
        self.assertNotIn(" in them", told)

    def test_failures_on_both_sides_span_no_narrow_range(self):
        """a beyond one standard deviation: a third of the samples fail, over the whole range."""
        both = SCENARIO.replace("sqrt(a * b)", "sqrt(b * b - 16 * (a - middle) ^ 2)").replace("0.1\n", "1\n")
        told, = self.failures(both)
        self.assertNotIn(" in them", told)


if __name__ == "__main__":
    unittest.main()
