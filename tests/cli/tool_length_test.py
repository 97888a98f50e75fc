"""`gumshoe` with the model tool_length: tables, effects, and what is impossible about a mill.

usage: tool_length_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import unittest

from program import InFolder, complaint, gumshoe, places

PRINTED = 1e-12  # mm

SCENARIO = """schema = 1
[model]
name = "tool_length"
[conditions]
spindle_speed = "1000 rpm"
feed = "30 mm/min"
start_angle = "0 deg"
start_height = "0.5 mm"
[quantities]
inserts = 2
offset = "4 mm"
wear_1 = "0 mm"
[quantities.laser_z]
value = "-500 mm"
u = "1 um"
[indications.spindle_z]
readings = ["-350.002 mm"]
resolution = "1 um"
"""


def swap(old, new):
    assert old in SCENARIO, old
    return SCENARIO.replace(old, new, 1)


# name: (scenario, line, words)
MISTAKES = {
    "no feed": (swap("30 mm/min", "0 mm/min"), 6, ["conditions: feed is not positive"]),
    "feed upwards": (swap("30 mm/min", "-30 mm/min"), 6, ["feed is not positive"]),
    "standing spindle": (swap("1000 rpm", "0 rpm"), 5, ["conditions: spindle_speed is not positive"]),
    "turning backwards": (swap("1000 rpm", "-1000 rpm"), 5, ["spindle_speed is not positive"]),
    "fed upwards": (swap('start_height = "0.5 mm"', 'direction = "1"'), 8, ["direction is not -1"]),
    "two and a half inserts": (swap("inserts = 2", "inserts = 2.5"), 10, ["inserts is not an integer"]),
    "no inserts": (swap("inserts = 2", "inserts = 0"), 10, ["inserts"]),
    "thirteen inserts": (swap("inserts = 2", "inserts = 13"), 10, ["inserts", "12"]),
    "wear larger than the insert": (swap('wear_1 = "0 mm"', 'wear_1 = "7 mm"'), 12, ["wear", "insert_radius"]),
    "effect of a standing tool": (SCENARIO + '[effects.rod_runout]\nx = "1 um"\n', 19, ["tool_length cannot carry it"]),
    "speed error beyond limits": (SCENARIO + '[effects.spindle_speed_error]\nerror = "-100 %"\n', 20, ["spindle_speed_error.error", "-50"]),
    "an insert that is not there": (SCENARIO + '[effects.insert_radius_error]\nradius_13 = "1 um"\n', 20, ["radius_13", "Did you mean 'radius_1"]),
    "an insert of no radius": (SCENARIO + '[effects.insert_radius_error]\nradius_2 = "-6 mm"\n', None, ["insert_radius including its errors is not positive"]),
}


class ToolLength(InFolder):
    def rows(self, header, *rows, code=0):
        path = self.folder / "points.csv"
        path.write_text("\n".join([",".join(header), *(",".join(map(str, row)) for row in rows)]) + "\n")
        self.run_ = gumshoe("evaluate", "tool_length", "--table", path)
        self.assertEqual(self.run_.returncode, code, self.run_.stderr)
        table = list(csv.DictReader(io.StringIO(self.run_.stdout)))
        self.assertEqual(len(table), len(rows))
        self.places = places(self.run_, path)
        return [{name: cell if name == "status" else float(cell) for name, cell in row.items()} for row in table]

    def test_inserts_are_a_column(self):
        # One flute waits a whole turn for its next chance: the lowest trigger over angles falls with fewer inserts.
        angles = range(0, 360, 10)
        rows = self.rows(["inserts (1)", "start_angle (deg)", "start_height (mm)"], *((n, a, 0.5) for n in (1, 2, 3, 6) for a in angles))
        self.assertEqual({row["status"] for row in rows}, {"ok"})
        spread = []
        for i in range(4):
            heights = [row["trigger_height (mm)"] for row in rows[36 * i:36 * i + 36]]
            spread.append(max(heights) - min(heights))
            for row in rows[36 * i:36 * i + 36]:  # L = 150 mm, laser_z = 0
                self.assertAlmostEqual(row["spindle_z (mm)"], 150 + row["trigger_height (mm)"], delta=PRINTED)
        self.assertEqual(spread, sorted(spread, reverse=True))
        for n, s in zip((1, 2, 3, 6), spread):
            self.assertLess(s, 0.030 / n)  # never more than the descent from one flute to the next
        # without the unit, too
        alone = self.rows(["inserts", "start_angle (deg)", "start_height (mm)"], (3, 40, 0.5))[0]
        self.assertEqual(alone["spindle_z (mm)"], rows[2 * 36 + 4]["spindle_z (mm)"])

    def test_impossible_rows_are_named_and_the_others_computed(self):
        header = ["inserts (1)", "feed (mm/min)", "spindle_speed (rpm)", "offset (mm)", "wear_1 (mm)", "direction (1)"]
        good = (2, 30, 1000, 4, 0, -1)
        bad = [(2.5, 30, 1000, 4, 0, -1), (0, 30, 1000, 4, 0, -1), (13, 30, 1000, 4, 0, -1), (2, 0, 1000, 4, 0, -1), (2, -30, 1000, 4, 0, -1),
               (2, 30, 0, 4, 0, -1), (2, 30, -1000, 4, 0, -1), (2, 30, 1000, 4, 6, -1), (2, 30, 1000, 4, -6, -1), (2, 30, 1000, 4, 0, 1)]
        rows = self.rows(header, good, *bad, good, code=2)
        self.assertEqual([row["status"] for row in rows], ["ok", *["out_of_domain"] * len(bad), "ok"])
        for row in rows[1:-1]:
            self.assertTrue(math.isnan(row["trigger_height (mm)"]) and math.isnan(row["spindle_z (mm)"]))
        self.assertEqual(sorted(line for line, _ in self.places), list(range(3, 3 + len(bad))))
        for word in ("inserts", "feed", "spindle_speed", "wear", "direction"):
            self.assertIn(word, self.run_.stderr)
        self.assertEqual(rows[0], rows[-1])

    def test_no_insert_meets_the_beam(self):  # a status, no error: the lowest points run 4 mm from the axis, the inserts end at 10
        rows = self.rows(["offset (mm)"], (4,), (10.5,), (30,), (-30,))
        self.assertEqual([row["status"] for row in rows], ["ok"] + ["never_covered"] * 3)

    def test_readout_gives_the_tool_that_was_simulated(self):
        # Below 100 mm, so that 15 digits of each printed number are 5e-14 mm at most.
        header = ["laser_z (mm)", "inserts (1)", "start_angle (deg)", "start_height (mm)", "feed (mm/min)", "tool_runout.x (um)", "tool_runout.tilt_y (mrad)",
                  "spindle_speed_error.error (%)", "servo_lag.time_constant (ms)", "servo_lag.latches_command (1)", "sampling_rate.period (ms)",
                  "feed_start_delay.delay (ms)", "spindle_axial_shift.at_once (um)", "revolution_confirm.revolutions (1)", "insert_seat_error.radius_2 (um)",
                  "rod_expansion.temperature_difference (K)", "z_scale.E_ZZ (um/m)", "trigger_latency.delay (ms)"]
        points = [(-50, 2, 0, 0.5, 30, *[0] * 13), (-50, 2, 17, 0.5, 30, 10, 0.1, 0.5, 8, 0, 2, 3, 50, 1, 12, 4, 12, 1.5),
                  (-40, 5, 250, 0.05, 60, -7, 0.3, -1, 60, 1, 0.5, -2, 20, 0, -9, -6, -20, 4)]
        lengths = [80.0, 81.2345678901, 63.5]
        simulated = self.rows([*header, "tool_length (mm)"], *((*map(repr, p), repr(z)) for p, z in zip(points, lengths)))
        evaluated = self.rows([*header, "spindle_z (mm)"], *((*map(repr, p), repr(row["spindle_z (mm)"])) for p, row in zip(points, simulated)))
        for length, there, back in zip(lengths, simulated, evaluated):
            self.assertEqual((there["status"], back["status"]), ("ok", "ok"))
            self.assertAlmostEqual(back["tool_length (mm)"], length, delta=2e-12)
            self.assertAlmostEqual(back["trigger_height (mm)"], there["trigger_height (mm)"], delta=2e-12)

    def test_effects_as_columns(self):
        header = ["start_height (mm)", "start_angle (deg)"]
        plain, turned = self.rows(header, (0.5, 10), (0.5, 10 + 6 * 1000 * 0.004))
        delayed = self.rows([*header, "feed_start_delay.delay (ms)"], (0.5, 10, 4))[0]  # 6 N dt degrees
        self.assertAlmostEqual(delayed["spindle_z (mm)"], turned["spindle_z (mm)"], delta=1e-11)
        confirmed = self.rows([*header, "revolution_confirm.revolutions (1)"], (0.5, 10, 3))[0]  # v / N = 30 um
        self.assertAlmostEqual(plain["spindle_z (mm)"] - confirmed["spindle_z (mm)"], 0.09, delta=PRINTED)
        late = self.rows([*header, "trigger_latency.delay (ms)"], (0.5, 10, 3))[0]
        self.assertAlmostEqual(plain["spindle_z (mm)"] - late["spindle_z (mm)"], 0.0015, delta=PRINTED)
        self.assertEqual(plain["trigger_height (mm)"], late["trigger_height (mm)"])

    def test_effects_at_null_change_no_bit(self):
        effects = json.loads(gumshoe("models", "tool_length", "--format", "json").stdout)["effects"]
        self.assertNotIn("rod_runout", effects)
        columns, nulls = [], []
        for name in effects:
            for q in json.loads(gumshoe("effects", name, "--format", "json").stdout)["quantities"]:
                columns.append(f"{name}.{q['name']} ({q['unit']})")
                nulls.append(repr(q["null_value"]))
        self.assertGreater(len(columns), 80)
        header = ["start_height (mm)", "start_angle (deg)", "inserts (1)"]
        points = [(0.5, 10, 2), (0.3, 200, 5)]
        plain = self.rows(header, *points)
        null = self.rows([*header, *columns], *((*p, *nulls) for p in points))
        for a, b in zip(plain, null):
            for column in ("trigger_height (mm)", "spindle_z (mm)", "effective_length (mm)"):
                self.assertEqual(a[column], b[column])

    # scenarios

    def write(self, text):
        path = self.folder / "mill.toml"
        path.write_text(text)
        return path

    def test_mistakes_in_a_scenario(self):
        good = gumshoe("check", self.write(SCENARIO))
        self.assertEqual((good.returncode, good.stderr), (0, ""))
        for name, (text, line, words) in MISTAKES.items():
            path = self.write(text)
            for command in (["check", path], ["run", path, "--samples", 1000, "--out", self.folder / "never.h5"]):
                with self.subTest(name, command=command[0]):
                    run = gumshoe(*command)
                    self.assertIsNone(complaint(run), run.stderr)
                    for word in words:
                        self.assertIn(word, run.stderr)
                    if line:
                        self.assertIn(line, [at for at, _ in places(run, path)], run.stderr)
                    self.assertFalse((self.folder / "never.h5").exists())

    def test_a_beam_that_is_never_met_fails_every_sample(self):
        run = gumshoe("run", self.write(swap("4 mm", "40 mm")), "--samples", 1000, "--out", self.folder / "out.h5")
        self.assertEqual(run.returncode, 3)
        self.assertIn("never_covered: 1000 samples", run.stdout)
        self.assertIn("the shadow cannot cover the share of the beam", run.stdout)
        check = gumshoe("check", self.write(swap("4 mm", "40 mm")))
        self.assertIn("warning: at the estimates there is no value: never_covered (the shadow cannot cover", check.stdout)

    def test_readings_without_a_derivative_are_named_or_counted(self):
        """Of the curve of a mill two readings decide some flutes, and eight or more the others."""
        angles = (8.69, 15.22, 20.66, 24.40, 29.41, 110.58, 121.82, 122.40, 133.26, 155.38, 176.79, 177.39, 182.76, 188.32,
                  211.74, 211.96, 216.69, 253.52, 271.16, 340.95, 349.65, 353.07)
        below = (4.719, 3.386, 2.321, 1.647, 19.536, 2.080, -0.130, -0.234, 16.480, 11.677, 7.061, 6.934, 5.787, 4.608, -0.180,
                 -0.222, -1.013, 9.906, 6.118, 10.590, 8.728, 8.000)  # um
        text = swap('name = "tool_length"', 'name = "tool_length"\nevaluation = "characteristic_curve"')
        for old, new in (('"0 deg"', str([f"{a} deg" for a in angles])), ('"0.5 mm"', str(["1.2 mm"] * 22)),
                         ('"30 mm/min"', '"49.75361884132676 mm/min"'), ('"1000 rpm"', '"610.0196187145038 rpm"'),
                         ("inserts = 2", 'inserts = 4\ntool_radius = "11.881761350480067 mm"\n'
                          'insert_radius = "7.353228058581706 mm"\nholder_angle = "201.16724607024975 deg"'),
                         ('"4 mm"', '"3.102660939698377 mm"'), ("-500 mm", "-300 mm"),
                         ('["-350.002 mm"]', str([f"{-160 - b / 1000:.6f} mm" for b in below])),
                         ('resolution = "1 um"', 'components = [ { u = "0.3 um", per = "reading" } ]')):
            assert old in text, old
            text = text.replace(old, new, 1)
        run = gumshoe("run", self.write(text), "--samples", 500, "--format", "json", "--out", self.folder / "out.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        reasons = {row["gum"]["reason"] for row in json.loads(run.stdout)}
        inputs = [r.partition("with respect to ")[2] for r in reasons if "no derivative" in r]
        self.assertTrue(inputs, reasons)
        for one in inputs:
            named = one.split(", ")
            self.assertEqual(len(named), len(set(named)), one)  # "spindle_z, spindle_z, ..." says nothing
            for name in named:
                self.assertRegex(name, r"^(laser_z|spindle_z(\[reading \d+\]| \(\d+ of its input draws\)))$")
        self.assertTrue(any("of its input draws" in one for one in inputs), inputs)

    def test_effects_run_and_show(self):
        path = self.write(SCENARIO + '[effects.feed_start_delay]\ndelay = { value = "3 ms", u = "1 ms" }\n'
                          '[effects.insert_seat_error]\nradius_2 = { value = "0 um", u = "5 um" }\n'
                          '[effects.spindle_speed_error]\nerror = { value = "0.1 %", u = "0.05 %" }\n')
        run = gumshoe("run", path, "--samples", 1000, "--out", self.folder / "out.h5")
        self.assertEqual(run.returncode, 0, run.stderr)


if __name__ == "__main__":
    unittest.main()
