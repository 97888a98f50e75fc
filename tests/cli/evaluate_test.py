"""`gumshoe evaluate`: the forward model at the points of a table, against values derived by hand.

usage: evaluate_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import math
import unittest

from program import InFolder, complaint, gumshoe, places

PRINTED = 1e-12  # mm: 15 digits of a length below 1 m are off by half a unit of 1e-12, doubles by less
DEG = math.pi / 180


class Evaluate(InFolder):
    def run_text(self, text, *more):
        self.path = self.folder / "points.csv"
        self.path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return gumshoe("evaluate", "rod_gauging", "--table", self.path, *more)

    def rows(self, header, *rows, code=0, more=()):
        """Output rows as dictionaries, numbers where they are numbers."""
        run = self.run_text("\n".join([",".join(header), *(",".join(map(str, row)) for row in rows)]) + "\n", *more)
        self.assertEqual(run.returncode, code, run.stderr)
        if code == 0:
            self.assertEqual(run.stderr, "")
        table = list(csv.DictReader(io.StringIO(run.stdout)))
        self.assertEqual(len(table), len(rows))
        self.stderr = run.stderr
        return [{name: cell if name == "status" else float(cell) for name, cell in row.items()} for row in table]

    def row(self, **values):
        """One point; `beam_pitch_deg=1` is column `beam_pitch (deg)`, `__` a dot."""
        header = []
        for key in values:
            name, unit = key.rsplit("_in_", 1)
            header.append(f"{name.replace('__', '.')} ({unit.replace('_per_', '/')})")
        row = self.rows(header, list(values.values()))[0]
        self.assertEqual(row["status"], "ok")
        return row

    # the table

    def test_order_text_and_columns_are_kept(self):
        text = 'beam_pitch (deg),"rod_radius (mm)"\n0.30,5.000\n-0.1,5\n+0.2,"4.5"\n'
        run = self.run_text(text)
        self.assertEqual(run.returncode, 0, run.stderr)
        lines = run.stdout.splitlines()
        self.assertEqual(lines[0], "beam_pitch (deg),rod_radius (mm),bottom_height (mm),spindle_z (mm),status")
        for line, start in zip(lines[1:], ("0.30,5.000,", "-0.1,5,", "+0.2,4.5,")):
            self.assertTrue(line.startswith(start) and line.endswith(",ok"), line)
        self.assertEqual(len(lines), 4)

    def test_a_model_that_a_scenario_describes(self):
        for model in ("expression", "serial_chain", "command"):
            run = gumshoe("evaluate", model, "--table", "points.csv")
            self.assertEqual(run.returncode, 2)
            self.assertIn(f"{model}: a scenario describes this model", run.stderr)

    def test_decimal_commas(self):
        """A cell with the other decimal sign is refused, and the remedy works; the numbers are the same."""
        text = "beam_pitch (deg);rod_radius (mm)\n0,30;5,5\n"
        refused = self.run_text(text)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("points.csv:2:1: error: beam_pitch: '0,30' is not a number (the decimal sign must be a point). Add --decimal \",\".", refused.stderr)
        run = self.run_text(text, "--decimal", ",")
        self.assertEqual(run.returncode, 0, run.stderr)
        same = self.run_text(text.replace(",", "."))
        self.assertEqual(run.stdout.replace(",", ".").replace(";", ","), same.stdout)
        self.assertTrue(run.stdout.splitlines()[1].startswith("0,30;5,5;"), run.stdout)
        again = "\n".join(";".join(row.split(";")[:2]) for row in run.stdout.splitlines()) + "\n"
        self.assertEqual(self.run_text(again, "--decimal", ",").stdout, run.stdout)  # what is written is read
        other = self.run_text(text.replace("0,30", "0.30"), "--decimal", ",")
        self.assertIn("(the decimal sign must be a comma). Add --decimal \".\".", other.stderr)

    def test_rows_do_not_depend_on_their_neighbours(self):
        # 19 rows are two groups of eight lanes and a padded rest; failing and impossible rows stand among them.
        points = [(5 + 0.1 * i, 0.02 * i, 0.5) for i in range(19)]
        points[3], points[10] = (0.1, 0, 0.9), (-1, 0, 0.5)
        header = ["rod_radius (mm)", "beam_pitch (deg)", "trigger_fraction"]
        together = self.rows(header, *points, code=2)
        for i, point in enumerate(points):
            alone = self.rows(header, point, code=2 if i == 10 else 0)[0]
            self.assertEqual(repr(alone), repr(together[i]))  # text, because nan is not nan
        self.assertEqual([row["status"] for row in together].count("ok"), 17)
        self.assertEqual((together[3]["status"], together[10]["status"]), ("never_covered", "out_of_domain"))

    def test_any_subset_of_columns(self):
        defaults = {"rod_radius (mm)": 5, "fillet_radius (mm)": 0.03, "bottom_elevation (deg)": 90, "bottom_azimuth (deg)": 0,
                    "rod_length (mm)": 150, "holder_angle (deg)": 0, "beam_yaw (deg)": 0, "beam_pitch (deg)": 0,
                    "beam_radius (mm)": 0.2, "trigger_fraction (1)": 0.5, "laser_z (mm)": 0, "feed (mm/min)": 4, "time (s)": 0}
        every = self.rows(list(defaults), list(defaults.values()))[0]
        for name, value in defaults.items():
            one = self.rows([name], [value])[0]
            for column in ("bottom_height (mm)", "spindle_z (mm)"):
                self.assertAlmostEqual(one[column], every[column], delta=PRINTED)
        self.assertAlmostEqual(every["spindle_z (mm)"], 150, delta=PRINTED)

    def test_units_are_converted(self):
        expected = self.row(rod_radius_in_mm=4, beam_pitch_in_deg=0.3, bottom_elevation_in_deg=88, beam_radius_in_mm=0.15, rod_length_in_mm=160)
        rows = self.rows(
            ["rod_radius (um)", "beam_pitch (mrad)", "bottom_elevation (rad)", "beam_radius (m)", "rod_length (cm)"],
            [4000, repr(1000 * 0.3 * DEG), repr(88 * DEG), 0.00015, 16])
        for column in ("bottom_height (mm)", "spindle_z (mm)"):
            self.assertAlmostEqual(rows[0][column], expected[column], delta=PRINTED)

    def test_feed_in_other_units(self):
        a = self.row(feed_in_mm_per_min=30, trigger_latency__delay_in_ms=3)
        b = self.row(feed_in_mm_per_s=0.5, trigger_latency__delay_in_s=0.003)
        self.assertAlmostEqual(a["spindle_z (mm)"], b["spindle_z (mm)"], delta=PRINTED)

    def test_windows_line_ends_and_byte_order_mark(self):
        run = self.run_text(b"\xef\xbb\xbfrod_radius (mm),beam_pitch (deg)\r\n5,0.1\r\n5,0.2\r\n")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual([line.split(",")[-1] for line in run.stdout.splitlines()], ["status", "ok", "ok"])

    def test_out_writes_the_same_bytes(self):
        text = "beam_pitch (deg)\n0.1\n0.2\n"
        printed = self.run_text(text).stdout
        run = self.run_text(text, "--out", self.folder / "out.csv")
        self.assertEqual((run.returncode, run.stdout), (0, ""))
        self.assertEqual((self.folder / "out.csv").read_text(), printed)

    def test_header_has_no_column_twice(self):
        # A table with readout and truth: whatever it does, no CSV with two columns of one name.
        run = self.run_text("spindle_z (mm),laser_z (mm)\n100,3\n")
        if run.returncode:
            self.assertIsNone(complaint(run))
        else:
            header = run.stdout.splitlines()[0].split(",")
            self.assertEqual(len(header), len(set(header)), header)

    # a scenario instead of a model

    def scenario(self, text, table, *more):
        (self.folder / "s.toml").write_text(text)
        (self.folder / "points.csv").write_text(table)
        return gumshoe("evaluate", self.folder / "s.toml", "--table", self.folder / "points.csv", *more)

    def test_values_of_a_scenario_stand_for_missing_columns(self):
        text = ("schema = 1\n[model]\nname = \"rod_gauging\"\n[conditions]\nfeed = \"30 mm/min\"\n[quantities]\n"
                "beam_pitch = { low = \"0.2 deg\", high = \"0.4 deg\", distribution = \"rectangular\" }\n"
                "[effects.trigger_latency]\ndelay = \"2 ms\"\n[indications.spindle_z]\nreadings = [\"100 mm\"]\n")
        run = self.scenario(text, "rod_radius (mm)\n4\n5\n")
        self.assertEqual(run.returncode, 0, run.stderr)
        found = list(csv.DictReader(io.StringIO(run.stdout)))
        rows = self.rows(["rod_radius (mm)", "beam_pitch (deg)", "feed (mm/min)", "trigger_latency.delay (ms)"],
                         (4, 0.3, 30, 2), (5, 0.3, 30, 2))
        for a, b in zip(found, rows):
            self.assertAlmostEqual(float(a["spindle_z (mm)"]), b["spindle_z (mm)"], delta=PRINTED)

    def test_the_machine_of_a_scenario(self):
        text = ("schema = 1\n[model]\nname = \"sphere_probing\"\nmethod = \"virtual_experiment\"\n[machine]\nname = \"three slides\"\n"
                "workpiece_side = [\"C\"]\ntool_side = [\"X\", \"Y\", \"Z\"]\n[quantities]\nsphere_x = \"100 mm\"\n")
        run = self.scenario(text, "C (deg),E_X0C (um)\n0,0\n90,0\n90,5\n")
        self.assertEqual(run.returncode, 0, run.stderr)
        found = list(csv.DictReader(io.StringIO(run.stdout)))
        # Behind C the sphere goes round; turned by 90 deg clockwise it stands at -Y. At 90 deg an axis off by e along X
        # moves it by e along X and by e along Y.
        for row, (x, y) in zip(found, ((100, 0), (0, -100), (0.005, -100 + 0.005))):
            self.assertAlmostEqual(float(row["X (mm)"]), x, delta=1e-9)
            self.assertAlmostEqual(float(row["Y (mm)"]), y, delta=1e-9)

    def test_a_row_without_a_finite_value_leaves_the_others_theirs(self):
        text = ("schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\ny = \"sqrt(a) / b\"\n[quantities]\n"
                "a = { value = 4, u = 0.1 }\nb = 1\n")
        run = self.scenario(text, "a,b\n4,1\n-1,1\n9,0\n16,2\n")
        self.assertEqual(run.returncode, 2)
        self.assertEqual(run.stdout.splitlines(), ["a,b,y (1),status", "4,1,2,ok", "-1,1,nan,not_finite", "9,0,nan,not_finite", "16,2,2,ok"])
        self.assertEqual(places(run, self.folder / "points.csv"), [(3, 1), (4, 1)])
        self.assertIn("the square root of a negative number (a = -1).", run.stderr)
        self.assertIn("division by zero (b = 0).", run.stderr)
        self.assertNotIn("estimates", run.stderr)

    def test_a_formula_that_the_table_does_not_ask_for_may_have_no_value(self):
        """Without readings the indications are simulated; the measurand's 1 / x is not needed."""
        text = ("schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\na = \"1 / x\"\n[model.indications]\nx = \"1 / a\"\n"
                "[quantities]\na = 4\n[indications.x]\nreadings = [0.25]\n")
        run = self.scenario(text, "a\n4\n")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertEqual(run.stdout.splitlines(), ["a,x (1),status", "4,0.25,ok"])

    def test_several_values_must_be_given(self):
        text = ("schema = 1\n[model]\nname = \"rod_gauging\"\n[quantities.rod_length.by.rod]\n1 = \"160 mm\"\n2 = \"180 mm\"\n"
                "[indications.spindle_z.readings]\nfile = \"read.csv\"\ncolumn = \"z\"\nunit = \"mm\"\nlabels = { rod = \"rod\" }\n")
        (self.folder / "read.csv").write_text("rod,z\n1,100\n2,120\n")
        run = self.scenario(text, "rod_radius (mm)\n5\n")
        self.assertIsNone(complaint(run))
        self.assertIn("column 'rod_length' is missing (the scenario has several values of it). Add a column 'rod_length (mm)'.",
                      run.stderr)
        self.assertEqual(self.scenario(text, "rod_length (mm)\n150\n").returncode, 0)

    def test_stated_effects_need_readings(self):
        text = ("schema = 1\n[model]\nname = \"rod_gauging\"\n[indications.spindle_z]\nreadings = [\"100 mm\"]\n"
                "[stated_effects.late]\nformula = \"feed\"\nunit = \"ms\"\nsize = \"1 ms\"\n")
        run = self.scenario(text, "rod_radius (mm)\n5\n")
        self.assertIsNone(complaint(run))
        self.assertIn("stated effects are not evaluated at points (their formulas belong to the readings). Leave their sizes out.",
                      run.stderr)

    # heights

    def test_recomputed_heights_of_the_thesis(self):
        """Fang 2022, Tables 2.2 to 2.7, recomputed from the angles as printed (reports/errata.md)."""
        standard, sharp, rod1, rod2 = (0.03, 90, 0), (0, 90, 0), (0.03, 89.922, 127.710), (0.03, 88.041, 144.086)
        cases = [
            (0, 0, sharp, 0), (0, 0, rod1, 0.004137), (0, 0, rod2, 0.137630),
            (0.6241, 0.2836, sharp, 0.024742), (0.6241, 0.2836, standard, 0.024594),
            (0.6241, 0.2836, rod1, 0.020515), (0.6241, 0.2836, rod2, 0.111943),
            (0.6240, 0.5729, sharp, 0.049983), (0.6240, 0.5729, rod1, 0.045606), (0.6240, 0.5729, rod2, 0.086855),
            (0.9424, 0.0911, sharp, 0.007948), (0.9424, 0.0911, rod1, 0.003851), (0.9424, 0.0911, rod2, 0.128072),
        ]
        rows = self.rows(["beam_yaw (deg)", "beam_pitch (deg)", "fillet_radius (mm)", "bottom_elevation (deg)", "bottom_azimuth (deg)"],
                         *((yaw, pitch, *rod) for yaw, pitch, rod, _ in cases))
        for case, row in zip(cases, rows):
            with self.subTest(case):
                self.assertAlmostEqual(row["bottom_height (mm)"], case[3], delta=0.5e-6 + 1e-9)

    def test_spindle_height_adds_up(self):
        row = self.row(beam_pitch_in_deg=0.2836, bottom_elevation_in_deg=88.041, bottom_azimuth_in_deg=144.086, rod_length_in_mm=179.822,
                       laser_z_in_mm=-509.866)
        self.assertAlmostEqual(row["spindle_z (mm)"], -509.866 + 179.822 + row["bottom_height (mm)"], delta=PRINTED)

    def test_other_fractions_of_a_straight_edge(self):
        # Square rod, level beam: the edge is a line at height k and covers (acos c - c sqrt(1 - c^2)) / pi of the disc, c = k / R_l.
        for c in (-0.7, -0.2, 0.0, 0.4, 0.95):
            fraction = (math.acos(c) - c * math.sqrt(1 - c * c)) / math.pi
            with self.subTest(c):
                row = self.row(fillet_radius_in_mm=0, beam_radius_in_mm=0.2, trigger_fraction_in_1=repr(fraction))
                self.assertAlmostEqual(row["bottom_height (mm)"], 0.2 * c, delta=1e-9)

    def test_never_covered_is_a_status_and_no_error(self):
        # A pin of radius r = R_l / 2 covers a strip at most: (2/pi)(asin(1/2) + (1/2) sqrt(3)/2) = 0.6090 of the disc.
        most = 2 / math.pi * (math.asin(0.5) + 0.5 * math.sqrt(0.75))
        rows = self.rows(["rod_radius (mm)", "fillet_radius (mm)", "beam_radius (mm)", "trigger_fraction"],
                         (0.1, 0, 0.2, repr(most - 1e-4)), (0.1, 0, 0.2, repr(most + 1e-4)), (0.1, 0, 0.2, 0.3))
        self.assertEqual([row["status"] for row in rows], ["ok", "never_covered", "ok"])
        self.assertTrue(math.isnan(rows[1]["bottom_height (mm)"]) and math.isnan(rows[1]["spindle_z (mm)"]))
        self.assertTrue(math.isfinite(rows[0]["bottom_height (mm)"]))

    def test_impossible_rows_are_named_and_the_others_computed(self):
        header = ["rod_radius (mm)", "fillet_radius (mm)", "trigger_fraction", "beam_pitch (deg)", "bottom_elevation (deg)", "beam_radius (mm)", "rod_length (mm)"]
        good = (5, 0.03, 0.5, 0, 90, 0.2, 150)
        bad = [(-5, 0.03, 0.5, 0, 90, 0.2, 150), (0, 0, 0.5, 0, 90, 0.2, 150), (5, 6, 0.5, 0, 90, 0.2, 150), (5, -0.1, 0.5, 0, 90, 0.2, 150),
               (5, 0.03, 0, 0, 90, 0.2, 150), (5, 0.03, 1, 0, 90, 0.2, 150), (5, 0.03, 0.5, 90, 90, 0.2, 150), (5, 0.03, 0.5, 0, 0, 0.2, 150),
               (5, 0.03, 0.5, 0, 180, 0.2, 150), (5, 0.03, 0.5, 0, 90, 0, 150), (5, 0.03, 0.5, 0, 90, 0.2, -1)]
        rows = self.rows(header, good, *bad, good, code=2)
        for row in rows[1:-1]:
            self.assertEqual(row["status"], "out_of_domain")
            self.assertTrue(math.isnan(row["bottom_height (mm)"]) and math.isnan(row["spindle_z (mm)"]))
        for row in (rows[0], rows[-1]):
            self.assertEqual(row["status"], "ok")
            self.assertAlmostEqual(row["spindle_z (mm)"], 150, delta=PRINTED)
        lines = self.stderr.splitlines()
        self.assertEqual(len(lines), len(bad))
        for line, number in zip(sorted(lines, key=lambda text: int(text.split(":")[1])), range(3, 3 + len(bad))):
            self.assertRegex(line, rf"points\.csv:{number}:\d+: error: ")
        self.assertIn((3, 1), [place for place in places(type("", (), {"stderr": self.stderr}), self.path)])

    # evaluation of readouts

    def test_readout_gives_the_beam_that_was_simulated(self):
        # Below 100 mm, so that 15 digits of each printed number are 5e-14 mm at most.
        header = ["beam_pitch (deg)", "beam_yaw (deg)", "bottom_elevation (deg)", "bottom_azimuth (deg)", "rod_length (mm)",
                  "z_scale.E_ZZ (um/m)", "trigger_latency.delay (ms)", "reclamp.shift (um)", "feed (mm/min)", "rod_runout.x (um)"]
        points = [(0, 0, 90, 0, 20, 0, 0, 0, 4, 0), (0.2836, 0.6241, 88.041, 144.086, 40, 0, 0, 0, 4, 0), (-3, 20, 85, -60, 30, 12, 2, 1.5, 30, 8)]
        truth = [30.0, 12.345678901234, -50.5]
        simulated = self.rows([*header, "laser_z (mm)"], *([*map(repr, point), repr(z)] for point, z in zip(points, truth)))
        evaluated = self.rows([*header, "spindle_z (mm)"], *([*map(repr, point), repr(row["spindle_z (mm)"])] for point, row in zip(points, simulated)))
        for z, there, back in zip(truth, simulated, evaluated):
            self.assertAlmostEqual(back["laser_z (mm)"], z, delta=1e-12)
            self.assertAlmostEqual(back["bottom_height (mm)"], there["bottom_height (mm)"], delta=1e-15)

    def test_evaluations_differ_by_the_bottom_height(self):
        header, point = ["spindle_z (mm)", "rod_length (mm)", "beam_pitch (deg)", "bottom_elevation (deg)", "bottom_azimuth (deg)"], (90, 40, 0.2836, 88.041, 144.086)
        full = self.rows(header, point)[0]
        conventional = self.rows(header, point, more=("--evaluation", "conventional"))[0]
        self.assertAlmostEqual(conventional["laser_z (mm)"], 50, delta=PRINTED)
        self.assertEqual(conventional["bottom_height (mm)"], 0)
        self.assertAlmostEqual(full["laser_z (mm)"], 50 - full["bottom_height (mm)"], delta=PRINTED)
        self.assertGreater(full["bottom_height (mm)"], 0.1)

    # effects: how far each one moves the readout of a square rod at a level beam, 150 mm long, laser_z = 0

    def moved(self, expected, **values):
        row = self.row(fillet_radius_in_mm=0, **values)
        self.assertAlmostEqual(row["spindle_z (mm)"], expected, delta=PRINTED)
        return row

    def test_trigger_latency(self):  # 30 mm/min = 0.5 mm/s, on the way down
        self.moved(150 - 0.5 * 0.003, trigger_latency__delay_in_ms=3, feed_in_mm_per_min=30)
        self.moved(150 + 0.5 * 0.003, trigger_latency__delay_in_ms=3, feed_in_mm_per_min=30, direction_in_1=1)
        self.moved(150 - 4 / 60 * 0.003, trigger_latency__delay_in_ms=3)

    def test_z_scale(self):  # actual = read (1 + E): the axis truly stands at 150 mm
        self.moved(150 / (1 + 10e-6), z_scale__E_ZZ_in_um_per_m=10)

    def test_thermal_growth(self):  # the nose has moved down, so the axis reads higher when the rod is at the beam
        self.moved(150 + 0.012 * 0.5, thermal_growth__rate_in_um_per_h=12, time_in_s=1800)
        self.moved(150 + 0.020 * (1 - math.exp(-0.5)), thermal_growth__amplitude_in_um=20, thermal_growth__time_constant_in_min=30, time_in_s=900)
        self.moved(150, thermal_growth__amplitude_in_um=20, thermal_growth__rate_in_um_per_h=12)

    def test_rod_expansion(self):  # 1.84 um/K at 160 mm of steel
        self.moved(160.00184, rod_expansion__temperature_difference_in_K=1, rod_length_in_mm=160)
        self.moved(160 - 2 * 160e3 * 1e-9, rod_expansion__temperature_difference_in_K=-2, rod_length_in_mm=160, rod_expansion__coefficient_in_um_per_m_per_K=1)

    def test_reclamp(self):
        self.moved(150.002, reclamp__shift_in_um=2)

    def test_z_reversal(self):  # lagging half of 4 um: higher than commanded on the way down
        self.moved(150 - 0.002, z_reversal__backlash_in_um=4)
        self.moved(150 + 0.002, z_reversal__backlash_in_um=4, direction_in_1=1)

    def test_beam_offset_along_the_beam(self):  # the beam rises towards +X: 4.95 um per mm
        here = self.row(beam_pitch_in_deg=0.2836)["bottom_height (mm)"]
        self.assertAlmostEqual(math.tan(0.2836 * DEG), 4.95e-3, delta=5e-6)
        for x in (1, -2.5):
            there = self.row(beam_pitch_in_deg=0.2836, beam_offset__x_in_mm=x)
            self.assertAlmostEqual(there["bottom_height (mm)"] - here, x * math.tan(0.2836 * DEG), delta=PRINTED)
            self.assertAlmostEqual(there["spindle_z (mm)"], 150 + there["bottom_height (mm)"], delta=PRINTED)

    def test_beam_offset_across_the_beam(self):
        # Bottom tilted across the beam: z = -cot(phi) y from its centre, a straight line as seen along the beam, sharp rim.
        # With the axis at y the line passes the beam's centre when the bottom's centre stands at -cot(phi) y.
        row = self.row(fillet_radius_in_mm=0, bottom_elevation_in_deg=88, bottom_azimuth_in_deg=90, beam_offset__y_in_mm=0.05)
        self.assertAlmostEqual(row["bottom_height (mm)"], -0.05 / math.tan(88 * DEG), delta=1e-9)

    def test_runout_turns_with_the_holder(self):  # x of the holder is Y of the machine, along a beam of yaw 90 deg
        rise = math.tan(0.2836 * DEG)
        here = self.row(beam_pitch_in_deg=0.2836, beam_yaw_in_deg=90)["bottom_height (mm)"]
        there = self.row(beam_pitch_in_deg=0.2836, beam_yaw_in_deg=90, holder_angle_in_deg=90, rod_runout__x_in_um=100)["bottom_height (mm)"]
        self.assertAlmostEqual(there - here, 0.1 * rise, delta=PRINTED)
        there = self.row(beam_pitch_in_deg=0.2836, beam_yaw_in_deg=90, rod_runout__y_in_um=100)["bottom_height (mm)"]
        self.assertAlmostEqual(there - here, 0.1 * rise, delta=PRINTED)

    def test_effects_at_null_change_no_bit(self):
        point = (0.2836, 88.041, 144.086)
        header = ["beam_pitch (deg)", "bottom_elevation (deg)", "bottom_azimuth (deg)"]
        plain = self.rows(header, point)[0]
        names = ["trigger_latency.delay (ms)", "z_scale.E_ZZ (um/m)", "thermal_growth.rate (um/h)", "thermal_growth.amplitude (um)",
                 "rod_expansion.temperature_difference (K)", "beam_offset.x (mm)", "beam_offset.y (mm)", "rod_runout.x (um)", "rod_runout.y (um)",
                 "z_reversal.backlash (um)", "reclamp.shift (um)"]
        null = self.rows([*header, *names], [*point, *[0] * len(names)])[0]
        for column in ("bottom_height (mm)", "spindle_z (mm)"):
            self.assertEqual(null[column], plain[column])


if __name__ == "__main__":
    unittest.main()
