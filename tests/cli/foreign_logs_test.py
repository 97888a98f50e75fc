"""Logs as other programs write them, from the file to a finding with `gumshoe new` and `trace --loop`: nothing is edited.

usage: foreign_logs_test.py path/to/gumshoe [unittest options]
"""
import math
import random
import unittest

from program import gumshoe
from traced_log import TracedLog


def german(x, places=2):
    return f"{x:.{places}f}".replace(".", ",")


class ForeignLogs(TracedLog):
    def foreign(self, name, content, *words, said=()):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        printed = self.new("--from", name, "--out", "s.toml", "--force", *words)
        for part in ("s.toml: ready", *said):
            self.assertIn(part, printed)
        self.text = (self.folder / "s.toml").read_text()

    def traced(self):
        return self.verdict("s.toml", "--loop", "4")

    def assert_axis(self, noise, depends=("position",)):
        """One loop leaves the noise, in sample and held out, to four standard deviations of their root mean squares."""
        found = self.traced()
        self.assertLessEqual(set(depends), {name for f in found["findings"] for name in f["depends_on"]})
        last = found["rounds"][-1]
        n = len(self.errors)
        self.assertAlmostEqual(last["after"] * 1e6 / noise, 1, delta=4 / math.sqrt(2 * n) + 0.15)  # fitted: up to a quarter of n
        # A fifth is held out, and predicted by a table of four means.
        self.assertLess(last["holdout_after"] * 1e6 / noise, math.sqrt(1.25) * (1 + 4 / math.sqrt(2 * n / 5)))
        self.assertGreater(found["rounds"][0]["before"] * 1e6, 2 * noise)
        return found

    def axis(self, seed, noise, reversal, runs=5, targets=range(0, 520, 40)):
        """[(run, way, target, error)] in um, in the order of an ISO 230-2 cycle."""
        draw = random.Random(seed)
        self.errors = [(run, way, x, 2.4 * math.sin(x / 70) + 0.01 * x + reversal * way + draw.gauss(0, noise))
                       for run in range(1, runs + 1) for way in (1, -1) for x in list(targets)[::way]]
        return self.errors

    def both(self, text):
        """The directions are told, and their reversal is fitted."""
        self.assertIn('direction = { column = "', self.text)
        self.assertIn(text, self.text)

    def test_targets_as_columns(self):
        errors = self.axis(21, 0.2, 0.6, targets=range(0, 450, 50))
        by_run = {}
        for run, way, x, e in errors:
            by_run.setdefault((run, "up" if way > 0 else "down"), {})[x] = f"{e:.2f}"
        rows = ["Run;Dir;" + ";".join(f"{x} mm" for x in range(0, 450, 50))]
        rows += [f"{run};{way};" + ";".join(cells[x] for x in range(0, 450, 50)) for (run, way), cells in by_run.items()]
        self.foreign("wide.csv", "\n".join(rows) + "\n", "--unit", "reading=um", said=["s.rows.csv: the runs of wide.csv one below the other", "position [mm]: position, mm"])
        lines = (self.folder / "s.rows.csv").read_text().splitlines()
        self.assertEqual(lines[0], "Run;Dir;position [mm];reading")
        self.assertEqual([line.split(";")[2] for line in lines[1:19]], [str(x) for x in [*range(0, 450, 50), *range(400, -50, -50)]])
        self.both('{ column = "Dir", map = { "down" = -1, "up" = 1 } }')
        self.assert_axis(0.2)

    def test_a_column_for_each_direction(self):
        errors = self.axis(22, 0.2, 0.9)
        at = {(run, way, x): f"{e:.2f}" for run, way, x, e in errors}
        rows = ["Cycle,Position (mm),Forward (um),Backward (um)"]
        rows += [f"{run},{x},{at[run, 1, x]},{at[run, -1, x]}" for run in range(1, 6) for x in range(0, 520, 40)]
        self.foreign("pairs.csv", "\n".join(rows) + "\n")
        lines = (self.folder / "s.rows.csv").read_text().splitlines()
        self.assertEqual(lines[0], "Cycle;Position (mm);direction;reading [um]")
        self.assertEqual([tuple(line.split(";")[:3]) for line in lines[13:15]], [("1", "480", "forward"), ("1", "480", "backward")])
        self.foreign("named.csv", "\n".join(["Cycle,Position (mm),Reading up (um),Reading down (um)", *rows[1:]]) + "\n")
        named = (self.folder / "s.rows.csv").read_text().splitlines()
        self.assertEqual([line.replace("up", "forward").replace("down", "backward") for line in named], lines)
        self.assert_axis(0.2)
        run = gumshoe("compensate", "s.traced.toml", "--with", "gain", "--with", "reversal", "--format", "linuxcnc-trim", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        for x, up, down in (map(float, line.split()) for line in run.stdout.splitlines()):
            # Means of 5 readings and of 26 for the play: 4 sigma of their difference, and half a step of rounding each.
            self.assertAlmostEqual((down - up) * 1e3, 2 * 0.9, delta=4 * 0.2 * math.sqrt(2 / 4) + 0.1, msg=x)

    def test_a_head_that_comes_again_and_cells_without_a_number(self):
        rows, errors = [], self.axis(23, 0.2, 0.8, runs=6, targets=range(0, 600, 60))
        for k, (run, way, x, e) in enumerate(errors):
            if k % 20 == 0:
                rows += ["Zyklus;Pos;Richt;Abw;", "-;mm;-;µm;"]
            rows.append(f"{run};{x};{'+' if way > 0 else '-'};{'---' if k == 27 else german(e)};")
        self.foreign("again.csv", "\r\n".join(rows) + "\r\n", said=["s.toml: ready"])
        self.assertIn("first_row = 3", self.text)
        explained = gumshoe("check", "s.toml", "--explain", cwd=self.folder)
        self.assertEqual(explained.returncode, 0, explained.stderr)
        self.assertIn("119 readings", explained.stdout)
        self.assert_axis(0.2)

    def test_a_laser_s_rtl(self):
        errors, targets = self.axis(24, 0.2, 0.7, targets=range(0, 650, 50)), list(range(0, 650, 50))
        at = {(run, way, x): e for run, way, x, e in errors}
        head = ["HEADER::", "File Type: RTL", "TARGET DATA::", "Filetype:LINEAR", "Target-count:13", "Targets :"]
        head += [" ".join(f"{x:12.4f}" for x in targets[i:i + 5]) for i in range(0, 13, 5)]
        head += ["Flags: 0", "USER-TEXT::", "Machine:M5", "Axis:Y", "RUNS::", "Run-count:10", "DEVIATIONS::", "Run Target Data:"]
        runs = [f"{2 * run - (way > 0)} {i} {at[run, way, x]:.3f}" for run in range(1, 6) for way in (1, -1) for i, x in enumerate(targets, 1)]
        self.foreign("y.rtl", "\r\n".join(head + runs + ["EQUIPMENT::", "Laser: 1 2 3", "ENVIRONMENT::", "1 2 3"]) + "\r\n",
                 said=["target [mm]: position, mm", "deviation [um]: reading, um"])
        lines = (self.folder / "s.rows.csv").read_text().splitlines()
        self.assertEqual(len(lines), 1 + 130)
        self.assertEqual(lines[14], f"2;-;600.0000;{at[1, -1, 600]:.3f}")
        self.assert_axis(0.2)
        # Runs of one direction have none; angles have no unit here.
        odd = [line for line in runs if not line.startswith("10 ")]
        (self.folder / "odd.rtl").write_text("\n".join(head + odd).replace("LINEAR", "Angular (pitch)"))
        said = gumshoe("new", "--from", "odd.rtl", cwd=self.folder).stdout
        self.assertIn("deviation: reading, unit unknown", said)
        self.assertNotIn("direction", said)

    def test_days_of_a_spreadsheet_and_signs_between_thousands(self):
        draw, rows = random.Random(25), ["Datum/Zeit;Temperatur Spindel [°C];Z-Position [µm]"]
        for k in range(96):
            t = 21 + 6 * (1 - math.exp(-k / 25))
            z = f"{1190 + 4.5 * (t - 21) + draw.gauss(0, 0.6):,.1f}".replace(",", "_").replace(".", ",").replace("_", ".")
            rows.append(f"{german(46085.3125 + k * 300 / 86400, 6)};{german(t)};{z}")
        self.assertTrue(any(z.split(";")[2].startswith("1.2") for z in rows) and any(len(z.split(";")[2]) == 7 for z in rows))
        self.foreign("days.csv", b"\xef\xbb\xbf" + "\r\n".join(rows).encode() + b"\r\n", said=["Z-Position [µm]: reading, um"])
        self.assertIn('time = { column = "Datum/Zeit", clock = "excel" }', self.text)
        found = self.traced()
        self.assertIn("temperatur_spindel_c", [name for f in found["findings"] for name in f["depends_on"]])
        self.assertAlmostEqual(found["rounds"][-1]["after"] * 1e6 / 0.6, 1, delta=4 / math.sqrt(2 * 96) + 0.05)

    def test_points_of_a_tracker_in_inches(self):
        draw, rows = random.Random(26), ["Point,X_nom_in,Y_nom_in,Z_nom_in,X_meas_in,Y_meas_in,Z_meas_in"]
        for k in range(54):
            x, y, z = draw.uniform(-20, 20), draw.uniform(-15, 15), draw.uniform(0, 25)
            at = (x + 0.004 + 3e-4 * x - 1e-4 * y + 1e-5 * z * z, y - 0.002 + 1e-4 * x, z + 0.001 - 2e-4 * z)
            rows.append(f"P{k + 1}," + ",".join(f"{v:.5f}" for v in (x, y, z, *(v + draw.gauss(0, 4e-4) for v in at))))
        self.foreign("points.csv", "\n".join(rows) + "\n", said=["X_nom_in: position, inch", "Z_meas_in: reading, inch"])
        found = self.traced()
        self.assertEqual([f["depends_on"] for f in found["findings"]], [["z_nom_in"]])
        self.assertAlmostEqual(found["rounds"][-1]["after"] / (4e-4 * 25.4e-3), 1, delta=4 / math.sqrt(2 * 3 * 40))

    def test_what_in_means(self):
        """An inch behind a length, a place behind anything else."""
        rows = ["pos_in,dev_in,T_in"] + [f"{x},{x % 3 / 1e4},{20 + x % 5 / 10}" for x in range(12)]
        self.foreign("in.csv", "\n".join(rows) + "\n", said=["pos_in: position, inch", "dev_in: reading, inch", "T_in: temperature, degC"])

    def test_contacts_of_a_macro_program(self):
        """DPRNT by a shipped description: the tip of a probe that grows as the spindle warms."""
        draw, rows = random.Random(27), ["%"]
        for k in range(72):
            x, y, z = 100 + draw.gauss(0, 6e-4), draw.gauss(0, 6e-4), -20 + 0.012 * (1 - math.exp(-k / 20)) + draw.gauss(0, 6e-4)
            rows.append(f"X {x:9.4f} Y {y:9.4f} Z {z:9.4f}".replace(" 0.", "  ."))
        self.foreign("dprnt.txt", "\r\n".join(rows + ["%"]) + "\r\n", "--form", "fanuc_dprnt", "--role", "z=reading", "--unit", "z=mm", "--unit", "x=mm",
                 "--unit", "y=mm")
        self.assertIn('form = "fanuc_dprnt.toml"', self.text)
        self.assertTrue((self.folder / "fanuc_dprnt.toml").exists())
        found = self.traced()
        self.assertEqual([f["depends_on"] for f in found["findings"]], [["order"]])
        self.assertAlmostEqual(found["rounds"][-1]["after"] / 0.6e-6, 1, delta=4 / math.sqrt(2 * 72) + 0.05)

    def test_several_cycles_in_one_protocol(self):
        """Diameters of a ring in four cycles, each with a head: nothing but noise. The dimension, 0 in all rows, is no position."""
        draw, rows = random.Random(28), []
        for k in range(48):
            if k % 12 == 0:
                rows += ["; TCH PROBE 421, made up", "Date: 03-02-2026", f"Time: {9 + k // 12}:00:00", "Type of dimension (0 = MM / 1 = INCH): 0"]
            rows.append(f"Q151 = {50 + draw.gauss(0, 8e-4):.4f} Q152 = {-30 + draw.gauss(0, 8e-4):.4f} Q153 = {25 + draw.gauss(0, 8e-4):.4f}")
        told = [w for name in ("centre_1", "centre_2", "diameter") for w in ("--unit", f"{name}=mm")]
        self.foreign("tchpr.txt", "\n".join(rows) + "\n", "--form", "heidenhain_q", "--role", "diameter=reading", *told)
        found = self.traced()
        self.assertEqual(found["findings"], [])
        self.assertAlmostEqual(found["rounds"][-1]["after"] / 0.8e-6, 1, delta=4 / math.sqrt(2 * 48))

    def test_forms_are_named(self):
        (self.folder / "log.txt").write_text("X 1 Y 2 Z 3\n")
        for words, said in ((("--from", "log.txt", "--form", "fanuc"), "--form: 'fanuc' is neither a file nor a description that is shipped. Use one of"),
                            (("--from", "log.txt", "--form", "heidenhain_p"), "Did you mean 'heidenhain_q'?"),
                            (("budget", "--form", "fanuc_dprnt"), "--form: there is no log that it would describe. Name the log by --from."),
                            (("--from", "log.txt", "--form", "heidenhain_q"), "no line of the log makes a row")):
            run = gumshoe("new", *words, cwd=self.folder)
            self.assertEqual(run.returncode, 2)
            self.assertIn(said, run.stderr)


if __name__ == "__main__":
    unittest.main()
