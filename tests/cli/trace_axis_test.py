"""A positioning test of a linear axis, traced to the scatter of its readings: scenarios/trace_linear_axis.toml.

usage: trace_axis_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import unittest

import plain_axis
from program import ROOT, InFolder, gumshoe

SCENARIOS = ROOT / "scenarios"


class TraceAxis(InFolder):
    def trace(self, seed):
        """Verdict on readings of another seed, traced until nothing is added."""
        (self.folder / "data").mkdir(exist_ok=True)
        (self.folder / "data" / "linear_axis.csv").write_text(plain_axis.table(plain_axis.readings(seed=seed)))
        (self.folder / "s.toml").write_text((SCENARIOS / "trace_linear_axis.toml").read_text())
        run = gumshoe("trace", "s.toml", "--draws", "99", "--loop", "5", "--format", "json", "--force", "--threads", "1",
                      cwd=self.folder, seconds=300)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def test_the_readings_are_as_their_script_writes(self):
        self.assertEqual((SCENARIOS / "data" / "linear_axis.csv").read_text(), plain_axis.table(plain_axis.readings()))

    def test_it_ends_at_the_scatter_of_a_reading(self):
        """Tables hold the bow, tables or effects the reversal, and the scale that drifts has its name. The floor has
        about 40 degrees of freedom a seed, so that the mean of three is known within 6.5 %; 0.2 is three of that."""
        verdicts = [self.trace(seed) for seed in (1, 2, 3)]
        rates = []
        for v in verdicts:
            self.assertEqual(set().union(*(f["depends_on"] for f in v["findings"])), {"position", "direction", "time"})
            drifts = [f for f in v["findings"] if "time" in f["depends_on"]]
            self.assertEqual([f["members"] for f in drifts], [["axis_scale_drift"]])
            rates.append(drifts[0]["quantities"][0])
            self.assertEqual(v["rounds"][-1]["added"], [])
            self.assertGreater(v["rms"]["before"], 2e-6)
            self.assertLess(v["rms"]["holdout_after"], v["rms"]["holdout_noise_interval95"][1])
        # 0.09 um/m a minute; u of the mean of three by what each states.
        u = math.hypot(*(r["u"] for r in rates)) / 3
        self.assertAlmostEqual(sum(r["value"] for r in rates) / 3, 60 * 0.09, delta=3 * u)
        for k in ("after", "replicate_floor"):
            mean = sum(v["rms"][k] for v in verdicts) / len(verdicts)
            self.assertAlmostEqual(1e6 * mean / plain_axis.NOISE_UM, 1, delta=0.2, msg=k)


if __name__ == "__main__":
    unittest.main()
