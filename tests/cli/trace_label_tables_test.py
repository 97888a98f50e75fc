"""What differs by two labels together and comes back in every series is a correction, and no scatter.

usage: trace_label_tables_test.py path/to/gumshoe [unittest options]
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

SIGMA = 0.4  # um
OPERATORS = ("anna", "ben", "carl", "dora")


def readings(seed, operators, series, off):
    """Three machines, read by every operator in every series. `off(draw)` gives what adds to each: um."""
    draw = random.Random(seed)
    adds = off(draw)
    yield "machine,operator,series,d_um"
    for one in range(1, series + 1):
        for machine in ("M1", "M2", "M3"):
            for operator in operators:
                yield f"{machine},{operator},{one},{5 + adds(machine, operator, one) + draw.gauss(0, SIGMA):.3f}"


def one_cell(_):
    return lambda machine, operator, series: 2.5 if (machine, operator) == ("M2", "carl") else 0


def table(draw):
    """Any value in each cell, the same in every series."""
    cells = collections.defaultdict(lambda: draw.gauss(0, 1.5))
    return lambda machine, operator, series: cells[machine, operator]


def by_machine(_):
    return lambda machine, operator, series: {"M1": 0, "M2": 1.5, "M3": -1}[machine]


def anew(draw):
    """Any value for each machine in each series: nothing that comes back."""
    cells = collections.defaultdict(lambda: draw.gauss(0, 1.5))
    return lambda machine, operator, series: cells[machine, series]


class LabelTables(TracedLog):
    def found(self, rows, *edits):
        scenario = self.log(rows)
        for old, new in edits:
            self.assertIn(old, scenario)
            scenario = scenario.replace(old, new)
        (self.folder / "log.toml").write_text(scenario)
        return self.verdict("log.toml")

    def predicted(self):
        """By machine and operator: the mean of the readings that are fitted, and what the traced scenario expects of
        them; um. And the share of all readings in their 95 % intervals."""
        run = gumshoe("run", "log.traced.toml", "--predict", "--samples", 2000, "--format", "json", "--out", "p.h5", "--force", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        said = json.loads(run.stdout)
        by = collections.defaultdict(list)
        with (self.folder / "log.csv").open() as file:
            for row, one in zip(csv.DictReader(file), said, strict=True):
                if row["series"] != "4":  # held out
                    by[row["machine"], row["operator"]].append((float(row["d_um"]), one["gum"]["estimate"]))
        inside = sum(one["predicted"]["inside"] for one in said) / len(said)
        return {cell: [statistics.fmean(x) for x in zip(*many)] for cell, many in by.items()}, inside

    def test_one_machine_of_one_operator_is_named_and_corrected(self):
        verdict = self.found(readings(1, OPERATORS, 4, one_cell))
        finding, = verdict["findings"]
        self.assertEqual(finding["kind"], "not_in_catalogue")
        self.assertEqual(finding["depends_on"], ["machine", "operator"])
        self.assertIn("machine M2, operator carl differs from the others by a constant", verdict["plain"][0])
        found, inside = self.predicted()
        self.assertEqual(len(found), 12)
        others = [expected for cell, (_, expected) in found.items() if cell != ("M2", "carl")]
        self.assertAlmostEqual(max(others), min(others), delta=1e-6)
        # The mean of three readings of the cell, one of which may be winsorised or correlated, and of 33 others.
        self.assertLess(abs(found["M2", "carl"][1] - found["M2", "carl"][0]), 0.5 * SIGMA / math.sqrt(3))
        self.assertLess(abs(others[0] - 5), 4 * SIGMA / math.sqrt(33))
        self.assertGreater(inside, 0.85)  # of 48: fewer in 0.5 % of sets
        again = self.verdict("log.traced.toml")
        self.assertEqual(again["findings"], [])

    def test_a_table_by_machine_and_operator_comes_back(self):
        verdict = self.found(readings(2, OPERATORS[:3], 4, table))
        finding, = verdict["findings"]
        self.assertEqual((finding["kind"], finding["depends_on"]), ("not_in_catalogue", ["machine", "operator"]))
        self.assertNotIn("cannot be corrected", " ".join(verdict["plain"]))
        found, inside = self.predicted()
        self.assertEqual(len(found), 9)
        for cell, (mean, expected) in found.items():
            self.assertLess(abs(expected - mean), 1e-3, cell)  # every cell has a size of its own
        self.assertGreater(inside, 0.8)  # of 36: fewer in 0.3 % of sets
        self.assertEqual(self.verdict("log.traced.toml")["findings"], [])

    def test_machines_that_differ_are_no_table_by_machine_and_operator(self):
        for seed in (23, 24):  # the table describes these readings better, as chance has it
            verdict = self.found(readings(seed, OPERATORS, 4, by_machine))
            self.assertEqual([f["depends_on"] for f in verdict["findings"]], [["machine"]])

    def test_what_does_not_come_back_is_scatter(self):
        verdict = self.found(readings(3, OPERATORS, 6, anew))
        finding, = verdict["findings"]
        self.assertEqual((finding["kind"], finding["depends_on"]), ("scatter", ["machine", "series"]))

    def test_labels_that_are_stated_to_be_done_anew_have_no_table(self):
        stated = '[trace]\nredone = [["machine", "operator"]]'
        verdict = self.found(readings(1, OPERATORS, 4, one_cell), ("[trace]", stated))
        finding, = verdict["findings"]
        self.assertEqual((finding["kind"], finding["depends_on"]), ("scatter", ["machine", "operator"]))


if __name__ == "__main__":
    unittest.main()
