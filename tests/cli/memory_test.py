"""Memory does not grow with the samples: peak of the resident set, as the kernel counts it.

usage: memory_test.py path/to/gumshoe [unittest options]
"""
import json
import os
import subprocess
import unittest

from program import GUMSHOE, InFolder

MiB = 1 << 20
SAMPLES = 8_000_000
LIMIT = 64 * MiB

# Two measurands at two readings, which some samples do not have: joint regions, an angle, a conformity test and a comparison.
SCENARIO = """schema = 1
[model]
name = "expression"
[model.measurands]
angle = "atan2(sqrt(a + x), b)"
root = "sqrt(a + x)"
[quantities]
a = { value = "0.3", u = "0.2" }
b = { value = "2", u = "0.1" }
[indications.x]
readings = { file = "x.csv", column = "x", unit = "1", labels = { side = "side" } }
[run]
samples = SAMPLES
max_failed_share = 0.1
store_samples = STORE
[[analysis.comparisons]]
measurand = "root"
between = "side"
[[analysis.conformity]]
measurand = "root"
lower = 0.1
"""


class Memory(InFolder):
    def peak(self, *words):
        """Bytes, and what it prints. Two threads, whatever the machine has: each has buffers of its own."""
        with open(self.folder / "out", "w+") as out, open(self.folder / "err", "w+") as err:
            child = subprocess.Popen([GUMSHOE, *map(str, words)], stdout=out, stderr=err)
            _, status, used = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0), err.seek(0)
            self.assertEqual(child.returncode, 0, err.read())
            return used.ru_maxrss * 1024, out.read()

    def scenario(self, store):
        (self.folder / "x.csv").write_text("side,x\nleft,0.1\nright,0.2\n")
        path = self.folder / "s.toml"
        path.write_text(SCENARIO.replace("SAMPLES", str(SAMPLES)).replace("STORE", store))
        return path

    def test_a_run_and_its_analysis_take_no_more_memory_than_a_short_one(self):
        """Four outputs are 256 MB of samples; held at once, one of them alone would exceed the limit."""
        self.assertGreater(8 * SAMPLES, 0.95 * LIMIT)
        result = self.folder / "r.h5"
        for store in ("false", "true"):
            with self.subTest(store_samples=store):
                used, said = self.peak("run", self.scenario(store), "--out", result, "--threads", 2, "--format", "json")
                self.assertLess(used, LIMIT)
                outputs = json.loads(said)
                self.assertGreater(outputs[0]["run"]["failed"], 0.001 * SAMPLES)
        again, _ = self.peak("analyse", result, "--out", self.folder / "again.h5", "--threads", 2)
        self.assertLess(again, LIMIT)

    def test_shards_are_merged_in_the_same_memory(self):
        scenario, shards = self.scenario("true"), [self.folder / f"{k}.h5" for k in (1, 2)]
        for k, shard in enumerate(shards, 1):
            used, _ = self.peak("run", scenario, "--shard", f"{k}/2", "--out", shard, "--threads", 2)
            self.assertLess(used, LIMIT)
        merged, _ = self.peak("merge", *shards, "--out", self.folder / "merged.h5", "--threads", 2)
        self.assertLess(merged, LIMIT)


if __name__ == "__main__":
    unittest.main()
