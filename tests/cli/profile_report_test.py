"""The report of a measurand along a condition: the figures come first, and the sentence is true of the formula.

usage: profile_report_test.py path/to/gumshoe [unittest options]
"""
import math
import pathlib
import re
import sys
import tempfile
import types
import unittest

from program import ROOT, gumshoe

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from browser import CLIPPED, measured
from gumshoe_report import profile, read

# An eccentric and tilted disc at twelve azimuths on two radii: u^2 = (2 um)^2 cos^2 + (1 um)^2 sin^2 + noise^2.
TEXT = """schema = 1
title = "disc"
[model]
name = "expression"
[model.measurands]
deviation = { formula = "d + e_x * cos(theta) + e_y * sin(theta)", unit = "um" }
[conditions]
theta = "0 deg"
radius = "70 mm"
time = "0 s"
[quantities]
e_x = { value = "0 um", u = "2 um", source = "assumed" }
e_y = { value = "3 um", u = "1 um", source = "assumed" }
[indications.d]
components = [ { u = "0.5 um", per = "reading", source = "assumed" } ]
[indications.d.readings]
file = "p.csv"
column = "d_um"
unit = "um"
labels = { line = "line", point = "point" }
[indications.d.readings.conditions]
theta = { column = "theta_deg", unit = "deg" }
radius = { column = "radius_mm", unit = "mm" }
time = { column = "time_s", unit = "s" }
[run]
samples = 40000
seed = 1
"""


# A condition whose unit is not the one in SI, nor the one common in a workshop.
ALONG = """schema = 1
[model]
name = "expression"
[model.measurands]
E = { formula = "V - S * %s", unit = "mV" }
[conditions]
%s = { spread = ["%s", "%s"], readings = 12 }
[quantities.S]
value = "%s"
u = "%s"
[indications.V]
components = [ { u = "0.2 mV", per = "reading" } ]
readings = [%s]
[run]
samples = 40000
"""
READINGS = ", ".join(f'"{60 + k} mV"' for k in range(12))


def table(points):
    lines = ["line,point,theta_deg,radius_mm,time_s,d_um"]
    for line, radius in (("inner", 70), ("outer", 71)):
        lines += [f"{line},{line}:{k},{30 * k},{radius},{k + radius},0" for k in range(points)]
    return "\n".join(lines) + "\n"


class Profile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.r, cls.page = cls().report(12)
        cls.drawn = (cls.folder / "p.html").rename(cls.folder / "drawn.html")

    def report(self, points, text=TEXT):
        (self.folder / "p.csv").write_text(table(points))
        (self.folder / "p.toml").write_text(text)
        result = self.folder / "p.h5"
        run = gumshoe("run", self.folder / "p.toml", "--out", result, "--force")
        self.assertEqual(run.returncode, 0, run.stderr)
        made = gumshoe("report", result, "--force")
        self.assertEqual((made.returncode, made.stderr), (0, ""))
        return read.result(result), (self.folder / "p.html").read_text(encoding="utf-8")

    def test_an_angle_is_drawn_round_and_the_sentence_holds(self):
        page = self.page
        self.assertTrue("deviation round theta, in µm, magnified" in page)
        words = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", re.sub(r"<(style|svg).*?</\1>", " ", page, flags=re.S)))
        found = re.search(r"uncertainty of deviation is largest, ([\d.]+) µm, at theta = (\d+)° \(line \w+\), and smallest, "
                          r"([\d.]+) µm, at theta = (\d+)°", words)
        self.assertEqual(found[1], f"{math.hypot(2, 0.5):.1f}")
        self.assertIn(found[2], ("0", "180"))
        self.assertEqual(found[3], f"{math.hypot(1, 0.5):.1f}")
        self.assertIn(found[4], ("90", "270"))
        share = re.search(r"its variance is due to e_x ([\d.]+) % and d ([\d.]+) %\.", words)
        self.assertAlmostEqual(float(share[1]), 100 * 4 / 4.25, delta=0.06)
        self.assertAlmostEqual(float(share[2]), 100 * 0.25 / 4.25, delta=0.06)
        largest = f"{math.hypot(2, 0.5):.1f}"
        self.assertTrue(f"At most it is {largest} µm on line inner; {largest} µm on line outer." in words)
        self.assertLess(page.index("Which quantity matters where"), page.index("All 24 outputs"))
        self.assertEqual(measured(self.drawn, CLIPPED), [])

    def test_lines_are_told_apart_and_time_is_no_azimuth(self):
        r = self.r
        drawn, = profile.of(r, r.outputs)
        self.assertEqual((drawn.along, drawn.units), ("theta", "rad"))
        self.assertEqual([line.label for line in drawn.lines], ["line inner", "line outer"])
        self.assertEqual([len(line.x) for line in drawn.lines], [12, 12])

    def test_a_length_is_drawn_along_a_line(self):
        text = TEXT.replace('theta = "0 deg"', 'place = "0 mm"').replace("theta = {", "place = {").replace(
            'unit = "deg"', 'unit = "mm"').replace("(theta)", "(place / radius)")
        _, page = self.report(12, text)
        self.assertTrue("deviation along place with symmetric coverage intervals" in page)
        self.assertFalse("magnified" in page)

    def test_what_a_target_needs_stands_before_the_table(self):
        asked = TEXT + """[[analysis.targets]]
measurand = "deviation"
labels = { line = "inner", point = "inner:0" }
U = "2 um"
costs = { e_x = 1 }
"""
        _, page = self.report(12, asked)
        self.assertLess(page.index("It needs u of e_x"), page.index("All 24 outputs"))

    def test_few_points_are_no_profile(self):
        r, page = self.report(4)
        self.assertEqual(list(profile.of(r, r.outputs)), [])
        self.assertFalse("Which quantity matters where" in page)

    def test_a_condition_has_the_unit_of_the_scenario(self):
        for low, high, unit, scale, S, u in (("10 degC", "70 degC", "°C", (1, -273.15), "0.2 mV/K", "1 %"),
                                             ("50 degF", "170 degF", "°F", (1.8, -459.67), "0.2 mV/K", "1 %"),
                                             ("0.1 kbar", "10 kbar", "kbar", (1e-8, 0), "0.1 mV/kbar", "90 %")):
            r, page = self.report(1, ALONG % ("X", "X", low, high, S, u, READINGS))
            p, = profile.of(r, r.outputs)
            self.assertEqual((p.scale.of(0.0), p.scale.of(1.0) - p.scale.of(0.0)), (scale[1], scale[1] + scale[0] - scale[1]))
            for x, o in zip(p.lines[0].x, p.lines[0].outputs):
                self.assertIn(f"[X {p.scale.number(x)} ", o.name)
            last = p.scale.text(p.lines[0].x[-1])
            self.assertTrue(f", at X = {last}, and smallest, " in page)
            self.assertTrue(f">X, {unit}</text>" in page)
            self.assertTrue(f">X ({unit})<" in page)  # the table of the readings

    def test_an_even_uncertainty_has_no_place(self):
        _, page = self.report(1, ALONG % ("X", "X", "10 degC", "70 degC", "0.2 mV/K", "0.01 %", READINGS))
        self.assertTrue("The standard uncertainty of E is 0.20\u202fmV at every X. On average its variance is due to V" in page)
        self.assertFalse("largest, " in page)

    def test_shares_add_up_along_the_line(self):
        r = self.r
        drawn, = profile.of(r, r.outputs)
        order, lines = profile.shares(drawn, {b.output: b for b in r.budgets}, {})
        self.assertEqual(order, ["e_x", "e_y", "d"])
        for rows in lines:
            for k, theta in enumerate(drawn.lines[0].x):
                variances = [4 * math.cos(theta) ** 2, math.sin(theta) ** 2, 0.25]
                for row, variance in zip(rows, variances):
                    self.assertAlmostEqual(row[k], variance / sum(variances), places=9)

    def test_outputs_without_a_budget_have_no_shares(self):
        output = types.SimpleNamespace(name="y")
        self.assertEqual(profile.of_variance(output, {}, {}), {})
        self.assertEqual(profile.of_variance(output, {"y": types.SimpleNamespace(applicable=0, rows=[])}, {}), {})


if __name__ == "__main__":
    unittest.main()
