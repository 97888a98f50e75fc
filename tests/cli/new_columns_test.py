"""What `gumshoe new` takes the columns of a data file for: position, reading, direction, times, temperatures.

usage: new_columns_test.py path/to/gumshoe [unittest options]
"""
import datetime
import json
import math
import random
import unittest

from program import gumshoe
from starter import Starter


class NewColumns(Starter):
    def test_a_column_of_both_signs_is_a_direction(self):
        """Whatever its name; a column of ones is not."""
        for signs, known in (((1, -1), True), ((1, 1), False)):
            rows = ["x_mm,leg,side,d_um"] + [f"{x},{w},1,{0.01 * x + w}" for w in signs for x in range(0, 60, 10)]
            (self.folder / "s.csv").write_text("\n".join(rows) + "\n")
            self.new("--from", "s.csv", "--out", "s.toml", "--force")
            self.assertEqual('direction = "leg"' in (self.folder / "s.toml").read_text(), known)

    def test_a_unit_says_more_than_a_name(self):
        """T may be a time or a temperature."""
        rows = ["x_mm;T_Lager [°C];T [s];d_um"] + [f"{x},0;{22 + x / 100};{x};{0.01 * x}".replace(".", ",") for x in range(0, 60, 10)]
        (self.folder / "t.csv").write_text("\n".join(rows) + "\n")
        said = self.new("--from", "t.csv", "--out", "t.toml")
        self.assertIn("T_Lager [°C]: temperature, degC (by its name)", said)
        self.assertIn("T [s]: time, s (by its name)", said)

    def test_symbols_of_quantities(self):
        """T_spindle, U_mV and rpm are no time, no uncertainty and no position; of days and returning parts."""
        rows = ["time_min,rpm,dz_um,T_spindle"] + [f"{t},{4000 * (t // 10 % 2)},{t % 7},{20 + t % 7}" for t in range(40)]
        (self.folder / "s.csv").write_text("\n".join(rows) + "\n")
        said = self.new("--from", "s.csv")
        self.assertIn("T_spindle: temperature, degC (by its name; degC by its numbers)", said)
        self.assertIn("rpm: used by its name, 1/min", said)
        self.assertIn("ready", said)
        rows = ["series,F_N,U_mV"] + [f"{k},{f},{0.002 * f}" for k in range(1, 5) for f in range(0, 600, 100)]
        (self.folder / "f.csv").write_text("\n".join(rows) + "\n")
        said = self.new("--from", "f.csv")
        self.assertIn("F_N: position, N", said)
        self.assertIn("U_mV: reading, mV", said)
        self.assertIn("# u = \"0.2 mV\"", (self.folder / "f.toml").read_text())
        rows = ["x_mm,d_um,u_um"] + [f"{x},{x % 3},0.2" for x in range(12)]
        (self.folder / "u.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("u_um: uncertainty, um", self.new("--from", "u.csv"))
        rows = ["Datum,tool,d_mm"] + [f"{d:02}.05.2026,T{k},{10 * k}" for d in range(4, 10) for k in (1, 2, 3, 4)]
        (self.folder / "d.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("Datum: cycle (by its dates)", self.new("--from", "d.csv"))
        self.assertIn('blocks = "datum"', (self.folder / "d.toml").read_text())
        rows = ["tool,d_mm"] + [f"T{k},{10 * k}" for d in range(6) for k in (1, 2, 3, 4)]
        (self.folder / "p.csv").write_text("\n".join(rows) + "\n")
        self.new("--from", "p.csv")
        self.assertIn("blocks = { count = 6 }", (self.folder / "p.toml").read_text())

    def test_what_is_no_reading(self):
        """A speed and the number of an insert come last, but are none; a feed is a condition, of several speeds."""
        rows = ["t_min,X_um,Y_um,T_spindle,rpm"] + [f"{k},{k * k * 7 % 131 / 10},{k * k * 5 % 113 / 10},{21 + k / 20},{6000 * (k // 10 % 2)}" for k in range(40)]
        (self.folder / "e.csv").write_text("\n".join(rows) + "\n")
        said = self.new("--from", "e.csv")
        self.assertIn("X_um: reading, um", said)
        self.assertIn("Y_um: reading, um", said)
        self.assertIn("rpm: used by its name, 1/min", said)
        said = self.new("--from", "e.csv", "--force", "--role", "X_um=reading", "Y_um=reading")
        self.assertIn("X_um: reading, um (by --role)", said)
        self.assertIn("Y_um: reading, um (by --role)", said)
        rows = ["time_s;d_mm;insert"] + [f"{6 * k};{30 + k * k % 97 * 0.0004:.4f};{k // 25 + 1}" for k in range(100)]
        (self.folder / "w.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("d_mm: reading, mm (as the last column of numbers)", self.new("--from", "w.csv"))
        rows = ["F_kN,S_mVV"] + [f"{k % 10},{k % 10 / 5 + k % 7 / 1e5:.5f}" for k in range(60)]
        (self.folder / "c.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("S_mVV: reading, mV/V", self.new("--from", "c.csv"))
        rows = ["repeat,angle_deg,feed_mm_min,radius_mm"] + [f"{n},{a},{f},{25 + (a * n * f % 7) / 1e4}" for n in (1, 2, 3) for f in (50, 200) for a in range(0, 360, 15)]
        (self.folder / "r.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("ready", self.new("--from", "r.csv"))
        self.assertIn('feed_mm_min = "feed_mm_min"', (self.folder / "r.toml").read_text().split("[data.conditions]")[1].split("[quant")[0])

    def test_what_is_no_position(self):
        """A pressure next to a target; a coordinate in coarse steps; runs side by side."""
        rows = ["Target (mm)\tError (um)\tPressure (mbar)"] + [f"{x}\t{x % 7}\t{1013 + x % 3}" for x in range(0, 60, 5)] * 2
        (self.folder / "p.txt").write_text("\n".join(rows) + "\n")
        self.assertIn("Pressure (mbar): used by its name", self.new("--from", "p.txt"))
        steps = [0, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3, 4, 4, 5, 1, 2, 3, 2, 6, 3] * 3 + [9, 11]
        rows = ["Time_min,Sphere_Y_mm,Diameter_mm"] + [f"{i},{200 + s / 1e4:.4f},{25 + i % 5 / 1e4}" for i, s in enumerate(steps)]
        (self.folder / "s.csv").write_text("\n".join(rows) + "\n")
        self.assertNotIn("position", self.new("--from", "s.csv"))

    def test_a_setting_of_few_numbers_tells_readings_apart(self):
        """Next to a position, numbers without a unit that are met often; a setting of two values is no position."""
        rows = ["QB,pressure_kPa,block,rate_um,point"] + [f"{flow},{x},{block},{x * x / flow:.3f},{x // 10}" for block in (1, 2) for flow in (200, 300) for x in range(10, 60, 10)]
        (self.folder / "p.csv").write_text("\n".join(rows) + "\n")
        self.new("--from", "p.csv")
        text = (self.folder / "p.toml").read_text()
        self.assertIn('qb = "QB"', text)
        self.assertNotIn('"point"', text) # the position under another name
        rows = ["stage,depth,density_um"] + [f"{stage},{100 * level},{level * level / 7:.3f}" for level in range(1, 9) for stage in (1, 2, 1, 2)]
        (self.folder / "q.csv").write_text("\n".join(rows) + "\n")
        self.new("--from", "q.csv", "--unit", "depth=none")
        text = (self.folder / "q.toml").read_text()
        self.assertIn('position = "depth"', text)
        self.assertIn('labels = { stage = "stage" }', text)

    def test_whole_numbers_that_count_passes_are_no_position(self):
        """A set, a start, whatever it is called: in each the same places come back. Of one place each it is a position."""
        for name, place, cycle in (("set", "pos_mm", True), ("start", "x_mm", True), ("Nummer", "Soll [N]", True), ("set", "feed_mm_min", False),
                                   ("tool_no", "x_mm", False), ("operator", "x_mm", False), ("insert", "x_mm", False), ("speed", "x_mm", False)):
            with self.subTest((name, place)):
                rows = [f"{name},{place},dev_um"] + [f"{s},{x},{(7 * s + x // 20) % 5 / 10}" for s in range(1, 6) for x in range(0, 60, 10)]
                (self.folder / "p.csv").write_text("\n".join(rows) + "\n")
                said = self.new("--from", "p.csv", "--force")
                self.assertEqual(f"{name}: cycle (as it numbers passes over the same places)" in said, cycle, said)
                if cycle:
                    self.assertIn(f"{place}: position", said)
        rows = ["start,tool,length_mm"] + [f"{s},T{k},{40 + k + s / 1e4}" for s in range(1, 9) for k in range(1, 6)]
        (self.folder / "p.csv").write_text("\n".join(rows) + "\n")
        said = self.new("--from", "p.csv", "--force")
        self.assertIn("start: cycle (as it numbers passes over the same places)", said)
        self.assertNotIn("position", said)
        rows = ["set,position (mm),error (um)"] + [f"{k + 1},{10 * (k % 5)},{k % 3}" for k in range(25)]
        (self.folder / "p.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("position (mm): position, mm", self.new("--from", "p.csv", "--force"))
        rows = ["set,d_um,x_mm"] + [f"{s},{(3 * s + k) % 5 / 10},{10 * s}" for s in range(1, 6) for k in range(4)]
        (self.folder / "p.csv").write_text("\n".join(rows) + "\n")
        self.assertNotIn("set: cycle", self.new("--from", "p.csv", "--force"))

    def test_days_are_a_time(self):
        """A check standard, measured once a week: the day tells its drift. Where it says nothing, new says why."""
        draw = random.Random(3)
        weeks = [datetime.date(2026, 1, 5) + datetime.timedelta(days=7 * k) for k in range(40)]
        forms = {"iso": "%Y-%m-%d", "german": "%d.%m.%Y", "month first": "%m/%d/%Y"}
        for name, form in forms.items():
            with self.subTest(name):
                rows = [f"{d.strftime(form)},{25 + 1e-4 * k + 2e-4 * draw.gauss(0, 1):.5f}" for k, d in enumerate(weeks)]
                (self.folder / "ring.csv").write_text("measured on,ring diameter (mm)\n" + "\n".join(rows) + "\n")
                self.assertIn("measured on: time (by its dates)", self.new("--from", "ring.csv", "--force"))
                run = gumshoe("trace", "ring.toml", "--draws", "99", "--force", "--json", "v.json", cwd=self.folder)
                self.assertEqual(run.returncode, 0, run.stderr)
                finding = json.loads((self.folder / "v.json").read_text())["findings"][0]
                self.assertEqual(finding["depends_on"], ["time"])
        # Weeks of which no day is above the twelfth, and which go on in either reading.
        days = [(1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (6, 7), (7, 8)]
        (self.folder / "ring.csv").write_text("day,reading (mm)\n" + "".join(f"{m:02}/{d:02}/2026,{25 + d / 1e4}\n" for m, d in days))
        self.assertIn("day: not used (its days and months may be read in either way: write them as 2026-02-03)", self.new("--from", "ring.csv", "--force"))

    def test_days_that_are_not_sure_are_no_time(self):
        """1 to 8 February, or a day of eight months? Then the times of day are no time either, and no label."""
        rows = [f"0{m}/02/2026,{h:02}:00,{10 * h},{0.1 * h:.1f}" for m in range(1, 9) for h in range(8, 14)]
        (self.folder / "d.csv").write_text("date,time,x (mm),error (um)\n" + "\n".join(rows) + "\n")
        said = self.new("--from", "d.csv")
        self.assertIn("date: cycle (by its dates)", said)
        self.assertIn("time: not used (its days and months may be read in either way: write them as 2026-02-03)", said)
        # A part was made before it was measured.
        days = [datetime.date(2026, 1, 5) + datetime.timedelta(days=k) for k in range(20)]
        (self.folder / "d.csv").write_text("made,measured on,d (mm)\n" + "".join(f"{d - datetime.timedelta(days=900 + 7 * k)},{d},{25 + k / 1e4}\n" for k, d in enumerate(days)))
        said = self.new("--from", "d.csv", "--force")
        self.assertIn("made: not used (the time is measured on)", said)
        self.assertIn("measured on: time (by its dates)", said)
        self.assertIn("d.toml: ready", said)

    def test_what_drifts_in_one_sweep_is_no_reading(self):
        for name, unit in (("pressure", "hPa"), ("battery", "V")):
            (self.folder / "d.csv").write_text(f"x (mm),{name} ({unit}),d (um)\n" + "".join(f"{10 * k},{12 + 0.01 * k:.3f},{math.sin(k):.2f}\n" for k in range(30)))
            self.assertIn("d (um): reading, um (as the last column of numbers)", self.new("--from", "d.csv", "--force"))

    def test_of_several_columns_the_reading_follows_what_was_set(self):
        draw = random.Random(5)
        rows = [(run, x, 0.2 * x + 1e-3 * draw.gauss(0, 1), 12 + 0.01 * draw.gauss(0, 1)) for run in range(1, 5) for x in range(11)]
        (self.folder / "cell.csv").write_text("run,torque (N m),bridge (mV/V),pack (V)\n" + "".join(f"{r},{x},{y:.4f},{v:.3f}\n" for r, x, y, v in rows))
        said = self.new("--from", "cell.csv")
        self.assertIn("bridge (mV/V): reading, mV/V (as it follows what was set)", said)
        self.assertIn("if this is what was read: --role 'pack (V)=reading'", said)
        # Two that follow it, or none: then their place.
        (self.folder / "cell.csv").write_text("run,torque (N m),bridge (mV/V),second (V)\n" + "".join(f"{r},{x},{y:.4f},{2 * y:.4f}\n" for r, x, y, v in rows))
        said = self.new("--from", "cell.csv", "--force")
        self.assertIn("second (V): reading, V (as the last column of numbers)", said)
        self.assertIn("--role 'bridge (mV/V)=reading'", said)

    def test_a_row_of_a_time_and_numbers_is_no_header(self):
        (self.folder / "d.csv").write_text("Time,Diameter, mm\n" + "".join(f"2026-01-{d:02} 08:00,25.00{d:02}\n" for d in range(1, 20)))
        said = self.new("--from", "d.csv", code=2)
        self.assertIn("d.csv:2:1: error: the first row holds numbers or dates, not names of columns (the lines above it have another number of cells)", said)

    def test_revolutions_temperatures_and_letters_with_marks(self):
        rows = ["Winkel [deg];Rev;T1;T2;Kühlmittel;Diff [arcsec]"]
        rows += [f"{a};{rev};{20 + rev};{40 + 2 * rev};{'an' if a % 60 else 'aus'};{math.sin(a):.3f}" for rev in range(1, 6) for a in range(0, 360, 30)]
        (self.folder / "turns.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("turns.toml: ready", self.new("--from", "turns.csv"))
        text = (self.folder / "turns.toml").read_text()
        self.assertIn('labels = { rev = "Rev", kuehlmittel = "Kühlmittel" }', text)
        self.assertIn('blocks = "rev"', text)
        self.assertIn('"T2" = "degC"', text)  # to 50: by itself it could be a time, or in degF


if __name__ == "__main__":
    unittest.main()
