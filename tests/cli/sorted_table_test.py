"""Tables that are sorted by what was set: `new` says so, and `trace` takes a curve for no memory of the readings and leaves out no
machine or part of a study.

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
        """Six blocks of 30 rows, dealt in turn, each round from the next block on: the last one, held out, has one of each round."""
        self.log(2, lambda x: 0.0)
        run = gumshoe("trace", "log.toml", "--force", "--out", "t.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        with h5py.File(self.folder / "t.h5") as file:
            held_out = [i for i, final in enumerate(file["residuals/final"][:]) if final]
        self.assertEqual(held_out, [5, 10, 15, 20, 25])

    def study(self, seed, rows):
        chance = random.Random(seed)
        lines = [f"{worker},{machine},{mean + chance.gauss(0, 1):.2f}" for worker, machine, mean in rows]
        (self.folder / "log.csv").write_text("worker,machine,score_um\n" + "\n".join(lines) + "\n")
        run = gumshoe("new", "--from", "log.csv", "--force", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return (self.folder / "log.toml").read_text()

    def test_a_study_of_workers_and_machines(self):
        """Six workers on three machines, three pieces each. In six stretches the last was half of a machine, whose workers were not
        in the others; what they do on it passed for scatter."""
        for seed in (1, 2, 3):
            chance = random.Random(100 + seed)
            cells = [(w, m, 50 + 5 * "ABC".index(m) + chance.gauss(0, 4)) for m in "ABC" for w in range(1, 7)]
            text = self.study(seed, [cell for cell in cells for _ in range(3)])
            self.assertIn('sorted by "machine", "worker"', text)
            self.assertIn('order = "unknown"', text)
            found = self.trace()
            self.assertEqual([sorted(f["depends_on"]) for f in found["findings"]], [["machine", "worker"]], seed)
            # Two of three pieces of a cell are known: sqrt(1 + 1/2) of the noise, 1 um, within 3 standard deviations of nine readings.
            self.assertLess(found["rms"]["holdout_after"], 2.2e-6, seed)

    def test_a_study_whose_rows_are_numbered(self):
        """The numbers may be the order of measurement; what was only in the last rows is found all the same, and told with what
        cannot be told from it."""
        chance = random.Random(1)
        cells = [(m, level) for m in "ABC" for level in (100, 200, 500) for _ in range(15)]
        rows = [f"{m},{level},{k + 1},{50 + (2 if (m, level) == ('C', 500) else 0) + chance.gauss(0, 0.5):.2f}" for k, (m, level) in enumerate(cells)]
        (self.folder / "log.csv").write_text("machine,feed_set,no,width_um\n" + "\n".join(rows) + "\n")
        run = gumshoe("new", "--from", "log.csv", "--force", cwd=self.folder)
        text = (self.folder / "log.toml").read_text()
        self.assertIn("interleaved = true", text, run.stdout)
        self.assertIn('order = "no"', text)
        found = self.trace()["findings"]
        self.assertEqual([sorted(f["depends_on"]) for f in found], [["feed_set", "machine"]])
        self.assertIn("cannot distinguish it from", " ".join(found[0]["remarks"]))

    def test_what_is_no_table_of_a_study(self):
        """Parts of their own in each batch are drawn from many: there whole batches are left out. A piece each may be in the order
        of measurement."""
        nested = self.study(1, [(f"{lot}{w}", lot, 50) for lot in "ABCDEF" for w in range(3) for _ in range(3)])
        once = self.study(1, [(w, m, 50) for m in "ABC" for w in range(1, 7)])
        for text in (nested, once):
            self.assertNotIn("unknown", text)


if __name__ == "__main__":
    unittest.main()
