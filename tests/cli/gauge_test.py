"""gumshoe gauge: the shipped examples agree, and a difference, a mistake or a run that fails is reported as such.

usage: gauge_test.py path_of_gumshoe [unittest options]
"""
import json
import re
import unittest

from program import ROOT, InFolder, complaint, gumshoe, places

EXAMPLES = ROOT / "scenarios" / "gauge"
SUM = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "x1 + x2"
[quantities.x1]
value = 1
u = 3
[quantities.x2]
value = 2
u = 4
[run]
samples = 1e5
"""
# exp(-b x) nears readings of -1 ever more as b grows: no finite b is best.
FIT = """schema = 1
[model]
name = "expression"
[model.indications]
y = "exp(-b * x)"
[conditions]
x = 0
[quantities.b]
estimated = true
value = 1
[indications.y]
rows = [{ x = 1, values = [-1] }, { x = 2, values = [-1.01] }, { x = 3, values = [-0.99] }]
"""


def expected(figure, value, **more):
    return "".join(f'{k} = "{v}"\n' for k, v in {"figure": figure, "value": value, **more}.items())


class Gauge(InFolder):
    def scenario(self, text, *figures):
        file = self.folder / "s.toml"
        file.write_text(text + "".join("[[expected]]\n" + f for f in figures))
        return file

    def test_every_shipped_example_agrees(self):
        run = gumshoe("gauge", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stdout[-2000:] + run.stderr)
        lines = json.loads(run.stdout)
        self.assertEqual({line["example"] for line in lines}, {file.stem for file in EXAMPLES.glob("*.toml")})
        for line in lines:
            with self.subTest(f"{line['example']}: {line['figure']}"):
                self.assertIn(line["verdict"], ("PASS", "NOTE"))
                self.assertTrue(line["source"], "a figure without a source")
                self.assertTrue(line["why"], "a tolerance without a reason")
                if line["verdict"] == "NOTE":
                    self.assertTrue(line["note"])

    def test_every_tolerance_could_be_missed(self):
        """A figure is worth something only if it would be missed: by half a unit of its last digit, which is all that is printed, or
        by a tenth of its scale. That is the figure itself, the u of its measurand, or 1 of an index or a correlation."""
        lines = json.loads(gumshoe("gauge", "--format", "json").stdout)
        split = lambda text: re.fullmatch(r"([-+]?[\d.]+(?:e[-+]?\d+)?)(?: (.*))?", text, re.I)
        of = lambda figure: figure.partition(" of ")[2]
        u = {}  # by example, measurand and unit, as printed
        for line in lines:
            if re.match(r"(gum\.)?standard_uncertainty\b", line["figure"]) and (value := split(line["ours"])):
                u[line["example"], of(line["figure"]), value[2]] = abs(float(value[1]))
        checked = 0
        for line in lines:
            number, tolerance = split(line["published"]), split(line["tolerance"])
            if not number or not tolerance or line["figure"].startswith("trials"):  # words; where a run stops is chance
                continue
            checked += 1
            with self.subTest(f"{line['example']}: {line['figure']}"):
                mantissa, _, power = number[1].lower().partition("e")
                half = 0.5 * 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))
                if line["why"] == "half a unit of the last digit":
                    self.assertAlmostEqual(float(tolerance[1]) / half, 1, delta=0.02)
                if float(tolerance[1]) < 1.02 * half:
                    continue
                index = re.match(r"(first|second|total|shapley|rank_first|joint\.correlation)\b", line["figure"])
                scale = max(abs(float(number[1])), u.get((line["example"], of(line["figure"]), number[2]), 0), 1 if index else 0)
                self.assertLess(float(tolerance[1]), 0.1 * scale)
        self.assertGreater(checked, 0.9 * len(lines))

    def test_a_wrong_figure_is_a_difference(self):
        run = gumshoe("gauge", self.scenario(SUM, expected("standard_uncertainty", "5.00", source="closed form"),
                                             expected("gum.standard_uncertainty", "5.1", source="made up")))
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertRegex(run.stdout, r"(?m)^PASS s: standard_uncertainty: published 5\.00 \(closed form\), ours ")
        self.assertRegex(run.stdout, r"(?m)^DIFF s: gum\.standard_uncertainty: published 5\.1 \(made up\), ours 5, ")
        self.assertIn("2 figures: 1 PASS, 1 DIFF, 0 NOTE", run.stdout)

    def test_a_wrong_word_is_a_difference(self):
        run = gumshoe("gauge", self.scenario(SUM, expected("gum.applicable", "no")))
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertRegex(run.stdout, r"DIFF s: gum\.applicable: published no, ours yes")

    def test_a_known_difference_is_a_note(self):
        run = gumshoe("gauge", self.scenario(SUM, expected("gum.standard_uncertainty", "5.1", note="a misprint")))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stdout, r"(?m)^NOTE s: gum\.standard_uncertainty: published 5\.1, ours 5, .*; a misprint$")

    def test_half_a_unit_of_the_last_digit_is_the_rule(self):
        for value, code in (("5.04", 1), ("5.0", 0), ("5", 0), ("4.6", 1), ("5.000000001", 1), ("5.000e+00", 0)):
            with self.subTest(value):
                run = gumshoe("gauge", self.scenario(SUM, expected("gum.standard_uncertainty", value)))
                self.assertEqual(run.returncode, code, run.stdout + run.stderr)

    def test_a_tolerance_stands_with_its_reason(self):
        figure = expected("gum.standard_uncertainty", "5.04", tolerance="0.05", why="rounded inputs")
        self.assertEqual(gumshoe("gauge", self.scenario(SUM, figure)).returncode, 0)
        run = gumshoe("gauge", self.scenario(SUM, expected("gum.standard_uncertainty", "5.04", tolerance="0.05")))
        self.assertIsNone(complaint(run))
        self.assertIn("a tolerance without a reason", run.stderr)

    def test_mistakes_are_located(self):
        mistakes = {
            "unknown figure": (SUM, expected("standard_uncertanty", "5")),
            "study that was not asked for": (SUM, expected("first[x1]", "0.36")),
            "unknown input": (SUM, expected("gum.contribution[x3]", "3")),
            "unknown measurand": (SUM, expected("estimate", "3", of="z")),
            "no number": (SUM, expected("estimate", "three")),
            "unit of another dimension": (SUM, expected("estimate", "3 mm")),
            "unknown figure of a fit": (FIT, expected("fit.converge", "no")),
            "unknown quantity of a fit": (FIT, expected("fit.value[c]", "1")),
        }
        line = {SUM: SUM.count("\n") + 1, FIT: FIT.count("\n") + 1}
        for name, (text, figure) in mistakes.items():
            with self.subTest(name):
                file = self.scenario(text, figure)
                run = gumshoe("gauge", file)
                self.assertIsNone(complaint(run), run.stdout + run.stderr)
                self.assertTrue(places(run, file), run.stderr)
                self.assertGreaterEqual(places(run, file)[0][0], line[text], run.stderr)

    def test_a_fit_that_fails_is_reported(self):
        run = gumshoe("gauge", self.scenario(FIT, expected("fit.converged", "yes")))
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        self.assertRegex(run.stdout, r"(?m)^DIFF s: fit\.converged: published yes, ours no")

    def test_a_scenario_without_figures_is_refused(self):
        run = gumshoe("gauge", self.scenario(SUM))
        self.assertIsNone(complaint(run))
        self.assertIn("nothing to compare with", run.stderr)

    def test_an_empty_folder_and_a_missing_file_are_refused(self):
        self.assertIsNone(complaint(gumshoe("gauge", self.folder)))
        self.assertIsNone(complaint(gumshoe("gauge", self.folder / "none.toml")))


if __name__ == "__main__":
    unittest.main()
