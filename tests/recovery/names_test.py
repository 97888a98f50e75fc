"""Right names and right sizes, on made-up sets that once got wrong ones.

usage: names_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import pathlib
import random
import sys
import tempfile
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "cli")]

import battery_sets
import families
import rods
import sets
import spheres
from program import GUMSHOE, gumshoe
from trace_closing_test import Rods

LINE = """schema = 1
title = "a line against a reference"
[model]
name = "expression"
[model.indications]
d = "gain * x + offset"
[conditions]
x = "0 mm"
place = 0
[quantities]
gain = { estimated = true, value = 0, unit = "um/m" }
offset = { estimated = true, value = "0 um" }
[indications.d]
components = [ { distribution = "normal", u = "1 um", per = "reading"FREEDOM } ]
[indications.d.readings]
file = "r.csv"
column = "d"
unit = "um"
labels = { cycle = "cycle" }
conditions = { x = { column = "x", unit = "mm" }, place = { column = "x", unit = "1" } }
[trace]
blocks = "cycle"
order = "t"
draws = 199
MORE
[trace.columns]
t = { column = "t", unit = "s" }
STATED
"""


class Names(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.path = pathlib.Path(temporary.name)

    def trace(self, scenario, *words):
        run = gumshoe("trace", scenario, "--format", "json", "--out", self.path / "o.h5", "--force", *words, cwd=self.path)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def line(self, shift, seed, noise=1.0, cycles=6, stated=(), freedom="", more=""):
        """A line at 20 places over cycles of 200 s, with shift(x in mm, t in s) in um."""
        chance, rows, t = random.Random(seed), ["cycle,x,t,d"], 0
        for cycle in range(1, cycles + 1):
            for x in range(0, 400, 20):
                rows.append(f"{cycle},{x},{t},{shift(x, t) + chance.gauss(0, noise):.6f}")
                t += 10
        entry = '[stated_effects.{}]\nindication = "d"\nmeaning = "{}"\nformula = "{}"\nunit = "{}"\n'
        text = "".join(entry.format(name, name, formula, *(unit or ["um"])) for name, formula, *unit in stated)
        (self.path / "r.csv").write_text("\n".join(rows) + "\n")
        (self.path / "s.toml").write_text(LINE.replace("STATED", text).replace("FREEDOM", freedom).replace("MORE", more))
        return self.trace("s.toml")

    # quantities with wide priors are fitted with the whole model

    def wide(self, seed, reversal=0.0):
        rng = sets.stream(seed, "wide priors")
        d = spheres.design(rng, wide=True)
        q = np.array([c.value + c.u * rng.standard_normal() for c in d.cells])
        turned = -0.5 * reversal * spheres.ARCSEC * d.value("C_direction")
        y = spheres.simulate(None, d, [q], C_error=turned)[0]
        y = y + d.noise * rng.standard_normal(y.shape)
        return self.trace(sets.write(self.path, self.path / "truth", "set", d, y, {}, spheres), "--draws", "199"), d.noise

    def test_wide_priors_and_nothing_else(self):
        alarms = 0
        for seed in (1, 2, 3, 4):
            v, noise = self.wide(seed)
            alarms += bool(v["findings"])
            for key in ("before", "holdout_before"):  # the millimetres of the priors are gone
                self.assertLess(v["rms"][key] * 1e6, 1.5 * noise, (seed, key))
        self.assertLessEqual(alarms, 1)  # at 0.05 each, two or more of four come once in seventy

    def test_reversal_beside_wide_priors(self):
        v, _ = self.wide(5, reversal=8.0)
        self.assertEqual([f["name"] for f in v["findings"]], ["c_axis_reversal"])
        q = v["findings"][0]["quantities"][0]
        self.assertLess(abs(q["value"] - 8), 4 * q["u"])

    # what another finding explains is dropped

    def test_a_name_that_stands_for_two_is_dropped_for_them(self):
        a, b = (lambda x: math.sin(x / 23)), (lambda x: math.cos(x / 31))
        stated = (("first", "sin(place / 23)"), ("second", "cos(place / 31)"), ("mixture", "sin(place / 23) + 0.6 * cos(place / 31) + 0.3 * sin(place / 9)"))
        v = self.line(lambda x, t: 2.5 * a(x) + 2.5 * b(x), 1, stated=stated)
        self.assertEqual(sorted(f["name"] for f in v["findings"]), ["first", "second"], v["findings"])

    # a shape of many sizes holds an effect and a simpler shape

    def both_ways(self, shift, seed):
        """A slide at ten places, up and down in six cycles, with shift(x in mm, direction) in um."""
        chance, rows, t = random.Random(seed), ["cycle,x,way,t,d"], 0
        for cycle in range(1, 7):
            for way in (1, -1):
                for x in range(0, 400, 40)[::way]:
                    rows.append(f"{cycle},{x},{way},{t},{shift(x, way) + chance.gauss(0, 1):.6f}")
                    t += 10
        (self.path / "r.csv").write_text("\n".join(rows) + "\n")
        text = LINE.replace("place = 0", "direction = 1").replace('place = { column = "x"', 'direction = { column = "way"')
        effect = '[stated_effects.lost_motion]\nindication = "d"\nformula = "direction"\nunit = "um"\n'
        (self.path / "s.toml").write_text(text.replace("STATED", effect).replace("FREEDOM", "").replace("MORE", ""))
        return self.trace("s.toml")

    def test_a_reversal_is_found_beside_any_error_of_position(self):
        error = random.Random(7)
        table = {x: error.gauss(0, 3) for x in range(0, 400, 40)}
        for seed in (1, 2, 3):
            v = self.both_ways(lambda x, way: table[x] + 1.2 * way, seed)
            found = {f.get("name") or f["kind"]: f for f in v["findings"]}
            self.assertIn("lost_motion", found, v["findings"])
            size = found["lost_motion"]["quantities"][0]
            self.assertLess(abs(size["value"] - 1.2), 4 * size["u"])

    def test_no_reversal_is_found_in_an_error_of_position(self):
        error = random.Random(7)
        table = {x: error.gauss(0, 3) for x in range(0, 400, 40)}
        for seed in (1, 2, 3):
            v = self.both_ways(lambda x, way: table[x], seed)
            self.assertNotIn("lost_motion", [f.get("name") for f in v["findings"]], seed)

    def test_a_growing_reversal_is_no_constant_one(self):
        for seed in (1, 2, 3):
            v = self.both_ways(lambda x, way: 0.012 * x * way, seed)
            self.assertNotIn("lost_motion", [f.get("name") for f in v["findings"]], seed)
            self.assertEqual(v["findings"][0]["depends_on"], ["x", "direction"], v["findings"])

    # shape parameters are sizes

    def test_a_time_constant_is_a_size(self):
        rods = Rods(setups=8, per_clamp=12)
        rods.write(self.path, lambda i: 20e-3 * math.exp(-i / 17.0), seed=3)  # 96 readings, one a minute
        v = self.trace("s.toml", "--draws", "199")
        self.assertEqual([f["name"] for f in v["findings"]], ["thermal_growth"], v["findings"])
        sizes = {q["name"]: q for q in v["findings"][0]["quantities"]}
        q = sizes["time_constant"]
        self.assertLess(abs(q["value"] - 17), 4 * q["u"])
        self.assertLess(q["u"], 3)
        low, high = q["interval95"]
        self.assertTrue(0 < low < q["value"] < high)
        run = gumshoe("run", next(self.path.rglob("*.traced.toml")), "--out", self.path / "run.h5", cwd=self.path)
        self.assertEqual(run.returncode, 0, run.stderr)

    # a shift of all leaves what is declared of each

    def test_a_shared_shift_leaves_the_draws_of_labels(self):
        names = ("1", "2", "3", "4")
        cells = "\n".join(f'"{r}" = {{ value = "150 mm", u = "3 um" }}' for r in names)
        rods = Rods(rods=names, setups=6, per_clamp=6, own=False, length=f"[quantities.rod_length.by.rod]\n{cells}")
        rods.text = rods.text.replace("[quantities.rod_length]\n[quantities.rod_length.by.rod]", "[quantities.rod_length.by.rod]")
        chance = random.Random(7)
        own = {r: chance.gauss(0, 3e-3) for r in names}
        rods.write(self.path, lambda i: 0.05 + own[rods.cells[i][1]], seed=4)
        v = self.trace("s.toml", "--draws", "199")
        self.assertEqual(len(v["findings"]), 1, [f["name"] for f in v["findings"]])

    # noise

    def test_a_declared_s_is_known_by_its_degrees_of_freedom(self):
        self.assertEqual(self.line(lambda x, t: 0, 2, noise=2)["verdict"], "scatter")
        self.assertEqual(self.line(lambda x, t: 0, 2, noise=2, freedom=", degrees_of_freedom = 3")["verdict"], "nothing_found")

    def test_both_numbers_of_a_noise_that_is_too_large(self):
        f = self.line(lambda x, t: 0, 2, noise=2.5)["findings"][0]
        self.assertTrue(any("1 um is declared" in r for r in f["remarks"]), f)

    # cycles, drifts and bad readings

    REDONE = 'redone = [["cycle"]]\nfinal = ["2", "4"]'

    def test_one_cycle_that_differs_is_no_scatter(self):
        for seed in (3, 4):
            v = self.line(lambda x, t: 4 if t < 200 else 0, seed, more=self.REDONE)
            self.assertEqual([f["kind"] for f in v["findings"]], ["not_in_catalogue"], v["findings"])
            self.assertIn("cycle 1 differs", v["plain"][0])
            first, second = self.trace("s.toml", "--loop", "2")["rounds"]
            for before, after in (("before", "after"), ("holdout_before", "holdout_after")):
                self.assertAlmostEqual(second[before] / first[after], 1, delta=0.02)

    def test_cycles_that_all_differ_are_scatter(self):
        shifts = (2.1, -1.4, 0.9, -2.6, 3.2, -0.8)
        v = self.line(lambda x, t: shifts[t // 200], 3, more=self.REDONE)
        self.assertEqual([f["name"] for f in v["findings"]], ["scatter:cycle"], v["findings"])

    def test_a_drift_stays_where_cycles_might_scatter(self):
        """Each cycle's mean drifts; beside a wave that is found first, the drift stays, alone or in a class."""
        stated = (("wave", "sin(place / 23)"), ("drift", "t", "um/s"))
        v = self.line(lambda x, t: 3 * math.sin(x / 23) + 4e-3 * t, 3, stated=stated, more=self.REDONE)
        self.assertEqual(v["findings"][0]["name"], "wave", v["findings"])
        self.assertIn("drift", [m for f in v["findings"][1:] for m in f["members"]], v["findings"])
        self.assertLess(v["rms"]["holdout_after"], 1.2e-6)

    def test_correlation_does_not_take_a_drift(self):
        v = self.line(lambda x, t: 4e-3 * t, 5, stated=(("drift", "t", "um/s"),))
        self.assertEqual([f["name"] for f in v["findings"]], ["drift"], v["findings"])

    def battery(self, name, seed):
        """Names that the rounds find in one set of a family of the battery."""
        family, = [f for f in families.FAMILIES if f.name == name]
        scenario, _ = battery_sets.make(GUMSHOE, family, seed, self.path / f"{name}{seed}")
        return [f["name"] for f in self.trace(scenario, "--loop", "2", "--draws", "199")["findings"]]

    def test_scatter_of_passes_is_excluded_by_a_drift_that_it_would_seldom_look_like(self):
        """Of four passes' means, scatter gives a line so straight in one of a hundred sets."""
        for seed in (1100, 1103):
            self.assertEqual(self.battery("lever stated:play@10+stated:drift@8 white", seed), ["play", "drift"], seed)

    def test_a_cause_that_explains_as_much_goes_before_a_curve(self):
        """Passes that may scatter hide most of a drift: its square in time passes the threshold, the drift does not."""
        self.assertEqual(self.battery("positioning stated:drift@8 white", 4604), ["drift"])

    def test_a_cause_goes_before_a_line_that_explains_as_much_of_the_scatter(self):
        """The passes' means lie on a line in time, which is the drift's own signature."""
        for seed in (4802, 4814):
            self.assertEqual(self.battery("positioning stated:drift@8 white", seed), ["drift"], seed)

    def test_a_curve_in_a_condition_is_not_named_after_an_effect_of_that_condition(self):
        for seed in (1108, 1115):
            self.assertEqual(self.battery("rod_gauging cubic@12 white", seed), ["not in the catalogue"], seed)

    def test_a_bad_reading_does_not_pass_its_error_on(self):
        """The twelve readings of a socket determine four unknowns, which take a third of what one of them is off by."""
        self.assertEqual(self.battery("single_socket bar_drift@15 one_bad", 1102), ["bar_drift"])

    def test_one_bad_reading_held_out_does_not_decide(self):
        bad = lambda x, t: 3 * math.sin(x / 23) + (25 if (x, t) == (100, 650) else 0)
        v = self.line(bad, 3, stated=(("wave", "sin(place / 23)"),), more=self.REDONE)
        self.assertEqual([f["name"] for f in v["findings"]], ["wave"], v["findings"])
        self.assertLess(v["rms"]["holdout_after_winsorised"], 0.5 * v["rms"]["holdout_after"])
        self.assertIn("bad readings cut", v["plain"][1])
        self.assertEqual([round(abs(o["residual"])) for o in v["outliers"]], [25], v["outliers"])

    def test_what_the_training_data_show_stands_where_the_rest_is_predicted_worse_by_chance(self):
        """Strength 8, a tenth to a fifth of the readings left out: they alone reject the right name."""
        for name, found, seed in (("rod_gauging declared:rod_length[rod 3]@8 white", "declared:rod_length[rod 3]", 4612),
                                  ("single_socket x_reversal@8 white", "x_reversal", 4619)):
            self.assertEqual(self.battery(name, seed), [found], seed)

    def test_outliers_at_the_start_are_no_shape(self):
        for seed in (1, 2, 3):
            v = self.line(lambda x, t: (20, 8, 5)[t // 10] if t < 30 else 0, seed)
            self.assertFalse([f for f in v["findings"] if f["kind"] == "not_in_catalogue" and f["depends_on"][0] in ("t", "order")], v["findings"])

    def test_an_effect_of_one_rod_has_its_name_and_its_size(self):
        """24 readings of rod 3, half of them from each side, each good to 0.5 um: u of their difference."""
        u = 2 * 0.5 / math.sqrt(24)
        for seed in (301, 302):
            d, y, truth = sets.make(GUMSHOE, rods, "single", "z_reversal[rod 3]", 8, seed)
            v = self.trace(sets.write(self.path, self.path / "truth", f"one_{seed}", d, y, truth, rods), "--draws", 199)
            self.assertEqual([f["name"] for f in v["findings"]], ["z_reversal[rod 3]"], v["findings"])
            self.assertIn("direction", v["findings"][0]["depends_on"])
            size, = v["findings"][0]["quantities"]
            self.assertEqual(size["labels"], {"rod": "3"})
            self.assertAlmostEqual(size["u"], u, delta=0.3 * u)
            self.assertAlmostEqual(size["value"], truth["effects"][0]["size"], delta=3.5 * u)
            again = self.trace(self.path / "scenario.traced.toml", "--draws", 199)
            self.assertEqual(again["findings"], [])
            self.assertAlmostEqual(again["rms"]["before"], v["rms"]["after"], delta=1e-3 * v["rms"]["after"])


if __name__ == "__main__":
    unittest.main()
