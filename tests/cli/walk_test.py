"""From a machine's log to an answer with the commands of the README: an axis with a laser, no file edited by hand; a robot
with a tracker, whose links only its user knows; a five-axis machine with a probe and a sphere.

usage: walk_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import pathlib
import random
import re
import tempfile
import tomllib
import unittest

from plain_machine import closing, place, side
from plain_robot import DEG, Robot, instrument, table
from program import gumshoe


def bend(x):
    """um: a screw that bends and is too long"""
    return 4 * math.sin(x / 70) + 0.008 * x


class Walk(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)

    def run_it(self, *words):
        run = gumshoe(*words, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout


class Axis(Walk):
    """A German log in Latin-1: decimal commas, words, a clock; five runs up and down, noise of 0.3 um."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        chance, rows, second = random.Random(5), ["Nr;Lauf;Soll [mm];Richtung;Uhrzeit;Abweichung [µm];Temp [°C]"], 8 * 3600
        cls.readings = []
        for run in range(1, 6):
            for way in (1, -1):
                for x in [50 * i for i in range(11)][::way]:
                    d = bend(x) + 1.2 * way + chance.gauss(0, 0.3)
                    cls.readings.append((run, x, way, d))
                    row = f"{len(rows)};{run};{x:.1f};{'+' if way > 0 else '-'};{d:.2f};{20 + len(rows) / 1e3:.2f}".replace(".", ",").split(";")
                    row.insert(4, f"{second // 3600:02d}:{second % 3600 // 60:02d}:{second % 60:02d}")
                    rows.append(";".join(row))
                    second += 25
        (cls.folder / "messung.csv").write_text("\n".join(rows) + "\n", encoding="latin-1")

    def test_from_the_log_to_budget_verdict_and_table(self):
        self.run_it("new", "linear_axis", "--from", "messung.csv")
        self.run_it("check", "linear_axis.toml")
        # The budget: figures after ISO 230-2 against plain Python.
        figures = {o["measurand"]: o for o in json.loads(self.run_it("run", "linear_axis.toml", "--samples", "1e4", "--format", "json", "--out", "b.h5"))}
        means = {(x, w): [round(d, 2) for _, at, way, d in self.readings if (at, way) == (x, w)] for _, x, w, _ in self.readings}
        average = {k: sum(v) / len(v) for k, v in means.items()}
        self.assertAlmostEqual(figures["B"]["estimate"], max(abs(average[x, 1] - average[x, -1]) for x, _ in average),
                               delta=4 * figures["B"]["standard_uncertainty"] / math.sqrt(1e4))  # of the Monte Carlo mean
        self.assertGreater(figures["A"]["standard_uncertainty"], figures["B"]["standard_uncertainty"])
        # The verdict: at the noise in one loop, held out as well.
        rounds = json.loads(self.run_it("trace", "linear_axis.toml", "--loop", "5", "--format", "json", "--out", "t.h5"))["rounds"]
        self.assertGreater(rounds[0]["holdout_before"] * 1e6, 2)
        # 22 readings, predicted from a table of means of 4: three standard deviations of their root mean square.
        noise = 0.3 * math.sqrt(1 + 1 / 4) * (1 + 3 / math.sqrt(2 * 22))
        self.assertLess(rounds[-1]["holdout_after"] * 1e6, noise)
        self.assertFalse(rounds[-1]["added"])
        # The table, applied to the run that no fit has seen.
        out = self.run_it("compensate", "linear_axis.traced.toml", "--with", "gain", "--with", "offset")
        table = {(float(r["position_mm"]), int(r["direction"])): (float(r["error_um"]), float(r["u_um"]))
                 for r in csv.DictReader(line for line in io.StringIO(out) if not line.startswith("#"))}
        rest = [round(d, 2) - table[x, way][0] for run, x, way, d in self.readings if run == 5]
        # The trace also predicts by what the readings say of the reference, whose errors are none of the axis'.
        self.assertLess(math.sqrt(sum(r * r for r in rest) / len(rest)), noise)
        for (x, way), (e, u) in table.items():  # 22 entries
            self.assertAlmostEqual(e, bend(x) + 1.2 * way, delta=3.5 * u)

    def test_the_control_reads_it(self):
        self.run_it("new", "linear_axis", "--from", "messung.csv", "--out", "again.toml")
        self.run_it("trace", "again.toml", "--loop", "5", "--out", "again.h5")
        for form in ("linuxcnc-trim", "sinumerik-eec", "isg"):
            self.run_it("compensate", "again.traced.toml", "--format", form, "--out", f"table.{form}")
            self.assertGreater(len((self.folder / f"table.{form}").read_text().splitlines()), 10)


class RobotWithTracker(Walk):
    """72 points of a robot with an eccentric encoder in its first joint, by a tracker of 20 um whose place is not known."""

    # Lengths in m, angles in rad: a, alpha, d, theta.
    links = ((0, -90 * DEG, 0.290, 0), (0.270, 0, 0, -90 * DEG), (0.070, -90 * DEG, 0, 0), (0, 90 * DEG, 0.302, 0), (0, -90 * DEG, 0, 0), (0, 0, 0.072, 0))
    errors = {"delta_a_J2": 0.22e-3, "delta_alpha_J2": 0.03 * DEG, "delta_theta_J2": -0.17 * DEG, "delta_beta_J2": 0.03 * DEG,
              "delta_a_J3": -0.15e-3, "delta_theta_J3": 0.2 * DEG, "delta_alpha_J4": -0.04 * DEG, "delta_theta_J5": 0.15 * DEG, "sine_J1": 0.03 * DEG}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.robot = Robot(cls.links, (), cls.errors, target=(0.03, 0, 0.05))
        cls.points = table(cls.robot, instrument(-1.2, 2.2, 0.6, 0.01, 0.02, -2.2), 7, 72)
        (cls.folder / "points.csv").write_text(cls.points)

    def test_from_points_to_finding_and_budget(self):
        out = self.run_it("new", "serial_chain", "--from", "points.csv")
        self.assertIn("the machine is that of the example. Replace [machine] by yours, then: gumshoe estimate serial_chain.toml", out)
        # What only the user knows: the design of the links, one line each, and the tracker; no masses of this robot.
        file = self.folder / "serial_chain.toml"
        text = file.read_text()
        for j, (a, alpha, d, theta) in enumerate(self.links, 1):
            link = f'a = "{1e3 * a!r} mm", alpha = "{alpha / DEG!r} deg", d = "{1e3 * d!r} mm", theta = "{theta / DEG!r} deg"'
            text = re.sub(rf'{{ axis = "J{j}".*}},', f'{{ axis = "J{j}", dh = {{ {link} }} }},', text)
        text = re.sub(r"^(mass|centre)_.*\n", "", text, flags=re.M).replace('# u = "..."', 'u = "20 um"')
        file.write_text(text)
        # The links alone do not explain the points, and estimate says so.
        fit = json.loads(self.run_it("estimate", "serial_chain.toml", "--format", "json"))
        self.assertTrue(fit["converged"])
        self.assertGreater(fit["s"], 2)
        # The verdict: the encoder, after which held-out points are as good as the tracker.
        rounds = json.loads(self.run_it("trace", "serial_chain.toml", "--loop", "3", "--format", "json", "--out", "t.h5"))["rounds"]
        self.assertEqual(rounds[0]["added"], ["declared:sine_J1"])
        self.assertGreater(rounds[0]["holdout_before"] * 1e6, 60)
        # 36 coordinates, predicted from 180 and 28 parameters: three standard deviations of their root mean square.
        self.assertLess(rounds[-1]["holdout_after"] * 1e6, 20 * math.sqrt(1 + 28 / 180) * (1 + 3 / math.sqrt(2 * 36)))
        # The budget: where the target is at each of the commands, by the robot as it is.
        outputs = json.loads(self.run_it("run", "serial_chain.traced.toml", "--samples", "1e4", "--format", "json", "--out", "b.h5"))
        commands = [[float(row[f"j{j}_deg"]) * DEG for j in range(1, 7)] for row in csv.DictReader(io.StringIO(self.points))]
        within = 0
        for k, name in enumerate(("position_x", "position_y", "position_z")):
            own = [o for o in outputs if o["measurand"].split("[")[0] == name]
            self.assertEqual(len(own), len(commands))
            for o, command in zip(own, commands):
                off = abs(o["estimate"] - 1e3 * self.robot.place(command)[k])
                self.assertLess(o["standard_uncertainty"], 0.02)  # the tracker's, and less than a twentieth of the robot's errors
                within += off < 2 * o["standard_uncertainty"]
        # All of them follow from the same 28 parameters: as if 28 independent coordinates were counted.
        self.assertGreater(within / (3 * len(commands)), 0.954 - 3 * math.sqrt(0.954 * 0.046 / 28))


class ProbeAndSphere(Walk):
    """A sphere on a tilting table, touched at 36 angles in two rounds, to 1 um: location errors, an out-of-square Y, a probe
    that is 4 um shorter than the tool setter said and grows by 4 um/K."""

    truth = {"probe_z": -0.149996, "sphere_x": 0.12003, "sphere_y": 0.03996, "sphere_z": 0.06005, "E_X0B": 120e-6, "E_Z0B": -15e-6,
             "E_A0B": 0.003 * DEG, "E_C0B": -0.002 * DEG, "E_X0C": 12e-6, "E_Y0C": -8e-6, "E_A0C": 0.004 * DEG, "E_B0C": -0.0025 * DEG,
             "E_C0Y": 120e-6}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        chance, rows = random.Random(7), ["Nr,b (deg),c (deg),x (mm),y (mm),z (mm),temperature (degC),time (s)"]
        poses = [(b, c) for _ in range(2) for b in (-60, -30, 0, 30, 60, 90) for c in range(0, 360, 60)]
        for i, (b, c) in enumerate(poses):
            warmer = 2 * (1 - math.exp(-i / 25))
            xyz = closing(side("B", "C", workpiece=True), side("X", "Y", "Z"), {"B": b * DEG, "C": c * DEG},
                          cls.truth | {"probe_z": cls.truth["probe_z"] - 4e-6 * (warmer - 1)})
            read = (f"{1e3 * v + chance.gauss(0, 1e-3):.4f}" for v in xyz)
            rows.append(",".join(map(str, (i + 1, b, c, *read, f"{20 + warmer:.2f}", 40 * i))))
        (cls.folder / "touches.csv").write_text("\n".join(rows) + "\n")

    def test_the_machine_is_asked_for(self):
        out = self.run_it("new", "sphere_probing", "--from", "touches.csv", "--out", "asked.toml")
        self.assertIn("machine.workpiece_side[1]: '?' is not an axis", out)
        self.assertIn("machine.tool_side[1]: '?' is not an axis", out)
        self.assertIn("gumshoe new ... --force --machine B,C/X,Y,Z", out)

    def test_from_touches_to_finding_and_budget(self):
        out = self.run_it("new", "sphere_probing", "--from", "touches.csv", "--machine", "B,C/X,Y,Z")
        self.assertEqual(re.findall(r"error: (\S+): '\?'", out), ["quantities.probe_z.value"], out)
        # What only the user knows: the length of the probe, and where the machine works.
        file = self.folder / "sphere_probing.toml"
        volume = "".join(f'{axis} = {{ from = "-{end} mm", to = "{end} mm", points = 3 }}\n' for axis, end in (("X", 200), ("Y", 150), ("Z", 100)))
        file.write_text(file.read_text().replace('"?", u', '"-150 mm", u') + f'\n[volume]\n{volume}B = "30 deg"\n')
        self.run_it("check", "sphere_probing.toml")
        # The verdict: Y is not square to X, and something grows with the temperature; held-out touches are as good as noise.
        rounds = json.loads(self.run_it("trace", "sphere_probing.toml", "--loop", "3", "--format", "json", "--out", "t.h5"))["rounds"]
        self.assertIn("declared:E_C0Y", rounds[0]["added"][0].split(" | "))
        self.assertEqual(len(rounds[0]["added"]), 2)
        self.assertEqual(rounds[-1]["added"], [])
        self.assertGreater(rounds[0]["holdout_before"] * 1e6, 3)
        # 36 coordinates, predicted from 180 and 14 parameters: three standard deviations of their root mean square.
        self.assertLess(rounds[-1]["holdout_after"] * 1e6, math.sqrt(1 + 14 / 180) * (1 + 3 / math.sqrt(2 * 36)))
        # The calibrated machine: the location errors within four of their u. Those along Z share the probe's length.
        found = tomllib.loads((self.folder / "sphere_probing.traced.toml").read_text())["quantities"]
        for name, true in self.truth.items():
            if name == "E_C0Y":  # its class has one of three names
                continue
            value, u = (float(found[name][k].split()[0]) for k in ("value", "u"))
            true /= DEG if name[2] in "ABC" and name[0] == "E" else 1e-3
            self.assertLess(abs(value - true), 4 * u, name)
            self.assertLess(u, 0.006, name)
        # The map: how far the tool is from where the commands say, calibrated at one sphere, over the whole volume.
        points = json.loads(self.run_it("volume", "sphere_probing.traced.toml", "--format", "json", "--out", "v.h5"))["points"]
        sides = side("B", "C", workpiece=True), side("X", "Y", "Z")
        tip = {"probe_z": self.truth["probe_z"]}
        for k, p in enumerate(points):
            commands = {"X": 0.2 * (k // 9 - 1), "Y": 0.15 * (k // 3 % 3 - 1), "Z": 0.1 * (k % 3 - 1), "B": 30 * DEG, "C": 0.0}
            error = place(*sides, commands, self.truth) - place(*sides, commands, tip)
            for axis, true in zip("xyz", error):
                self.assertLess(abs(p[f"error_{axis}"] - true), 4 * p[f"u_{axis}"] + 1e-9, (commands, axis))
                self.assertLess(p[f"u_{axis}"], 10e-6)
        # The budget: where the tip stands against the sphere, to little more than the noise of a touch.
        outputs = json.loads(self.run_it("run", "sphere_probing.traced.toml", "--samples", "1e4", "--format", "json", "--out", "b.h5"))
        self.assertEqual(len(outputs), 3 * 72)
        for o in outputs:
            self.assertLess(o["standard_uncertainty"], 1.5e-3)
        within = sum(abs(o["estimate"]) < 2 * o["standard_uncertainty"] for o in outputs) / len(outputs)
        self.assertGreater(within, 0.954 - 3 * math.sqrt(0.954 * 0.046 / len(outputs)))


if __name__ == "__main__":
    unittest.main()
