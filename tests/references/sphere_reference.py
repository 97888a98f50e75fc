#!/usr/bin/python3
"""Reference commands of the sphere calibration, to 1e-15 mm: writes sphere_cases.csv.

    sphere_reference.py         # needs python3-mpmath; the table is committed, the tests only read it

Method (on purpose not the engine's): homogeneous 4 x 4 matrices of the whole loop, workpiece - bed - tool, 40 digits.
An actual axis is reached by two rotations that carry the design axis onto its line and are undone behind the motion;
`small_angle` has the first-order matrices of Fang 2022, eqs (4.7) to (4.10), in their place, as printed. The commands
are the solution of  tip in the workpiece's frame = place above the sphere,  which is linear in X, Y and Z.
"""

import csv
import pathlib
import random

from mpmath import mp, mpf, atan2, cos, sin, tan, sqrt, matrix, eye, lu_solve

mp.dps = 40
DEG = mp.pi / 180
DEFAULTS = dict(
    probe_x="85.564", probe_y="287.428", probe_z="454.220", E_X0B="-0.406", E_Z0B="0.544", E_X0C="0.230", E_Y0C="0.369",
    E_A0B="-0.267", E_C0B="-0.184", E_A0C="0.0433", E_B0C="0.0121", link_B_x="-120", link_B_z="110", link_C_x="50",
    link_C_y="180", sphere_distance="184.183", sphere_radius="12.5", tip_radius="3", sphere_y="0", sphere_z="0", E_AA="0",
    E_BB="0", E_CC="0", E_XX="0", E_XY="0", E_XZ="0", E_YX="0", E_YY="0", E_YZ="0", E_ZX="0", E_ZY="0", E_ZZ="0", S_XY="0",
    S_XZ="0", S_YZ="0", A="0", B="0", C="0")
ANGLES = {"E_A0B", "E_C0B", "E_A0C", "E_B0C", "E_AA", "E_BB", "E_CC", "A", "B", "C"}
SQUARENESS = {"S_XY", "S_XZ", "S_YZ"}


def unit(name):
    return "deg" if name in ANGLES else "um/m" if name in SQUARENESS else "mm"


def shift(x, y, z):
    m = eye(4)
    m[0, 3], m[1, 3], m[2, 3] = x, y, z
    return m


def turn(axis, angle):
    """Right-handed about X (0), Y (1) or Z (2)."""
    m = eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    m[i, i] = m[j, j] = cos(angle)
    m[i, j], m[j, i] = -sin(angle), sin(angle)
    return m


def rows(*values):
    return matrix([list(map(mpf, row)) for row in values])


def onto_line(direction, axis):
    """A rotation that carries the design axis (Y or Z) onto the direction; its inverse is its transpose."""
    x, y, z = direction
    if axis == 2:  # about Y until Z leans in XZ far enough, then about X: (sin b, -cos b sin a, cos b cos a)
        return turn(0, atan2(-y, z)) * turn(1, atan2(x, sqrt(y * y + z * z)))
    return turn(0, atan2(z, y)) * turn(2, atan2(-x, sqrt(y * y + z * z)))


def frames(q, variant):
    """Into the actual axes' directions and back."""
    a_b, c_b, a_c, b_c = (q[n] for n in ("E_A0B", "E_C0B", "E_A0C", "E_B0C"))
    if variant == "exact":
        b = onto_line((-tan(c_b), mpf(1), tan(a_b)), 1)
        c = onto_line((tan(b_c), -tan(a_c), mpf(1)), 2)
        return b, b.T, c, c.T
    return (rows((1, -c_b, 0, 0), (c_b, 1, -a_b, 0), (0, a_b, 1, 0), (0, 0, 0, 1)),    # (4.9)
            rows((1, c_b, 0, 0), (-c_b, 1, a_b, 0), (0, -a_b, 1, 0), (0, 0, 0, 1)),    # (4.8)
            rows((1, 0, b_c, 0), (0, 1, -a_c, 0), (-b_c, a_c, 1, 0), (0, 0, 0, 1)),    # (4.8)
            rows((1, 0, -b_c, 0), (0, 1, a_c, 0), (b_c, -a_c, 1, 0), (0, 0, 0, 1)))    # (4.7)


def tip(q, variant, x, y, z, at_a, at_b, at_c):
    """The tip's centre in the workpiece's frame, (4.11)."""
    b, b_back, c, c_back = frames(q, variant)
    dbx, dbz = q["link_B_x"] + q["E_X0B"], q["link_B_z"] + q["E_Z0B"]
    dcx, dcy = q["link_C_x"] + q["E_X0C"], q["link_C_y"] + q["E_Y0C"]
    bed_from_workpiece = shift(-x, 0, 0) * turn(0, at_a)
    bed_from_b = shift(dbx, y, z - dbz) * b
    b_from_c = turn(1, at_b) * b_back * shift(dcx - dbx, dcy, dbz) * c
    c_from_origin = turn(2, at_c) * c_back * shift(-dcx, -dcy, 0)
    probe = matrix([q["probe_x"], -q["probe_y"], -q["probe_z"], 1])
    return lu_solve(bed_from_workpiece, bed_from_b * b_from_c * c_from_origin * probe)


def commands(q, variant, at_a, at_b, at_c):
    """The tip is above the sphere: its centre in the workpiece's frame, and both radii along the machine's Z."""
    above = turn(0, -at_a) * matrix([0, 0, q["sphere_radius"] + q["tip_radius"], 1])
    place = [-q["sphere_distance"], q["sphere_y"] + above[1], q["sphere_z"] + above[2]]
    zero = tip(q, variant, 0, 0, 0, at_a, at_b, at_c)
    columns = [tip(q, variant, *e, at_a, at_b, at_c) - zero for e in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    slope = matrix([[columns[j][i] for j in range(3)] for i in range(3)])
    return lu_solve(slope, matrix([place[i] - zero[i] for i in range(3)]))


def recorded(case, variant):
    q = {n: mpf(v) * (DEG if n in ANGLES else mpf(10) ** -6 if n in SQUARENESS else 1) for n, v in case.items()}
    nominal = commands(q, variant, q["A"], q["B"], q["C"])
    actual = commands(q, variant, q["A"] + q["E_AA"], q["B"] + q["E_BB"], q["C"] + q["E_CC"])
    e = [q["E_XX"] + q["E_XY"] + q["E_XZ"] + q["S_XZ"] * nominal[2] - q["S_XY"] * nominal[1],  # (4.51)
         q["E_YX"] + q["E_YY"] + q["E_YZ"] - q["S_YZ"] * nominal[2],
         q["E_ZX"] + q["E_ZY"] + q["E_ZZ"]]
    return [actual[i] + e[i] for i in range(3)]


def cases():
    def case(**values):
        return {**DEFAULTS, **{n: str(v) for n, v in values.items()}}

    for c in range(0, 91, 15):
        yield case(C=c)  # pattern I
    for b in range(-20, 46, 13):
        yield case(C=90, B=b)  # pattern II
    yield case(E_A0B=0, E_C0B=0, E_A0C=0, E_B0C=0, B=30, C=-60)
    for name in sorted(ANGLES - {"A", "B", "C"}):  # each alone, and large
        yield case(**{name: 5}, A=20, B=-35, C=50, sphere_y=7, sphere_z=-3)
    for name in list(DEFAULTS)[:9] + ["link_B_x", "link_B_z", "link_C_x", "link_C_y", "sphere_distance"]:
        yield case(**{name: float(DEFAULTS[name]) + 17}, B=12, C=75)
    for name in list(DEFAULTS)[23:32]:
        yield case(**{name: 0.004}, B=12, C=75)
    for name in sorted(SQUARENESS):
        yield case(**{name: 8}, B=12, C=75, E_BB=0.04, E_CC=-0.04)
    draw = random.Random(4051)
    for _ in range(40):
        size = draw.choice([1, 1, 20])
        q = {n: round(float(v) * draw.uniform(0.5, 1.5), 4) for n, v in DEFAULTS.items()}
        for n in ("E_A0B", "E_C0B", "E_A0C", "E_B0C"):
            q[n] = round(size * draw.uniform(-0.5, 0.5), 5)
        for n in ("E_AA", "E_BB", "E_CC"):
            q[n] = round(size * draw.uniform(-0.04, 0.04), 5)
        for n in list(DEFAULTS)[23:32]:
            q[n] = round(draw.uniform(-0.004, 0.004), 6)
        for n in SQUARENESS:
            q[n] = round(draw.uniform(-50, 50), 3)
        q.update(sphere_y=round(draw.uniform(-20, 20), 3), sphere_z=round(draw.uniform(-20, 20), 3),
                 A=round(draw.uniform(-180, 180), 2), B=round(draw.uniform(-120, 120), 2), C=round(draw.uniform(-200, 200), 2))
        yield case(**q)


def main():
    with open(pathlib.Path(__file__).with_name("sphere_cases.csv"), "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["evaluation", *(f"{n} ({unit(n)})" for n in DEFAULTS), "X (mm)", "Y (mm)", "Z (mm)"])
        for case in cases():
            for variant in ("exact", "small_angle"):
                out.writerow([variant, *case.values(), *(mp.nstr(v, 20) for v in recorded(case, variant))])


if __name__ == "__main__":
    main()
