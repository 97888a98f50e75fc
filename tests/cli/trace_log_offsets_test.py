"""What `gumshoe new` fits for each day, operator or tool by itself, and what both programs say of it.

usage: trace_log_offsets_test.py path/to/gumshoe [unittest options]
"""
import itertools
import math
import random
import re
import unittest

from traced_log import TracedLog

DAYS, NOISE = 12, 0.4


def rows(seed, words, of, temperature=lambda day: 20.0):
    """Two readings a day of each word of a column; `of(day, word)` is added to the noise; um."""
    draw = random.Random(seed)
    label, names = words
    yield f"day,{label},temp_degC,dev_um"
    for day, word, _ in itertools.product(range(1, DAYS + 1), names, range(2)):
        yield f"{day},{word},{temperature(day):.2f},{of(day, word) + draw.gauss(0, NOISE):.2f}"


OPERATORS, TOOLS = ("operator", "AB"), ("tool", ("T1", "T2", "T3"))


class Offsets(TracedLog):
    def size(self, remark, log):
        """Size and u of the only finding, by the remark that states them. Nothing is fitted by label."""
        text = self.log(log)
        self.assertNotRegex(text, r"by\.")
        verdict = self.verdict("log.toml")
        self.assertNotIn("agree with the model", " ".join(verdict["plain"]))
        remarks = " ".join(r for f in verdict["findings"] for r in f["remarks"])
        return map(float, re.search(remark + r":? (\S+) \S+, u = (\S+) ", remarks).groups())

    def test_what_changes_from_day_to_day_is_found_be_it_ever_so_large(self):
        """30 and 150 times the noise: days differ by far more than readings of one day do."""
        for times in (30, 150):
            big = times * NOISE
            for name, remark, of, true in (
                    ("drift", "a straight line against day_number", lambda d, _: big * d, big),
                    ("step", "it differs by", lambda d, _: big * (d > 5), big),
                    ("day", "it differs by", lambda d, _: big * (d == 5), big)):
                with self.subTest(name, times=times):
                    value, u = self.size(remark, rows(times, OPERATORS, of))
                    self.assertAlmostEqual(value, true, delta=4 * u)
                    # The least that two means of 4 readings leave, and the most that one of 4 and many do.
                    self.assertLess(u, 2 * NOISE / math.sqrt(4))

    def test_a_temperature_that_differs_by_day_is_found(self):
        draw = random.Random(3)
        air = [20 + draw.uniform(-4, 4) for _ in range(DAYS + 1)]
        value, u = self.size("a straight line against temp_degc",
                             rows(4, OPERATORS, lambda d, _: 8 * (air[d] - 20), lambda d: air[d]))
        # The temperature is written to 0.01 K: 0.003 K * 8 um/K is no part of the noise.
        self.assertAlmostEqual(value, 8, delta=4 * u)

    def test_an_operator_who_differs_is_found(self):
        value, u = self.size("it differs by", rows(5, OPERATORS, lambda _, who: 40 * (who == "B")))
        self.assertAlmostEqual(abs(value), 40, delta=4 * u)

    def test_tools_have_their_lengths_and_both_programs_say_so(self):
        length = {"T1": 0, "T2": 55, "T3": -20}
        (self.folder / "log.csv").write_text("\n".join(rows(6, TOOLS, lambda _, tool: length[tool])) + "\n")
        told = self.new("--from", "log.csv")
        text = (self.folder / "log.toml").read_text()
        line, = (n for n, one in enumerate(text.splitlines(), 1) if "by.tool" in one)
        self.assertIn("what differs from one tool to the next is not judged", text.splitlines()[line - 1])
        self.assertIn(f"dev_um_offset: fitted for each tool by itself: what differs from one tool to the next is not judged "
                      f"(line {line}; for one that all share: value = ... in place of by.tool)", told)
        verdict = self.verdict("log.toml")
        self.assertEqual(verdict["findings"], [])
        # Means of 18 training readings each: the difference of two has u = 0.4 um * sqrt(2 / 18).
        said, = (re.search(r"dev_um_offset is fitted for each tool by itself, and its values differ by up to (\S+) um: what differs so "
                           r"from one tool to the next is not judged", p) for p in verdict["plain"] if "fitted for each" in p)
        self.assertAlmostEqual(float(said[1]), 75, delta=0.5 + 4 * NOISE * math.sqrt(2 / 18))
        self.assertTrue(any("fitted for each tool by itself" in s for s in verdict["statements"]))

    def test_without_effects_of_a_catalogue_there_are_no_detection_limits(self):
        self.log(rows(7, OPERATORS, lambda *_: 0))
        verdict = self.verdict("log.toml")
        self.assertEqual((verdict["findings"], verdict["detection_limits"]), ([], []))
        self.assertNotIn("detection limits", " ".join(verdict["plain"]))
        self.assertRegex(verdict["plain"][-1], r"small compared with the noise \(0\.[34]\d* um\) may still be present")


if __name__ == "__main__":
    unittest.main()
