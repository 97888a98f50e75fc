"""`gumshoe run` and `replay`: the same bits however they are computed, interrupted or not; what a run says.

usage: run_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import os
import re
import signal
import subprocess
import time
import unittest

os.environ["HDF5_USE_FILE_LOCKING"] = "FALSE"  # to look at a file while it is written
import h5py
import numpy as np

from program import GUMSHOE, ROOT, SCENARIO, InOneFolder, complaint, gumshoe

RODS = ROOT / "scenarios/rod_gauging.toml"
LONG = 12_000_000  # samples: seconds of work, so that a signal arrives in the middle

EXACT = '[quantities.beam_pitch]\nvalue = "0.2836 deg"\n'
HEAD = 'schema = 1\n[model]\nname = "rod_gauging"\n'
# A pin of half the beam's radius covers at most 0.6090 of it: about half of the fractions drawn are out of reach.
PIN = HEAD + """[quantities.rod_radius]
value = "0.1 mm"
[quantities.fillet_radius]
value = "0 mm"
[quantities.trigger_fraction]
value = 0.609
u = 0.01
[indications.spindle_z]
readings = ["-329.932 mm"]
resolution = "1 um"
"""
MOST_COVERED = 2 / math.pi * (math.asin(0.5) + 0.5 * math.sqrt(0.75))
ROD2 = """[quantities.bottom_elevation]
value = "88.041 deg"
u = "0.002 deg"
[quantities.bottom_azimuth]
value = "144.086 deg"
[quantities.beam_yaw]
value = "0.6241 deg"
[quantities.beam_pitch]
value = "0.2836 deg"
u = "0.005 deg"
[indications.spindle_z]
resolution = "1 um"
"""
ROD2_HEIGHT = 0.111943  # mm, bottom_height at these values (evaluate_test.py)


def outputs(path, first=None):
    with h5py.File(path) as file:
        return {name: file["outputs"][name][..., :first] for name in ("bottom_height", "laser_z", "status")}


def attribute(path, name):
    with h5py.File(path) as file:
        return file.attrs[name]


class Run(InOneFolder):
    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def result(self, name, scenario, samples, *more, code=0, environment=None):
        path = self.folder / name
        run = gumshoe("run", scenario, "--samples", samples, "--out", path, "--force", *more, env={**os.environ, **(environment or {})})
        self.assertEqual(run.returncode, code, run.stderr)
        if code == 0:
            self.assertEqual(run.stderr, "")  # no progress where stderr is no terminal
        self.text = run.stdout
        self.complaint = run.stderr
        return path

    def same_bits(self, a, b):
        for name, values in a.items():
            self.assertEqual(values.tobytes(), b[name].tobytes(), name)

    # the same bits

    def test_threads(self):
        samples = 300_001  # several blocks and an odd end
        one = self.result("one.h5", RODS, samples, "--threads", 1)
        for threads in (2, 7):
            other = self.result("many.h5", RODS, samples, "--threads", threads)
            self.same_bits(outputs(one), outputs(other))
            with h5py.File(one) as a, h5py.File(other) as b:
                for name in ("estimate", "standard_uncertainty", "symmetric_low", "shortest_high"):
                    self.assertEqual(a["summary"][name][()].tobytes(), b["summary"][name][()].tobytes(), name)
                self.assertEqual(a["sensitivity/000/total"][()].tobytes(), b["sensitivity/000/total"][()].tobytes())

    def test_instruction_sets(self):
        plain = self.result("sse2.h5", RODS, 20011, environment={"GUMSHOE_ISA": "sse2"})
        self.assertEqual(attribute(plain, "instruction_set"), "sse2")
        pins = self.write("pins.toml", PIN)
        failing = self.result("sse2_pin.h5", pins, 20011, code=3, environment={"GUMSHOE_ISA": "sse2"})
        for wish in ("avx2", "avx512"):
            with self.subTest(wish):
                wide = self.result("wide.h5", RODS, 20011, environment={"GUMSHOE_ISA": wish})
                if attribute(wide, "instruction_set") != wish:
                    self.skipTest(f"no {wish} here")
                self.same_bits(outputs(plain), outputs(wide))
                self.same_bits(outputs(failing), outputs(self.result("wide_pin.h5", pins, 20011, code=3, environment={"GUMSHOE_ISA": wish})))

    def test_unknown_instruction_set(self):
        run = gumshoe("run", RODS, "--samples", 1000, "--out", self.folder / "never.h5", env={**os.environ, "GUMSHOE_ISA": "mmx"})
        self.assertIsNone(complaint(run), run.stderr)
        self.assertEqual(run.stdout, "")

    def test_first_samples_of_a_longer_run(self):
        long = self.result("long.h5", RODS, 200_003)
        for samples in (2, 7, 1003, 70_001):
            short = self.result("short.h5", RODS, samples)
            self.same_bits(outputs(short), outputs(long, samples))

    def test_seed(self):
        a, b = self.result("a.h5", RODS, 1000, "--seed", 2), self.result("b.h5", RODS, 1000, "--seed", 3)
        self.assertFalse(np.any(outputs(a)["laser_z"] == outputs(b)["laser_z"]))
        self.assertEqual(attribute(a, "seed"), 2)

    def test_another_effect_moves_no_other_draw(self):
        # An active reclamp adds exactly its own draw: streams are keyed by the quantity's name.
        plain = self.result("plain.h5", self.write("plain.toml", SCENARIO), 1000)
        more = self.result("more.h5", self.write("more.toml", SCENARIO + '[effects.reclamp]\nshift = { u = "1 um" }\n'), 1000)
        self.assertEqual(outputs(plain)["bottom_height"].tobytes(), outputs(more)["bottom_height"].tobytes())
        shift = (outputs(plain)["laser_z"] - outputs(more)["laser_z"]).ravel()
        self.assertLess(abs(np.std(shift) / 1e-6 - 1), 5 / math.sqrt(2 * 1000))

    # interrupted

    def signalled(self, path, number):
        """Starts a long run, sends the signal once the file says that samples are there."""
        process = subprocess.Popen([GUMSHOE, "run", RODS, "--samples", str(LONG), "--threads", "1", "--out", path],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 20
        while time.monotonic() < until and process.poll() is None:
            time.sleep(0.02)
            try:
                with h5py.File(path) as file:
                    if file["samples_done"][0] > 0:
                        break
            except OSError:
                continue  # not there yet
        self.assertIsNone(process.poll(), "finished before the signal: raise LONG")
        process.send_signal(number)
        out, err = process.communicate(timeout=30)
        return process.returncode, out, err

    def test_interrupted_runs_resume_to_the_same_bits(self):
        whole = self.result("whole.h5", RODS, LONG)
        for number, code in ((signal.SIGINT, 130), (signal.SIGKILL, -signal.SIGKILL)):
            with self.subTest(signal.Signals(number).name):
                path = self.folder / f"{number}.h5"
                ended, out, err = self.signalled(path, number)
                self.assertEqual((ended, out), (code, ""), err)
                with h5py.File(path) as file, h5py.File(whole) as reference:
                    done = int(file["samples_done"][0])
                    self.assertEqual(file.attrs["complete"], 0)
                    self.assertGreater(done, 0)
                    self.assertLess(done, LONG)
                    np.testing.assert_array_equal(file["outputs/laser_z"][0, :done], reference["outputs/laser_z"][0, :done])
                if number == signal.SIGINT:
                    self.assertIn(f"{done} of {LONG} samples", err)
                    self.assertIsNone(complaint(gumshoe("report", path)))  # not finished: no report
                run = gumshoe("run", RODS, "--samples", LONG, "--threads", 2, "--out", path)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertIn(f"resuming after {done} samples", run.stderr)
                self.same_bits(outputs(path), outputs(whole))
                with h5py.File(path) as file, h5py.File(whole) as reference:
                    self.assertEqual(file.attrs["complete"], 1)
                    for name in ("estimate", "standard_uncertainty", "shortest_low", "shortest_high"):
                        self.assertEqual(file["summary"][name][()].tobytes(), reference["summary"][name][()].tobytes(), name)
                path.unlink()

    # one sample again

    def replayed(self, path, sample):
        run = gumshoe("replay", path, "--sample", sample)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        last = run.stdout.split("\noutputs\n")[1]
        return run.stdout, [float(x) for x in re.findall(r"(\S+) mm$", last, re.M)], re.search(r"^status (\w+)$", last, re.M)[1]

    def test_replay_gives_the_stored_values(self):
        path = self.result("replay.h5", RODS, 100_000)
        stored = outputs(path)
        for sample in (0, 1, 63, 64, 12345, 65535, 65536, 99_999):
            with self.subTest(sample):
                text, values, status = self.replayed(path, sample)
                self.assertEqual(status, "ok")
                for value, name in zip(values, ("bottom_height", "laser_z"), strict=True):
                    # 17 digits lose nothing; m to mm and back rounds twice.
                    self.assertLess(abs(value / 1000 - stored[name][0, sample]), 4.5e-16 * abs(stored[name][0, sample]))
                for word in ("rod_radius", "reclamp.shift", "bottom_height", "intermediate values"):
                    self.assertIn(word, text)

    def test_replay_of_a_virtual_experiment_shows_its_intermediate_values(self):
        path = self.result("virtual.h5", self.write("virtual.toml", HEAD + 'method = "virtual_experiment"\n' + ROD2), 1000)
        text, values, _ = self.replayed(path, 17)
        self.assertLess(abs(values[1] / 1000 - outputs(path)["laser_z"][0, 17]), 1e-16)
        self.assertIn("intermediate values", text)

    # what is printed

    def test_json_and_csv(self):
        scenario = self.write("formats.toml", SCENARIO)
        path = self.result("formats.h5", scenario, 5000, "--format", "json")
        rows = json.loads(self.text, parse_constant=lambda name: self.fail(f"{name} is no JSON"))
        self.assertEqual([row["output"] for row in rows], ["bottom_height", "laser_z"])
        values = outputs(path)
        for row in rows:
            sample = 1000 * values[row["output"]].ravel()
            self.assertEqual((row["unit"], row["valid"], row["failed"]), ("mm", 5000, 0))
            self.assertAlmostEqual(row["estimate"], float(np.mean(sample)), delta=1e-9)
            self.assertAlmostEqual(row["standard_uncertainty"], float(np.std(sample, ddof=1)), delta=1e-9)
            for low, high in (row["symmetric"], row["shortest"]):
                self.assertLessEqual(abs(np.mean((sample >= low) & (sample <= high)) - 0.95), 2 / 5000)
        self.result("formats.h5", scenario, 5000, "--format", "csv")
        table = list(csv.DictReader(io.StringIO(self.text)))
        self.assertEqual([row["output"] for row in table], ["bottom_height", "laser_z"])
        for row, same in zip(table, rows):
            self.assertAlmostEqual(float(row["estimate"]), same["estimate"], delta=1e-12)
            self.assertAlmostEqual(float(row["shortest_high"]), same["shortest"][1], delta=1e-12)

    def test_comparisons_stand_with_both_of_their_outputs(self):
        """Labels of one value, 1, in both columns: a comparison is told by its outputs, not by the words in its name."""
        (self.folder / "x.csv").write_text("rod,setup,x\n1,1,0.1\n2,1,0.3\n1,2,0.6\n2,2,0.7\n")
        scenario = self.write("compared.toml", """schema = 1
[model]
name = "expression"
[model.measurands]
y = "x + a"
z = "x - a"
[quantities]
a = { value = 2, u = 1 }
[indications.x]
readings = { file = "x.csv", column = "x", unit = "1", labels = { rod = "rod", setup = "setup" } }
components = [ { u = 0.01, per = "reading" } ]
[analysis]
comparisons = [ { measurand = "y", between = "rod", within = "setup" }, { measurand = "y", between = "setup", within = "rod" } ]
printed = [ { measurand = "z", labels = { rod = "1", setup = "2" }, value = -1.5 } ]
""")
        self.result("compared.h5", scenario, 20_000, "--format", "json")
        rows = {row["output"]: row for row in json.loads(self.text)}
        name = lambda rod, setup: f"y[rod {rod}, setup {setup}]"
        read = {("1", "1"): 0.1, ("2", "1"): 0.3, ("1", "2"): 0.6, ("2", "2"): 0.7}
        for (rod, setup), x in read.items():
            found = {(c["a"], c["b"]): c for c in rows[name(rod, setup)]["comparisons"]}
            others = [name({"1": "2", "2": "1"}[rod], setup), name(rod, {"1": "2", "2": "1"}[setup])]
            self.assertEqual({frozenset(pair) for pair in found}, {frozenset((name(rod, setup), o)) for o in others})
            values = {name(*labels): value for labels, value in read.items()}
            for (a, b), c in found.items():  # the common input cancels: u = 0.01 sqrt(2), known to 1 / sqrt(2 n)
                u = 0.01 * math.sqrt(2)
                self.assertAlmostEqual(c["difference"], values[a] - values[b], delta=5 * u / math.sqrt(20_000))
                self.assertAlmostEqual(c["standard_uncertainty"], u, delta=5 * u / math.sqrt(2 * 20_000))
        for output, row in rows.items():
            self.assertEqual("comparisons" in row, output.startswith("y"), output)
            self.assertEqual("printed" in row, output == "z[rod 1, setup 2]", output)

    def test_too_many_failed_samples(self):
        samples = 20_000
        path = self.result("pin.h5", self.write("pin.toml", PIN), samples, code=3)
        self.assertRegex(self.complaint, r"error: \d+ of 20000 samples failed")
        status = outputs(path)["status"]
        with h5py.File(path) as file:
            never = int(file["outputs/status"].attrs["flag_values"][file["outputs/status"].attrs["flag_meanings"].split().index("never_covered")])
            self.assertEqual(file.attrs["complete"], 1)
            self.assertEqual(file.attrs["failed"], np.sum(status != 0))
            self.assertEqual(set(np.unique(status)), {0, never})
            for name in ("bottom_height", "laser_z"):
                np.testing.assert_array_equal(np.isnan(file["outputs"][name][0]), status != 0)
        # P(fraction > most) of a normal about 0.609 with u = 0.01; five standard deviations of a count.
        share = 0.5 * math.erfc((MOST_COVERED - 0.609) / 0.01 / math.sqrt(2))
        self.assertLess(abs(np.mean(status != 0) - share), 5 * math.sqrt(share * (1 - share) / samples))
        first = int(np.flatnonzero(status)[0])
        self.assertIn(f"never_covered: {np.sum(status != 0)} samples, the first is sample {first} ", self.text)
        text, values, said = self.replayed(path, first)
        self.assertEqual(said, "never_covered")
        self.assertTrue(all(map(math.isnan, values)))
        self.assertGreater(float(re.search(r"trigger_fraction +(\S+) 1$", text.split("\nreading")[1], re.M)[1]), MOST_COVERED)
        self.assertEqual(self.replayed(path, int(np.flatnonzero(status == 0)[0]))[2], "ok")

    def test_failed_samples_may_be_allowed(self):
        self.result("allowed.h5", self.write("allowed.toml", PIN + "[run]\nmax_failed_share = 0.6\n"), 2000)
        self.assertIn("never_covered", self.text)

    # what the numbers mean

    def test_virtual_experiment(self):
        # Conventional: laser_z = spindle_z - rod_length, the truth is bottom_height lower, so the error is +bottom_height.
        samples = 20_000
        for evaluation, error in (("full", 0.0), ("conventional", ROD2_HEIGHT)):
            with self.subTest(evaluation):
                text = HEAD + f'method = "virtual_experiment"\nevaluation = "{evaluation}"\n' + ROD2
                path = self.result(f"{evaluation}.h5", self.write(f"{evaluation}.toml", text), samples)
                self.assertEqual(attribute(path, "method"), "virtual_experiment")
                found = 1000 * outputs(path)["laser_z"].ravel()
                # u(pitch) moves the height by about 5 mm of radius times 0.005 deg; resolution is 0.29 um.
                u = math.hypot(5 * math.radians(0.005), 0.001 / math.sqrt(12))
                self.assertLess(abs(np.std(found) / u - 1), 0.1)
                # five standard errors, the last digit of the height, and second order below 1e-6 mm
                self.assertLess(abs(np.mean(found) - error), 5 * u / math.sqrt(samples) + 1.5e-6)
                self.assertIn("error of laser_z = ", self.text)
                self.assertNotIn("e-", self.text)

    def test_three_readouts_alone_have_no_standard_uncertainty(self):
        # Mean -329.931667, s = 2.517 um: t with 2 degrees of freedom, scale 1.453 um. All else is exact.
        text = HEAD + EXACT + '[indications.spindle_z]\nreadings = ["-329.932 mm", "-329.934 mm", "-329.929 mm"]\nresolution = "1 um"\nrepeatability = "readings"\n'
        samples, scale, t975 = 100_000, 0.0025166115 / math.sqrt(3), 4.302652730
        path = self.result("three.h5", self.write("three.toml", text), samples)
        line = next(line for line in self.text.splitlines() if line.startswith("laser_z = "))
        self.assertIn("without a standard uncertainty", line)
        self.assertRegex(line, r"95 % coverage interval is \[-\d+\.\d+, -\d+\.\d+\] mm")
        self.assertIn("2 degree", self.text)
        with h5py.File(path) as file:
            row = [name.decode() for name in file["summary/measurand"][()]].index("laser_z")
            self.assertTrue(np.isnan(file["summary/standard_uncertainty"][row]))
            low, high = 1000 * file["summary/symmetric_low"][row], 1000 * file["summary/symmetric_high"][row]
        # Density of t with 2 degrees of freedom at x is (2 + x^2)^-1.5; five standard errors of a quantile.
        tolerance = 5 * math.sqrt(0.025 * 0.975 / samples) * (2 + t975**2) ** 1.5 * scale
        self.assertLess(tolerance, t975 * scale / 5)
        laser_z = -329.931666667 - 150 - 0.024594  # bottom_height of a square rod with a fillet of 0.03 mm, evaluate_test.py
        self.assertAlmostEqual(low, laser_z - t975 * scale, delta=tolerance)
        self.assertAlmostEqual(high, laser_z + t975 * scale, delta=tolerance)
        self.result("three.h5", self.folder / "three.toml", 2000, "--format", "json")
        self.assertIsNone(next(r for r in json.loads(self.text) if r["output"] == "laser_z")["standard_uncertainty"])

    def test_readouts_alone_are_a_scenario(self):  # nothing but the readout is uncertain: u = step / sqrt(12)
        text = HEAD + '[indications.spindle_z]\nreadings = ["-329.932 mm"]\nresolution = "1 um"\n'
        for method, path in (("propagation", self.write("bare.toml", text)), ("virtual_experiment", self.write(
                "bare_virtual.toml", text.replace('"rod_gauging"\n', '"rod_gauging"\nmethod = "virtual_experiment"\n').replace('readings = ["-329.932 mm"]\n', "")))):
            with self.subTest(method):
                found = outputs(self.result("bare.h5", path, 2000))["laser_z"]
                # A rectangular variance has a relative standard error of sqrt(0.8 / n).
                self.assertLess(abs(np.std(found) / (1e-6 / math.sqrt(12)) - 1), 5 * math.sqrt(0.2 / 2000))

    def test_effective_degrees_of_freedom_of_one_component_are_its_own(self):
        # One Type A component with 2 degrees of freedom and nothing else: Welch-Satterthwaite gives 2, k = 4.30 (GUM G.4, Table G.2).
        text = HEAD + EXACT + '[indications.spindle_z]\nreadings = ["-329.932 mm", "-329.934 mm", "-329.929 mm"]\nresolution = "1 um"\nrepeatability = "readings"\n'
        self.result("dof.h5", self.write("dof.toml", text), 2000)
        found = re.search(r"^laser_z = .*GUM framework: U = (\S+) mm with k = (\S+) \((\d+) effective", self.text, re.M)
        self.assertIsNotNone(found, self.text)
        self.assertEqual((found[2], found[3]), ("4.30", "2"))
        self.assertAlmostEqual(float(found[1]), 4.3027 * 0.0014530, delta=5e-5)

    def test_square_rod_at_pitch_zero_has_no_gum_framework(self):
        # The height is R_r |tan(pitch)|: no derivative at 0, and the mean is biased by 5 mm u(pitch) sqrt(2/pi) = 0.70 um.
        text = (HEAD + '[quantities.fillet_radius]\nvalue = "0 mm"\n[quantities.beam_pitch]\nvalue = "0 deg"\nu = "0.01 deg"\n'
                + "[indications.spindle_z]" + SCENARIO.split("[indications.spindle_z]")[1])
        samples = 50_000
        path = self.result("kink.h5", self.write("kink.toml", text), samples)
        self.assertRegex(self.text, r"(?m)^GUM framework.*: not applicable \(.*beam_pitch.*\)")
        self.assertNotIn("U =", self.text)
        height = 1000 * outputs(path)["bottom_height"].ravel()
        u = 5 * math.radians(0.01)
        # The curved rim across the beam lowers the height by R_l^2 / (8 R_r^2) of itself: 2e-4.
        self.assertLess(abs(np.mean(height) - u * math.sqrt(2 / math.pi)), 5 * u * math.sqrt(1 - 2 / math.pi) / math.sqrt(samples) + 4e-4 * u)


if __name__ == "__main__":
    unittest.main()
