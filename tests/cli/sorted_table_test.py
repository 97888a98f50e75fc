"""A table of a calibration, sorted by what was set: `new` says so, and `trace` takes a curve for no memory of the readings.

usage: sorted_table_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import random
import unittest

import h5py

from program import InOneFolder, gumshoe

POINTS, NOISE = 30, 0.01


class SortedTable(InOneFolder):
    def log(self, seed, curve, order=sorted):
        chance = random.Random(seed)
        places = order([round(100 * i / (POINTS - 1), 1) for i in range(POINTS)])
        rows = [f"{x},{0.01 * x + curve(x) + chance.gauss(0, NOISE):.4f}" for x in places]
        (self.folder / "log.csv").write_text("position_mm,signal_mV\n" + "\n".join(rows) + "\n")
        run = gumshoe("new", "--from", "log.csv", "--force", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return (self.folder / "log.toml").read_text()

    def trace(self):
        run = gumshoe("trace", "log.toml", "--draws", "199", "--format", "json", "--force", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def test_rows_that_are_sorted_are_no_order_of_measurement(self):
        hump = lambda x: 6 * NOISE * math.exp(-((x - 60) / 20) ** 2)
        for order in (sorted, lambda x: sorted(x, reverse=True)):
            text = self.log(1, hump, order)
            self.assertIn("blocks = { count = 6, interleaved = true }", text)
            self.assertIn('order = "unknown"', text)
        mixed = self.log(1, hump, lambda x: random.Random(3).sample(x, len(x)))
        self.assertIn("blocks = { count = 6 } ", mixed)
        self.assertNotIn("unknown", mixed)

    def test_a_hump_is_a_curve_and_no_memory_of_readings(self):
        """In order, noise that resembles that of the reading before would say the same: it is no question where nobody knows it."""
        for seed in range(1, 6):
            self.log(seed, lambda x: 6 * NOISE * math.exp(-((x - 60) / 20) ** 2))
            found = self.trace()
            self.assertEqual([f["depends_on"] for f in found["findings"]], [["position"]], seed)
            self.assertLess(found["rms"]["holdout_after"], found["rms"]["holdout_before"], seed)
            self.assertTrue(any("the order of measurement is not known" in s for s in found["statements"]), found["statements"])

    def test_readings_of_each_block_are_spread_over_the_table(self):
        """Six blocks of 30 rows, dealt in turn: the last one, held out, has every sixth reading."""
        self.log(2, lambda x: 0.0)
        run = gumshoe("trace", "log.toml", "--force", "--out", "t.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        with h5py.File(self.folder / "t.h5") as file:
            held_out = [i for i, final in enumerate(file["residuals/final"][:]) if final]
        self.assertEqual(held_out, list(range(5, POINTS, 6)))


if __name__ == "__main__":
    unittest.main()
