#!/usr/bin/python3
"""Reference values of the single socket method: writes single_socket_stations.csv and single_socket_rotations.csv.

    single_socket_reference.py  # needs python3-mpmath; the tables are committed, the tests only read them

Method (on purpose not the engine's): homogeneous 4 x 4 matrices, 40 digits, exact equations by Newton's method from the
nominal values. Linear solutions are the paper's equations as printed, with (11) and (12) corrected. Lengths in mm, angles
in deg.
"""

import csv
import pathlib
import random

from mpmath import cos, eye, findroot, lu_solve, matrix, mp, mpf, sin, sqrt

mp.dps = 40
DEG = mp.pi / 180
DIGITS = 22
MACHINES = ("rrttt", "tttrr", "rtttr_head", "rtttr_table")
ANGLES = {"rrttt": ("alpha", "beta"), "tttrr": ("alpha", "gamma"), "rtttr_head": ("beta",), "rtttr_table": ("alpha",)}


def shift(x, y, z):
    m = eye(4)
    m[0, 3], m[1, 3], m[2, 3] = x, y, z
    return m


def turn(axis, angle):
    m = eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    m[i, i] = m[j, j] = cos(angle)
    m[i, j], m[j, i] = -sin(angle), sin(angle)
    return m


def place(machine, point, z_alpha_gamma, angle):
    """From the pivot. @param angle: dictionary, rad"""
    a, b, g = (angle.get(n, mpf(0)) for n in ("alpha", "beta", "gamma"))
    chain = {"rrttt": turn(0, a) * turn(1, b), "tttrr": turn(0, a) * shift(0, 0, z_alpha_gamma) * turn(2, g),
             "rtttr_head": turn(1, b), "rtttr_table": turn(0, a)}[machine]
    at = chain * matrix([*point, 1])
    return [at[i] for i in range(3)]


def exact(machine, p, zag, angle, v):
    """Errors of the angles: the equations that the method solves, k a change of the lever."""
    def at(*x):
        names = ANGLES[machine]
        turned = place(machine, p, zag, {n: angle[n] + d for n, d in zip(names, x)})
        k = x[-1] if len(x) > len(names) else mpf(1)
        return [k * turned[i] - v[i] for i in {"rrttt": (0, 1, 2), "tttrr": (0, 1), "rtttr_head": (0, 2),
                                               "rtttr_table": (1, 2)}[machine]]
    start = [mpf(0)] * len(ANGLES[machine]) + ([mpf(1)] if machine != "tttrr" else [])
    x = findroot(at, start, tol=mpf(10) ** -60)
    return dict(zip(ANGLES[machine], x))


def linear(machine, p, zag, angle, v):
    """v = (x_2 + Dx_2) - (x_1 + Dx_1), likewise y and z; seating across the spindle is not in these cases."""
    a, b, g = (angle.get(n, mpf(0)) for n in ("alpha", "beta", "gamma"))
    x, y, z = p
    if machine == "tttrr":
        u, s, w = x * cos(g) - y * sin(g), x * sin(g) + y * cos(g), z + zag
        k = x * x + y * y - v[0] * u
        return {"gamma": (u - v[0]) / s, "alpha": ((-v[1] - w * sin(a)) * s + cos(a) * k) / (w * cos(a) * s + sin(a) * k)}
    beta = -(-v[0] + z * sin(b)) / cos(b) / z
    if machine == "rtttr_head":
        return {"beta": beta}
    if machine == "rtttr_table":
        return {"alpha": (-v[1] + y * cos(a) - z * sin(a)) / (z * cos(a) + y * sin(a))}
    return {"beta": beta, "alpha": (v[1] * cos(a) + v[2] * sin(a)) / (-v[2] * cos(a) + v[1] * sin(a))}


def text(x):
    return mp.nstr(mpf(x), DIGITS)


def number(rng, low, high, digits):
    return mpf(f"{rng.uniform(low, high):.{digits}f}")


def body(rng, machine):
    """A movement whose nominal places are stated to a micrometre, as a table does."""
    head = machine in ("rrttt", "rtttr_head")
    p = [mpf(0), mpf(0), number(rng, -300, -150, 3)] if head else [number(rng, *r, 3) for r in ((-200, -40), (60, 200), (-200, 200))]
    zag = number(rng, 20, 90, 3) if machine == "tttrr" else mpf(0)
    angle = {n: number(rng, -60, 60, 2) * DEG for n in ANGLES[machine]}
    if machine == "tttrr":  # away from the singular places
        angle = {"alpha": number(rng, -20, 20, 2) * DEG, "gamma": number(rng, -20, 20, 2) * DEG}
        p[2] = number(rng, 100, 200, 3)
    pivot = [number(rng, -300, 300, 3) for _ in range(3)]
    return p, zag, angle, pivot


def rotations():
    rng = random.Random(2013)
    header = ["evaluation", "pivot_x", "pivot_y", "pivot_z", "point_x", "point_y", "point_z", "z_alpha_gamma", "seating_x", "seating_y",
              "seating_z", "nominal_x", "nominal_y", "nominal_z", "before_x", "before_y", "before_z", "alpha", "beta", "gamma",
              "after_x", "after_y", "after_z", "d_alpha", "d_beta", "d_gamma", "closure_length"]
    out = []
    for machine in MACHINES:
        for case in range(12):
            p, zag, angle, pivot = body(rng, machine)
            spread = mpf(rng.choice(["0.1", "1", "20"]))  # mm
            before = [number(rng, -1, 1, 4) * spread / 10 for _ in range(3)]
            after = [number(rng, -1, 1, 4) * spread / 10 for _ in range(3)]
            seating = [number(rng, -1, 1, 3) * spread / 10 for _ in range(3)] if case % 3 == 0 else [mpf(0)] * 3
            unturned = [a + b for a, b in zip(p, seating)]
            nominal = [a + b for a, b in zip(pivot, place(machine, p, zag, angle))]
            stated = [mpf(mp.nstr(x, 20)) for x in nominal] if case % 2 else [mpf(0)] * 3
            if case % 4 == 1:
                stated = nominal = [mpf(f"{float(x):.3f}") for x in nominal]
            v = [n + d2 - x - d1 for n, d2, x, d1 in zip(nominal, after, pivot, before)]
            closure = sqrt(sum(x * x for x in v)) - sqrt(sum(x * x for x in place(machine, unturned, zag, {})))
            inputs = [*pivot, *p, zag, *seating, *stated, *before, *(angle.get(n, mpf(0)) / DEG for n in ("alpha", "beta", "gamma")), *after]
            solved = {machine: exact(machine, unturned, zag, angle, v)}
            if case % 3:
                solved[machine + "_linear"] = linear(machine, p, zag, angle, v)
            for evaluation, d in solved.items():
                errors = [d.get(n, mpf(0)) / DEG for n in ("alpha", "beta", "gamma")]
                out.append([evaluation, *map(text, inputs), *map(text, errors), text(closure)])
    unit = {"alpha": "deg", "beta": "deg", "gamma": "deg", "d_alpha": "deg", "d_beta": "deg", "d_gamma": "deg"}
    return [header[0]] + [f"{h} ({unit.get(h, 'mm')})" for h in header[1:]], out


def position(levers, lengths, changes, is_linear):
    """Least squares of the changes; Newton's method on the gradient of the sum of squares, or three equations."""
    if is_linear:
        rows = matrix([[x / l for x in a] for a, l in zip(levers, lengths)])
        return list(lu_solve(rows.T * rows, rows.T * matrix(changes)))
    if len(levers) == 3:
        def equations(*d):
            return [sum((x + y) ** 2 for x, y in zip(a, d)) - (l + c) ** 2 for a, l, c in zip(levers, lengths, changes)]
    else:
        def equations(*d):
            g = [mpf(0)] * 3
            for a, l, c in zip(levers, lengths, changes):
                moved = [x + y for x, y in zip(a, d)]
                now = sqrt(sum(x * x for x in moved))
                g = [s + (now - l - c) * x / now for s, x in zip(g, moved)]
            return g
    return list(findroot(equations, position(levers, lengths, changes, True), tol=mpf(10) ** -60))


def stations():
    rng = random.Random(1999)
    names = ["reference_x", "reference_y", "reference_z", "station_x", "station_y", "station_z", "step", "pivot_x", "pivot_y", "pivot_z",
             "point_x", "point_y", "point_z", "z_alpha_gamma", "alpha", "beta", "gamma", "length_change"]
    found = ["before_x", "before_y", "before_z", "after_x", "after_y", "after_z", "d_alpha", "d_beta", "d_gamma"]
    out, number_of_table = [], 0

    def around(reference, count):
        """Stations at about 150 mm in directions that are not square to each other."""
        base = [(1, .1, .05), (-.1, .9, .2), (.05, -.2, 1), (.6, .6, -.5), (-.5, .4, .7)][:count]
        return [[r + 150 * mpf(str(b)) + number(rng, -9, 9, 3) for r, b in zip(reference, direction)] for direction in base]

    def readings(count, error, noise):
        reference = [number(rng, -300, 300, 3) for _ in range(3)]
        rows, levers, lengths, changes = [], [], [], []
        for at in around(reference, count):
            lever = [a - b for a, b in zip(at, reference)]
            length = sqrt(sum(x * x for x in lever))
            change = sqrt(sum((x + d) ** 2 for x, d in zip(lever, error))) - length + number(rng, -noise, noise, 4)
            change = mpf(mp.nstr(change, 18))
            rows.append([*reference, *at, change]), levers.append(lever), lengths.append(length), changes.append(change)
        return rows, levers, lengths, changes

    def add(evaluation, blocks, p, pivot, zag, angle, result):
        nonlocal number_of_table
        number_of_table += 1
        for step, rows in enumerate(blocks, 1):
            for row in rows:
                turned = angle if step == 2 else {}
                inputs = [*row[:6], step, *pivot, *p, zag, *(turned.get(n, mpf(0)) / DEG for n in ("alpha", "beta", "gamma")), row[6]]
                out.append([number_of_table, evaluation, *map(text, inputs), *("" if x is None else text(x) for x in result)])

    for count in (3, 3, 4, 5):
        for size, noise in (("0.05", 0), ("0.27", 0.005), ("1.7", 0.02)):
            error = [number(rng, -1, 1, 4) * mpf(size) for _ in range(3)]
            rows, *data = readings(count, error, noise)
            for evaluation in ("position", "position_linear"):
                d = position(*data, evaluation == "position_linear")
                add(evaluation, [rows], [0, 0, -250], [0, 0, 0], 0, {}, [*d, *[None] * 6])
    for machine in MACHINES:
        for noise in (0, 0.01):
            p, zag, angle, pivot = body(rng, machine)
            before = [number(rng, -1, 1, 4) * mpf("0.2") for _ in range(3)]
            d = {n: number(rng, -1, 1, 4) * mpf("0.3") * DEG for n in ANGLES[machine]}
            nominal = place(machine, p, zag, angle)
            actual = place(machine, p, zag, {n: angle[n] + d[n] for n in angle})
            after = [b + x - y for b, x, y in zip(before, actual, nominal)]
            one, two = readings(3, before, noise), readings(3 if noise == 0 else 4, after, noise)
            for evaluation in (machine, machine + "_linear"):
                is_linear = evaluation.endswith("linear")
                d1, d2 = position(*one[1:], is_linear), position(*two[1:], is_linear)
                v = [n + y - x for n, x, y in zip(nominal, d1, d2)]
                errors = (linear if is_linear else exact)(machine, p, zag, angle, v)
                shown = [errors[n] / DEG if n in errors else None for n in ("alpha", "beta", "gamma")]
                add(evaluation, [one[0], two[0]], p, pivot, zag, angle, [*d1, *d2, *shown])
    unit = {"alpha": "deg", "beta": "deg", "gamma": "deg", "step": "1"}
    header = ["table", "evaluation"] + [f"{n} ({unit.get(n, 'mm')})" for n in names]
    return header + [f"{n} ({'deg' if n.startswith('d_') else 'mm'})" for n in found], out


if __name__ == "__main__":
    for name, (header, rows) in (("rotations", rotations()), ("stations", stations())):
        with (pathlib.Path(__file__).parent / f"single_socket_{name}.csv").open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([header, *rows])
