#!/usr/bin/python3
"""References of the laser ball bars: writes ball_bar_cases.csv and ball_bar_contours.csv.

    ball_bar_reference.py         # needs python3-mpmath; the tables are committed, the tests only read them

Method (on purpose not the engine's), 50 digits. ball_bar_cases.csv: the ball from three read lengths, by the angles of the
base triangle and a linear system for two differences of squares; the machine's frame by Gram and Schmidt; `tolerance` is
what sixteen roundings of every input make of a coordinate, by differences. ball_bar_contours.csv: the lengths that are
read on a contour, with slides whose differential equation is integrated over the commanded motion by quadrature with its
poles as complex numbers; the commanded motion itself is integrated from its acceleration.
"""

import csv
import pathlib
import random

from mpmath import mp, mpf, mpc, acos, cos, exp, lu_solve, matrix, pi, quad, sin, sqrt

mp.dps = 50
HERE = pathlib.Path(__file__).resolve().parent
EPS = mpf(2) ** -53
UNITS = {"um": ("initialisation", "form"), "us": ("skew",), "um/m": ("wavelength_error",), "um/m/K": ("expansion",),
         "K": ("temperature_difference",), "1/s": ("loop_gain",), "deg": ("angle", "elevation"), "s": ("time",),
         "mm/min": ("feed",), "m/s2": ("acceleration",), "m/s3": ("jerk",),
         "1": ("Z_motion", "X_motion", "damping", "contour", "order", "sense")}
FACTORS = {"mm": "1e-3", "um": "1e-6", "us": "1e-6", "um/m": "1e-6", "um/m/K": "1e-6", "K": "1", "1/s": "1", "s": "1",
           "m/s2": "1", "m/s3": "1", "1": "1"}
DEFAULTS = dict(
    base_length_1="400", base_length_2="400", base_length_3="400", Z_motion_x="0", Z_motion_y="0", Z_motion_z="1",
    X_motion_x="1", X_motion_y="0", X_motion_z="0", origin_x="200", origin_y="120", origin_z="300", initialisation_1="0",
    initialisation_2="0", initialisation_3="0", fixture_length_12="400", fixture_length_23="400", fixture_offset="0",
    form_1="0", form_2="0", form_3="0", axis_offset_1="0", axis_offset_2="0", axis_offset_3="0", wavelength_error="0",
    expansion="11.5", temperature_difference="0", skew_1="0", skew_2="0", skew_3="0", loop_gain="30", damping="0.7",
    contour="0", x="0", y="0", z="0", size="100", angle="0", elevation="0", sense="1", feed="889", acceleration="0.98",
    jerk="0", order="1", time="0")


def unit(name):
    for u, names in UNITS.items():
        if any(name == n or name.startswith(n + "_") for n in names):
            return u
    return "mm"


def si(name, text):
    u = unit(name)
    if u == "deg":
        return mpf(text) * pi / 180
    if u == "mm/min":
        return mpf(text) / 60000
    return mpf(text) * mpf(FACTORS[u])


def values(given):
    return {name: si(name, text) for name, text in {**DEFAULTS, **given}.items()}


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def scaled(s, a):
    return [s * x for x in a]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def unit_vector(a):
    return scaled(1 / sqrt(dot(a, a)), a)


def axes(q):
    """Machine axes in the bars' frame, by Gram and Schmidt."""
    n_z = unit_vector([q["Z_motion_" + c] for c in "xyz"])
    v = [q["X_motion_" + c] for c in "xyz"]
    n_x = unit_vector(minus(v, scaled(dot(v, n_z), n_z)))
    n_y = [n_z[1] * n_x[2] - n_z[2] * n_x[1], n_z[2] * n_x[0] - n_z[0] * n_x[2], n_z[0] * n_x[1] - n_z[1] * n_x[0]]
    return n_x, n_y, n_z


def sockets(q):
    b12, b23, b31 = [(1 + q["expansion"] * q["temperature_difference"]) * q[f"base_length_{i}"] for i in (1, 2, 3)]
    at_1 = acos((b12 ** 2 + b31 ** 2 - b23 ** 2) / (2 * b12 * b31))
    return [[mpf(0)] * 3, [b12, mpf(0), mpf(0)], [b31 * cos(at_1), b31 * sin(at_1), mpf(0)]]


def fixture(q):
    a, b, h = q["fixture_length_12"], q["fixture_length_23"], q["fixture_offset"]
    return (a + b) - sqrt(a * a + h * h) - sqrt(b * b + h * h)  # length that is set minus true length


def tool(q, read):
    """Tool from socket 1 along the machine's axes, at rest; None where there is none."""
    lengths = []
    for i, r in enumerate(read):
        beam = (r - q[f"initialisation_{i + 1}"] - q[f"form_{i + 1}"] - fixture(q)) / (1 + q["wavelength_error"])
        lengths.append(sqrt(beam ** 2 + q[f"axis_offset_{i + 1}"] ** 2))
    s = sockets(q)
    rows = matrix([[2 * s[1][0], 2 * s[1][1]], [2 * s[2][0], 2 * s[2][1]]])
    right = matrix([lengths[0] ** 2 - lengths[i] ** 2 + dot(s[i], s[i]) for i in (1, 2)])
    x, y = lu_solve(rows, right)
    z2 = lengths[0] ** 2 - x ** 2 - y ** 2
    if z2 < 0:
        return None
    return [dot(n, [x, y, sqrt(z2)]) for n in axes(q)]


def rounding(given, read_text):
    """What sixteen roundings of each input make of the three coordinates, mm."""
    q = values(given)
    read = [si("length", t) for t in read_text]
    at = tool(q, read)
    total = [mpf(0)] * 3
    for name in list(q) + [0, 1, 2]:
        near_q, near = dict(q), list(read)
        step = mpf(10) ** -30
        if isinstance(name, int):
            size, near[name] = read[name], read[name] * (1 + step)
        else:
            size, near_q[name] = q[name], q[name] * (1 + step)
        if size == 0:
            continue
        moved = tool(near_q, near)
        total = [t + abs(m - a) / step for t, m, a in zip(total, moved, at)]
    return [max(16 * EPS * t * 1000, mpf("1e-13")) for t in total]


# Contours


class Move:
    """Path length against time from rest to rest, integrated from its acceleration."""

    def __init__(self, length, v, a, j):
        def phases(v):
            if j == 0:
                return [(v / a, mpf(0), mpf(0), a)]
            rise = min(a / j, sqrt(v / j))
            return [(rise, j, mpf(0), mpf(0)), (v / (rise * j) - rise, mpf(0), rise * j, mpf(0)), (rise, -j, rise * j, mpf(0))]
        def ramp_time(v):
            return sum(p[0] for p in phases(v))
        if v * ramp_time(v) > length:  # a ramp takes half its time at v
            low, high = mpf(0), v
            for _ in range(200):
                middle = (low + high) / 2
                low, high = (middle, high) if middle * ramp_time(middle) < length else (low, middle)
            v = low
        up = phases(v)
        cruise = (length - v * ramp_time(v)) / v
        # The ramp down is the ramp up in reverse: its acceleration runs back with the other sign.
        down = [(t, jj, -(a0 + c + jj * t)) for t, jj, a0, c in reversed(up)]
        self.pieces, time, s, feed = [], mpf(0), mpf(0), mpf(0)
        for t, jj, a0 in [(t, jj, a0 + c) for t, jj, a0, c in up] + [(cruise, mpf(0), mpf(0))] + down:
            if t <= 0:
                continue
            self.pieces.append((time, time + t, s, feed, a0, jj))
            s, feed, time = s + feed * t + a0 * t ** 2 / 2 + jj * t ** 3 / 6, feed + a0 * t + jj * t ** 2 / 2, time + t
        assert abs(s - length) < mpf(10) ** -25 and abs(feed) < mpf(10) ** -25
        self.end, self.length = time, length

    def at(self, t, piece=None):
        """Path length and feed; those of a piece at its ends."""
        if piece is None:
            if t >= self.end:
                return self.length, mpf(0)
            piece = next(p for p in self.pieces if t <= p[1])
        begin, _, s, v, a, j = piece
        d = t - begin
        return s + v * d + a * d ** 2 / 2 + j * d ** 3 / 6, v + a * d + j * d ** 2 / 2


def response(order, gain, damping, move, point, time):
    """Position and velocity of a slide: x = u(0) + integral of g(t - tau) u'(tau), g the step response."""
    if order == 1:
        step, impulse = (lambda t: 1 - exp(-gain * t)), (lambda t: gain * exp(-gain * t))
    elif damping == 1:
        w = 2 * gain
        step, impulse = (lambda t: 1 - exp(-w * t) * (1 + w * t)), (lambda t: w ** 2 * t * exp(-w * t))
    else:
        w = 2 * damping * gain
        root = sqrt(mpc(damping ** 2 - 1))
        p, m = w * (-damping + root), w * (-damping - root)
        step = lambda t: (1 + (m * exp(p * t) - p * exp(m * t)) / (p - m)).real
        impulse = lambda t: (p * m * (exp(p * t) - exp(m * t)) / (p - m)).real
    x, v = point(mpf(0))[0], mpf(0)
    for piece in move.pieces:
        begin, end = piece[0], min(piece[1], time)
        if begin >= end:
            break
        panels = 1 + int((end - begin) * gain / 4)
        nodes = [begin + (end - begin) * k / panels for k in range(panels + 1)]
        def rate(tau):
            s, feed = move.at(tau, piece)
            return point(s)[1] * feed
        x += quad(lambda tau: step(time - tau) * rate(tau), nodes)
        v += quad(lambda tau: impulse(time - tau) * rate(tau), nodes)
    return x, v


def lengths(q):
    """Read lengths of the bars, m."""
    place = [q["x"], q["y"], q["z"]]
    a, e = q["angle"], q["elevation"]
    along, left = [cos(a) * cos(e), sin(a) * cos(e), sin(e)], [-sin(a), cos(a), mpf(0)]
    position, velocity = [], []
    for i in range(3):
        if q["contour"] == 0:
            position.append(place[i]), velocity.append(mpf(0))
            continue
        circle, size = q["contour"] == 2, q["size"]
        move = Move(2 * pi * size if circle else size, q["feed"], q["acceleration"], q["jerk"])
        def point(s):
            if not circle:
                return place[i] + along[i] * s, along[i]
            phi = q["sense"] * s / size
            return (place[i] + size * (along[i] * cos(phi) + left[i] * sin(phi)),
                    q["sense"] * (left[i] * cos(phi) - along[i] * sin(phi)))
        x, v = response(q["order"], q["loop_gain"], q["damping"], move, point, q["time"])
        position.append(x), velocity.append(v)
    origin = [q["origin_" + c] for c in "xyz"]
    n = axes(q)
    def in_bars(p):
        return [sum(p[k] * n[k][c] for k in range(3)) for c in range(3)]
    ball, moving = in_bars([p + o for p, o in zip(position, origin)]), in_bars(velocity)
    out = []
    for i, s in enumerate(sockets(q), 1):
        bar = minus(ball, s)
        length = sqrt(dot(bar, bar))
        read = sqrt(length ** 2 - q[f"axis_offset_{i}"] ** 2) * (1 + q["wavelength_error"])
        out.append(read + q[f"initialisation_{i}"] + q[f"form_{i}"] + fixture(q) + q[f"skew_{i}"] * dot(bar, moving) / length)
    return out


def digits(x, n=20):
    return mp.nstr(x, n, strip_zeros=True, min_fixed=-1, max_fixed=0)


def write(name, header, rows):
    with open(HERE / name, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        out.writerows(rows)


def static_cases(draw):
    """(given, lengths that are read as texts)"""
    def number(low, high, places=4):
        return f"{draw.uniform(low, high):.{places}f}"
    for n in range(60):
        given = {f"base_length_{i}": number(380, 700) for i in (1, 2, 3)}
        if n >= 15:
            for i in (1, 2, 3):
                given |= {f"initialisation_{i}": number(-50, 50), f"form_{i}": number(-5, 5), f"axis_offset_{i}": number(0, 2)}
            given |= dict(wavelength_error=number(-50, 50), temperature_difference=number(-8, 8), fixture_offset=number(0, 3),
                          fixture_length_12=number(200, 600), fixture_length_23=number(200, 600))
        if n >= 30:
            given |= dict(Z_motion_x=number(-0.5, 0.5), Z_motion_y=number(-0.5, 0.5), Z_motion_z=number(0.6, 1.4),
                          X_motion_x=number(0.6, 1.4), X_motion_y=number(-0.7, 0.7), X_motion_z=number(-0.3, 0.3))
        if n >= 45:  # near what is possible: a flat base, a low tool
            flat = mpf(10) ** -(n % 5)
            given["base_length_3"] = digits(mpf(given["base_length_1"]) + mpf(given["base_length_2"]) - flat, 12)
        height = mpf(10) ** -(n % 4) if 40 <= n < 50 else mpf(draw.uniform(60, 600))
        q = values(given)
        s = sockets(q)
        ball = [mpf(draw.uniform(-0.2, 0.8)), mpf(draw.uniform(-0.1, 0.6)), height / 1000]
        read = []
        for i in range(3):
            bar = minus(ball, s[i])
            r = sqrt(dot(bar, bar) - q[f"axis_offset_{i + 1}"] ** 2) * (1 + q["wavelength_error"])
            read.append(mp.nstr((r + q[f"initialisation_{i + 1}"] + q[f"form_{i + 1}"] + fixture(q)) * 1000, 16))
        yield given, read
    for read in (["100", "100", "500"], ["200", "200", "230"], ["1000", "500", "500"]):
        yield {}, read


def main():
    draw = random.Random(1999)
    inputs = [n for n in DEFAULTS if n not in ("contour", "x", "y", "z", "size", "angle", "elevation", "sense", "feed", "acceleration",
              "jerk", "order", "time", "loop_gain", "damping", "expansion") and not n.startswith(("origin", "skew"))]
    header = [f"{n} ({unit(n)})" for n in inputs] + [f"length_{i} (mm)" for i in (1, 2, 3)]
    rows = []
    for given, read in static_cases(draw):
        found = tool(values(given), [si("length", t) for t in read])
        row = [given.get(n, DEFAULTS[n]) for n in inputs] + read
        if found is None:
            rows.append(row + ["nan"] * 6 + ["out_of_domain"])
            continue
        rows.append(row + [digits(1000 * c) for c in found] + [digits(t, 3) for t in rounding(given, read)] + ["ok"])
    mp.dps = 30
    write("ball_bar_cases.csv", header + [f"tool_{c} (mm)" for c in "xyz"] + [f"tolerance_{c} (mm)" for c in "xyz"] + ["status"], rows)

    shared = dict(skew_1="100", skew_2="-40", skew_3="15", X_motion_y="0.3", Z_motion_x="0.1", initialisation_1="2",
                  axis_offset_2="0.5", wavelength_error="3", temperature_difference="2", fixture_offset="1")
    cases = []
    for time in ("0.011", "0.3", "1.7", "6.74", "6.78", "7.3"):
        cases.append(shared | dict(contour="1", angle="30", elevation="20", x="-10", y="5", z="3", time=time))
    for time in ("0.02", "0.2", "3", "4.77"):
        cases.append(shared | dict(contour="1", angle="45", feed="1778", size="140", jerk="30", acceleration="4.91", order="2", time=time))
    for damping in ("0.3", "1", "1.0000001", "2.5"):
        cases.append(dict(contour="1", angle="-120", feed="3000", size="40", jerk="200", order="2", damping=damping, time="0.21"))
    cases.append(dict(contour="1", size="0.5", feed="3000", time="0.03"))                        # the feed is not reached
    cases.append(dict(contour="1", size="0.5", feed="3000", jerk="20", time="0.13"))             # nor is the acceleration
    for order, time in (("1", "0.02"), ("1", "2.5"), ("1", "5.311"), ("2", "0.35"), ("2", "4")):
        cases.append(shared | dict(contour="2", size="25", feed="1778", angle="20", elevation="35", order=order, time=time, sense="-1"))
    for order, time in (("1", "0.1"), ("1", "0.9"), ("2", "0.3"), ("2", "1.2")):
        cases.append(dict(contour="2", size="5", feed="2500", jerk="2", time=time, order=order, damping="0.5", loop_gain="80"))
    inputs = [n for n in DEFAULTS if any(n in c for c in cases)]
    header = [f"{n} ({unit(n)})" for n in inputs] + [f"length_{i} (mm)" for i in (1, 2, 3)]
    rows = [[c.get(n, DEFAULTS[n]) for n in inputs] + [digits(1000 * x) for x in lengths(values(c))] for c in cases]
    write("ball_bar_contours.csv", header, rows)


main()
