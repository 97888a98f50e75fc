"""`gumshoe` with the model laser_ball_bar: joint evaluations and effects against closed forms, and what is impossible.

usage: laser_ball_bar_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import math
import pathlib
import tempfile
import unittest

from program import complaint, gumshoe

FEED = 1778 / 60  # mm/s
MISMATCH = 1 / 30 - 1 / 33  # s
PRINTED = 1e-11  # mm

# header, row, words
IMPOSSIBLE = {
    "no contour": ("contour", "3", "contour must be 0, 1 or 2"),
    "half a contour": ("contour", "0.5", "contour must be 0, 1 or 2"),
    "third order": ("order", "3", "order of the servos must be 1 or 2"),
    "neither sense": ("sense", "0", "sense must be 1 or -1"),
    "standing": ("feed (mm/min)", "0", "feed is not positive"),
    "no size": ("size (mm)", "0", "size of the contour is not positive"),
    "no acceleration": ("acceleration (m/s2)", "0", "acceleration is not positive"),
    "negative jerk": ("jerk (m/s3)", "-1", "jerk is negative"),
    "before the start": ("time (s)", "-0.1", "time is before the start of the contour"),
    "long after the end": ("contour,time (s)", "1,60", "time lies more than 1 s after the end of the contour"),
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

    def test_a_joint_evaluation_needs_its_readings(self):
        lengths = ["length_1 (mm)", "length_2 (mm)", "length_3 (mm)"]
        two = [[1, 0.5, 400, 400, 400], [1, 0.6, 400, 400, 400]]
        for evaluation, header, rows, words in (
                ("circle", ["contour", "time (s)"], two, "not every reading is of a circle; its condition contour must be 2"),
                ("line", ["contour", "feed (mm/min)"], [[1, 100, *two[0][2:]], [1, 200, *two[0][2:]]],
                 "readings of one line differ only in their time, but other conditions differ, too"),
                ("circle", ["contour", "time (s)"], [[2, 1, *two[0][2:]]],
                 "fewer than 5 readings lie in the stretch of constant feed, later than settling; is the feed reached?"),
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
