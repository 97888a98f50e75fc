"""The loop on readings of an axis: a round starts where the one before ended, and what repeats is corrected.

usage: loop_test.py path/to/gumshoe [unittest options]
"""
import concurrent.futures
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import axis

GUMSHOE = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else ""
SAME = 0.02  # relative difference of errors between the end of a round and the start of the next
REPEATS = ("reversal", "alternating_reversal", "table", "table_and_reversal", "periodic", "temperature")


def rounds(missing, seed, noise, declared):
    with tempfile.TemporaryDirectory() as folder:
        axis.write(pathlib.Path(folder), missing, seed, noise, declared)
        run = subprocess.run([GUMSHOE, "trace", "s.toml", "--loop", "6", "--format", "json", "--threads", "1"], cwd=folder,
                             capture_output=True, text=True, timeout=300)
        assert run.returncode == 0, run.stderr
        return json.loads(run.stdout)["rounds"]


class Loop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        sets = [(m, 1, n, True) for m, n in itertools.product(axis.MISSING, axis.NOISE)]
        sets += [(m, 2, "plain", False) for m in axis.MISSING]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            cls.found = dict(zip(sets, pool.map(lambda s: rounds(*s), sets)))

    def test_a_round_starts_where_the_one_before_ended(self):
        for s, table in self.found.items():
            for a, b in itertools.pairwise(table):
                for before, after in (("before", "after"), ("holdout_before", "holdout_after")):
                    self.assertLess(abs(b[before] / a[after] - 1), SAME, (s, before, table))

    def test_the_loop_ends(self):
        for s, table in self.found.items():
            self.assertTrue(not table[-1]["added"] or table[-1]["vetoed"], (s, table))

    def test_what_repeats_is_corrected(self):
        """In plain noise of 1 um: 54 readings or more in 2 cells of 9 leave the noise, within 3 of its standard errors."""
        for (missing, _, noise, _), table in self.found.items():
            if missing in REPEATS and noise == "plain":
                self.assertLess(abs(table[-1]["after"] * 1e6 - 1), 3 / (2 * 54) ** 0.5, (missing, table))
                self.assertGreater(table[0]["before"] * 1e6, 2, missing)


if __name__ == "__main__":
    unittest.main()
