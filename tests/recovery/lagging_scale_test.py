"""An axis whose scale follows the temperature that was recorded with a lag of forty minutes, which no candidate does: what the
held-out cycles at the end refute is not to be corrected for, and the next round starts where this one ended.

usage: lagging_scale_test.py path/to/gumshoe [unittest options]
"""
import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "cli")]

from program import gumshoe

SCENARIO = """schema = 1
title = "an axis in a shop whose temperature swings"
[model]
name = "linear_axis"
[data]
file = "r.csv"
labels = { cycle = "cycle" }
[data.conditions]
position = { column = "position", unit = "mm" }
direction = "direction"
time = { column = "time", unit = "s" }
temperature = { column = "temperature", unit = "degC" }
[quantities]
offset = { estimated = true, value = "0 um" }
gain = { estimated = true, value = "0 um/m" }
[indications.deviation]
readings = { column = "deviation", unit = "um" }
u = "0.3 um"
[trace]
blocks = "cycle"
order = "time"
draws = 199
"""
LAG, PERIOD, SWING, EXPANSION = 2400.0, 9000.0, 2.0, 8e-3  # s, s, K, um/mm/K
CYCLES, TARGETS, LENGTH, PAUSE = 8, 9, 800.0, 1500.0


def write(folder, seed):
    """The scale is the first-order response to a sine: it is smaller by the root of 1 + (2 pi LAG / PERIOD)^2, and later."""
    rng = np.random.default_rng([6, seed])
    phase, turn = rng.uniform(0, 2 * np.pi), 2 * np.pi / PERIOD
    places = np.linspace(0, LENGTH, TARGETS)
    position = np.tile(np.concatenate([places, places[::-1]]), CYCLES)
    n = len(position)
    cycle = np.arange(n) // (2 * TARGETS) + 1
    time = 15.0 * np.arange(n) + PAUSE * (cycle - 1)
    air = SWING * np.sin(turn * time + phase)
    scale = SWING / np.hypot(1, turn * LAG) * np.sin(turn * time + phase - np.arctan(turn * LAG))
    deviation = 2 + 5e-3 * position + EXPANSION * position * scale + 0.3 * rng.standard_normal(n)
    columns = {"cycle": cycle, "position": position, "direction": np.where(np.arange(n) % (2 * TARGETS) < TARGETS, 1, -1),
               "time": time, "temperature": (20 + air + 0.02 * rng.standard_normal(n)).round(2), "deviation": deviation.round(3)}
    rows = [",".join(columns)] + [",".join(str(x) for x in row) for row in zip(*columns.values())]
    (folder / "r.csv").write_text("\n".join(rows) + "\n")
    (folder / "s.toml").write_text(SCENARIO)


class LaggingScale(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.found = {}
        for seed in (1, 2, 3, 5):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                write(folder, seed)
                cls.found[seed] = [cls.trace(folder, "s.toml", *words) for words in ((), ("--format", "json"))]
                cls.found[seed].append(cls.trace(folder, "s.traced.toml", "--format", "json"))

    @staticmethod
    def trace(folder, scenario, *words):
        run = gumshoe("trace", scenario, "--out", "o.h5", "--force", *words, cwd=folder)
        assert run.returncode == 0, run.stderr
        return json.loads(run.stdout) if words else run.stdout

    def test_what_makes_held_out_readings_worse_is_not_to_be_corrected_for(self):
        worse = 0
        for seed, (text, first, _) in self.found.items():
            rms = first["rms"]
            if first["vetoed"] or not first["findings"] or rms["holdout_after"] <= 1.05 * rms["holdout_before"]:
                continue
            worse += 1
            self.assertTrue(first["unconfirmed"], seed)
            self.assertIn("measure another block before you correct for anything", text, seed)
            self.assertLess(rms["holdout_after"], 2.05 * rms["holdout_before"], seed)
        self.assertGreater(worse, 0)  # else these sets tell nothing

    def test_the_next_round_starts_where_this_one_ended(self):
        """Also where the hold-out blocks rejected what was found, and scatter of cycles is all that the scenario holds."""
        vetoed = 0
        for seed, (_, first, second) in self.found.items():
            vetoed += first["vetoed"]
            self.assertAlmostEqual(second["rms"]["before"] / first["rms"]["after"], 1, delta=0.02, msg=seed)
        self.assertGreater(vetoed, 0)


if __name__ == "__main__":
    unittest.main()
