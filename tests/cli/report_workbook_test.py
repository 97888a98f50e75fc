"""The budget of the report: as a workbook, as equations, and in the words around it.

usage: report_workbook_test.py path/to/gumshoe [unittest options]
"""
import io
import math
import subprocess
import sys
import types
import unittest
import zipfile
from xml.etree import ElementTree

from program import MADE, ROOT, InOneFolder

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from gumshoe_report import certificate, explain, mathml, read, reduce, tables, workbook


class Workbook(InOneFolder):
    """The budget as Office Open XML, read again without the writer."""

    NAMES = {"m": workbook.MAIN, "r": workbook.OFFICE}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        path = cls.folder / "full.h5"
        subprocess.run([MADE, path], check=True)
        cls.result = read.result(path)
        cls.archive = zipfile.ZipFile(io.BytesIO(workbook.budget(cls.result)))

    def sheets(self):
        """{name of the sheet: {"A1": (value, formula)}}, as the relations say."""
        self.assertIsNone(self.archive.testzip())
        parse = lambda name: ElementTree.fromstring(self.archive.read(name))
        types = {e.get("PartName") for e in parse("[Content_Types].xml") if e.get("PartName")}
        self.assertLessEqual(types, {"/" + name for name in self.archive.namelist()})
        targets = {e.get("Id"): e.get("Target") for e in parse("xl/_rels/workbook.xml.rels")}
        found = {}
        for sheet in parse("xl/workbook.xml").iterfind(".//m:sheet", self.NAMES):
            cells = {}
            for c in parse("xl/" + targets[sheet.get(f"{{{workbook.OFFICE}}}id")]).iterfind(".//m:c", self.NAMES):
                text = c.find("m:is/m:t", self.NAMES)
                value = text.text if text is not None else float(c.find("m:v", self.NAMES).text)
                formula = c.find("m:f", self.NAMES)
                cells[c.get("r")] = (value, formula.text if formula is not None else None)
            found[sheet.get("name")] = cells
        return found

    def test_sums_agree_with_the_result(self):
        sheets, checked = self.sheets(), 0
        self.assertEqual(len(sheets), len(self.result.budgets))
        for cells, b in zip(sheets.values(), self.result.budgets):
            self.assertEqual(cells["A1"][0], b.output)
            if not b.applicable:
                continue
            column = {int(at[1:]): value for at, (value, _) in cells.items() if at[0] == "J" and isinstance(value, float)}
            components = [column[k] for k in range(3, 3 + len(b.rows)) if k in column]
            label = {value: int(at[1:]) for at, (value, _) in cells.items() if at[0] == "A"}
            u, k = label["combined standard uncertainty u_c"], label["coverage factor k"]
            U = next(row for text, row in label.items() if text.startswith("expanded uncertainty"))
            self.assertAlmostEqual(column[u], b.combined_standard_uncertainty * b.display_factor)
            if f"J{u}" in cells and cells[f"J{u}"][1]:
                self.assertEqual(cells[f"J{u}"][1], f"SQRT(SUMSQ(J3:J{2 + len(b.rows)}))")
                self.assertAlmostEqual(math.sqrt(sum(x * x for x in components)), column[u], delta=1e-6 * column[u])
                checked += 1
            self.assertEqual(cells[f"J{U}"][1], f"J{k}*J{u}")
            self.assertAlmostEqual(column[U], b.expanded_uncertainty * b.display_factor)
        self.assertTrue(checked)

    def test_names_of_sheets_are_legal_and_unique(self):
        long = "bottom_height[rod standard, setup 1]"
        names = workbook.sheet_names([long, long, "a/b", "A b", ""])
        self.assertEqual(len({n.lower() for n in names}), 5)
        for name in names:
            self.assertRegex(name, r"^[^\[\]:*?/\\']{1,31}$")


class Equations(unittest.TestCase):
    """MathML says what the formula says: parentheses where they are needed and nowhere else."""

    def shown(self, text):
        """The formula in one line: fractions as (a)/(b), powers as a^(b), indices as a_(b)."""
        def walk(e):
            inside = [walk(child) for child in e]
            text = (e.text or "").strip()
            return {"mfrac": lambda: "({})/({})".format(*inside), "msup": lambda: "{}^({})".format(*inside),
                    "msub": lambda: "{}_({})".format(*inside), "msqrt": lambda: f"sqrt({''.join(inside)})",
                    }.get(e.tag, lambda: text + "".join(inside))()
        return walk(ElementTree.fromstring(str(mathml.equation(text)).replace("&#x2061;", "")))

    def test_structure(self):
        for text, shown in (
                ("y = -(a + b)/(c*d) - (e - f)", "y=(−(a+b))/(c·d)−(e−f)"),
                ("y = a - (b + c) + (d + e)", "y=a−(b+c)+d+e"),
                ("y = a*(b + c)*(d*g)", "y=a·(b+c)·d·g"),
                ("y = (a*b)^2 - (-a)^2^x_1", "y=(a·b)^(2)−(−a)^(2^(x_(1)))"),
                ("y = a/b/c", "y=((a)/(b))/(c)"),
                ("growth = alpha*length*sqrt(abs(t_0 - t))", "growth=α·length·sqrt(|t_(0)−t|)"),
                ("E_X0B = 2.5e-6*f(x, y)", "E_(X0B)=2.5·10^(−6)·f(x,y)")):
            self.assertEqual(self.shown(text), shown, text)

    def test_what_cannot_be_read_stays_as_it_is_written(self):
        self.assertEqual(mathml.equation("y = (a < b"), "<code>y = (a &lt; b</code>")


class Coefficients(unittest.TestCase):
    def test_units_are_those_that_people_write(self):
        def unit(output, si_output, factor, of, si, by, slope):
            b = types.SimpleNamespace(display_units=output, units=si_output, display_factor=factor)
            c = types.SimpleNamespace(display_units=of, units=si, display_factor=by, sensitivity=slope)
            value, written = tables.readable_coefficient(b, c)
            return float(f"{value:.6g}"), written
        degree = 180 / math.pi
        self.assertEqual(unit("mm", "m", 1e3, "deg", "rad", degree, 5e-3), (87.2665, "um/deg"))  # 5 mm times pi / 180
        self.assertEqual(unit("mm", "m", 1e3, "um", "m", 1e6, -1.0), (-1.0, "1"))
        self.assertEqual(unit("mm", "m", 1e3, "m", "m", 1.0, 0.3), (300.0, "mm/m"))
        self.assertEqual(unit("mm", "m", 1e3, "1", "1", 1.0, 0.3), (300.0, "mm"))
        self.assertEqual(unit("mm", "m", 1e3, "um/m/K", "1/K", 1e6, 0.04), (0.04, "um/(um/m/K)"))


class Reduce(unittest.TestCase):
    def budget(self, shares, **more):
        rows = [types.SimpleNamespace(name=n, quantity=n, share=s, monte_carlo_share=math.nan, evaluation=e, source="x",
                                      distribution="normal", degrees_of_freedom=math.inf)
                for n, s, e in shares]
        return types.SimpleNamespace(**{**dict(rows=rows, applicable=1, correlation_share=0.0, display_units="um", display_factor=1e6,
                                     combined_standard_uncertainty=10e-6), **more})

    def test_what_is_left_without_a_quantity(self):
        found = reduce.table(self.budget([("a", 0.64, "A"), ("b", 0.36, "B")]), 10e-6)
        first, second = found.rows
        # u without a: 10 sqrt(0.36) = 6.0; with half of u(a): 10 sqrt(1 - 0.75 0.64) = 7.2; without b: 8.0
        self.assertEqual((first.name, first.exact, first.half, second.exact), ("a", "6.0", "7.2", "8.0"))
        self.assertIn("observations", first.how)
        self.assertIn("source", second.how)

    def test_correlated_inputs_have_no_such_table(self):
        self.assertEqual(reduce.table(self.budget([("a", 0.6, "A")], correlation_share=0.4), 10e-6).rows, [])

    def test_without_the_law_indices_decide(self):
        indices = types.SimpleNamespace(rows=[types.SimpleNamespace(input="a", first=0.19, total=0.2),
                                              types.SimpleNamespace(input="b", first=0.75, total=0.76)])
        wrong = reduce.table(self.budget([("a", 0.9, "B"), ("b", 0.1, "B")]), 20e-6, indices)  # the law sees no kink
        self.assertEqual([(r.name, r.exact) for r in wrong.rows], [("b", "10"), ("a", "18")])
        found = reduce.table(self.budget([("a", math.nan, "B"), ("b", math.nan, "B")], applicable=0), 20e-6, indices)
        self.assertEqual([(r.name, r.exact) for r in found.rows], [("b", "10"), ("a", "18")])


class Certificate(unittest.TestCase):
    def test_signs_that_people_write(self):
        self.assertEqual(certificate.typeset("z[rod-2] = (-1.20 +- 0.03) um, k = 1.96, 95 %"),
                         "z[rod-2] = (−1.20 ± 0.03) µm, k = 1.96, 95 %")

    def test_of_a_validated_budget(self):
        o = types.SimpleNamespace(name="L")
        b = types.SimpleNamespace(applicable=1, expanded_uncertainty=99e-9, estimate=10.0033871e-3, display_units="mm",
                                  display_factor=1e3, display_offset=0.0, effective_degrees_of_freedom=math.inf, coverage_factor=1.96)
        v = types.SimpleNamespace(verdict="validated")
        self.assertEqual(certificate.line(o, b, v, 0.95).replace("\u202f", " "), "L = (10.003387 ± 0.000099) mm, k = 1.96, 95 %")
        v.verdict = "not validated"
        self.assertEqual(certificate.line(o, b, v, 0.95), "")


class WhyTheyDiffer(unittest.TestCase):
    """The sentence follows its rules (reports/README.md): each reason alone gives its own words and no other."""

    WORDS = {"flat": "the slope c_i is zero", "kink": "kink", "together": "act together", "tails": "s/√n",
             "correlated": "inputs are correlated"}

    def sentence(self, row=None, first=0.5, total=0.5, correlation=0.0, u=1.0):
        """Two inputs that share the variance evenly, one of them changed."""
        row = {"name": "a", "share": 0.5, "sensitivity": 1.0, "differentiable": 1, "distribution": "normal",
               "degrees_of_freedom": 0.0, **(row or {})}
        other = {**row, "name": "b", "share": 0.5, "sensitivity": 1.0, "differentiable": 1, "distribution": "normal"}
        budget = types.SimpleNamespace(rows=[types.SimpleNamespace(**r) for r in (row, other)], applicable=True,
                                       correlation_share=correlation, combined_standard_uncertainty=1.0)
        indices = types.SimpleNamespace(rows=[
            types.SimpleNamespace(input="a", first=first, total=total),
            types.SimpleNamespace(input="b", first=0.5, total=0.5 + (total - first))])
        return explain.why(budget, indices, None, u)

    def reasons(self, sentence):
        return {name for name, words in self.WORDS.items() if words in sentence}

    def test_agreement_is_said(self):
        self.assertIn("agree", self.sentence())
        self.assertEqual(self.reasons(self.sentence()), set())

    def test_each_reason(self):
        none = float("nan")
        self.assertEqual(self.reasons(self.sentence({"share": 0.0, "sensitivity": 0.0})), {"flat"})
        self.assertEqual(self.reasons(self.sentence({"share": none, "sensitivity": none, "differentiable": 0})), {"kink"})
        self.assertEqual(self.reasons(self.sentence(first=0.2)), {"together"})
        self.assertEqual(self.reasons(self.sentence({"distribution": "t", "degrees_of_freedom": 4.0, "share": 0.3})),
                         {"tails"})
        self.assertEqual(self.reasons(self.sentence({"share": 0.3}, correlation=0.2)), {"correlated"})
        self.assertIn("not linear over the range", self.sentence({"share": 0.3}))

    def test_without_a_law_of_propagation_there_is_nothing_to_compare(self):
        none = float("nan")  # as of a virtual experiment
        row = types.SimpleNamespace(name="a", share=none, sensitivity=none, differentiable=1, distribution="normal",
                                    degrees_of_freedom=0.0)
        budget = types.SimpleNamespace(rows=[row], applicable=False, correlation_share=none, combined_standard_uncertainty=none)
        indices = types.SimpleNamespace(rows=[types.SimpleNamespace(input="a", first=0.5, total=1.0)])
        self.assertEqual(explain.why(budget, indices, None, 1.0), "")

    def test_size_of_the_difference(self):
        self.assertIn("most for a (0.20)", self.sentence({"share": 0.3}))
        self.assertIn("1.41 times u_c", self.sentence({"share": 0.3}, u=1.41))


if __name__ == "__main__":
    unittest.main()
