"""Tables of compensation with steps, a resolution and a reference of their own: what they cover, and what they leave.

usage: compensate_table_test.py path/to/gumshoe [unittest options]
"""
import math
import re
import unittest

from compensate_test import at, read_back
from program import InOneFolder, complaint, gumshoe

POSITIONS = [-5.9, 105.6, 204.2, 296.1, 399.9, 499.2, 602.4, 704.6, 793.5, 892.5]
SCENARIO = """schema = 1
[model]
name = "linear_axis"
[data]
file = "axis.csv"
[data.units]
x_mm = "mm"
d_um = "um"
[data.conditions]
position = "x_mm"
direction = "way"
[quantities]
offset = "0 um"
gain = "0 um/m"
[indications.deviation]
readings = "d_um"
components = [ { distribution = "normal", u = "0.5 um", per = "reading" } ]
[stated_effects.bow]
indication = "deviation"
formula = "position * position"
unit = "um/m2"
size = { value = "60 um/m2", u = "1 um/m2" }
[stated_effects.bend]
indication = "deviation"
formula = "position * position * position"
unit = "um/m3"
size = { value = "-60 um/m3", u = "1 um/m3" }
[stated_effects.play]
indication = "deviation"
formula = "direction"
unit = "um"
size = { value = "1 um", u = "0.1 um" }
"""
TABLES = ("linuxcnc", "linuxcnc-trim", "sinumerik-eec", "sinumerik-cec", "isg", "etalon")


def deviation(x, way):
    """um; the last digit is noise"""
    return round(60 * ((x / 1000)**2 - (x / 1000)**3) + way, 1)


class Tables(InOneFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.readings = [(x, way, deviation(x, way)) for way in (1, -1) for x in POSITIONS]
        (cls.folder / "axis.csv").write_text("x_mm,way,d_um\n" + "".join(f"{x},{way},{d}\n" for x, way, d in cls.readings))
        (cls.folder / "s.toml").write_text(SCENARIO)

    def compensate(self, form, *words):
        axis = () if form == "csv" or form.startswith("linuxcnc") else ("--axis", "X1" if form.startswith("sinumerik") else "X")
        return gumshoe("compensate", "s.toml", "--format", form, *axis, *words, cwd=self.folder)

    def table(self, form, *words):
        run = self.compensate(form, *words)
        self.assertEqual(run.returncode, 0, run.stderr)
        return read_back(run.stdout, form), run.stderr

    def refused(self, words, *said):
        run = gumshoe("compensate", "s.toml", *words, cwd=self.folder)
        self.assertIsNone(complaint(run), (words, run.stderr))
        for word in said:
            self.assertIn(word, run.stderr)

    def left(self, rows, zero=0.0):
        rest = [d - zero - at(rows, x, way) for x, way, d in self.readings]
        return math.sqrt(sum(r * r for r in rest) / len(rest))

    def test_the_travel_is_covered(self):
        for form in TABLES:
            rows, said = self.table(form, "--step", "300 mm")
            end = 894.1 if form.startswith("sinumerik") else 892.5
            with self.subTest(form):
                self.assertEqual([round(x, 6) for x, _, _ in rows], [-5.9, 294.1, 594.1, end])
                self.assertIn(f"table: 4 points, -5.9 mm to {end} mm", said)
                self.assertEqual("; measured to 892.5 mm, where the last error holds" in said, end > 892.5)
        tenth = self.compensate("sinumerik-eec", "--step", "89.84 mm").stdout  # of the travel: no point beyond
        self.assertIn("$AA_ENC_COMP_MAX[0,X1]=892.500000\n", tenth)
        self.assertEqual(len(re.findall(r"^\$AA_ENC_COMP\[", tenth, re.M)), 11)

    def test_what_is_left_is_that_of_the_table_as_it_is_written(self):
        first = sum(self.table("csv")[0][0][1:]) / 2  # what a table that is zero there lacks
        seen = set()
        for form in TABLES:
            for words in (("--step", "50 mm"), ("--step", "300 mm"), ("--step", "50 mm", "--resolution", "5 um"),
                          ("--step", "50 mm", "--resolution", "0.25 um")):
                with self.subTest(form, words=words):
                    rows, said = self.table(form, *words)
                    left = float(re.search(r"these readings(?:, less [a-z_ ]+)?: \S+ um, with the table (\S+) um", said)[1])
                    expected = self.left(rows, first if form.startswith("sinumerik") else 0)
                    self.assertAlmostEqual(left, expected, delta=6e-3 * max(1, expected))
                    seen.add(left)
        self.assertGreater(len(seen), 6)
        exact, said = self.table("csv")
        self.assertAlmostEqual(float(re.search(r"with the table (\S+) um", said)[1]), self.left(exact), delta=2e-3)

    def test_entries_are_multiples_of_the_resolution(self):
        rows, _ = self.table("linuxcnc-trim", "--step", "50 mm", "--resolution", "0.25 um")
        for _, up, down in rows:
            for e in (up, down):
                self.assertAlmostEqual(e / 0.25, round(e / 0.25), delta=1e-6)

    def test_the_tables_of_both_directions_are_zero_at_the_reference_in_their_mean(self):
        """Each of them is off by half the reversal there, of 2 um at every position; the file must not call it zero."""
        for reference, place in (("294.1 mm", 1), ("594.1 mm", 2)):
            run = self.compensate("sinumerik-cec", "--step", "300 mm", "--resolution", "1 nm", "--reference", reference)
            _, up, down = read_back(run.stdout, "sinumerik-cec")[place]
            self.assertAlmostEqual(up, 1, delta=1.1e-3)
            self.assertAlmostEqual(down, -1, delta=1.1e-3)
            self.assertIn("a table for each direction; their mean is zero at the reference", run.stdout)
        (self.folder / "one.toml").write_text(SCENARIO.partition("[stated_effects.play]")[0])
        run = gumshoe("compensate", "one.toml", "--format", "sinumerik-cec", "--step", "300 mm", cwd=self.folder)
        self.assertIn("mm, zero at the reference", run.stdout, run.stderr)
        self.assertEqual(float(re.search(r"^\$AN_CEC\[0,0\]=(.+)$", run.stdout, re.M)[1]), 0)

    def test_options_that_make_no_table(self):
        eec = ("--format", "sinumerik-eec")
        for size in ("0 um", "-1 um"):
            self.refused((*eec, "--step", "50 mm", "--resolution", size), f"--resolution: '{size}' must be positive")
        for step in ("0 mm", "-50 mm"):
            self.refused((*eec, "--step", step), f"--step: '{step}' must be positive")
        for form in TABLES:
            self.refused(("--format", form, "--step", "1e-6 mm"), "points (a table has at most 10000). Use a longer --step.")
        for place in ("5000 mm", "-6 mm"):
            self.refused((*eec, "--step", "50 mm", "--reference", place), f"--reference: {place} is outside the travel measured",
                         "(-5.9 mm to 892.5 mm)")
        for name in ("X1\nM30", "X 1", "X,1", "\u00c4"):
            self.refused((*eec, "--step", "50 mm", "--axis", name), "the name of an axis has letters, digits and _ only")
        self.refused((*eec, "--step", "50 mm", "--axis", ""), "--axis: the text is empty")
        self.refused(eec, "the positions are not equidistant", 'Use --step "100 mm".')
        text = self.compensate("sinumerik-eec", "--step", "300 mm", "--reference", "892.5 mm").stdout
        self.assertAlmostEqual(float(re.search(r"^\$AA_ENC_COMP\[0,3,X1\]=(.+)$", text, re.M)[1]), 0, delta=1e-4)


if __name__ == "__main__":
    unittest.main()
