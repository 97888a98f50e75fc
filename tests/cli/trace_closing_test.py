"""The loop closed: what gumshoe trace found stands in a scenario that gumshoe run and gumshoe trace read.

usage: trace_closing_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import random
import statistics
import tomllib
import unittest

import h5py

from program import InFolder, complaint, gumshoe

FEEDS = (20, 200, 500, 1000)  # mm/min
NOISE = 5e-4  # mm


class Rods:
    """Made-up readings of rods in set-ups, each set-up with its own height of the beam, or none of its own."""

    def __init__(self, rods=("1",), setups=8, per_clamp=12, own=True, u=NOISE, redone="", length="", feeds=FEEDS, more=""):
        self.rods, self.own, self.noise = rods, own, u
        self.cells = [(str(s), r, k) for s in range(1, setups + 1) for r in rods for k in range(per_clamp)]
        self.feeds = [feeds[k % len(feeds)] for _, _, k in self.cells]
        self.directions = [-1] * len(self.cells)
        constants = "\n".join(f'"{k}" = {{ value = "-510 mm" }}' for k in range(1, setups + 1))
        laser = f"[quantities.laser_z]\nestimated = true\n[quantities.laser_z.by.setup]\n{constants}" if own else \
            '[quantities.laser_z]\nvalue = "-510 mm"'
        self.text = f"""# Question: what does the model lack?
schema = 1
title = "made-up rods"
[model]
name = "rod_gauging"
{laser}
[quantities.rod_length]
{length or 'value = "150 mm"'}
[indications.spindle_z]
readings = {{ file = "r.csv", column = "z", unit = "mm", labels = {{ setup = "setup", rod = "rod" }}, conditions = {{ feed = {{ column = "feed", unit = "mm/min" }}, direction = {{ column = "direction", unit = "1" }}, time = {{ column = "t", unit = "s" }} }} }}
components = [ {{ distribution = "normal", u = "0.5 um", per = "reading" }} ]
[run]
samples = 2000
[trace]
blocks = "setup"
order = "time"
draws = 99
{redone}
[trace.columns]
T = {{ column = "T", unit = "degC" }}
{more}
"""

    def write(self, folder, shift, seed=1):
        """`shift(i)` in mm at reading i."""
        chance = random.Random(seed)
        heights = {s: chance.gauss(0, 0.01) if self.own else 0 for s, _, _ in self.cells}
        self.temperature = [20 + 2 * math.sin(i / 7.3) for i in range(len(self.cells))]
        self.z = [-360 + heights[s] + shift(i) + chance.gauss(0, self.noise) for i, (s, _, _) in enumerate(self.cells)]
        rows = (f"{s},{r},{self.feeds[i]},{self.directions[i]},{60 * i},{self.temperature[i]:.6f},{self.z[i]:.7f}"
                for i, (s, r, _) in enumerate(self.cells))
        (folder / "r.csv").write_text("\n".join(("setup,rod,feed,direction,t,T,z", *rows)) + "\n")
        (folder / "s.toml").write_text(self.text)

    def latency(self, ms):
        """A later trigger lets the spindle travel on: lower by feed times delay."""
        return lambda i: -self.feeds[i] / 60 * ms * 1e-3


def in_mm(text):
    value, unit = text.split()
    return float(value) * {"mm": 1, "um": 1e-3, "m": 1e3}[unit]


class Closing(InFolder):
    def setUp(self):
        super().setUp()
        self.traced = self.folder / "results/s.traced.toml"

    def program(self, *words, code=0):
        run = gumshoe(*words, cwd=self.folder)
        self.assertEqual(run.returncode, code, run.stderr)
        return run.stdout

    def trace(self, scenario="s.toml", *words):
        return json.loads(self.program("trace", scenario, "--format", "json", *words))

    def closed(self, kind, name=None):
        """Verdict and the scenario written; it runs."""
        verdict = self.trace()
        self.assertEqual(verdict["verdict"], kind, [(f["name"], f["p_value"]) for f in verdict["findings"]])
        if name:
            self.assertEqual(verdict["findings"][0]["name"], name)
        text = self.traced.read_text()
        self.assertIn("# Question: what does the model lack?\n# Written by gumshoe ", text)
        self.program("run", self.traced, "--out", "run.h5")
        return verdict, tomllib.loads(text)

    def traced_again(self):
        verdict = self.trace(self.traced)
        self.assertEqual(verdict["verdict"], "nothing_found", [(f["name"], f["p_value"]) for f in verdict["findings"]])
        return verdict

    def test_effect_beside_the_constants_of_the_data(self):
        rods = Rods(length='value = "150 mm"')
        rods.write(self.folder, rods.latency(0.5), seed=6)
        verdict, s = self.closed("named", "trigger_latency")
        # What follows is of readings that weigh alike.
        self.assertEqual((verdict["noise"]["correlation"], verdict["noise"]["outliers"]), (0, 0))
        size = verdict["findings"][0]["quantities"][0]
        delay = s["effects"]["trigger_latency"]["delay"]
        number = lambda text: float(text.split()[0])
        self.assertAlmostEqual(number(delay["value"]), size["value"], delta=1e-9)
        self.assertAlmostEqual(number(delay["u"]), size["u"], delta=1e-9)
        for word in ("named, p = ", "95 % interval [", "72 readings", "hash of scenario and data "):
            self.assertIn(word, delay["source"])
        # Every set-up has its offset, also those held out: they differ by the means of readings corrected by the latency.
        self.assertEqual(s["trace"]["free"], ["laser_z", "trigger_latency.delay"])
        self.assertNotIn("estimated", s["quantities"]["laser_z"])
        heights = {k: in_mm(v["value"]) for k, v in s["quantities"]["laser_z"]["by"]["setup"].items()}
        corrected = {k: statistics.mean(z + f / 60 * number(delay["value"]) * 1e-3 for z, f, c in
                                        zip(rods.z, rods.feeds, rods.cells) if c[0] == k) for k in heights}
        for k in heights:
            self.assertAlmostEqual(heights[k] - heights["1"], corrected[k] - corrected["1"], delta=1e-3 * NOISE)
        # Two sources of a constant's variance: noise of twelve readings, and the delay times the mean feed; these also tie
        # any two constants: r = m^2 v / (m^2 v + noise^2/12), whatever the noise.
        tied = s["correlations"][0]
        self.assertEqual((tied["kind"], len(tied["quantities"])), ("pearson", 9))
        n, feeds = 72, [f / 60 for f in FEEDS]
        mean = statistics.mean(feeds)
        spread = sum((f - mean) ** 2 for f in feeds) / 4
        between = mean**2 / (n * spread)
        at = [tied["quantities"].index(q) for q in ("laser_z[setup 2]", "laser_z[setup 8]")]
        self.assertAlmostEqual(tied["matrix"][at[0]][at[1]], between / (between + 1 / 12), delta=0.005)
        j = tied["quantities"].index("trigger_latency.delay")
        sign = abs(tied["matrix"][j][at[1]])
        self.assertAlmostEqual(sign, math.sqrt(between / (between + 1 / 12)), delta=0.005)
        with h5py.File(self.folder / "results/s.traced.h5") as file:
            self.assertIn(b"trigger_latency.delay", list(file["budget_after/000/name"]))
            self.assertNotIn(b"trigger_latency.delay", list(file["budget_before/000/name"]))
        with h5py.File(self.folder / "run.h5") as file:
            self.assertIn(b"trigger_latency.delay", list(file["budget/000/name"]))
        self.traced_again()

    def test_effect_alone_has_its_sobol_index(self):
        rods = Rods(own=False, more="[analysis]\nsensitivity = { sobol = 512 }")
        rods.write(self.folder, rods.latency(0.5))
        verdict, s = self.closed("named", "trigger_latency")
        self.assertNotIn("correlations", s)
        self.assertEqual(s["analysis"]["sensitivity"], {"sobol": 512})
        # Of a height at 1000 mm/min: the noise of a reading and the delay times the feed, both normal and additive.
        feed, u = 1000 / 60 * 1e-3, float(s["effects"]["trigger_latency"]["delay"]["u"].split()[0])
        expected = (feed * u) ** 2 / ((feed * u) ** 2 + NOISE**2)
        with h5py.File(self.folder / "run.h5") as file:
            group = file["sensitivity/007"]  # two outputs each reading
            self.assertEqual(group.attrs["output"], "laser_z[setup 1, rod 1, feed 1000 mm/min, time 180 s]")
            names = [n.decode() for n in group["input"]]
            self.assertAlmostEqual(float(group["total"][names.index("trigger_latency.delay")]) / expected, 1, delta=0.3)
        self.traced_again()

    def test_correlated_inputs_get_shapley_effects(self):
        rods = Rods(more="[analysis]\nsensitivity = { sobol = 256 }")
        rods.write(self.folder, rods.latency(0.5))
        _, s = self.closed("named", "trigger_latency")
        self.assertEqual(s["analysis"]["sensitivity"], {"shapley": 256})

    def test_declared_quantity_of_one_label(self):
        length = 'value = "150 mm"\nu = "1 um"\nper = "rod"\nsource = "gauge block"'
        rods = Rods(rods=("1", "2", "3"), per_clamp=4, length=length)
        rods.write(self.folder, lambda i: 0.02 if rods.cells[i][1] == "2" else 0)
        verdict, s = self.closed("named", "declared:rod_length[rod 2]")
        by = s["quantities"]["rod_length"]["by"]["rod"]
        for k in ("1", "3"):  # as it was
            self.assertEqual(by[k], {"value": "150 mm", "u": "1 um", "per": "rod", "source": "gauge block"})
        size = verdict["findings"][0]["quantities"][0]
        self.assertAlmostEqual(in_mm(by["2"]["value"]), size["value"], delta=1e-9)
        self.assertNotIn("per", by["2"])
        # The mean of the others is known as declared, 1 um / sqrt 2.
        self.assertAlmostEqual(in_mm(by["2"]["u"]), math.hypot(1e-3 / math.sqrt(2), NOISE * math.sqrt(1.5 / 24)), delta=1e-4)
        self.traced_again()

    def test_declared_quantity_that_scatters_keeps_its_scatter(self):
        length = 'value = "150 mm"\ncomponents = [ { name = "own", u = "1 um", per = "rod" }, { name = "seat", u = "0.3 um", per = ["rod", "setup"] } ]'
        rods = Rods(rods=("1", "2", "3"), per_clamp=4, length=length)
        rods.write(self.folder, lambda i: 0.02 if rods.cells[i][1] == "2" else 0)
        _, s = self.closed("named", "declared:rod_length[rod 2]")
        components = s["quantities"]["rod_length"]["by"]["rod"]["2"]["components"]
        self.assertEqual([c["name"] for c in components], ["seat", "trace"])
        self.assertIn("rod_length[rod 2]: trace", s["correlations"][0]["quantities"])

    def test_class_is_written_by_its_first_and_names_the_others(self):
        rods = Rods(feeds=(30,), per_clamp=12)
        rods.directions = [1 if k % 2 else -1 for _, _, k in rods.cells]
        rods.write(self.folder, lambda i: 0.004 * rods.directions[i])
        verdict, s = self.closed("class")
        members = verdict["findings"][0]["members"]
        self.assertEqual(list(s["effects"]), [members[0]])
        (quantity,) = s["effects"][members[0]].values()
        for name in members:
            self.assertIn(name, quantity["source"])
        self.assertGreaterEqual(float(quantity["u"].split()[0]), verdict["findings"][0]["quantities"][0]["u"] * (1 - 1e-9))
        self.traced_again()

    def test_scatter_of_clampings(self):
        rods = Rods(rods=("1", "2", "3"), per_clamp=4, redone='redone = [["rod", "setup"]]')
        chance = random.Random(5)
        seat = {c[:2]: chance.gauss(0, 0.003) for c in rods.cells}
        rods.write(self.folder, lambda i: seat[rods.cells[i][:2]])
        verdict, s = self.closed("scatter", "scatter:rod,setup")
        shift = s["effects"]["reclamp"]["shift"]
        self.assertEqual((in_mm(shift["value"]), sorted(shift["per"])), (0, ["rod", "setup"]))
        self.assertAlmostEqual(in_mm(shift["u"]), verdict["findings"][0]["quantities"][0]["value"] * 1e-3, delta=1e-9)
        with h5py.File(self.folder / "run.h5") as file:
            self.assertTrue(any(n.startswith(b"reclamp.shift") for n in file["budget/000/name"]))
        self.traced_again()

    def test_no_act_done_anew_scatters_nothing(self):
        """The same readings: stated that nothing was clamped anew, no label is a variance component."""
        for redone, tried in (('redone = []', False), ("", True)):
            rods = Rods(rods=("1", "2", "3"), per_clamp=4, redone=redone)
            chance = random.Random(5)
            seat = {c[:2]: chance.gauss(0, 0.003) for c in rods.cells}
            rods.write(self.folder, lambda i: seat[rods.cells[i][:2]])
            run = gumshoe("trace", self.folder / "s.toml", "--out", self.folder / "t.h5", "--format", "json")
            self.assertEqual(run.returncode, 0, run.stderr)
            named = [f["name"] for f in json.loads(run.stdout)["findings"]]
            self.assertEqual(any(n.startswith("scatter:") and n != "scatter:reading" for n in named), tried, named)

    def test_noise_larger_than_declared(self):
        rods = Rods(u=3 * NOISE)
        rods.write(self.folder, lambda i: 0)
        _, s = self.closed("scatter", "scatter:reading")
        declared, added = s["indications"]["spindle_z"]["components"]
        self.assertEqual((declared["u"], added["per"]), ("0.5 um", "reading"))
        # 72 readings: sigma within 3 sqrt(1/144) of itself; what is added makes up the difference of squares.
        self.assertAlmostEqual(math.hypot(in_mm(added["u"]), NOISE) / (3 * NOISE), 1, delta=0.25)
        self.traced_again()

    def round_trip(self, verdict):
        """Round 2 starts where round 1 ended: the same errors and noise, and no finding."""
        again = self.traced_again()
        for key, after in (("before", "after"), ("holdout_before", "holdout_after"), ("noise", "noise")):
            self.assertAlmostEqual(again["rms"][key] / verdict["rms"][after], 1, delta=0.02, msg=key)
        return again

    def test_an_unknown_dependence_on_a_column_is_a_correction(self):
        rods = Rods()
        rods.write(self.folder, lambda i: 0.01 * math.sin(2.5 * (rods.temperature[i] - 20)))
        verdict, s = self.closed("not_in_catalogue")
        self.assertEqual(len(s["indications"]["spindle_z"]["components"]), 1)  # it is no noise
        stated = s["stated_effects"]
        for effect in stated.values():
            self.assertEqual(effect["indication"], "spindle_z")
            self.assertIn("not in the catalogue", effect["source"])
            self.assertIn("depends on T", effect["source"])
            self.assertEqual(len(effect["table"]["T"]), len(effect["table"]["loading"]))
        # The sum of the tables is what was put in, but for a constant, which set-ups take.
        levels = [float(t.split()[0]) for t in next(iter(stated.values()))["table"]["T"]]
        size = {name: in_mm(effect["size"]["value"]) for name, effect in stated.items()}
        found = [sum(size[n] * e["table"]["loading"][k] for n, e in stated.items()) for k in range(len(levels))]
        put = [0.01 * math.sin(2.5 * (t - 20)) for t in levels]
        difference = [a - b for a, b in zip(found, put)]
        self.assertLess(statistics.pstdev(difference), 3 * NOISE)
        self.round_trip(verdict)

    def test_an_unknown_step_by_label_is_a_correction(self):
        rods = Rods(rods=("1", "2", "3", "4"), per_clamp=4, redone="redone = []", setups=8)
        step = {"1": 0, "2": 0.004, "3": -0.002, "4": 0.001}
        rods.text = rods.text.replace('labels = { setup = "setup", rod = "rod" }', 'labels = { setup = "setup", batch = "rod" }')
        rods.write(self.folder, lambda i: step[rods.cells[i][1]])
        verdict, s = self.closed("not_in_catalogue")
        by = s["stated_effects"]["shape_1"]["size"]["by"]["batch"]
        value = lambda k: in_mm(by[k]["value"] if isinstance(by[k], dict) else by[k])
        for k in step:
            self.assertAlmostEqual(value(k) - value("1"), step[k], delta=5 * NOISE / math.sqrt(24))
        self.round_trip(verdict)

    def test_beyond_its_levels_a_correction_is_refused(self):
        rods = Rods()
        rods.write(self.folder, lambda i: 0.01 * math.sin(2.5 * (rods.temperature[i] - 20)))
        self.closed("not_in_catalogue")
        lines = (self.folder / "r.csv").read_text().splitlines()
        cells = lines[1].split(",")
        (self.folder / "r.csv").write_text("\n".join([lines[0], ",".join([*cells[:5], "40", cells[6]]), *lines[2:]]) + "\n")
        run = gumshoe("check", self.traced)
        self.assertIsNone(complaint(run))
        self.assertRegex(run.stderr, r"it has no value at reading 1 \(setup = 1, rod = 1\), where \w+ = 40 degC \(it is known "
                                     r"from \S+ degC to \S+ degC\)\. Measure there and add the level")

    def test_estimated_noise_is_written(self):
        rods = Rods()
        rods.text = rods.text.replace('components = [ { distribution = "normal", u = "0.5 um", per = "reading" } ]\n', "")
        rods.write(self.folder, rods.latency(0.5))
        verdict, s = self.closed("named", "trigger_latency")
        added, = s["indications"]["spindle_z"]["components"]
        self.assertEqual(added["per"], "reading")
        self.assertAlmostEqual(in_mm(added["u"]) / NOISE, 1, delta=3 / math.sqrt(2 * 63))
        self.round_trip(verdict)

    def test_the_loop_ends_with_one_scenario(self):
        rods = Rods()
        wave = lambda i: 0.01 * math.sin(2.5 * (rods.temperature[i] - 20))
        rods.write(self.folder, lambda i: rods.latency(0.5)(i) + wave(i))
        verdict = self.trace("s.toml", "--loop", "5")
        rounds = verdict["rounds"]
        self.assertEqual(rounds[-1]["added"], [])
        self.assertIn("trigger_latency", rounds[0]["added"])
        for a, b in zip(rounds, rounds[1:]):
            for before, after in (("before", "after"), ("holdout_before", "holdout_after")):
                self.assertAlmostEqual(b[before] / a[after], 1, delta=0.02)
        self.traced_again()
        said = self.program("trace", "s.toml", "--loop", "5")
        self.assertRegex(said, r"round +before +after +noise +floor +held out +after +noise +added\n1 .*trigger_latency.*\n(.*\n)*\d .*nothing\n")

    def test_stated_effect_gets_its_size(self):
        film = '[stated_effects.film]\nindication = "spindle_z"\nformula = "1 / feed"\nunit = "um*mm/min"\nmeaning = "coolant"'
        rods = Rods(more=film)
        rods.write(self.folder, lambda i: 0.1 / rods.feeds[i])
        verdict, s = self.closed("named", "film")
        size = verdict["findings"][0]["quantities"][0]
        self.assertAlmostEqual(float(s["stated_effects"]["film"]["size"]["value"].split()[0]), size["value"], delta=1e-6)
        self.traced_again()

    def test_nothing_found_the_fit_is_written(self):
        rods = Rods()
        rods.write(self.folder, rods.latency(0.5))
        self.assertIn(f"scenario with the findings: {self.traced.relative_to(self.folder)}", self.program("trace", "s.toml"))
        rods.write(self.folder, lambda i: 0)
        self.assertIn("scenario as fitted: ", self.program("trace", "s.toml"))
        fitted = self.traced.read_text()
        self.assertNotIn("trigger_latency", fitted)  # of the other data
        self.assertIn("fitted to these readings;", fitted)

    def test_what_somebody_else_wrote_is_left_alone(self):
        rods = Rods()
        rods.write(self.folder, rods.latency(0.5))
        self.traced.parent.mkdir()
        self.traced.write_text("schema = 1\n")
        run = gumshoe("trace", "s.toml", cwd=self.folder)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertEqual(self.traced.read_text(), "schema = 1\n")

    def test_other_data_other_folder(self):
        rods = Rods()
        rods.write(self.folder, rods.latency(0.5))
        (self.folder / "r.csv").rename(self.folder / "other.csv")
        (self.folder / "out").mkdir()
        self.trace("s.toml", "--data", "other.csv", "--out", "out/a.h5")
        s = tomllib.loads((self.folder / "out/s.traced.toml").read_text())
        self.assertEqual(s["indications"]["spindle_z"]["readings"]["file"], "../other.csv")
        self.program("check", "out/s.traced.toml")

    def test_free_names_a_quantity(self):
        rods = Rods(redone='free = ["laser_zz"]')
        rods.write(self.folder, lambda i: 0)
        run = gumshoe("check", "s.toml", cwd=self.folder)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn("trace.free: 'laser_zz' is not a quantity", run.stderr)


if __name__ == "__main__":
    unittest.main()
