"""What is stated reading by reading stays with its reading, where a study looks at one alone.

usage: single_readings_test.py path/to/gumshoe [unittest options]
"""
import math
import unittest

import h5py
import numpy as np

from program import InFolder, gumshoe

LENGTHS = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "z"
[conditions]
p = 1
[indications.z]
{noise}
[indications.z.readings]
file = "z.csv"
column = "z"
unit = "um"
{labels}
conditions = {{ p = {{ column = "p" }} }}
{more}
[run]
samples = 200000
"""
K = 1.959964


class SingleReadings(InFolder):
    def targets(self, quantity, noise, more, labels="", measurand="z"):
        """The u that is allowed for a quantity, in um by output, of a target of U = 10 um."""
        (self.folder / "z.csv").write_text("n,z,p,ux\n1,10,1,1\n2,20,2,3\n3,30,3,4\n")
        (self.folder / "s.toml").write_text(LENGTHS.format(noise=noise, more=more, labels=labels).replace('y = "z"', f'y = "{measurand}"'))
        run = gumshoe("run", "s.toml", "--out", "o.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        with h5py.File(self.folder / "o.h5") as f:
            return [t["allowed"][list(t["quantity"][:]).index(quantity.encode())] * 1e6 for t in f["target"].values()]

    def test_the_noise_of_each_reading(self):
        """Readings of 1, 3 and 4 um without labels: what they leave for another quantity."""
        found = self.targets("x", 'u = { column = "ux", unit = "um" }', '[quantities]\nx = { value = "0 um", u = "1 um" }\n'
                             '[[analysis.targets]]\nmeasurand = "y"\nU = "10 um"\n', measurand="z + x")
        self.assertEqual(len(found), 3, found)
        for own, u in zip((1, 3, 4), found):
            exact = math.sqrt((10 / K) ** 2 - own**2)
            self.assertAlmostEqual(u, exact, delta=0.02 * exact)

    def test_a_stated_effect(self):
        """Its size is multiplied by 1, 2 and 3; readings have a noise of 2 um."""
        found = self.targets("film.size", 'u = "2 um"', """[stated_effects.film]
unit = "um"
formula = "p"
indication = "z"
size = { value = "0 um", u = "1 um" }
[[analysis.targets]]
measurand = "y"
U = "10 um"
""", 'labels = { n = "n" }')
        for n, u in zip((1, 2, 3), found):
            exact = math.sqrt((10 / K) ** 2 - 4) / n
            self.assertAlmostEqual(u, exact, delta=0.02 * exact)

    def test_morris_moves_readings_from_points_of_their_own(self):
        """y = z^2 of three readings, each with a draw of its own: the same base points would give equal figures."""
        (self.folder / "z.csv").write_text("n,z,p\n1,0,1\n2,0,1\n3,0,1\n")
        (self.folder / "s.toml").write_text(LENGTHS.format(noise='u = "1 um"', labels='labels = { n = "n" }',
                                                           more="[analysis]\nsensitivity = { morris = 64 }")
                                            .replace('y = "z"', 'y = "z^2"'))
        run = gumshoe("run", "s.toml", "--samples", "2000", "--out", "o.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        with h5py.File(self.folder / "o.h5") as f:
            found = [study["mean_absolute"][0] for study in f["morris"].values()]
        self.assertEqual(len(found), 3)
        self.assertEqual(len(set(found)), 3, found)
        for one in found:  # E|x(a)^2 - x(b)^2| / |step|: the same for all but for sampling
            self.assertAlmostEqual(one / np.mean(found), 1, delta=5 / math.sqrt(64))


if __name__ == "__main__":
    unittest.main()
