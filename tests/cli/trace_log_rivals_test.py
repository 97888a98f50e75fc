"""Causes that the data cannot distinguish are named together in the sentence.

usage: trace_log_rivals_test.py path/to/gumshoe [unittest options]
"""
import random
import unittest

from traced_log import TracedLog


class Rivals(TracedLog):
    def test_labels_that_are_never_apart_are_named_together(self):
        """Bob always runs M2, whichever column stands first: 1 um (2 sigma) between them."""
        for seed, columns in ((1, "operator,machine"), (2, "machine,operator")):
            draw = random.Random(seed)
            lines = [f"day,{columns},err_um"]
            for i in range(96):
                second = i % 2
                of = {"operator": ("Ann", "Bob")[second], "machine": ("M1", "M2")[second]}
                lines.append(f"{i // 6 + 1},{','.join(of[c] for c in columns.split(','))},{second + draw.gauss(0, 0.5):.2f}")
            self.log(lines)
            said = self.verdict("log.toml")["plain"][0]
            first, other = ("operator Bob", "machine M2") if columns.startswith("op") else ("machine M2", "operator Bob")
            self.assertEqual(said, f"{first} or {other}, which are never apart in these data, differs from the others by a constant.")

    def test_a_label_that_is_seldom_apart_is_not_said_to_be_never(self):
        """On every fourth day Ann runs M2: its difference is told from hers."""
        draw = random.Random(3)
        lines = ["day,operator,machine,err_um"]
        for i in range(96):
            bob = i % 2
            machine = 1 if (i // 6) % 4 == 0 else bob
            lines.append(f"{i // 6 + 1},{('Ann', 'Bob')[bob]},{('M1', 'M2')[machine]},{machine + draw.gauss(0, 0.3):.2f}")
        self.log(lines)
        said = self.verdict("log.toml")["plain"][0]
        self.assertEqual(said, "machine M1 differs from the others by a constant.")

    def test_a_temperature_that_rises_with_time_is_named_with_it(self):
        """Correlation above 0.999: the sentence holds both, whichever is first."""
        draw = random.Random(4)
        lines = ["time (h),temp_degC,err_um"]
        for i in range(96):
            t = 20 + 0.05 * i + draw.gauss(0, 0.02)
            lines.append(f"{i},{t:.3f},{0.9 * (t - 20) + draw.gauss(0, 0.5):.2f}")
        self.log(lines)
        said = self.verdict("log.toml")["plain"][0]
        self.assertIn("these data cannot distinguish it from", said)
        for name in ("time", "temp_degc"):
            self.assertRegex(said, rf"\b{name}\b")


if __name__ == "__main__":
    unittest.main()
