"""`gumshoe run --shard` and `gumshoe merge`: the result is that of the single run, byte by byte; what cannot be merged is
named, with the commands that make it.

usage: shard_test.py path/to/gumshoe [unittest options]
"""
import os
import random
import re
import shlex
import shutil
import signal
import struct
import subprocess
import time
import unittest

import h5py

from counted_model import CORRELATED, COUNTED_PROGRAM, STUDIES, starts
from program import FORMULA, GUMSHOE, SCENARIO, gumshoe
from sealed import record, reseal, samples_done
from shards import SAME_DATE, Shards
from slow_model import SLOW, SLOW_PROGRAM


class RunShards(Shards):
    def test_three_of_sixteen_are_lost_and_made_again(self):
        scenario = self.scenario(SCENARIO + "[run]\nsamples = 20_000\n")
        files, _ = self.make(scenario, 16, "--threads", 1)
        single = self.single(scenario, "--threads", 2)
        files[3].unlink()
        with open(files[7], "r+b") as file:  # one bit of one sample
            file.seek(record(files[7])["places"]["outputs/laser_z"][0] + 8 * 100)
            byte = file.read(1)[0]
            file.seek(-1, os.SEEK_CUR)
            file.write(bytes([byte ^ 1]))
        with open(files[12], "r+b") as file:  # as if it had been killed at once
            file.seek(record(files[12])["places"]["samples_done"][0])
            file.write(struct.pack("<Q", 0))
        run = self.refused("1 of 16 shards are missing (3/16)", "merge", *self.shards.iterdir(), "--out", "whole.h5")
        self.assertIn("7-of-16.h5: shard 7/16 cannot be used (it is damaged", run.stderr)
        self.assertIn("12-of-16.h5: shard 12/16 cannot be used (it is not finished: 0 of ", run.stderr)
        self.assertFalse((self.folder / "whole.h5").exists())
        commands = run.stdout.splitlines()
        self.assertEqual([re.search(r"--shard (\d+)/16", line)[1] for line in commands], ["3", "7", "12"])
        for command in commands:
            self.done(*shlex.split(command)[1:])
        shuffled = sorted(files.values())
        random.Random(1).shuffle(shuffled)
        self.assertEqual(self.merged(shuffled), single)
        again = self.done("run", scenario, "--shard", "3/16", "--out", files[3])
        self.assertNotIn("resuming", again.stderr)

    def test_the_result_is_that_of_the_single_run(self):
        adaptive = '[run]\nadaptive = { rule = "stein", digits = 1 }\n'
        nothing_measured = SCENARIO + "[run]\nsamples = 20_000\n"
        cases = {"failing samples, several measurands": (FORMULA, ["--seed", "7"]),
                 "samples not stored": (FORMULA + "store_samples = false\n", []),
                 "sobol": (FORMULA + 'design = "sobol"\n', []),
                 "latin hypercube": (FORMULA + 'design = "latin_hypercube"\nstore_inputs = true\n', ["--samples", "3e3"]),
                 "prediction": (nothing_measured, ["--predict", "--samples", "5000"]),
                 "adaptive, with a number": (SCENARIO + adaptive, ["--samples", "5000"])}
        for name, (text, options) in cases.items():
            with self.subTest(name):
                scenario = self.scenario(text)
                files, said = self.make(scenario, 5, *options)
                ranges = [tuple(map(int, re.search(r"samples (\d+) to (\d+) of", s).groups())) for s in said.values()]
                self.assertEqual([first for first, _ in ranges], [0, *(last + 1 for _, last in ranges[:-1])])
                whole = self.single(scenario, *options)
                for threads in (1, 2):
                    (self.folder / "whole.h5").unlink(missing_ok=True)
                    self.assertEqual(self.merged(files.values(), "--threads", threads), whole)
                if "failing" in name:
                    failed = sum(int(re.search(r"(\d+) failed", s)[1]) for s in said.values())
                    with h5py.File(self.folder / "whole.h5") as file:
                        self.assertGreater(failed, 0)
                        self.assertEqual(failed, (file["outputs/status"][:] != 0).sum())
                shutil.rmtree(self.shards)
                self.shards.mkdir()

    def test_studies_are_divided_and_merge_runs_the_model_not_once(self):
        (self.folder / "counted.py").write_text(COUNTED_PROGRAM)
        for name, text in (("independent", STUDIES), ("correlated", CORRELATED)):
            with self.subTest(name):
                scenario = self.scenario(text)
                whole = self.single(scenario)
                points = sum(starts(self.folder))
                (self.folder / "starts").unlink()
                files, said = self.make(scenario, 3)
                runs = [int(re.search(r"about (\d+) model runs of studies", s)[1]) for s in said.values()]
                # Units are not divided; the largest take 8 rows of 8 runs.
                self.assertLess(max(runs) - min(runs), 2 * 64)
                # Each shard tries the scenario (2 starts) and, of Sobol' indices, runs 64 rows for their origin.
                self.assertLess(sum(starts(self.folder)), points + 3 * (2 + 64) + 64)
                (self.folder / "starts").unlink()
                for threads in (1, 2):
                    (self.folder / "whole.h5").unlink(missing_ok=True)
                    self.assertEqual(self.merged(files.values(), "--threads", threads), whole)
                    self.assertEqual(starts(self.folder), [])
                shutil.rmtree(self.shards)
                self.shards.mkdir()

    def test_a_scenario_whose_name_looks_like_an_option(self):
        scenario = self.scenario(FORMULA, "-x.toml")
        self.done("run", "--shard", "1/2", "--out", "one.h5", "--", scenario)
        run = self.refused("1 of 2 shards are missing (2/2)", "merge", "one.h5")
        self.assertEqual(run.stdout, "gumshoe run ./-x.toml --shard 2/2 --out ./-x.2-of-2.h5\n")
        self.done(*shlex.split(run.stdout)[1:])
        self.merged(["one.h5", "./-x.2-of-2.h5"])

    def test_studies_that_are_lost_or_damaged(self):
        (self.folder / "counted.py").write_text(COUNTED_PROGRAM)
        scenario = self.scenario(STUDIES)
        whole = self.single(scenario)
        points = sum(starts(self.folder))
        files, _ = self.make(scenario, 3)
        with open(files[2], "r+b") as file:  # one bit of one value
            file.seek(record(files[2])["places"]["studies/values"][0] + 8 * 100)
            byte = file.read(1)[0]
            file.seek(-1, os.SEEK_CUR)
            file.write(bytes([byte ^ 1]))
        with open(files[3], "r+b") as file:  # as if it had been killed in its studies
            file.seek(record(files[3])["places"]["studies/values_done"][0])
            file.write(struct.pack("<Q", 100))
        run = self.refused("2-of-3.h5: shard 2/3 cannot be used (it is damaged: its values of studies are damaged from number "
                           "0 on)", "merge", *files.values(), "--out", "whole.h5")
        self.assertIn("3-of-3.h5: shard 3/3 cannot be used (it is not finished: 100 of ", run.stderr)
        self.assertIn(" values of studies)", run.stderr)
        (self.folder / "starts").unlink()
        for command in run.stdout.splitlines():
            self.done(*shlex.split(command)[1:])
        self.assertLess(sum(starts(self.folder)), points * 2 // 3 + 64)  # the samples are not drawn again, nor the first values
        self.assertEqual(self.merged(files.values()), whole)

    def test_a_shard_whose_studies_are_stopped_goes_on(self):
        (self.folder / "counted.py").write_text(COUNTED_PROGRAM.replace("import", "import time,", 1) + "time.sleep(0.02)\n")
        scenario = self.scenario(STUDIES)
        files, _ = self.make(scenario, 2, numbers=[2])
        command = [GUMSHOE, "run", scenario, "--shard", "1/2", "--out", files[1], "--threads", "1"]
        stopped = subprocess.Popen(command, cwd=self.folder, env=SAME_DATE, stderr=subprocess.PIPE, text=True)
        done = 0
        while not done and stopped.poll() is None:
            time.sleep(0.02)
            if files[1].exists():
                with open(files[1], "rb") as file:
                    file.seek(record(files[1])["places"]["studies/values_done"][0])
                    done = struct.unpack("<Q", file.read(8))[0]
        stopped.send_signal(signal.SIGTERM)
        said = stopped.communicate(timeout=30)[1]
        self.assertEqual(stopped.returncode, 130, said)
        self.assertRegex(said, r"interrupted after 320 of 320 samples and \d+ of \d+ values of studies\.")
        self.assertIn("resuming after 320 samples", self.done(*command[1:]).stderr)
        self.assertEqual(self.merged(files.values()), self.single(scenario))

    def test_a_merge_goes_on_in_a_run_that_was_begun(self):
        scenario = self.scenario(FORMULA)
        files, _ = self.make(scenario, 3)
        whole = self.single(scenario)
        self.done("run", scenario, "--out", "whole.h5")
        reseal(self.folder / "whole.h5", complete=False)
        self.assertEqual(self.merged(files.values()), whole)

    def test_refusals_of_files(self):
        scenario = self.scenario(FORMULA)
        files, _ = self.make(scenario, 3)
        self.done("run", scenario, "--out", "single.h5")
        others = {"seed is 2, that of the others 1": ["run", scenario, "--seed", "2", "--shard", "1/3"],
                  "number of shards is 4, that of the others 3": ["run", scenario, "--shard", "1/4"],
                  "options is --samples 5000, that of the others none": ["run", scenario, "--samples", "5e3", "--shard", "1/3"],
                  "scenario is t.toml, hash": ["run", self.scenario(FORMULA + "# other\n", "t.toml"), "--shard", "1/3"]}
        for words, command in others.items():
            with self.subTest(words):
                self.done(*command, "--out", "other.h5", "--force")
                run = self.refused("other.h5: the shard belongs to another run", "merge", "other.h5", *files.values())
                self.assertIn(words, run.stderr)
                self.assertEqual(run.stdout, "")  # nothing is missing
        reseal(files[1], version="0.0.1")
        run = self.refused("its version is 0.0.1", "merge", *files.values())
        self.assertIn("--shard 1/3", run.stdout)
        for file in files.values():
            reseal(file, version="0.0.1")
        self.refused("the shards were made by Gumshoe 0.0.1", "merge", *files.values())
        files, _ = self.make(scenario, 3)
        self.refused("single.h5: the file is no shard", "merge", "single.h5", *files.values())
        os.truncate(files[3], files[3].stat().st_size // 2)
        run = self.refused("can be read (its end is missing", "merge", *files.values())
        self.assertIn("Remove it, and make the shard again.", run.stderr)
        self.assertIn("--shard 3/3", run.stdout)
        files, _ = self.make(scenario, 3)
        for other in (scenario, "/dev/null"):
            run = self.refused("no shard can be read", "merge", other)
            self.assertIn(f"{other}: the file is no shard (it is not an HDF5 file). Leave it out.", run.stderr)
        self.refused("none.h5: the file is no shard (the file does not exist). Check its name.", "merge", "none.h5")
        self.refused("this is the file that is read", "merge", *files.values(), "--out", files[2])
        for command in (["report", files[1]], ["analyse", files[1]], ["replay", files[1], "--sample", 0]):
            self.refused("the file holds a part of a run (shard 1/3)", *command)
        for file in files.values():
            reseal(file, design_hash="0" * 16)
        self.refused("the shards have another design", "merge", *files.values())
        self.scenario(FORMULA.replace("0.5", "0.4"))
        self.refused("not the scenario of these shards", "merge", *files.values())

    def test_a_number_of_samples_that_is_not_the_part_of_the_run(self):
        scenario = self.scenario(FORMULA)
        files, _ = self.make(scenario, 2)
        for file in files.values():
            reseal(file, options="--samples 5000")
        self.refused("another number of samples than its part", "merge", *files.values())

    def test_refusals_of_options(self):
        scenario = self.scenario(FORMULA)
        for text in ("0/4", "5/4", "3", "a/b", "1/-2", "1/2000000", "1/4x"):
            self.refused("is not a shard", "run", scenario, "--shard", text)
        self.refused("20001 samples are too few for 1000 shards", "run", scenario, "--shard", "1/1000")
        adaptive = self.scenario(SCENARIO + '[run]\nadaptive = { rule = "stein", digits = 1 }\n')
        self.refused("an adaptive run cannot be divided", "run", adaptive, "--shard", "1/4")
        self.refused("--shard excludes --format", "run", scenario, "--shard", "1/4", "--format", "json")

    def test_a_shard_that_its_scheduler_stops_goes_on(self):
        (self.folder / "slow.py").write_text(SLOW_PROGRAM)
        scenario = self.scenario(SLOW)
        files, _ = self.make(scenario, 2, numbers=[2])
        command = [GUMSHOE, "run", scenario, "--shard", "1/2", "--out", files[1], "--threads", "1"]
        stopped = subprocess.Popen(command, cwd=self.folder, env=SAME_DATE, stderr=subprocess.PIPE, text=True)
        while (not files[1].exists() or not samples_done(files[1])) and stopped.poll() is None:
            time.sleep(0.02)
        stopped.send_signal(signal.SIGTERM)
        said = stopped.communicate(timeout=30)[1]
        self.assertEqual(stopped.returncode, 130, said)
        self.assertLess(0, samples_done(files[1]))
        self.assertLess(samples_done(files[1]), record(files[1])["samples"])
        self.assertIn("resuming after", self.done(*command[1:]).stderr)
        self.assertEqual(self.merged(files.values()), self.single(scenario))

    def test_shards_of_computers_with_other_instruction_sets(self):
        scenario = self.scenario(SCENARIO + "[run]\nsamples = 5000\n")
        files, _ = self.make(scenario, 2, numbers=[1])
        gumshoe("run", scenario, "--shard", "2/2", "--out", files[2], cwd=self.folder, env={**SAME_DATE, "GUMSHOE_ISA": "sse2"})
        self.assertEqual(self.merged(files.values()), self.single(scenario))

    def test_the_scenario_may_lie_elsewhere(self):
        scenario = self.scenario(FORMULA)
        files, _ = self.make(scenario, 2)
        (self.folder / scenario).rename(self.folder / "moved.toml")
        run = self.gumshoe("merge", *files.values())
        self.assertEqual(run.returncode, 2)
        self.merged(files.values(), "--scenario", "moved.toml")


if __name__ == "__main__":
    unittest.main()
