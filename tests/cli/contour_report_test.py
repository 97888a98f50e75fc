"""The report of a measured contour and of points over a volume: figures in space.

usage: contour_report_test.py path/to/gumshoe [unittest options]
"""
import math
import pathlib
import re
import sys
import tempfile
import types
import unittest
import unittest.mock

import matplotlib
import numpy as np

from program import ROOT, gumshoe

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from gumshoe_report import profile, read, spatial_figures


class Figures(unittest.TestCase):
    def result(self, scenario, *more):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        out = pathlib.Path(folder.name) / "r.h5"
        run = gumshoe("run", ROOT / "scenarios" / scenario, "--samples", 1000, "--out", out)
        self.assertEqual(run.returncode, 0, run.stderr)
        return read.result(out)

    def test_a_contour_is_drawn_with_its_deviations_magnified(self):
        r = self.result("ball_bar_circle.toml")
        drawn = spatial_figures.contour(r, r.outputs)
        # Deviations up to 45 um + 3 um: a quarter of 50 mm is 260 times as much.
        self.assertIn("1778 mm/min, deviations × 200", drawn)
        (rows,) = spatial_figures.contours(r, r.outputs).values()
        self.assertEqual(len(rows), 72)
        # The major axis lies 45 deg past +Y, where X and Y have opposite signs.
        outwards = max(rows, key=lambda row: row[2].estimate)[1]
        self.assertLess((outwards["x"] - 0.2031) * (outwards["y"] - 0.1184), 0)
        self.assertEqual(spatial_figures.volume(r, r.outputs), "")

    def test_a_square_is_drawn_with_its_corners(self):
        corners = spatial_figures.polygon({"size": 40.0, "sense": -1, "sides": 4})
        self.assertTrue(np.allclose(corners, [[0, 40, 40, 0], [0, 0, -40, -40]]))
        # Inside near a side, outside of it, and beyond a corner.
        on, out = spatial_figures.nearest(corners, np.array([[10, 10, 43.0], [-1, 2, 4.0]]))
        self.assertTrue(np.allclose(on, [[10, 10, 40], [0, 0, 0]]))
        self.assertTrue(np.allclose(out, [[0, 0, 0.6], [1, 1, 0.8]]))

    def test_what_was_read_is_no_condition_of_a_profile(self):
        r = self.result("ball_bar_circle.toml")
        self.assertEqual({p.along for p in profile.of(r, r.outputs)}, {"time"})

    def test_a_volume_is_drawn_with_its_uncertainties(self):
        r = self.result("ball_bar_volume.toml")
        drawn = spatial_figures.volume(r, r.outputs)
        self.assertIn(f"u of {r.outputs[0].measurand} in µm", re.sub(r"\s+", " ", drawn))
        for o in r.outputs:
            self.assertIn(f">{1e6 * o.standard_uncertainty:#.2g}<".replace(".<", "<"), re.sub(r"\s+(?=<)", "", drawn))
        self.assertEqual(spatial_figures.contour(r, r.outputs), "")
        one = [o for o in r.outputs if not o.name.endswith("z 100 mm]")]
        self.assertTrue(spatial_figures.volume(r, one))
        self.assertEqual(spatial_figures.volume(r, [o for o in one if o.reading != 0]), "")  # a hole in the grid

    def test_measurands_over_a_volume_have_their_own_units_and_scales(self):
        """Lengths and angles over one grid: as numbers of SI the angles are a hundred times as large."""
        outputs, readings = [], []
        for k, (x, y) in enumerate((x, y) for x in (0.0, 0.1, 0.2) for y in (0.0, 0.1, 0.2)):
            readings.append(types.SimpleNamespace(x=x, y=y, z=0.0))
            for name, unit, factor, u in (("error", "mm", 1e3, 2e-6 * (1 + k)), ("tilt", "deg", 180 / math.pi, math.radians((1 + k) / 3600))):
                outputs.append(types.SimpleNamespace(measurand=name, reading=k, standard_uncertainty=u, display_units=unit, display_factor=factor))
        drawn = []
        with unittest.mock.patch.object(spatial_figures, "svg", lambda figure, *_: drawn.append(figure) or "drawn"):
            self.assertTrue(spatial_figures.volume(types.SimpleNamespace(readings=readings), outputs))
        for axes, title, last in zip(drawn[0].axes, ("u of error in µm, z 0 mm", "u of tilt in ″, z 0 mm"), ("18", "9.0"), strict=True):
            self.assertEqual(axes.get_title(loc="left"), title)
            self.assertEqual(axes.texts[-1].get_text(), last)
            darkest = min(sum(patch.get_facecolor()[:3]) for patch in axes.patches)
            self.assertAlmostEqual(darkest, sum(matplotlib.colormaps["Blues"](0.75)[:3]))


if __name__ == "__main__":
    unittest.main()
