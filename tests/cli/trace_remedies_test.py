"""gumshoe trace on logs as laboratories take them: what is told, and that the traced scenario expects later readings.

usage: trace_remedies_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import random
import re
import unittest

import h5py

from program import InFolder, gumshoe

CELL = """schema = 1
[model]
name = "expression"
[model.indications]
U = "b0 + b1 * load"
[data]
file = "{file}"
labels = {{ run = "run" }}
[data.units]
load_kN = "kN"
U_mV = "mV"
t_min = "min"
[data.conditions]
load = "load_kN"
time = "t_min"
{way}[quantities]
b0 = {{ estimated = true, value = "0 mV" }}
b1 = {{ estimated = true, value = "0.2 mV/kN" }}
[indications.U]
readings = "U_mV"
[trace]
blocks = "run"
order = "time"
draws = 199
"""
AXIS = """schema = 1
[model]
name = "linear_axis"
[data]
file = "{file}"
labels = {{ cycle = "cycle" }}
[data.units]
x_mm = "mm"
t_s = "s"
d_um = "um"
[data.conditions]
position = "x_mm"
direction = "way"
time = "t_s"
[quantities]
offset = {{ estimated = true, value = "0 um" }}
gain = {gain}
[indications.deviation]
readings = "d_um"
{noise}
[trace]
blocks = "cycle"
order = "time"
draws = 199
"""
FREE = '{ estimated = true, value = "0 um/m" }'
NOISE = 'components = [ { distribution = "normal", u = "0.2 um", per = "reading" } ]'


def axis(seed, cycles, of, noise=0.2, step=0.001):
    """@param of  error in um of (reading, cycle, x in mm, way), readings counted from 1"""
    chance, n = random.Random(seed), 0
    targets = [chance.uniform(-4, 4) + 100 * i for i in range(10)]
    yield "cycle,x_mm,way,t_s,d_um"
    for cycle in cycles:
        n = 20 * (cycle - 1)
        for way in (1, -1):
            for x in targets[::way]:
                n += 1
                d = of(n, cycle, x, way) + chance.gauss(0, noise)
                yield f"{cycle},{x:.1f},{way},{30 * n},{round(d / step) * step:.3f}"


class Logs(InFolder):
    def trace(self, name, *words):
        run = gumshoe("trace", name, "--force", "--out", "o.h5", "--json", "v.json", *words, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout, json.loads((self.folder / "v.json").read_text())

    def write(self, name, rows):
        (self.folder / name).write_text("\n".join(rows) + "\n")

    def expected(self, file, new):
        """(inside, all) of the readings in `new`."""
        text = (self.folder / "s.traced.toml").read_text().replace(f'"{file}"', f'"{new}"')
        (self.folder / "p.toml").write_text(text)
        run = gumshoe("run", "p.toml", "--predict", "--samples", "20000", "--force", "--out", "p.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return tuple(map(int, re.search(r"(\d+) of (\d+) readings lie", run.stdout).groups()))


class Remedies(Logs):
    def load_cell(self, runs, seed):
        chance, t = random.Random(seed), 24 * (runs[0] - 1)
        yield "run,load_kN,t_min,U_mV"
        for run in runs:
            for i in [*range(11), *range(9, -1, -1)]:
                back = t % 24 > 10
                U = 0.003 + 0.2 * i + (0.0012 * 4 * i * (10 - i) / 100 if back else 0) + chance.gauss(0, 0.0002)
                yield f"{run},{i},{t},{U:.5f}"
                t += 1
            t += 3

    def test_a_hysteresis_without_a_direction_names_the_remedy(self):
        self.write("a.csv", self.load_cell(range(1, 7), 1))
        self.write("b.csv", self.load_cell(range(7, 9), 2))
        (self.folder / "s.toml").write_text(CELL.format(file="a.csv", way=""))
        text, _ = self.trace("s.toml")
        self.assertIn("The readings differ between rising and falling load", text)
        self.assertIn('is known by time alone; state the direction as a condition, { column = "...", sense = true } with the column of '
                      "load", text)
        # The table goes by load and by its sense: the two ways differ by 1.2 uV * 4 F (10 - F) / 100, and would cancel.
        with h5py.File(self.folder / "o.h5") as file:
            table = file["trace/findings/000/tables/000"]
            load, sense = (table[f"keys/{key}"][:] * scale for key, scale in (("load", 1e-3), ("sense of load", 1)))
            y = {(round(F), round(s)): e for F, s, e in zip(load, sense, table["y"][:])}
            u = dict(zip(y, table["u"][:]))
        for F in range(1, 10):
            self.assertAlmostEqual(y[F, -1] - y[F, 1], 1.2e-6 * 4 * F * (10 - F) / 100, delta=8 * u[F, 1])
        (self.folder / "s.toml").write_text(CELL.format(file="a.csv", way='way = { column = "load_kN", sense = true }\n'))
        text, _ = self.trace("s.toml")
        self.assertNotIn("is known by time alone", text)
        inside, all_ = self.expected("a.csv", "b.csv")
        self.assertGreaterEqual(inside, 0.85 * all_)  # of 42, 36 or fewer have a chance of 1 in 60

    def test_a_bad_reading_is_told_beside_a_finding(self):
        def of(n, cycle, x, way):
            return -0.5 * way + (9 if n == 32 else 0)
        self.write("a.csv", axis(3, range(1, 7), of))
        (self.folder / "s.toml").write_text(AXIS.format(file="a.csv", gain=FREE, noise=NOISE))
        text, verdict = self.trace("s.toml")
        self.assertEqual([f["name"] for f in verdict["findings"]], ["axis_reversal"])
        self.assertRegex(text, r"One reading is outlying: reading 32 \(.*\), by [89]\.\d+ um\. Check it\.")

    def test_what_came_and_went_is_over(self):
        """A bell about reading 57; later readings are expected without it."""
        def of(n, cycle, x, way):
            return 2 * math.exp(-0.5 * ((n - 57) / 3) ** 2)
        self.write("a.csv", axis(4, range(1, 7), of))
        self.write("b.csv", axis(4, range(7, 10), of))
        (self.folder / "s.toml").write_text(AXIS.format(file="a.csv", gain=FREE, noise=NOISE))
        text, _ = self.trace("s.toml")
        self.assertIn("Something came and went about reading", text)
        inside, all_ = self.expected("a.csv", "b.csv")
        self.assertGreaterEqual(inside, 0.87 * all_)  # of 60, 51 or fewer have a chance of 1 in 300

    def test_a_value_of_the_model_is_not_said_to_be_declared(self):
        """A scale of 20 um/m where the scenario holds the gain at 0 and says nothing of the reference."""
        self.write("a.csv", axis(5, range(1, 7), lambda n, cycle, x, way: 0.02 * x))
        (self.folder / "s.toml").write_text(AXIS.format(file="a.csv", gain='{ value = "0 um/m" }', noise=NOISE))
        text, verdict = self.trace("s.toml")
        found = verdict["findings"][0]
        self.assertIn("declared:reference_scale", found["members"])
        self.assertIn("the declared value of reference_scale" if len(found["members"]) > 1 else
                      "The readings contradict a value that the model takes where the scenario states none: reference_scale", text)


class CoarseDisplay(Logs):
    """A display of 1 um, readings that repeat to 0.2 um, and only the display declared."""

    def test_later_readings_lie_in_their_intervals(self):
        """Of 95 %; neighbours round alike, so that fewer than the binomial are independent. The errors lie anywhere between
        two steps: at one place of all, rounding is the same for all. The name stands, and a second round finds nothing."""
        named, inside, all_ = 0, 0, 0
        for seed in range(21, 27):
            def of(n, cycle, x, way):
                return -0.75 * way + 0.0061 * x + 0.13 * (10 + seed)
            self.write("a.csv", axis(10 + seed, range(1, 7), of, step=1))
            self.write("b.csv", axis(10 + seed, range(7, 11), of, step=1))
            (self.folder / "s.toml").write_text(AXIS.format(file="a.csv", gain=FREE, noise='resolution = "1 um"'))
            _, first = self.trace("s.toml")
            named += "axis_reversal" in [f["name"] for f in first["findings"]]
            counted = self.expected("a.csv", "b.csv")
            inside, all_ = inside + counted[0], all_ + counted[1]
            _, second = self.trace("s.traced.toml")
            self.assertEqual(second["findings"], [], seed)
            self.assertAlmostEqual(second["rms"]["before"] / first["rms"]["after"], 1, delta=0.02)
        self.assertGreaterEqual(named, 5)
        self.assertGreaterEqual(inside, 0.9 * all_)


if __name__ == "__main__":
    unittest.main()
