"""Contours measured with three laser ball bars on a machine whose servos are integrated in small steps, independent of the
engine; writes the data of trace_contours.toml, or those of ball_bar_circle.toml and ball_bar_square.toml.

usage: plain_contour.py > scenarios/data/trace_contours.csv
       plain_contour.py --circle > scenarios/data/ball_bar_circle.csv
       plain_contour.py --square > scenarios/data/ball_bar_square.csv
"""
import math
import random
import sys

GAINS = {"x": 30.0, "y": 33.0, "z": 30.0}  # 1/s: the scenario declares one for all
ORIGIN = (203.1, 118.4, 299.2)             # of the machine's coordinates from socket 1, mm
SOCKETS = ((0.0, 0.0), (400.0, 0.0), (200.0, 200 * math.sqrt(3)))
ACCELERATION = 980.0                       # mm/s2
NOISE = 0.7e-3                             # of every length, mm
STEP = 5e-4                                # of the integration, s: fourth order, exact to 1e-9 mm
PASSES, READINGS = 4, 15                   # passes over all contours, readings of a contour
CONTOURS = [(kind, angle, feed) for feed in (889.0, 1778.0) for kind, angle in ((1, 45.0), (1, 135.0), (2, 0.0))]
SIZES = {1: 100.0, 2: 50.0, 3: 40.0}       # length of a line, radius of a circle, side of a square, mm


def path(length, feed, t):
    """Path length of a trapezoidal move, mm; it reaches the feed (mm/s)."""
    ramp, end = feed / ACCELERATION, length / feed + feed / ACCELERATION
    if t < ramp:
        return ACCELERATION * max(t, 0.0) ** 2 / 2
    if t < end - ramp:
        return feed * (t - ramp / 2)
    return length - ACCELERATION * max(end - t, 0.0) ** 2 / 2


def command(kind, angle, feed, t):
    """Commanded point, mm; feed in mm/min."""
    a, size = math.radians(angle), SIZES[kind]
    if kind == 1:
        s = path(size, feed / 60, t)
        return s * math.cos(a), s * math.sin(a), 0.0
    if kind == 3:  # counter-clockwise from 0, 0 along X, with a stop at each corner
        side = size / (feed / 60) + feed / 60 / ACCELERATION
        s = [path(size, feed / 60, t - k * side) for k in range(4)]
        return s[0] - s[2], s[1] - s[3], 0.0
    phi = a + path(2 * math.pi * size, feed / 60, t) / size
    return size * math.cos(phi), size * math.sin(phi), 0.0


def follow(kind, angle, feed, times, gains=GAINS):
    """Where the slides are at the times, mm: x' = K (u - x), Runge and Kutta."""
    k = [gains[c] for c in "xyz"]
    x, t, out = list(command(kind, angle, feed, 0.0)), 0.0, []
    for end in times:
        steps = max(1, math.ceil((end - t) / STEP))
        h = (end - t) / steps
        for _ in range(steps):
            u0, u1, u2 = (command(kind, angle, feed, t + f * h) for f in (0.0, 0.5, 1.0))
            for i in range(3):
                a = k[i] * (u0[i] - x[i])
                b = k[i] * (u1[i] - x[i] - h / 2 * a)
                c = k[i] * (u1[i] - x[i] - h / 2 * b)
                d = k[i] * (u2[i] - x[i] - h * c)
                x[i] += h / 6 * (a + 2 * b + 2 * c + d)
            t += h
        out.append(tuple(x))
    return out


def lengths(x):
    at = [o + c for o, c in zip(ORIGIN, x)]
    return [math.dist(at, (*s, 0.0)) for s in SOCKETS]


def circle():
    """One fast circle with the gains of X and Y the other way round, as the paper's ellipse has them."""
    draw, feed = random.Random(51), 1778.0
    end = 2 * math.pi * SIZES[2] / (feed / 60) + feed / 60 / ACCELERATION
    times = [round(0.05 + (end - 0.05) * i / 72, 3) for i in range(72)]
    print("time_s,length_1_mm,length_2_mm,length_3_mm")
    for t, x in zip(times, follow(2, 0.0, feed, times, {"x": 33.0, "y": 30.0, "z": 30.0})):
        print(t, *(f"{l + draw.gauss(0, NOISE):.5f}" for l in lengths(x)), sep=",")


def square():
    """One fast square with the gains of the circle above."""
    draw, feed = random.Random(52), 1778.0
    end = 4 * (SIZES[3] / (feed / 60) + feed / 60 / ACCELERATION)
    times = [round(0.02 + end * i / 160, 3) for i in range(160)]
    print("time_s,length_1_mm,length_2_mm,length_3_mm")
    for t, x in zip(times, follow(3, 0.0, feed, times, {"x": 33.0, "y": 30.0, "z": 30.0})):
        print(t, *(f"{l + draw.gauss(0, NOISE):.5f}" for l in lengths(x)), sep=",")


def main():
    draw = random.Random(1999)
    print("pass,contour,angle_deg,size_mm,feed_mm_min,start_s,time_s,length_1_mm,length_2_mm,length_3_mm")
    start = 0.0
    true = {}
    for n in range(1, PASSES + 1):
        for kind, angle, feed in CONTOURS:
            length = SIZES[kind] * (1 if kind == 1 else 2 * math.pi)
            end = length / (feed / 60) + feed / 60 / ACCELERATION
            times = [round(0.05 + (end - 0.05) * i / READINGS, 3) for i in range(READINGS)]
            if (kind, angle, feed) not in true:
                true[kind, angle, feed] = [lengths(x) for x in follow(kind, angle, feed, times)]
            for t, at in zip(times, true[kind, angle, feed]):
                read = (f"{l + draw.gauss(0, NOISE):.5f}" for l in at)
                print(n, kind, angle, SIZES[kind], feed, f"{start:.0f}", t, *read, sep=",")
            start += end + 5


if __name__ == "__main__":
    if "-h" in sys.argv:
        sys.exit(print(__doc__))
    circle() if "--circle" in sys.argv else square() if "--square" in sys.argv else main()
