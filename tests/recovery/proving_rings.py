"""A proving ring under dead weights: its deflection over rising and falling loads, ring turned from run to run, a calibration
curve through readings whose zero is taken anew in every run."""
import numpy as np

import by_formula
import shapes
from design import Cell, Design, hold_out, room_temperature

MODEL = "proving_ring"
FULL = 50.0  # kN


def design(rng, blocks=8, loads=7, offsets=True, first=0.0, **more):
    """@param offsets: each run has a zero of its own"""
    rows, t = [], 0.0
    for run in range(1, blocks + 1):
        for direction in (1.0, -1.0):
            for k in np.arange(loads)[::int(direction)]:
                rows.append((str(run), FULL * k / (loads - 1), direction, 90.0 * (run % 4), t))
                t += rng.uniform(25, 35)
        t += 300.0
    run, load, direction, turned, time = map(np.array, zip(*rows))
    room = room_temperature(rng, time)
    cells = [Cell("rate", "um/kN", 18.0, free=True, step=0.01), Cell("bend", "um/kN^2", 0.01, 0.002)]
    cells += [Cell("zero", "mm", 0.0, label="run", level=str(r), free=True, step=0.01) for r in range(1, blocks + 1)] if offsets else [
        Cell("zero", "mm", 0.0, free=True, step=0.01)]
    if first:
        cells += [Cell("fading", "um", 0.0, first), Cell("fade", "s", 200.0)]
    return Design(MODEL, {"run": run}, {"load": (load.round(3), "kN"), "direction": (direction, "1"), "turned": (turned, "deg"),
                                        "time": (time.round(1), "s")},
                  {"warmth": ((room - 20).round(2), "K")}, cells, "run", hold_out(rng, blocks), (("run",),), **{"noise": 0.5, **more})


def simulate(program, d, vectors, extra=()):
    load = d.value("load")
    one = lambda q: q["rate", "um/kN"] * load + q["bend", "um/kN^2"] * load**2 + 1e3 * q["zero", "mm"] + q.get(
        ("fading", "um"), 0) * np.exp(-d.time / 200)
    return np.array([one(d.gather(v)) for v in vectors])[..., None]


def table(d, rng):
    level = np.rint(d.value("load")).astype(int)
    x = d.value("load")
    return by_formula.without([x**0, x, x**2, *(c[2](d) for c in CANDIDATES.values())], rng.standard_normal(level.max() + 1)[level])


CANDIDATES = {
    "softening": ("load * warmth", "um/kN/K", lambda d: d.value("load") * d.value("warmth"), ("load", "warmth")),
    "friction": ("direction * load", "um/kN", lambda d: d.value("direction") * d.value("load"), ("direction", "load")),
    "eccentric": ("load * cos(turned)", "um/kN", lambda d: d.value("load") * np.cos(d.value("turned") * np.pi / 180), ("turned", "load")),
    "creep": ("time", "um/h", lambda d: d.time / 3600, ("time",)),
}
half = lambda d: d.value("load") / FULL * (1 - d.value("load") / FULL)
ADDED = {
    "hysteresis": (lambda d, rng: d.value("direction") * half(d), ("direction", "load")),
    "table": (table, ("load",)),
    "cubic": (lambda d, rng: (d.value("load") / FULL)**3, ("load",)),
    "first_run": (lambda d, rng: (d.block() == "1") * d.value("load"), ("time", "run", "load")),
    "temperature": (lambda d, rng: d.value("warmth"), ("warmth",)),
    "jump": (shapes.giving_way, ("time",)),
}
SYSTEM = by_formula.System(MODEL, design, simulate, "a proving ring under dead weights", "rate * load + bend * load^2 + zero",
                           {"load": '"0 kN"', "direction": 1, "turned": '"0 deg"', "time": '"0 s"'}, CANDIDATES, ADDED, ("friction", "softening"), ("bend",))
