"""What `gumshoe new` says of rows: left out, copied, ended by a separator, with units in their cells.

usage: new_rows_test.py path/to/gumshoe [unittest options]
"""
import random
import unittest

from starter import Starter

HEADER = "day,operator,temp_degC,size_mm"


def rows(seed=1, count=40):
    draw = random.Random(seed)
    return [f"{i // 8 + 1},{'AB'[i % 2]},{20 + draw.gauss(0, 1):.1f},{25 + draw.gauss(0, 0.002):.4f}" for i in range(count)]


class Rows(Starter):
    def told(self, lines, code=0):
        (self.folder / "log.csv").write_text("\n".join(lines) + "\n")
        return self.new("--from", "log.csv", "--force", code=code)

    def test_rows_may_end_with_a_separator_and_the_header_not(self):
        said = self.told([HEADER] + [row + "," for row in rows()])
        self.assertIn("log.csv: 40 rows\n", said)
        self.assertIn("size_mm: reading, mm", said)
        self.assertIn("ready. Next:", said)
        self.assertNotIn("header =", (self.folder / "log.toml").read_text())

    def test_a_further_cell_with_a_text_is_no_end_of_a_row(self):
        self.assertIn("the row has 5 cells, the header 4", self.told([HEADER] + [row + ",x" for row in rows(count=1)], code=2))

    def test_units_of_electricity_mass_and_pressure_are_read_from_names(self):
        for unit in ("uV", "kV", "uA", "mA", "ohm", "mT", "psi", "g", "mg", "mN", "cm", "ns", "pA", "mmHg", "inHg", "degF", "kHz", "mL"):
            with self.subTest(unit):
                self.assertIn(f"signal_{unit}: reading, {unit} (", self.told([f"day,signal_{unit}"] + [f"{i // 5},{i * 7 % 11 / 10}" for i in range(30)]))
        self.assertIn("signal_percent: reading, % (", self.told(["day,signal_percent"] + [f"{i // 5},{i * 7 % 11 / 10}" for i in range(30)]))

    def test_a_letter_of_a_temperature_is_no_farad(self):
        for name, unit in (("Temp (F)", "degF"), ("temp_F", "degF"), ("T_F", "degF"), ("Temp (C)", "degC")):
            with self.subTest(name):
                said = self.told([f"{name},dia_um"] + [f"{68 + i * 7 % 11 / 10},{i * 5 % 13 / 10}" for i in range(30)])
                self.assertIn(f"{name}: temperature, {unit} (by its name)", said)
        self.assertIn("cap (F): reading, F", self.told(["day,cap (F)"] + [f"{i // 5},{i * 7 % 11 / 10}" for i in range(30)]))

    def test_a_month_is_a_label_and_what_tells_readings_apart_needs_no_unit(self):
        said = self.told(["month,day,load_N,dia_um"] + [f"{m},{d},{(7 * m + 3 * d) % 11},{(5 * m + d) % 13 / 10}" for m in (5, 6, 7) for d in range(1, 13)])
        self.assertIn("month: label, which tells readings apart\n", said)
        self.assertIn("load_N: position, N", said)

    def test_a_rate_is_no_time(self):
        said = self.told(["day,rate_ml_h"] + [f"{i // 5},{i * 7 % 11 / 10}" for i in range(30)])
        self.assertIn("rate_ml_h: reading, mL/h (", said)

    def test_a_column_that_is_told_to_be_another_is_recorded_and_no_reading(self):
        lines = ["day,flow_percent,size_mm"] + [f"{i // 5},{40 + i * 7919 % 1009 / 100},{i * 5 % 13 / 10}" for i in range(30)]
        self.told(lines)
        self.assertIn("[indications.flow_percent]", (self.folder / "log.toml").read_text())
        self.new("--from", "log.csv", "--force", "--role", "flow_percent=other")
        text = (self.folder / "log.toml").read_text()
        self.assertNotIn("[indications.flow_percent]", text)
        self.assertRegex(text, r'\[trace.columns\]\n(.*\n)*flow_percent = "flow_percent"')

    def test_units_in_cells_are_said(self):
        said = self.told([HEADER] + [row + " mm" for row in rows()], code=2)
        self.assertIn("log.csv:2:10: error: the cells of the column 'size_mm' are no numbers: '25.", said)
        self.assertIn("(they hold their unit). Write numbers alone, and the unit in the column's name, as size (mm).", said)
        other = self.told(["day,size_mm,width_um"] + [f"{i // 5},25.{i} mm,{i * 7 % 11 / 10}" for i in range(30)])
        self.assertIn("its cells hold their unit, as '25.0 mm'", other)

    def test_cells_beyond_a_limit_are_said(self):
        """An overflow, a detection limit: the error names the cell, whether the column was told or not."""
        for cell in ("OL", "<0.01"):
            lines = ["part,size_mm"] + [f"P{i % 5},{cell if i == 7 else 25 + i * 7 % 11 / 10}" for i in range(30)]
            for more in ((), ("--role", "size_mm=reading")):
                (self.folder / "log.csv").write_text("\n".join(lines) + "\n")
                said = self.new("--from", "log.csv", "--force", *more, code=2)
                self.assertIn(f"log.csv:9:4: error: the column 'size_mm' has a cell that is no number: '{cell}'. Leave such cells empty", said)

    def test_one_bad_cell_makes_no_position_the_reading(self):
        for cell in ("1 000", "6D-3", "0x10"):
            lines = ["x (mm),y (mm),temp_c"] + [f"{10 * i},{cell if i == 3 else i * 7 % 11 / 1000},{20 + i * 3 % 7 / 10}" for i in range(12)]
            self.assertIn(f"log.csv:5:4: error: the column 'y (mm)' has a cell that is no number: '{cell}'", self.told(lines, code=2))

    def test_what_was_read_may_have_the_name_of_a_condition(self):
        """A force that scatters next to settings; a time to failure; a coordinate to the right of its error."""
        for name in ("force [N]", "angle (deg)", "time_to_fail (s)", "T (degC)"):
            with self.subTest(name):
                lines = [f"dilution,{name},machine"] + [f"{(1, 2, 5)[i % 3]},{50 + i * 7919 % 1009 / 100},{'AB'[i % 2]}" for i in range(36)]
                said = self.told(lines)
                self.assertIn(f"{name}: reading", said)
                self.assertIn("dilution: label", said)
        lines = ["run,e (um),x (mm)"] + [f"{i // 6 + 1},{i * 7919 % 1009 / 100},{i % 6 * 50}" for i in range(36)]
        said = self.told(lines)
        self.assertIn("x (mm): position, mm", said)
        self.assertIn("e (um): reading, um", said)

    def test_a_label_under_a_second_name_and_one_that_never_changes(self):
        said = self.told(["part,part_id,rev,size_mm"] + [f"P{i % 5},{100 + i % 5},3,{25 + i * 7 % 11 / 10}" for i in range(30)])
        self.assertIn("part_id: not used, unit unknown (it divides the rows as part does)", said)
        self.assertIn("rev: not used (it is the same in every row)", said)

    def test_a_number_that_is_told_to_have_no_unit_stays_a_part(self):
        lines = ["day,size_mm"] + [f"{i // 5},{25 + i * 7 % 11 / 10}" for i in range(30)]
        self.told(lines)
        for more in (("--unit", "day=1"), ("--unit", "day=none"), ("--role", "day=label")):
            self.new("--from", "log.csv", "--force", *more)
            self.assertIn('labels = { day = "day" }', (self.folder / "log.toml").read_text(), more)

    def test_rows_that_are_left_out_are_counted(self):
        lines = rows()
        for i in (3, 17, 18):
            lines[i] = lines[i].rsplit(",", 1)[0] + ","
        self.assertIn("log.csv: 40 rows, of which 3 are left out: size_mm has no number there\n", self.told([HEADER] + lines))

    def test_rows_that_were_copied_are_said(self):
        lines = rows(2)
        said = self.told([HEADER] + lines[:24] + lines[12:24] + lines[24:])
        self.assertIn("  12 rows from line 26 on are those from line 14 on in every cell: were they copied?", said)

    def test_rows_that_recur_by_chance_are_not_said_to_be_copied(self):
        """Two readings a day in steps: rows of a day are equal in one of ten or twenty cases, and runs of them are rare."""
        for seed in range(20):
            draw = random.Random(seed)
            lines = [f"{i // 8 + 1},{'AB'[i % 2]},{draw.choice('0123456789')}" for i in range(80)]
            self.assertNotIn("copied", self.told(["day,operator,dev_um"] + lines))
        self.assertNotIn("copied", self.told(["operator,dev_um"] + ["A,1.5"] * 30 + ["A,1.6"] * 30))


if __name__ == "__main__":
    unittest.main()
