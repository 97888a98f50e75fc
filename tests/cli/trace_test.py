"""gumshoe trace from outside: files, verdict on stdout, exit codes.

usage: trace_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import random
import unittest

import h5py

from program import InFolder, complaint, gumshoe

# A rod gauged at four feeds in eight set-ups, each with its own height of the beam. A latency shifts by feed times delay.
SCENARIO = """schema = 1
title = "made-up rod"
[model]
name = "rod_gauging"
[quantities.laser_z]
estimated = true
[quantities.laser_z.by.setup]
SETUPS
[quantities.rod_length]
value = "150 mm"
u = "1 um"
[indications.spindle_z]
readings = { file = "r.csv", column = "spindle_z", unit = "mm", labels = { setup = "setup", round = "round" }, conditions = { feed = { column = "feed", unit = "mm/min" } } }
components = [ { distribution = "normal", u = "0.5 um", per = "reading" } ]
[trace]
blocks = "setup"
draws = 99
"""
SETUPS = 8


def readings(delay, seed=1):
    """Delay in ms; feed in mm/min; noise of 0.5 um."""
    chance = random.Random(seed)
    lines = ["setup,round,feed,spindle_z"]
    for setup in range(1, SETUPS + 1):
        constant = -360 + chance.gauss(0, 0.01)
        for k, feed in enumerate((20, 200, 500, 1000) * 3):
            lines.append(f"{setup},{k // 4},{feed},{constant - feed / 60 * delay * 1e-3 + chance.gauss(0, 5e-4):.7f}")
    return "\n".join(lines) + "\n"


class Trace(InFolder):
    def setUp(self):
        super().setUp()
        self.scenario = self.folder / "s.toml"
        self.scenario.write_text(SCENARIO.replace("SETUPS", "\n".join(
            f'"{k}" = {{ value = "-510 mm" }}' for k in range(1, SETUPS + 1))))
        (self.folder / "r.csv").write_text(readings(0.5))

    def trace(self, *words, code=0):
        run = gumshoe("trace", *words, cwd=self.folder)
        self.assertEqual(run.returncode, code, run.stderr)
        return run

    def test_every_output_says_the_same(self):
        said = self.trace(self.scenario, "--format", "json", "--json", "v.json", "--report", "p.html").stdout
        verdict = json.loads(said)
        self.assertEqual((self.folder / "v.json").read_text(), said)
        self.assertEqual(verdict["verdict"], "named")
        found = verdict["findings"][0]
        self.assertEqual(found["name"], "trigger_latency")
        size = found["quantities"][0]
        self.assertEqual(size["unit"], "ms")
        self.assertAlmostEqual(size["value"], 0.5, delta=5 * size["u"])
        # 72 readings for the fit, u = 0.5 um / sqrt(sum (f - mean f)^2); feeds have a standard deviation of 370 mm/min.
        feeds = [f / 60 * 1e-3 for f in (20, 200, 500, 1000)]
        spread = math.sqrt(sum((f - sum(feeds) / 4) ** 2 for f in feeds) / 4)
        self.assertAlmostEqual(size["u"] / (0.5e-6 / spread / math.sqrt(72) * 1e3), 1, delta=0.3)
        out = self.folder / "results/s.traced.h5"
        with h5py.File(out) as file:
            self.assertEqual(file["trace"].attrs["verdict"], "named")
            self.assertEqual(file["trace/rms"].attrs["before"], verdict["rms"]["before"])
            self.assertEqual(len(file["residuals/before"]), 96)
        self.assertIn("Found: trigger latency", (self.folder / "p.html").read_text())
        self.assertFalse(list(self.folder.glob("*.csv"))[1:])  # --report writes the page and nothing else
        text = self.trace(self.scenario, "--out", "o.h5").stdout
        self.assertIn("found: trigger_latency", text)
        self.assertTrue(text.endswith("written: o.h5\n"))

    def test_other_data_other_verdict(self):
        (self.folder / "other.csv").write_text(readings(0))
        said = self.trace(self.scenario, "--data", "other.csv", "--format", "json").stdout
        self.assertEqual(json.loads(said)["verdict"], "nothing_found")  # and that is an answer: exit code 0
        self.assertIsNone(complaint(self.trace(self.scenario, "--data", "none.csv", code=2)))

    def test_too_few_data_are_an_answer_too(self):
        (self.folder / "r.csv").write_text("\n".join(readings(0.5).splitlines()[:4]) + "\n")
        self.scenario.write_text("\n".join(
            line for line in self.scenario.read_text().splitlines() if not line.startswith(tuple(f'"{k}"' for k in range(2, 9)))))
        verdict = json.loads(self.trace(self.scenario, "--format", "json").stdout)
        self.assertEqual(verdict["verdict"], "insufficient_data")
        self.assertIsNone(verdict["rms"]["before"])
        self.assertTrue(verdict["statements"])

    def test_refusals(self):
        for words in (("none.toml",), (self.scenario, "--out", self.scenario), (self.scenario, "--json", self.scenario),
                      (self.scenario, "--out", "no/folder.h5"), (self.scenario, "--json", "no/folder.json"),
                      (self.scenario, "--report", "no/folder.html"), (self.scenario, "--draws", "5"),
                      (self.scenario, "--draws", "many"), (self.scenario, "--format", "csv"),
                      (self.scenario, "--data", "r.csv", "--out", "r.csv")):
            run = gumshoe("trace", *words, cwd=self.folder)
            self.assertIsNone(complaint(run), f"{words}: {run.stderr}")
        self.assertFalse((self.folder / "results/s.traced.h5").exists())


if __name__ == "__main__":
    unittest.main()
