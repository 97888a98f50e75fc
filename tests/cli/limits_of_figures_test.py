"""Results at the limits of what their figures can say: few readings, numbers at the end of double precision.

usage: limits_of_figures_test.py path/to/gumshoe [unittest options]
"""
import json
import unittest

import numpy as np

from program import InFolder, gumshoe

PLUG = """schema = 1
[model]
name = "expression"
[model.measurands]
d = { formula = "r + c", unit = "mm" }
[indications.r]
readings = [READINGS]
repeatability = "readings"
[quantities.c]
value = "0 um"
U = "0.5 um"
k = 2
[run]
samples = 200_000
[[analysis.conformity]]
measurand = "d"
lower = "9.99 mm"
upper = "10.01 mm"
rule = "iso_14253_1"
"""
FAR = """schema = 1
[model]
name = "expression"
[model.measurands]
d = { formula = "x", unit = "m" }
[quantities.x]
value = "1e9 m"
u = "U"
[run]
samples = 100_000
"""


class LimitsOfFigures(InFolder):
    def ran(self, text, *words):
        file = self.folder / "s.toml"
        file.write_text(text)
        run = gumshoe("run", file, "--force", *words)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def test_three_readings_have_a_guard_band_though_no_standard_uncertainty(self):
        """A t with two degrees of freedom has no variance, but quantiles: 5 % of it lie beyond 2.92 s / sqrt(3)."""
        text = PLUG.replace("READINGS", '"10.0000 mm", "10.0001 mm", "10.0002 mm"')
        row = json.loads(self.ran(text, "--format", "json"))[0]
        self.assertIsNone(row["standard_uncertainty"])
        decision = row["conformity"][0]
        self.assertTrue(decision["accepted"])
        rng = np.random.default_rng(1)
        d = rng.standard_t(2, 1_000_000) * 1e-4 / np.sqrt(3) + rng.normal(0, 0.00025, 1_000_000)
        self.assertAlmostEqual(decision["guard_band"], np.quantile(d, 0.95), delta=0.03 * np.quantile(d, 0.95))
        said = self.ran(text)
        self.assertNotIn("nan", said)
        self.assertIn("conformity of d: accepted", said)

    def test_samples_coarser_than_the_uncertainty_are_told(self):
        for u, told in (("1 nm", True), ("0.3 um", True), ("10 um", False)):  # doubles there are 0.12 um apart
            row = json.loads(self.ran(FAR.replace("U", u), "--format", "json"))[0]
            warning, verdict = row["warning"], row["validation"]["verdict"]
            self.assertEqual("numbers of double precision are 0.12 um apart" in warning, told, warning)
            self.assertEqual(verdict == "not applicable", told, verdict)
        row = json.loads(self.ran(FAR.replace("U", "0.3 um"), "--format", "json"))[0]
        self.assertAlmostEqual(row["standard_uncertainty"], 0.3e-6, delta=0.02e-6)  # coarse, but not constant
        self.assertIn("warning: numbers of double precision", self.ran(FAR.replace("U", "1 nm")))


if __name__ == "__main__":
    unittest.main()
