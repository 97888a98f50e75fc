"""A shared library as a model: the shipped example, the same model as a program, and every way a library can be bad.

usage: plugin_test.py path/to/gumshoe [unittest options]
"""
import csv
import json
import os
import re
import shutil
import subprocess
import unittest

os.environ["HDF5_USE_FILE_LOCKING"] = "FALSE"
import h5py
import numpy as np

from program import GUMSHOE, ROOT, InFolder, complaint, gumshoe, places

HEADER = ROOT / "engine/models/plugin"
CC = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")

# One plugin with a switch for each fault: cc -DFAULT_...
PLUGIN = r"""
#include "gumshoe_plugin.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#ifndef ABI
#define ABI GUMSHOE_PLUGIN_ABI
#endif
#ifndef QUANTITIES
#define QUANTITIES {"a", "mm", "one", 10, 0, 100}, {"b", "1", "other", 2, 0, 0}
#endif
#ifndef MEASURANDS
#define MEASURANDS {"y", "mm", "product", 0, 0, 0}
#endif
#ifndef CONDITIONS
#define CONDITIONS {"feed", "mm/min", "", 60, 0, 0}
#endif
#ifndef FAULT
#define FAULT
#endif
#ifndef THREADS
#define THREADS 1
#endif
static const gumshoe_variable q[] = {QUANTITIES}, m[] = {MEASURANDS}, c[] = {CONDITIONS}, x[] = {{"r", "mm", "", 0, 0, 0}};
static double at(const gumshoe_column* k, size_t i) { return k->data[i * k->stride]; }
static int overflow(volatile char* p) { volatile char big[4096]; big[0] = *p; return overflow(big) + big[0]; }
static int broken(const gumshoe_batch* b) { return b->samples > 100 && access("broken", F_OK) == 0; }
static volatile int inside, zero;
static int evaluate(const gumshoe_batch* b) {
  (void)overflow; (void)broken; (void)zero;
  if (THREADS == 0) { if (__sync_fetch_and_add(&inside, 1) != 0) { strcpy(b->error, "called twice at once"); return 5; } usleep(1000); }
  FAULT
  for (size_t i = 0; i < b->samples; ++i)
    b->measurands[0][i] = at(&b->quantities[0], i) * at(&b->quantities[1], i) + at(&b->indications[0], i) + 0 * at(&b->conditions[0], i);
  if (THREADS == 0) __sync_fetch_and_sub(&inside, 1);
  return 0;
}
#ifdef SIMULATE
static int simulate(const gumshoe_batch* b) {
  for (size_t i = 0; i < b->samples; ++i) {
    b->measurands[0][i] = 25;
    b->simulated[0][i] = 25 - at(&b->quantities[0], i) * at(&b->quantities[1], i);
  }
  return 0;
}
#else
#define simulate 0
#endif
#ifndef NAME
#define NAME gumshoe_plugin
#endif
static const gumshoe_model model = {ABI, THREADS, "mine", "Mine", 0, 0, q, sizeof q / sizeof *q, c, sizeof c / sizeof *c,
  x, 1, m, sizeof m / sizeof *m, evaluate, simulate};
GUMSHOE_EXPORT const gumshoe_model* NAME(void) { return &model; }
"""
SCENARIO = """schema = 1
[model]
name = "plugin"
library = "libmine.so"
[quantities.a]
value = "10 mm"
u = "1 um"
[quantities.b]
value = 2
u = 1e-3
[indications.r]
readings = ["5 mm"]
resolution = "1 um"
[run]
samples = 20_000
seed = 3
"""
PLACE = (4, 11)


class Plugin(InFolder):
    def setUp(self):
        super().setUp()
        self.scenario = self.folder / "s.toml"
        self.scenario.write_text(SCENARIO)

    def build(self, *switches, code=PLUGIN):
        source = self.folder / "mine.c"
        source.write_text(code)
        (self.folder / "libmine.so").unlink(missing_ok=True)
        subprocess.run([CC, "-std=gnu99", "-O1", "-shared", "-fPIC", "-ffp-contract=off", f"-I{HEADER}", *switches, str(source),
                        "-o", str(self.folder / "libmine.so")], check=True)

    def run_it(self, name="r.h5", *more):
        return gumshoe("run", self.scenario, "--out", self.folder / name, *more, cwd=self.folder)

    def values(self, name="r.h5", output="y"):
        with h5py.File(self.folder / name) as file:
            return file["outputs"][output][0], file["outputs/status"][()]

    def refused(self, run, *words, place=PLACE):
        self.assertIsNone(complaint(run), run.stderr)
        self.assertEqual(set(places(run, self.scenario)), {place}, run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)

    def test_numbers_threads_replay(self):
        self.build()
        bits = set()
        for threads in (1, 2, 5):
            run = self.run_it(f"{threads}.h5", "--threads", threads)
            self.assertEqual(run.returncode, 0, run.stderr)
            bits.add(self.values(f"{threads}.h5")[0].tobytes())
        self.assertEqual(len(bits), 1)
        y = self.values("1.h5")[0]
        # y = a b + r: u^2 = (2 x 1 um)^2 + (10 mm x 1e-3)^2 + (1 um)^2 / 12
        u = np.sqrt(4 + 100 + 1 / 12) * 1e-6
        self.assertLess(abs(y.mean() - 25e-3), 4 * u / np.sqrt(20000))
        self.assertLess(abs(y.std() / u - 1), 4 / np.sqrt(40000))
        with h5py.File(self.folder / "1.h5") as file:
            # exact but for rounding: y = 25e-3 to 3e-18, over steps of 0.5e-6
            self.assertAlmostEqual(float(file["budget/000"].attrs["combined_standard_uncertainty"]) / u, 1, delta=1e-10)
        self.assertIn("are differences over a standard uncertainty", run.stdout)
        replay = gumshoe("replay", self.folder / "1.h5", "--sample", 12345)
        self.assertEqual(replay.returncode, 0, replay.stderr)
        shown = re.search(r"outputs\n  y +(\S+) mm", replay.stdout)
        self.assertEqual(float(shown[1]) / 1000, y[12345])
        check = gumshoe("check", self.scenario, "--explain")
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn("model mine", check.stdout)
        self.assertIn("feed 0.001 m/s (60 mm/min)", check.stdout)
        report = gumshoe("report", self.folder / "1.h5", "--out", self.folder / "report.html")
        self.assertEqual(report.returncode, 0, report.stderr)

    def test_what_it_prints_goes_to_standard_error(self):
        loading = PLUGIN + '__attribute__((constructor)) static void loaded(void) { printf("loaded\\n"); }\n'
        self.build('-DFAULT=printf("printed\\n"); (void)!write(1, "written\\n", 8);', code=loading)
        for threads in (1, 3):
            for form in ("json", "csv"):
                with self.subTest(form, threads=threads):
                    run = self.run_it("r.h5", "--threads", threads, "--format", form, "--force")
                    self.assertEqual(run.returncode, 0, run.stderr)
                    for word in ("loaded", "printed", "written"):
                        self.assertNotIn(word, run.stdout)
                        self.assertIn(word, run.stderr)
                    if form == "json":
                        self.assertEqual(len(json.loads(run.stdout)), 1)
                    else:
                        self.assertEqual(len(list(csv.DictReader(run.stdout.splitlines()))), 1)
        with open("/dev/full", "w") as full:  # a full standard error is no error of the command
            run = subprocess.run([GUMSHOE, "run", self.scenario, "--out", self.folder / "f.h5", "--format", "json"], stderr=full,
                                 stdout=subprocess.PIPE, text=True)
        self.assertEqual((run.returncode, len(json.loads(run.stdout))), (0, 1))

    def test_a_plugin_that_wants_one_call_at_a_time(self):
        self.build("-DTHREADS=0")
        run = self.run_it("r.h5", "--threads", 4)
        self.assertEqual(run.returncode, 0, run.stderr)
        # the test can fail: the same plugin, when it claims to bear several threads
        self.build("-DTHREADS=0")
        code = PLUGIN.replace("{ABI, THREADS,", "{ABI, 1,")
        self.build("-DTHREADS=0", code=code)
        self.refused(self.run_it("bad.h5", "--threads", 4), "called twice at once")

    def test_fast_math_does_not_reach_us(self):
        # -ffast-math libraries switch denormal numbers off for the thread that loads them.
        text = SCENARIO.replace('u = "1 um"', 'u = "1e-309 m"').replace('value = "10 mm"', 'value = "0 mm"')
        self.scenario.write_text(text.replace('["5 mm"]\nresolution = "1 um"', '["0 mm"]').replace("0, 100", "0, 0"))
        results = []
        for flags in ((), ("-ffast-math", "-O0")):
            self.build("-DQUANTITIES={\"a\", \"mm\", 0, 0, 0, 0}, {\"b\", \"1\", 0, 2, 0, 0}", *flags)
            run = self.run_it("r.h5", "--threads", 1)
            self.assertEqual(run.returncode, 0, run.stderr)
            results.append(self.values()[0])
        self.assertGreater((np.abs(results[0]) > 0).mean(), 0.99)
        self.assertLess(np.abs(results[0]).max(), 2.3e-308)
        self.assertEqual(results[0].tobytes(), results[1].tobytes())

    def test_virtual_experiment(self):
        text = SCENARIO.replace('name = "plugin"', 'name = "plugin"\nmethod = "virtual_experiment"').replace('readings = ["5 mm"]\n', "")
        self.scenario.write_text(text)
        self.build("-DSIMULATE")
        run = self.run_it()
        self.assertEqual(run.returncode, 0, run.stderr)
        error = self.values()[0]  # of y: a0 b0 - a b + noise
        u = np.sqrt(4 + 100 + 1 / 12) * 1e-6
        self.assertLess(abs(error.std() / u - 1), 4 / np.sqrt(40000))
        self.assertLess(abs(error.mean()), 4 * u / np.sqrt(20000))
        self.build()
        self.refused(self.run_it("never.h5"), "does not simulate the readings", place=(2, 1))

    def test_failed_samples(self):
        for fault in ("for (size_t i = 0; i < b->samples; ++i) b->failed[i] = at(&b->quantities[1], i) > 2.002;",
                      "FAULT_NAN"):
            code = PLUGIN if fault != "FAULT_NAN" else PLUGIN.replace(
                "if (THREADS == 0) __sync_fetch_and_sub", "for (size_t i = 0; i < b->samples; ++i) if (at(&b->quantities[1], i) > 2.002) b->measurands[0][i] = 1 / 0.0;\n  if (THREADS == 0) __sync_fetch_and_sub")
            self.build(f"-DFAULT={fault if fault != 'FAULT_NAN' else ''}", code=code)
            run = self.run_it()
            self.assertEqual(run.returncode, 3, run.stderr)
            values, status = self.values()
            self.assertEqual(set(status), {0, 6})
            self.assertLess(abs((status == 6).mean() - 0.02275), 4 * np.sqrt(0.0223 / 20000))
            self.assertTrue(np.isnan(values[status == 6]).all() and np.isfinite(values[status == 0]).all())

    def test_bad_libraries(self):
        cases = [
            (["-DABI=2"], ["version 2 of the plugin interface", "this program uses version 1"]),
            (["-DNAME=other"], ["is not a plugin (it does not export a function gumshoe_plugin)"]),
            (["-DMEASURANDS={\"y\", \"foo\", 0, 0, 0, 0}"], ["y: 'foo' is not a unit"]),
            (['-DQUANTITIES={"a", "mm", 0, 0, 0, 0}, {"a", "mm", 0, 0, 0, 0}'], ["the name 'a' is used twice"]),
            (['-DQUANTITIES={"a", "mm", 0, 0, 0, 0}, {"feed", "1", 0, 0, 0, 0}'], ["the name 'feed' is used twice"]),
            (['-DQUANTITIES={"a b", "mm", 0, 0, 0, 0}, {0, "1", 0, 0, 0, 0}'], ["number 1 of its quantities has no valid name", "number 2"]),
            (['-DQUANTITIES={"a", "mm", 0, 7, 1, 2}, {"b", "1", 0, 0, 2, 1}'], ["default is outside", "its lower limit exceeds its upper limit"]),
            (['-DQUANTITIES={"a", "mm", 0, NAN, 0, 0}, {"b", "1", 0, 0, 0, 0}'], ["default is not finite"]),
            (["-DFAULT=static double calls; for (size_t i = 0; i < b->samples; ++i) b->measurands[0][i] = ++calls; return 0;"],
             ["gives different results at the same point (y is 2 mm, then 3 mm"]),
            (["-DFAULT=return 3;"], ["failed at a point outside the run", "returned 3"]),
            (["-DFAULT=snprintf(b->error, b->error_size, \"no table\"); return 1;"], ["(no table)"]),
            (["-DFAULT=*(volatile int*)8 = 1;"], ["crashed outside the run", "SIGSEGV"]),
            (["-DFAULT=abort();"], ["crashed outside the run", "SIGABRT"]),
            (["-DFAULT=zero = 7 / zero;"], ["crashed outside the run", "SIGFPE"]),
            (["-DFAULT=char z = 1; overflow(&z);", "-O0"], ["crashed outside the run", "SIGSEGV"]),
            (["-DFAULT=exit(0);"], ["crashed outside the run", "called exit()"]),
        ]
        for switches, words in cases:
            with self.subTest(words):
                self.build(*switches)
                self.refused(gumshoe("check", self.scenario), "'libmine.so'", *words)

    def test_no_measurands_and_null(self):
        self.build(code=PLUGIN.replace("m, sizeof m / sizeof *m", "m, 0"))
        self.refused(gumshoe("check", self.scenario), "no measurands")
        self.build(code=PLUGIN.replace('"mine"', '"my model"'))
        self.refused(gumshoe("check", self.scenario), "it has no valid name", "Correct the plugin's description.")
        self.build(code=PLUGIN.replace("return &model;", "return 0;"))
        self.refused(gumshoe("check", self.scenario), "returns null")
        self.build(code=PLUGIN.replace(", evaluate, simulate}", ", 0, simulate}"))
        self.refused(gumshoe("check", self.scenario), "no evaluate")

    @unittest.skipUnless(shutil.which("c++"), "no C++ compiler")
    def test_an_exception_does_not_cross_the_interface(self):
        source = self.folder / "mine.cpp"
        source.write_text("""
#include "gumshoe_plugin.h"
static int evaluate(const gumshoe_batch*) { throw 1; }
static const gumshoe_variable q{"a", "mm", "", 10, 0, 100}, m{"y", "mm", "", 0, 0, 0};
static const gumshoe_model model{GUMSHOE_PLUGIN_ABI, 1, "mine", "", "", "", &q, 1, 0, 0, 0, 0, &m, 1, evaluate, 0};
extern "C" GUMSHOE_EXPORT const gumshoe_model* gumshoe_plugin(void) { return &model; }
""")
        subprocess.run(["c++", "-shared", "-fPIC", f"-I{HEADER}", str(source), "-o", str(self.folder / "libmine.so")],
                       check=True)
        self.scenario.write_text(SCENARIO[:SCENARIO.index("[quantities.b]")])
        self.refused(gumshoe("check", self.scenario), "threw an exception at a point outside the run",
                     "Return a code and a text instead.")

    def test_no_library(self):
        library = self.folder / "libmine.so"
        self.refused(gumshoe("check", self.scenario), "does not exist", "Build it")
        library.mkdir()
        self.refused(gumshoe("check", self.scenario), "is a directory")
        library.rmdir()
        for data in (b"", b"int main() {}", os.urandom(5000)):
            library.write_bytes(data)
            self.refused(gumshoe("check", self.scenario), "cannot be loaded as a library")
        self.build("-DFAULT=extern void nowhere(void); nowhere();")
        self.refused(gumshoe("check", self.scenario), "cannot be loaded as a library", "nowhere")
        self.scenario.write_text(SCENARIO.replace('library = "libmine.so"\n', ""))
        self.refused(gumshoe("check", self.scenario), "library", place=(2, 1))
        self.scenario.write_text(SCENARIO.replace('"libmine.so"', "5"))
        self.refused(gumshoe("check", self.scenario), "model.library", place=PLACE)

    def test_crash_late_and_resume(self):
        # Crashes beyond the third block of a run while the file `broken` is there; slowly, so that blocks reach the file.
        switch = "-DFAULT=static volatile int calls; if (broken(b) && ++calls > 3) { sleep(1); *(volatile int*)8 = 1; } if (broken(b)) usleep(300000);"
        self.build(switch)
        self.assertEqual(self.run_it("whole.h5").returncode, 0)
        (self.folder / "broken").touch()
        run = self.run_it("r.h5", "--threads", 1)
        self.refused(run, "crashed at samples 6144 to 8191", "SIGSEGV", "are kept")
        with h5py.File(self.folder / "r.h5") as file:
            done = int(np.ravel(file["samples_done"][()])[0])
        self.assertIn(done, (2048, 4096, 6144))  # the marker is set every quarter of a second
        (self.folder / "broken").unlink()
        again = self.run_it("r.h5")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn(f"resuming after {done} samples", again.stderr)
        self.assertEqual(self.values("r.h5")[0].tobytes(), self.values("whole.h5")[0].tobytes())

    def test_refusal_late_keeps_what_was_done(self):
        self.build("-DFAULT=static volatile int calls; if (broken(b) && ++calls > 3) { strcpy(b->error, \"licence\"); return 1; }")
        (self.folder / "broken").touch()
        run = self.run_it("r.h5", "--threads", 1)
        self.refused(run, "failed at samples 6144 to 8191", "(licence)", "6144 of 20000 samples are kept")

    def test_another_library_is_another_model(self):
        self.build()
        self.assertEqual(self.run_it().returncode, 0)
        self.build("-DQUANTITIES={\"a\", \"mm\", \"one\", 11, 0, 100}, {\"b\", \"1\", \"other\", 2, 0, 0}")
        replay = gumshoe("replay", self.folder / "r.h5", "--sample", 1)
        self.assertIsNone(complaint(replay), replay.stderr)
        self.assertIn("has changed since this result", replay.stderr)

    def test_shipped_example_and_the_same_as_a_program(self):
        shutil.copytree(ROOT / "scenarios/plugin", self.folder / "plugin", ignore=shutil.ignore_patterns("build"))
        shutil.copytree(ROOT / "scenarios/command", self.folder / "command")
        build = self.folder / "plugin/build"
        if shutil.which("cmake"):
            options = ["-G", "Ninja", "-S", str(self.folder / "plugin"), "-B", str(build), f"-DGUMSHOE_PLUGIN_HEADER={HEADER}"]
            subprocess.run(["cmake", *options], check=True, stdout=subprocess.DEVNULL)
            subprocess.run(["cmake", "--build", str(build)], check=True, stdout=subprocess.DEVNULL)
        else:
            build.mkdir()
            subprocess.run([CC, "-std=c99", "-O2", "-shared", "-fPIC", "-ffp-contract=off", f"-I{HEADER}", "-o",
                            str(build / "libsphere_density.so"), str(self.folder / "plugin/sphere_density.c")], check=True)
        for kind in ("plugin", "command"):
            run = gumshoe("run", self.folder / kind / "sphere_density.toml", "--samples", 20000, "--out", self.folder / f"{kind}.h5")
            self.assertEqual(run.returncode, 0, run.stderr)
        for output in ("density", "volume"):
            plugin, command = self.values("plugin.h5", output)[0], self.values("command.h5", output)[0]
            np.testing.assert_allclose(plugin, command, rtol=1e-15, atol=0)
        # pi / 6 x (25.4 mm)^3; u of its cube is three times that of the diameter
        volume, _ = self.values("plugin.h5", "volume")
        self.assertAlmostEqual(volume.mean() / (np.pi / 6 * 0.0254**3), 1, delta=4 * 3 * 1e-6 / 25.4e-3 / np.sqrt(20000) + 1e-8)


if __name__ == "__main__":
    unittest.main()
