"""Readings of an axis against a laser, with the traits of real data: positions repeated in both directions over cycles,
slow temperature, and one thing that the straight line of the scenario lacks."""
import math
import random

CYCLES, POSITIONS, PITCH = 6, 9, 50.0  # mm
TABLE = (0, 4, -3, 2, 5, -2, 1, 3, 0)  # um


def scenario(declared, draws=99):
    noise = 'components = [ { u = "1 um", per = "reading" } ]' if declared else ""
    return f"""# Question: what does a straight line lack?
schema = 1
title = "axis against a laser"
[model]
name = "expression"
[model.indications]
d = "gain * x + offset"
[conditions]
x = "0 mm"
direction = 1
[quantities]
gain = {{ estimated = true, value = 0, unit = "um/m" }}
offset = {{ estimated = true, value = "0 um" }}
[indications.d]
{noise}
[indications.d.readings]
file = "r.csv"
column = "d"
unit = "um"
labels = {{ cycle = "cycle" }}
conditions = {{ x = {{ column = "x", unit = "mm" }}, direction = {{ column = "direction", unit = "1" }} }}
[trace]
blocks = "cycle"
order = "t"
draws = {draws}
[trace.columns]
t = {{ column = "t", unit = "s" }}
T = {{ column = "T", unit = "degC" }}
"""


# The model of an axis itself, whose reversal is in the catalogue; columns cycle, x, direction and d.
LINEAR_AXIS = """schema = 1
[model]
name = "linear_axis"
[data]
file = "r.csv"
labels = { cycle = "cycle" }
units = { x = "mm", d = "um" }
conditions = { position = "x", direction = "direction" }
[quantities]
offset = { estimated = true, value = "0 um" }
[indications.deviation]
readings = "d"
[trace]
blocks = "cycle"
"""


# What is missing, in um, at place p (mm, number), direction d, time t (s), temperature T (degC).
MISSING = {
    "nothing": lambda x, p, d, t, T: 0,
    "reversal": lambda x, p, d, t, T: 3 * d,
    "alternating_reversal": lambda x, p, d, t, T: 5 * d * (-1) ** p,
    "table": lambda x, p, d, t, T: TABLE[p],
    "table_and_reversal": lambda x, p, d, t, T: TABLE[p] + 2 * d,
    "drift_by_position": lambda x, p, d, t, T: 2e-5 * t * x,
    "first_cycle": lambda x, p, d, t, T: 6 * math.exp(-t / 200),
    "periodic": lambda x, p, d, t, T: 4 * math.sin(2 * math.pi * x / 170),
    "temperature": lambda x, p, d, t, T: 3 * (T - 20),
    "cycles": lambda x, p, d, t, T: (3, -2, 1, -3, 2, -1)[int(t // 360)],  # each 18 readings long
}
# The noise, in um: plain, of which one reading is bad, read in coarse steps, larger at the far end.
NOISE = ("plain", "one_bad", "coarse", "unequal")


def rows(missing, seed, noise="plain"):
    """Rows of r.csv with their header."""
    chance = random.Random(f"{missing} {noise} {seed}")
    out, t = [("cycle", "x", "direction", "t", "T", "d")], 0
    bad = (chance.randint(1, 4), chance.choice((1, -1)), chance.randrange(POSITIONS))
    for cycle in range(1, CYCLES + 1):
        for direction in (1, -1):
            for p in range(POSITIONS)[::direction]:
                x, T = PITCH * p, 20 + 1.5 * math.sin(t / 900) + 0.3 * cycle
                d = 2 + MISSING[missing](x, p, direction, t, T)
                d += chance.gauss(0, 0.5 + x / 200 if noise == "unequal" else 1)
                d += 25 if noise == "one_bad" and (cycle, direction, p) == bad else 0
                out.append((cycle, x, direction, t, T, 2 * round(d / 2) if noise == "coarse" else d))
                t += 20
    return out


def write(folder, missing, seed, noise="plain", declared=True):
    (folder / "r.csv").write_text("".join(",".join(map(str, row)) + "\n" for row in rows(missing, seed, noise)))
    (folder / "s.toml").write_text(scenario(declared))
