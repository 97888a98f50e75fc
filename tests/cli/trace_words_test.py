"""Words, units and averages of a trace's page: names as one says them, and what its figures draw.

usage: trace_words_test.py path/to/gumshoe [unittest options]
"""
import math
import sys
import types
import unittest
import unittest.mock

import numpy as np

from program import ROOT

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from gumshoe_report import names, trace, trace_axes, trace_figures


class Words(unittest.TestCase):
    def test_values_of_labels_stay_as_they_are(self):
        for name, said in (("step:tool_id T_2", "offset of tool id T_2"), ("step:tool_id T_2 with direction 1", "offset of tool id T_2 with direction 1"),
                           ("product:rail_position*tool_id T_2", "product of rail position and tool id T_2"),
                           ("product:x*box a_b*c", "product of x and box a_b*c"),
                           ("step:time with tool_id T_2 after reading 14", "step of tool id T_2 after reading 14"),
                           ("step:time after reading 14", "step after reading 14"),
                           ("while:time with tool_id T_2 from reading 14 to reading 31", "difference of tool id T_2 from reading 14 to reading 31"),
                           ("bend:time with tool_id T_2 after reading 14", "bend of tool id T_2 after reading 14"),
                           ("bend:time after reading 14", "bend after reading 14"),
                           ("lag:air_temperature", "delayed effect of air temperature"),
                           ("while:time from reading 14 to reading 31", "difference from reading 14 to reading 31"),
                           ("declared:rod_length[rod R_2]", "length of rod R_2 (declared)"),
                           ("declared:tool_id_offset[tool_id T_2]", "offset of tool id T_2 (declared)")):
            self.assertEqual(names.readable(name), said)
        self.assertEqual(names.plain("rod_length[tool_id T_2]"), "rod length[tool id T_2]")

    def test_noise_of_single_readings_is_no_label(self):
        self.assertEqual(names.readable("scatter:reading"), "larger noise of single readings")
        t = types.SimpleNamespace(kind="scatter", depends_on=["reading"])
        self.assertEqual(trace.Trace.dependence(None, t), "")

    def test_names_as_one_says_them(self):
        for name, said in (("trigger_latency", "trigger latency"), ("scatter:rod,setup", "scatter by rod and setup"),
                           ("declared:rod_length[rod 2]", "length of rod 2 is not what was declared"),
                           ("polynomial:feed^2", "square of feed"), ("table:x*direction", "any value by x and direction"),
                           ("harmonic:2xscrew", "2 waves per turn of screw"), ("omnibus:time", "any dependence on time")):
            self.assertEqual(trace.in_words(name), said)
        self.assertEqual(names.readable("declared:rod_length[rod 2]"), "length of rod 2 (declared)")

    def test_units_suit_the_size(self):
        for size, said in ((5e-5, ("nm", 1e6)), (2e-3, ("um", 1e3)), (3.0, ("mm", 1))):
            unit, factor = trace.suited("mm", size)
            self.assertEqual((unit, round(factor)), said)
        self.assertEqual(trace.suited("um", 5390), ("mm", 1e-3))

    def test_a_time_has_one_unit_along_every_axis(self):
        """Residuals and the curve of an unknown effect against the same time."""
        for last, unit, to in ((540.0, "s", 540), (5400.0, "min", 90)):
            own = {"display_units": "s", "units": "s", "display_factor": 1.0, "display_offset": 0.0}
            points = [types.SimpleNamespace(x=x, y=1e-6 * x, u=1e-7) for x in np.linspace(0, last, 10)]
            curve = types.SimpleNamespace(**own, against="time", rows=points, size_display_units="um", size_display_factor=1e6,
                                          indication="deviation")
            drawn = []
            with unittest.mock.patch.object(trace_figures, "svg", lambda figure, *_: drawn.append(figure) or ""):
                trace_figures.curves([curve], "c")
            axes = drawn[0].axes[0]
            self.assertEqual(axes.get_xlabel(), f"time, {unit}")
            self.assertAlmostEqual(axes.lines[0].get_xdata()[-1], to)
            column = types.SimpleNamespace(**own, values=[p.x for p in points])
            t = types.SimpleNamespace(findings=[], data=types.SimpleNamespace(columns={"time": column}, conditions={}))
            (name, along, values, _), = trace_axes.columns(t)
            self.assertEqual((name, along, values[-1]), ("time", unit, to))

    def test_averages_lie_on_a_line(self):
        x = np.repeat(np.arange(40.0), 6)
        centre, mean, half = trace_figures.averages(x, 2 * x + np.tile([-1, 1], 120))
        np.testing.assert_allclose(mean, 2 * centre, atol=1e-12)  # bins hold whole groups, whose noise cancels
        self.assertGreater(len(centre), trace_figures.DISTINCT)
        x = np.repeat([4.0, 120.0], 8)  # per value: s = sqrt(8 / 7), two standard errors of a mean of 8
        centre, mean, half = trace_figures.averages(x, np.tile([-1.0, 1.0], 8))
        np.testing.assert_allclose((*centre, *mean), (4, 120, 0, 0), atol=1e-12)
        np.testing.assert_allclose(half, 2 * math.sqrt(8 / 7) / math.sqrt(8))


if __name__ == "__main__":
    unittest.main()
