"""Stated effects given as a table (linear between the levels of one condition, exact combinations of several), and on
several indications.

usage: stated_table_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import pathlib
import random
import tempfile
import unittest

from program import complaint, gumshoe

TEXT = """schema = 1
[model]
name = "expression"
[model.measurands]
y = {{ formula = "d", unit = "um" }}
[conditions]
x = "0 mm"
direction = 1
[indications.d.readings]
file = "r.csv"
column = "d"
unit = "um"
conditions = {{ x = {{ column = "x", unit = "mm" }}, direction = {{ column = "dir", unit = "1" }} }}
[stated_effects.bend]
unit = "um"
size = "2 um"
{bend}
[run]
samples = 16
"""


class Table(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_with(self, bend, rows):
        (self.folder / "r.csv").write_text("x,dir,d\n" + "\n".join(rows) + "\n")
        (self.folder / "s.toml").write_text(TEXT.format(bend=bend))
        return gumshoe("run", self.folder / "s.toml", "--format", "json", cwd=self.folder)

    def corrections(self, bend, rows):
        """What the evaluation takes from the readings, in um."""
        run = self.run_with(bend, rows)
        self.assertEqual(run.returncode, 0, run.stderr)
        found = json.loads(run.stdout)
        self.assertEqual({o["unit"] for o in found}, {"um"})
        return [-o["estimate"] for o in found]

    def test_linear_between_levels_in_any_order(self):
        bend = 'table = { x = ["100 mm", "0 mm", "50 mm"], loading = [0.5, 0, 1] }'
        found = self.corrections(bend, ["0,1,0", "25,1,0", "50,1,0", "90,1,0", "100,1,0"])
        for a, b in zip(found, (0, 1, 2, 1.2, 1), strict=True):  # twice the loading
            self.assertAlmostEqual(a, b, places=9)

    def test_combinations_of_two_conditions(self):
        bend = 'table = { x = ["0 mm", "0 mm", "50 mm", "50 mm"], direction = [1, -1, 1, -1], loading = [0, 1, 2, 4] }'
        found = self.corrections(bend, ["0,1,0", "0,-1,0", "50,1,0", "50,-1,0"])
        for a, b in zip(found, (0, 2, 4, 8), strict=True):
            self.assertAlmostEqual(a, b, places=9)

    def refused(self, message, bend, rows=("0,1,0",)):
        run = self.run_with(bend, rows)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn(message, run.stderr)

    def test_beyond_the_levels_there_is_no_value(self):
        """The message names what lies beyond which limits."""
        two = 'table = { x = ["0 mm", "50 mm"], loading = [0, 1] }'
        for x in ("-1", "51"):
            self.refused(f"it has no value at reading 2, where x = {x} mm (it is known from 0 mm to 50 mm). Measure there "
                         "and add the level, or leave the reading out by where in [data]", two, ("0,1,0", f"{x},1,0"))
        both = 'table = { x = ["0 mm", "50 mm"], direction = [1, -1], loading = [0, 1] }'
        self.refused("it has no value at reading 1, where x = 50 mm (it is known from 0 mm to 0 mm)", both, ("50,1,0",))
        square = 'table = { x = ["0 mm", "50 mm"], direction = [1, -1], loading = [0, 1] }'
        self.refused("it has no value at reading 1, where x = 25 mm, direction = 0 (it has no rows that differ from this in "
                     "one level alone)", square, ("25,0,0",))

    def test_along_one_condition_where_the_other_agrees(self):
        """x times direction, which is linear in each."""
        bend = 'table = { x = ["0 mm", "0 mm", "50 mm", "50 mm"], direction = [1, -1, 1, -1], loading = [0, 0, 1, -1] }'
        for a, b in zip(self.corrections(bend, ["25,1,0", "25,-1,0", "50,0.5,0"]), (1, -1, 1), strict=True):
            self.assertAlmostEqual(a, b, places=9)

    def test_a_margin_goes_on_in_a_straight_line(self):
        """Along the chord to the first level as far inside: neighbours that differ by chance are not enlarged."""
        bend = 'table = { x = ["0 mm", "99 mm", "100 mm"], loading = [0, 0.99, 2], margin = 0.05 }'
        for a, b in zip(self.corrections(bend, ["-5,1,0", "105,1,0"]), (-0.1, 4.2), strict=True):
            self.assertAlmostEqual(a, b, places=9)
        self.refused("where x = 106 mm (it is known from -5 mm to 105 mm)", bend, ("106,1,0",))
        self.refused("a table is not continued by 0.2 of its range (nothing was measured so far beyond its ends). State a "
                     "share between 0 and 0.1", bend.replace("0.05", "0.2"))

    def test_what_came_and_went_is_zero_beyond(self):
        """A margin, if there is one, comes first."""
        bend = 'table = { x = ["0 mm", "50 mm", "100 mm"], loading = [0, 1, 0], beyond = 0 }'
        for a, b in zip(self.corrections(bend, ["-400,1,0", "25,1,0", "700,1,0"]), (0, 1, 0), strict=True):
            self.assertAlmostEqual(a, b, places=9)
        bend = 'table = { x = ["0 mm", "100 mm"], loading = [0, 1], margin = 0.05, beyond = 3 }'
        for a, b in zip(self.corrections(bend, ["105,1,0", "106,1,0"]), (2.1, 6), strict=True):
            self.assertAlmostEqual(a, b, places=9)

    def test_bad_tables(self):
        for bend, message in (
                ('table = { loading = [0, 1] }', "it names no condition and no column"),
                ('table = { x = ["0 mm", "1 mm"], loading = [0] }', "a column has 2 rows and loading has 1"),
                ('table = { x = ["0 mm"], loading = [0] }', "a column has 1 rows and loading has 1"),
                ('table = { x = ["0 mm", "0 mm"], loading = [0, 1] }', "rows 1 and 2 state the same level"),
                ('table = { x = ["0 mm", "1 mm"] }', "table.loading is missing"),
                ('table = { xx = ["0 mm", "1 mm"], loading = [0, 1] }', "unknown key 'xx'"),
                ('formula = "1"\ntable = { x = ["0 mm", "1 mm"], loading = [0, 1] }', "it has a formula and a table"),
                ('meaning = "?"', "it has neither a formula nor a table")):
            self.refused(message, bend)

    def test_the_unit_is_that_of_the_indication(self):
        run = self.run_with("", ["0,1,0"])
        text = TEXT.format(bend='table = { x = ["0 mm", "1 mm"], loading = [0, 1] }').replace('"um"\nsize = "2 um"', '"ms"')
        (self.folder / "s.toml").write_text(text)
        run = gumshoe("check", self.folder / "s.toml")
        self.assertIsNone(complaint(run))
        self.assertIn("a size in ms does not change d (the loadings of a table are plain numbers)", run.stderr)


TWO = """schema = 1
[model]
name = "expression"
[model.indications]
a = "offset_a"
b = "offset_b"
[conditions]
t = 0
[quantities]
offset_a = { estimated = true, value = "0 um" }
offset_b = { estimated = true, value = "0 um" }
[indications.a]
readings = { file = "r.csv", column = "a", unit = "um", labels = { block = "block" }, conditions = { t = { column = "t", unit = "1" } } }
components = [ { distribution = "normal", u = "1 um", per = "reading" } ]
[indications.b]
readings = { file = "r.csv", column = "b", unit = "um", labels = { block = "block" }, conditions = { t = { column = "t", unit = "1" } } }
components = [ { distribution = "normal", u = "1 um", per = "reading" } ]
[trace]
blocks = "block"
order = "t"
draws = 199
"""
BOTH = '[stated_effects.twist]\nformula = { a = "sin(t / 7)", b = "-2 * sin(t / 7)" }\nunit = "um"\n'


class SeveralIndications(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def trace(self, effect, size=2.0):
        chance, rows = random.Random(4), ["block,t,a,b"]
        for i in range(96):
            x = size * math.sin(i / 7)
            rows.append(f"{i // 12},{i},{5 + x + chance.gauss(0, 1):.6f},{9 - 2 * x + chance.gauss(0, 1):.6f}")
        (self.folder / "r.csv").write_text("\n".join(rows) + "\n")
        (self.folder / "s.toml").write_text(TWO + effect)
        return gumshoe("trace", "s.toml", "--format", "json", "--loop", "3", cwd=self.folder)

    def test_one_size_moves_both(self):
        """u of one size from n readings of a sine and of twice its opposite: 1 um / sqrt(5 n / 2), n = 72 trained on."""
        run = self.trace(BOTH)
        self.assertEqual(run.returncode, 0, run.stderr)
        v = json.loads(run.stdout)
        finding, = v["rounds"][0]["added"] if "added" in v else v["findings"]
        self.assertEqual(finding["name"], "twist")
        size, = finding["quantities"]
        u = 1 / math.sqrt(5 * 72 / 2)
        self.assertAlmostEqual(size["u"], u, delta=0.2 * u)
        self.assertAlmostEqual(size["value"], 2, delta=3.5 * u)
        self.assertFalse(v["rounds"][1]["added"], v["rounds"])
        self.assertAlmostEqual(v["rounds"][1]["before"], v["rounds"][0]["after"], delta=1e-3 * v["rounds"][0]["after"])

    def test_a_freed_one_is_taken_from_both(self):
        run = self.trace(BOTH + 'size = "2 um"\n')
        self.assertEqual(json.loads(run.stdout)["findings"], [], run.stderr)

    def test_what_is_wrong_is_said(self):
        for effect, words in (
                ('formula = { c = "t" }\nunit = "um/s"\n', "'c' is not an indication"),
                ('formula = { a = "t" }\nindication = "a"\nunit = "um/s"\n', "the formulas name their indications"),
                ('formula = { }\nunit = "um/s"\n', "it is empty"),
                ('formula = { a = "t", b = "1" }\nunit = "deg"\n', "a is a length")):
            run = self.trace("[stated_effects.twist]\n" + effect)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn(words, run.stderr)


if __name__ == "__main__":
    unittest.main()
