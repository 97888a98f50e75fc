"""In which units and words gumshoe trace says its figures.

usage: trace_units_test.py path/to/gumshoe [unittest options]
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
y = "{formula}"
[data]
file = "y.csv"
repeats = "apart"
labels = {{ {labels} }}
units = {{ {units} }}
[data.conditions]
{conditions}
[quantities]
y0 = {{ estimated = true, value = "0 {unit}" }}
{quantities}
[indications.y]
readings = "y"
[trace]
seed = 1
{trace}
"""


class Units(InFolder):
    def trace(self, rows, unit, labels="", formula="y0", units="", conditions="", quantities="", trace=""):
        """What is printed, and the verdict."""
        (self.folder / "y.csv").write_text("\n".join(rows) + "\n")
        (self.folder / "y.toml").write_text(SCENARIO.format(
            formula=formula, labels=labels, units=f'y = "{unit}"' + units, conditions=conditions, unit=unit,
            quantities=quantities, trace=trace))
        run = gumshoe("trace", "y.toml", "--draws", "99", "--force", "--json", "v.json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout, json.loads((self.folder / "v.json").read_text())

    def test_lengths_have_one_unit_that_suits_them(self):
        """Scatter of parts of 2 mm read in mm, of 20 nm read in nm and of 20 um read in mm."""
        for size, read, shown in ((2, "mm", "mm"), (20, "nm", "nm"), (0.02, "mm", "um"), (2e-5, "mm", "um")):
            draw = random.Random(2)
            parts = [draw.gauss(0, size) for _ in range(8)]
            said, v = self.trace(["part,y"] + [f"{k},{y + draw.gauss(0, size / 10)!r}" for _ in range(6) for k, y in enumerate(parts)],
                                 read, labels='part = "part"', trace='redone = [["part"]]')
            self.assertEqual(v["findings"][0]["name"], "scatter:part", v["plain"])
            self.assertRegex(v["plain"][0], rf"\(standard deviation \S+ {shown}\)")
            self.assertRegex(said, rf"residual standard deviation, {shown} ")
            self.assertRegex(said, rf"  standard deviation = \S+ {shown}, u = \S+ {shown}, ")
            self.assertEqual(set(re.findall(r"[0-9] ([num]?m)\b", said)), {shown})
            self.assertNotRegex(said, r"\de[+-]?\d+ [nu]?m")

    def test_errors_of_several_indications_have_their_own_units(self):
        """Position in um and pitch in arcsec, of which the pitch alone changes with the direction."""
        draw = random.Random(4)
        rows = ["cycle,pos_mm,dir,x_um,pitch"]
        for cycle in range(1, 7):
            for direction in (1, -1):
                rows += [f"{cycle},{pos},{direction},{2 + draw.gauss(0, 0.3):.3f},{0.6 * direction + draw.gauss(0, 0.2):.3f}"
                         for pos in range(0, 501, 50)]
        (self.folder / "y.csv").write_text("\n".join(rows) + "\n")
        (self.folder / "y.toml").write_text(SCENARIO[:SCENARIO.index("[model.ind")] + """[model.indications]
x = "x0"
pitch = "p0"
[data]
file = "y.csv"
labels = { cycle = "cycle" }
units = { pos_mm = "mm", x_um = "um", pitch = "arcsec" }
[data.conditions]
position = "pos_mm"
direction = "dir"
[quantities]
x0 = { estimated = true, value = "0 um" }
p0 = { estimated = true, value = "0 arcsec" }
[indications]
x = { readings = "x_um", u = "0.3 um" }
pitch = { readings = "pitch", u = "0.2 arcsec" }
[trace]
blocks = "cycle"
""")
        run = gumshoe("trace", "y.toml", "--draws", "99", "--json", "v.json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        v = json.loads((self.folder / "v.json").read_text())
        self.assertIn("An unknown effect changes the readings of pitch with direction.", v["plain"])
        x, pitch = v["of_indications"]
        self.assertEqual((x["unit"], pitch["unit"]), ("um", "arcsec"))
        # 22 held-out readings: s scatters by 15 %; the direction adds 0.6 arcsec to 0.2 arcsec.
        for key, size, expected in (("holdout_before", x, 0.3), ("holdout_after", x, 0.3), ("holdout_before", pitch, 0.632),
                                    ("holdout_after", pitch, 0.2)):
            self.assertAlmostEqual(size[key] / expected, 1, delta=0.5, msg=key)
        self.assertRegex(run.stdout, r"\nThat of pitch falls from 0\.[56]\d* arcsec to 0\.[12]\d* arcsec\.\n")
        self.assertRegex(run.stdout, r"\n  hold-out: pitch, arcsec +0\.\d+ +0\.\d+\n")
        # Together they give the error of all, where the pitch counts by its noise.
        for key in ("before", "after", "holdout_before", "holdout_after"):
            whole = v["rms"][key] * 1e6
            self.assertAlmostEqual(math.hypot(x[key], 1.5 * pitch[key]) / math.sqrt(2) / whole, 1, delta=1e-6, msg=key)

    def test_only_what_counts_readings_is_called_so(self):
        """A wave of 12 readings in decimal years, by the number of the reading, and by the file's order alone."""
        for column, trace, period in (("t", 'order = "t"', 1), ("n", 'order = "n"', 12), (None, "", 12)):
            draw = random.Random(1)
            rows = ["t,n,y"] + [f"{1990 + k / 12:.8f},{k + 1},{math.sin(math.pi * k / 6) + draw.gauss(0, 0.2):.4f}" for k in range(120)]
            _, v = self.trace(rows, "1", conditions=f'{column} = "{column}"' if column else "", trace=trace)
            remarks = " ".join(r for f in v["findings"] for r in f["remarks"])
            found, u = map(float, re.search(r"period (\S+)" + (" readings" if period == 12 else "") + r", u = (\d\S*\d)", remarks).groups())
            self.assertLess(abs(found - period), 3.5 * u)
            self.assertEqual("readings," in remarks, period == 12, remarks)
            self.assertRegex(remarks, r"amplitude \S+, u = 0\.\d+")

    def test_a_plain_number_has_no_unit(self):
        draw = random.Random(1)
        for power in (1, 2):
            rows = ["x,y"] + [f"{x},{3 * x ** power + draw.gauss(0, 0.1):.4f}" for x in range(24)]
            said, v = self.trace(rows, "1", conditions='x = "x"', trace="")
            self.assertTrue(v["findings"], v["plain"])
            self.assertNotRegex(said, r"[0-9] 1[,; )\n]")
            self.assertRegex(said, r"residual standard deviation {2,}before")

    def test_readings_that_differ_in_time_are_not_of_equal_conditions(self):
        draw = random.Random(1)
        rows = ["s,y"] + [f"{60 * k},{20 + 30 * math.exp(-k / 15) + draw.gauss(0, 0.05):.3f}" for k in range(40)]
        said, v = self.trace(rows, "degC", units=', s = "s"', conditions='time = "s"', trace='order = "time"')
        self.assertNotIn("equal conditions", said)
        self.assertIn("readings that follow each other scatter by", said)
        self.assertNotRegex(said, r"\b1 sets")
        # The curve goes through zero; the size is that of the whole drift.
        size = re.search(r"until it levels off it changes by (\S+) degC, u = (\S+) degC", " ".join(v["findings"][0]["remarks"]))
        self.assertAlmostEqual(float(size[1]), -30, delta=1)

    def test_an_outlier_has_less_weight(self):
        """None whose weight is shown as 1.00, and as many as are listed."""
        draw = random.Random(1)
        readings = [draw.gauss(0, 1) for _ in range(20)]
        counts = set()
        for k in range(8):
            readings[7] = 2.12 + 0.005 * k
            said, v = self.trace(["y"] + [f"{y:.3f}" for y in readings], "mm")
            weights = re.findall(r"^outlier: .*, weight (\S+)$", said, re.M)
            self.assertNotIn("1.00", weights)
            self.assertEqual(len(weights), len(v["outliers"]))
            counts.add(len(weights))
            self.assertIn(f"{len(weights)} outlier{'s' * (len(weights) > 1)} with reduced weight", said)
        self.assertEqual(counts, {1, 2})


if __name__ == "__main__":
    unittest.main()
