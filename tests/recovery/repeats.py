"""Readings of an axis whose conditions come back in every cycle: what repeats, what drifts, what scatters, and one cycle
or one reading that differs from the others. The true scatter of a reading is 1 um."""
import random

import axis

CYCLES, POSITIONS, PITCH, STEP = 5, 9, 50.0, 20  # mm, s


def walk(seed, size, rho):
    """A pattern over the places of a cycle that looks like noise of serial correlation rho."""
    chance = random.Random(f"walk {seed}")
    out = [chance.gauss(0, size)]
    while len(out) < 2 * POSITIONS:
        out.append(rho * out[-1] + (1 - rho * rho) ** 0.5 * chance.gauss(0, size))
    return out


# What is missing, in um, by cycle c (from 0), place k in the cycle, position p, its coordinate x, direction d, time t.
MISSING = {
    "nothing": lambda c, k, p, x, d, t, w: 0,
    "alternating_reversal": lambda c, k, p, x, d, t, w: 10 * d * (-1) ** p,
    "correlated_pattern": lambda c, k, p, x, d, t, w: w[k],
    "drift_by_position": lambda c, k, p, x, d, t, w: 2e-5 * t * x,
    "first_cycle_shifted": lambda c, k, p, x, d, t, w: 8 if c == 0 else 0,
    "third_cycle_noisy": lambda c, k, p, x, d, t, w: 0,
    "one_bad": lambda c, k, p, x, d, t, w: 30 if (c, k) == (2, 7) else 0,
    "last_cycle_tilted": lambda c, k, p, x, d, t, w: 0.05 * x if c == CYCLES - 1 else 0,
}


def rows(missing, seed=1, cycles=CYCLES):
    """Rows of r.csv with their header."""
    chance = random.Random(f"{missing} {seed}")
    pattern = walk(seed, 3, 0.9)
    out, t = [("cycle", "x", "direction", "t", "T", "d")], 0
    for c in range(cycles):
        for k, p in enumerate((*range(POSITIONS), *reversed(range(POSITIONS)))):
            d, x = (1 if k < POSITIONS else -1), PITCH * p
            noise = 6 if missing == "third_cycle_noisy" and c == 2 else 1
            out.append((c + 1, x, d, t, 20 + 1e-3 * t, 2 + MISSING[missing](c, k, p, x, d, t, pattern) + chance.gauss(0, noise)))
            t += STEP
    return out


def write(folder, missing, seed=1, declared=True, cycles=CYCLES, draws=99):
    (folder / "r.csv").write_text("".join(",".join(map(str, row)) + "\n" for row in rows(missing, seed, cycles)))
    (folder / "s.toml").write_text(axis.scenario(declared, draws))


def write_unrecorded(folder, seed=1, declared=True, draws=99, sides=1):
    """Two runs through the positions in each cycle (on each of the sides), told apart by labels only; what reads 3 um more
    in one reads 3 um less in the other, and so from position to position and from side to side."""
    lines = ["cycle,run,side,x,direction,t,T,d"]
    chance = random.Random(f"unrecorded {seed}")
    for c in range(6):
        for side in range(1, sides + 1):
            for run in (1, 2):
                for p in range(POSITIONS):
                    d = 2 + 3 * (-1) ** (run + p + side) + chance.gauss(0, 1)
                    lines.append(f"{c + 1},{run},{side},{PITCH * p},1,{STEP * len(lines)},{20 + 1e-3 * len(lines)},{d}")
    labels = '{ cycle = "cycle", run = "run"' + (', side = "side"' if sides > 1 else "") + " }"
    (folder / "r.csv").write_text("\n".join(lines) + "\n")
    (folder / "s.toml").write_text(axis.scenario(declared, draws).replace('{ cycle = "cycle" }', labels))


def write_turning_slope(folder, seed=1):
    """Eight days of three clampings, which scatter by 5 um, and a slope that the last two days have with the other sign."""
    chance = random.Random(f"turning {seed}")
    lines = ["day,clamp,x,d"]
    for day in range(1, 9):
        for clamp in "abc":
            offset = chance.gauss(0, 5)
            for x in range(0, 600, 100):
                lines.append(f"{day},{clamp},{x},{offset + (0.01 if day < 7 else -0.01) * x + chance.gauss(0, 1)}")
    (folder / "r.csv").write_text("\n".join(lines) + "\n")
    (folder / "s.toml").write_text("""schema = 1
[model]
name = "expression"
[model.indications]
d = "offset + 0 * x"
[conditions]
x = "0 mm"
[quantities]
offset = { estimated = true, value = "0 um" }
[indications.d]
components = [ { u = "1 um", per = "reading" } ]
[indications.d.readings]
file = "r.csv"
column = "d"
unit = "um"
labels = { day = "day", clamp = "clamp" }
conditions = { x = { column = "x", unit = "mm" } }
[trace]
blocks = "day"
final = ["7", "8"]
redone = [["day", "clamp"]]
draws = 99
""")
