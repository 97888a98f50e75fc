"""Robots and other chains under an instrument: against plain matrices and virtual work, recovery and coverage of planted
errors, what trace finds, and complaints of wrong descriptions.

usage: serial_chain_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import random
import re
import unittest

from plain_robot import DEG, POSE, TRUTH, UR5E, UR5E_MASSES, Robot, instrument, table
from program import ROOT, InFolder, complaint, gumshoe

SHIPPED = ROOT / "scenarios" / "serial_chain.toml"
TARGET = (0.02, -0.01, 0.06)


def unit_of(name):
    for start, shown in (("delta_a_", ("mm", 1e-3)), ("delta_d_", ("mm", 1e-3)), ("scale", ("um/m", 1e-6)), ("compliance", ("urad/N/m", 1e-6)),
                         ("mass", ("kg", 1)), ("centre", ("mm", 1e-3)), ("target", ("mm", 1e-3)), ("base_x", ("mm", 1e-3))):
        if name.startswith(start):
            return shown
    return "deg", DEG


def stated(name, value):
    unit, size = unit_of(name)
    return f'{name} = "{value / size!r} {unit}"\n'


def loads(masses):
    out = {}
    for j, (mass, centre) in enumerate(masses, 1):
        out[f"mass_J{j}"] = mass
        out |= {f"centre_{c}_J{j}": x for c, x in zip("xyz", centre)}
    return out


def machine(links, modified=False):
    rows = "".join(f'  {{ axis = "J{j}", {"modified_" if modified else ""}dh = {{ a = "{a!r} m", alpha = "{alpha!r} rad", d = "{d!r} m", '
                   f'theta = "{theta!r} rad" }} }},\n' for j, (a, alpha, d, theta) in enumerate(links, 1))
    return f"[machine]\nworkpiece_side = []\ntool_side = [\n{rows}]\n"


def head(data, conditions, indications=("x", "y", "z"), u=None, measured="position"):
    units = "".join(f'"{c}" = "{"kg" if "kg" in c else "deg"}"\n' for c in conditions.values())
    units += "".join(f'"{i}_mm" = "mm"\n' for i in indications)
    named = "".join(f'{name} = "{column}"\n' for name, column in conditions.items())
    read = "".join(f'[indications.{i}]\nreadings = "{i}_mm"\n{f"u = {u!r}" if u else ""}\n' for i in indications)
    return (f'schema = 1\n[model]\nname = "serial_chain"\nmeasured = "{measured}"\n[data]\nfile = "{data}"\n[data.units]\n{units}'
            f'[data.conditions]\n{named}{read}')


JOINTS = {f"J{j}": f"j{j}_deg" for j in range(1, 7)}
# Far from anything that parameters of another kind could imitate.
EVERYTHING = TRUTH | {"delta_d_J1": 0.4e-3, "delta_theta_J6": 0.3 * DEG, "delta_beta_J5": -0.1 * DEG, "scale_J1": 80e-6, "scale_J4": -50e-6,
                      "cosine_J2": 0.01 * DEG, "sine_J3": -0.02 * DEG, "compliance_J1": 2e-6, "compliance_J3": 40e-6, "compliance_J5": 90e-6}


class Chain(InFolder):
    def estimated(self, text):
        file = self.folder / "chain.toml"
        file.write_text(text)
        run = gumshoe("estimate", file, "--format", "json", "--scenario-out", self.folder / "out.toml", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def exact(self, modified):
        """Every error stated, and readings without noise: what is left is the rounding of the readings' text."""
        masses, robot = UR5E_MASSES, Robot(UR5E, UR5E_MASSES, EVERYTHING, modified, TARGET)
        (self.folder / "points.csv").write_text(table(robot, instrument(0.3, 0.2, 0.1, 0.5, -0.4, 2.0), 5, 30, 0.0, (0.0, 3.0)))
        text = head("points.csv", JOINTS | {"payload": "payload_kg"}) + machine(UR5E, modified) + "[quantities]\n"
        for name, value in (EVERYTHING | loads(masses) | dict(zip(("target_x", "target_y", "target_z"), TARGET)) |
                            {"base_a": 0.5, "base_b": -0.4, "base_c": 2.0}).items():
            text += stated(name, value)
        text += 'base_y = "200 mm"\nbase_z = "100 mm"\nbase_x = { estimated = true, value = "0 mm" }\n'
        fit = self.estimated(text)
        self.assertAlmostEqual(fit["parameters"]["base_x"]["value"], 300, delta=1e-4)
        # Readings are written to 0.1 um: a standard deviation of 0.1 um / sqrt 12.
        self.assertEqual(fit["s_unit"], "mm")
        self.assertLess(fit["s"], 0.05e-3)

    def test_robot_against_plain_matrices_and_virtual_work(self):
        self.exact(False)

    def test_modified_parameters_against_plain_matrices(self):
        self.exact(True)

    def test_planted_errors_come_back_within_their_uncertainty(self):
        # Sizes drawn as the priors say; 60 points of a noisy tracker whose place nobody knows. Over 12 robots the share
        # of 95 % intervals that cover is 0.95 with a standard error of 0.015 if the 18 errors of a robot were independent.
        text = SHIPPED.read_text()
        priors = {name: float(u) * (1e-3 if unit == "mm" else DEG)
                  for name, u, unit in re.findall(r'^(delta_\w+) .* u = "([\d.]+) (mm|deg)"', text, re.M)}
        self.assertEqual(len(priors), 18)
        covered, squares, tried = 0, 0, 0
        for seed in range(12):
            chance = random.Random(seed)
            truth = {name: chance.gauss(0, u) for name, u in priors.items()}
            robot = Robot(UR5E, (), truth, target=TARGET)
            pose = instrument(*(chance.uniform(-2, 2) for _ in range(3)), *(chance.uniform(-20, 20) * DEG for _ in range(2)), chance.uniform(-90, 90) * DEG)
            (self.folder / "points.csv").write_text(table(robot, pose, seed))
            fit = self.estimated(text.replace("data/robot_tracker.csv", "points.csv"))
            self.assertLess(fit["s"], 1.35)  # times the declared noise; 171 degrees of freedom
            for name, value in truth.items():
                got, size = fit["parameters"][name], unit_of(name)[1]
                z = (got["value"] - value / size) / got["standard_uncertainty"]
                covered, squares, tried = covered + (abs(z) < 1.96), squares + z * z, tried + 1
        self.assertGreater(covered / tried, 0.95 - 3 * 0.015)
        self.assertAlmostEqual(squares / tried, 1, delta=0.25)

    def test_a_distance_finds_what_it_can(self):
        # Ranges of a robot from 2 m away: scale of the first joint, and where the instrument stands.
        truth, pose = {"scale_J1": 150e-6}, instrument(-1.9, 0.6, -0.2, 0, 0, 0)
        rows = list(csv.DictReader(io.StringIO(table(Robot(UR5E, (), truth, target=TARGET), pose, 3, 80))))
        out = io.StringIO()
        writer = csv.writer(out)
        writer.writerow([*JOINTS.values(), "distance_mm"])
        for row in rows:
            writer.writerow([*(row[c] for c in JOINTS.values()), repr(math.dist((0, 0, 0), [float(row[f"{k}_mm"]) for k in "xyz"]))])
        (self.folder / "points.csv").write_text(out.getvalue())
        text = head("points.csv", JOINTS, ("distance",), "20 um", "distance") + machine(UR5E) + "[quantities]\n"
        text += "".join(stated(f"target_{k}", x) for k, x in zip("xyz", TARGET))
        text += "".join(f'base_{k} = {{ estimated = true, value = "{v} mm" }}\n' for k, v in zip("xyz", (-1800, 500, 0)))
        fit = self.estimated(text + 'scale_J1 = { estimated = true, value = "0 um/m" }\n')
        got = fit["parameters"]["scale_J1"]
        self.assertLess(abs(got["value"] - 150), 4 * got["standard_uncertainty"])
        self.assertLess(got["standard_uncertainty"], 15)

    def test_trace_finds_what_the_links_do_not_explain(self):
        run = gumshoe("trace", SHIPPED, "--format", "json", "--out", self.folder / "t.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        verdict = json.loads(run.stdout)
        found = verdict["findings"]
        self.assertEqual([f["name"] for f in found], ["declared:compliance_J2"], found)
        size = found[0]["quantities"][0]
        self.assertLess(abs(size["value"] - 1e6 * TRUTH["compliance_J2"]), 3 * size["u"])
        self.assertNotIn("did not converge", run.stdout)  # from a tracker whose place is not stated

    def refused(self, machine_text, *said):
        file = self.folder / "chain.toml"
        file.write_text('schema = 1\n[model]\nname = "serial_chain"\nmethod = "virtual_experiment"\n' + machine_text)
        run = gumshoe("check", file)
        self.assertIsNone(complaint(run), run.stderr)
        for word in said:
            self.assertIn(word, run.stderr)
        self.assertEqual(run.stderr.count("error:"), 1, run.stderr)

    def test_wrong_descriptions(self):
        one = '[machine]\nworkpiece_side = []\ntool_side = [{}]\n'
        for name, text, *said in (
                ("a joint without its link", one.format('"J1"'), "'J1' is not an axis", "J names a joint", "Write dh = {"),
                ("both conventions", one.format('{ axis = "J1", dh = { a = "1 mm" }, modified_dh = { a = "1 mm" } }'),
                 "modified_dh: the link is stated by dh, too"),
                ("a link and a point", one.format('{ axis = "J1", dh = { a = "1 mm" }, point = ["1 mm", "0 mm", "0 mm"] }'), "point: the axis is stated by dh, too"),
                ("a link and a direction", one.format('{ axis = "C", dh = { a = "1 mm" }, direction = [0, 0, 1] }'), "direction: the axis is stated by dh, too"),
                ("a wrong unit of a link", one.format('{ axis = "J1", dh = { alpha = "1 mm" } }'), "is not an angle"),
                ("an unknown parameter", one.format('{ axis = "J1", dh = { alhpa = "1 deg" } }'), "Did you mean 'alpha'?"),
                ("a direction of two", one.format('{ axis = "C", direction = [0, 1] }'), "X, Y and Z are needed"),
                ("a direction away from its letter", one.format('{ axis = "C", direction = [0, 1, -1] }'), "90 deg or more away", "sense = -1"),
                ("a direction of words", one.format('{ axis = "C", direction = [0, "one", 1] }'), "a number without a unit is expected"),
                ("no such error of a link", one.format('{ axis = "J1", dh = {} }') + 'errors = { E_A0J1 = "1 deg" }\n', "errors of a link are delta_a"),
                ("a wrong unit of a link's error", one.format('{ axis = "J1", dh = {} }') + 'errors = { delta_d_J1 = "1 deg" }\n', "is not a length"),
                ("points of stated axes", one.format('"C"') + 'points = { C = ["0 mm", "0 mm", "1 mm"] }\n', "points: the axes are stated one by one"),
                ("points of no axis", '[machine]\nname = "TTTRR"\npoints = { B = ["0 mm", "0 mm", "1 mm"] }\n', "the machine has no axis 'B'"),
                ("a point of two", '[machine]\nname = "TTTRR"\npoints = { C = ["0 mm", "0 mm"] }\n', "X, Y and Z are needed"),
                ("a negative payload", one.format('"C"') + '[conditions]\npayload = "-1 kg"\n', "the payload is negative"),
                ("a negative compliance", one.format('"C"') + '[quantities]\ncompliance_C = "-1 urad/N/m"\n', "compliance_C")):
            with self.subTest(name):
                self.refused(text, *said)

    def test_models_with_axes_of_their_own_refuse_inclined_ones(self):
        file = self.folder / "chain.toml"
        for model in ("laser_scan", "single_socket"):
            file.write_text(f'schema = 1\n[model]\nname = "{model}"\nmethod = "virtual_experiment"\n[machine]\n'
                            'workpiece_side = ["B", { axis = "C", direction = [0, 1, 1] }]\ntool_side = ["X", "Y", "Z"]\n')
            run = gumshoe("check", file)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertIn("the axis C is inclined", run.stderr)

    def test_points_of_a_predefined_machine(self):
        file = self.folder / "chain.toml"
        text = '''schema = 1
[model]
name = "serial_chain"
method = "virtual_experiment"
[machine]
{}
[conditions]
C = "90 deg"
[quantities]
E_X0C = {{ value = "0 mm", u = "1 um" }}
target_x = "10 mm"
'''
        listed = 'workpiece_side = [{ axis = "A", point = ["0 mm", "5 mm", "7 mm"] }, { axis = "C", point = ["1 mm", "2 mm", "3 mm"] }]\ntool_side = ["X", "Y", "Z"]'
        named = 'name = "TTTRR"\npoints = { C = ["1 mm", "2 mm", "3 mm"], A = ["0 mm", "5 mm", "7 mm"] }'
        said = []
        for description in (listed, named):
            file.write_text(text.format(description))
            run = gumshoe("run", file, "--samples", "1000", "--format", "json", "--out", self.folder / "r.h5", "--force")
            self.assertEqual(run.returncode, 0, run.stderr)
            said.append([(row["measurand"], row["estimate"], row["standard_uncertainty"]) for row in json.loads(run.stdout)])
        self.assertEqual(*said)


if __name__ == "__main__":
    unittest.main()
