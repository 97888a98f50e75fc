"""Readings with one estimated standard deviation: a mean of them is a t with the degrees of freedom of that one, in the GUM framework
and in the samples, however many readings there are.

usage: common_estimate_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import pathlib
import tempfile
import unittest

from program import gumshoe

T_995 = {3: 5.8409, 4: 4.6041}  # quantiles of t, GUM Table G.2
SAMPLES = 400_000

AXIS = """schema = 1
[model]
name = "linear_axis"
evaluation = "iso_230_2_once"
{data}
[indications.deviation]
readings = {readings}
{noise}
[run]
samples = {samples}
[analysis]
measurands = ["mean_reversal"]
coverage_probability = 0.99
"""
PLACES = """[conditions]
position = ["0 mm", "100 mm", "200 mm", "300 mm", "300 mm", "200 mm", "100 mm", "0 mm"]
direction = [1, 1, 1, 1, -1, -1, -1, -1]"""
EIGHT = '["1 um", "2 um", "3 um", "4 um", "5 um", "4 um", "3 um", "2 um"]'
FILE = """[data]
file = "r.csv"
units = { x_mm = "mm", dev_um = "um" }
[data.conditions]
position = "x_mm"
direction = "dir\""""


class CommonEstimate(unittest.TestCase):
    def reversal(self, data, readings, noise, *options):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "s.toml").write_text(AXIS.format(data=data, readings=readings, noise=noise, samples=SAMPLES))
            (folder / "r.csv").write_text("x_mm,dir,dev_um\n0,1,1.604\n0,1,1.746\n100,1,2.599\n100,1,2.109\n0,-1,2.772\n0,-1,2.634\n"
                                          "100,-1,3.339\n100,-1,3.674\n")
            run = gumshoe("run", "s.toml", "--out", "s.h5", "--format", "json", *options, cwd=folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            return json.loads(run.stdout)[0]

    def check(self, out, u, degrees):
        gum, (low, high) = out["gum"], out["symmetric"]
        self.assertAlmostEqual(gum["combined_standard_uncertainty"], u, delta=1e-6 * u)
        self.assertEqual(gum["effective_degrees_of_freedom"], degrees)
        self.assertAlmostEqual(gum["expanded_uncertainty"], T_995[degrees] * u, delta=1e-4 * u * T_995[degrees])
        # Of the end of the interval: 5 standard errors of an order statistic, by the density of t there.
        density = 0.005 * degrees / T_995[degrees]  # of a tail that falls with the power of its degrees of freedom, or faster
        error = 5 * math.sqrt(0.005 * 0.995 / SAMPLES) / density * u
        self.assertAlmostEqual((high - low) / 2, T_995[degrees] * u, delta=error)

    def test_a_declared_s(self):
        """Four pairs of places: the mean of four differences of two readings, s = 0.5 um."""
        for more in ((), ("--seed", "5")):
            out = self.reversal(PLACES, EIGHT, 'repeatability = { s = "0.5 um", degrees_of_freedom = 3 }', *more)
            self.check(out, 0.5 * math.sqrt(8) / 4, 3)

    def test_a_pooled_s(self):
        """Four cells of two: s by the differences within them, of four degrees of freedom; two differences of means of two."""
        within = (1.746 - 1.604, 2.109 - 2.599, 2.634 - 2.772, 3.674 - 3.339)
        s = math.sqrt(sum(d * d / 2 for d in within) / 4)
        self.check(self.reversal(FILE, '"dev_um"', "repeatability = { pooled = true }"), s * math.sqrt(0.5), 4)

    def test_a_component_stated_once(self):
        component = 'components = [{ name = "probe", u = "0.5 um", degrees_of_freedom = 3, per = "reading" }]'
        self.check(self.reversal(PLACES, EIGHT, component), 0.5 * math.sqrt(8) / 4, 3)

    def test_each_reading_by_its_own_repeats(self):
        """Four estimates of one degree of freedom each are four terms: G.4.1."""
        out = self.reversal(FILE, '"dev_um"', 'repeatability = "readings"')
        s2 = [d * d / 2 for d in (1.746 - 1.604, 2.109 - 2.599, 2.634 - 2.772, 3.674 - 3.339)]
        self.assertEqual(out["gum"]["effective_degrees_of_freedom"], math.floor(sum(s2) ** 2 / sum(x * x for x in s2)))


if __name__ == "__main__":
    unittest.main()
