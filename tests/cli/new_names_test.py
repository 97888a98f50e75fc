"""`gumshoe new` from files whose columns have unusual names and cells: what it writes is a scenario that `check` accepts.

usage: new_names_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import unittest

from program import gumshoe
from starter import Starter

# Constants and functions of formulas, numbers with units, words of TOML, signs, letters with marks, words of `new` itself.
NAMES = ["e", "E", "é", "pi", "log", "max", "3D", "10 mm", "1x", "1", "1e3", "-5", "位置", "_", "__", "a b", "a.b",
         "a#b", "a=b", "a\\b", 'say "x"', "it's", "a,b", "a;b", "[data]", "{x}", "*", "a\tb", "true", "nan", "inf",
         "schema", "column", "reading", "row", "block", "offset", "gain", "reversal", "deviation", "measured",
         "direction", "position", "constant", "x_offset", "label", "order"]


def table(header, rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([header, *rows])
    return text.getvalue()


class NewNames(Starter):
    def good(self, text, *more):
        """Writes a scenario of the table; check must accept it. Returns what new said and wrote."""
        (self.folder / "d.csv").write_text(text)
        said = self.new(*more, "--from", "d.csv", "--out", "d.toml", "--force")
        run = gumshoe("check", "d.toml", cwd=self.folder)
        written = (self.folder / "d.toml").read_text()
        self.assertEqual(run.returncode, 0, f"{run.stderr}\n{text[:200]}\n{written}")
        return said, written

    def test_a_column_may_have_any_name(self):
        noise = [0.7 * k * k % 1 for k in range(24)]
        tables = {
            "reading over time": lambda n: (["time_s", n], [(k, y) for k, y in enumerate(noise)]),
            "reading at positions": lambda n: (["pos_mm", n], [(k % 6 * 50, y) for k, y in enumerate(noise)]),
            "words": lambda n: (["pos_mm", "err_um", n], [(k % 6 * 50, y, "AB"[k // 12]) for k, y in enumerate(noise)]),
            "four words": lambda n: (["pos_mm", "err_um", n], [(k % 6 * 50, y, "ABCD"[k // 6]) for k, y in enumerate(noise)]),
            "two ways": lambda n: (["pos_mm", n, "way"], [(k % 6 * 50, y, ("up", "down")[k // 6 % 2]) for k, y in enumerate(noise)]),
            "second reading": lambda n: (["pos_mm", "x_um", n], [(k % 6 * 50, y, y * y % 0.3) for k, y in enumerate(noise)]),
        }
        for name in NAMES:
            for of, make in tables.items():
                with self.subTest(name=name, of=of):
                    header, rows = make(name)
                    plain = of in ("words", "four words") or (of, name) == ("second reading", "direction")
                    options = [] if plain else [f"--unit={name}=um"]
                    if of in ("reading over time", "reading at positions", "two ways"):
                        options.append(f"--role={name}=reading")
                    self.good(table(header, rows), *options)

    def test_names_that_become_equal(self):
        """Their differences are signs, marks or capitals."""
        for names in (("x a", "x_a"), ("é", "e"), ("X", "x"), ("log", "column_log"), ("x", "x_offset")):
            with self.subTest(names):
                units = [f"--unit={name}=um" for name in names]
                rows = [(k, 0.7 * k * k % 1, 0.3 * k * k % 1) for k in range(24)]
                self.good(table(["time_s", *names], rows), *units)
                rows = [(k % 6 * 50, 0.7 * k * k % 1, 0.3 * k * k % 1) for k in range(24)]
                self.good(table(["pos_mm", *names], rows), *units)
                rows = [(k % 6, k // 6, 0.7 * k * k % 1) for k in range(24)]
                self.good(table([*names, "err_um"], rows), "linear", *units)

    def test_another_name_is_told(self):
        rows = [(k, 0.7 * k * k % 1) for k in range(24)]
        said, written = self.good(table(["time_s", "e"], rows), "--unit=e=um")
        self.assertIn("e: reading, um (as the last column of numbers); named column_e, because its own name is a constant of formulas", said)
        self.assertIn("[indications.column_e]", written)
        said, _ = self.good(table(["time_s", "max"], rows), "--unit=max=um")
        self.assertIn("named column_max, because its own name is a function of formulas", said)

    def test_one_column_is_the_time(self):
        rows = [(k, f"2024-01-01 10:00:{k:02}", 0.7 * k * k % 1) for k in range(24)]
        said, written = self.good(table(["time_s", "when", "err_um"], rows))
        self.assertEqual(written.count("order = "), 1)
        self.assertIn("when: not used (the time is time_s)", said)

    def test_a_label_has_no_empty_cells(self):
        """A remark on some rows tells nothing apart; nor does a run that some rows do not state."""
        for name in ("remark", "run"):
            rows = [(k % 6 * 50, 0.7 * k * k % 1, "door open" if k % 5 == 0 else "") for k in range(24)]
            said, written = self.good(table(["pos_mm", "err_um", name], rows))
            self.assertIn(f"{name}: not used (it is empty in more than a tenth of the rows, and a label is in none)", said)
            self.assertNotIn("labels = ", written)
        # One that a row or two do not state is a label all the same; these rows are left out.
        rows = [(k % 6 * 50, 0.7 * k * k % 1, "" if k == 7 else "ABCD"[k // 6]) for k in range(24)]
        said, written = self.good(table(["pos_mm", "err_um", "run"], rows))
        self.assertIn("24 rows, of which 1 is left out: run has nothing there", said)
        self.assertIn('labels = { run = "run" }', written)
        self.assertIn('where = { "run" = { not = "" } }', written)
        # A row without a reading is left out, and its label with it.
        rows = [(k % 6 * 50, "" if k == 9 else 0.7 * k * k % 1, "" if k == 9 else "ABCD"[k // 6]) for k in range(24)]
        _, written = self.good(table(["pos_mm", "err_um", "run"], rows))
        self.assertIn('labels = { run = "run" }', written)

    def test_cells_that_do_not_fit_the_name_of_their_column(self):
        for name, cell, why in (("u", 0, "it is not above 0 in every row: '0' in line 2"),
                                ("temp", "warm", "not all of its cells are numbers")):
            with self.subTest(name):
                rows = [(k % 6 * 50, 0.7 * k * k % 1, cell) for k in range(24)]
                said, _ = self.good(table(["pos_mm", "err_um", name], rows), f"--unit={name}={'um' if name == 'u' else 'K'}")
                self.assertRegex(said, rf"{name}: not used.* \({why}\)")

    def test_the_cell_that_is_no_number_is_named(self):
        """A column with a misprint is not used; which cell is to be mended must be said."""
        for name, unit in (("temp", "degC"), ("u", "um"), ("load", "N")):
            for bad, why in (({20: "2O.1"}, r"'2O\.1' in line 22 is not a number"),
                             ({3: "20.1.2", 7: "x", 9: "y"}, r"'20\.1\.2' in line 5 is not a number, nor are 2 more of its cells")):
                with self.subTest(name, bad=bad):
                    rows = [(k % 6 * 50, 0.7 * k * k % 1, bad.get(k, 20 + k % 5 / 10)) for k in range(24)]
                    said, _ = self.good(table(["pos_mm", "err_um", name], rows), f"--unit={name}={unit}")
                    self.assertRegex(said, rf"{name}: not used.* \({why}\)")

    def test_labels_that_are_numbers_but_for_a_letter(self):
        """Runs 1, 2 and 2b are no misprint, unless the column has a unit."""
        for name, label in (("run", True), ("batch", True), ("load (N)", False)):
            with self.subTest(name):
                rows = [(k % 6 * 50, 0.7 * k * k % 1, "1122"[k // 6] + "b" * (k // 6 == 3)) for k in range(24)]
                said, written = self.good(table(["pos_mm", "err_um", name], rows))
                self.assertEqual("labels = " in written, label)
                self.assertEqual(f"{name}: not used ('2b' in line 20 is not a number, nor are 5 more of its cells)" in said, not label)

    def test_positions_without_a_number_are_refused(self):
        (self.folder / "d.csv").write_text("load;err_um\n;1\n;2\n;3\n")
        self.assertIn("the column 'load' has too few numbers (it has the positions)", self.new("--from", "d.csv", code=2))


if __name__ == "__main__":
    unittest.main()
