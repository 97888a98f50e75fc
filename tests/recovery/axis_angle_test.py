"""An error of a rotary axis' angle that no card knows, stated by the user as a formula on the quantity E_CC: is it named, with its
size, and does the next round start where this one ended?

usage: axis_angle_test.py path/to/gumshoe [unittest options]
"""
import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "cli")]

import spheres
from program import gumshoe
from scenario_text import readings_csv, scenario_toml

STATED = """
[stated_effects.three_bearings]
quantity = "E_CC"
formula  = "sin(3 * C)"
unit     = "arcsec"
meaning  = "three bearings of the drive"

[stated_effects.twist_of_B]
quantity = "E_BB"
formula  = "sin(2 * B)"
unit     = "arcsec"
"""


class AxisAngle(unittest.TestCase):
    def sets(self, seed, size, stated=STATED):
        """A folder with readings of a machine whose C axis errs by size (arcsec) sin 3C."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name)
        rng = np.random.default_rng([seed, 20])
        d = spheres.design(rng)
        q = np.array([c.value + (rng.uniform(-3, 3) * c.step if c.free else c.u * rng.standard_normal()) for c in d.cells])
        angle = d.value("C") * np.pi / 180
        y = spheres.simulate(None, d, [q], C_error=size * spheres.ARCSEC * np.sin(3 * angle))[0]
        y = y + d.noise * rng.standard_normal(y.shape)
        (path / "readings.csv").write_text(readings_csv(d, y, spheres.OUTPUTS))
        (path / "s.toml").write_text(scenario_toml(d, spheres) + stated)
        return path

    def trace(self, path, scenario, *words):
        run = gumshoe("trace", scenario, "--format", "json", "--draws", "199", "--out", path / "o.h5", "--force", *words, cwd=path)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def test_it_is_named_with_its_size(self):
        for seed, size in ((1, 6.0), (2, -8.0)):
            path = self.sets(seed, size)
            found = self.trace(path, "s.toml")
            # A shape by chance has a probability of alpha; no other name may be there.
            self.assertEqual([f["members"] for f in found["findings"] if f["kind"] in ("named", "class")], [["three_bearings"]],
                             found["statements"])
            row = found["findings"][0]["quantities"][0]
            # The truth lies within the interval, or 1 % of sets would not: u is that of the fit, 3.3 of it at most.
            self.assertLess(abs(row["value"] - size), 3.3 * row["u"], row)
            self.assertLess(row["u"], 0.2 * abs(size))
            # Round 2 starts where this one ended.
            again = self.trace(path, "s.traced.toml")
            # A shape by chance, which held-out blocks reject, has a probability of alpha here as well.
            self.assertTrue(again["findings"] == [] or again["vetoed"], again["statements"])
            self.assertAlmostEqual(again["rms"]["before"] / found["rms"]["after"], 1, delta=0.02)
            self.assertAlmostEqual(again["rms"]["holdout_before"] / found["rms"]["holdout_after"], 1, delta=0.02)

    def test_nothing_is_named_where_nothing_is(self):
        found = self.trace(self.sets(3, 0.0), "s.toml")
        self.assertEqual(found["verdict"], "nothing_found", found["statements"])


if __name__ == "__main__":
    unittest.main()
