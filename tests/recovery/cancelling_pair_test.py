"""An axis that expands with its temperature while its scale drifts the other way, in a shop that warms up: the two nearly
cancel, and what they leave looks like noise whose readings resemble those before them. Neither passes alone.

usage: cancelling_pair_test.py path/to/gumshoe [unittest options]
"""
import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "cli")]

from lagging_scale_test import SCENARIO
from program import gumshoe

EXPANSION, DRIFT, WARMING = 10.0, -7.0, 0.7  # um/m/K, um/m/h, K/h: EXPANSION * WARMING + DRIFT = 0
CYCLES, TARGETS, LENGTH, STEP, NOISE = 6, 11, 0.6, 40.0, 0.3  # m, s, um
SIZES = {"axis_expansion": EXPANSION, "axis_scale_drift": DRIFT}


def write(folder, seed):
    """The temperature is a straight line in time and a random walk."""
    rng = np.random.default_rng([14, seed])
    places = np.linspace(0, LENGTH, TARGETS)
    position = np.tile(np.concatenate([places, places[::-1]]), CYCLES)
    n = len(position)
    hours = STEP / 3600 * np.arange(n)
    warmer = WARMING * hours + 0.3 * np.cumsum(rng.standard_normal(n)) / np.sqrt(n)
    deviation = 2 + 5 * position + position * (EXPANSION * warmer + DRIFT * hours) + NOISE * rng.standard_normal(n)
    columns = {"cycle": np.arange(n) // (2 * TARGETS) + 1, "position": 1e3 * position,
               "direction": np.where(np.arange(n) % (2 * TARGETS) < TARGETS, 1, -1), "time": STEP * np.arange(n),
               "temperature": (20 + warmer).round(2), "deviation": deviation.round(2)}
    rows = [",".join(columns)] + [",".join(str(x) for x in row) for row in zip(*columns.values())]
    (folder / "r.csv").write_text("\n".join(rows) + "\n")
    (folder / "s.toml").write_text(SCENARIO)


class CancellingPair(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rounds = {}
        for seed in range(1, 13):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                write(folder, seed)
                cls.rounds[seed] = [cls.trace(folder, file) for file in ("s.toml", "s.traced.toml")]

    @staticmethod
    def trace(folder, scenario):
        run = gumshoe("trace", scenario, "--out", "o.h5", "--force", "--format", "json", cwd=folder)
        assert run.returncode == 0, run.stderr
        return json.loads(run.stdout)

    def test_both_are_found(self):
        """But where their temperature moves too little."""
        found, inside, sizes = 0, 0, 0
        for first, _ in self.rounds.values():
            if {f["name"] for f in first["findings"]} != set(SIZES):
                continue
            found += 1
            self.assertLess(first["p_anything"], 0.05)
            self.assertLess(first["rms"]["holdout_after"], first["rms"]["holdout_before"])
            for f in first["findings"]:
                q, = f["quantities"]
                sizes += 1
                inside += q["interval95"][0] <= SIZES[f["name"]] <= q["interval95"][1]
        self.assertGreaterEqual(found, 10)
        # Of twenty intervals of 95 %, fewer than 17 hold the true size in one case of sixty.
        self.assertGreaterEqual(inside, 0.85 * sizes)

    def test_the_next_round_starts_where_this_one_ended(self):
        for seed, (first, second) in self.rounds.items():
            self.assertAlmostEqual(second["rms"]["before"] / first["rms"]["after"], 1, delta=0.02, msg=seed)
            self.assertEqual(second["findings"], [], seed)


if __name__ == "__main__":
    unittest.main()
