"""u of a table of compensation: what the fit gives, and what the declared quantities that it held add.

usage: compensate_uncertainty_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import random
import re
import unittest

from program import InOneFolder, gumshoe

POSITIONS = [100.0 * i for i in range(5)]
SCENARIO = """schema = 1
[model]
name = "linear_axis"
[conditions]
position = {positions}
direction = {directions}
time = {{ spread = ["0 min", "60 min"], readings = 30 }}
[indications.deviation]
readings = {readings}
{noise}
[quantities]
offset = {{ estimated = true, value = "0 um" }}
gain = {{ estimated = true, value = "0 um/m"{prior} }}
{declared}
[effects.axis_reversal]
backlash = {{ estimated = true, value = "0 um" }}
"""
NOISE = 'components = [ { u = "0.05 um", per = "reading" } ]'


class Uncertainty(InOneFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        chance = random.Random(5)
        places = [(x, way) for _ in range(3) for way in (1, -1) for x in POSITIONS[::way]]
        cls.filled = {"positions": json.dumps([f"{x} mm" for x, _ in places]), "directions": json.dumps([way for _, way in places]),
                      "readings": json.dumps([f"{2 + 0.03 * x - 1.5 * way + chance.gauss(0, 0.05):.3f} um" for x, way in places])}

    def estimated(self, declared, prior="", noise=NOISE):
        text = SCENARIO.format(declared=declared, prior=prior, noise=noise, **self.filled)
        (self.folder / "s.toml").write_text(text)
        run = gumshoe("estimate", "s.toml", "--scenario-out", "e.toml", "--force", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)

    def table(self, *words):
        """{(position, direction): (error, u)} in um, and what was said."""
        run = gumshoe("compensate", "e.toml", *words, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        rows = csv.DictReader(line for line in io.StringIO(run.stdout) if not line.startswith("#"))
        return {(float(r["position_mm"]), int(r["direction"])): (float(r["error_um"]), float(r["u_um"])) for r in rows}, run

    def test_a_temperature_that_the_fit_held_is_in_u(self):
        """The axis is reduced to 20 degC by 11.5 um/m/K: 0.1 K is 0.46 um at 400 mm, of which the noise knows nothing."""
        self.estimated('temperature_difference = { value = "1 K", u = "0.1 K" }')
        rows, run = self.table("--with", "gain")
        self.estimated('temperature_difference = "1 K"')
        plain, quiet = self.table("--with", "gain")
        for (x, way), (error, u) in rows.items():
            self.assertAlmostEqual(error, plain[x, way][0], delta=1.1e-4)
            self.assertAlmostEqual(u, math.hypot(plain[x, way][1], x * 1e-3 * 11.5 * 0.1), delta=1.1e-4)
        self.assertLess(plain[400.0, 1][1], 0.1)
        self.assertIn("# u contains the declared uncertainty of temperature_difference\n", run.stdout)
        self.assertIn("u contains the declared uncertainty of temperature_difference (up to 0.46 um)\n", run.stderr)
        self.assertNotIn("declared", quiet.stdout + quiet.stderr)

    def test_what_the_readings_are_less_of_is_named(self):
        """Offset and gain are fitted, but not in the table: 2 um and 30 um/m would stay in the readings that it is used for."""
        self.estimated('temperature_difference = "0 K"')
        places = [x for x in POSITIONS for _ in (1, -1)]
        expected = {"offset and gain": [(0, 0)], "offset": [(0, 0.03)], None: [(2, 0.03)]}
        for words, (less, [(offset, gain)]) in zip(((), ("--with", "gain"), ("--with", "gain", "--with", "offset")), expected.items()):
            said = re.search(r"root mean square of these readings(?:, less ([a-z ]+))?: (\S+) um, with the table 0.0\d+ um",
                             self.table(*words)[1].stderr)
            # Of values (v + 1.5)^2 and (v - 1.5)^2 and noise; offset and gain are fitted within 0.02 um and 0.1 um/m.
            rms = math.sqrt(sum((offset + gain * x) ** 2 for x in places) / len(places) + 1.5**2 + 0.05**2)
            self.assertEqual(said[1], less)
            self.assertAlmostEqual(float(said[2]), rms, delta=0.06)

    def test_what_a_quantity_that_is_left_out_takes_up_is_not_in_u(self):
        """The gain is the set-up's then, and the reversal is the same at every temperature."""
        self.estimated('temperature_difference = { value = "1 K", u = "0.1 K" }')
        rows, run = self.table()
        for error, u in rows.values():
            self.assertAlmostEqual(u, 0.05 / math.sqrt(30), delta=1e-4)  # half the reversal, from all readings
        self.assertNotIn("declared", run.stdout + run.stderr)

    def test_u_is_by_how_much_another_value_would_move_the_table(self):
        """The fit is done again with each declared quantity shifted by its u: a drift, which the order of the readings mixes
        into gain and reversal; with a prior that shares the data with it; with noise that the fit estimates."""
        declared = {"temperature_difference": (1, 0.1, "K"), "reference_drift": (0.2, 0.4, "um/h"), "expansion": (11.5, 2, "um/m/K")}
        def text(u=True, **shift):
            return "\n".join(f'{name} = {{ value = "{value + shift.get(name, 0)} {unit}"' + (f', u = "{by} {unit}" }}' if u else " }")
                             for name, (value, by, unit) in declared.items())
        for prior, noise in (("", NOISE), (', u = "0.05 um/m"', NOISE), ("", "")):
            with self.subTest(prior=prior, noise=noise):
                self.estimated(text(), prior, noise)
                rows, run = self.table("--with", "gain", "--with", "offset")
                self.estimated(text(u=False), prior, noise)
                plain, _ = self.table("--with", "gain", "--with", "offset")
                squares, most = {at: u * u for at, (_, u) in plain.items()}, {}
                for name, (_, by, _) in declared.items():
                    self.estimated(text(u=False, **{name: by}), prior, noise)
                    moved, _ = self.table("--with", "gain", "--with", "offset")
                    for at in squares:
                        squares[at] += (moved[at][0] - plain[at][0])**2
                        most[name] = max(most.get(name, 0), abs(moved[at][0] - plain[at][0]))
                for at, (_, u) in rows.items():  # printed to 0.1 nm, errors of less than 1 um twice
                    self.assertAlmostEqual(u, math.sqrt(squares[at]), delta=4e-4, msg=at)
                for name, by in most.items():
                    said = re.search(rf"{name} \(up to (\S+) um\)", run.stderr)
                    self.assertAlmostEqual(float(said[1]), by, delta=6e-3 * by + 2e-4)

    def test_what_u_cannot_contain_is_said(self):
        self.estimated('temperature_difference = { value = "1 K", u = "0.1 K" }')
        text = (self.folder / "e.toml").read_text()
        (self.folder / "e.toml").write_text(re.sub(r"(?m)^components = .*\n", "", text))
        _, run = self.table("--with", "gain")
        self.assertIn("# u does not contain the declared uncertainty of temperature_difference\n", run.stdout)
        self.assertIn("warning: u does not contain the declared uncertainty of temperature_difference (the estimate held it", run.stderr)


if __name__ == "__main__":
    unittest.main()
