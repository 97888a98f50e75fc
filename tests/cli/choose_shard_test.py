"""`gumshoe choose --shard` and `gumshoe merge`: a grid of candidates is divided, and other grids are refused.

usage: choose_shard_test.py path/to/gumshoe [unittest options]
"""
import shlex
import struct
import unittest

import h5py

from choose_test import TEXT as CHOICE
from program import FORMULA
from sealed import record, reseal
from shards import Shards


class ChoiceShards(Shards):
    def test_a_choice_is_divided(self):
        scenario = self.scenario(CHOICE + '[run]\nseed = 3\n')
        files, said = self.make(scenario, 4, command="choose")
        self.assertIn("candidates 0 to 3 of 15 of the coarse grid", said[1])
        single = self.single(scenario, command="choose")
        for threads in (1, 2):
            (self.folder / "whole.h5").unlink(missing_ok=True)
            self.assertEqual(self.merged(files.values(), "--threads", threads), single)
        with h5py.File(files[1]) as file:  # what a shard knows can be read
            self.assertTrue((file["outputs/time"][0] > 5).all())
        files[2].unlink()
        with open(files[3], "r+b") as file:  # as if it had been killed
            file.seek(record(files[3])["places"]["samples_done"][0])
            file.write(struct.pack("<Q", 1))
        self.done("choose", scenario, "--seed", "4", "--shard", "4/4", "--out", "other.h5")
        self.done("run", self.scenario(FORMULA, "f.toml"), "--shard", "4/4", "--out", "run.h5")
        run = self.refused("1 of 4 shards are missing (2/4)", "merge", *self.shards.iterdir(), "other.h5", "run.h5")
        for words in ("3-of-4.h5: shard 3/4 cannot be used (it is not finished: 1 of 4 candidates)",
                      "other.h5: the shard belongs to another run (its seed is 4, that of the others 3)",
                      "run.h5: the shard belongs to another run (its command is run --shard, that of the others choose --shard)"):
            self.assertIn(words, run.stderr)
        for command in run.stdout.splitlines():
            self.assertTrue(command.startswith("gumshoe choose s.toml --shard"))
            self.done(*shlex.split(command)[1:])
        self.assertEqual(self.merged(sorted(self.shards.iterdir())), single)
        self.refused("15 candidates are too few for 16 shards", "choose", scenario, "--shard", "1/16")
        self.refused("--shard excludes --format", "choose", scenario, "--shard", "1/4", "--format", "json")
        self.refused("the file holds a part of a run (shard 1/4)", "report", files[1])

    def test_a_grid_that_is_not_that_of_the_shards(self):
        scenario = self.scenario(CHOICE)
        files, _ = self.make(scenario, 2, command="choose")
        content = CHOICE.replace("steps = 5", "steps = 6")
        self.scenario(content)
        other, _ = self.make(scenario, 2, "--force", command="choose")
        said = record(other[1])
        files, _ = self.make(self.scenario(CHOICE), 2, "--force", command="choose")
        for file in files.values():
            reseal(file, scenario_hash=said["scenario_hash"])
        self.scenario(content)
        self.refused("the shards have other candidates than the coarse grid of s.toml (design hash", "merge", *files.values())
        for file in files.values():
            reseal(file, design_hash=said["design_hash"])
        self.refused("the shard has another number of candidates than its part of the grid", "merge", *files.values())

    def test_a_shard_of_another_grid_of_as_many_candidates_is_made_again(self):
        content = CHOICE.replace('low = "10 mm/min"', 'low = "20 mm/min"')
        file = self.make(self.scenario(content), 2, command="choose")[0][1]
        said, whole = record(file), file.read_bytes()
        self.make(self.scenario(CHOICE), 2, "--force", command="choose", numbers=[1])
        self.assertEqual(record(file)["rows"], said["rows"])
        # As a program would have left it that divides the same ranges in another way.
        reseal(file, scenario_hash=said["scenario_hash"], scenario_text=said["scenario_text"])
        other = self.done("choose", self.scenario(content), "--shard", "1/2", "--out", file)
        self.assertIn("held 8 samples of an unfinished run with other settings; this run replaces it", other.stderr)
        self.assertEqual(file.read_bytes(), whole)
        self.assertEqual(self.done("choose", "s.toml", "--shard", "1/2", "--out", file).stderr, "")


if __name__ == "__main__":
    unittest.main()
