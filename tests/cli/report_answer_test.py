"""The answer of a run: U, k and intervals stand where it is stated, each is explained, and the workbook has them, too.

usage: report_answer_test.py path/to/gumshoe [unittest options]
"""
import io
import math
import re
import sys
import unittest
import xml.etree.ElementTree as ElementTree
import zipfile

from program import ROOT

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from browser import measured
from report_resolved_test import Runs, plain, words_of
from gumshoe_report import page, workbook

SEVERAL = """schema = 1
[model]
name = "expression"
[model.measurands]
%s
[quantities]
x = { value = "10 mm", u = "2 um" }
z = { value = 1, distribution = "rectangular", half_width = 0.5 }
"""

# Two observations: a t distribution with one degree of freedom, which has no standard uncertainty.
WITHOUT_U = """schema = 1
[model]
name = "expression"
[model.measurands]
y = { formula = "x", unit = "mm" }
[quantities]
x = { observations = ["1.00 mm", "1.02 mm", "1.01 mm"] }
"""

LONG = """schema = 1
[model]
name = "expression"
[model.measurands]
result_of_{first} = {{ formula = "{first} + {second}", unit = "mm" }}
result_of_{second} = {{ formula = "{first} - {second}", unit = "mm" }}
[quantities]
{first} = {{ value = "10 mm", u = "2 um" }}
{second} = {{ value = "1 mm", u = "1 um", source = "a certificate" }}
[analysis]
joint = [["result_of_{first}", "result_of_{second}"]]
sensitivity = {{ sobol = 256 }}
"""

CONFORMITY = """
[[analysis.conformity]]
measurand = "y0"
lower = "9 mm"
rule = "%s"
"""


def outputs(count):
    return "".join(f'y{k} = {{ formula = "{k + 1} * x", unit = "mm" }}\n' for k in range(count))


class Answer(Runs):
    def words(self, text):
        self.made = self.result(text)
        self.html = page.render(self.made)
        return plain(words_of(self.html).replace("&#8239;", " "))

    def test_U_and_k_stand_in_the_table_of_many_outputs(self):
        words = self.words(SEVERAL % outputs(6))
        table = self.html[self.html.index("<h2>Result</h2>"):]
        table = table[:table.index("</table>")]
        heads = [re.sub("<[^>]+>", "", h) for h in re.findall(r"<th scope=\"col\"[^>]*>(.*?)</th>", table)]
        row = [re.sub("<[^>]+>", "", c) for c in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", table[table.index("<tbody>"):])][:len(heads)]
        cells = dict(zip((plain(h) for h in heads), row))
        o = self.made.outputs[0]
        self.assertEqual(cells["U, 95 %"], f"{o.expanded_uncertainty * 1e3:.4f}")
        self.assertEqual(cells["k"], f"{o.coverage_factor:.2f}")
        self.assertRegex(cells["symmetric interval, 95 %"], r"^\[9\.99\d+, 10\.00\d+\]$")
        self.assertIn("Symmetric interval: 2.5 % of the values lie below it and 2.5 % above it", words)

    def test_intervals_are_explained_where_there_are_few_outputs(self):
        words = self.words(SEVERAL % outputs(1) + "[analysis]\ncoverage_probability = 0.9\n")
        self.assertIn("Symmetric interval: 5 % of the values lie below it and 5 % above it; it need not be centred at the estimate.", words)
        self.assertIn("Shortest interval: the shortest one that contains 90 % of the values.", words)

    def test_a_result_without_standard_uncertainty_has_its_interval_and_one_warning(self):
        words = self.words(WITHOUT_U)
        number = re.search(r'<p class="number">(.*?)</p>', self.html, re.S)[1]
        self.assertRegex(plain(re.sub("<[^>]+>", "", number)), r"^y = 1\.010? mm, 95 % interval \[\d\.\d+, \d\.\d+\] mm$")
        self.assertEqual(words.count("the ends of the interval are quantiles and remain valid"), 1)

    def test_long_names_push_no_number_out_of_sight(self):
        first, second = (f"a_long_name_of_one_of_the_quantities_of_the_{what}_kind" for what in ("first", "second"))
        self.words(LONG.format(first=first, second=second))
        path = self.folder / "long.html"
        path.write_text(self.html, encoding="utf-8")
        cut = "return [...document.querySelectorAll('.wide')].filter(e => e.scrollWidth > e.clientWidth + 1).length"
        self.assertEqual(measured(path, cut, 1200), 0)
        self.assertLessEqual(measured(path, "return document.documentElement.scrollWidth", 600), 600)

    def test_the_rule_stands_in_the_heading(self):
        headings = re.findall(r"<h3>(y0: .*?)</h3>", self.page_of_two_rules())
        self.assertEqual([re.sub("<[^>]+>", "", h) for h in headings], ["y0: accepted by ILAC-G8", "y0: accepted by simple acceptance"])

    def page_of_two_rules(self):
        self.words(SEVERAL % outputs(1) + CONFORMITY % "ilac_g8" + CONFORMITY % "simple_acceptance")
        return self.html

    def test_the_estimate_is_no_bar(self):
        """Its line is neither in the colour of the histogram nor unbroken."""
        self.words(SEVERAL % outputs(1))
        figure = self.html[self.html.index('aria-label="Distribution of y0'):]
        figure = figure[:figure.index("</svg>")]
        self.assertIn(">estimate</text>", figure)
        lines = re.findall(r'<path d="M ([\d.]+) [\d.]+ \nL \1 [^"]*"[^>]*style="([^"]*)"', figure)
        self.assertTrue([style for _, style in lines if "stroke-dasharray: 1" in style and "var(--ink)" in style], lines)

    def test_the_workbook_has_the_stated_result(self):
        r = self.result(SEVERAL % 'y = { formula = "x * z", unit = "mm" }')
        self.assertEqual(r.validations[0].verdict, "not validated")
        cells, styles = self.cells(r)
        stated = {text.removeprefix("stated result: "): cells[f"J{at[1:]}"] for at, (text, _) in cells.items()
                  if at[0] == "A" and str(text).startswith("stated result: ")}
        o = r.outputs[0]
        for name, value in (("estimate", o.estimate), ("standard uncertainty u", o.standard_uncertainty),
                            ("expanded uncertainty U", o.expanded_uncertainty), ("symmetric 95 % interval, lower end", o.symmetric_low),
                            ("shortest 95 % interval, upper end", o.shortest_high)):
            self.assertAlmostEqual(stated[name][0], 1e3 * value, 12)
        self.assertAlmostEqual(stated["coverage factor k"][0], o.coverage_factor, 12)
        self.assertEqual(styles[stated["standard uncertainty u"][1]], "0.0")  # 2.9 mm
        row = next(at[1:] for at, (text, _) in cells.items() if at[0] == "A" and text == "x")
        self.assertEqual((cells[f"B{row}"][0], styles[cells[f"B{row}"][1]]), (10.0, "0.0000"))  # to the place of 2.0 um

    def cells(self, r):
        """({"A1": (value, style)}, format by style) of the first sheet."""
        archive = zipfile.ZipFile(io.BytesIO(workbook.budget(r)))
        names, found = {"m": workbook.MAIN}, {}
        for c in ElementTree.fromstring(archive.read("xl/worksheets/sheet1.xml")).iterfind(".//m:c", names):
            text, value = c.find("m:is/m:t", names), c.find("m:v", names)
            found[c.get("r")] = (text.text if text is not None else float(value.text), int(c.get("s", 0)))
        styles = ElementTree.fromstring(archive.read("xl/styles.xml"))
        codes = {f.get("numFmtId"): f.get("formatCode") for f in styles.iterfind(".//m:numFmt", names)}
        return found, [codes.get(x.get("numFmtId"), "") for x in styles.iterfind("m:cellXfs/m:xf", names)]

    def test_many_budgets_share_a_sheet_of_results(self):
        r = self.result(SEVERAL % outputs(1))
        rows = workbook.all_results(r.outputs, 0.95)
        self.assertEqual([text for text, _ in rows[0]][:5], ["output", "estimate", "u", "U, 95 %", "k"])
        self.assertTrue(math.isfinite(rows[1][3]))


if __name__ == "__main__":
    unittest.main()
