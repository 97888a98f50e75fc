"""On a grid of two axes: two curves that add up are two curves, and a surface of both is one.

usage: surface_test.py path/to/gumshoe [unittest options]
"""
import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "cli")]

from program import GUMSHOE, gumshoe

PLANE = """schema = 1
title = "a plane probed on a grid"
[model]
name = "expression"
[model.indications]
d = "height"
[conditions]
x = "0 mm"
y = "0 mm"
[quantities]
height = { estimated = true, value = "0 um" }
[indications.d]
components = [ { distribution = "normal", u = "1 um", per = "reading" } ]
[indications.d.readings]
file = "r.csv"
column = "d"
unit = "um"
labels = { cycle = "cycle" }
conditions = { x = { column = "x", unit = "mm" }, y = { column = "y", unit = "mm" } }
[trace]
blocks = "cycle"
order = "t"
draws = 199
[trace.columns]
t = { column = "t", unit = "s" }
"""
ALONG, ACROSS, CYCLES = 7, 5, 4


def found(error, seed):
    """What is found in noise of 1 um. @param error [along][across], um"""
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        (folder / "s.toml").write_text(PLANE)
        lines, t = ["cycle,x,y,t,d"], 0
        for cycle in range(CYCLES):
            for cell in rng.permutation(ALONG * ACROSS):
                i, j = divmod(int(cell), ACROSS)
                t += 10
                lines.append(f"{cycle + 1},{50 * i},{40 * j},{t},{error[i, j] + rng.standard_normal():.4f}")
        (folder / "r.csv").write_text("\n".join(lines) + "\n")
        out = gumshoe("trace", "s.toml", "--format", "json", "--threads", "1", cwd=folder)
        assert out.returncode == 0, out.stderr
        return [f["depends_on"] for f in json.loads(out.stdout)["findings"]]


class Surface(unittest.TestCase):
    """A cell's mean of four readings scatters by 0.5 um: errors of 4 um are eight of them."""

    def test_two_curves_that_add_up_are_two(self):
        for seed in range(4):
            rng = np.random.default_rng([1, seed])
            error = 4 * rng.standard_normal(ALONG)[:, None] + 4 * rng.standard_normal(ACROSS)
            self.assertEqual(sorted(found(error, seed)), [["x"], ["y"]], seed)

    def test_a_surface_is_one(self):
        for seed in range(4):
            rng = np.random.default_rng([2, seed])
            self.assertEqual(found(4 * rng.standard_normal((ALONG, ACROSS)), seed), [["x", "y"]], seed)

    def test_one_curve_is_one(self):
        for seed in range(4):
            rng = np.random.default_rng([3, seed])
            self.assertEqual(found(4 * rng.standard_normal(ALONG)[:, None] * np.ones(ACROSS), seed), [["x"]], seed)


if __name__ == "__main__":
    unittest.main()
