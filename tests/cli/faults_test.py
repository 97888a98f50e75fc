"""Whatever fails under a command (a read, a write, a flush to the disk, a renaming, an allocation), it ends in its usual
bytes or in one clear message, leaves nothing half done that looks whole, and the same command again gives the usual bytes.

A preloaded library (tests/faults/faults.c) makes the n-th call fail, alone or with all that follow, or kills the process
there. Every n of each call is taken up to MOST; of more calls the first, the last and evenly spaced ones between them.
--every takes every n (minutes). Memory is limited as well (ulimit -v), from what the program needs to start to what the
command needs.

usage: faults_test.py path/to/gumshoe [--every] [unittest options]
"""
import concurrent.futures
import os
import pathlib
import resource
import sys
import tempfile
import unittest

from program import GUMSHOE, ROOT, complaint, gumshoe
from sealed import record

LIBRARY = pathlib.Path(GUMSHOE).parent / "tests/libgumshoe_faults.so"
EVERY = "--every" in sys.argv
if EVERY:
    sys.argv.remove("--every")
MOST = 9
WORKERS = 2

RUN = """schema = 1
[model]
name = "expression"
[model.measurands]
root = "sqrt(a)"
sum = "a + b"
[quantities]
a = { value = "1", u = "0.5" }
b = { value = "2", u = "0.1" }
[run]
samples = 4096
max_failed_share = 0.1
[analysis]
sensitivity = { sobol = 256 }
"""
CHOOSE = """schema = 1
[model]
name = "rod_gauging"
method = "virtual_experiment"
[indications.spindle_z]
components = [{ u = "0.9 um", per = "reading" }]
[quantities.rod_length]
value = "179.822 mm"
u = "1 um"
[choose]
measurand = "laser_z"
target = "10 um"
[choose.variables]
readings = [1, 2]
"""
LOAD_CELL = ROOT / "scenarios/trace_load_cell.toml"
# Name of a case: its command; what it reads, made by these commands; what it writes.
SHARDS = [["run", "s.toml", "--shard", f"{k}/2", "--out", f"{k}.h5"] for k in (1, 2)]
CASES = {
    "run": (["run", "s.toml", "--out", "out.h5", "--threads", 1], [], ["out.h5"]),
    "run --shard": (SHARDS[0], [], ["1.h5"]),
    "merge": (["merge", "1.h5", "2.h5", "--out", "out.h5", "--threads", 1], SHARDS, ["out.h5"]),
    "analyse": (["analyse", "r.h5", "--out", "out.h5", "--threads", 1],
                [["run", "s.toml", "--out", "r.h5"]], ["out.h5"]),
    "estimate": (["estimate", ROOT / "scenarios/gauge/gum_h3.toml", "--scenario-out", "out.toml", "--threads", 1], [],
                 ["out.toml"]),
    "trace": (["trace", LOAD_CELL, "--draws", 19, "--out", "out.h5", "--json", "out.json", "--threads", 1], [],
              ["out.h5", "out.json"]),
    "compensate": (["compensate", "trace_linear_axis.traced.toml", "--out", "out.csv"],
                   [["trace", ROOT / "scenarios/trace_linear_axis.toml", "--draws", 19, "--out", "t.h5"]], ["out.csv"]),
    "choose": (["choose", "c.toml", "--samples", 200, "--out", "out.h5", "--threads", 1], [], ["out.h5"]),
}


class Worker:
    """A folder of its own, because results name the place of their scenario, in which one call after the other fails."""

    def __init__(self, case, folder):
        self.words, preparations, self.outputs = CASES[case]
        self.folder = folder
        self.folder.mkdir()
        (folder / "s.toml").write_text(RUN)
        (folder / "c.toml").write_text(CHOOSE)
        for words in preparations:
            assert (made := self.gumshoe(words)).returncode == 0, made.stderr
        self.before = self.bytes()
        counts = folder.parent / f"{folder.name}.counts"
        run = self.gumshoe(self.words, LD_PRELOAD=str(LIBRARY), GUMSHOE_FAULT_COUNTS=str(counts))
        assert run.returncode == 0, run.stderr
        self.whole = self.bytes()
        self.counts = {call: int(n) for call, n in map(str.split, counts.read_text().splitlines())}

    def gumshoe(self, words, memory=None, **variables):
        limit = memory and (lambda: resource.setrlimit(resource.RLIMIT_AS, (memory, memory)))
        return gumshoe(*words, cwd=self.folder, env={**os.environ, "SOURCE_DATE_EPOCH": "0", **variables}, preexec_fn=limit)

    def enough(self, words):
        """Memory with which a command runs, to 64 KiB."""
        low, high = 0, 2**32
        while high - low > 2**16:
            middle = (low + high) // 2
            low, high = (low, middle) if self.gumshoe(words, middle).returncode == 0 else (middle, high)
        return high

    def bytes(self):
        return {path.name: path.read_bytes() for path in sorted(self.folder.iterdir())}

    def begin_again(self):
        for path in self.folder.iterdir():
            path.unlink()
        for name, content in self.before.items():
            (self.folder / name).write_bytes(content)

    def wrong(self, fault):
        """What is wrong where this call fails ("pwrite:3") or memory is limited ("memory:60000000 bytes"), or None."""
        self.begin_again()
        if fault.startswith("memory:"):
            run = self.gumshoe(self.words, int(fault[7:-6]))
        else:
            run = self.gumshoe(self.words, LD_PRELOAD=str(LIBRARY), GUMSHOE_FAULT=fault)
        left = self.bytes()
        if run.returncode == 0:
            return None if left == self.whole else f"exit code 0, and {self.difference(left)}"
        if run.returncode != (-9 if fault.endswith("!") else 2) or (run.returncode == 2 and complaint(run)):
            return f"exit code {run.returncode}, {complaint(run)}: {run.stderr[-300:]!r}"
        for output in self.outputs:
            if output in left and left[output] != self.whole[output] and self.looks_whole(self.folder / output):
                return f"{output} is not as it should be and looks whole, after {run.stderr!r}"
        again = self.gumshoe(self.words)
        if again.returncode != 0:
            return f"again: exit code {again.returncode}, {again.stderr!r}, after {run.stderr!r}"
        if (left := self.bytes()) != self.whole:
            return f"again: {self.difference(left)}, after {run.stderr!r}"

    @staticmethod
    def looks_whole(path):
        return path.suffix != ".h5" or record(path)["complete"]

    def difference(self, left):
        names = [name for name in sorted({*left, *self.whole}) if left.get(name) != self.whole.get(name)]
        return ", ".join(f"{name} {'is left' if name not in self.whole else 'differs' if name in left else 'is missing'}"
                         for name in names)


def chosen(count):
    """The calls that fail in turn, of so many."""
    if EVERY or count <= MOST:
        return range(1, count + 1)
    ends = MOST // 3
    return sorted({*range(1, ends + 1), *range(count - ends + 1, count + 1),
                   *(round(1 + k * (count - 1) / ends) for k in range(ends))})


@unittest.skipUnless(LIBRARY.exists(), "the library of faults is not built")
class Faults(unittest.TestCase):
    def case(self, name):
        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
            workers = list(pool.map(lambda k: Worker(name, pathlib.Path(folder) / str(k)), range(WORKERS)))
            counts = workers[0].counts
            self.assertGreater(counts["pwrite"] + counts["fwrite"], 0)
            faults = [f"{call}:{n}" for call, count in counts.items() for n in chosen(count)]
            # A disk that is full or broken stays so.
            faults += [f"{call}:{n}+" for call, count in counts.items() if call not in ("mmap", "malloc")
                       for n in list(chosen(count))[::3]]
            faults += [f"{call}:{n}!" for call, count in counts.items() if call not in ("mmap", "malloc")
                       for n in list(chosen(count))[::2]]
            # Where the system puts libraries and stack changes what a start needs, by some pages: before main() nothing can be said.
            start, needed = workers[0].enough(["--version"]) + 2**18, workers[0].enough(workers[0].words)
            faults += [f"memory:{start + k * (needed - start) // MOST} bytes" for k in range(MOST)]
            found = pool.map(lambda k: [(one, workers[k].wrong(one)) for one in faults[k::WORKERS]], range(WORKERS))
            wrong = [f"{one}: {what}" for part in found for one, what in part if what]
        self.assertEqual(wrong, [], f"{len(wrong)} of {len(faults)} faults:\n" + "\n".join(sorted(wrong)))


for case in CASES:
    setattr(Faults, "test_" + case.replace(" --", "_"), lambda self, case=case: self.case(case))


if __name__ == "__main__":
    unittest.main()
