"""A linear axis against a laser: positions come back in both directions, cycle after cycle, while the room's temperature
wanders. A straight line and a declared sag are fitted; `gumshoe` sees the model as an expression."""
import numpy as np

import by_formula
import shapes
from design import Cell, Design, hold_out, room_temperature

MODEL = "positioning"
PITCH = 43.0  # mm


def design(rng, blocks=6, positions=9, offsets=False, first=0.0, **more):
    """@param offsets: each cycle has an offset of its own; @param first: um, declared u of what fades in the first minutes"""
    rows, t = [], 0.0
    for cycle in range(1, blocks + 1):
        for direction in (1.0, -1.0):
            for p in np.arange(positions)[::int(direction)]:
                rows.append((str(cycle), PITCH * p, direction, t))
                t += 20.0
        t += 60.0
    cycle, x, direction, time = map(np.array, zip(*rows))
    room = room_temperature(rng, time)
    free = dict(free=True, step=0.01)
    cells = [Cell("gain", "um/m", 0.0, free=True, step=1.0), Cell("sag", "um/m2", 5.0, 3.0)]
    cells += [Cell("offset", "mm", 0.0, label="cycle", level=str(c), **free) for c in range(1, blocks + 1)] if offsets else [
        Cell("offset", "mm", 0.0, **free)]
    if first:
        cells += [Cell("fading", "um", 0.0, first), Cell("fade", "s", 200.0)]
    return Design(MODEL, {"cycle": cycle}, {"x": (x, "mm"), "direction": (direction, "1"), "time": (time, "s"),
                                            "screw": (36.0 * x % 360, "deg")},
                  {"warmth": ((room - 20).round(2), "K")}, cells, "cycle", hold_out(rng, blocks), (("cycle",),), **{"noise": 1.0, **more})


def simulate(program, d, vectors, extra=()):
    x, t = d.value("x") / 1e3, d.time
    one = lambda q: q["gain", "um/m"] * x + q["sag", "um/m2"] * x**2 + 1e3 * q["offset", "mm"] + q.get(("fading", "um"), 0) * np.exp(-t / 200)
    return np.array([one(d.gather(v)) for v in vectors])[..., None]


def place(d):
    return np.rint(d.value("x") / PITCH).astype(int)


def table(both):
    """Any value at each position, or at each position and direction."""
    def of(d, rng):
        row = place(d) + (d.value("direction") > 0) * (place(d).max() + 1) * both
        x = d.value("x")
        return by_formula.without([x**0, x, x**2, *(c[2](d) for c in CANDIDATES.values())], rng.standard_normal(row.max() + 1)[row])
    return of


# What may be stated as a candidate: formula, unit of its size, um at size 1, what it depends on.
CANDIDATES = {
    "lost_motion": ("direction", "um", lambda d: d.value("direction"), ("direction",)),
    "expansion": ("x * warmth", "um/m/K", lambda d: d.value("x") / 1e3 * d.value("warmth"), ("x", "warmth")),
    "drift": ("time", "um/h", lambda d: d.time / 3600, ("time",)),
    "lead": ("sin(screw)", "um", lambda d: np.sin(d.value("screw") * np.pi / 180), ("screw", "x")),
}
ADDED = {
    "reversal": (lambda d, rng: d.value("direction"), ("direction",)),
    "alternating": (lambda d, rng: d.value("direction") * (-1.0)**place(d), ("x", "screw", "direction")),
    "growing_reversal": (lambda d, rng: d.value("direction") * d.value("x"), ("x", "screw", "direction")),
    "table": (table(False), ("x", "screw")),
    "table_both": (table(True), ("x", "screw", "direction")),
    "drift_by_position": (lambda d, rng: d.time * d.value("x"), ("x", "screw", "time")),
    "first_cycle": (lambda d, rng: np.exp(-d.time / 200), ("time", "cycle")),
    "cycle_1": (lambda d, rng: d.block() == "1", ("time", "cycle")),
    "periodic": (lambda d, rng: np.sin(2 * np.pi * d.value("x") / 95 + rng.uniform(0, 6)), ("x", "screw")),
    "temperature": (lambda d, rng: d.value("warmth"), ("warmth",)),
    "jump": (shapes.giving_way, ("time",)),
    "bump": (shapes.passing(200, 500), ("time", "cycle")),
}
SYSTEM = by_formula.System(MODEL, design, simulate, "a linear axis against a laser", "gain * x + sag * x^2 + offset",
                           {"x": '"0 mm"', "direction": 1, "time": '"0 s"', "screw": '"0 deg"'}, CANDIDATES, ADDED, ("lost_motion", "drift"), ("sag",))
