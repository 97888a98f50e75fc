"""Figures: exponents stand with the label of their axis, names of points do not cover each other.

usage: figure_labels_report_test.py path/to/gumshoe [unittest options]
"""
import sys
import types
import unittest

from program import ROOT

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from gumshoe_report import choice_figures, figures, overview_figure, profile_figures

import matplotlib.pyplot as plt


class Exponents(unittest.TestCase):
    def drawn(self, label, size=1e-17, **more):
        figure, grid = plt.subplots(2, 1, squeeze=False, **more)
        for axes in grid[:, 0]:
            axes.plot([0, 3 * size], [0, 1])
        grid[-1, 0].set_xlabel(label)
        return figures.svg(figure, "x", "a figure")

    def test_an_exponent_stands_once_behind_the_label(self):
        text = self.drawn("deviation, in kg", sharex=True)
        self.assertIn(">deviation, in kg, × 10⁻¹⁷<", text)
        self.assertEqual(text.count("10⁻¹⁷"), 1)
        self.assertNotIn("1e", text[text.index("</defs>"):].replace("\u2212", "-"))

    def test_plain_numbers_have_none(self):
        self.assertNotIn("×", self.drawn("deviation, in mm", 0.1))


class Names(unittest.TestCase):
    def test_names_of_near_points_do_not_cover_each_other_or_a_mark(self):
        figure, axes = plt.subplots()
        axes.set_xlim(0, 10), axes.set_ylim(0, 10)
        points = [(8, 5, "high speed, low feed"), (8.1, 5.1, "twelve start angles"), (8, 5, "twelve start angles, fitted")]
        choice_figures.name_points(axes, points, [(6, 5)])
        boxes = [text.get_window_extent() for text in axes.texts]
        self.assertEqual(len(boxes), 3)
        for k, box in enumerate(boxes):
            self.assertEqual(box.count_overlaps(boxes[:k]), 0)
            self.assertFalse(box.contains(*axes.transData.transform((6, 5))))
        plt.close(figure)


class Panels(unittest.TestCase):
    def output(self, name, estimate, u=2e-6):
        return types.SimpleNamespace(name=name, measurand="z", estimate=estimate, standard_uncertainty=u, symmetric_low=estimate - 2 * u,
                                     symmetric_high=estimate + 2 * u, shortest_low=estimate - 2 * u, shortest_high=estimate + 2 * u,
                                     display_units="mm", display_factor=1e3, display_offset=0, histogram=[], histogram_edges=[])

    def outputs(self, of_setup):
        return [self.output(f"z[rod{k}, setup {n}]", of_setup * n + k * 1e-6) for n in range(4) for k in range(3)]

    def test_outputs_far_apart_have_a_panel_for_each_value_of_the_label_that_parts_them(self):
        outputs = self.outputs(5e-4)
        parts = overview_figure.panels(outputs)
        self.assertEqual([(title, len(group)) for title, group in parts], [(f"setup {n}", 3) for n in range(4)])
        text = overview_figure.overview(outputs, "o")
        self.assertEqual(text.count(">deviation from "), 4)

    def test_intervals_that_the_line_covers_are_stated(self):
        line = lambda u: types.SimpleNamespace(lines=[types.SimpleNamespace(outputs=[self.output("z", 0.5 + k / 100, u) for k in range(9)])])
        self.assertEqual(profile_figures.too_narrow(line(1e-4)).replace("\u202f", " "),
                         "The intervals are too narrow to be seen: their half-width is at most 0.20 mm.")
        self.assertEqual(profile_figures.too_narrow(line(1e-2)), "")

    def test_near_ones_share_an_axis(self):
        self.assertEqual(len(overview_figure.panels(self.outputs(5e-6))), 1)
        self.assertEqual(len(overview_figure.panels([self.output("a", 0), self.output("b", 1)])), 1)  # no label parts them


if __name__ == "__main__":
    unittest.main()
