"""Damaged results: every changed byte is noticed, and a resumed run takes no sample that is not as it was written.

usage: damage_test.py path/to/gumshoe [unittest options]
"""
import json
import os
import random
import shutil
import signal
import subprocess
import time
import unittest

import h5py
import numpy as np

from program import GUMSHOE, ROOT, SCENARIO, InFolder, complaint, gumshoe
from sealed import record, reseal
from slow_model import SAMPLES, SLOW, SLOW_PROGRAM


def put(path, at, data):
    """Writes the bytes at this place."""
    with open(path, "r+b") as file:
        file.seek(at)
        file.write(data)


def change(path, at, flipped=1):
    with open(path, "r+b") as file:
        file.seek(at)
        byte = file.read(1)[0]
        file.seek(at)
        file.write(bytes([byte ^ flipped]))


def figures(run):
    """What a run printed, but for its file, date and duration."""
    return [{key: value for key, value in output.items() if key != "run"} for output in json.loads(run.stdout)]


class Damage(InFolder):
    def complete(self, *words):
        scenario = self.folder / "rod.toml"
        scenario.write_text(SCENARIO)
        path = self.folder / "rod.h5"
        run = gumshoe("run", scenario, "--samples", 3000, "--out", path, *words)
        self.assertEqual(run.returncode, 0, run.stderr)
        return path

    def test_every_changed_byte_is_noticed(self):
        whole = self.complete()
        said, size, chance = record(whole), whole.stat().st_size, random.Random(1)
        places = {name: place for name, place in said["places"].items() if name != "samples_done"}
        wanted = [chance.randrange(size) for _ in range(30)] + [0, 9, size - 1, size - 49, size - 30]
        wanted += [offset + chance.randrange(length) for offset, length in places.values()]
        with h5py.File(whole) as file:  # a figure that would be shown, and the heap that holds the texts
            wanted += [file["summary/estimate"].id.get_offset(), whole.read_bytes().find(b"GCOL") + 16]
        for at in wanted:
            with self.subTest(at):
                path = shutil.copy(whole, self.folder / "damaged.h5")
                change(path, at, 1 << chance.randrange(8))
                for words in (["replay", path, "--sample", 3], ["report", path], ["analyse", path]):
                    run = gumshoe(*words)
                    self.assertIsNone(complaint(run), f"{words[0]}: {run.stdout[:200]} {run.stderr}")
                    self.assertIn("damaged.h5", run.stderr)
                    self.assertRegex(run.stderr, "damaged|missing|is not an HDF5 file|another program")
                again = gumshoe("run", self.folder / "rod.toml", "--samples", 3000, "--out", path)
                self.assertIn(again.returncode, (0, 2), again.stderr)
                if again.returncode == 0:
                    with h5py.File(path) as a, h5py.File(whole) as b:
                        np.testing.assert_array_equal(a["outputs/laser_z"][()], b["outputs/laser_z"][()])

    def test_results_are_compared_and_combined_only_if_their_samples_are_sound(self):
        whole = self.complete()
        (self.folder / "other.toml").write_text(SCENARIO.replace('u = "1 um"', 'u = "2 um"'))
        other = self.folder / "other.h5"
        self.assertEqual(gumshoe("run", self.folder / "other.toml", "--samples", 3000, "--out", other).returncode, 0)
        damaged = shutil.copy(whole, self.folder / "damaged.h5")
        with h5py.File(whole) as file:
            change(damaged, file["outputs/laser_z"].id.get_offset() + 8 * 1234 + 5, 4)
        for command in (["compare"], ["compare", "--same", "beam_pitch"], ["combine"]):
            for results in ([damaged, other], [other, damaged]):
                with self.subTest(command, first=results[0].name):
                    run = gumshoe(*command, *results)
                    self.assertIsNone(complaint(run), run.stdout)
                    self.assertIn("damaged.h5' is damaged (its samples are damaged from number 0 on)", run.stderr)
            self.assertEqual(gumshoe(*command, whole, other).returncode, 0)

    def test_a_changed_marker_is_noticed(self):
        path = self.complete()
        change(path, record(path)["places"]["samples_done"][0] + 7, 64)
        self.assertIn("the progress marker is damaged", gumshoe("replay", path, "--sample", 3).stderr)

    def test_the_generator_alone_notices_too(self):
        whole = self.complete()
        for at, words in ((whole.stat().st_size // 2, "damaged|not those that were written"), (None, "truncated"), (0, "HDF5")):
            path = shutil.copy(whole, self.folder / "damaged.h5")
            with h5py.File(whole) as file:
                at = file["summary/estimate"].id.get_offset() if at else at
            os.truncate(path, 5000) if at is None else change(path, at)
            run = subprocess.run(["/usr/bin/python3", ROOT / "reports/report.py", path], capture_output=True, text=True)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertRegex(run.stderr, words)

    def test_the_damage_is_named(self):
        whole = self.complete()
        for at, words in ((record(whole)["places"]["outputs/laser_z"][0] + 8 * 2100, "its samples are damaged from number 2048"),
                          (whole.read_bytes().find(b"GCOL") + 16, "is not a Gumshoe result that can be read (it is damaged")):
            path = shutil.copy(whole, self.folder / "damaged.h5")
            change(path, at)
            self.assertIn(words, gumshoe("replay", path, "--sample", 3).stderr)

    def test_changes_by_another_program_are_noticed(self):
        path = self.complete()
        with h5py.File(path, "r+") as file:
            file["summary/estimate"][0] = 1
        for words in (["replay", path, "--sample", 3], ["report", path], ["analyse", path]):
            run = gumshoe(*words)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertIn("changed by another program", run.stderr)

    def test_records_that_say_impossible_things(self):
        whole = self.complete()
        places = record(whole)["places"]
        for words, fields in (("another format version", {"format_version": 3}),
                              ("record at its end is damaged", {"places": {**places, "digests": [2**63, 2**62]}}),
                              ("record at its end is damaged", {"seed": "seven"}),
                              ("not those that were written", {"digest": 1}),
                              ("progress marker is damaged", {"samples": 2**61}), ("contradicts itself", {"rows": [["laser_z", 1000]]}),
                              ("holds no samples", {"rows": [["weight", 0]]}), ("it has no progress marker", {"places": {}})):
            with self.subTest(words, fields=list(fields)):
                path = shutil.copy(whole, self.folder / "odd.h5")
                reseal(path, **fields)
                run = gumshoe("replay", path, "--sample", 3)
                self.assertIsNone(complaint(run), run.stderr)
                self.assertIn(words, run.stderr)

    # resuming

    def interrupted(self, name, number=signal.SIGKILL, more=""):
        """An unfinished run of a few blocks."""
        (self.folder / "s.toml").write_text(SLOW + more)
        (self.folder / "slow.py").write_text(SLOW_PROGRAM)
        path = self.folder / name
        run = subprocess.Popen([GUMSHOE, "run", "s.toml", "--threads", "2", "--out", name], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 60
        while time.monotonic() < until and run.poll() is None:
            time.sleep(0.02)
            if path.exists() and self.done(path) >= 4 * 2048:
                break
        self.assertIsNone(run.poll())
        run.send_signal(number)
        said = run.communicate(timeout=60)[1]
        self.assertLess(self.done(path), SAMPLES)
        return path, said

    def done(self, path):
        with h5py.File(path, locking=False) as file:
            return int(file["samples_done"][0])

    def resumed(self, path):
        run = gumshoe("run", "s.toml", "--threads", "2", "--out", path, "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run

    def test_what_was_not_written_or_is_damaged_is_drawn_again(self):
        path, _ = self.interrupted("killed.h5")
        places, done = record(path)["places"], self.done(path)
        values, status, digests, marker = (places[n][0] for n in ("outputs/y", "outputs/status", "digests", "samples_done"))
        raised = min(SAMPLES, done + 8192).to_bytes(8, "little")
        whole = self.resumed("whole.h5")
        for name, damage in (("marker", lambda p: put(p, marker, raised)), ("first", lambda p: change(p, values)),
                             ("later", lambda p: change(p, values + 8 * 5000 + 6, 0x10)),
                             ("status", lambda p: change(p, status + 3000)), ("digest", lambda p: change(p, digests + 8)),
                             ("nothing", lambda p: None)):
            with self.subTest(name):
                damaged = shutil.copy(path, self.folder / f"{name}.h5")
                damage(damaged)
                first = {"marker": done, "first": 0, "later": 4096, "status": 2048, "digest": 0, "nothing": done}[name]
                run = self.resumed(damaged)
                self.assertEqual("are as they were written" in run.stderr, name != "nothing", run.stderr)
                self.assertEqual(f"resuming after {first} samples" in run.stderr, first > 0, run.stderr)
                self.assertEqual(figures(run), figures(whole))
                with h5py.File(damaged) as a, h5py.File(self.folder / "whole.h5") as b:
                    self.assertEqual(a["outputs/y"][()].tobytes(), b["outputs/y"][()].tobytes())

    def test_a_run_without_stored_samples_resumes(self):
        path, said = self.interrupted("s.h5", signal.SIGINT, "store_samples = false\n")
        done = self.done(path)
        self.assertIn("Repeat the command to resume", said)
        run = self.resumed(path)
        self.assertIn(f"resuming after {done} samples", run.stderr)
        with h5py.File(path) as file:
            self.assertNotIn("outputs", file)
            self.assertEqual((int(file["samples_done"][0]), int(file.attrs["complete"])), (SAMPLES, 1))
        self.assertLess(path.stat().st_size, 8 * SAMPLES)
        (self.folder / "s.toml").write_text(SLOW)
        self.assertEqual(figures(self.resumed("stored.h5")), figures(run))

    def test_storing_no_samples_takes_no_more_memory(self):
        formula = ('schema = 1\n[model]\nname = "expression"\n[model.measurands]\ny = "a"\n[quantities]\n'
                   'a = { value = "1 mm", u = "1 um" }\n[run]\nsamples = 5000000\nstore_samples = ')
        peak = {}
        for keep in ("true", "false"):
            (self.folder / "m.toml").write_text(formula + keep + "\n")
            process = subprocess.Popen([GUMSHOE, "run", "m.toml", "--threads", "2", "--out", f"{keep}.h5"], cwd=self.folder,
                                       stdout=subprocess.DEVNULL)
            _, status, usage = os.wait4(process.pid, 0)
            self.assertEqual(status, 0)
            peak[keep] = usage.ru_maxrss / 1024  # MiB
        self.assertLess(peak["false"], peak["true"] + 10)  # samples are 38 MiB; scratch of threads varies by a few


if __name__ == "__main__":
    unittest.main()
