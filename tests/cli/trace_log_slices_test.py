"""Blocks that `gumshoe new` cut by their number are slices of time, and no cause.

usage: trace_log_slices_test.py path/to/gumshoe [unittest options]
"""
import math
import random
import re
import unittest

from traced_log import TracedLog


class Slices(TracedLog):
    def test_a_slice_of_time_is_no_cause(self):
        """A step of 4 sigma at the very edge of one of six slices that `new` cut: a step, and no scatter of slices."""
        for seed in range(6):
            draw = random.Random(seed)
            text = self.log(["axis,err_um"] + [f"{'XY'[i % 2]},{2 * (i >= 60) + draw.gauss(0, 0.5):.2f}" for i in range(120)])
            self.assertIn("blocks = { count = 6 }", text)
            v = self.verdict("log.toml")
            self.assertEqual([f["described_by"] for f in v["findings"]], ["step:order after reading 60"], v["plain"])
            size, u = map(float, re.search(r"it differs by (\S+) um, u = (\S+) um", " ".join(v["findings"][0]["remarks"])).groups())
            self.assertAlmostEqual(size, 2, delta=4 * u)
            # Means of 60 readings and of 40, as the last slice is held out, and the scale of the noise known to 7 %.
            self.assertAlmostEqual(u, 0.5 * math.sqrt(1 / 60 + 1 / 40), delta=0.4 * u)

    def test_a_column_of_blocks_may_scatter(self):
        """Batches that someone named are acts: eight of them with a standard deviation of three times the noise."""
        draw = random.Random(5)
        of = [draw.gauss(0, 1.5) for _ in range(12)]
        self.log(["axis,run,err_um"] + [f"{'XY'[i % 2]},{i // 10 + 1},{of[i // 10] + draw.gauss(0, 0.5):.2f}" for i in range(120)])
        v = self.verdict("log.toml")
        self.assertEqual([f["name"] for f in v["findings"]], ["scatter:run"])


if __name__ == "__main__":
    unittest.main()
