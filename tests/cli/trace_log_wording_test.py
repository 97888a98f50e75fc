"""What `gumshoe trace` says of logs: periods that gaps confuse.

usage: trace_log_wording_test.py path/to/gumshoe [unittest options]
"""
import datetime
import math
import random
import unittest

from traced_log import TracedLog


class Wording(TracedLog):
    def test_gaps_leave_the_period_open(self):
        """Four hours of each day: a wave of 8 h goes round three times a day, as those of 6 h, 12 h and 24 h go round
        four times, twice and once."""
        noise = random.Random(11)
        start = datetime.datetime(2026, 3, 2, 7)
        rows = ["timestamp,z (um)"]
        for day in range(6):
            for k in range(24):
                t = start + datetime.timedelta(days=day, minutes=10 * k)
                rows.append(f"{t},{4 * (1 - math.exp(-k / 8)) + noise.gauss(0, 0.3):.2f}")
        self.log(rows)
        said = [r for f in self.verdict("log.toml")["findings"] for r in f.get("remarks", []) if r.startswith("a wave along")]
        self.assertTrue(said)
        self.assertRegex(said[0], r"period \S+ h, or as well .* h, which these readings cannot distinguish because of the gaps "
                                  r"between them; amplitude \S+ um, u = \S+ um")
        self.assertNotRegex(said[0], r"period [^;]*u = ")

    def test_without_gaps_the_period_has_its_uncertainty(self):
        noise = random.Random(12)
        rows = ["time (min),z (um)"]
        rows += [f"{t},{math.sin(2 * math.pi * t / 97) + noise.gauss(0, 0.3):.2f}" for t in range(0, 1440, 10)]
        self.log(rows)
        said, = (r for f in self.verdict("log.toml")["findings"] for r in f.get("remarks", []) if r.startswith("a wave along"))
        self.assertRegex(said, r"period 9[67]\.\d+ min, u = \S+ min; amplitude ")


if __name__ == "__main__":
    unittest.main()
