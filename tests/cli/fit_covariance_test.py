"""The covariance that a joint evaluation of the sphere calibration gives by itself: against plain algebra with derivatives by
differences of the model's commands, and against Monte Carlo of the same scenario.

usage: fit_covariance_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import random
import unittest

import h5py
import numpy as np

from program import ROOT, InFolder, gumshoe

DEG = math.pi / 180
POSES = [(0, c) for c in range(0, 91, 5)] + [(b, 90) for b in range(-20, 46, 5)]
MACHINE = {"probe_x": 85.4, "probe_y": 287.1, "probe_z": 453.6, "E_X0B": -0.3, "E_Z0B": 0.5, "E_A0B": 0.21, "E_C0B": -0.1, "E_X0C": 0.2,
           "E_Y0C": -0.1, "E_A0C": -0.04, "E_B0C": 0.06}
UNIT = {name: "deg" if name[2] in "AC" or name == "E_B0C" else "mm" for name in MACHINE}
SI = {"deg": DEG, "mm": 1e-3}
SAMPLES = 20_000


class FitCovariance(InFolder):
    def commands(self, machine):
        """X, Y, Z in m of one machine at all poses: [3 pose + axis]."""
        table = self.folder / "points.csv"
        header = [f"{name} ({UNIT[name]})" for name in machine] + ["B (deg)", "C (deg)"]
        rows = [[repr(float(v)) for v in machine.values()] + [str(b), str(c)] for b, c in POSES]
        table.write_text("\n".join(map(",".join, [header, *rows])) + "\n")
        run = gumshoe("evaluate", "sphere_calibration", "--table", table)
        self.assertEqual(run.returncode, 0, run.stderr)
        return np.array([1e-3 * float(row[f"{k} (mm)"]) for row in csv.DictReader(io.StringIO(run.stdout)) for k in "XYZ"])

    def derivatives(self, machine):
        """Commands by the eleven, by differences: relative error 1e-9 of steps of a micrometre or microradian, of 0.5 m."""
        columns = []
        for name, unit in UNIT.items():
            step = 1e-4 / SI[unit]
            ends = [self.commands(machine | {name: machine[name] + sign * step}) for sign in (1, -1)]
            columns.append((ends[0] - ends[1]) / 2e-4)
        return np.array(columns).T

    def touches(self, u, seed, poses=POSES):
        draw, exact = random.Random(seed), 1e3 * self.commands(MACHINE)
        rows = [[b, c, *(repr(x + draw.gauss(0, u)) for x in exact[3 * i:3 * i + 3])] for i, (b, c) in enumerate(POSES)]
        (self.folder / "touches.csv").write_text("\n".join(",".join(map(str, r)) for r in [("b", "c", "x", "y", "z"), *rows[:len(poses)]]) + "\n")

    def measured(self, evaluation, u="5 um", more=""):
        text = f'schema = 1\n[model]\nname = "sphere_calibration"\nevaluation = "{evaluation}"\n[data]\nfile = "touches.csv"\nrepeats = "apart"\n'
        text += '[data.units]\nb = "deg"\nc = "deg"\nx = "mm"\ny = "mm"\nz = "mm"\n[data.conditions]\nB = "b"\nC = "c"\n'
        for k in "XYZ":
            text += f'[indications.{k}]\nreadings = "{k.lower()}"\ncomponents = [ {{ distribution = "normal", u = "{u}", per = "reading" }} ]\n'
        text += f"[run]\nsamples = {SAMPLES}\n[analysis]\njoint = [{json.dumps(list(MACHINE))}]\n{more}"
        return self.result(text)

    def result(self, text):
        (self.folder / "s.toml").write_text(text)
        self.runs = getattr(self, "runs", 0) + 1
        path = self.folder / f"{self.runs}.h5"
        run = gumshoe("run", self.folder / "s.toml", "--out", path, "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.outputs = {o["output"].removeprefix("error of "): o for o in json.loads(run.stdout)}
        file = h5py.File(path)
        self.addCleanup(file.close)
        self.assertEqual([n.removeprefix("error of ") for n in file["fit/000/name"].asstr()], list(MACHINE))
        return file

    def assert_like(self, found, expected, relative):
        """Matrices, each entry on the scale of its two standard uncertainties."""
        u = np.sqrt(np.diag(expected))
        self.assertLess(np.max(np.abs(found - expected) / np.outer(u, u)), relative)

    def assert_monte_carlo(self, file, covariance):
        """Four standard errors: of a covariance at most u1 u2 sqrt(2 / n)."""
        self.assert_like(file["joint/000/covariance"][()], covariance, 4 * math.sqrt(2 / SAMPLES))

    def test_equal_weights_by_the_residuals(self):
        self.touches(5e-3, 41)
        file = self.measured("joint")
        fit = file["fit/000"]
        found = {name: self.outputs[name]["estimate"] for name in MACHINE}
        J = self.derivatives(found)
        # Monte Carlo's mean is off the solution by a hundredth of u, which changes the residuals by 1e-4 of their size.
        with open(self.folder / "touches.csv") as rows:
            read = np.array([1e-3 * float(row[k]) for row in csv.DictReader(rows) for k in "xyz"])
        rest = read - self.commands(found)
        rest -= J @ np.linalg.lstsq(J, rest, rcond=None)[0]
        freedom = 3 * len(POSES) - 11
        s2 = rest @ rest / freedom
        self.assertEqual((fit.attrs["equations"], fit.attrs["degrees_of_freedom"]), (3 * len(POSES), freedom))
        self.assertAlmostEqual(fit.attrs["scatter"] / math.sqrt(s2), 1, delta=1e-5)
        self.assert_like(fit["covariance"][()], s2 * np.linalg.inv(J.T @ J), 1e-4)
        self.assert_monte_carlo(file, fit["covariance"][()] * (5e-6) ** 2 / s2)
        # Its u and correlations are those of the matrix, in the file and in JSON.
        u = np.sqrt(np.diag(fit["covariance"][()]))
        self.assertLess(np.max(np.abs(fit["standard_uncertainty"][()] / u - 1)), 1e-12)
        for i, (a, unit) in enumerate(UNIT.items()):
            told = self.outputs[a]["fit"]
            self.assertAlmostEqual(told["standard_uncertainty"] * SI[unit] / u[i], 1, delta=1e-9)
            for k, b in enumerate(UNIT):
                self.assertAlmostEqual(told["correlation"][b], fit["covariance"][i, k] / u[i] / u[k], delta=1e-9)

    def test_planes_first(self):
        """Two steps: not the least squares of all rows, so that its covariance is larger than theirs, and Monte Carlo's."""
        self.touches(5e-3, 42)
        file = self.measured("sequential")
        fit = file["fit/000"]
        scale = (5e-6 / fit.attrs["scatter"]) ** 2
        self.assert_monte_carlo(file, fit["covariance"][()] * scale)
        J = self.derivatives(MACHINE)
        least = np.sqrt(np.diag(np.linalg.inv(J.T @ J))) * 5e-6
        own = fit["standard_uncertainty"][()] * math.sqrt(scale)
        self.assertTrue(np.all(own > 0.999 * least))
        self.assertGreater(np.max(own / least), 1.1)  # least squares of all rows would be 1
        self.assertGreater(fit.attrs["degrees_of_freedom"], 3 * len(POSES) - 11)

    def test_the_scatter_of_the_residuals_is_that_of_the_commands(self):
        """Virtual experiments: the mean of s^2 over the samples, known to sqrt(2 / 88 / n); also where planes come first."""
        for evaluation in ("joint", "sequential"):
            text = f'schema = 1\n[model]\nname = "sphere_calibration"\nmethod = "virtual_experiment"\nevaluation = "{evaluation}"\n[conditions]\n'
            text += "".join(f"{k} = {json.dumps([f'{p[i]} deg' for p in POSES])}\n" for i, k in enumerate("BC"))
            text += "".join(f'[indications.{k}]\ncomponents = [ {{ distribution = "normal", u = "5 um", per = "reading" }} ]\n' for k in "XYZ")
            file = self.result(text + f"[run]\nsamples = {SAMPLES}\n")
            self.assertAlmostEqual(file["fit/000"].attrs["scatter"] / 5e-6, 1, delta=4 * math.sqrt(2 / 88 / SAMPLES) / 2 + 1e-5)

    def test_declared_weights(self):
        """Rotary errors and squareness, which act on many commands alike, are in the weights; chi-squared tests them."""
        text = (ROOT / "scenarios/sphere_calibration.toml").read_text()
        text = text.replace('evaluation = "sequential"', 'evaluation = "joint_weighted"').replace("samples = 100_000", f"samples = {SAMPLES}")
        file = self.result("\n".join(line for line in text.split("\n") if not line.startswith("sensitivity")))
        self.assert_monte_carlo(file, file["fit/000/covariance"][()])
        self.assertTrue(math.isnan(file["fit/000"].attrs["scatter"]))
        self.assertTrue(math.isnan(file["fit/000"].attrs["chi_squared"]))
        # The same error of every command: the weights change nothing, and the covariance does not know the residuals.
        for u, likely in (("5 um", True), ("2 um", False)):
            self.touches(5e-3, 43)
            fit = self.measured("joint_weighted", u)["fit/000"]
            J = self.derivatives(MACHINE)
            self.assert_like(fit["covariance"][()], np.linalg.inv(J.T @ J) * float(u[0]) ** 2 * 1e-12, 1e-3)
            self.assertEqual(fit.attrs["probability"] > 1e-3, likely)
            self.assertAlmostEqual(fit.attrs["chi_squared"], 88 * (5 / float(u[0])) ** 2, delta=5 * math.sqrt(2 * 88) * (5 / float(u[0])) ** 2)

    def test_what_the_poses_leave_undetermined(self):
        self.touches(5e-3, 44, POSES[:19])
        fit = self.measured("joint")["fit/000"]
        u = dict(zip(MACHINE, fit["standard_uncertainty"][()]))
        self.assertTrue(math.isinf(u["E_A0B"]) and math.isinf(u["E_Z0B"]))
        self.assertTrue(u["E_A0C"] < 1e-3)
        self.assertEqual(fit.attrs["degrees_of_freedom"], 3 * 19 - 7)
        run = gumshoe("run", self.folder / "s.toml", "--out", self.folder / "t.h5")
        self.assertRegex(run.stdout, r"least squares: 57 indications, 50 degrees of freedom, s = [45]\.\d+ um; u by the fit itself: .*E_A0B undetermined")


if __name__ == "__main__":
    unittest.main()
