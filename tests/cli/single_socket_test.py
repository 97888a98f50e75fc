"""The single socket method from outside: by hand, stations as rows, and what is refused.

usage: single_socket_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import pathlib
import tempfile
import unittest

from program import ROOT, complaint, gumshoe

SQUARE = [(150, 0, 0), (0, 150, 0), (0, 0, 150)]


class SingleSocket(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "points.csv"

    def evaluate(self, header, rows, evaluation, model="single_socket"):
        self.path.write_text("\n".join(",".join(map(str, row)) for row in (header, *rows)) + "\n")
        return gumshoe("evaluate", model, "--table", self.path, "--evaluation", evaluation)

    def results(self, *asked, **named):
        run = self.evaluate(*asked, **named)
        self.assertEqual(run.returncode, 0, run.stderr)
        return [{name: float(cell) for name, cell in row.items() if name != "status"}
                for row in csv.DictReader(io.StringIO(run.stdout))]

    def refused(self, part, *asked, **named):
        run = self.evaluate(*asked, **named)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn(part, run.stderr)

    def test_what_all_stations_share_is_one_contribution(self):
        """Of the bar's deviation u = 1 um by station and 1 um in all of them. With bars along X, Y, Z and (1, 1, 1) the
        position along X is 5/6 l_1 - (l_2 + l_3) / 6 + l_4 / sqrt(12), but for 0.03 mm of 150 mm."""
        at = ["150", "0", "0", "86.6025"]
        conditions = "\n".join(f"station_{axis} = {[f'{x} mm' for x in at[:3][-k:] + at[:3][:-k] + at[3:]]}" for k, axis in ((3, "x"), (1, "y"), (2, "z")))
        self.path.with_name("s.toml").write_text(f"""schema = 1
[model]
name = "single_socket"
evaluation = "position"
[conditions]
{conditions}
[indications.length_change]
readings = ["30 um", "-20 um", "50 um", "34.6 um"]
components = [ {{ u = "1 um", per = "reading" }}, {{ u = "1 um", per = [] }} ]
[run]
samples = 20_000
[analysis]
sensitivity = {{ sobol = 8192, dgsm = 256 }}
""")
        run = gumshoe("run", "s.toml", "--format", "json", cwd=self.path.parent)
        self.assertEqual(run.returncode, 0, run.stderr)
        x = json.loads(run.stdout)[0]
        own = [5 / 6, -1 / 6, -1 / 6, 12**-0.5]
        rows = {row["component"]: row for row in x["budget"]}
        self.assertEqual(list(rows), ["length_change[reading 1]: c1", "length_change: c2"] + [f"length_change[reading {k}]: c1" for k in (2, 3, 4)])
        variance = sum(c * c for c in own) + sum(own) ** 2
        for name, c in (("length_change: c2", sum(own)), *((f"length_change[reading {k + 1}]: c1", c) for k, c in enumerate(own))):
            self.assertAlmostEqual(rows[name]["sensitivity"] * 1e3, c, delta=1e-3, msg=name)
            self.assertAlmostEqual(rows[name]["share"], c * c / variance, delta=2e-3)
        self.assertEqual(x["gum"]["correlation_share"], 0)
        self.assertAlmostEqual(x["gum"]["combined_standard_uncertainty"] * 1e3, variance**0.5, delta=1e-3)
        # The bound by derivatives, of a linear function of normal inputs the share itself; u^2 of 20,000 samples to 1 %.
        for name, row in x["dgsm"].items():
            share = rows[name]["share"]
            self.assertAlmostEqual(row["bound"], share, delta=0.04 * share + 1e-3, msg=name)

    STATION = ["station_x (mm)", "station_y (mm)", "station_z (mm)", "length_change (mm)"]

    def test_position_by_hand(self):
        # Bars along the axes see the components; exactly, the bar along X also sees the sagitta of the other two.
        error = (0.3, -0.4, 1.2)
        rows = [(*at, math.dist(error, [-x for x in at]) - 150) for at in SQUARE]
        exact, = self.results(self.STATION, rows, "position")
        linear, = self.results(self.STATION, rows, "position_linear")
        for axis, true, row in zip("xyz", error, rows):
            self.assertAlmostEqual(exact[f"position_error_{axis} (mm)"], true, delta=1e-12)
            self.assertAlmostEqual(linear[f"position_error_{axis} (mm)"], row[3], delta=1e-12)

    def test_the_bar_s_own_errors(self):
        # 150 mm that warm by 2 K grow by 3.45 um and indicate that much less; the zero adds.
        header = [*self.STATION, "bar_zero (um)", "temperature_difference (K)"]
        row, = self.results(header, [(150, 0, 0, 0.010, 4, 2)], "length")
        self.assertAlmostEqual(row["length_error (um)"], 10 - 4 + 3.45, delta=1e-10)

    def test_a_declared_length_is_what_changes_count_from(self):
        header = [*self.STATION, "bar_length (mm)"]
        rows = [(*at, d, 150) for at, d in zip(SQUARE, (0.01, 0.02, 0.03))]
        self.assertEqual(self.results(header, rows, "position"), self.results(self.STATION, [r[:4] for r in rows], "position"))
        self.refused("bar_length differs from the distance between station and reference", header,
                     [(150, 0, 0, 0.01, 300)], "length")

    def test_directions(self):
        self.refused("1 stations, but a position error has three components", self.STATION, [(150, 0, 0, 0)], "position")
        plane = [(150, 0, 0, 0), (0, 150, 0, 0), (100, 100, 0, 0)]
        self.refused("lie in one plane: nothing determines the position error", self.STATION, plane, "position")
        near = self.evaluate(self.STATION, [(150, 0, 0, 0), (150, 20, 0, 0), (150, 0, 20, 0)], "position")
        self.assertIn("unfavourable: position errors are 8.7 times as uncertain", near.stderr)

    def test_steps(self):
        header = ["step", "alpha (deg)", *self.STATION]
        both = [(s, 10 * (s - 1), *at, 0) for s in (1, 2) for at in SQUARE]
        self.refused("the readings are of both steps, but 'position' evaluates one", header, both, "position")
        self.refused("2 stations of step 2, but", header, both[:-1], "rrttt")
        differ = [*both[:-1], (2, 11, *SQUARE[2], 0)]
        self.refused("the stations of step 2 differ in angles, pivot or point", header, differ, "rrttt")
        self.refused("step must be 1 or 2", header, [(3, 0, 150, 0, 0, 0)], "length")
        self.refused("direction must be 1, -1 or 0", ["direction", *self.STATION], [(2, 150, 0, 0, 0)], "length")
        self.refused("station and reference are less than 1 mm apart", self.STATION, [(0, 0, 0, 0)], "length")

    def test_a_rotation_by_hand(self):
        # A tool of 250 mm, turned by nothing; 1 um along Y is 4 urad about X against the sense of alpha's lever.
        header = ["after_x (um)", "after_y (um)", "after_z (um)"]
        row, = self.results(header, [(1, 1, 0)], "rrttt_linear", model="single_socket_rotation")
        self.assertAlmostEqual(math.radians(row["d_beta (deg)"]), -4e-6, delta=1e-15)
        self.assertAlmostEqual(math.radians(row["d_alpha (deg)"]), math.atan(4e-6), delta=1e-15)

    def test_what_determines_no_angles(self):
        header = ["beta (deg)", "after_x (mm)", "after_y (mm)", "after_z (mm)"]
        self.refused("the ball has no lever for one of the angles", header, [(90, 0, 0, 0)], "rrttt", model="single_socket_rotation")
        self.refused("over 1 mm from where pivot, point and angles put the ball", [*header, "nominal_x (mm)"], [(0, 0, 0, 0, 2)],
                     "rrttt", model="single_socket_rotation")

    def test_axes_that_a_machine_does_not_have(self):
        header = ["gamma (deg)", "after_x (mm)", "after_y (mm)", "after_z (mm)"]
        absent = "alpha, beta or gamma is not 0, but the machine has no such axis"
        self.refused(absent, header, [(5, 0, 0, 0)], "rrttt", model="single_socket_rotation")
        self.refused(absent, ["step", "gamma (deg)", *self.STATION], [(s, 5 * (s - 1), *at, 0) for s in (1, 2) for at in SQUARE], "rrttt")
        self.refused("z_alpha_gamma is not 0, but the machine is not TTTRR", ["z_alpha_gamma (mm)", *header[1:]], [(5, 0, 0, 0)], "rrttt",
                     model="single_socket_rotation")
        self.refused("the evaluation 'described' belongs to a [machine]", header, [(0, 0, 0, 0)], "described",
                     model="single_socket_rotation")

    # on a described machine

    MACHINE = """schema = 1
[model]
name = "single_socket_rotation"
method = "virtual_experiment"
evaluation = "described"
[machine]
name = "B and C in the table"
workpiece_side = ["Y", {{ axis = "B", point = ["10 mm", "0 mm", "-50 mm"] }}, {{ axis = "C", point = ["-5 mm", "30 mm", "0 mm"] }}]
tool_side = {tool}
[conditions]
beta = "20 deg"
gamma = "-35 deg"
[quantities]
point_x = "120 mm"
point_y = "40 mm"
point_z = "90 mm"
d_beta = "0.2 deg"
d_gamma = "-0.15 deg"
"""

    def run_on(self, tool='["X", "Z"]', more=""):
        scenario = self.path.with_name("machine.toml")
        scenario.write_text(self.MACHINE.format(tool=tool) + '[indications.after_x]\ncomponents = [ { distribution = "normal", u = "1 um" } ]\n' + more)
        return gumshoe("run", scenario, "--samples", 1000, "--format", "json", "--out", scenario.with_suffix(".h5"))

    def test_any_two_rotary_axes(self):
        # The machine that is simulated is the one that is evaluated: the errors that were given come back.
        run = self.run_on()
        self.assertEqual(run.returncode, 0, run.stderr)
        for result in json.loads(run.stdout):
            if result["measurand"].startswith("d_"):
                self.assertLess(abs(result["estimate"]), 1e-4)

    def test_a_virtual_experiment_simulates_the_machine_of_its_evaluation(self):
        text = self.MACHINE.format(tool="[]")
        text = text[:text.index("[machine]")].replace("described", "tttrr_linear") + text[text.index("[conditions]"):].replace(
            'beta = "20 deg"', 'alpha = "20 deg"').replace("d_beta", "d_alpha")
        scenario = self.path.with_name("tttrr.toml")
        scenario.write_text(text + '[indications.after_x]\ncomponents = [ { distribution = "normal", u = "1 um" } ]\n')
        run = gumshoe("run", scenario, "--samples", 1000, "--format", "json", "--out", scenario.with_suffix(".h5"))
        self.assertEqual(run.returncode, 0, run.stderr)

    # Both steps with bars.

    BARS = """schema = 1
[model]
name = "single_socket"
method = "{method}"
evaluation = "{evaluation}"
{machine}
[conditions]
{conditions}
[quantities]
point_x = "{point[0]} mm"
point_y = "{point[1]} mm"
point_z = "{point[2]} mm"
{more}
[indications.length_change]
components = [ {{ distribution = "normal", u = "{u} um", per = "reading" }} ]
{readings}
"""
    TABLES = {  # name: axes from the bed, directions, from the first axis to the second in mm, [machine]
        "B C": ((1, 2), (-15, 30, 50), '[{ axis = "B", point = ["10 mm", "0 mm", "-50 mm"] }, { axis = "C", point = ["-5 mm", "30 mm", "0 mm"] }]'),
        "A C": ((0, 2), (0, 0, 60), '["A", { axis = "C", point = ["0 mm", "0 mm", "60 mm"] }]'),
    }

    def run_bars(self, readings="", more="", u=1, **parts):
        scenario = self.path.with_name("bars.toml")
        scenario.write_text(self.BARS.format(readings=readings, more=more, u=u, **parts))
        run = gumshoe("run", scenario, "--samples", 1000, "--format", "json", "--out", scenario.with_suffix(".h5"))
        self.assertEqual(run.returncode, 0, run.stderr)
        return {result["measurand"]: result["estimate"] for result in json.loads(run.stdout)}

    def test_a_described_head_as_printed(self):
        # RRTTT, of which the reference tests know the results: the same draws give the same mean errors.
        conditions = ["step = [1, 1, 1, 2, 2, 2]"]
        conditions += [f'station_{axis} = ["{{}} mm", "{{}} mm", "{{}} mm", "{{}} mm", "{{}} mm", "{{}} mm"]'.format(*2 * [at[i] for at in SQUARE])
                       for i, axis in enumerate("xyz")]
        conditions += [f'{name} = ["0 deg", "0 deg", "0 deg", "{a} deg", "{a} deg", "{a} deg"]' for name, a in (("alpha", 25), ("beta", -40))]
        parts = {"method": "virtual_experiment", "point": (3, -7, -250), "conditions": "\n".join(conditions),
                 "more": 'd_alpha = "0.15 deg"\nd_beta = "-0.3 deg"\nposition_error_x = "80 um"\nseating_y = { value = "0 um", u = "5 um" }'}
        printed = self.run_bars(evaluation="rrttt", machine="", **parts)
        described = self.run_bars(evaluation="described", machine='[machine]\nworkpiece_side = []\ntool_side = ["X", "Y", "Z", "A", "B"]', **parts)
        self.assertEqual(list(printed), list(described))
        for name, value in printed.items():
            self.assertAlmostEqual(described[name], value, delta=math.degrees(1e-12) if name.startswith("d_") else 1e-9, msg=name)

    def test_bars_on_tables_of_two_axes(self):
        # Readings from rotations written out here, without noise; the closed form of TTTRR, where there is one, agrees.
        def about(axis, angle, at):
            i, j = (axis + 1) % 3, (axis + 2) % 3
            out = list(at)
            out[i], out[j] = (math.cos(angle) * at[i] - math.sin(angle) * at[j], math.sin(angle) * at[i] + math.cos(angle) * at[j])
            return out
        point, commanded, wrong, before = (120, 40, 90), (20, -35), (0.2, -0.15), (0.030, -0.020, 0.050)
        for name, (axes, apart, table) in self.TABLES.items():
            def place(*angles):
                first, second = (math.radians(a) for a in angles)
                return about(axes[0], first, [a + c for a, c in zip(apart, about(axes[1], second, point))])
            actual = place(*(a + b for a, b in zip(commanded, wrong)))
            after = [d + x - y for d, x, y in zip(before, actual, place(*commanded))]
            letters = [("alpha", "beta", "gamma")[axis] for axis in axes]
            rows = [(step, *(a * (step - 1) for a in commanded), *at, math.dist([p + e for p, e in zip(at, error)], (0, 0, 0)) - 150)
                    for step, error in ((1, before), (2, after)) for at in SQUARE]
            columns = ["step", *letters, "station_x", "station_y", "station_z"]
            self.path.write_text("\n".join(",".join(map(repr, row)) for row in rows).join([",".join([*columns, "change"]) + "\n", "\n"]))
            unit = {"step": "1"} | dict.fromkeys(letters, "deg")
            read = ", ".join(f'{c} = {{ column = "{c}", unit = "{unit.get(c, "mm")}" }}' for c in columns)
            machines = {"described": f'[machine]\nworkpiece_side = {table}\ntool_side = ["X", "Y", "Z"]'} | ({"tttrr": ""} if name == "A C" else {})
            for evaluation, machine in machines.items():
                found = self.run_bars(
                    method="propagation", evaluation=evaluation, point=point, machine=machine, conditions="", u=1e-9,
                    more='z_alpha_gamma = "60 mm"' if evaluation == "tttrr" else "",
                    readings=f'readings = {{ file = "{self.path}", column = "change", unit = "mm", conditions = {{ {read} }} }}')
                for letter, angle in zip(letters, wrong):
                    self.assertAlmostEqual(found[f"d_{letter}"], angle, delta=math.degrees(1e-12), msg=(name, evaluation))
                self.assertEqual({n for n in found if n.startswith("d_")}, {f"d_{letter}" for letter in letters})
                for measurand, true in (("before_z", before[2]), ("after_x", after[0]), ("closure_length", 0)):
                    self.assertAlmostEqual(found[measurand], true, delta=1e-9, msg=(name, evaluation, measurand))

    def test_choose_finds_the_best_height_of_a_ring(self):
        # d_alpha moves the ball along c = (0, 1, sqrt 3) / 2 by 160.7 mm / rad; least u at tan^4 h = 2 (1 / sqrt 3)^2, h from Z.
        out = self.path.with_name("choice.h5")
        run = gumshoe("choose", ROOT / "scenarios/choose_socket_directions.toml", "--format", "json", "--out", out)
        self.assertEqual(run.returncode, 0, run.stderr)
        best = json.loads(run.stdout)["recommended"]
        height = 120 / (2 / 3) ** 0.25
        lever = 250 * math.cos(math.radians(50))
        def u(height):
            h = math.atan(120 / height)
            return math.sqrt(2 * (0.25 / (1.5 * math.sin(h) ** 2) + 0.75 / (3 * math.cos(h) ** 2))) * 1e-3 / lever
        found = -best["settings"]["reference_z"]
        self.assertLess(abs(found - height), 20)  # flat: within 20 mm U grows by 2 %
        self.assertLess(u(height + 20) / u(height), 1.02)
        self.assertAlmostEqual(best["average"]["U"] / (1.96 * math.degrees(u(found)) * 3600), 1, delta=0.01)

    def test_machine_and_evaluation_belong_together(self):
        stations = [(s, *at, 0) for s in (1, 2) for at in SQUARE]
        self.refused("the evaluation 'described' belongs to a [machine]", ["step", *self.STATION], stations, "described")

    def test_which_machines(self):
        for tool, more, part in (('["X", "Z", "A"]', "", "single_socket_rotation has two rotary axes, both in the table or both in the head"),
                                 ('["X", "Z"]', '[machine.errors]\nE_A0C = "1 urad"\n', "E_A0C is no quantity of single_socket_rotation")):
            run = self.run_on(tool, more)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertIn(part, run.stderr)


if __name__ == "__main__":
    unittest.main()
