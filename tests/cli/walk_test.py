"""From a machine's log to an answer with the commands of the README and no file edited by hand: an axis with a laser.

usage: walk_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import pathlib
import random
import tempfile
import unittest

from program import gumshoe


def bend(x):
    """um: a screw that bends and is too long"""
    return 4 * math.sin(x / 70) + 0.008 * x


class Axis(unittest.TestCase):
    """A German log in Latin-1: decimal commas, words, a clock; five runs up and down, noise of 0.3 um."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        chance, rows, second = random.Random(5), ["Nr;Lauf;Soll [mm];Richtung;Uhrzeit;Abweichung [µm];Temp [°C]"], 8 * 3600
        cls.readings = []
        for run in range(1, 6):
            for way in (1, -1):
                for x in [50 * i for i in range(11)][::way]:
                    d = bend(x) + 1.2 * way + chance.gauss(0, 0.3)
                    cls.readings.append((run, x, way, d))
                    row = f"{len(rows)};{run};{x:.1f};{'+' if way > 0 else '-'};{d:.2f};{20 + len(rows) / 1e3:.2f}".replace(".", ",").split(";")
                    row.insert(4, f"{second // 3600:02d}:{second % 3600 // 60:02d}:{second % 60:02d}")
                    rows.append(";".join(row))
                    second += 25
        (cls.folder / "messung.csv").write_text("\n".join(rows) + "\n", encoding="latin-1")

    def run_it(self, *words):
        run = gumshoe(*words, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def test_from_the_log_to_budget_verdict_and_table(self):
        self.run_it("new", "linear_axis", "--from", "messung.csv")
        self.run_it("check", "linear_axis.toml")
        # The budget: figures after ISO 230-2 against plain Python.
        figures = {o["measurand"]: o for o in json.loads(self.run_it("run", "linear_axis.toml", "--samples", "1e4", "--format", "json", "--out", "b.h5"))}
        means = {(x, w): [round(d, 2) for _, at, way, d in self.readings if (at, way) == (x, w)] for _, x, w, _ in self.readings}
        average = {k: sum(v) / len(v) for k, v in means.items()}
        self.assertAlmostEqual(figures["B"]["estimate"], max(abs(average[x, 1] - average[x, -1]) for x, _ in average),
                               delta=4 * figures["B"]["standard_uncertainty"] / math.sqrt(1e4))  # of the Monte Carlo mean
        self.assertGreater(figures["A"]["standard_uncertainty"], figures["B"]["standard_uncertainty"])
        # The verdict: at the noise in one loop, held out as well.
        rounds = json.loads(self.run_it("trace", "linear_axis.toml", "--loop", "5", "--format", "json", "--out", "t.h5"))["rounds"]
        self.assertGreater(rounds[0]["holdout_before"] * 1e6, 2)
        # 22 readings, predicted from a table of means of 4: three standard deviations of their root mean square.
        noise = 0.3 * math.sqrt(1 + 1 / 4) * (1 + 3 / math.sqrt(2 * 22))
        self.assertLess(rounds[-1]["holdout_after"] * 1e6, noise)
        self.assertFalse(rounds[-1]["added"])
        # The table, applied to the run that no fit has seen.
        out = self.run_it("compensate", "linear_axis.traced.toml", "--with", "gain", "--with", "offset")
        table = {(float(r["position_mm"]), int(r["direction"])): (float(r["error_um"]), float(r["u_um"]))
                 for r in csv.DictReader(line for line in io.StringIO(out) if not line.startswith("#"))}
        rest = [round(d, 2) - table[x, way][0] for run, x, way, d in self.readings if run == 5]
        # The trace also predicts by what the readings say of the reference, whose errors are none of the axis'.
        self.assertLess(math.sqrt(sum(r * r for r in rest) / len(rest)), noise)
        for (x, way), (e, u) in table.items():  # 22 entries
            self.assertAlmostEqual(e, bend(x) + 1.2 * way, delta=3.5 * u)

    def test_the_control_reads_it(self):
        self.run_it("new", "linear_axis", "--from", "messung.csv", "--out", "again.toml")
        self.run_it("trace", "again.toml", "--loop", "5", "--out", "again.h5")
        for form in ("linuxcnc-trim", "sinumerik-eec", "isg"):
            self.run_it("compensate", "again.traced.toml", "--format", form, "--out", f"table.{form}")
            self.assertGreater(len((self.folder / f"table.{form}").read_text().splitlines()), 10)


if __name__ == "__main__":
    unittest.main()
