"""The mills of Fang 2022, chapter 3, and calls of the `gumshoe` program about them. Lengths mm, angles deg."""

import csv
import io
import pathlib
import subprocess
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PROGRAM = ROOT / "build" / "release" / "gumshoe"

# Table 3.1. Whatever is left out has the model's default.
EXAMPLE_1 = {"tool_radius (mm)": 10, "insert_radius (mm)": 6, "insert_thickness (mm)": 3.97, "clearance_angle (deg)": 15,
             "insert_radial_angle (deg)": -8, "insert_axial_angle (deg)": -5, "inserts (1)": 2, "holder_angle (deg)": 0,
             "offset (mm)": 4, "beam_radius (mm)": 0.2, "wear_1 (mm)": 0, "wear_2 (mm)": 0, "wear_3 (mm)": 0,
             "spindle_speed (rpm)": 1000, "feed (mm/min)": 30, "start_height (mm)": 0}
EXAMPLE_2 = {**EXAMPLE_1, "wear_2 (mm)": 0.005}
# Table 3.2, which gives neither offset nor beam radius: d = r - R, as in Table 3.1.
EXAMPLE_3 = {**EXAMPLE_1, "tool_radius (mm)": 12, "insert_radius (mm)": 5, "inserts (1)": 3, "offset (mm)": 7,
             "wear_2 (mm)": 0.006, "wear_3 (mm)": 0.010, "spindle_speed (rpm)": 500}
# Tables 3.3 and 3.4, one flute worn.
EXPERIMENT = {**EXAMPLE_1, "insert_radius (mm)": 5, "insert_thickness (mm)": 3.2, "insert_radial_angle (deg)": -12,
              "insert_axial_angle (deg)": 6, "holder_angle (deg)": 140, "offset (mm)": 4.9, "wear_2 (mm)": 0.002,
              "start_height (mm)": 5}
EXPERIMENT_LENGTH = 176.641


def heights(points):
    """Trigger heights in mm; every point has to be solved."""
    columns = list(points[0])
    with tempfile.NamedTemporaryFile("w", suffix=".csv", newline="") as table:
        writer = csv.DictWriter(table, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(points)
        table.flush()
        done = subprocess.run([str(PROGRAM), "evaluate", "tool_length", "--table", table.name],
                              stdout=subprocess.PIPE, text=True, check=True)
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    if len(rows) != len(points):
        raise SystemExit(f"{len(points)} points gave {len(rows)} rows")
    failed = [row for row in rows if row["status"] != "ok"]
    if failed:
        raise SystemExit(f"not solved: {failed[0]}")
    return np.array([float(row["trigger_height (mm)"]) for row in rows])


def curve(tool, angles, **changes):
    """Trigger heights in mm over start angles."""
    base = {**tool, **{column(name): value for name, value in changes.items()}, "spindle_z (mm)": 0}
    return heights([{**base, "start_angle (deg)": repr(float(a))} for a in angles])


UNITS = {"feed": "mm/min", "spindle_speed": "rpm", "inserts": "1"}


def column(name):
    unit = UNITS.get(name) or ("deg" if name.endswith("angle") else "mm")
    return f"{name} ({unit})"


def flutes(tool, angles, **changes):
    """Which flute triggers, from 1: the one whose height moves when it alone is raised by 1 nm."""
    z = curve(tool, angles, **changes)
    which = np.zeros(len(z), int)
    for k in range(1, int(tool["inserts (1)"]) + 1):
        moved = curve(tool, angles, **{**changes, f"wear_{k}": tool[f"wear_{k} (mm)"] + 1e-6})
        which[np.abs(moved - z) > 1e-9] = k
    return z, which


def per_turn(tool, **changes):
    """Descent per turn v / N_s, mm."""
    t = {**tool, **{column(name): value for name, value in changes.items()}}
    return t["feed (mm/min)"] / t["spindle_speed (rpm)"]


def extremes(tool, step=0.5, **changes):
    """Local maxima and minima over the start angle: two lists of (angle, height, flute). Located to 1e-5 deg: behind a
    maximum the curve may fall by a jump, so points are laid ever closer around the extreme one."""
    angles = np.arange(0, 360, step)
    z, which = flutes(tool, angles, **changes)
    found = []
    for sign in (1, -1):
        y = sign * z
        at = np.flatnonzero((y > np.roll(y, 1)) & (y >= np.roll(y, -1)))
        found.append([])
        for i in at:
            middle, half = angles[i], step
            while half > 5e-6:
                grid = np.linspace(middle - half, middle + half, 21)
                values = curve(tool, grid, **changes)
                middle, half = grid[int(np.argmax(sign * values))], half / 10
            found[-1].append((middle % 360, sign * np.max(sign * values), int(which[i])))
    return found
