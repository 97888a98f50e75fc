"""The report states what the samples resolve, and no noise: failed samples, indices near 0 and 1, rounding errors.

usage: report_resolved_test.py path/to/gumshoe [unittest options]
"""
import math
import re
import sys
import types
import unittest

from report_budget_test import Runs

from choose_report_test import words_of
from gumshoe_report import page, reduce, resolved, tables

# `sum` never fails; `root` does where x is negative, in a third of the samples.
ONE_FAILS = """schema = 1
[model]
name = "expression"
[model.measurands]
sum = "x + y"
root = "sqrt(x)"
[quantities]
x = { value = 0.5, u = 1 }
y = { value = 2, u = 0.1 }
[run]
max_failed_share = 0.5
[analysis]
sensitivity = { sobol = 1024 }
"""

PLAIN = """schema = 1
[model]
name = "expression"
[model.measurands]
y = { formula = "%s", unit = "%s" }
[quantities]
%s
[analysis]
sensitivity = { sobol = %d }
"""
QUANTITY = 'q%02d = { value = "%d mm", u = "%g mm" }\n'


def plain(text):
    return text.replace("\u202f", " ")


class Failed(Runs):
    def test_failed_samples_of_one_output_are_said_of_all(self):
        r = self.result(ONE_FAILS)
        words = plain(words_of(page.render(r)))
        valid = r.outputs[0].valid
        self.assertEqual(words.count("This result is conditional on the samples in which no output failed: "
                                     f"{valid // 1000} {valid % 1000:03d} of 50 000 (69 %)."), 2)
        self.assertIn("A sample in which any output fails is left out of every output.", words)
        self.assertIn("because 31.0 % of the samples failed and are left out", words)
        self.assertNotIn("the model is not linear", words)
        self.assertIn("so that its ends may differ for this reason alone", words)

    def test_nothing_is_said_where_none_failed(self):
        words = words_of(page.render(self.result(ONE_FAILS.replace("value = 0.5", "value = 50"))))
        self.assertNotIn("conditional", words)
        self.assertNotIn("of the samples failed", words)


class Shares(Runs):
    def only(self, formula, quantities, samples=4096, unit="mm"):
        r = self.result(PLAIN % (formula, unit, quantities, samples))
        return r, r.budgets[0], r.outputs[0].standard_uncertainty, r.sensitivities[0]

    def test_what_is_left_without_a_quantity_is_a_bound_where_it_is_not_resolved(self):
        _, b, u, sobol = self.only("q00 + q01", QUANTITY % (0, 10, 1e-3) + QUANTITY % (1, 2, 1))
        found = reduce.table(b, u, sobol, accounted=False)
        self.assertRegex(plain(found.text), r"u would fall from 1\.0 mm to less than 0\.00\d+ mm\.")
        left = float(found.rows[0].exact.removeprefix(resolved.BELOW))
        self.assertTrue(1e-3 <= left < 1.5e-3, left)  # the other one has 1 um
        self.assertEqual(reduce.table(b, u, sobol).rows[0].exact, "0.0010")  # by the law

    def test_nothing_else_is_not_a_number_from_rounding(self):
        _, b, u, sobol = self.only("q00^2 + 0 * q01^2", QUANTITY % (0, 0, 1) + QUANTITY % (1, 2, 1), unit="mm2")
        found = reduce.table(b, u, sobol)
        self.assertRegex(plain(found.rows[0].exact), r"^< 0\.00\d+$")

    def test_a_sum_has_no_interactions_and_no_negative_shares(self):
        rows = "".join(QUANTITY % (k, k, 1 + k / 50) for k in range(20))
        _, b, u, sobol = self.only(" + ".join(f"q{k:02d}" for k in range(20)), rows, 1024)
        shown = tables.budget(b, u, sobol)
        self.assertEqual(shown.interactions, "not resolved")
        self.assertFalse([row.monte_carlo for row in shown.rows if row.monte_carlo.startswith("−")])
        self.assertEqual(tables.budget(b, u, types.SimpleNamespace(rows=[types.SimpleNamespace(
            **{**vars(i), "first_low": -0.01, "first_high": 0.02}) for i in sobol.rows])).rows[0].monte_carlo, "<\u202f2.0\u202f%")

    def test_interactions_are_stated_where_there_are_some(self):
        _, b, u, sobol = self.only("q00 * q01", QUANTITY % (0, 0, 1) + QUANTITY % (1, 0, 1), 16384, "mm2")
        self.assertRegex(tables.budget(b, u, sobol).interactions, r"^(9\d|10\d)\.")

    def test_many_equal_quantities_matter_little_one_by_one(self):
        rows = "".join(QUANTITY % (k, k, 1 + k / 500) for k in range(30))
        _, b, u, sobol = self.only(" + ".join(f"q{k:02d}" for k in range(30)), rows)
        found = reduce.table(b, u, sobol)
        self.assertIn("No single quantity matters much: q29 has the largest share", found.text)
        self.assertEqual(found.left, 25)
        self.assertNotIn(reduce.significant(u * 1e3, 3), [row.half for row in found.rows])

    def test_no_contributions_no_caption_of_them(self):
        r, b, u, sobol = self.only("q00^2 + 0 * q01^2", QUANTITY % (0, 0, 1) + QUANTITY % (1, 2, 1), unit="mm2")
        words = words_of(page.render(r))
        self.assertNotIn("of the law of propagation, blue", words)
        self.assertIn("the law of propagation states no uncertainty", words)
        self.assertNotIn("U = 0", words)
        drawn = words_of(page.render(self.only("q00 + q01", QUANTITY % (0, 0, 1) + QUANTITY % (1, 2, 1))[0]))
        self.assertIn("of the law of propagation, blue", drawn)


def component(name, quantity="", share=math.nan, contribution=math.nan, **more):
    return types.SimpleNamespace(**{**dict(
        name=name, quantity=quantity or name, share=share, contribution=contribution, sensitivity=1.0, estimate=1.0,
        standard_uncertainty=1.0, display_factor=1.0, display_offset=0.0, display_units="mm", evaluation="B", distribution="normal",
        degrees_of_freedom=math.inf, differentiable=1, scope="", source="", monte_carlo_share=math.nan), **more})


def index(name, first, half, total=None):
    total = first if total is None else total
    return types.SimpleNamespace(input=name, first=first, first_low=first - half, first_high=first + half, total=total,
                                 total_low=total - half, total_high=total + half)


def budget(rows, **more):
    return types.SimpleNamespace(**{**dict(
        output="y", rows=rows, applicable=0, reason="", combined_standard_uncertainty=math.nan, expanded_uncertainty=math.nan,
        second_order_uncertainty=math.nan, second_order_bias=0.0, coverage_factor=math.nan, correlation_share=0.0,
        effective_degrees_of_freedom=math.inf, estimate=0.0, display_factor=1.0, display_offset=0.0, display_units="mm",
        monte_carlo_interactions=0.0, remark=""), **more})


class Rows(unittest.TestCase):
    def test_an_index_of_a_quantity_stands_once_for_all_its_labels(self):
        rows = [component("noise"), component("e_b[setup 1]", "e_b"), component("e_b[setup 2]", "e_b"), component("e_a[setup 1]", "e_a"),
                component("e_a[setup 2]", "e_a")]
        sobol = types.SimpleNamespace(rows=[index("noise", 0.02, 0.01), index("e_a", 0.6, 0.05), index("e_b", 0.38, 0.05)])
        shown = tables.budget(budget(rows), 1.0, sobol).rows
        self.assertEqual([(c.name, c.span, plain(c.monte_carlo)) for c in shown if c.span],
                         [("e_a[setup 1]", 2, "60.0 %"), ("e_b[setup 1]", 2, "38.0 %"), ("noise", 1, "2.0 %")])
        self.assertEqual([c.name for c in shown if not c.span], ["e_a[setup 2]", "e_b[setup 2]"])

    def test_rounding_errors_are_no_contributions(self):
        rows = [component("a", share=1.0, contribution=3.6), component("b", share=1e-33, contribution=5.8e-17, sensitivity=-1e-19),
                component("c", share=1e-8, contribution=3.6e-4)]
        shown = {c.name: c for c in tables.budget(budget(rows, applicable=1, combined_standard_uncertainty=3.6, second_order_bias=1e-17,
                                                         second_order_uncertainty=9.0)).rows}
        self.assertEqual((shown["b"].contribution, shown["b"].sensitivity, shown["b"].share), ("0", "0", "0"))
        self.assertEqual(shown["c"].contribution, "0.00036")
        remarks = tables.budget(budget(rows, applicable=1, combined_standard_uncertainty=3.6, second_order_bias=1e-17,
                                       second_order_uncertainty=9.0)).remarks
        self.assertNotIn("shift the mean", remarks[0])

    def test_what_is_left_is_no_rounding_error(self):
        rows = [component("a", share=1.0, contribution=3.6), component("b", share=1e-32, contribution=3.6e-16)]
        b = budget(rows, applicable=1, combined_standard_uncertainty=3.6)
        self.assertEqual(reduce.table(b, 3.6).rows[0].exact, "0")

    def test_the_order_is_that_of_the_budget_unless_samples_show_more(self):
        rows = [component("noisy", share=1e-6, contribution=1e-3), component("small", share=0.01, contribution=0.1),
                component("bent", share=0.0, contribution=0.0), component("main", share=0.5, contribution=0.7)]
        sobol = types.SimpleNamespace(rows=[index("noisy", 0.02, 0.03), index("small", 0.01, 0.03), index("bent", 0.3, 0.05),
                                            index("main", 0.5, 0.05)])
        shown = tables.budget(budget(rows, applicable=1, combined_standard_uncertainty=1.0), 1.0, sobol).rows
        self.assertEqual([c.name for c in shown], ["main", "bent", "small", "noisy"])

    def test_without_shares_contributions_order_the_rows(self):
        rows = [component("a", contribution=0.0), component("b", contribution=3.6), component("c", contribution=0.4, differentiable=0)]
        self.assertEqual([c.name for c in tables.budget(budget(rows)).rows], ["b", "c", "a"])

    def test_what_has_no_effect_is_one_line(self):
        rows = [component("a", share=1.0, contribution=1.0)] + [component(f"b{k}", share=0.0, contribution=0.0) for k in range(7)]
        shown = tables.budget(budget(rows, applicable=1, combined_standard_uncertainty=1.0))
        self.assertEqual(([c.name for c in shown.rows], shown.folded, shown.folded_share), (["a"], 7, "0"))


class Bars(Runs):
    def test_the_bar_of_the_others_is_not_cut(self):
        rows = "".join(QUANTITY % (k, k, 1 + k / 100) for k in range(40))
        text = page.render(self.result(PLAIN % (" + ".join(f"q{k:02d}" for k in range(40)), "mm", rows, 4096)))
        figure = text[text.index('aria-label="Tornado plot of the budget and Sobol'):]
        axes = figure[figure.index('id="s0-axes_2"'):figure.index("</svg>")]
        ticks = [float(x) for x in re.findall(r'x="[\d.]+" y="[\d.]+"[^>]*>(\d\.\d+)</text>', axes)]
        self.assertGreaterEqual(max(ticks), 0.5, ticks)  # 28 others have two thirds of the variance


if __name__ == "__main__":
    unittest.main()
