"""A positioning test of a linear axis, traced to the scatter of its readings: scenarios/trace_linear_axis.toml.

usage: trace_axis_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import random
import re
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
                      cwd=self.folder)
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

    def test_what_a_table_cannot_hold_is_said(self):
        """The scale that drifts is left in the readings; the table takes the rest."""
        self.trace(4)
        run = gumshoe("compensate", "results/s.traced.toml", "--with", "gain", "--with", "offset", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("left out: axis_scale_drift also depends on something else than the position", run.stderr)
        table = {(float(row["position_mm"]), int(row["direction"])): float(row["error_um"])
                 for row in csv.DictReader(line for line in io.StringIO(run.stdout) if not line.startswith("#"))}
        with open(self.folder / "data" / "linear_axis.csv") as file:
            readings = [(float(r["x_mm"]), int(r["direction"]), float(r["deviation_um"]))
                        for r in csv.DictReader(line for line in file if not line.startswith("#"))]
        root_mean_square = lambda values: math.sqrt(sum(v * v for v in values) / len(values))
        said = re.search(r"these readings(?:, less [a-z_ ]+)?: (\S+) um, with the table (\S+) um, of which (\S+) um is noise and the rest what is left out", run.stderr)
        before, after, noise = map(float, said.groups())
        self.assertAlmostEqual(before / root_mean_square([d for _, _, d in readings]), 1, delta=6e-3)
        self.assertAlmostEqual(after / root_mean_square([d - table[x, way] for x, way, d in readings]), 1, delta=6e-3)
        self.assertAlmostEqual(noise / plain_axis.NOISE_UM, 1, delta=4 / math.sqrt(2 * 80) + 0.13)  # 20 of 80 are fitted
        self.assertGreater(after, 3 * noise)

    WARMING = """schema = 1
[model]
name = "linear_axis"
evaluation = "deviation"
[data]
file = "w.csv"
labels = { cycle = "cycle" }
conditions = { position = "x_mm", direction = "direction", time = "time_min" }
units = { x_mm = "mm", time_min = "min", deviation_um = "um" }
[indications.deviation]
readings = "deviation_um"
[quantities]
offset = { estimated = true, value = "0 um" }
gain = { estimated = true, value = "0 um/m" }
[trace]
blocks = "cycle"
order = "time"
"""

    def test_a_time_constant_is_fitted_beside_a_reversal(self):
        """An axis warms by 6 um in 20 min and has a reversal of 2.4 um: each hides the other, so that they are found together."""
        for seed in (1, 2, 3):
            draw, rows, time = random.Random(seed), [], 0.0
            for cycle in range(1, 6):
                for direction in (1, -1):
                    for i in range(11)[::direction]:
                        read = 3 + 5e-3 * 50 * i - 1.2 * direction + 6 * (1 - math.exp(-time / 20)) + draw.gauss(0, 0.5)
                        rows.append((cycle, 50 * i, direction, time, read))
                        time += 0.6
            (self.folder / "w.csv").write_text(plain_axis.table(rows))
            (self.folder / "w.toml").write_text(self.WARMING)
            run = gumshoe("trace", "w.toml", "--draws", "199", "--format", "json", "--force", "--threads", "1", cwd=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            found = {f["members"][0]: {q["name"].split(".")[-1]: q for q in f["quantities"]} for f in json.loads(run.stdout)["findings"]}
            self.assertEqual(set(found), {"axis_drift", "axis_reversal"})
            for name, truth in (("amplitude", 6), ("time_constant", 20)):
                size = found["axis_drift"][name]
                self.assertLess(abs(size["value"] - truth), 3 * size["u"], name)  # beyond in one of 400

    def test_a_recorded_temperature_hides_neither_drift_nor_floor(self):
        """Readings warm up by 2 um with 2 h, a temperature near the machine rises with the time, and no two readings
        have the same: their conditions are equal all the same, and the drift is one of time."""
        chance, rows, t = random.Random(7), ["cycle,x_mm,direction,t_s,temperature_degC,d_um"], 0
        for cycle in range(1, 61):
            for way in (1, -1):
                for x in [50 * i for i in range(9)][::way]:
                    d = 1.2 * way + 2 * (1 - math.exp(-t / 7200)) + chance.gauss(0, 0.4)
                    rows.append(f"{cycle},{x},{way},{t},{20 + t / 36000 + chance.gauss(0, 0.01):.2f},{d:.3f}")
                    t += 60
        (self.folder / "warm.csv").write_text("\n".join(rows) + "\n")
        run = gumshoe("new", "linear_axis", "--from", "warm.csv", "--out", "s.toml", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        run = gumshoe("trace", "s.toml", "--draws", "199", "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        v = json.loads(run.stdout)
        found = {f["name"]: f for f in v["findings"]}
        self.assertEqual(set(found), {"axis_reversal", "axis_drift"})
        self.assertEqual(found["axis_drift"]["depends_on"], ["time"])
        for size, true in zip(found["axis_drift"]["quantities"], (2, 120), strict=True):
            self.assertAlmostEqual(size["value"], true, delta=3.5 * size["u"], msg=size)
        # A reversal of 1.2 um with noise of 0.4 um is most of the mean square: 1.44 of 1.44 + 0.16 + the drift's 0.1.
        self.assertGreater(found["axis_reversal"]["removed_share"], 0.7)
        self.assertIn("axis_drift", v["plain"][1])
        # 0.4 um; some 700 degrees of freedom: 2.7 %, of which 0.1 is three and a half.
        self.assertAlmostEqual(v["rms"]["replicate_floor"] * 1e6 / 0.4, 1, delta=0.1)


if __name__ == "__main__":
    unittest.main()
