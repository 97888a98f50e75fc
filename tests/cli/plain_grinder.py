"""A calibration of the belt grinder with an effect that its scenario does not declare, by plain 4 x 4 matrices,
independent of the engine; writes the data of trace_sphere.toml.

usage: plain_grinder.py > scenarios/data/trace_sphere.csv
"""
import math
import random
import sys

from plain_machine import DEG, closing, side

ARCSEC = DEG / 3600
MACHINE = {  # m and rad, signs of the engine's model; links and artefact are the model's defaults
    "probe_x": 85.557e-3, "probe_y": 287.435e-3, "probe_z": 454.220e-3,
    "E_X0B": -0.417e-3, "E_Z0B": 0.532e-3, "E_A0B": -0.2669 * DEG, "E_C0B": -0.1839 * DEG,
    "E_X0C": 0.230e-3, "E_Y0C": 0.367e-3, "E_A0C": 0.0434 * DEG, "E_B0C": 0.0121 * DEG,
}
SQUARENESS = {"S_XY": 5e-6, "S_XZ": -3e-6, "S_YZ": 2e-6}
ECCENTRICITY = 8 * ARCSEC  # of the encoder of C: its graduation stands off its bearing towards 35 deg
TOWARDS = 35 * DEG
NOISE = 1.5e-6             # of every recorded command
PASSES, SECONDS = 8, 40    # each pass touches every pose, forth or back
POSES = [(0, c) for c in range(-90, 181, 15)] + [(b, 90) for b in range(-20, 46, 5)]
SIDES = (side("X", ("A", None, 1), workpiece=True),
         side("Y", "Z", ("B", (-120e-3, 0.0, -110e-3)), ("C", (50e-3, 180e-3, 0.0))))


def commands(b, c, eccentricity=0.0, squareness=None):
    """X, Y, Z at which the tip stands above the sphere, m; b and c in deg."""
    values = {"sphere_x": -184.183e-3, "contact_z": 15.5e-3, "probe_x": MACHINE["probe_x"],
              "probe_y": -MACHINE["probe_y"], "probe_z": -MACHINE["probe_z"],
              **{k: v for k, v in MACHINE.items() if k.startswith("E_")}, "E_Z0B": -MACHINE["E_Z0B"],
              "E_CC": eccentricity * math.sin(c * DEG - TOWARDS)}
    angles = {"A": 0.0, "B": b * DEG, "C": c * DEG}
    x, y, z = closing(*SIDES, angles, values)
    if squareness:  # of the commands without positioning errors
        _, y0, z0 = closing(*SIDES, angles, {**values, "E_CC": 0.0})
        x += squareness["S_XZ"] * z0 - squareness["S_XY"] * y0
        y -= squareness["S_YZ"] * z0
    return x, y, z


if __name__ == "__main__":
    if "-h" in sys.argv:
        sys.exit(print(__doc__))
    draw = random.Random(6)
    true = {pose: commands(*pose, ECCENTRICITY, SQUARENESS) for pose in POSES}
    print("pass,pose,time_s,B_deg,C_deg,B_direction,C_direction,X_mm,Y_mm,Z_mm")
    time, at, came = 0, [0, -90], [1, 1]  # B, C: where they stand and from which side they came
    for n in range(PASSES):
        for i, pose in list(enumerate(POSES))[::1 if n % 2 == 0 else -1]:
            time += SECONDS
            came = [old if here == there else 1 if there > here else -1 for here, there, old in zip(at, pose, came)]
            at = pose
            read = (f"{1e3 * (v + draw.gauss(0, NOISE)):.4f}" for v in true[pose])
            print(n + 1, i + 1, time, *pose, *came, *read, sep=",")
