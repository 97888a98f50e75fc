"""`gumshoe` with the model laser_ball_bar: joint evaluations and effects against closed forms, and what is impossible.

usage: laser_ball_bar_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import pathlib
import tempfile
import unittest

import numpy as np

import plain_machine
from program import complaint, gumshoe

FEED = 1778 / 60  # mm/s
MISMATCH = 1 / 30 - 1 / 33  # s
PRINTED = 1e-11  # mm

# header, row, words
IMPOSSIBLE = {
    "no contour": ("contour", "4", "contour must be 0, 1, 2 or 3"),
    "half a contour": ("contour", "0.5", "contour must be 0, 1, 2 or 3"),
    "third order": ("order", "3", "order of the servos must be 1 or 2"),
    "neither sense": ("sense", "0", "sense must be 1 or -1"),
    "standing": ("feed (mm/min)", "0", "feed is not positive"),
    "no size": ("size (mm)", "0", "size of the contour is not positive"),
    "no acceleration": ("acceleration (m/s2)", "0", "acceleration is not positive"),
    "negative jerk": ("jerk (m/s3)", "-1", "jerk is negative"),
    "before the start": ("time (s)", "-0.1", "time is before the start of the contour"),
    "long after the end": ("contour,time (s)", "1,60", "time lies more than 1 s after the end of the contour"),
    "two sides": ("contour,sides", "3,2", "sides must be a whole number from 3 to 12"),
    "half a side": ("contour,sides", "3,4.5", "sides must be a whole number from 3 to 12"),
    "no time at a corner": ("contour,dwell (s)", "3,-0.1", "dwell is negative"),
    "no turn": ("contour,turns", "2,0", "turns must be above 0 and at most 1000"),
    "a line that rises": ("contour,rise (mm)", "1,5", "rise is not 0, but the contour is no level circle (a helix stands upright)"),
    "an oblique helix": ("contour,rise (mm),elevation (deg)", "2,5,10", "rise is not 0, but the contour is no level circle (a helix stands upright)"),
    "flat base": ("base_length_1 (mm)", "800", "the base lengths make no triangle"),
    "one direction": ("X_motion_x,X_motion_z", "0,1", "Z_motion and X_motion have one direction, or none"),
    "under the sockets": ("origin_z (mm)", "-1", None),
    "lengths that do not meet": ("length_1 (mm),length_2 (mm),length_3 (mm)", "100,100,500", None),
}


class LaserBallBar(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.table = pathlib.Path(temporary.name) / "points.csv"

    def rows(self, header, *rows, code=0, evaluation=None):
        with self.table.open("w") as file:
            csv.writer(file).writerows([header, *rows])
        self.run = gumshoe("evaluate", "laser_ball_bar", "--table", self.table, *(["--evaluation", evaluation] if evaluation else []))
        self.assertEqual(self.run.returncode, code, self.run.stderr)
        return list(csv.DictReader(io.StringIO(self.run.stdout)))

    def together(self, evaluation, header, *rows, falsified=()):
        """The joint evaluation of the simulated lengths; columns that start with `falsified` only simulation knows."""
        read = self.rows(header, *rows)
        lengths = [f"length_{i} (mm)" for i in (1, 2, 3)]
        known = [i for i, name in enumerate(header) if not name.startswith(tuple(falsified) or "\0")]
        return self.rows([header[i] for i in known] + lengths,
                         *([row[i] for i in known] + [one[name] for name in lengths] for row, one in zip(rows, read)),
                         evaluation=evaluation)[0]

    def test_what_is_impossible_is_refused(self):
        for what, (header, row, words) in IMPOSSIBLE.items():
            with self.subTest(what):
                found = self.rows(header.split(","), row.split(","), code=2 if words else 0)[0]
                self.assertEqual(found["status"], "out_of_domain")
                self.assertEqual(found["tool_x (mm)"], "nan")
                if words:
                    self.assertIsNone(complaint(self.run))
                    self.assertIn(words, self.run.stderr)

    def test_a_circle_becomes_the_ellipse_of_its_gains(self):
        header = ["contour", "time (s)", "feed (mm/min)", "size (mm)", "sense", "angle (deg)", "servo_gain_mismatch.y (%)"]
        for sense in (1, -1):
            found = self.together("circle", header, *([2, repr(0.5 + 0.2 * i), 1778, 50, sense, 30, 10] for i in range(50)),
                                  falsified=["servo"])
            # Steady response of first order: amplitudes cos(delta), phases delta = atan(omega / K), of the slides.
            x, y = math.atan(FEED / 50 / 30), math.atan(FEED / 50 / 33)
            a, b, c, d = math.cos(x) ** 2, math.cos(x) * math.sin(x), math.cos(y) ** 2, math.cos(y) * math.sin(y)
            matrix = [[a, b], [-d, c]] if sense == 1 else [[a, -b], [d, c]]
            (p, q), (r, s) = matrix  # u = 50 matrix (cos, sin)
            total, product = p * p + q * q + r * r + s * s, p * s - q * r
            root = math.sqrt(total ** 2 / 4 - product ** 2)
            major, minor = 50 * math.sqrt(total / 2 + root), 50 * math.sqrt(total / 2 - root)
            azimuth = math.degrees(math.atan2(2 * (p * r + q * s), p * p + q * q - r * r - s * s)) / 2
            # The slides settle to exp(-30 0.5) of a lag of 1 mm before the first reading.
            self.assertAlmostEqual(float(found["major_axis (mm)"]), major, delta=1e-7)
            self.assertAlmostEqual(float(found["minor_axis (mm)"]), minor, delta=1e-7)
            self.assertAlmostEqual(float(found["axis_difference (mm)"]), major - minor, delta=1e-7)
            self.assertAlmostEqual(float(found["major_angle (deg)"]), azimuth, delta=1e-4)
            self.assertAlmostEqual(azimuth, 45 * sense, delta=1)
            self.assertAlmostEqual(float(found["peak_to_valley (mm)"]), FEED * MISMATCH, delta=2e-3 * FEED * MISMATCH)

    def test_each_gain_is_explained_by_its_own_symbol(self):
        said = gumshoe("effects", "servo_gain_mismatch").stdout
        for slide in "yz":
            self.assertRegex(said, rf"(?m)^  {slide} .*\n +K_{slide}/K_x - 1: loop gain of {slide.upper()} above that of X")

    def test_a_line_is_offset_by_its_gains_and_by_nothing_on_the_way_there(self):
        header = ["contour", "time (s)", "feed (mm/min)", "angle (deg)", "servo_gain_mismatch.y (%)"]
        found = self.together("line", header, *([1, repr(t / 100), 1778, 45, 10] for t in range(0, 300)), falsified=["servo"])
        # 0.2 s after the feed is constant exp(-6) of the offset is missing, and less later.
        offset = FEED / 2 * MISMATCH
        self.assertAlmostEqual(float(found["steady_offset (mm)"]), offset, delta=1e-3 * offset)
        self.assertLess(float(found["peak_to_valley (mm)"]), 0.02 * offset)
        self.assertAlmostEqual(float(found["following_error (mm)"]), FEED * (1 / 30 + 1 / 33) / 2, delta=1e-3)

    def test_the_frame_of_a_machine_is_found(self):
        # X drops by 70 um/m and Y by nothing; the declared frame is another one than the bars'.
        header = ["motion", "x (mm)", "z (mm)", "X_motion_x", "X_motion_y", "Z_motion_x", "squareness.E_B0X (um/m)"]
        frame = [3, 4, 0.1, 70]
        found = self.together("machine_frame", header, *([3, 0, 10 * i, *frame] for i in range(6)),
                              *([1, 20 * i, 0, *frame] for i in range(6)), falsified=["squareness"])
        z = (0.1 / math.hypot(0.1, 1), 0, 1 / math.hypot(0.1, 1))
        for axis, want in zip("xyz", z):
            self.assertAlmostEqual(float(found[f"Z_motion_{axis} (1)"]), want, delta=1e-12)
        self.assertAlmostEqual(float(found["E_B0X (um/m)"]), 70, delta=70 * 70e-6 + 1e-6)

    def test_a_square_is_what_its_servos_make_of_it(self):
        # Runge-Kutta integration of the servos' equations, the command written out here: a square of 20 mm at 1778 mm/min,
        # 0.98 m/s2, clockwise, with a stop of 0.02 s; the corners are rounded by what is left of the lag.
        size, feed, ramp, dwell = 20.0, FEED, FEED / 980, 0.02
        side = size / feed + ramp  # s
        def path(t):
            t = min(max(t, 0), side)
            up = min(t, ramp)
            down = max(t - (side - ramp), 0)
            return 490 * up ** 2 + feed * max(min(t, side - ramp) - ramp, 0) + feed * down - 490 * down ** 2
        def command(t):
            s = [path(t - k * (side + dwell)) for k in range(4)]
            return s[0] - s[2], s[3] - s[1]
        step, moments = 1e-4, [0.05, side - 0.01, side + 0.01, side + 0.03, 2 * side + 0.05, 4 * (side + dwell) + 0.2]
        for order in (1, 2):
            def rate(t, state):
                out = []
                for (x, v), u, gain in zip(state, command(t), (30, 33)):
                    w = 2 * 0.7 * gain
                    out.append((gain * (u - x), 0) if order == 1 else (v, w * w * (u - x) - 2 * 0.7 * w * v))
                return out
            def moved(state, by, h):
                return [(x + h * a, v + h * b) for (x, v), (a, b) in zip(state, by)]
            state, way = [(0.0, 0.0), (0.0, 0.0)], []
            for i in range(round(moments[-1] / step) + 1):
                way.append([x for x, _ in state])
                t = i * step
                a = rate(t, state)
                b = rate(t + step / 2, moved(state, a, step / 2))
                c = rate(t + step / 2, moved(state, b, step / 2))
                d = rate(t + step, moved(state, c, step))
                state = [(x + step / 6 * (p[0] + 2 * q[0] + 2 * r[0] + s[0]), v + step / 6 * (p[1] + 2 * q[1] + 2 * r[1] + s[1]))
                         for (x, v), p, q, r, s in zip(state, a, b, c, d)]
            header = ["contour", "sides", "sense", "size (mm)", "feed (mm/min)", "dwell (s)", "order", "servo_gain_mismatch.y (%)", "time (s)"]
            fixed = [3, 4, -1, size, FEED * 60, dwell, order, 10]
            steps = [round(t / step) for t in moments]
            for found, at in zip(self.rows(header, *([*fixed, repr(i * step)] for i in steps)), steps):
                # The trapezoid's kinks cost a Runge-Kutta step up to a h^2 / 8 of acceleration, 1e-9 mm, some times.
                self.assertAlmostEqual(float(found["tool_x (mm)"]) - 200, way[at][0], delta=1e-7)
                self.assertAlmostEqual(float(found["tool_y (mm)"]) - 120, way[at][1], delta=1e-7)
            every = range(0, steps[-1], 10)
            found = self.together("polygon", header, *([*fixed, repr(i * step)] for i in every), falsified=["servo"])
            corners = [(size, 0), (size, -size), (0, -size)]
            worst = max(min(math.dist(corner, way[i]) for i in every) for corner in corners)
            # Readings are up to 0.03 mm apart; straight between them the way is nearer than at them.
            self.assertAlmostEqual(float(found["corner_error (mm)"]), worst, delta=0.005)
            inside = max(min(x, -y, size - x, size + y) for x, y in (way[i] for i in every))
            self.assertAlmostEqual(float(found["undershoot (mm)"]), max(inside, 0), delta=1e-6)

    def test_a_helix_is_what_its_servos_make_of_it(self):
        # Two turns of 15 mm that rise by 10 mm each, clockwise: Runge-Kutta of first order with the command written out here.
        size, rise, turns, feed, gains = 15.0, 10.0, 2, FEED, (30, 33, 27)
        way = math.hypot(size, rise / (2 * math.pi))  # mm per rad
        ramp = feed / 980
        end = 2 * math.pi * turns * way / feed + ramp
        def command(t):
            s = 490 * t * t if t < ramp else feed * (t - ramp / 2) if t < end - ramp else 2 * math.pi * turns * way - 490 * max(end - t, 0) ** 2
            return size * math.cos(s / way), -size * math.sin(s / way), rise / (2 * math.pi) * s / way
        state, step, moments, at = list(command(0)), 1e-4, (0.02, 1.0, end + 0.3), {}
        for i in range(round(moments[-1] / step) + 1):
            if any(round(m / step) == i for m in moments):
                at[i] = list(state)
            u0, u1, u2 = (command((i + f) * step) for f in (0, 0.5, 1))
            for j, k in enumerate(gains):
                a = k * (u0[j] - state[j])
                b = k * (u1[j] - state[j] - step / 2 * a)
                c = k * (u1[j] - state[j] - step / 2 * b)
                d = k * (u2[j] - state[j] - step * c)
                state[j] += step / 6 * (a + 2 * b + 2 * c + d)
        header = ["contour", "sense", "size (mm)", "rise (mm)", "turns", "feed (mm/min)", "servo_gain_mismatch.y (%)",
                  "servo_gain_mismatch.z (%)", "time (s)"]
        rows = self.rows(header, *([2, -1, size, rise, turns, 60 * feed, 10, -10, repr(i * step)] for i in at))
        for found, (x, y, z) in zip(rows, at.values()):
            for axis, value, origin in (("x", x, 200), ("y", y, 120), ("z", z, 300)):
                self.assertAlmostEqual(float(found[f"tool_{axis} (mm)"]) - origin, value, delta=1e-7)
            self.assertAlmostEqual(float(found["contour_error (mm)"]), math.hypot(x, y) - size, delta=1e-7)
        # In the middle of the steady stretch: across the helix on the unrolled cylinder, and behind along it.
        x, y, z = at[round(1 / step)]
        s = feed * (1.0 - ramp / 2)
        arc = -math.remainder(math.atan2(y, x) + s / way, 2 * math.pi) * size
        up = z - rise / (2 * math.pi) * s / way
        self.assertAlmostEqual(float(rows[1]["plane_error (mm)"]), (size * up - rise / (2 * math.pi) * arc) / way, delta=1e-7)
        self.assertAlmostEqual(float(rows[1]["following_error (mm)"]), -(size * arc + rise / (2 * math.pi) * up) / way, delta=1e-7)

    MACHINE = """schema = 1
[model]
name = "laser_ball_bar"
method = "virtual_experiment"
evaluation = "commanded"
[machine]
name = "any"
workpiece_side = {workpiece}
tool_side = {tool}
[conditions]
x = "60 mm"
y = "-20 mm"
z = "30 mm"
A = "25 deg"
C = "-40 deg"
[quantities]
tool_length = "150 mm"
{errors}
[indications.length_1]
components = [ {{ u = "1e-9 um", per = "reading" }} ]
"""

    def test_bars_on_a_machine_see_where_the_tool_truly_is(self):
        # The chain of plain_machine.py by 4 x 4 matrices, with the slides at the places that a machine without errors needs. The
        # frame of the bars is that which the slides X, Y, Z span at angles 0, from the tool at 0, 0, 0. The chain turns a head by
        # its zero position at angle 0 already, where the model takes the tool to be upright.
        common = {"E_Y0A": 8e-6, "E_Z0A": -6e-6, "E_B0A": 12e-6, "E_C0A": -9e-6}
        point = (0.01, -0.02, -0.06)
        stated = '{{ axis = "{}", point = ["10 mm", "-20 mm", "-60 mm"] }}'
        A, C = stated.format("A"), stated.format("C")
        slides, angles = ("X", "Y", "Z"), {"A": math.radians(25), "C": math.radians(-40)}
        for workpiece, tool, sides, second in (
                (f"[{A}, {C}]", '["X", "Y", "Z"]', ([("A", point), ("C", point)], slides), {"E_Y0C": 5e-6, "E_B0C": 7e-6}),
                ("[]", f'["X", "Y", "Z", {A}, {C}]', ([], (*slides, ("A", point), ("C", point))), {"E_Y0C": 5e-6, "E_B0C": 7e-6}),
                (f'["X", {A}]', f'["Y", "Z", {C}]', (["X", ("A", point)], ("Y", "Z", ("C", point))), {"E_Y0C": 5e-6, "E_B0C": 7e-6})):
            in_each = C in tool and A in workpiece
            truth = common | ({"E_A0A": 10e-6} if A in workpiece else {})
            values = {"probe_z": -0.15, "E_X0C": 4e-6} | truth | second
            stated_values = {"E_X0C": 4e-6} | truth
            for name, value in second.items():
                stated_values[name if in_each else f"{name}_minus_{name[:-1]}A"] = value - (0 if in_each else truth[name[:-1] + "A"])
            workpiece_side, tool_side = plain_machine.side(*sides[0], workpiece=True), plain_machine.side(*sides[1])
            at = {"probe_z": -0.15, "sphere_x": 0.06, "sphere_y": -0.02, "sphere_z": 0.03}
            commands = dict(zip(slides, plain_machine.closing(workpiece_side, tool_side, angles, at))) | angles
            def tool_on_table(**commanded):
                off, table = plain_machine.gap(workpiece_side, tool_side, dict.fromkeys((*slides, *angles), 0.0) | commanded, values)
                return table[:3, :3].T @ off
            zero = tool_on_table()
            spanned = np.array([tool_on_table(**{s: 1.0}) - zero for s in slides]).T
            on_table = np.linalg.solve(spanned, tool_on_table(**commands) - zero) + [0, 0, -0.15] - [0.06, -0.02, 0.03]
            scenario = self.table.with_name("machine.toml")
            scenario.write_text(self.MACHINE.format(workpiece=workpiece, tool=tool, errors="\n".join(
                f'{name} = "{value * 1e6!r} {"um" if name[2] in "XYZ" else "urad"}"' for name, value in stated_values.items())))
            run = gumshoe("run", scenario, "--samples", 1000, "--format", "json", "--out", scenario.with_suffix(".h5"))
            self.assertEqual(run.returncode, 0, run.stderr)
            found = {r["measurand"]: r["estimate"] for r in json.loads(run.stdout)}
            for i, axis in enumerate("xyz"):
                # As commanded minus as it is; what differs in second order is 1e-10 of 0.2 m.
                self.assertAlmostEqual(found[f"tool_{axis}"], -1e3 * on_table[i], delta=1e-7, msg=(tool, axis))

    def test_a_machine_that_the_bars_cannot_follow(self):
        scenario = self.table.with_name("machine.toml")
        scenario.write_text(self.MACHINE.format(workpiece='["C", "X"]', tool='["Y", "Z", "A"]', errors=""))
        run = gumshoe("check", scenario)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn("the slide X is carried by the rotary axis C, and laser_ball_bar moves its slides on the bed", run.stderr)

    def test_a_joint_evaluation_needs_its_readings(self):
        lengths = ["length_1 (mm)", "length_2 (mm)", "length_3 (mm)"]
        two = [[1, 0.5, 400, 400, 400], [1, 0.6, 400, 400, 400]]
        for evaluation, header, rows, words in (
                ("circle", ["contour", "time (s)"], two, "not every reading is of a circle; its condition contour must be 2"),
                ("line", ["contour", "feed (mm/min)"], [[1, 100, *two[0][2:]], [1, 200, *two[0][2:]]],
                 "readings of one line differ only in their time, but other conditions differ, too"),
                ("circle", ["contour", "time (s)"], [[2, 1, *two[0][2:]]],
                 "fewer than 5 readings lie in the stretch of constant feed, later than settling; is the feed reached?"),
                ("polygon", ["contour", "time (s)"], [[3, 0.1, *two[0][2:]], [3, 0.2, *two[0][2:]]],
                 "the readings pass no corner between two sides of the polygon (all are of one side)"),
                ("machine_frame", ["motion", "x (mm)"], [[3, 0, *two[0][2:]], [3, 1, *two[0][2:]]],
                 "a line along X needs two points or more; their condition motion must be 1")):
            with self.subTest(words):
                self.rows(header + lengths, *rows, code=2, evaluation=evaluation)
                self.assertIsNone(complaint(self.run))
                self.assertIn(words, self.run.stderr)

    def contour_errors(self, header, row):
        """Contour, plane and following error of a bar length that does not know of what falsifies it, mm."""
        read = self.rows(header, row)[0]
        plain = [(name, x) for name, x in zip(header, row) if "." not in name]
        found = self.rows([n for n, _ in plain] + [f"length_{i} (mm)" for i in (1, 2, 3)],
                          [x for _, x in plain] + [read[f"length_{i} (mm)"] for i in (1, 2, 3)])[0]
        return [float(found[f"{name}_error (mm)"]) for name in ("contour", "plane", "following")]

    def test_effects_have_their_sizes_and_signs(self):
        line = ["contour", "time (s)", "feed (mm/min)"]
        lag = FEED / 30
        # A delay of 100 us lets the tool go on by 2.96 um; bars are linear in it to 1e-5 of that.
        contour, plane, following = self.contour_errors([*line, "sampling_jitter.delay (us)"], [1, 2, 1778, 100])
        self.assertAlmostEqual(following, lag - FEED * 1e-4, delta=1e-7)
        self.assertAlmostEqual(contour, 0, delta=1e-7)
        # While the feed grows a bracket of 0.2 um/(m/s2) stays behind by 0.2 um at nearly 0.98 m/s2.
        still = self.contour_errors(line, [1, 0.025, 1778])[2]
        bent = self.contour_errors([*line, "bracket_inertia.compliance (um/(m/s2))"], [1, 0.025, 1778, 0.2])[2]
        share = 1 - math.exp(-30 * 0.025)  # of the acceleration, which a first-order slide follows
        self.assertAlmostEqual(bent - still, 0.2e-3 * 0.98 * share, delta=1e-9)
        # Y leans by 50 um/m towards -X: on a line along Y to the left, by 5 um per 100 mm.
        at = FEED * 2 - FEED ** 2 / 980 / 2 - lag  # a ramp covers half its time at 0.98 m/s2
        contour, plane, _ = self.contour_errors([*line, "angle (deg)", "squareness.E_C0Y (um/m)", "squareness.E_A0Y (um/m)"],
                                                [1, 2, 1778, 90, 50, 20])
        self.assertAlmostEqual(contour, 50e-6 * at, delta=1e-9)
        self.assertAlmostEqual(plane, 20e-6 * at, delta=1e-9)
        # A counter-clockwise circle from +X: Y turns round after a quarter, the axis a lag of 1/K later.
        quarter = math.pi / 2 * 50 / FEED + FEED / 980 / 2 + 1 / 30
        circle = ["contour", "size (mm)", "time (s)", "feed (mm/min)"]
        spike = [*circle, "reversal_spike.y (um)", "reversal_spike.rise (ms)"]
        for after, height in ((-0.01, 0), (0.02, 10), (0.04, 20 * math.exp(-1)), (0.5, 0)):
            still = self.contour_errors(circle, [2, 50, repr(quarter + after), 1778])[0]
            stuck = self.contour_errors(spike, [2, 50, repr(quarter + after), 1778, 10, 20])[0]
            self.assertAlmostEqual(stuck - still, 1e-3 * height, delta=2e-5)  # outwards

    def test_all_skews_alike_are_a_delay(self):
        header = ["contour", "time (s)", "elevation (deg)"]
        a = self.rows([*header, "skew_1 (us)", "skew_2 (us)", "skew_3 (us)"], [1, 2, 30, 70, 70, 70])[0]
        b = self.rows([*header, "sampling_jitter.delay (us)"], [1, 2, 30, 70])[0]
        for i in (1, 2, 3):
            self.assertAlmostEqual(float(a[f"length_{i} (mm)"]), float(b[f"length_{i} (mm)"]), delta=PRINTED)

    def test_the_commanded_point_stands_for_a_tool_that_nobody_measures(self):
        row = self.rows(["contour", "time (s)", "length_1 (mm)", "length_2 (mm)", "length_3 (mm)"], [1, 2, 1, 1, 1], evaluation="commanded")[0]
        at = 889 / 60 * 2 - (889 / 60) ** 2 / 980 / 2
        for name, want in (("tool_x", 200 + at), ("tool_y", 120), ("tool_z", 300), ("contour_error", 0), ("following_error", 0)):
            self.assertAlmostEqual(float(row[f"{name} (mm)"]), want, delta=PRINTED)


if __name__ == "__main__":
    unittest.main()
