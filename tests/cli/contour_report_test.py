"""The report of a measured contour and of points over a volume: figures in space.

usage: contour_report_test.py path/to/gumshoe [unittest options]
"""
import pathlib
import re
import sys
import tempfile
import unittest

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
        drawn, unit = spatial_figures.volume(r, r.outputs)
        self.assertEqual(unit, "µm")
        for o in r.outputs:
            self.assertIn(f">{1e6 * o.standard_uncertainty:#.2g}<".replace(".<", "<"), re.sub(r"\s+(?=<)", "", drawn))
        self.assertEqual(spatial_figures.contour(r, r.outputs), "")
        one = [o for o in r.outputs if not o.name.endswith("z 100 mm]")]
        self.assertTrue(spatial_figures.volume(r, one))
        self.assertEqual(spatial_figures.volume(r, [o for o in one if o.reading != 0]), "")  # a hole in the grid


if __name__ == "__main__":
    unittest.main()
