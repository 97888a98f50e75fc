"""Logs traced in rounds: what is found holds in the next round, and the rounds come to an end.

usage: trace_log_rounds_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import random
import re
import unittest

from traced_log import TracedLog


class Rounds(TracedLog):
    def test_a_curve_that_goes_astray_beyond_its_end_is_rejected(self):
        """Creep of a load cell: 20 s apart, loaded from 200 s to 1000 s."""
        draw, rows = random.Random(5), ["t_s,Kraft_kN,S_mVV"]
        for t in range(0, 1800, 20):
            load = 0 if t < 200 or t > 1000 else 50
            creep = 0 if t < 200 else 1 - math.exp(-(t - 200) / 150) if t <= 1000 else math.exp(-(t - 1000) / 150)
            rows.append(f"{t},{load},{0.04 * load + 6e-4 * creep + draw.gauss(0, 2e-5):.6f}")
        self.log(rows)
        for round in self.verdict("log.toml", "--loop", "5")["rounds"]:
            self.assertLess(round["holdout_after"], 4.01 * round["holdout_before"])

    def test_a_drift_without_times_or_by_a_temperature(self):
        """An axis that grows while its temperature rises, and no time: what is found holds in the second round."""
        draw, rows = random.Random(11), ["run,dir,target_mm,measured_mm,temp"]
        for run in range(1, 4):
            for way in (1, -1):
                for i, p in enumerate(range(0, 1001, 50)[::way]):
                    t = 20 + 0.6 * (run - 1) + 0.3 * (way < 0) + 0.015 * i
                    y = p + 11e-6 * p * (t - 20) - 0.004 * (way < 0) + 0.003 * math.sin(p / 130) + draw.gauss(0, 0.0006)
                    rows.append(f"{run},{'+' if way > 0 else '-'},{p},{y:.4f},{t:.2f}")
        self.log(rows)
        v = self.verdict("log.toml", "--loop", "4")
        first, second = v["rounds"][:2]
        self.assertEqual(second["added"], [])
        self.assertAlmostEqual(second["before"], first["after"], delta=0.02 * first["after"])
        traced = next(self.folder.glob("**/*.traced.toml")).read_text()
        if "order" in traced:
            self.assertIn('order = { counts = "readings" }', traced)
            self.assertIn("these data cannot distinguish it from product:position*temp", json.dumps(v))

    def test_what_only_the_order_of_rows_tells_is_not_found_for_ever(self):
        """A load cell that bends and lags on the way down, in a scenario that does not say which way it was."""
        draw, rows = random.Random(31), ["Reihe;Lage;Stufe;Last kN;Anzeige mV/V"]
        for k, place in enumerate(("0 Grad", "0 Grad", "120 Grad", "240 Grad")):
            for level, word in [(s, "auf") for s in range(11)] + [(s, "ab") for s in range(9, -1, -1)]:
                load = 5 * level
                lag = 1.5e-4 * math.sin(math.pi * load / 50) if word == "ab" else 0
                d = 0.04 * load + 2.2e-6 * load**2 + lag + (0, 0, 3e-4, -2e-4)[k] * load / 50 + draw.gauss(0, 2e-5)
                rows.append(f"{k + 1};{place};{word}{level};{load:.1f};{d:.5f}".replace(".", ","))
        text = re.sub(r"\n(direction|reversal) = [^\n]*", "", self.log(rows)).replace(" + reversal * direction", "")
        (self.folder / "log.toml").write_text(text)
        v = self.verdict("log.toml", "--loop", "5")
        self.assertIn("hysteresis:position", [f["described_by"] for f in v["findings"]])
        self.assertEqual(v["rounds"][-1]["added"], [])
        self.assertLess(len(v["rounds"]), 5)
        self.assertIn("follows the order of the rows", " ".join(v["statements"]))


if __name__ == "__main__":
    unittest.main()
