"""The made-up sphere calibration: its data are as their note says, and the effect in them is the whole of what the
scenario lacks.

usage: trace_sphere_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import subprocess
import sys
import unittest

from plain_grinder import ARCSEC, ECCENTRICITY, MACHINE, PASSES, POSES, TOWARDS
from program import ROOT, InFolder, gumshoe

SCENARIO = ROOT / "scenarios" / "trace_sphere.toml"
EFFECT = """
[effects.c_encoder_eccentricity]
cosine = { estimated = true, value = "0 arcsec" }
sine   = { estimated = true, value = "0 arcsec" }
"""


class TraceSphere(InFolder):
    def estimated(self, text):
        file = self.folder / "case.toml"
        file.write_text(text.replace('"data/', f'"{ROOT}/scenarios/data/'))
        run = gumshoe("estimate", file, "--scenario-out", self.folder / "out.toml", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def test_data_are_as_their_note_says(self):
        made = subprocess.run([sys.executable, ROOT / "tests/cli/plain_grinder.py"], capture_output=True, text=True)
        self.assertEqual((made.returncode, made.stderr), (0, ""))
        def numbers(text):
            return [[float(v) for v in row.split(",")] for row in text.split()[1:]]
        shipped = numbers((ROOT / "scenarios/data/trace_sphere.csv").read_text())
        self.assertEqual(len(shipped), PASSES * len(POSES))
        for ours, theirs in zip(numbers(made.stdout), shipped, strict=True):
            for a, b in zip(ours, theirs, strict=True):
                self.assertAlmostEqual(a, b, delta=1.01e-4)  # the last digit printed

    def test_effect_is_what_the_scenario_lacks(self):
        text = SCENARIO.read_text()
        without, with_it = self.estimated(text), self.estimated(text + EFFECT)
        self.assertEqual(without["degrees_of_freedom"], with_it["degrees_of_freedom"] + 2)
        self.assertGreater(without["chi_squared"], 5 * without["degrees_of_freedom"])
        # Five standard deviations of chi-squared about its mean.
        f = with_it["degrees_of_freedom"]
        self.assertLess(abs(with_it["chi_squared"] - f), 5 * math.sqrt(2 * f))
        size = {f"c_encoder_eccentricity.{k}": v * ECCENTRICITY / ARCSEC
                for k, v in (("cosine", -math.sin(TOWARDS)), ("sine", math.cos(TOWARDS)))}
        def is_angle(k):
            return k[:3] in ("E_A", "E_B", "E_C")
        truth = {k: v / (3600 * ARCSEC) if is_angle(k) else 1e3 * v for k, v in MACHINE.items()}
        for name, value in {**truth, **size}.items():
            p = with_it["parameters"][name]
            with self.subTest(name):
                self.assertLess(abs(p["value"] - value), 4 * p["standard_uncertainty"])


if __name__ == "__main__":
    unittest.main()
