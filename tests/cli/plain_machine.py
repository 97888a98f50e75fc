"""A machine's chain by plain 4 x 4 matrices, independent of the engine; writes the data of machine_five_axis.toml.

usage: plain_machine.py > scenarios/data/table_sphere.csv
"""
import math
import random
import sys

import numpy as np

DEG = math.pi / 180
LETTERS = "XYZ"


def shift(v):
    m = np.eye(4)
    m[:3, 3] = v
    return m


def turn(line, angle):
    """About a line through the origin: Rodrigues, with the matrix of the cross product squared."""
    x, y, z = line
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    m = np.eye(4)
    m[:3, :3] += math.sin(angle) * k + (1 - math.cos(angle)) * k @ k
    return m


def motion(axis, command, errors):
    """One axis as (name, sense, point); its errors by ISO name; m and rad."""
    name, sense, point = axis
    rotary = name[0] in "ABC"
    d = ("ABC" if rotary else "XYZUVW").index(name[0]) % 3
    def error(kind):
        return errors.get(f"E_{kind}{name}", 0.0)
    tan = {letter: math.tan(error(letter + "0")) for letter in "ABC" if letter != "ABC"[d]}
    line = np.array([[1, tan.get("C", 0), -tan.get("B", 0)], [-tan.get("C", 0), 1, tan.get("A", 0)],
                     [tan.get("B", 0), -tan.get("A", 0), 1]][d], float)
    line /= np.linalg.norm(line)
    tilt = np.eye(4)
    for i in range(3):
        if not (rotary and i == d):
            tilt = tilt @ turn(np.eye(3)[i], error("ABC"[i]))
    moved = shift([error(letter) for letter in LETTERS])
    if rotary:
        at = np.array(point) + [error(letter + "0") if i != d else 0 for i, letter in enumerate(LETTERS)]
        own = sense * command + error("ABC"[d] + "0") + error("ABC"[d])
        return moved @ shift(at) @ tilt @ turn(line, own) @ shift(-at)
    own = sense * command + error(LETTERS[d] + "0")
    return moved @ shift(own * line) @ shift(point) @ tilt @ shift(-np.array(point))


def gap(workpiece_side, tool_side, commands, values):
    """Tip minus sphere in the frame of the bed, and bed_from_workpiece."""
    sides = []
    for axes in (workpiece_side, tool_side):
        pose = np.eye(4)
        for axis in axes:
            pose = pose @ motion(axis, commands[axis[0]], values)
        sides.append(pose)
    def point(name):
        return np.array([values.get(f"{name}_{c}", 0.0) for c in "xyz"] + [1.0])
    tip, sphere = sides[1] @ point("probe"), sides[0] @ point("sphere")
    return (tip - sphere)[:3] - point("contact")[:3], sides[0]


def place(workpiece_side, tool_side, commands, values):
    """The tip from the workpiece's frame."""
    tip, bed_from_workpiece = gap(workpiece_side, tool_side, commands, {k: v for k, v in values.items() if k[:6] not in ("sphere", "contac")})
    return bed_from_workpiece[:3, :3].T @ tip


def closing(workpiece_side, tool_side, angles, values, slides="XYZ"):
    """Commands of the slides that close the gap: linear equations by differences over 1 m, solved twice."""
    commands = {**angles, **{s: 0.0 for s in slides}}
    for _ in range(2):
        at, _ = gap(workpiece_side, tool_side, commands, values)
        columns = [gap(workpiece_side, tool_side, {**commands, s: commands[s] + 1}, values)[0] - at for s in slides]
        for s, step in zip(slides, np.linalg.solve(np.array(columns).T, -at)):
            commands[s] += step
    return [commands[s] for s in slides]


def side(*axes, workpiece=False):
    """("X", point=None, sense=None) tuples filled up by ISO 841."""
    out = []
    for axis in axes:
        name, point, sense = (*axis, *(None, None)[: 3 - len(axis)]) if isinstance(axis, tuple) else (axis, None, None)
        out.append((name, sense or (-1 if workpiece else 1), point or (0.0, 0.0, 0.0)))
    return out


TRUTH = {  # m and rad
    "probe_z": -0.15, "sphere_x": 0.12003, "sphere_y": 0.03996, "sphere_z": 0.06005,
    "E_Y0A": 20e-6, "E_Z0A": -15e-6, "E_B0A": 0.003 * DEG, "E_C0A": -0.002 * DEG,
    "E_X0C": 12e-6, "E_Y0C": -8e-6, "E_A0C": 0.004 * DEG, "E_B0C": -0.0025 * DEG,
    "E_C0Y": 20e-6, "E_B0Z": -15e-6, "E_A0Z": 10e-6,
}
POSES = [(a, c) for a in (-60, -30, 0, 30, 60, 90) for c in (0, 60, 120, 180, 240, 300)]

if __name__ == "__main__":
    if "-h" in sys.argv:
        sys.exit(print(__doc__))
    draw = random.Random(5)
    print("A_deg,C_deg,X_mm,Y_mm,Z_mm")
    for a, c in POSES:
        xyz = closing(side("A", "C", workpiece=True), side("X", "Y", "Z"), {"A": a * DEG, "C": c * DEG}, TRUTH)
        print(a, c, *(f"{1e3 * v + draw.gauss(0, 1e-3):.4f}" for v in xyz), sep=",")
