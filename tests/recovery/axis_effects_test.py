"""Effects of a linear axis, each alone in made-up readings written without the engine, are named with their sizes.

usage: axis_effects_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import pathlib
import random
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from program import InFolder, gumshoe  # noqa: E402

SCENARIO = """schema = 1
[model]
name = "linear_axis"
[data]
file = "axis.csv"
labels = { cycle = "cycle" }
units = { x_mm = "mm", time_min = "min", temp_degC = "degC", angle_urad = "urad", dev_um = "um" }
conditions = { position = "x_mm", direction = "direction", time = "time_min", temperature = "temp_degC", pitch_angle = "angle_urad" }
[conditions]
pitch = "10 mm"
[quantities]
offset = { estimated = true, value = "0 um" }
gain = { estimated = true, value = "0 um/m" }
[indications.deviation]
readings = "dev_um"
[trace]
blocks = "cycle"
order = "time"
seed = 1
"""

# Members of the finding; its first sizes; what it adds, um, at x (m), from side s, at t (min), T - 20 degC, angle (urad).
CASES = [
    (["axis_reversal"], [3], lambda x, s, t, T, a: -s * 3 / 2),
    (["axis_reversal_slope"], [4], lambda x, s, t, T, a: -s * 4 * x / 2),
    (["axis_periodic_error"], [0.5, 1.5], lambda x, s, t, T, a: 0.5 * math.cos(200 * math.pi * x) + 1.5 * math.sin(200 * math.pi * x)),
    (["axis_drift", "declared:reference_drift"], [5], lambda x, s, t, T, a: 5 * t / 60),  # either of them drifts
    (["axis_drift"], [8, 20], lambda x, s, t, T, a: 8 * (1 - math.exp(-t / 20))),
    (["axis_scale_drift"], [6], lambda x, s, t, T, a: 6 * x * t / 60),
    (["axis_expansion"], [4], lambda x, s, t, T, a: 4 * T * x),
    (["axis_abbe_error"], [100], lambda x, s, t, T, a: 0.1 * a),
    ([], [], lambda x, s, t, T, a: 0),
]


def readings(added, seed):
    """Five cycles over twelve uneven targets, up and down; a straight line, 0.2 um of noise, and what is added."""
    draw = random.Random(seed)
    targets = [round(75 * i + draw.uniform(-12, 12), 1) for i in range(12)]
    t, rows = 0.0, ["cycle,x_mm,direction,time_min,temp_degC,angle_urad,dev_um"]
    for cycle in range(1, 6):
        for s in (1, -1):
            for mm in targets[::s]:
                x = mm / 1000
                T, angle = 1.5 * math.sin(t / 17) + 0.02 * t + draw.gauss(0, 0.02), 30 * math.sin(5 * x) + 10 * x
                y = 1 + 3 * x + added(x, s, t, T, angle) + draw.gauss(0, 0.2)
                rows.append(f"{cycle},{mm},{s},{t:.1f},{20 + T:.3f},{angle:.2f},{y:.3f}")
                t += 0.5
    return "\n".join(rows) + "\n"


class AxisEffects(InFolder):
    def test_each_alone_has_its_name_and_size(self):
        (self.folder / "s.toml").write_text(SCENARIO)
        for members, sizes, added in CASES:
            for seed in (1, 2):
                with self.subTest(members=members, seed=seed):
                    (self.folder / "axis.csv").write_text(readings(added, seed))
                    run = gumshoe("trace", "s.toml", "--draws", "99", "--threads", "1", "--format", "json", "--force", cwd=self.folder)
                    self.assertEqual(run.returncode, 0, run.stderr)
                    verdict = json.loads(run.stdout)
                    self.assertEqual([f["members"] for f in verdict["findings"]], [members] if members else [])
                    # A fifth of the noise is left to chance: 120 readings know it within 7 %.
                    self.assertAlmostEqual(verdict["rms"]["after"] / 0.2e-6, 1, delta=0.2)
                    for found, size in zip(verdict["findings"][0]["quantities"] if members else [], sizes):
                        self.assertAlmostEqual(found["value"], size, delta=4 * found["u"])


if __name__ == "__main__":
    unittest.main()
