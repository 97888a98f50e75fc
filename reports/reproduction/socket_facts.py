"""Wang, Yu, Liao 2013, Table 2: how its angles come out, and the closure that it does not use."""
import csv
import pathlib

import numpy as np
from scipy.optimize import brentq

DATA = pathlib.Path(__file__).resolve().parents[2] / "scenarios" / "data" / "single_socket.csv"
POINT = np.array([-49.275, -14.312, -177.777])  # after the three translations, mm
PRINTED = {"1": ("-0.0426", "0.0684"), "2": ("-0.0161", "0.4514"), "3": ("-0.0128", "-0.2403"), "4": ("-0.0396", "-0.2513")}


def cases():
    for r in csv.DictReader(DATA.open(newline="")):
        yield dict(case=r["case"], alpha=float(r["alpha_deg"]), gamma=float(r["gamma_deg"]), printed=PRINTED[r["case"]],
                   before=np.array([float(r[f"d{a}_before_mm"]) for a in "xyz"]), after=np.array([float(r[f"d{a}_after_mm"]) for a in "xyz"]))


def turned(point, alpha, gamma):
    a, g = np.radians(alpha), np.radians(gamma)
    x, y, z = point
    v = x * np.sin(g) + y * np.cos(g)
    return np.array([x * np.cos(g) - y * np.sin(g), v * np.cos(a) - z * np.sin(a), v * np.sin(a) + z * np.cos(a)])


def closure(case):
    """Length before less length after, mm."""
    return np.linalg.norm(POINT + case["before"]) - np.linalg.norm(turned(POINT, case["alpha"], case["gamma"]) + case["after"])


def as_printed(case):
    """(d_alpha, d_gamma) in deg, the way that gives the printed ones: z errors reversed, x for gamma, then y for alpha, d_alpha reversed."""
    sign = np.array([1, 1, -1])
    before, goal = POINT + sign * case["before"], turned(POINT, case["alpha"], case["gamma"]) + sign * case["after"]
    gamma = brentq(lambda d: (turned(before, 0, case["gamma"] + d) - goal)[0], -3, 3, xtol=1e-12)
    alpha = brentq(lambda d: (turned(before, case["alpha"] + d, case["gamma"] + gamma) - goal)[1], -3, 3, xtol=1e-12)
    return -alpha, gamma
