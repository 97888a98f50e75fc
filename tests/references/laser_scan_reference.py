#!/usr/bin/python3
"""Reference displacements of the scanner, to 1e-15 mm: writes laser_scan_cases.csv.

    laser_scan_reference.py     # needs python3-mpmath; the table is committed, the tests only read it

Method (on purpose not the engine's): homogeneous 4 x 4 matrices composed as Ibaraki et al. 2018, eqs (3), (8) and (12)
print them, 40 digits; the surface as an implicit function, and along the beam the zero of smallest absolute value, found
by sampling the function and bisection. Prints the displacements of the other machines, which the test holds. Location errors without a printed place (slides) as in the model's README.
"""
import csv
import pathlib
import random

from mpmath import mp, mpf, atan, cos, eye, hypot, matrix, pi, sin, sqrt

mp.dps = 40
DEG = pi / 180
LENGTHS = ["e_x", "e_y", "e_z", "workpiece_x", "workpiece_y", "E_X0B", "E_Y0C", "E_Z0B", "E_X0C_minus_E_X0B", "sensor_length", "sensor_zero",
           "cone_radius", "cone_height", "surface_height", "surface_radius", "ring_radius", "radius"]
MRAD = ["e_a", "e_b", "E_A0B", "E_B0B", "E_C0B", "E_A0C_minus_E_A0B", "E_C0Y", "E_A0Z", "E_B0Z"]
ANGLES = ["B", "C", "theta", "cylinder_azimuth"]
NUMBERS = ["sensor_gain", "cone_slope", "plane_slope_x", "plane_slope_y", "surface"]
NAMES = LENGTHS + MRAD + ANGLES + NUMBERS
DEFAULTS = dict.fromkeys(NAMES, mpf(0)) | dict(cone_slope=mpf("-0.005"), cone_radius=mpf(70), surface_radius=mpf(100), ring_radius=mpf(70),
                                              radius=mpf(70))


def move(x=0, y=0, z=0):
    m = eye(4)
    m[0, 3], m[1, 3], m[2, 3] = x, y, z
    return m


def turn(axis, angle):
    m = eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    m[i, i] = m[j, j] = cos(angle)
    m[i, j], m[j, i] = -sin(angle), sin(angle)
    return m


def implicit(q, p):
    """Zero on the surface, in the part's frame about its centre."""
    x, y, z = p
    kind = int(q["surface"])
    rho = hypot(x, y)
    if kind == 0:
        return z - q["cone_height"] - q["cone_slope"] * (rho - q["cone_radius"])
    if kind == 1:
        return z - q["surface_height"] - q["plane_slope_x"] * x - q["plane_slope_y"] * y
    h, r = z - q["surface_height"], abs(q["surface_radius"])
    if kind == 2:
        a = q["cylinder_azimuth"] * DEG
        return hypot(y * cos(a) - x * sin(a), h) - r
    if kind == 3:
        return hypot(rho, h) - r
    return hypot(rho - q["ring_radius"], h) - r


def nominal_height(q, x, y):
    rho = hypot(x, y)
    kind, r = int(q["surface"]), q["surface_radius"]
    if kind == 0:
        return q["cone_height"] + q["cone_slope"] * (rho - q["cone_radius"])
    if kind == 1:
        return q["surface_height"] + q["plane_slope_x"] * x + q["plane_slope_y"] * y
    a = q["cylinder_azimuth"] * DEG
    off = {2: y * cos(a) - x * sin(a), 3: rho, 4: rho - q["ring_radius"]}[kind]
    return q["surface_height"] + (1 if r > 0 else -1) * sqrt(r * r - off * off)


def paper(q, r):
    """Table (B, C), eq (8)."""
    B, C = q["B"] * DEG, q["C"] * DEG
    real = (move(q["E_X0B"], q["E_Y0C"], q["E_Z0B"]) * turn(0, r["E_A0B"]) * turn(1, r["E_B0B"]) * turn(2, r["E_C0B"]) * turn(1, -B)
            * move(q["E_X0C_minus_E_X0B"]) * turn(0, r["E_A0C_minus_E_A0B"]) * turn(2, -C))
    return turn(1, -B) * turn(2, -C), eye(4), real, eye(4)


# Other machines, for fixed errors: shifts along X, Y, Z, rotations about X, Y, Z, then offset and twist of the second axis.
SHIFT, ROTATION = ("0.11", "-0.07", "0.05"), ("2e-4", "-3e-4", "1.5e-4")
OFFSET, TWIST, POINT = mpf("0.04"), mpf("-2.5e-4"), (mpf(10), mpf(-20), mpf(120))


def about(point, m):
    return move(*point) * m * move(*[-x for x in point])


def errors():
    return move(*map(mpf, SHIFT)), turn(0, mpf(ROTATION[0])) * turn(1, mpf(ROTATION[1])) * turn(2, mpf(ROTATION[2]))


def table_AC(q, r):
    """A at POINT, and C on it, in the table."""
    shift, rotation = errors()
    A, C = q["first"] * DEG, q["second"] * DEG
    first = about(POINT, turn(0, -A))
    real = shift * about(POINT, rotation) * first * move(0, OFFSET) * turn(1, TWIST) * turn(2, -C)
    return first * turn(2, -C), eye(4), real, eye(4)


def head_CB(q, r):
    """C, and B on it at POINT, in the head."""
    shift, rotation = errors()
    C, B = q["first"] * DEG, q["second"] * DEG
    second = about(POINT, turn(1, B))
    real = shift * rotation * turn(2, C) * move(OFFSET) * about(POINT, turn(0, TWIST)) * second
    return eye(4), turn(2, C) * second, eye(4), real


def one_in_each(q, r):
    """C in the table; B at POINT in the head, where its own place along Z belongs."""
    _, rotation = errors()
    C, B = q["first"] * DEG, q["second"] * DEG
    head = about(POINT, turn(1, B))
    table = move(mpf(SHIFT[0]), mpf(SHIFT[1])) * rotation * turn(2, -C)
    return turn(2, -C), head, table, move(OFFSET, 0, mpf(SHIFT[2])) * about(POINT, turn(0, TWIST)) * head


def displacement(row, machine=paper):
    q = DEFAULTS | row
    r = {k: q[k] / 1000 for k in MRAD}
    theta = q["theta"] * DEG
    x, y = q["radius"] * cos(theta), q["radius"] * sin(theta)
    spot = matrix([q["workpiece_x"] + x, q["workpiece_y"] + y, nominal_height(q, x, y), 1])
    table, head, real_table, real_head = machine(q, r)
    sensor = matrix([0, 0, -q["sensor_length"], 1])
    slides = table * spot - head * sensor
    X, Y, Z = slides[0], slides[1], slides[2]
    there = move(X - r["E_C0Y"] * Y + r["E_B0Z"] * Z, Y - r["E_A0Z"] * Z, Z) * real_head
    to_part = turn(0, -r["e_a"]) * turn(1, -r["e_b"]) * real_table**-1
    to_part = move(-q["workpiece_x"] - q["e_x"], -q["workpiece_y"] - q["e_y"], -q["e_z"]) * to_part
    p, u = to_part * there * sensor, to_part * there * matrix([0, 0, 1, 0])

    def f(t):
        return implicit(q, [p[i] + t * u[i] for i in range(3)])

    step, brackets = mpf("0.05"), []
    for i in range(60):  # 3 mm each way: more than any error here
        for a, b in ((i * step, (i + 1) * step), (-(i + 1) * step, -i * step)):
            if f(a) == 0:
                brackets.append((a, a))
            elif f(a) * f(b) < 0:
                brackets.append((a, b))
        if brackets:
            break
    roots = []
    for a, b in brackets:
        sign = 1 if f(b) > 0 else -1
        for _ in range(140):
            m = (a + b) / 2
            a, b = (a, m) if f(m) * sign > 0 else (m, b)
        roots.append((a + b) / 2)
    t = min(roots, key=abs)
    return q["sensor_zero"] + (1 + q["sensor_gain"]) * t


def draw(chance, surface):
    row = {k: mpf(str(round(chance.uniform(-0.2, 0.2), 4))) for k in LENGTHS[:3] + LENGTHS[5:9] + ["sensor_zero"]}
    row |= {k: mpf(str(round(chance.uniform(-0.5, 0.5), 4))) for k in MRAD}
    row |= dict(surface=mpf(surface), sensor_gain=mpf(str(round(chance.uniform(-0.01, 0.01), 5))),
                sensor_length=mpf(chance.choice([0, 150])), workpiece_x=mpf(str(round(chance.uniform(-80, 80), 3))),
                workpiece_y=mpf(str(round(chance.uniform(-80, 80), 3))), theta=mpf(chance.randrange(0, 360)))
    radius = chance.uniform(60, 75)
    tilt = 0.0  # slope of the surface along the radius
    if surface == 0:
        slope = chance.choice([-0.005, 0.0629, 0.0, -1.0, 0.7, 2.5])
        row |= dict(cone_slope=mpf(str(slope)), cone_height=mpf(str(chance.choice([0, 20]))))
        tilt = slope
    elif surface == 1:
        row |= dict(plane_slope_x=mpf("0.1"), plane_slope_y=mpf("-0.05"), surface_height=mpf(20))
    else:
        hollow = chance.choice([1, -1])
        size = {2: 90, 3: 110, 4: 15}[surface]
        row |= dict(surface_radius=mpf(hollow * size), surface_height=mpf(5), cylinder_azimuth=mpf(chance.randrange(0, 180)))
        if surface == 2:
            radius = chance.uniform(10, 50)
        if surface == 3:
            tilt = -hollow * radius / (size * size - radius * radius) ** 0.5
        if surface == 4:
            row["ring_radius"] = mpf(70)
            off = radius - 70
            tilt = -hollow * off / (size * size - off * off) ** 0.5
    row["radius"] = mpf(str(round(radius, 3)))
    row["B"] = mpf(str(round(float(-atan(mpf(str(tilt))) / DEG) + chance.uniform(-3, 3), 3)))
    row["C"] = mpf(str(round(float(row["theta"]) + chance.uniform(-5, 5), 3)))
    return row


def unit(name):
    return "mm" if name in LENGTHS else "mrad" if name in MRAD else "deg" if name in ANGLES else "1"


if __name__ == "__main__":
    chance = random.Random(1604)
    with (pathlib.Path(__file__).parent / "laser_scan_cases.csv").open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow([f"{n} ({unit(n)})" for n in NAMES] + ["displacement (mm)"])
        for n in range(100):
            row = DEFAULTS | draw(chance, n % 5)
            out.writerow([mp.nstr(row[n], 17, strip_zeros=True).removesuffix(".0") for n in NAMES] + [mp.nstr(displacement(row), 18)])
    for machine, first, second in ((table_AC, "3.5", "-55"), (head_CB, "33", "-3.5"), (one_in_each, "33", "-3.5")):
        for theta in ("35", "210"):
            turned = str(int(theta) - 35)
            at = dict(first=mpf(first), second=mpf(second)) | dict(theta=mpf(theta), cone_slope=mpf("0.0629"), cone_height=mpf(20),
                                                                  workpiece_x=mpf(30), workpiece_y=mpf(-40), sensor_length=mpf(150))
            rotating = "second" if machine is table_AC else "first"
            at[rotating] += mpf(turned)
            print(machine.__name__, theta, mp.nstr(displacement(at, machine), 18))
