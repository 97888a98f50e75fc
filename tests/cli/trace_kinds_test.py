"""A log whose channels are of different kinds: a straightness in um and a pitch in arcsec at the same positions.

usage: trace_kinds_test.py path/to/gumshoe [unittest options]
"""
import json
import random
import unittest

from program import InFolder, complaint, gumshoe

SCENARIO = """schema = 1
title = "straightness and pitch"
[model]
name = "expression"
[model.indications]
dx = "offset + gain * position"
rx = "angle + angle_gain * position"
[data]
file = "log.csv"
labels = {{ cycle = "cycle" }}
[data.units]
pos = "mm"
dx = "um"
rx = "{unit}"
[data.conditions]
position = "pos"
[quantities]
offset = {{ estimated = true, value = "0 um" }}
gain = {{ estimated = true, value = "0 um/mm" }}
angle = {{ estimated = true, value = "0 {unit}" }}
angle_gain = {{ estimated = true, value = "0 {unit}/mm" }}
[indications.dx]
readings = "dx"
[indications.rx]
readings = "rx"
[trace]
blocks = "cycle"
"""
ARCSEC = 4.84813681109536  # urad


def log(cycles, scale=1.0):
    """Parabolas of 3 um and -3 arcsec, noise 0.3 um and 0.4 arcsec."""
    draw = random.Random(3)
    yield "cycle,pos,dx,rx"
    for cycle in range(1, cycles + 1):
        for pos in range(0, 1001, 100):
            x = pos / 1000
            dx, rx = 12 * (x - 0.5) ** 2 + draw.gauss(0, 0.3), -12 * (x - 0.5) ** 2 + draw.gauss(0, 0.4)
            yield f"{cycle},{pos},{dx:.3f},{scale * rx!r}"


class Kinds(InFolder):
    def traced(self, unit, scale, cycles=5):
        (self.folder / "log.csv").write_text("\n".join(log(cycles, scale)) + "\n")
        (self.folder / "kinds.toml").write_text(SCENARIO.format(unit=unit))
        run = gumshoe("trace", "kinds.toml", "--loop", "3", "--draws", "199", "--json", "v.json", cwd=self.folder)
        return run, json.loads((self.folder / "v.json").read_text()) if run.returncode == 0 else None

    def test_noise_is_estimated_for_each_kind(self):
        """One noise of both would be that of the angles in rad, which hides the straightness."""
        run, verdict = self.traced("arcsec", 1)
        self.assertEqual(run.returncode, 0, run.stderr)
        first = verdict["rounds"][0]
        self.assertEqual(len(first["added"]), 2, first)
        # 55 readings, 11 positions of 5: s is known to 1 / sqrt(2 * 44) = 0.11, by the median to 0.2.
        self.assertAlmostEqual(first["after"], 0.3e-6, delta=0.15e-6)
        self.assertIn("root mean squares are in the unit of dx", run.stdout)
        text = (self.folder / "results" / "kinds.traced.toml").read_text()
        noise = [float(line.split('name = "trace", u = "')[1].split()[0]) for line in text.splitlines() if 'name = "trace", u =' in line]
        self.assertAlmostEqual(noise[0], 0.3, delta=0.15)
        self.assertAlmostEqual(noise[1], 0.4, delta=0.2)

    def test_the_unit_of_an_angle_changes_nothing(self):
        _, arcsec = self.traced("arcsec", 1)
        _, urad = self.traced("urad", ARCSEC)
        for a, b in zip(arcsec["rounds"], urad["rounds"], strict=True):
            self.assertEqual(a["added"], b["added"])
            for key in ("before", "after", "holdout_before", "holdout_after"):
                self.assertAlmostEqual(a[key] / b[key], 1, delta=1e-6)

    def test_too_few_readings_ask_for_the_noise(self):
        run, _ = self.traced("arcsec", 1, cycles=1)
        self.assertIsNone(complaint(run))
        self.assertIn("indications of different kinds have no noise stated", run.stderr)


if __name__ == "__main__":
    unittest.main()
