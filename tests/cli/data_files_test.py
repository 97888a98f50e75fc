"""Data files of scenarios: several indications in one file, columns of observations, and correlation that is exact.

usage: data_files_test.py path/to/gumshoe [unittest options]
"""
import re
import unittest

from program import InFolder, complaint, gumshoe

# Positions in long form: a row per axis; the labels that name an axis choose an indication.
LONG = """# axis;point;position
axis;point;position;by
X;1;1,5;a
Y;1;2,5;a
Z;1;9;a
X;2;1,25;a
X;2;1,75;a
Y;2;3,5;a
Y;2;7;b
Z;2;9;a
"""
AXES = """schema = 1
[model]
name = "expression"
[model.measurands]
d = { formula = "x + y", unit = "mm" }
[indications.x]
readings = { file = "long.csv", column = "position", unit = "mm", decimal = ",", LABELS, where = { axis = "X" } }
[indications.y]
readings = { file = "long.csv", column = "position", unit = "mm", decimal = ",", LABELS, where = { axis = "Y", by = { not = "b" } } }
resolution = "1 um"
[indications.x.repeatability]
pooled = true
[run]
samples = 1000
"""


class DataFiles(InFolder):
    def setUp(self):
        super().setUp()
        (self.folder / "long.csv").write_text(LONG)
        self.file = self.folder / "s.toml"

    def run_it(self, text):
        self.file.write_text(text)
        """The names of its outputs."""
        run = gumshoe("run", self.file, "--out", self.folder / "s.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        return re.findall(r"^(d\S*\[[^]]*\]) = ", run.stdout, re.M)

    def refused(self, text, *words):
        self.file.write_text(text)
        run = gumshoe("check", self.file)
        self.assertIsNone(complaint(run), run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)

    def test_one_file_for_several_indications(self):
        # The axis as a label that `where` fixes, and as a column alone: neither is a label of the readings.
        for labels in ('labels = { axis = "axis", point = "point" }', 'labels = { point = "point" }'):
            with self.subTest(labels):
                result = self.run_it(AXES.replace("LABELS", labels))
                self.assertEqual(result, ["d[point 1]", "d[point 2]"])
                # s of x from its own two readings at point 2, not from those of other axes: 0.25 sqrt(2), 1 degree of freedom
                explained = gumshoe("check", self.file, "--explain").stdout
                self.assertIn("s = 354 um pooled over 2 readings, 1 degrees of freedom", explained)
                for reading in ("x 0.0015 m (1.5 mm); y 0.0025 m", "x 0.0015 m (1.5 mm); y 0.0035 m"):
                    self.assertIn(reading, explained)

    def test_a_label_that_all_indications_share_stays(self):
        text = AXES.replace("LABELS", 'labels = { axis = "axis", point = "point" }')
        text = text.replace('axis = "X" }', 'axis = "X", point = "1" }').replace("pooled = true", 's = "1 um"')
        text = text.replace('axis = "Y", by', 'axis = "Y", point = "1", by')
        result = self.run_it(text)
        self.assertEqual(result, ["d[point 1]"])

    def test_a_label_that_varies_elsewhere_is_not_dropped(self):
        text = AXES.replace("LABELS", 'labels = { axis = "axis", point = "point" }')
        self.refused(text.replace('axis = "X" }', 'axis = "X", point = "1" }').replace("pooled = true", 's = "1 um"'),
                     "x has no reading")


if __name__ == "__main__":
    unittest.main()
