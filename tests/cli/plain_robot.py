"""A robot with a tracker by plain 4 x 4 matrices and virtual work, independent of the engine; writes the data of
serial_chain.toml.

usage: plain_robot.py > scenarios/data/robot_tracker.csv
"""
import csv
import io
import math
import random
import sys

import numpy as np

DEG = math.pi / 180

# Universal Robots, "DH parameters for calculations of kinematics and dynamics", UR5e: (a, alpha, d, theta) in m and rad,
# mass in kg, centre of mass in m.
UR5E = ((0, math.pi / 2, 0.1625, 0), (-0.425, 0, 0, 0), (-0.3922, 0, 0, 0), (0, math.pi / 2, 0.1333, 0),
        (0, -math.pi / 2, 0.0997, 0), (0, 0, 0.0996, 0))
UR5E_MASSES = ((3.761, (0, -0.02561, 0.00193)), (8.058, (0.2125, 0, 0.11336)), (2.846, (0.15, 0, 0.0265)),
               (1.37, (0, -0.0018, 0.01634)), (1.3, (0, 0.0018, 0.01634)), (0.365, (0, 0, -0.001159)))
GRAVITY = 9.80665  # m/s2


def turn(axis, angle):
    m = np.eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    m[i, i] = m[j, j] = math.cos(angle)
    m[i, j], m[j, i] = -math.sin(angle), math.sin(angle)
    return m


def shift(x=0.0, y=0.0, z=0.0):
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


class Robot:
    """Links with errors, by name as in a scenario and in SI: delta_a_J2, scale_J1, compliance_J2, ..."""

    def __init__(self, links, masses=(), errors=None, modified=False, target=(0.0, 0.0, 0.0)):
        self.links, self.masses, self.errors, self.modified, self.target = links, masses, errors or {}, modified, target

    def error(self, name, joint):
        return self.errors.get(f"{name}_J{joint + 1}", 0.0)

    def frames(self, angles):
        """Of each link, from the base; angles as they are."""
        pose, out = np.eye(4), []
        for j, (a, alpha, d, theta) in enumerate(self.links):
            a, alpha, d, theta = (x + self.error("delta_" + n, j) for n, x in zip(("a", "alpha", "d", "theta"), (a, alpha, d, theta)))
            across = turn(0, alpha) @ turn(1, self.error("delta_beta", j))
            along = turn(2, theta + angles[j]) @ shift(z=d)
            pose = pose @ (shift(a) @ across @ along if self.modified else along @ shift(a) @ across)
            out.append(pose)
        return out

    def potential(self, angles, payload):
        frames = self.frames(angles)
        weights = [(m, f @ np.array([*centre, 1])) for (m, centre), f in zip(self.masses, frames)]
        weights.append((payload, frames[-1] @ np.array([*self.target, 1])))
        return sum(m * GRAVITY * at[2] for m, at in weights)

    def place(self, commands, payload=0.0):
        """Of the target from the base, m; commands in rad, payload in kg."""
        angles = [c * (1 + self.error("scale", j)) + self.error("cosine", j) * math.cos(c) + self.error("sine", j) * math.sin(c)
                  for j, c in enumerate(commands)]
        twists = []
        for j in range(len(angles)):  # the torque is the loss of potential energy per angle
            step = np.eye(len(angles))[j] * 1e-5
            torque = -(self.potential(angles + step, payload) - self.potential(angles - step, payload)) / 2e-5
            twists.append(self.error("compliance", j) * torque)
        return (self.frames(np.array(angles) + twists)[-1] @ np.array([*self.target, 1]))[:3]


def instrument(x, y, z, a, b, c):
    """Pose of the base in the frame of the instrument; m and rad."""
    return shift(x, y, z) @ turn(0, a) @ turn(1, b) @ turn(2, c)


def table(robot, pose, seed, count=60, noise=20e-6, payloads=(0.0,)):
    """CSV of points at random commands; a column of payloads where there are several."""
    chance, out = random.Random(seed), io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow([*(f"j{j + 1}_deg" for j in range(len(robot.links))), *(["payload_kg"] if len(payloads) > 1 else []), "x_mm", "y_mm", "z_mm"])
    for i in range(count):
        commands = [round(chance.uniform(-150, 150), 2) for _ in robot.links]
        commands[1] = round(chance.uniform(-150, -30), 2)  # above the floor
        payload = payloads[i % len(payloads)]
        at = pose @ np.array([*robot.place([c * DEG for c in commands], payload), 1])
        rows.writerow([*commands, *([payload] if len(payloads) > 1 else []), *(f"{1e3 * (x + chance.gauss(0, noise)):.4f}" for x in at[:3])])
    return out.getvalue()


# Actual minus design of the shipped data; no joint sees all of them alone.
TRUTH = {"delta_a_J1": 0.11e-3, "delta_alpha_J1": 0.02 * DEG, "delta_a_J2": -0.24e-3, "delta_alpha_J2": -0.03 * DEG,
         "delta_theta_J2": 0.15 * DEG, "delta_beta_J2": 0.02 * DEG, "delta_a_J3": 0.31e-3, "delta_alpha_J3": 0.04 * DEG,
         "delta_theta_J3": -0.21 * DEG, "delta_beta_J3": -0.015 * DEG, "delta_alpha_J4": -0.05 * DEG,
         "delta_theta_J4": 0.12 * DEG, "delta_a_J5": 0.09e-3, "delta_alpha_J5": 0.03 * DEG, "delta_d_J5": -0.12e-3,
         "delta_theta_J5": -0.1 * DEG, "compliance_J2": 15e-6}
POSE = instrument(2.1, -0.4, 0.35, 1 * DEG, -2 * DEG, 118 * DEG)

if __name__ == "__main__":
    sys.stdout.write(table(Robot(UR5E, UR5E_MASSES, TRUTH, target=(0.02, -0.01, 0.06)), POSE, seed=1))
