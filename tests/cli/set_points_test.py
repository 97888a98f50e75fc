"""What the operator set for each reading stands in a column, where the model has a quantity.

usage: set_points_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import random
import re
import unittest

from program import InFolder, gumshoe

SCENARIO = """schema = 1
[model]
name = "expression"
[model.indications]
d = "height + offset * cos(holder)"
[data]
file = "r.csv"
LABELS
[data.units]
holder_deg = "deg"
d_um = "um"
time_s = "s"
[data.conditions]
time = "time_s"
[conditions]
time = "0 s"
[quantities.height]
estimated = true
value = "0 um"
[quantities.offset]
value = "4 um"
u = "0.5 um"
[quantities.holder]
HOLDER
[indications.d]
readings = "d_um"
u = "0.5 um"
[trace]
blocks = "turn"
draws = 199
COLUMNS
"""
COLUMN = SCENARIO.replace("LABELS", 'labels = { turn = "turn" }').replace("COLUMNS", "")
SET = COLUMN.replace("HOLDER", 'column = "holder_deg"\nu = "0.1 deg"\nsource = "scale of the holder"')
ANGLES = (0, 45, 90, 135, 180, 225, 270, 315)


class SetPoints(InFolder):
    def setUp(self):
        super().setUp()
        draw, rows = random.Random(4), ["turn,holder_deg,time_s,d_um"]
        for turn in range(1, 7):
            for a in ANGLES:
                rad = math.radians(a)
                # The catalogue of an expression has no effect that goes round twice.
                rows.append(f"{turn},{a},{len(rows) * 20},{3 + 4 * math.cos(rad) + 2 * math.sin(2 * rad) + draw.gauss(0, 0.5):.3f}")
        (self.folder / "r.csv").write_text("\n".join(rows) + "\n")

    def write(self, text, name="s.toml"):
        (self.folder / name).write_text(text)
        return name

    def said(self, *words):
        run = gumshoe(*words, "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def test_a_column_is_one_entry_for_each_set_point(self):
        by = ", ".join(f'"{a}" = {{ value = "{a} deg", u = "0.1 deg", source = "scale of the holder" }}' for a in ANGLES)
        written = SCENARIO.replace("LABELS", 'labels = { turn = "turn", holder = "holder_deg" }').replace(
            "HOLDER", f"by.holder = {{ {by} }}").replace("COLUMNS", '[trace.columns]\nholder_set = { column = "holder_deg", unit = "deg" }')
        self.write(SET), self.write(written, "by.toml")
        a, b = (self.said("trace", s, "--out", s.replace(".toml", ".h5")) for s in ("s.toml", "by.toml"))
        a.pop("made_by"), b.pop("made_by")
        self.assertEqual(a, b)

    def test_trace_takes_the_set_point_as_a_covariate(self):
        self.write(SET)
        v = self.said("trace", "s.toml", "--loop", "3", "--out", "t.h5")
        self.assertEqual([f["depends_on"] for f in v["findings"]], [["holder_set"]])
        self.assertLess(v["rms"]["holdout_after"], v["rms"]["holdout_noise_interval95"][1])
        self.assertEqual(v["rounds"][-1]["added"], [])
        self.assertAlmostEqual(v["rounds"][1]["holdout_before"] / v["rms"]["holdout_after"], 1, delta=0.02)

    def test_a_unit_beside_the_column_and_no_table_of_trace(self):
        text = SET.replace('holder_deg = "deg"\n', "").replace('column = "holder_deg"', 'column = "holder_deg"\nunit = "deg"')
        self.write(text[:text.index("[trace]")])
        v = self.said("trace", "s.toml", "--draws", "199", "--out", "t.h5")
        self.assertEqual([f["depends_on"] for f in v["findings"]], [["holder_set"]])
        self.refused(SET.replace('column = "holder_deg"', 'column = "holder_deg"\nunit = "rad"'), "quantities.holder.unit: data.units.holder_deg is 'deg'")

    def refused(self, text, words):
        run = gumshoe("check", self.write(text), cwd=self.folder)
        self.assertEqual(run.returncode, 2)
        self.assertIn(words, run.stderr)

    def test_mistakes(self):
        self.refused(SET.replace("holder_deg\"\nu", "holder_degrees\"\nu"), "quantities.holder.column: 'r.csv' has no column 'holder_degrees'. Did you mean 'holder_deg'?")
        self.refused(SET.replace('u = "0.1 deg"', 'value = "3 deg"'), "quantities.holder.value: given together with column")
        self.refused(SET.replace('u = "0.1 deg"', "estimated = true"), "quantities.holder.estimated: given together with column")
        self.refused(SET.replace('holder_deg = "deg"\n', ""), "quantities.holder.column: the unit of 'holder_deg' is not stated")
        self.refused(SET.replace('holder_deg = "deg"', 'holder_deg = "mm"'), "cos of a length")
        self.refused(SET.replace('labels = { turn = "turn" }', 'labels = { turn = "turn", holder = "turn" }'), "data.labels.holder is another column")
        self.refused(COLUMN.replace("HOLDER", 'by.turn = { 1 = { column = "holder_deg" } }'), "an entry by label has no column")
        self.refused(re.sub(r"\[data\].*?\[conditions\]", "[conditions]", SET, flags=re.S), "there is no [data]")
        rows = (self.folder / "r.csv").read_text().replace("1,45,", "1,none,", 1)
        data = (self.folder / "r.csv").read_text()
        (self.folder / "r.csv").write_text(data.replace("2,45,", "2,45.0,", 1))
        self.refused(SET, "'45' and '45.0' in the column 'holder_deg' are one set-point")
        self.assertEqual(gumshoe("check", self.write(SET.replace('u = "0.1 deg"\n', "")), cwd=self.folder).returncode, 0)
        (self.folder / "r.csv").write_text(rows)
        self.refused(SET, "no value for holder = 'none'")


if __name__ == "__main__":
    unittest.main()
