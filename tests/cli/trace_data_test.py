"""Shipped scenarios that trace measured data, and the cone scanned in two set-ups: data, formulas and verdicts.

usage: trace_data_test.py path/to/gumshoe [unittest options]
"""
import csv
import json
import re
import sys
import unittest

import h5py
import numpy as np

from program import ROOT, InFolder, gumshoe

sys.path.append(str(ROOT / "tests" / "recovery"))
import cone

SCENARIOS = ROOT / "scenarios"


class TraceData(InFolder):
    def call(self, verb, name, *words, text=None):
        file = self.folder / f"{name}.toml"
        text = text or (SCENARIOS / f"{name}.toml").read_text()
        file.write_text(text.replace('"data/', f'"{SCENARIOS}/data/').replace('"gauge/', f'"{SCENARIOS}/gauge/'))
        run = gumshoe(verb, file, "--format", "json", *words, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def trace(self, name, *words, text=None):
        return self.call("trace", name, "--draws", "99", "--out", f"{name}.h5", *words, text=text)

    def test_a_square_is_found_and_nothing_beside_it(self):
        line, square, parabola = (self.trace(f"trace_load_cell{k}") for k in ("", "_square", "_quadratic"))
        self.assertEqual(line["verdict"], "not_in_catalogue")
        self.assertIn("load", line["findings"][0]["depends_on"])
        self.assertEqual([f["name"] for f in square["findings"]], ["square"])
        size = square["findings"][0]["quantities"][0]
        self.assertLess(abs(size["value"] + 3.16081871345029e-15), 3 * size["u"])  # NIST, certified
        self.assertEqual(parabola["verdict"], "nothing_found")
        # What is left without the square is what the parabola leaves: residual standard deviation, certified 2.0518e-4.
        for v, key in ((square, "after"), (parabola, "before")):
            self.assertAlmostEqual(v["rms"][key] / 2.0517742407e-4, 1, delta=0.05)

    def test_a_thermometer_lacks_nothing(self):
        v = self.trace("trace_thermometer")
        self.assertEqual(v["verdict"], "nothing_found")
        self.assertAlmostEqual(v["rms"]["before"], 0.0035, delta=0.00005)  # GUM, H.3.3

    def test_a_missing_file_is_one_problem_and_not_also_its_columns(self):
        text = (SCENARIOS / "trace_load_cell.toml").read_text()
        self.assertIn('order  = "order"', text)
        file = self.folder / "s.toml"
        file.write_text(text.replace('"data/load_cell.csv"', '"none.csv"'))
        run = gumshoe("trace", file, cwd=self.folder)
        self.assertEqual(run.returncode, 2)
        message, = run.stderr.splitlines()
        self.assertIn("none.csv': the file does not exist", message)

    def test_few_readings_name_no_cause(self):
        for name in ("trace_rods", "trace_single_socket"):
            for f in self.trace(name)["findings"]:
                self.assertIn(f["kind"], ("scatter", "not_in_catalogue"), name)
        said = " ".join(self.trace("trace_rods")["statements"])
        self.assertIn("feed is 4 mm/min in every reading", said)
        self.assertNotIn("direction is", said)  # only a comment speaks of it
        text = (SCENARIOS / "trace_single_socket.toml").read_text().replace("[trace]\n", '[trace]\nblocks = "case"\n')
        self.assertEqual(self.trace("trace_single_socket", text=text)["verdict"], "insufficient_data")

    def test_nothing_found_is_agreement_only_if_noise_explains_the_residuals(self):
        for name in ("trace_rods", "trace_thermometer", "trace_load_cell_quadratic"):
            v = self.trace(name)
            self.assertEqual(v["verdict"], "nothing_found")
            rms = v["rms"]
            larger = [size for size, limits in ((rms["holdout_before"], rms["holdout_noise_interval95"]),
                                                (rms["before"], rms["noise_interval95"]))
                      if size is not None and limits[1] is not None and size > limits[1]]
            self.assertEqual("agree with the model" in v["plain"][0], not larger, (name, v["plain"][0]))
            self.assertEqual("than noise alone gives" in v["plain"][0] and not "no larger" in v["plain"][0], bool(larger))

    def test_a_trace_does_not_say_what_only_a_run_does(self):
        said = "laser_z: estimated, without a distribution; treated as exact"
        self.trace("trace_rods")
        with h5py.File(self.folder / "trace_rods.h5") as file:
            self.assertFalse([n for n in file["notes"].asstr()[()] if said in n])
        self.assertIn(said, gumshoe("check", self.folder / "trace_rods.toml", cwd=self.folder).stdout)

    def test_cone_readings_are_as_their_script_writes(self):
        for case, file in (("constant", "cone.csv"), ("shift", "cone_shift.csv")):
            with (SCENARIOS / "data" / file).open(newline="") as f:
                shipped = [float(r["d_um"]) for r in csv.DictReader(f)]
            made = [row[-1] for row in cone.readings(case)]
            np.testing.assert_allclose(shipped, made, atol=0.0051)  # printed to 0.01 um

    def test_the_scanner_is_the_matrices_of_the_cone(self):
        errors = dict(dx_BR=0.05, dy_BR=-0.04, dz_BR=0.03, dx_CB=0.02, alpha_BR=2e-4, beta_BR=-3e-4, gamma_BR=1e-4, alpha_CB=2.5e-4, e_x=0.2,
                      e_y=-0.15, e_z=0.01, e_a=1e-4, e_b=-2e-4, zero=0.005)
        text = (SCENARIOS / "trace_cone.toml").read_text()
        lines = ["setup,surface,line,point,time_s,B_deg,C_deg,r_mm,cx_mm,cy_mm,d_um"]
        for setup in (1, 2):
            here = {k: setup * v for k, v in errors.items()}
            for k, v in here.items():
                value = f"{v * 1e6!r} urad" if k in ("e_a", "e_b") or k[0] in "abg" else f"{v * 1e3!r} um"
                name = cone.NAMES.get(k, k)
                text, count = re.subn(rf'(\b{name}\.by\.setup\]?(?: = {{ |\n)(?:.*\n|1 = "[^"]*", ){{{setup - 1}}}{setup} = (?:{{ value = )?)"[^"]*"', rf'\g<1>"{value}"', text)
                self.assertEqual(count, 1, k)
            for line, (surface, radius) in enumerate(cone.LINES, 1):
                for a in cone.ANGLES:
                    d = cone.displacement(surface, radius, np.radians(a), setup, here)
                    lines.append(f"{setup},{surface},{line},{line}:{a:g},0,{cone.TILT[surface]},{a},{radius},{cone.CENTRE[setup][0]},"
                                 f"{cone.CENTRE[setup][1]},{1e3 * d:.9f}")
        (self.folder / "exact.csv").write_text("\n".join(lines) + "\n")
        fit = self.call("estimate", "trace_cone", "--scenario-out", "o.toml", text=text.replace("data/cone.csv", "exact.csv"))
        # The form takes what both set-ups share; nothing is left of their difference, nor of the mean.
        self.assertLess(1.7 * np.sqrt(fit["chi_squared"]), 1e-6)  # um, all residuals together
        for name, p in fit["parameters"].items():
            self.assertLess(abs(p["value"]), 1e-6, name)

    def test_a_constant_has_many_owners(self):
        v = self.trace("trace_cone")
        f = v["findings"][0]
        self.assertEqual((v["verdict"], len(v["findings"])), ("class", 1))
        sizes = {a["name"]: a["quantities"][0] for a in f["alternatives"]}
        for owner, size in (("sensor_zero[setup 2]", 13.7), ("E_Z0B[setup 2]", 10.7 + 13.7), ("e_z[setup 2]", 13.7), ("thermal_growth", 13.7 / 2)):
            low, high = sizes.get(f"declared:{owner}", sizes.get(owner))["interval95"]
            self.assertTrue(low < size < high, owner)
        # Each brings a wave that is not there, or moves by metres and radians. A tilt that both set-ups share lifts the part in
        # set-up 2 alone; its wave is that of the form, which is free.
        for other in ("e_x", "e_y", "e_a[", "e_b[", "E_Y0C", "E_A0"):
            self.assertFalse([m for m in f["members"] if m.startswith(f"declared:{other}")])
        self.assertLess(v["rms"]["holdout_after"], 0.5 * v["rms"]["holdout_before"])
        with h5py.File(self.folder / "trace_cone.h5") as file:
            rows = file["trace/candidates"]
            names, correlation = [name.decode() for name in rows["name"]], rows["correlation"][:]
        # The first is a table, of whose columns the free form takes some: they span no less for that.
        self.assertTrue(names[0].startswith("table:"))
        self.assertAlmostEqual(correlation[0], 1, delta=1e-6)
        for member in f["members"]:
            self.assertGreater(max([c for name, c in zip(names, correlation) if name == member], default=1), 0.9, member)

    def test_what_is_declared_is_no_finding(self):
        text = (SCENARIOS / "trace_cone.toml").read_text().replace("data/cone.csv", "data/cone_shift.csv")
        self.assertEqual(self.trace("trace_cone", text=text)["verdict"], "nothing_found")


if __name__ == "__main__":
    unittest.main()
