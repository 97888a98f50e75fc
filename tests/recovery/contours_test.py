"""Contours with one effect that the scenario does not declare, made by tests/cli/plain_contour.py apart from the engine: does
`gumshoe trace` find it, and nothing where there is none?

usage: contours_test.py path/to/gumshoe [unittest options]
       contours_test.py path/to/gumshoe --score N      # N sets of each kind: a table of what was found
"""
import math
import pathlib
import random
import sys
import unittest

import kinds

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))
import plain_contour as plain  # noqa: E402

GUMSHOE = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else ""
PASSES, READINGS = 4, 15
plain.STEP = 4e-3  # exact to 1e-6 mm once the slides move

# name: what may be said of it
KINDS = {
    "nothing": set(),
    "unequal gains": {"servo_gain_mismatch"},
    "Y leans": {"squareness"},
    "Y has play": {"y_reversal"},
    "Y sticks at reversal": {"reversal_spike"},
    "bar 3 is read late": {"declared:skew_3"},
}


def directions(kind, angle, feed, times):
    """Direction of Y and the time since it turned round, of slides that lag their command by 1/30 s."""
    dt, sign, since, t, out = 1e-3, 1.0, math.inf, 0.0, []
    for end in times:
        while t < end:
            lagged = t - 1 / 30
            v = plain.command(kind, angle, feed, lagged + dt)[1] - plain.command(kind, angle, feed, lagged)[1] if lagged > 0 else 0.0
            if abs(v) > 1e-9 and math.copysign(1, v) != sign:
                sign, since = math.copysign(1, v), 0.0
            t, since = t + dt, since + dt
        out.append((sign, since))
    return out


def data(kind, seed):
    draw = random.Random(seed)
    size = draw.choice((-1, 1)) * draw.uniform(0.6, 1.4)
    gains = {**dict.fromkeys("xyz", draw.uniform(29, 31))}
    if kind == "unequal gains":
        gains["y"] *= 1 + 0.04 * size
    rows, start, cache = ["pass,contour,angle_deg,size_mm,feed_mm_min,start_s,time_s,length_1_mm,length_2_mm,length_3_mm"], 0.0, {}
    for n in range(1, PASSES + 1):
        for contour in plain.CONTOURS:
            c, angle, feed = contour
            length = plain.SIZES[c] * (1 if c == 1 else 2 * math.pi)
            end = length / (feed / 60) + feed / 60 / plain.ACCELERATION
            if contour not in cache:
                times = sorted(round(draw.uniform(0.05, end), 3) for _ in range(READINGS))
                slides = [list(x) for x in plain.follow(c, angle, feed, times, gains)]
                for x, (sign, since) in zip(slides, directions(c, angle, feed, times)):
                    if kind == "Y leans":
                        x[0] -= 60e-6 * size * x[1]
                    if kind == "Y has play":
                        x[1] -= sign * 3e-3 * size
                    if kind == "Y sticks at reversal":  # another shape than the catalogue's
                        x[1] -= sign * 40e-3 * size * (math.exp(-since / 0.3) - math.exp(-since / 0.1))
                lengths = [plain.lengths(x) for x in slides]
                if kind == "bar 3 is read late":
                    after = [plain.lengths(x) for x in plain.follow(c, angle, feed, [t + 0.01 for t in times], gains)]
                    lengths = [(a[0], a[1], a[2] + 3e-4 * size * (b[2] - a[2]) / 0.01) for a, b in zip(lengths, after)]
                cache[contour] = times, lengths
            for t, at in zip(*cache[contour]):
                read = (f"{x + draw.gauss(0, plain.NOISE):.5f}" for x in at)
                rows.append(",".join(map(str, (n, c, angle, plain.SIZES[c], feed, f"{start:.0f}", t, *read))))
            start += end + 5
    return "\n".join(rows) + "\n"


def write(folder, kind, seed):
    """A set's files; returns the scenario."""
    (folder / "data").mkdir()
    (folder / "data/trace_contours.csv").write_text(data(kind, seed))
    (folder / "set.toml").write_text((ROOT / "scenarios/trace_contours.toml").read_text())
    return folder / "set.toml"


def found(kind, seed):
    return kinds.found_in(GUMSHOE, write, kind, seed)


class Contours(unittest.TestCase):
    def test_nothing_is_found_where_there_is_nothing(self):
        self.assertEqual(found("nothing", 1), [])

    def test_unequal_gains_are_found(self):
        names = found("unequal gains", 2)
        self.assertEqual(len(names), 1)
        self.assertIn("servo_gain_mismatch", names[0])


if __name__ == "__main__":
    kinds.main(found, KINDS)
