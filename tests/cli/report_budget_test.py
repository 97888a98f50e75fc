"""The budget of the report: units of sensitivity coefficients, shares of the variance, coverage probabilities.

usage: report_budget_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import subprocess
import sys
import unittest

from program import GUMSHOE, ROOT, InOneFolder

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from gumshoe_report import csv_tables, explain, page, read, reduce, rounding, studies, tables, workbook

# Units that differ from those of the inputs in scale: a temperature in degF, a difference of voltages in mV.
UNITS = """schema = 1
[model]
name = "expression"
[model.measurands]
t = { formula = "x", unit = "degF" }
v = { formula = "a - b", unit = "mV" }
d = { formula = "l * sin(w)", unit = "mm" }
[quantities]
x = { value = "20 degC", u = "0.5 degC" }
a = { value = "1 V", u = "20 uV" }
b = { value = "999.5 mV", u = "15 uV" }
l = { value = "1 m", u = "3 um" }
w = { value = "1 deg", u = "0.01 deg" }
"""

# The slope against a is zero at the estimate, but a has more than half of the variance.
TORQUE = """schema = 1
[model]
name = "expression"
[model.measurands]
M = { formula = "m * l * cos(a)", unit = "N*m" }
[quantities]
m = { value = "98.1 N", u = "0.15 mN" }
l = { value = "500.012 mm"%s }
a = { value = "0 arcmin", distribution = "rectangular", half_width = "30 arcmin" }
"""
LENGTH = ', u = "5 um"'

# Linear: a Type A component of 5 degrees of freedom, and a rectangular one.
LINEAR = """schema = 1
[model]
name = "expression"
[model.measurands]
y = { formula = "%s", unit = "um" }
[quantities]
a = { value = "0 um", u = "%s um"%s }
b = { value = "0 um", distribution = "rectangular", half_width = "6 um" }
"""


# Two readings that share nearly all of their error.
CANCELLING = """schema = 1
[model]
name = "expression"
[model.measurands]
y = { formula = "a - b", unit = "mm" }
[quantities]
a = { value = "10 mm", u = "1 mm" }
b = { value = "5 mm", u = "1 mm" }
[[correlations]]
quantities = ["a", "b"]
kind = "pearson"
coefficient = %s
[analysis]
sensitivity = { shapley = 256 }
"""


# Fails where x is negative.
ROOT_OF = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "sqrt(x)"
[quantities]
x = { value = %s, u = 0.1 }
[run]
max_failed_share = 0.5
"""


class Runs(InOneFolder):
    @classmethod
    def ran(cls, text, *options, samples=50_000):
        (cls.folder / "s.toml").write_text(text)
        run = subprocess.run([GUMSHOE, "run", cls.folder / "s.toml", "--samples", str(samples), "--out",
                              cls.folder / "s.h5", "--force", *options], check=True, capture_output=True, text=True)
        return run.stdout

    @classmethod
    def result(cls, text, **more):
        cls.ran(text, **more)
        return read.result(cls.folder / "s.h5")


class Coefficients(Runs):
    """Each row multiplies: c times u is |c| u, in the units that stand next to them."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.made = cls.result(UNITS)
        cls.rows = [(b, c) for b in cls.made.budgets for c in b.rows]

    def test_rows_multiply_in_tables_and_workbook(self):
        for b, c in self.rows:
            line = csv_tables.line("budget", c, b)
            self.assertAlmostEqual(abs(line["sensitivity"]) * line["standard_uncertainty"], line["contribution"], 12)
            row = dict(zip(workbook.COLUMNS, workbook.component_row(b, c)))
            self.assertAlmostEqual(abs(row["c"]) * row["u"], row["|c| u"], 12)
            self.assertEqual((row["c"], row["unit of c"]), (line["sensitivity"], line["sensitivity_unit"]))

    def test_coefficients_are_in_the_units_that_are_shown(self):
        found = {(b.output, c.name): tables.coefficient(b, c) for b, c in self.rows}
        wanted = {("t", "x"): (1.8, "degF/degC"), ("v", "a"): (1000, "mV/V"), ("v", "b"): (-1, "1")}
        for at, (value, unit) in wanted.items():
            self.assertAlmostEqual(found[at][0], value, 9)
            self.assertEqual(found[at][1], unit)

    def test_the_page_shows_them_so(self):
        shown = {(b.output, row.name): (row.sensitivity, row.sensitivity_unit) for b in self.made.budgets
                 for row in tables.budget(b).rows}
        self.assertEqual(shown["t", "x"], ("1.80", "°F/°C"))
        self.assertEqual(shown["v", "a"], ("1000", "mV/V"))
        self.assertEqual(shown["v", "b"], ("−1.00", ""))
        self.assertEqual(shown["d", "w"], ("17.5", "mm/°"))
        self.assertEqual(shown["d", "l"], ("17.5", "mm/m"))
        self.assertIn("1.80<small>°F/°C</small>", page.render(self.made))

    def test_the_terminal_and_the_report_write_one_table(self):
        text = self.ran(UNITS, "--format", "csv", "--budget")
        lines = csv_tables.plain(self.made)["budget"]
        printed = list(csv.DictReader(io.StringIO(text)))
        self.assertEqual(list(printed[0]), list(lines[0]))
        names = ("output", "quantity", "unit", "sensitivity_unit", "contribution_unit")
        self.assertEqual([[row[n] for n in names] for row in printed], [[row[n] for n in names] for row in lines])
        of_json = json.loads(self.ran(UNITS, "--format", "json"))
        self.assertEqual([c["sensitivity_unit"] for o in of_json for c in o["budget"]],
                         [row["sensitivity_unit"] for row in lines])

    def test_quotients_are_written_as_the_engine_writes_them(self):
        self.assertEqual([tables.over("rad", below) for below in ("1", "rad", "m", "N*m", "m/s", "m.s-1")],
                         ["rad", "1", "rad/m", "rad/(N*m)", "rad/(m/s)", "rad/(m.s-1)"])


class Reduced(Runs):
    def reduced(self, text, **more):
        r = self.result(text, **more)
        o, b, v = r.outputs[0], r.budgets[0], r.validations[0]
        one = lambda studies: studies[0] if studies else None
        return o.standard_uncertainty, reduce.table(
            b, o.standard_uncertainty, one(r.sensitivities), one(r.shapley), one(r.given_data),
            explain.law_accounts(b, o, v.verdict))

    def study(self, name):
        return TORQUE % LENGTH + f"[analysis]\nsensitivity = {{ {name} }}\n"

    def test_shares_that_do_not_account_for_the_variance_give_no_advice(self):
        u, found = self.reduced(TORQUE % LENGTH)
        self.assertEqual(found.rows, [])
        self.assertIn("Monte Carlo gives 0.00075", found.text)
        self.assertIn("Set sensitivity = { sobol = 65536 } in [analysis]", found.text)
        self.assertIn("sobol = 65536", page.render(read.result(self.folder / "s.h5")))

    def test_indices_say_what_an_exact_quantity_leaves(self):
        without_length = self.reduced(TORQUE % "")[0]
        for name in ("sobol = 16384", "given_data = 50000"):
            u, found = self.reduced(self.study(name))
            self.assertFalse(found.law)
            self.assertEqual([row.name for row in found.rows][:2], ["a", "l"], name)
            self.assertAlmostEqual(float(found.rows[1].exact), without_length, delta=0.05 * u, msg=name)
            self.assertIn("u would fall from 0.00075", found.text)

    def test_shapley_effects_name_the_largest(self):
        found = self.reduced(self.study("shapley = 2048"))[1]
        self.assertEqual(found.rows, [])
        self.assertRegex(found.text, r"The largest Shapley effect is that of a, 5\d\.\d")

    def test_a_linear_model_keeps_the_law_whatever_the_shape_of_its_interval(self):
        """A rectangular contribution lets the verdict be "not validated"; u and its shares are right."""
        u, found = self.reduced(LINEAR % ("a + b", 1, ""))
        self.assertEqual(read.result(self.folder / "s.h5").validations[0].verdict, "not validated")
        self.assertTrue(found.law)
        self.assertEqual(float(found.rows[0].exact), 1.0)

    def test_a_t_distribution_counts_with_its_variance(self):
        freedom = ", degrees_of_freedom = 5"
        u, found = self.reduced(LINEAR % ("a + b", 5, freedom))
        self.assertTrue(found.law)
        halved = self.reduced(LINEAR % ("a + b", 2.5, freedom))[0]
        row = next(row for row in found.rows if row.name == "a")
        self.assertAlmostEqual(float(row.half), 1e6 * halved, delta=0.1)
        self.assertIn(f"from {rounding.significant(1e6 * u)}\u202fµm", found.text)
        self.assertIn("where a t distribution counts by its variance", page.render(read.result(self.folder / "s.h5")))

    def test_without_a_standard_uncertainty_nothing_is_claimed_of_it(self):
        for x in ('["1.00 mm", "1.02 mm", "1.01 mm"]', '["1.00 mm", "1.02 mm"]'):
            text = LINEAR.replace('a = { value = "0 um", u = "%s um"%s }', f"x = {{ observations = {x} }}")
            u, found = self.reduced(text % "x + b")
            self.assertFalse(math.isfinite(u))
            self.assertEqual(found.rows, [])
            self.assertIn("No standard uncertainty exists", found.text)
            self.assertIn("More observations of x would give it one", found.text)
            self.assertNotIn("µm", found.text)

    def test_words_of_the_program_are_no_source_to_better(self):
        text = LINEAR.replace('a = { value = "0 um", u = "%s um"%s }\n', "") % "x + b"
        text += '[indications]\nx = { readings = ["1 um"], u = "9 um" }\n'
        row = next(row for row in self.reduced(text)[1].rows if row.name.startswith("x"))
        self.assertEqual(row.how, "more indications in a reading: four times as many halve it")

    def test_the_terminal_says_the_same(self):
        text = self.ran(TORQUE % LENGTH)
        self.assertRegex(text, r"largest contributions to first order only \(u_c = 0\.00050 N\*m; Monte Carlo gives "
                               r"u = 0\.00075 N\*m\): l 0\.00049 N\*m .*; set sensitivity = \{ sobol = 65536 \}")
        self.assertRegex(self.ran(self.study("sobol = 16384")),
                         r"largest contributions \(first-order Sobol' indices\): a 5\d %, l 4\d %")
        for linear in (("a + b", 1, ""), ("a + b", 5, ", degrees_of_freedom = 5")):
            self.assertRegex(self.ran(LINEAR % linear),
                             r"(?m)^  largest contributions: [ab] \d\.\d um \(\d+ %\), [ab] ")


class Failing(Runs):
    def test_no_bounds_are_stated_where_too_many_samples_failed(self):
        words = page.render(self.result(ROOT_OF % 0.1))
        self.assertIn("With so many of them no bounds can be given for the symmetric interval.", words)
        self.assertRegex(words, "shift the mean by −0.0[0-9]+\\.")
        self.assertIn("Whatever their values, the symmetric interval lies within [", page.render(self.result(ROOT_OF % 0.25)))


class Conformity(Runs):
    """The table has the digits and the bounds of the statement above it."""

    def table_of(self, x, limits):
        text = LINEAR.replace('a = { value = "0 um", u = "%s um"%s }\n', f"x = {{ {x} }}\n").replace("6 um", "1 nm") % "x + b"
        r = self.result(text + f'[[analysis.conformity]]\nmeasurand = "y"\n{limits}rule = "ilac_g8"\n')
        return studies.conformity(r.conformity[0], r.outputs[0])

    def test_digits_where_no_standard_uncertainty_exists(self):
        c = self.table_of('observations = ["1.00 mm", "1.02 mm", "1.01 mm"]', 'lower = "0.9 mm"\nupper = "1.1 mm"\n')
        self.assertEqual((c.tolerance, c.estimate, c.acceptance, c.guard), (["900", "1100"], "1010", ["925", "1075"], "25"))
        self.assertIn("from 925 um to 1075 um", c.statement)

    def test_what_the_samples_do_not_resolve_is_a_bound(self):
        c = self.table_of('value = "1 mm", u = "10 um"', 'lower = "0.9 mm"\nprocess = { value = "1 mm", u = "20 um" }\n')
        risks = {name: value.replace("\u202f", " ") for name, value, _ in c.risks}
        self.assertEqual(c.p_c.replace("\u202f", " "), "> 99.994 %")
        self.assertEqual(risks["specific consumer’s risk"], "< 0.006 %")
        self.assertEqual(risks["global consumer’s risk R_C"], "< 0.006 %")
        self.assertEqual(risks["process conformance"], "> 99.9999 %")
        self.assertEqual(studies.chance(0.8185946, 1e-13, 1e-4), "81.859460000\u202f%")  # no error of zero
        for value in (c.p_c, *risks.values()):
            if "±" not in value:
                self.assertIn(value.replace("\u202f", " "), c.statement)
            self.assertNotRegex(value, "^0\u202f%|100\\.0|± 0\\.0*\\)")


class Cancelling(Runs):
    """Contributions are no shares of a variance that correlations have made smaller than any of them."""

    def test_no_shares_are_stated(self):
        printed = self.ran(CANCELLING % 0.99999999, "--budget")
        self.assertIn("  largest contributions: a 1.0 mm, b 1.0 mm; the inputs are correlated, and their contributions of 1.4 mm "
                      "cancel to u_c = 0.14 um, so that they are no shares of the variance\n", printed)
        self.assertRegex(printed, r"(?m)^  a  .* 1\.0 mm +-$")
        self.assertRegex(printed, r"(?m)^  without correlations +1\.4 mm$")
        self.assertNotIn("correlations  ", printed.replace("without correlations", ""))
        result = read.result(self.folder / "s.h5")
        shown = tables.budget(result.budgets[0], result.outputs[0].standard_uncertainty)
        self.assertEqual([row.share for row in shown.rows], ["–", "–"])
        self.assertEqual([row.width for row in shown.rows], [0, 0])
        html = page.render(result)
        self.assertIn("they cancel", html)
        self.assertIn("so that they are no shares of the variance", html)
        for text in (printed, html):
            self.assertNotRegex(text, r"\d{4,}(\.\d)?[ \u202f]%")

    def test_shares_are_stated_where_they_are_some(self):
        printed = self.ran(CANCELLING % 0.4, "--budget")  # 1 + 1 - 0.8 = 1.2
        self.assertRegex(printed, r"largest contributions: a 1\.0 mm \(83 %\), b 1\.0 mm \(83 %\), correlations -67 %\n")
        self.assertIn("-66.7\u202f%".replace("-", "−"), page.render(read.result(self.folder / "s.h5")))


class Reasons(Runs):
    """Why budget and indices differ is said of this model, and of no other."""

    def why(self, text):
        r = self.result(text)
        o, b = r.outputs[0], r.budgets[0]
        sobol, shapley = (studies[0] if studies else None for studies in (r.sensitivities, r.shapley))
        u = o.standard_uncertainty
        return explain.why(b, sobol, shapley, u), reduce.table(b, u, sobol, shapley)

    def test_a_correlated_input_is_no_bend(self):
        """y = a + b / 1000 is linear; b has its Shapley effect of the variance that it shares with a."""
        text = CANCELLING.replace('"a - b"', '"a + b / 1000"') % 0.8
        said, table = self.why(text)
        self.assertIn("b has next to no contribution of its own, but correlated inputs share their Shapley effects", said)
        self.assertNotIn("not linear", said)
        self.assertEqual(table.rows, [])
        self.assertIn("The inputs depend on each other", table.text)

    def test_no_variance_has_shares(self):
        """A sum with a t of 2 degrees of freedom."""
        text = LINEAR % ("a + b", 5, ", degrees_of_freedom = 2") + "[analysis]\nsensitivity = { sobol = 1024 }\n"
        said, _ = self.why(text)
        self.assertIn("no variance that the indices could divide", said)
        self.assertNotIn("not linear", said)


class Places(unittest.TestCase):
    def test_no_more_digits_than_a_double_has_and_zero_is_zero(self):
        for value, u, text in ((0, 3.2e-16, "0"), (3.2e-15, 1.1e-14, "3e−15"), (-1.234e-12, 1e-13, "−1.23e−12"),
                               (1e-18, 1e-16, "0"), (1.0, 1e-17, "1"), (1 / 3, 1e-17, "0.333333333333333"),
                               (0.5, 1e-10, "0.50000000000"), (0, 0.1, "0.00"), (6.0221e23, 1e20, "6.0221e23")):
            self.assertEqual(rounding.fixed(value, rounding.decimals(u)), text)


class Coverage(Runs):
    def test_a_probability_below_one_is_never_a_hundred_percent(self):
        shown = {0.95: "95", 0.9545: "95.45", 0.9973: "99.73", 0.6827: "68.27", 0.99999: "99.999", 1e-5: "0.001",
                 1 - 1e-9: "99.9999999", 1 - 1e-15: ">\u202f99.9999999999", 1e-15: "<\u202f0.0000000001"}
        for p, text in shown.items():
            self.assertEqual(rounding.probability(p), text + "\u202f%")
        self.assertEqual(rounding.probability(math.nan), "–")

    def test_result_and_report_write_it_with_its_digits(self):
        text = LINEAR % ("a + b", 5, "") + "[analysis]\ncoverage_probability = 0.99999\n"
        printed = self.ran(text, samples=200_000)
        self.assertIn(", 99.999 %\n", printed)
        self.assertIn("shortest 99.999 % coverage interval", printed)
        result = read.result(self.folder / "s.h5")
        self.assertIn("shortest 99.999 % coverage interval", result.outputs[0].statement)
        for shown in (printed, page.render(result)):
            self.assertNotRegex(shown, r"100 % coverage|k = \d\.\d\d, 100")
        self.assertIn("expanded uncertainty U, 99.999 %", str(workbook.budget_rows(result.budgets[0], 0.99999)))


if __name__ == "__main__":
    unittest.main()
