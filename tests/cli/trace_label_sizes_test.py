"""What a traced scenario says of machines, probes and cycles that differ is what was fitted to their readings.

usage: trace_label_sizes_test.py path/to/gumshoe [unittest options]
"""
import collections
import csv
import json
import math
import random
import statistics
import unittest

from program import gumshoe
from traced_log import TracedLog

SIGMA = 0.3  # um


def machines():
    """Three machines in five series: um."""
    draw = random.Random(2)
    yield "machine,operator,series,d_um"
    for series in range(1, 6):
        for machine, off in (("M1", 0), ("M2", 1.5), ("M3", -1)):
            for operator in ("anna", "ben", "carl", "dora"):
                yield f"{machine},{operator},{series},{2 + off + draw.gauss(0, SIGMA):.3f}"


def styli():
    """A ring probed on four days with two styli, each with lobes of its own."""
    draw = random.Random(3)
    yield "angle_deg,stylus,day,d_um"
    for day in range(1, 5):
        for stylus, lobe, off in (("short", 0.4, 0), ("long", 1.5, 2)):
            for angle in range(0, 360, 15):
                d = off + lobe * math.sin(3 * math.radians(angle)) + draw.gauss(0, SIGMA)
                yield f"{angle},{stylus},{day},{d:.3f}"


def cycles():
    """An axis whose five cycles differ, the last of which is held out by default."""
    draw = random.Random(4)
    yield "cycle,position_mm,d_um"
    for cycle, off in enumerate((4, 0, 2.5, -1, 3), 1):
        for position in range(0, 480, 40):
            yield f"{cycle},{position},{off + draw.gauss(0, SIGMA):.3f}"


class LabelSizes(TracedLog):
    def predicted(self, rows, *keys):
        """By these columns: the mean of the readings, and of what the traced scenario expects of them with its u; um. And the share of
        readings in their 95 % intervals."""
        verdict = self.verdict("log.toml") if self.log(rows) else None
        self.assertEqual([f["kind"] for f in verdict["findings"]], ["not_in_catalogue"])
        run = gumshoe("run", "log.traced.toml", "--predict", "--samples", 2000, "--format", "json", "--out", "p.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        said = json.loads(run.stdout)
        by = collections.defaultdict(list)
        with (self.folder / "log.csv").open() as file:
            for row, one in zip(csv.DictReader(file), said, strict=True):
                by[tuple(row[key] for key in keys)].append((float(row["d_um"]), one["gum"]["estimate"], one["standard_uncertainty"]))
        inside = sum(one["predicted"]["inside"] for one in said) / len(said)
        return {key: [statistics.fmean(x) for x in zip(*many)] for key, many in by.items()}, inside

    def test_every_machine_has_what_its_readings_say(self):
        found, inside = self.predicted(machines(), "machine")
        self.assertEqual(len(found), 3)
        for machine, (mean, expected, _) in found.items():
            # All 20 readings against the 16 of them that are fitted: four standard deviations of the difference.
            self.assertLess(abs(expected - mean), 4 * SIGMA * math.sqrt(1 / 16 - 1 / 20), machine)
        self.assertGreater(inside, 0.85)  # of 60: fewer in 0.2 % of sets

    def test_every_stylus_has_a_table_of_its_own(self):
        found, inside = self.predicted(styli(), "stylus", "angle_deg")
        self.assertEqual(len(found), 48)
        for cell, (mean, expected, _) in found.items():
            # Four readings against the three that are fitted; the largest of 48 lies beyond 4 in 0.3 % of sets.
            self.assertLess(abs(expected - mean), 4 * SIGMA * math.sqrt(1 / 3 - 1 / 4), cell)
        self.assertGreater(inside, 0.88)  # of 192: fewer in 0.1 % of sets

    def test_a_cycle_that_is_held_out_is_one_more_of_those_that_differ(self):
        found, _ = self.predicted(cycles(), "cycle")
        fitted = [mean for (cycle,), (mean, _, _) in found.items() if cycle != "5"]
        mean, expected, u = found[("5",)]
        spread = statistics.stdev(fitted) * math.sqrt(1 + 1 / 4)
        self.assertLess(abs(expected - statistics.fmean(fitted)), 4 * SIGMA / math.sqrt(48))
        self.assertAlmostEqual(u, math.hypot(spread, SIGMA), delta=0.1 * spread)  # SIGMA is known to 10 %
        self.assertLess(abs(mean - expected), 2 * u)
        for cycle in "1234":
            self.assertLess(found[(cycle,)][2], 1.5 * SIGMA)


if __name__ == "__main__":
    unittest.main()
