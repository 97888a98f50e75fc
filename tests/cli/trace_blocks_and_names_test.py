"""Traces of a straight axis that a formula states: a block that differs and a drift, effects that hide each other, waves
that equal steps cannot distinguish; and how sizes and suggestions are worded.

usage: trace_blocks_and_names_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import random
import re
import unittest

from program import InFolder, gumshoe

AXIS = """schema = 1
[model]
name = "expression"
[model.indications]
deviation = "offset + gain * position + reversal * direction"
[data]
file = "s.csv"
labels = { cycle = "cycle" }
conditions = { position = "x_mm", direction = "direction" }
units = { x_mm = "mm", time_min = "min", deviation_um = "um", room_degC = "degC" }
[indications.deviation]
readings = "deviation_um"
[quantities]
offset = { estimated = true, value = "0 um" }
gain = { estimated = true, value = "0 um/mm" }
reversal = { estimated = true, value = "0 um" }
[trace]
blocks = "cycle"
order = "time"
[trace.columns]
time = "time_min"
room = "room_degC"
"""
STATED = """[conditions]
T_ref = "20 degC"
tau = "15 min"
[stated_effects.expansion]
formula = "position * (room - T_ref)"
unit = "um/m/K"
[stated_effects.warming]
formula = "1 - exp(-time / tau)"
unit = "um"
"""


def room(time, seed):
    return 20 + 1.5 * math.sin(2 * math.pi * time / 150 + 1) + 0.3 * math.sin(time / 3.1 + seed)


def readings(seed, error, places=range(0, 501, 50), cycles=5, noise=0.5):
    """Up and down `cycles` times: offset, slope and reversal of the model, and error(cycle, place, time, room), in um."""
    draw, rows, time = random.Random(seed), ["cycle,x_mm,direction,time_min,room_degC,deviation_um"], 0.0
    places = list(places)
    for cycle in range(1, cycles + 1):
        for direction in (1, -1):
            for x in places[::direction]:
                here = room(time, seed)
                d = 3 + 0.02 * x + 1.2 * direction + error(cycle, x, time, here) + draw.gauss(0, noise)
                rows.append(f"{cycle},{x:g},{direction},{time:.2f},{here:.3f},{d:.3f}")
                time += 0.6
    return "\n".join(rows) + "\n"


class BlocksAndNames(InFolder):
    def trace(self, data, scenario=AXIS):
        (self.folder / "s.csv").write_text(data)
        (self.folder / "s.toml").write_text(scenario)
        run = gumshoe("trace", "s.toml", "--draws", "199", "--format", "json", "--force", "--threads", "1", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def test_one_cycle_that_differs_and_a_drift_are_two(self):
        """Any value by cycle would explain both, and predict nothing of the next cycle."""
        for seed in (1, 2, 3):
            v = self.trace(readings(seed, lambda cycle, x, time, room: 2 * (cycle == 3) + 0.04 * time))
            self.assertEqual([f["described_by"] for f in v["findings"]], ["step:cycle 3", "polynomial:time"], v["plain"])
            self.assertLess(v["rms"]["holdout_after"], v["rms"]["holdout_before"])

    def test_values_by_cycle_say_nothing_of_another(self):
        """Cycles at random: of one that is held out their mean is known, as it was without them."""
        level = [3, -2, 1.5, -2.5, 0.2]  # the first is far from the mean
        v = self.trace(readings(1, lambda cycle, x, time, room: level[cycle - 1]))
        self.assertEqual([f["depends_on"] for f in v["findings"]], [["cycle"]], v["plain"])
        rms = v["rms"]
        self.assertLess(rms["holdout_after"], 1.05 * rms["holdout_before"], v["plain"])

    def test_an_operator_is_no_scatter_of_his_runs(self):
        """Nine runs of three operators, of whom one reads 1.5 um more, while the readings follow the room's temperature."""
        scenario = AXIS.replace('{ cycle = "cycle" }', '{ cycle = "cycle", operator = "operator" }')
        for seed in (1, 2, 3):
            rows = readings(seed, lambda cycle, x, time, room: 1.5 * (cycle % 3 == 0) + 1.2 * (room - 20), cycles=9).splitlines()
            named = [f"{rows[0]},operator"] + [f"{row},{'Anna Ben Carl'.split()[(int(row.split(',')[0]) - 1) % 3]}" for row in rows[1:]]
            v = self.trace("\n".join(named) + "\n", scenario)
            self.assertEqual({f["described_by"] for f in v["findings"]}, {"polynomial:room", "step:operator Carl"}, v["plain"])

    def test_two_stated_effects_that_hide_each_other(self):
        """Neither expansion nor warming alone says more than a shape; and expansion is a product of two conditions, which is
        no cause to give its name up."""
        for seed in (1, 2, 3):
            truth = lambda cycle, x, time, room: 6e-3 * x * (room - 20) + 5 * (1 - math.exp(-time / 15))
            v = self.trace(readings(seed, truth), AXIS + STATED)
            found = {f["name"]: f["quantities"][0] for f in v["findings"]}
            self.assertEqual(set(found), {"expansion", "warming"}, v["plain"])
            depends = {f["name"]: f["depends_on"] for f in v["findings"]}  # as the formulas say, though all vary with time
            self.assertEqual(depends, {"expansion": ["position", "room"], "warming": ["time"]})
            for name, size in (("expansion", 6), ("warming", 5)):
                self.assertLess(abs(found[name]["value"] - size), 3.5 * found[name]["u"])

    def test_a_hall_is_cooled_while_a_programme_recurs(self):
        """A wave in time is no function of the positions that come back, nor the other way round."""
        for seed, period in ((1, 7.3), (2, 31.0)):
            v = self.trace(readings(seed, lambda cycle, x, time, room: 1.5 * math.sin(2 * math.pi * time / period), cycles=6))
            self.assertEqual([f["described_by"] for f in v["findings"]], ["wave:time"], v["plain"])
            found, u, size, u_size = map(float, re.search(r"period (\S+) min, u = (\S+) min; amplitude (\S+) um, u = (\S+) um",
                                                          " ".join(v["findings"][0]["remarks"])).groups())
            self.assertLess(abs(found - period), 3.5 * u)
            self.assertLess(abs(size - 1.5), 3.5 * u_size)
            draw = random.Random(seed)
            errors = {x: draw.gauss(0, 1.5) for x in range(0, 501, 50)}
            v = self.trace(readings(seed, lambda cycle, x, time, room: errors[x], cycles=6))
            self.assertEqual([f["described_by"] for f in v["findings"]], ["table:position"], v["plain"])

    def test_a_drift_is_no_scatter_from_cycle_to_cycle(self):
        """It changes the readings within a cycle, too; scatter of the cycles does not."""
        for seed in (1, 5, 7, 9):
            for drift in (lambda time: 1.8 * (1 - math.exp(-time / 24)), lambda time: 0.022 * time):
                v = self.trace(readings(seed, lambda cycle, x, time, room: drift(time), cycles=6))
                self.assertEqual([f["depends_on"] for f in v["findings"]], [["time"]], v["plain"])
            draw = random.Random(seed)
            shift = [draw.choice((-1, 1)) * draw.uniform(0.5, 1) for _ in range(7)]
            v = self.trace(readings(seed, lambda cycle, x, time, room: shift[cycle], cycles=6))
            self.assertIn("scatter:cycle", v["findings"][0]["members"], v["plain"])

    def test_noise_that_resembles_what_was_before_is_said_first(self):
        for seed in (1, 2):
            draw, slow = random.Random(seed), [0.0]
            wander = lambda *at: slow.append(0.8 * slow[-1] + draw.gauss(0, 1)) or slow[-1]
            v = self.trace(readings(seed, wander, cycles=6, noise=0.1))
            self.assertEqual(v["findings"], [])
            self.assertRegex(v["plain"][0], r"resemble those before them \(correlation 0\.[468]\): something varies slowly")

    def test_one_rising_series_does_not_tell_the_order_from_the_position(self):
        rows = readings(1, lambda *at: 0, range(0, 501, 10), cycles=1).splitlines()
        upwards = "\n".join(rows[:52]) + "\n"
        both = "position never falls from one reading to the next; what depends on time cannot be distinguished from what depends on position"
        scenario = AXIS.replace('reversal = { estimated = true, value = "0 um" }', 'reversal = { value = "1.2 um" }')
        self.assertIn(both, self.trace(upwards, scenario)["statements"])
        self.assertNotIn(both, self.trace("\n".join(rows) + "\n")["statements"])

    def test_equal_steps_do_not_tell_waves_apart(self):
        """A wave of 10 mm, read every 13.7 mm, is one of 37 mm: 1/10 = 1/13.7 + 1/37."""
        wave = lambda cycle, x, time, room: 1.5 * math.sin(2 * math.pi * x / 10)
        v = self.trace(readings(1, wave, [round(13.7 * k, 1) for k in range(37)], cycles=4))
        remarks = " ".join(v["findings"][0]["remarks"])
        period, u = map(float, re.search(r"period (\S+) mm, u = (\S+) mm", remarks).groups())
        self.assertLess(abs(period - 1 / (1 / 10 - 1 / 13.7)), 3.5 * u)
        self.assertRegex(remarks, r"read in steps of 13\.7 mm, waves of period 21\.[78] mm and 10 mm look the same")

    def test_a_missing_target_leaves_equal_steps(self):
        """One target of 40 is missing, and the others are met within 0.2 mm: shorter waves cannot be told apart."""
        wave = lambda cycle, x, time, room: 1.5 * math.sin(2 * math.pi * x / 37)
        for seed in (1, 2):
            draw = random.Random(seed)
            places = [round(13.7 * k + draw.uniform(-0.2, 0.2), 1) for k in range(40) if k != 17]
            v = self.trace(readings(seed, wave, places, cycles=4))
            period, u = map(float, re.search(r"period (\S+) mm, u = (\S+) mm", " ".join(v["findings"][0]["remarks"])).groups())
            self.assertLess(abs(period - 37), 3.5 * u)

    def test_uneven_targets_show_short_waves(self):
        """Targets at (i - 1) p + r, r at random, as ISO 230-2 sets them: a screw of 10 mm shows where p is 13.7 mm."""
        wave = lambda cycle, x, time, room: 1.5 * math.sin(2 * math.pi * x / 10)
        for seed in (1, 2):
            draw = random.Random(seed)
            places = [round(13.7 * i + draw.uniform(0, 8), 1) for i in range(37)]
            v = self.trace(readings(seed, wave, places, cycles=4))
            self.assertEqual([f["described_by"] for f in v["findings"]], ["wave:position"], v["plain"])
            remarks = " ".join(v["findings"][0]["remarks"])
            period, u, size, u_size = map(float, re.search(r"period (\S+) mm, u = (\S+) mm; amplitude (\S+) um, u = (\S+) um$", remarks).groups())
            self.assertLess(abs(period - 10), 3.5 * u)
            self.assertLess(abs(size - 1.5), 3.5 * u_size)
        v = self.trace(readings(3, lambda *at: 0, places, cycles=4))
        self.assertEqual(v["findings"], [])

    def test_a_constant_of_a_formula_is_nothing_to_vary(self):
        """The temperature and a drift cannot be told apart here. T_ref is 20 degC by definition: another would not help."""
        scenario = (AXIS + STATED).replace("position * (room - T_ref)", "room - T_ref").replace("um/m/K", "um/K")
        scenario += '[stated_effects.creep]\nformula = "time"\nunit = "um/h"\n'
        scenario += '[stated_effects.bow]\nformula = "position^2"\nunit = "um/m^2"\n'
        v = self.trace(readings(7, lambda cycle, x, time, room: 0.5 * (room - 20)), scenario)
        classes = [f for f in v["findings"] if f["kind"] == "class"]
        self.assertEqual([f["members"] for f in classes], [["creep", "expansion"]], v["plain"])
        self.assertNotIn("T_ref", classes[0]["suggestion"])

    def test_a_declared_value_is_told_to_the_digits_known(self):
        """A lever of 300.49 mm, declared as 300 mm."""
        draw = random.Random(3)
        rows = ["day,load_N,torque_Nm"] + [f"{day},{f},{f * 0.30049 + draw.gauss(0, 2e-3):.5f}" for day in range(1, 7) for f in (10, 20, 50, 100)]
        (self.folder / "s.csv").write_text("\n".join(rows) + "\n")
        (self.folder / "s.toml").write_text("""schema = 1
[model]
name = "expression"
[model.indications]
torque = "L * load + zero"
[data]
file = "s.csv"
labels = { day = "day" }
conditions = { load = "load_N" }
units = { load_N = "N", torque_Nm = "N m" }
[indications.torque]
readings = "torque_Nm"
u = "2 N.mm"
[quantities]
L = { value = "300 mm", u = "0.02 mm" }
zero = { estimated = true, value = "0 N m" }
[trace]
blocks = "day"
""")
        run = gumshoe("trace", "s.toml", "--draws", "199", "--format", "json", "--force", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(json.loads(run.stdout)["plain"][0], r"a value that the scenario declares: L \(L 300\.4[789]\d* mm\)")


if __name__ == "__main__":
    unittest.main()
