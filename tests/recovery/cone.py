#!/usr/bin/python3
"""Readings of a laser displacement sensor on a cone, in the geometry of Ibaraki et al. 2018, section 4, made up.

    cone.py constant | shift > CSV

Six circles on two conical surfaces, 290 deg each, in set-up 1 (part on the axis of C) and two hours later in set-up 2
(part beside it). `constant`: the sensor's zero moved by 13.7 um between the set-ups. `shift`: the part lies (0.2, -0.2)
mm off in set-up 2, the cause that the paper names. Plain 4 x 4 matrices and a Newton iteration, apart from the model
laser_scan, which a test holds against them.
"""
import sys

import numpy as np

SLOPE = {"A": -0.005, "B": np.tan(np.radians(3.6))}
TILT = {"A": 0.28, "B": -3.6}  # commanded B, deg
LINES = [("A", 71.0), ("A", 70.5), ("A", 70.0), ("B", 68.5), ("B", 66.5), ("B", 64.5)]  # radius, mm
CENTRE = {1: (0.0, 0.0), 2: (75.453, -77.898)}  # of the part on the table, mm
HEIGHT, RADIUS = 20.0, 70.0  # of the surfaces above the table at this radius, mm; the paper does not print it
ANGLES = np.arange(5, 290, 20.0)
START, LINE_TIME = {1: 0.0, 2: 7200.0}, 40.0  # s
NOISE = 2.4 / np.sqrt(2)  # um: differences of two scatter by 2.4 um, as the paper's do
FORM = [(2, 3.0, 20.0), (3, 2.5, 75.0), (5, 1.0, 140.0)]  # harmonic, um, deg: 11 um from peak to valley
# R-test of the paper: mm and rad. Its alpha_CR, beta_CR are not in its Table 1; taken for alpha_CB and beta_BR.
MACHINE = dict(dx_BR=6.3e-3, dy_BR=2.8e-3, dz_BR=10.7e-3, dx_CB=2.4e-3, alpha_BR=0.0, beta_BR=19.6e-6, gamma_BR=0.0, alpha_CB=20e-6)
NAMES = dict(dx_BR="E_X0B", dy_BR="E_Y0C", dz_BR="E_Z0B", dx_CB="E_X0C_minus_E_X0B", alpha_BR="E_A0B", beta_BR="E_B0B", gamma_BR="E_C0B",
             alpha_CB="E_A0C_minus_E_A0B", zero="sensor_zero")  # of the model laser_scan
NONE = dict(e_x=0.0, e_y=0.0, e_z=0.0, e_a=0.0, e_b=0.0, zero=0.0, growth=0.0)
TRUTH = {"constant": (11, dict(zero=13.7e-3)), "shift": (12, dict(e_x=0.2, e_y=-0.2))}  # seed; set-up 2, mm


def move(x=0.0, y=0.0, z=0.0):
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


def turn(axis, angle):
    m, (i, j) = np.eye(4), {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    c, s = np.cos(angle), np.sin(angle)
    m[i, i], m[i, j], m[j, i], m[j, j] = c, -s, s, c
    return m


def displacement(surface, radius, C, setup, errors, centred=True):
    """By how much nearer to the sensor the surface is than commanded, mm; C in rad. Without `centred` the cone stays at
    the table's centre, as equation (11) of the paper has it."""
    e = {**MACHINE, **NONE, **errors}
    B, m0, (cx, cy) = np.radians(TILT[surface]), SLOPE[surface], CENTRE[setup]
    z = HEIGHT + m0 * (radius - RADIUS)
    commanded = turn("y", -B) @ turn("z", -C) @ [radius * np.cos(C) + cx, radius * np.sin(C) + cy, z, 1]
    machine_from_table = (move(e["dx_BR"], e["dy_BR"], e["dz_BR"]) @ turn("x", e["alpha_BR"]) @ turn("y", e["beta_BR"]) @ turn("z", e["gamma_BR"])
                          @ turn("y", -B) @ move(e["dx_CB"]) @ turn("x", e["alpha_CB"]) @ turn("z", -C))
    to_part = move(-cx, -cy) @ turn("x", -e["e_a"]) @ turn("y", -e["e_b"]) @ np.linalg.inv(machine_from_table)  # tilts about the table's origin
    spot, beam = to_part @ commanded, to_part @ [0, 0, 1, 0]
    off = np.array([e["e_x"], e["e_y"]]) - (0 if centred else np.array([cx, cy]))
    d = 0.0
    for _ in range(50):
        x, y, height = (spot + d * beam)[:3]
        at = np.array([x, y]) - off
        rho = np.hypot(*at)
        gap = height - e["e_z"] - HEIGHT - m0 * (rho - RADIUS)
        step = gap / (beam[2] - m0 * (at @ beam[:2]) / rho)
        d -= step
        if abs(step) < 1e-13:
            break
    return d + e["zero"] + e["growth"]


def profile(setup, errors, centred=True, angles=ANGLES):
    """[line][angle], mm, of the change that these errors make in addition to those of the machine."""
    return np.array([[displacement(s, r, np.radians(a), setup, errors, centred) - displacement(s, r, np.radians(a), setup, {}, centred)
                      for a in angles] for s, r in LINES])


def readings(case):
    seed, errors = TRUTH[case]
    chance = np.random.default_rng(seed)
    rows = []
    for setup in (1, 2):
        for line, (surface, radius) in enumerate(LINES, 1):
            for i, angle in enumerate(ANGLES):
                d = displacement(surface, radius, np.radians(angle), setup, errors if setup == 2 else {})
                form = sum(a * np.cos(n * np.radians(angle) - np.radians(p)) for n, a, p in FORM)
                rows.append((setup, surface, line, f"{line}:{angle:g}", START[setup] + LINE_TIME * (line - 1 + i / len(ANGLES)), TILT[surface], angle,
                             radius, *CENTRE[setup], 1e3 * d + form + NOISE * chance.standard_normal()))
    return rows


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in TRUTH:
        sys.exit(__doc__)
    print("setup,surface,line,point,time_s,B_deg,C_deg,r_mm,cx_mm,cy_mm,d_um")
    for *head, time, B, C, r, cx, cy, d in readings(sys.argv[1]):
        print(",".join(map(str, head)), f"{time:.1f},{B:g},{C:g},{r:g},{cx:g},{cy:g},{d:.2f}", sep=",")
