"""Logs of passes that were aligned or centred anew: what belongs to the alignment is told, and then fitted.

usage: trace_log_alignment_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import random
import unittest

from traced_log import TracedLog


class Alignment(TracedLog):
    def test_passes_that_were_aligned_anew(self):
        """Straightness in eight passes, each with an offset and a slope of its own: it is told, and then fitted."""
        draw, rows = random.Random(12), ["Lauf,X_mm,dY_um"]
        for run in range(1, 9):
            offset, slope = draw.gauss(0, 6), draw.gauss(0, 0.012)
            rows += [f"{run},{x},{offset + slope * x + 2.5 * math.sin(2 * math.pi * x / 500) + draw.gauss(0, 0.4):.2f}" for x in range(0, 501, 25)]
        for words, told in (((), True), (("--role", "Lauf=alignment"), False)):
            self.log(rows, *words)
            v = self.verdict("log.toml")
            self.assertEqual(any("each lauf has a slope of its own against position" in s for s in v["statements"]), told)
        self.assertEqual([f["depends_on"] for f in v["findings"]], [["position"]])
        self.assertLess(v["rms"]["holdout_after"], v["rms"]["holdout_noise_interval95"][1])

    def test_a_ball_bar_that_was_centred_anew(self):
        """Four circles, each with an eccentricity of its own, that drifts and steps in order must not hide."""
        draw, rows = random.Random(77), ["run;dir;angle_deg;dr_um"]
        for run in range(1, 5):
            x, y = draw.gauss(0, 3), draw.gauss(0, 3)
            for a in (range(0, 360, 5) if run % 2 else range(355, -1, -5)):
                t = math.radians(a)
                rows.append(f"{run};{'CCW' if run % 2 else 'CW'};{a};{x * math.cos(t) + y * math.sin(t) + 2.5 * math.sin(2 * t) + draw.gauss(0, 0.3):.2f}")
        for words, told in (((), True), (("--role", "run=alignment"), False)):
            self.log(rows, *words)
            first = self.verdict("log.toml", "--loop", "3")["rounds"][0]
            said = json.dumps(self.verdict("log.toml"))
            self.assertEqual("each run has a first wave of its own against position" in said, told)
            if not told:
                self.assertLess(first["after"], 1.2 * 0.3e-6)


if __name__ == "__main__":
    unittest.main()
