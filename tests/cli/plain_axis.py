"""Writes scenarios/data/linear_axis.csv: a made-up positioning test of a linear axis, apart from the engine.

Deviation = actual minus commanded position, um: a bowed table by position, a reversal that grows with position, a scale
that drifts with time, normal noise. Five cycles of ten targets, up and then down. Run it to print the file.
"""
import math
import random

NOISE_UM = 0.15
SEED = 1


def deviation(x_mm, direction, time_min):
    """What a reading is without noise, um."""
    x = x_mm / 1000
    table = 1.2 + 6 * x + 4 * math.sin(2.6 * math.pi * x) * (1 - 0.4 * x)
    reversal = 0.8 + 2.4 * x
    drift = 0.09 * x * time_min
    return table + direction * reversal / 2 + drift


def readings(cycles=5, seed=SEED):
    """Rows: cycle, target (mm), direction, time (min), deviation (um). Targets are uneven, so that none falls in step
    with a screw."""
    draw = random.Random(seed)
    targets = [round(100 * i + draw.uniform(-8, 8), 1) for i in range(10)]
    time = 0.0
    for cycle in range(1, cycles + 1):
        for direction in (1, -1):
            for x in targets[::direction]:
                yield cycle, x, direction, time, deviation(x, direction, time) + draw.gauss(0, NOISE_UM)
                time += 0.5


def table(rows):
    lines = ["cycle,x_mm,direction,time_min,deviation_um"]
    return "\n".join(lines + [f"{c},{x},{s},{t:.1f},{d:.2f}" for c, x, s, t, d in rows]) + "\n"


if __name__ == "__main__":
    print(table(readings()), end="")
