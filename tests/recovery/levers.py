"""A gauge in a swivelling arm: height over the swivel's angle. Lengths are known to 5 mm and angles to half a degree only, so that
the model bends by tens of micrometres over what is declared, with readings good to one."""
import numpy as np

import by_formula
import shapes
from design import Cell, Design, hold_out, room_temperature

MODEL = "lever"
RAD = np.pi / 180


def design(rng, blocks=6, angles=9, offsets=False, u_length=5.0, u_angle=0.5, **more):
    """@param offsets: each pass has an offset of its own; @param u_length: mm; @param u_angle: deg"""
    rows, t = [], 0.0
    for turn in range(1, blocks + 1):
        for direction in (1.0, -1.0):
            for a in np.linspace(-60, 60, angles)[::int(direction)]:
                rows.append((str(turn), a, direction, t))
                t += 15.0
        t += 120.0
    turn, swivel, direction, time = map(np.array, zip(*rows))
    room = room_temperature(rng, time)
    cells = [Cell("arm", "mm", 500.0, u_length), Cell("cross", "mm", 80.0, u_length), Cell("tilt", "deg", 0.0, u_angle),
             Cell("lean", "deg", 0.0, u_angle)]
    cells += [Cell("offset", "mm", 0.0, label="turn", level=str(b), free=True, step=0.01) for b in range(1, blocks + 1)] if offsets else [
        Cell("offset", "mm", 0.0, free=True, step=0.01)]
    return Design(MODEL, {"turn": turn}, {"swivel": (swivel, "deg"), "direction": (direction, "1"), "time": (time, "s")},
                  {"warmth": ((room - 20).round(2), "K")}, cells, "turn", hold_out(rng, blocks), (("turn",),), **{"noise": 1.0, **more})


def simulate(program, d, vectors, extra=()):
    s = d.value("swivel") * RAD
    one = lambda q: 1e3 * (q["arm", "mm"] * np.sin(s + q["tilt", "deg"] * RAD) + q["cross", "mm"] * np.cos(s + q["lean", "deg"] * RAD)
                           + q["offset", "mm"])
    return np.array([one(d.gather(v)) for v in vectors])[..., None]


def table(d, rng):
    level = np.rint(d.value("swivel") + 60).astype(int)
    s = d.value("swivel") * RAD
    return by_formula.without([s**0, np.sin(s), np.cos(s), *(c[2](d) for c in CANDIDATES.values())], rng.standard_normal(level.max() + 1)[level])


CANDIDATES = {
    "play": ("direction", "um", lambda d: d.value("direction"), ("direction",)),
    "oval": ("sin(2 * swivel)", "um", lambda d: np.sin(2 * d.value("swivel") * RAD), ("swivel",)),
    "growth": ("sin(swivel) * warmth", "um/K", lambda d: np.sin(d.value("swivel") * RAD) * d.value("warmth"), ("swivel", "warmth")),
    "drift": ("time", "um/h", lambda d: d.time / 3600, ("time",)),
}
ADDED = {
    "table": (table, ("swivel",)),
    "third": (lambda d, rng: np.cos(3 * d.value("swivel") * RAD + rng.uniform(0, 6)), ("swivel",)),
    "jump": (shapes.giving_way, ("time",)),
}
SYSTEM = by_formula.System(MODEL, design, simulate, "a gauge in a swivelling arm", "arm * sin(swivel + tilt) + cross * cos(swivel + lean) + offset",
                           {"swivel": '"0 deg"', "direction": 1, "time": '"0 s"'}, CANDIDATES, ADDED, ("play", "oval"), ())
