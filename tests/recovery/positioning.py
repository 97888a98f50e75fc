"""A linear axis against a laser: positions come back in both directions, cycle after cycle, while the room's temperature
wanders. A straight line and a declared sag are fitted; `gumshoe` sees the model as an expression."""
import numpy as np

import by_formula
import shapes
from by_formula import scatter_toml
from design import Cell, Design, hold_out, room_temperature
from shapes import along

MODEL = "positioning"
OUTPUTS = ("d",)
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
ADDED = by_formula.added(CANDIDATES) | {
    "reversal": (along(1.0)(lambda d, rng: d.value("direction")), None, None, ("direction",)),
    "alternating": (along(1.0)(lambda d, rng: d.value("direction") * (-1.0)**place(d)), None, None, ("x", "screw", "direction")),
    "growing_reversal": (along(1.0)(lambda d, rng: d.value("direction") * d.value("x")), None, None, ("x", "screw", "direction")),
    "table": (along(1.0)(table(False)), None, None, ("x", "screw")),
    "table_both": (along(1.0)(table(True)), None, None, ("x", "screw", "direction")),
    "drift_by_position": (along(1.0)(lambda d, rng: d.time * d.value("x")), None, None, ("x", "screw", "time")),
    "first_cycle": (along(1.0)(lambda d, rng: np.exp(-d.time / 200)), None, None, ("time", "cycle")),
    "cycle_1": (along(1.0)(lambda d, rng: d.block() == "1"), None, None, ("time", "cycle")),
    "periodic": (along(1.0)(lambda d, rng: np.sin(2 * np.pi * d.value("x") / 95 + rng.uniform(0, 6))), None, None, ("x", "screw")),
    "temperature": (along(1.0)(lambda d, rng: d.value("warmth")), None, None, ("warmth",)),
    "jump": (along(1.0)(shapes.giving_way), None, None, ("time",)),
    "bump": (along(1.0)(shapes.passing(200, 500)), None, None, ("time", "cycle")),
}
SINGLES = (*(n for n in ADDED if n.startswith("stated:")), "declared:sag")
PAIRS = (("stated:lost_motion", "stated:drift"),)
OUTSIDE = tuple(n for n in ADDED if not n.startswith("stated:"))
ALIASES = ()
CATALOGUE = []


def own_catalogue(d):
    return by_formula.own_catalogue(CANDIDATES, d)


def header(d):
    return by_formula.header("a linear axis against a laser", d, "gain * x + sag * x^2 + offset",
                             {"x": '"0 mm"', "direction": 1, "time": '"0 s"', "screw": '"0 deg"'})


def stated(d):
    return by_formula.stated_toml(CANDIDATES, d)


def leave(program, d, q, left):
    """Readings with what each mounting of the reflector left (um, by reading)."""
    return simulate(program, d, [q])[0] + left[:, None]
