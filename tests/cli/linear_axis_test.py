"""Figures of ISO 230-2 from readings of a linear axis, against a worked example and plain formulas; what the reference and
the effects add to a reading; and from a log to figures and a traced scenario.

usage: linear_axis_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import random
import re
import statistics
import unittest

import plain_axis
from program import ROOT, InFolder, gumshoe

UP = {0: [0.4, 0.9, 0.1, 0.6, 0.5], 250: [2.1, 2.9, 2.4, 2.0, 2.6], 500: [4.8, 5.6, 5.1, 5.3, 4.7]}
DOWN = {0: [-1.2, -0.7, -1.5, -1.0, -1.1], 250: [-0.3, 0.6, 0.1, -0.2, 0.3], 500: [3.9, 4.4, 4.1, 4.6, 4.0]}
# Worked by hand from the definitions, um. A divisor n in place of n - 1 gives R = 3.614534 and A = 7.378803; a reversal
# down minus up without its absolute value gives R = 1.469694.
WORKED = {"A": 7.517942, "A_up": 5.917942, "A_down": 6.466190, "R": 3.769694, "R_up": 1.469694, "R_down": 1.469694,
          "E": 6.2, "E_up": 4.6, "E_down": 5.3, "M": 4.95, "B": 2.3, "mean_reversal": 1.6}


def figures(up, down):
    """ISO 230-2:2014 from deviations by target, apart from the engine."""
    mean = [{p: statistics.fmean(x) for p, x in side.items()} for side in (up, down)]
    s = [{p: statistics.stdev(x) for p, x in side.items()} for side in (up, down)]
    width = lambda low, high: max(high) - min(low)
    sides = [[m.values() for m in mean[i:j]] for i, j in ((0, 2), (0, 1), (1, 2))]
    out = {name: width(*2 * [[m for side in some for m in side]]) for name, some in zip(("E", "E_up", "E_down"), sides)}
    for name, some in (("A", (0, 1)), ("A_up", (0,)), ("A_down", (1,))):
        out[name] = width([mean[i][p] - 2 * s[i][p] for i in some for p in up], [mean[i][p] + 2 * s[i][p] for i in some for p in up])
    jump = {p: mean[0][p] - mean[1][p] for p in up}
    out["R_up"], out["R_down"] = (4 * max(side.values()) for side in s)
    out["R"] = max(out["R_up"], out["R_down"], *(2 * s[0][p] + 2 * s[1][p] + abs(jump[p]) for p in up))
    out["B"], out["mean_reversal"] = max(map(abs, jump.values())), statistics.fmean(jump.values())
    both = [(mean[0][p] + mean[1][p]) / 2 for p in up]
    return out | {"M": max(both) - min(both)}


class LinearAxis(InFolder):
    def check(self, up, down, quantities="", evaluation="iso_230_2", conditions="", code=0):
        rows = [f"{run},{p},{sign},{dev}" for sign, side in ((1, up), (-1, down)) for p, xs in side.items() for run, dev in enumerate(xs)]
        (self.folder / "axis.csv").write_text("\n".join(["run,target_mm,direction,dev_um", *rows]) + "\n")
        (self.folder / "s.toml").write_text(f"""schema = 1
[model]
name = "linear_axis"
evaluation = "{evaluation}"
[data]
file = "axis.csv"
labels = {{ run = "run" }}
units = {{ target_mm = "mm", dev_um = "um" }}
conditions = {{ position = "target_mm", direction = "direction" }}
[conditions]
{conditions}
[indications.deviation]
readings = "dev_um"
[quantities]
offset = "0 um"
{quantities}
""")
        run = gumshoe("run", "s.toml", "--samples", "20000", "--format", "json", "--force", cwd=self.folder)
        self.assertEqual(run.returncode, code, run.stderr)
        return {r["measurand"]: r for r in json.loads(run.stdout)} if code == 0 else run.stderr

    def values(self, *args, **more):
        return {name: r["estimate"] for name, r in self.check(*args, **more).items()}

    def test_worked_example(self):
        found = self.values(UP, DOWN)
        self.assertEqual(list(found), ["A", "A_up", "A_down", "R", "R_up", "R_down", "E", "E_up", "E_down", "M", "B", "mean_reversal"])
        for name, value in WORKED.items():
            self.assertAlmostEqual(found[name], value, delta=6e-7, msg=name)
        for name, value in figures(UP, DOWN).items():
            self.assertAlmostEqual(found[name], value, delta=1e-12, msg=name)

    def test_laws_of_the_figures(self):
        draw = random.Random(230)
        for trial in range(6):
            targets = draw.sample(range(-400, 900), draw.randint(2, 7))
            runs, noise = draw.randint(2, 6), 10 ** draw.uniform(-2, 1)
            up, down = ({p: [draw.gauss(k + p / 100, noise) for _ in range(runs)] for p in targets} for k in (0, draw.uniform(-5, 5)))
            found = self.values(up, down)
            for name, value in figures(up, down).items():
                self.assertAlmostEqual(found[name], value, delta=1e-11, msg=name)
            self.assertGreaterEqual(found["A"], max(found["E"], found["A_up"], found["A_down"]))
            self.assertGreaterEqual(found["E"], found["M"] - 1e-12)
            self.assertGreaterEqual(found["R"], max(found["R_up"], found["R_down"], found["B"]))
            self.assertLessEqual(found["E"], found["M"] + found["B"] + 1e-12)
            higher = [{p: [x + 7 for x in xs] for p, xs in side.items()} for side in (up, down)]
            swapped = self.values(down, up)
            for name, value in self.values(*higher).items():
                self.assertAlmostEqual(value, found[name], delta=1e-11, msg=name)
            for name in ("A", "R", "E", "M", "B"):
                self.assertAlmostEqual(swapped[name], found[name], delta=1e-11, msg=name)
            self.assertAlmostEqual(swapped["mean_reversal"], -found["mean_reversal"], delta=1e-11)
            self.assertAlmostEqual(swapped["A_up"], found["A_down"], delta=1e-11)

    def test_positions_in_place_of_deviations(self):
        rows = [f"{run};{p};{'+-'[sign < 0]};{p + dev / 1000:.6f}" for sign, side in ((1, UP), (-1, DOWN)) for p, xs in side.items() for run, dev in enumerate(xs)]
        (self.folder / "log.csv").write_text("\n".join(["run;target_mm;dir;laser_mm", *rows]) + "\n")
        gumshoe("new", "linear_axis", "--from", "log.csv", cwd=self.folder)
        path = self.folder / "linear_axis.toml"
        self.assertIn("reads_position = 1", path.read_text())
        path.write_text(re.sub(r"(?m)^\w+ = \{ value.*\n", "", path.read_text()))  # no uncertainty, no reduction
        run = gumshoe("run", "linear_axis.toml", "--format", "json", "--samples", "1000", cwd=self.folder)
        found = {r["measurand"]: r["estimate"] for r in json.loads(run.stdout)}
        for name, value in WORKED.items():
            self.assertAlmostEqual(found[name], value, delta=6e-7, msg=name)

    def test_what_a_common_scale_error_makes_uncertain(self):
        # 2 um/m over 0.5 m: 1 um in E and M, whose ends are those of the travel; nothing in reversal and repeatability.
        found = self.check(UP, DOWN, 'reference_scale = { value = "0 um/m", u = "2 um/m", source = "assumed" }')
        for name in ("E", "M"):
            self.assertAlmostEqual(found[name]["standard_uncertainty"], 1.0, delta=0.03, msg=name)
        for name in ("B", "R", "R_up", "mean_reversal"):
            # What the rounding of the samples leaves is no uncertainty: a certificate once said 2.52 +- 1.3e-15 um.
            self.assertEqual(found[name]["standard_uncertainty"], 0, name)
            self.assertEqual(found[name]["certificate"], "", name)
            self.assertEqual(found[name]["symmetric"], [found[name]["estimate"]] * 2, name)

    def test_what_cancels_is_not_in_the_budget(self):
        # A difference quotient of roundings once gave a contribution of 0.0000000000047 nm.
        run = gumshoe("run", ROOT / "scenarios/linear_axis.toml", "--samples", "2000", "--format", "json", "--out", "x.h5", cwd=self.folder)
        budgets = {r["measurand"]: {b["quantity"]: b["contribution"] for b in r["budget"]} for r in json.loads(run.stdout)}
        for name in ("R", "B"):
            self.assertGreater(budgets[name].pop("reference_drift"), 0)
            self.assertEqual(set(budgets[name].values()), {0}, name)
        self.assertGreater(budgets["E"]["reference_scale"], 0.2)

    def test_one_run_gives_no_repeatability(self):
        up, down = ({p: xs[:1] for p, xs in side.items()} for side in (UP, DOWN))
        said = self.check(up, down, code=2)
        self.assertIn("the target at 0 mm has one run upwards, from which ISO 230-2 evaluates no accuracy A and no repeatability R", said)
        found = self.values(up, down, evaluation="iso_230_2_once")
        self.assertEqual(list(found), ["E", "E_up", "E_down", "M", "B", "mean_reversal"])
        self.assertAlmostEqual(found["E"], 4.8 + 1.2, delta=1e-9)
        self.assertAlmostEqual(found["B"], 2.1 + 0.3, delta=1e-9)

    def test_what_it_refuses(self):
        for up, down, said in ((UP, {0: DOWN[0], 250: DOWN[250]}, "the target at 500 mm was not reached downwards"),
                               (UP, {}, "the target at 0 mm was not reached downwards")):
            self.assertIn(said, self.check(up, down, code=2))
        text = (self.folder / "axis.csv").read_text().replace("500,1,", "500,0,")
        (self.folder / "axis.csv").write_text(text)
        run = gumshoe("run", "s.toml", "--force", cwd=self.folder)
        self.assertIn("compares targets reached from both sides, but a direction is 0", run.stderr)
        (self.folder / "axis.csv").write_text(text.replace("500,0,", "500,2,"))
        self.assertIn("direction must be 1, -1 or 0", gumshoe("run", "s.toml", "--force", cwd=self.folder).stderr)
        for line, said in (('pitch = "-5 mm"', "pitch is negative"), ("reads_position = 2", "reads_position must be 0 or 1"), ('temperature = "-5 K"', "temperature is below absolute zero"),
                           ('temperature = "-300 degC"', "-300 degC is below absolute zero (-273.15 degC)")):
            self.assertIn(said, self.check(UP, DOWN, conditions=line, code=2))

    # one reading

    def corrected(self, **values):
        """Corrected deviation, um; `__` in a name is a dot."""
        units = {"position": "mm", "datum": "mm", "pitch": "mm", "time": "min", "temperature": "degC", "pitch_angle": "urad",
                 "compensated": "um/m", "deviation": "um", "reference_scale": "um/m", "reference_drift": "um/h",
                 "misalignment": "mrad", "dead_path": "mm", "wavelength_change": "um/m", "expansion": "um/m/K",
                 "temperature_difference": "K", "backlash": "um", "slope": "um/m", "cosine": "um", "sine": "um",
                 "rate": "um/h", "amplitude": "um", "time_constant": "min", "coefficient": "um/m/K", "offset": "mm"}
        names = [k.replace("__", ".") for k in values]
        header = [n if n == "direction" else f"{n} ({units[n.split('.')[-1]] if n != 'axis_scale_drift.rate' else 'um/m/h'})" for n in names]
        (self.folder / "t.csv").write_text(",".join(header) + "\n" + ",".join(map(str, values.values())) + "\n")
        run = gumshoe("evaluate", "linear_axis", "--table", "t.csv", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return float(next(csv.DictReader(io.StringIO(run.stdout)))["corrected_deviation (um)"])

    def test_what_a_reading_contains(self):
        # Travel 0.4 m from the datum, 90 min; by hand, and with the sign by which each is subtracted.
        at = {"position": 500, "datum": 100, "direction": -1, "time": 90, "deviation": 10}
        for more, error in (({"reference_scale": 3}, 1.2), ({"reference_drift": 2}, 3), ({"dead_path": 300, "wavelength_change": 0.5}, -0.15),
                            ({"misalignment": 2}, 400e3 * (math.cos(2e-3) - 1)), ({"expansion": 10, "temperature_difference": 2}, 8),
                            ({"expansion": 10, "temperature_difference": 2, "compensated": 20}, 0),
                            ({"axis_reversal__backlash": 5}, 2.5), ({"axis_reversal_slope__slope": 5}, 1),
                            ({"pitch": 16, "axis_periodic_error__sine": 2, "axis_periodic_error__cosine": 3}, 2),
                            ({"axis_periodic_error__sine": 2, "axis_periodic_error__cosine": 3}, 0),
                            ({"axis_drift__rate": 4}, 6), ({"axis_drift__amplitude": 4, "axis_drift__time_constant": 45}, 4 * (1 - math.exp(-2))),
                            ({"axis_scale_drift__rate": 5}, 3), ({"temperature": 23, "axis_expansion__coefficient": 5}, 6),
                            ({"pitch_angle": 20, "axis_abbe_error__offset": 100}, 2)):
            self.assertAlmostEqual(self.corrected(**at, **more), 10 - error, delta=1e-9, msg=more)

    def test_a_longer_wave_on_the_dead_path_counts_fewer_fringes(self):
        """Counted: half waves between the zero at the datum and the target, of a HeNe laser whose wave in air grows
        meanwhile. An axis without error is indicated short by the dead path times the growth, and is corrected to zero."""
        at_zero, dead, travel, growth = 632.8e-9, 0.3, 0.4, 2e-6
        now = at_zero * (1 + growth)
        fringes = 2 * (dead + travel) / now - 2 * dead / at_zero
        deviation = (fringes * now / 2 - travel) * 1e6  # the control knows the wave in air, um
        self.assertAlmostEqual(deviation, -0.6, delta=1e-6)
        at = {"position": 500, "datum": 100, "direction": 1, "dead_path": dead * 1e3, "wavelength_change": growth * 1e6}
        self.assertAlmostEqual(self.corrected(deviation=deviation, **at), 0, delta=1e-6)
        uncompensated = (fringes * at_zero / 2 - travel) * 1e6
        self.assertAlmostEqual(self.corrected(deviation=uncompensated, reference_scale=-growth * 1e6, **at), 0,
                               delta=2 * growth * growth * (dead + travel) * 1e6 + 1e-6)  # the second order
        (self.folder / "v.toml").write_text('schema = 1\n[model]\nname = "linear_axis"\nmethod = "virtual_experiment"\n[conditions]\n'
                                            'position = "500 mm"\ndatum = "100 mm"\n[quantities]\ndead_path = "300 mm"\nwavelength_change = "2 um/m"\n')
        (self.folder / "v.csv").write_text("position (mm)\n500\n")
        run = gumshoe("evaluate", "v.toml", "--table", "v.csv", cwd=self.folder)
        simulated = float(next(csv.DictReader(io.StringIO(run.stdout)))["deviation (um)"])
        self.assertAlmostEqual(simulated, deviation, delta=1e-6)

    # from a log

    def test_a_log_becomes_figures_and_a_traced_scenario(self):
        header = "Cycle;Target [mm];Dir;Deviation [µm];Time (min);Temp (°C)"
        rows = [f"{c};{x};{'+' if s > 0 else '-'};{d:.2f};{t};20.5".replace(".", ",") for c, x, s, t, d in plain_axis.readings(seed=4)]
        (self.folder / "log.csv").write_text("\n".join([header, *rows]) + "\n")
        run = gumshoe("new", "linear_axis", "--from", "log.csv", cwd=self.folder)
        self.assertIn("linear_axis.toml: ready. Next: gumshoe run linear_axis.toml", run.stdout, run.stderr)
        text = (self.folder / "linear_axis.toml").read_text()
        for part in ('position = "Target [mm]"', 'direction = { column = "Dir", map = { "+" = 1, "-" = -1 } }', 'time = "Time (min)"',
                     'temperature = "Temp (°C)"', 'labels = { cycle = "Cycle" }', 'blocks = "cycle"', 'order = "time"'):
            self.assertIn(part, text)
        run = gumshoe("run", "linear_axis.toml", "--format", "json", "--samples", "2000", cwd=self.folder)
        found = {r["measurand"]: r["estimate"] for r in json.loads(run.stdout)}
        up, down = {}, {}
        for c, x, s, t, d in plain_axis.readings(seed=4):
            (up if s > 0 else down).setdefault(x, []).append(round(d, 2))
        # The beam's misalignment, up to 1 mrad, makes a little of A and E; repeatability and reversal are as computed.
        plain = figures(up, down)
        self.assertAlmostEqual(found["B"], plain["B"], delta=0.02)
        self.assertAlmostEqual(found["A"], plain["A"], delta=0.5)
        trace = gumshoe("trace", "linear_axis.toml", "--draws", "99", "--format", "json", cwd=self.folder)
        self.assertEqual(trace.returncode, 0, trace.stderr)
        rms = json.loads(trace.stdout)["rms"]
        self.assertLess(rms["after"] * 5, rms["before"])


if __name__ == "__main__":
    unittest.main()
