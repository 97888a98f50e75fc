"""`gumshoe new`: first scenarios from models and from data files, and what is left to fill in.

usage: new_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import random
import unittest

from program import complaint, gumshoe
from starter import Starter

# One axis, up and down, five cycles: a straight line, a reversal, and a ripple of 40 mm pitch that a line does not know.
HEADER = {"axis.csv": ("Cycle;Target [mm];Dir;Deviation [µm];Date/Time;Temp Scale (°C)", ";", ","),
          "plain.csv": ("run,position,direction,error,time,temp", ",", "."),
          "blanks.txt": ("cycle pos_mm dir dev_um time_s temp_degC", " ", ".")}


def deviation(x, sign, cycle, k):
    noise = 0.05 * math.sin(12.9898 * (k + 78.233 * cycle))
    return 1.5 + 0.01 * x + 0.8 * sign + 2 * math.sin(2 * math.pi * x / 40) + noise


def log(name):
    header, separator, decimal = HEADER[name]
    rows, k = [header], 0
    for cycle in range(1, 6):
        for sign, word in ((1, "fwd"), (-1, "bwd")):
            for x in range(0, 110, 10) if sign > 0 else range(100, -10, -10):
                k += 1
                clock = f"2026-02-03T10:{k // 60:02}:{k % 60:02}" if name != "blanks.txt" else str(k)
                numbers = [f"{v:.3f}".replace(".", decimal) for v in (x, deviation(x, sign, cycle, k), 20 + 0.001 * k)]
                rows.append(separator.join((str(cycle), numbers[0], word, numbers[1], clock, numbers[2])))
    return "\n".join(rows) + "\n"


class New(Starter):
    def write(self, name):
        (self.folder / name).write_text(log(name))

    def test_every_model_has_a_scenario_that_runs(self):
        models = [m["name"] for m in json.loads(gumshoe("models", "--format", "json").stdout)]
        self.assertGreater(len(models), 5)
        for model in [*models, "budget"]:  # and linear, below: it needs data
            with self.subTest(model):
                self.assertIn(f"{model}.toml: ready. Next: gumshoe run {model}.toml", self.new(model))
                run = gumshoe("run", f"{model}.toml", "--samples", "2000", "--out", f"{model}.h5", cwd=self.folder)
                self.assertEqual(run.returncode, 0, run.stderr)

    def test_a_model_on_a_described_machine_asks_for_the_machine(self):
        for model in ("sphere_probing", "serial_chain"):
            with self.subTest(model):
                self.assertIn(f"{model}.toml: the machine is that of the example. Replace [machine] by yours, then: gumshoe run {model}.toml", self.new(model))
                run = gumshoe("run", f"{model}.toml", "--samples", "2000", "--out", f"{model}.h5", cwd=self.folder)
                self.assertEqual(run.returncode, 0, run.stderr)

    def test_the_card_tells_every_quantity(self):
        self.new("rod_gauging")
        text = (self.folder / "rod_gauging.toml").read_text()
        for q in json.loads(gumshoe("models", "rod_gauging", "--format", "json").stdout)["quantities"]:
            self.assertIn(q["meaning"], text)
            self.assertIn(f"# {q['name']}: " if f"\n[quantities.{q['name']}]" in text else f"# [quantities.{q['name']}]", text)
        # What is commented out may be stated.
        stated = text.replace("# [quantities.", "[quantities.").replace("\n# value = ", "\nvalue = ")
        (self.folder / "all.toml").write_text(stated)
        self.assertEqual(gumshoe("check", "all.toml", cwd=self.folder).returncode, 0)

    def test_a_log_of_an_axis_is_traced_as_it_stands(self):
        for name in ("axis.csv", "blanks.txt"):
            self.write(name)
            said = self.new("--from", name)
            scenario = name.split(".")[0] + ".toml"
            self.assertIn(f"{scenario}: ready. Next: gumshoe trace {scenario}", said)
            run = gumshoe("trace", scenario, "--draws", "199", "--format", "json", cwd=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            verdict = json.loads(run.stdout)
            self.assertIn("position", verdict["findings"][0]["depends_on"])
            # The ripple is gone; what is left is the noise, whose root mean square is 0.05 um / sqrt(2).
            self.assertLess(verdict["rms"]["after"], 0.06e-6)
            self.assertGreater(verdict["rms"]["before"], 1e-6)
        text = (self.folder / "axis.toml").read_text()
        for part in ('decimal = ","', 'position = "Target [mm]"', '{ column = "Dir", map = { "bwd" = -1, "fwd" = 1 } }',
                     'labels = { cycle = "Cycle" }', '"Target [mm]" = "mm"', 'time = { column = "Date/Time", clock = "iso" }',
                     'temp_scale_c = "Temp Scale (°C)"', '"Deviation [µm]" = "um"', 'order = "time"', 'blocks = "cycle"'):
            self.assertIn(part, text)

    def test_what_the_file_does_not_say_is_to_be_filled_in(self):
        self.write("plain.csv")
        said = self.new("--from", "plain.csv")
        self.assertIn("plain.toml: to fill in, then gumshoe check plain.toml:", said)
        self.assertIn("temp: temperature, degC (by its name; degC by its numbers)", said)
        for column in ("position", "error"):
            self.assertIn(f"data.units.{column}: the unit of the column '{column}' is still to be told", said)
        check = gumshoe("check", "plain.toml", cwd=self.folder)
        self.assertEqual(check.returncode, 2)
        self.assertEqual(check.stderr.count(": error: data.units."), 2, check.stderr)
        text = (self.folder / "plain.toml").read_text()
        for unit in ('"position" = "mm"', '"error" = "um"', '"temp" = "degC"'):
            text = text.replace(unit.split(" = ")[0] + ' = "?"', unit)
        (self.folder / "plain.toml").write_text(text)
        self.assertEqual(gumshoe("check", "plain.toml", cwd=self.folder).returncode, 0)
        # The same by options.
        units = [w for c, u in (("position", "mm"), ("error", "um"), ("temp", "degC")) for w in ("--unit", f"{c}={u}")]
        self.assertIn("ready", self.new("--from", "plain.csv", "--out", "told.toml", *units))

    def test_measured_positions_are_told_from_errors(self):
        rows = ["soll_mm,ist_mm"] + [f"{x},{x + 0.001 * x % 7}" for x in range(0, 200, 10)]
        (self.folder / "p.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("ready", self.new("--from", "p.csv"))
        self.assertIn('measured = "position + offset + gain * position"', (self.folder / "p.toml").read_text())

    def test_an_offset_of_a_temperature_is_a_difference(self):
        """Of a thermometer against a reference, at 0 degC and not at 0 K; and a length against a temperature."""
        noise = (0.01, -0.02, 0.01)
        rows = ["run,ref_degC,reading_degC,grows_um"] + [f"{r},{t},{1.02 * t + 0.7 + noise[(t // 5 + r) % 3]},{3 + 0.5 * t + noise[r - 1]}"
                                                         for r in (1, 2, 3) for t in range(0, 60, 5)]
        (self.folder / "t.csv").write_text("\n".join(rows) + "\n")
        for reading, formula, offset, gain in (("reading_degC", "position + offset + gain", ("K", 0.7), ("K/K", 0.02)),
                                               ("grows_um", "offset + gain", ("um", 3), ("um/K", 0.5))):
            self.assertIn("ready", self.new("--from", "t.csv", "--role", f"{reading}=reading", "--unit", "ref_degC=degC", "--force"))
            text = (self.folder / "t.toml").read_text()
            self.assertIn(f'"{formula} * (position - reference)"', text)
            for part in (f'"0 {offset[0]}"', f'"0 {gain[0]}"', 'reference = "0 degC"'):
                self.assertIn(part, text)
            self.assertRegex(text, '"ref_degC" = "degC" +# as told')
            run = gumshoe("estimate", "t.toml", "--format", "json", cwd=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            sizes = json.loads(run.stdout)["parameters"]
            for name, (unit, value) in (("offset", offset), ("gain", gain)):
                self.assertEqual(sizes[name]["unit"], unit)
                self.assertAlmostEqual(sizes[name]["value"], value, delta=0.01)

    def test_offsets_of_several_set_temperatures_are_differences(self):
        draw, rows = random.Random(3), ["set_a_degC,set_b_degC,act_a_degC,act_b_degC"]
        for _ in range(40):
            a, b = draw.uniform(0, 80), draw.uniform(0, 80)
            rows.append(",".join(f"{x:.3f}" for x in (a, b, 1.01 * a + 0.5, b - 0.3 + 0.02 * a)))
        (self.folder / "s.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("ready", self.new("--from", "s.csv"))
        self.assertIn('"set_a_degc + act_a_degc_offset + act_a_degc_by_set_a_degc * (set_a_degc - reference)', (self.folder / "s.toml").read_text())
        run = gumshoe("estimate", "s.toml", "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        sizes = json.loads(run.stdout)["parameters"]
        for name, value in (("act_a_degc_offset", 0.5), ("act_b_degc_offset", -0.3)):
            self.assertEqual(sizes[name]["unit"], "K")
            self.assertAlmostEqual(sizes[name]["value"], value, delta=0.01)

    def test_rows_without_a_number_and_counts_of_rows(self):
        rows = "".join(f"{i};{10 * i};{'' if i == 3 else f'1,{i}'};{'+' if i % 2 else '-'}\r\n" for i in range(1, 8))
        (self.folder / "g.csv").write_bytes(("\ufeffNr;Pos_X (mm);Messwert [um];Side\r\n" + rows).encode())
        said = self.new("--from", "g.csv")
        self.assertIn("g.toml: ready", said)
        self.assertIn("Nr: time (as it counts the readings)", said)
        text = (self.folder / "g.toml").read_text()
        for part in ('where = { "Messwert [um]" = { not = "" } }', 'readings = "Messwert [um]"', '# blocks = { count = 6 }',
                     'direction = { column = "Side", map = { "+" = 1, "-" = -1 } }'):
            self.assertIn(part, text)
        explained = gumshoe("check", "g.toml", "--explain", cwd=self.folder).stdout
        self.assertEqual(explained.count("one indication"), 6)

    def test_channels_of_a_laser(self):
        """Errors of one kind at the same positions are read together, each with an offset and a slope of its own."""
        rows = ["Run,Direction,Position (mm),Linear (um),Horizontal (um),Pitch (arcsec),Humidity (%)"]
        rows += [f"{n},{'+' if way > 0 else '-'},{p},{p / 100 + p % 7 / 10},{p % 11 / 10},{p % 13 / 10},{40 + n + p / 1000}"
                 for n in (1, 2, 3) for way in (1, -1) for p in range(0, 1001, 50)[::way]]
        (self.folder / "l.csv").write_text("\n".join(rows) + "\n")
        said = self.new("--from", "l.csv")
        for part in ("Linear (um): reading, um", "Horizontal (um): reading, um", "Pitch (arcsec): not used", "Humidity (%): used by its name, %", "ready"):
            self.assertIn(part, said)
        self.assertIn("horizontal_um_offset + horizontal_um_gain * position + horizontal_um_reversal * direction", (self.folder / "l.toml").read_text())
        said = self.new("--from", "l.csv", "--role", "Pitch (arcsec)=reading", "--force")
        self.assertIn("Pitch (arcsec): reading, arcsec (by --role)", said)
        self.assertIn("Linear (um): not used", said)
        said = self.new("--from", "l.csv", "--role", "Horizontal (um)=reading", "--force")
        self.assertIn("Linear (um): not used", said)
        self.assertIn('deviation = "offset + gain * position + reversal * direction"', (self.folder / "l.toml").read_text())

    def test_coordinates_at_their_targets(self):
        """A robot that is read in three coordinates: an affine map is fitted, and what bends beyond it is found."""
        draw, rows = random.Random(8), ["pose,cmd_x_mm,cmd_y_mm,cmd_z_mm,act_x_mm,act_y_mm,act_z_mm"]
        for k in range(60):
            x, y, z = draw.uniform(600, 1200), draw.uniform(-500, 500), draw.uniform(200, 900)
            act = (x + 0.3 + 4e-4 * x - 2e-4 * y, y - 0.1 + 2e-4 * x, z + 0.2 - 1e-6 * (x - 900) ** 2)
            rows.append(",".join(f"{v:.3f}" for v in (k + 1, x, y, z, *(a + draw.gauss(0, 0.01) for a in act))))
        (self.folder / "q.csv").write_text("\n".join(rows) + "\n")
        self.assertIn("ready", self.new("--from", "q.csv"))
        run = gumshoe("trace", "q.toml", "--draws", "199", "--format", "json", "--out", "q.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        v = json.loads(run.stdout)
        self.assertEqual([f["depends_on"] for f in v["findings"]], [["cmd_x_mm"]])
        self.assertIn("act_z_mm", v["findings"][0]["described_by"])
        # 13 directions of 60 readings are fitted; the noise is 0.01 mm.
        self.assertAlmostEqual(v["rms"]["after"], 10e-6, delta=3.5 * 10e-6 / math.sqrt(2 * 3 * 45))

    def test_runs_side_by_side(self):
        """As sheets of ISO 230-2 have them, with and without a line of units."""
        for units, option in ((["mm;um;um;um;um"], ()), ([], ("--unit", "reading=um", "--unit", "Pos=mm"))):
            rows = ["Pos;R1+;R1-;R2+;R2-"] + units + [f"{x};1,{x};2,{x};3,{x};4,{x}" for x in range(10, 70, 5)]
            (self.folder / "w.csv").write_text("\n".join(rows) + "\n")
            said = self.new("--from", "w.csv", "--force", *option)
            self.assertIn("w.rows.csv: the runs of w.csv one below the other", said)
            self.assertIn("ready", said)
            lines = (self.folder / "w.rows.csv").read_text().splitlines()
            self.assertEqual(len(lines), 1 + 4 * 12)
            self.assertEqual((lines[1], lines[13]), ("10;1;+;1,10", "65;1;-;2,65"))  # the way back begins where it ends
            text = (self.folder / "w.toml").read_text()
            for part in ('file = "w.rows.csv"', 'labels = { run = "run" }', 'map = { "+" = 1, "-" = -1 }', 'decimal = ","'):
                self.assertIn(part, text)

    def test_runs_side_by_side_with_their_unit(self):
        for form in ("Cycle {} [um]", "run {} (um)", "series{}_um"):
            header = ";".join(["Target [mm]"] + [form.format(k) for k in range(1, 6)])
            (self.folder / "w.csv").write_text("\n".join([header] + [f"{x};1;2;3;4;5" for x in range(0, 110, 10)]) + "\n")
            self.assertIn("ready", self.new("--from", "w.csv", "--force"), form)
            self.assertEqual((self.folder / "w.rows.csv").read_text().splitlines()[:2], ["Target [mm];run;reading [um]", "0;1;1"])
            text = (self.folder / "w.toml").read_text()
            for part in ('readings = "reading [um]"', 'labels = { run = "run" }', 'position = "Target [mm]"'):
                self.assertIn(part, text, form)

    def test_runs_side_by_side_whose_direction_comes_first(self):
        """Columns in the order of the runs or of the directions: each run goes up, then down, from the last target back."""
        for up, down in (("up_{}_um", "down_{}_um"), ("up{}_um", "down{}_um"), ("fwd{} (um)", "bwd{} (um)"),
                         ("Up run {} [um]", "Down run {} [um]")):
            for order in ([(1, up), (1, down), (2, up), (2, down)], [(1, up), (2, up), (1, down), (2, down)]):
                with self.subTest(up, order=order):
                    header = ["target_mm"] + [form.format(run) for run, form in order]
                    value = {(1, up): 1, (1, down): 2, (2, up): 3, (2, down): 4}
                    rows = [";".join([str(x), *(f"{value[one]}.{x}" for one in order)]) for x in range(10, 70, 5)]
                    (self.folder / "w.csv").write_text("\n".join([";".join(header), *rows]) + "\n")
                    said = self.new("--from", "w.csv", "--force")
                    self.assertIn("w.rows.csv: the runs of w.csv one below the other", said)
                    self.assertIn("ready", said)
                    lines = [line.split(";") for line in (self.folder / "w.rows.csv").read_text().splitlines()]
                    self.assertEqual(lines[0], ["target_mm", "run", "direction", "reading [um]"])
                    self.assertEqual([line[1] for line in lines[1::12]], ["1", "1", "2", "2"])
                    self.assertEqual([line[3] for line in lines[1::12]], ["1.10", "2.65", "3.10", "4.65"])
                    text = (self.folder / "w.toml").read_text()
                    for part in ('labels = { run = "run" }', " = 1", " = -1"):
                        self.assertIn(part, text)
        # Of one direction alone, of a position, or twice the same, such names say no run.
        for names in ("up_1_um;up_2_um", "pos1_mm;pos2_mm", "up_1_um;up_01_um;down_1_um"):
            with self.subTest(names):
                values = [";".join([str(x), *(f"{k}.{x}" for k in range(len(names.split(";"))))]) for x in range(10, 70, 5)]
                (self.folder / "w.csv").write_text("\n".join([f"target_mm;{names}", *values]) + "\n")
                said = gumshoe("new", "--from", "w.csv", "--force", cwd=self.folder)
                self.assertEqual(said.returncode, 0, said.stderr)
                self.assertNotIn("w.rows.csv", said.stdout + said.stderr)

    def test_a_gain_of_plain_numbers(self):
        (self.folder / "g.csv").write_text("run,load (kN),reading (1)\n" + "".join(f"{r},{x},{0.5 * x + r % 2 / 1e3}\n" for r in (1, 2, 3) for x in range(10)))
        self.assertIn("ready", self.new("--from", "g.csv"))
        check = gumshoe("check", "g.toml", cwd=self.folder)
        self.assertEqual(check.returncode, 0, check.stderr)

    def test_a_calibration_log(self):
        """Units after a blank, a series that is no position, a force, an indication of another kind."""
        rows = ["Reihe\tLage\tStufe\tLast kN\tAnzeige mV/V\tTemp °C"]
        rows += [f"{k}\t{k * 90} Grad\tauf{s}\t{5 * s},0\t{0.2 * s:.3f}\t21,4".replace(".", ",") for k in range(1, 5) for s in range(11)]
        (self.folder / "dms.txt").write_text("\r\n".join(["# Pruefer: M. Muster"] + rows) + "\r\n", encoding="latin-1")
        self.assertIn("ready", self.new("--from", "dms.txt"))
        text = (self.folder / "dms.toml").read_text()
        for part in ('position = "Last kN"', '"Last kN" = "kN"', '"Anzeige mV/V" = "mV/V"', 'readings = "Anzeige mV/V"', 'blocks = "reihe"',
                     'deviation = "offset + gain * position"'):
            self.assertIn(part, text)

    def test_columns_of_a_model(self):
        (self.folder / "rods.csv").write_text("rod,spindle_z_mm,feed (mm/min)\na,-330.1,4\na,-330.2,4\nb,-331.0,8\nb,-331.1,8\n")
        self.assertIn("ready", self.new("rod_gauging", "--from", "rods.csv"))
        text = (self.folder / "rod_gauging.toml").read_text()
        for part in ('readings = "spindle_z_mm"', 'feed = "feed (mm/min)"', 'labels = { rod = "rod" }'):
            self.assertIn(part, text)
        (self.folder / "rods.csv").write_text("rod,a_mm,b_mm\na,-330.1,4\nb,-331.0,8\n")
        said = self.new("laser_ball_bar", "--from", "rods.csv")
        self.assertIn("indications.length_1.readings.column: 'rods.csv' has no column '?'. Use one of rod, a_mm, b_mm.", said)

    def test_files_as_programs_write_them(self):
        """Lines above the names, units below them, cells without a number, dates apart from times: all is one axis."""
        draw = random.Random(4)
        plan = [(x, s) for _ in range(5) for s in (1, -1) for x in range(0, 500, 50)[::s]]
        rows = [(x, 0.01 * x + 0.6 * s + draw.gauss(0, 0.3), s) for x, s in plan]
        files = {
            "units": ("pos;dev\n[mm];um\n" + "".join(f"{x};{y:.2f}\n" for x, y, s in rows), "first_row = 3"),
            "above": ("Machine: M 5\nDate: 2026-01-02\n\nPos [mm],Dev [um]\n" + "".join(f"{x},{y:.2f}\n" for x, y, s in rows), "header = 4"),
            "ends": ("pos_mm,dev_um,\n" + "".join(f"{x},{y:.2f},\n" for x, y, s in rows), 'repeats = "apart"'),
            "gaps": ("pos_mm,dev_um\n" + "".join(f"{x},{'NaN' if i == 7 else '-' if i == 9 else f'{y:.2f}'}\n" for i, (x, y, s) in enumerate(rows)),
                     '"dev_um" = { not = ["-", "NaN"] }'),
            "dates": ("Date,Time,pos_mm,dev_um\n" + "".join(f"03/01/2026,{8 + i // 60}:{i % 60:02d}:00 AM,{x},{y:.2f}\n" for i, (x, y, s) in enumerate(rows)),
                      'time = { column = ["Date", "Time"], clock = "%m/%d/%Y %I:%M:%S %p" }')}
        for name, (text, line) in files.items():
            (self.folder / f"{name}.csv").write_text(text)
            self.assertIn("ready", self.new("--from", f"{name}.csv"))
            self.assertIn(line, (self.folder / f"{name}.toml").read_text())
            run = gumshoe("trace", f"{name}.toml", "--draws", "99", "--format", "json", cwd=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            # The positions tell the way up from the way down: a reversal, and nothing else.
            self.assertIn("sense = true", (self.folder / f"{name}.toml").read_text())
            self.assertEqual(json.loads(run.stdout)["findings"], [], name)
        (self.folder / "signs.csv").write_text("pos_mm;dev_um\n" + "".join(f"{x};1 00{x % 7}.25\n" for x in range(20)))
        self.assertIn("signs.csv:2:3: error: '1 000.25' is not a number (the column 'dev_um' has the readings)", self.new("--from", "signs.csv", code=2))

    def test_a_linear_model_of_any_columns(self):
        """Three machines, of which one has another slope; coefficients within three of their u, 0.01 to 0.02 N."""
        draw = random.Random(3)
        rows = ["machine;load (N);temp_C;force [N];time (min);mood"]
        for i in range(48):
            machine, load, t = "abc"[i % 3], 10 * (i // 3 % 4), round(20 + draw.uniform(-1, 1), 3)
            force = 5 + 0.3 * load + {"a": 0, "b": 2 + 0.05 * load, "c": -1}[machine] + 0.7 * (t - 20) + draw.gauss(0, 0.02)
            rows.append(f"{machine};{load};{t};{force:.4f};{i};{i}!")
        (self.folder / "f.csv").write_text("\n".join(rows) + "\n")
        terms = [w for t in ("load", "machine", "machine*load", "temp") for w in ("--term", t)]
        self.assertIn("linear.toml: ready. Next: gumshoe trace linear.toml", self.new("linear", "--from", "f.csv", *terms))
        text = (self.folder / "linear.toml").read_text()
        for part in ('machine_b = { column = "machine", map = { "a" = 0, "b" = 1, "c" = 0 } }', 'by_load = { estimated = true, value = "0 N/N" }',
                     'by_temp * (temp - reference_temperature)', 'order = "time"'):
            self.assertIn(part, text)
        run = gumshoe("estimate", "linear.toml", "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        found = json.loads(run.stdout)["parameters"]
        for name, true in {"constant": 5, "by_load": 0.3, "by_machine_b": 2, "by_machine_c": -1, "by_machine_b_load": 0.05,
                           "by_machine_c_load": 0, "by_temp": 0.7}.items():
            self.assertAlmostEqual(found[name]["value"], true, delta=3 * found[name]["standard_uncertainty"], msg=name)
            self.assertLess(found[name]["standard_uncertainty"], 0.05, name)
        self.new("linear", "--from", "f.csv", "--out", "plain.toml")  # every column of numbers
        self.assertIn('force = "constant + by_load * load + by_temp * (temp - reference_temperature)"', (self.folder / "plain.toml").read_text())
        for words, said in ((("linear",), "a linear model is made of the columns of a data file, but none is named"),
                            (("--from", "f.csv", "--term", "load"), "--term: only a linear model has terms"),
                            (("linear", "--from", "f.csv", "--term", "lod"), "--term: 'f.csv' has no column 'lod' other than its readings 'force [N]'"),
                            (("linear", "--from", "f.csv", "--term", "mood"), "--term: the column 'mood' has 48 different words in 48 rows"),
                            (("linear", "--from", "f.csv", "--role", "force [N]=other"), "f.csv: there is no column of readings")):
            self.assertIn(said, self.new(*words, code=2))
        # A column of readings that is told to be a position is replaced by the one that is left; people are labels.
        (self.folder / "pair.csv").write_text("ours_ppb,theirs_ppb,operator\n" + "".join(f"{x * 1.1:.2f},{x}.0{x % 2},{x % 2}\n" for x in range(12)))
        self.new("--from", "pair.csv", "--role", "theirs_ppb=position")
        text = (self.folder / "pair.toml").read_text()
        for line in ('readings = "ours_ppb"', 'position = "theirs_ppb"', 'labels = { operator = "operator" }', '"ours_ppb" = "ppb"'):
            self.assertIn(line, text)
        (self.folder / "fast.csv").write_text("Expt,speed_km_s\n" + "".join(f"{x % 3},{x}.5\n" for x in range(12)))
        self.assertIn("Expt: cycle (by its name)\n  speed_km_s: reading, km/s", self.new("--from", "fast.csv"))
        (self.folder / "one.csv").write_text("force_N\n1\n2\n")
        self.assertIn("there is no column but the readings", self.new("linear", "--from", "one.csv", code=2))

    def test_a_grid_of_two_coordinates(self):
        """The second coordinate is asked for its unit like the first, and then a condition."""
        rows = ["X,Y,rep,dX_um"] + [f"{x},{y},{r},{0.01 * y + 0.1 * (x % 3):.2f}" for r in range(4) for x in range(0, 50, 10) for y in range(0, 30, 10)]
        (self.folder / "grid.csv").write_text("\n".join(rows) + "\n")
        said = self.new("--from", "grid.csv", code=0)
        self.assertIn("data.units.X: the unit of the column 'X' is still to be told", said)
        self.assertIn("data.units.Y: the unit of the column 'Y' is still to be told", said)
        self.assertIn("grid.toml: ready", self.new("--from", "grid.csv", "--force", "--unit", "X=mm", "--unit", "Y=mm"))
        self.assertIn('y = "Y"', (self.folder / "grid.toml").read_text())

    def test_mistakes(self):
        self.write("axis.csv")
        for words, said in ((("rod_gaugin",), "unknown model 'rod_gaugin'. Did you mean 'rod_gauging'?"),
                            ((), "neither a model nor a data file is named"),
                            (("budget", "--from", "axis.csv"), "--from: a budget has no data file"),
                            (("--from", "axis.csv", "--unit", "Dir"), "--unit: 'Dir' is not COLUMN=VALUE"),
                            (("--from", "axis.csv", "--unit", "Dirr=mm"), "--unit: 'axis.csv' has no column 'Dirr'. Did you mean 'Dir'?"),
                            (("--from", "axis.csv", "--role", "Dir=place"), "--role: 'place' is no role of a column. Use one of"),
                            (("--from", "none.csv"), "none.csv")):
            err = self.new(*words, code=2)
            self.assertIn(said, err)
        for text, said in (("1,2\n3,4\n", "the first row holds numbers or dates, not names of columns"), ("a,b\n", "the file has no rows"),
                           ("a,b\nx,y\nz,w\n", "there is no column of readings")):
            (self.folder / "bad.csv").write_text(text)
            self.assertIn(said, self.new("--from", "bad.csv", code=2))
        self.new("budget")
        (self.folder / "budget.toml").write_text("mine")
        self.assertIn("'budget.toml': not overwritten (a file stands there)", self.new("budget", code=2))
        self.new("budget", "--force")
        self.assertIsNone(complaint(gumshoe("new", "x", cwd=self.folder)))


if __name__ == "__main__":
    unittest.main()
