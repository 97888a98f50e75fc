#!/usr/bin/python3
"""Mills whose readings jump with what is missing: run-out, or an insert that is lower by more than a tooth's feed.

usage: mills_test.py path/to/gumshoe [unittest options]
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

GUMSHOE = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else ""

import mills
import sets
from score import covered


def traced(folder, what, seed, **plan):
    """(verdict, truth) of a set of this noise, um, and plan."""
    d, y, truth = sets.make(GUMSHOE, mills, "several", what, 0, seed, **plan)
    scenario = sets.write(folder, folder / "truth", "set", d, y, truth, mills)
    subprocess.run([GUMSHOE, "trace", scenario, "--draws", "199", "--out", folder / "found.h5", "--json", folder / "verdict.json"],
                   check=True, capture_output=True)
    return json.loads((folder / "verdict.json").read_text()), truth


class Jumps(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)

    def found(self, what, seed, **plan):
        verdict, truth = traced(self.folder, what, seed, **plan)
        self.assertEqual([f["name"] for f in verdict["findings"]], [name for name, _ in what], verdict["plain"])
        self.assertFalse(verdict["jumps_not_crossed"])
        return verdict["findings"][0], truth["effects"][0], verdict

    def test_an_insert_among_noise_of_a_third_of_its_size(self):
        """1.5 um, where the noise is 0.5 um and readings of all other quantities jump, too."""
        finding, effect, _ = self.found((("declared:wear_2", 8.0),), 7001, setups=10, clampings=2)
        self.assertEqual(covered(finding, effect), [True], finding)

    def test_an_insert_lower_by_more_than_a_step(self):
        """0.72 um, where a tooth's feed is 0.5 um in the median. No noise is declared."""
        finding, effect, _ = self.found((("declared:wear_2", 15.0),), 7001, setups=10, clampings=2, noise=0.1, declared=False)
        self.assertGreater(effect["size"], 0.7e-3)
        self.assertEqual(covered(finding, effect), [True], finding)

    def test_an_insert_that_triggers_every_reading(self):
        """0.92 um in 24 readings: its tangent is that of the tool's length, and a step of both would lose the size that was tried."""
        finding, effect, _ = self.found((("declared:wear_3", 15.0),), 940, clampings=1, noise=0.1)
        self.assertEqual(covered(finding, effect), [True], finding)

    def test_sizes_between_those_first_tried(self):
        """24 readings. The sizes that explain them are a few hundredths of those tried, half of the size does not reach the first
        jump, and readings that jump are outliers as long as the insert is in its place."""
        for seed in (3504, 3505, 3508):
            with self.subTest(seed):
                finding, effect, _ = self.found((("declared:wear_3", 15.0),), seed, clampings=1, noise=0.1)
                self.assertEqual(covered(finding, effect), [True], finding)

    def test_run_out_of_several_steps(self):
        """0.09 mrad of a tool of 20 mm: 1.7 um from one side to the other. What is left is the noise."""
        finding, effect, verdict = self.found((("tool_runout", 30.0),), 7002, noise=0.1)
        self.assertGreater(effect["size"], 0.08)
        self.assertEqual(covered(finding, effect), [True, True], finding)
        self.assertLess(verdict["noise"]["scale"], 1.3)

    def test_a_size_that_no_insert_has_stands_back(self):
        """An insert of nearly three times its radius would fit better than the true run-out, which is of usual size."""
        _, _, verdict = self.found((("tool_runout", 8.0),), 2710, setups=10, clampings=2)
        self.assertIn("tilt_y", verdict["plain"][0])  # the larger of its two sizes is told, too

    def test_run_out_does_not_depend_on_time(self):
        """In 18 readings its signature goes along with a drift."""
        finding, _, _ = self.found((("tool_runout", 15.0),), 2710, clampings=1, noise=0.1)
        self.assertLessEqual(set(finding["depends_on"]), {"feed", "spindle_speed", "start_angle"})

    def test_jumps_that_were_not_crossed_are_no_missing_effect(self):
        """As long as this run-out is not found. The verdict must not say that no known effect explains the readings."""
        verdict, _ = traced(self.folder, (("tool_runout", 15.0),), 3707, clampings=1, noise=0.1)
        self.assertTrue(verdict["jumps_not_crossed"])
        self.assertIn("the readings jump with sizes that were tried", verdict["plain"][0])
        self.assertFalse(any("No candidate explains" in s for s in verdict["plain"]))


class Rounds(unittest.TestCase):
    def test_a_round_starts_where_the_one_before_ended(self):
        """24 readings, 18 to train on: a size that came back as a reading of itself would take 4 % of the error, and a declared
        insert that started from what was declared would leave a run-out on another tooth. A drift that is sought anew would
        explain more the second time. A size keeps its uncertainty: along its tangent the readings know 0.9 mrad of a run-out of
        0.1 mrad."""
        quiet, undeclared = dict(noise=0.1), dict(declared=False)
        for what, seed, noise in ((("declared:wear_3", 15.0), 943, quiet), (("tool_runout", 15.0), 946, quiet),
                                  (("tool_runout", 15.0), 3705, quiet), (("thermal_growth", 15.0), 7004, undeclared)):
            with tempfile.TemporaryDirectory() as place:
                folder = pathlib.Path(place)
                d, y, truth = sets.make(GUMSHOE, mills, "several", (what,), 0, seed, clampings=1, **noise)
                scenario = sets.write(folder, folder / "truth", "set", d, y, truth, mills)
                subprocess.run([GUMSHOE, "trace", scenario, "--loop", "2", "--draws", "199", "--out", folder / "found.h5",
                                "--json", folder / "verdict.json"], check=True, capture_output=True)
                verdict = json.loads((folder / "verdict.json").read_text())
                first, second = verdict["rounds"]
                self.assertEqual(first["added"], [what[0]])
                for before, after in (("before", "after"), ("holdout_before", "holdout_after")):
                    self.assertLess(abs(second[before] / first[after] - 1), 0.02, (what, before))
                states = tomllib.loads((folder / f"{scenario.stem}.traced.toml").read_text())
                sizes = states.get("effects", {}).get(what[0], {}) | states["quantities"]
                for q in verdict["findings"][0]["quantities"]:
                    written = sizes[q["name"]]["u"]
                    self.assertLess(abs(float(written.split()[0]) / q["u"] - 1), 0.1, (what, q, written))


class Oracle(unittest.TestCase):
    def test_run_out_hides_which_of_two_inserts_is_lower(self):
        """Four inserts differ by three heights. With another run-out the insert across is as likely, if readings are
        of both at once: changes by each alone do not add up."""
        _, _, truth = sets.make(GUMSHOE, mills, "several", (("tool_runout", 15.0), ("declared:wear_2", 15.0)), 0, 7003, exact=True,
                                clampings=1, noise=0.1)
        wear = truth["effects"][1]
        self.assertIn("declared:wear_4", wear["unsplit_exact"])
        self.assertLess(wear["exact_rivals"]["declared:wear_4"], 0.1)


if __name__ == "__main__":
    unittest.main()
