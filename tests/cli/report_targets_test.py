"""What would reach a target: the uncertainties are those of a scenario, and only columns and words that apply are shown.

usage: report_targets_test.py path/to/gumshoe [unittest options]
"""
import math
import sys
import types
import unittest

from program import ROOT

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from report_resolved_test import Runs, budget, component, plain, words_of
from gumshoe_report import page, targets

TARGET = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "a + b"
[quantities]
a = { value = 1, u = 0.3 }
b = { value = 2, u = 0.4 }
[[analysis.targets]]
measurand = "y"
U = %s
"""


def target(rows, **more):
    shown = dict(display_units="mm", display_factor=1e3, display_offset=0)
    return types.SimpleNamespace(**{**dict(output="y", present=2e-3, wanted=5e-3, reached=math.nan, cost_ratio=math.nan, statement="",
                                           rows=rows), **shown, **more})


def row(quantity, present, allowed, gum=math.nan, cheapest=math.nan):
    return types.SimpleNamespace(quantity=quantity, present=present, allowed=allowed, allowed_gum=gum, cost=math.nan, cheapest=cheapest,
                                 display_units="mm", display_factor=1e3, display_offset=0)


class Targets(unittest.TestCase):
    def draws(self, *us):
        return budget([component(f"e[setup {k}]", "e", standard_uncertainty=u) for k, u in enumerate(us)])

    def test_the_uncertainty_is_that_of_one_draw(self):
        present = 2e-5 * math.sqrt(2)
        found = targets.target(target([row("e", present, 1.5 * present)]), self.draws(2e-5, 2e-5))
        self.assertEqual((found.rows[0].present, found.rows[0].allowed, found.several), ("0.020", "0.030", True))
        many = targets.target(target([row("e", 5e-7 * math.sqrt(96), 1e-6 * math.sqrt(96), cheapest=25e-8 * math.sqrt(96))]), self.draws(*[5e-7] * 96))
        self.assertEqual((many.rows[0].present, many.rows[0].allowed, many.rows[0].cheapest), ("0.00050", "0.0010", "0.00025"))
        self.assertIn("e 0.00025", many.cheapest)

    def test_different_draws_are_all_stated(self):
        found = targets.target(target([row("e", math.hypot(5e-6, 1.5e-4), 2 * math.hypot(5e-6, 1.5e-4))]), self.draws(5e-6, 1.5e-4))
        self.assertEqual((found.rows[0].present, found.rows[0].allowed), ("0.0050 and 0.15", "0.010 and 0.30"))
        us = [1e-5 * k for k in range(1, 7)]
        found = targets.target(target([row("e", math.hypot(*us), math.inf)]), self.draws(*us))
        self.assertEqual((found.rows[0].present, found.rows[0].allowed), ("0.010 to 0.060", "any"))

    def test_what_is_no_sum_of_draws_stays(self):
        found = targets.target(target([row("e", 1e-3, 2e-3)]), self.draws(2e-5, 2e-5))
        self.assertEqual((found.rows[0].present, found.several), ("1.0", False))

    def test_without_a_law_there_is_no_such_column_and_no_false_none(self):
        met = targets.target(target([row("e", 1e-3, math.inf)]), self.draws(1e-3))
        self.assertEqual((met.has_gum, met.none, met.any), (False, False, True))
        missed = targets.target(target([row("e", 1e-3, math.nan)]), self.draws(1e-3))
        self.assertEqual((missed.has_gum, missed.none), (False, True))


class Page(Runs):
    def test_the_legend_names_what_the_table_has(self):
        met, missed = (plain(words_of(page.render(self.result(TARGET % U)))) for U in (3, 0.5))
        self.assertIn("The target is already met", met)
        self.assertNotIn("even an exact quantity would not suffice", met)
        self.assertIn("“None”: even an exact quantity would not suffice", missed)
        self.assertIn("by Monte Carlo and by the law of propagation", met)


if __name__ == "__main__":
    unittest.main()
