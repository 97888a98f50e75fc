"""What `gumshoe trace` says of logs: periods that gaps confuse, findings that held-out readings reject or do not meet.

usage: trace_log_wording_test.py path/to/gumshoe [unittest options]
"""
import datetime
import json
import math
import random
import unittest

from program import gumshoe
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

    def test_what_held_out_readings_reject_is_no_headline(self):
        """Two lobes that the last day has the other way round."""
        noise = random.Random(13)
        rows = ["angle (deg),day,radius_error (um)"]
        for day in range(1, 7):
            size = 0.6 if day < 6 else -0.6
            rows += [f"{a},{day},{size * math.cos(2 * math.radians(a)) + noise.gauss(0, 0.2):.2f}" for a in range(0, 360, 15)]
        self.log(rows)
        v = self.verdict("log.toml")
        self.assertTrue(v["vetoed"])
        said = " ".join(v["plain"])
        self.assertIn("An unknown effect of position was found in the training data, but it does not improve the prediction of "
                      "held-out readings. Nothing is added to the model. Measure more blocks to decide.", said)
        self.assertNotIn("changes the readings", said)
        self.assertNotIn("Also found", said)

    def test_why_an_error_changes_that_blocks_are_insensitive_to(self):
        """The first cycle alone bends the gain of all: without it, the others are predicted better."""
        noise = random.Random(14)
        rows = ["position (mm),cycle,deviation (um)"]
        for cycle in range(1, 7):
            rows += [f"{x},{cycle},{(6 * x / 500 if cycle == 1 else 0) + noise.gauss(0, 0.3):.2f}" for x in range(0, 520, 20)]
        self.log(rows)
        v = self.verdict("log.toml")
        said, = (s for s in v["statements"] if "insensitive to the finding" in s)
        self.assertIn("can neither confirm nor reject it; their error changes only because everything else is fitted together "
                      "with it", said)

    def test_a_free_reversal_leaves_the_zero_open(self):
        """Reversal errors that are zero at the lowest position, and those at the highest, differ by a constant, which is free."""
        noise = random.Random(5)
        rows = ["position (mm),direction,cycle,deviation (um)"]
        for cycle in range(1, 7):
            for sign, way in (("+", range(0, 501, 50)), ("-", range(500, -1, -50))):
                rows += [f"{x},{sign},{cycle},{float(sign + '1') * x / 500 + noise.gauss(0, 0.3):.2f}" for x in way]
        self.log(rows)
        f, = self.verdict("log.toml")["findings"]
        self.assertIn("described by product:position*direction", f["remarks"])

    def test_fresh_readings_a_little_beyond(self):
        """Growth with position and temperature: between the temperatures of a position, and up to a twentieth of their range
        beyond, it is predicted; farther beyond, the message says by how much."""
        noise = random.Random(15)
        head = "position (mm),temperature (degC),day,deviation (um)"

        def rows(temperatures):
            for day in range(1, 6):
                for t in temperatures:
                    for x in range(0, 600, 100):
                        yield f"{x},{t:.1f},{day},{0.003 * x * (t - 20) + noise.gauss(0, 0.3):.2f}"

        self.log([head, *rows((18, 20, 22, 24))])
        v = self.verdict("log.toml")
        self.assertIn("product:position*temperature_degc", {f["described_by"] for f in v["findings"]})
        traced = (self.folder / "log.traced.toml").read_text()
        self.assertIn("margin = 0.05", traced)
        (self.folder / "fresh.toml").write_text(traced.replace('"log.csv"', '"fresh.csv"'))

        def predict(*temperatures):
            (self.folder / "fresh.csv").write_text("\n".join([head, *rows(temperatures)]) + "\n")
            return gumshoe("run", "fresh.toml", "--predict", "--samples", 200, "--format", "json", cwd=self.folder)

        run = predict(17.8, 19, 24.2)
        self.assertEqual(run.returncode, 0, run.stderr)
        for one, row in zip(json.loads(run.stdout), (self.folder / "fresh.csv").read_text().splitlines()[1:], strict=True):
            x, t, _, _ = map(float, row.split(","))
            self.assertAlmostEqual(one["estimate"], 0.003 * x * (t - 20), delta=0.5)
        self.assertIn("temperature_degc = 24.9 degC (it is known from 17.7 degC to 24.3 degC). Measure there",
                      predict(24.9).stderr)


if __name__ == "__main__":
    unittest.main()
