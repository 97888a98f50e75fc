"""A ball bar in eight sockets, twelve stations each: position errors of a machine. The bar is written here anew."""
import numpy as np

import shapes
from design import Cell, Design, final_blocks, room_temperature
from shapes import along

MODEL = "single_socket"
OUTPUTS = ("length_change",)
EXPANSION = 11.5e-6
STATION = ("station_x", "station_y", "station_z")


def design(rng, sockets=8, alike=False, one_way=False, **more):
    """@param alike: every bar stands at the same angle to Z"""
    rows, cells, t = [], [], 300.0
    for socket in range(1, sockets + 1):
        place = np.round(rng.uniform(-300, 300, 3), 1)
        level = str(socket)
        for axis, x in zip("xyz", place):
            cells.append(Cell(f"reference_{axis}", "mm", x, 0.0, "socket", level))
            cells.append(Cell(f"position_error_{axis}", "mm", round(rng.uniform(-0.05, 0.05), 3), 0.0, "socket", level, free=True, step=0.01))
        if not more.get("scatter"):  # declared scatter is that of the zero
            cells.append(Cell("bar_zero", "um", 0.0, 0.3, "socket", level))
        cells += [Cell("temperature_difference", "K", round(rng.uniform(-1, 1), 1), 0.1, "socket", level)]
        for k in range(12):
            azimuth, height = rng.uniform(0, 2 * np.pi), 0.5 if alike else rng.uniform(-0.2, 0.98)
            n = np.array([np.sqrt(1 - height**2) * np.cos(azimuth), np.sqrt(1 - height**2) * np.sin(azimuth), height])
            rows.append((level, *np.round(place + rng.choice([150.0, 250.0]) * n, 3), -1.0 if one_way else rng.choice([-1.0, 1.0]), t))
            t += rng.uniform(60, 150)
        t += rng.uniform(600, 1800)
    socket, x, y, z, direction, time = map(np.array, zip(*rows))
    room = room_temperature(rng, time)
    return Design(MODEL, {"socket": socket},
                  {**{name: (v.astype(float), "mm") for name, v in zip(STATION, (x, y, z))}, "direction": (direction, "1"), "time": (time.round(1), "s")},
                  {"temperature": (room.round(2), "degC")}, cells, "socket", final_blocks(rng, sockets), (("socket",),), **more)


def bar(d, q):
    """Bars from socket to ball (mm, by reading) and their lengths."""
    lever = np.stack([d.value(s) - q[f"reference_{a}", "mm"] for s, a in zip(STATION, "xyz")], -1)
    return lever, np.linalg.norm(lever, axis=1)


def simulate(program, d, vectors, extra=()):
    """um, (number of vectors, readings, 1)."""
    out = []
    for vector in vectors:
        q = d.gather(vector)
        lever, length = bar(d, q)
        error = np.stack([q[f"position_error_{a}", "mm"] for a in "xyz"], -1)
        change = np.linalg.norm(lever + error, axis=1) - length - length * EXPANSION * q["temperature_difference", "K"]
        out.append(1e3 * change + q.get(("bar_zero", "um"), 0.0))
    return np.array(out)[..., None]


def directions(d):
    lever, length = bar(d, d.gather(d.values()))
    return lever / length[:, None]


@along(1.0)
def yielding(d, rng):
    """Brackets that yield sideways, and a little more than in proportion."""
    return (1 - directions(d)[:, 2]**2)**1.1


def play(k):
    """Backlash of one slide, taken up smoothly."""
    return along(1.0)(lambda d, rng: -0.5 * directions(d)[:, k] * shapes.hysteresis(d.value("direction"), rng.uniform(2, 6, d.readings), 1.0))


@along(1.0)
def product(d, rng):
    return shapes.room(d, rng) * shapes.unit(d.value("station_x"))


ADDED = {
    "bar_drift": (along(1.0)(shapes.drift), "rate", "um/h", ("time",)),
    "bracket_deflection": (yielding, "deflection", "um", STATION, "+"),
    "x_reversal": (play(0), "backlash", "um", ("direction", "station_x"), "+"),
    "z_reversal": (play(2), "backlash", "um", ("direction", "station_z"), "+"),
    "bump": (along(1.0)(shapes.passing(1200, 2400)), None, None, ("time",)),
    "jump": (along(1.0)(shapes.giving_way), None, None, ("time",)),
    "wave": (along(1.0)(shapes.wave), None, None, ("temperature",)),
    "product": (product, None, None, ("temperature", "station_x")),
}
SINGLES = ("bar_drift", "bracket_deflection", "x_reversal", "z_reversal", "declared:bar_zero[socket *]")
PAIRS = (("bar_drift", "bracket_deflection"), ("z_reversal", "bar_drift"))
OUTSIDE = ("bump", "jump", "wave", "product")
# Of bars that are inclined alike all indicate too much by the same, as if the ball stood higher; slides that come from one
# side shift all stations.
ALIASES = ((dict(alike=True), "bracket_deflection", ()),
           (dict(one_way=True), "x_reversal", ()))
CATALOGUE = []


def own_catalogue(d):
    """Small changes by the catalogue's formulas, um: errors of the slides as the bar sees them."""
    n, t, place = directions(d), d.time / 60, np.stack([d.value(s) for s in STATION], -1)
    rows = [("bar_drift", t / 60), ("bracket_deflection", 1 - n[:, 2]**2), ("thermal_growth", -n[:, 2] * t / 60)]
    rows += [(f"{'xyz'[k]}_reversal", -0.5 * d.value("direction") * n[:, k]) for k in range(3)]
    rows += [(f"{'xyz'[k]}_scale", place[:, k] * n[:, k] / 1e3) for k in range(3)]
    rows += [(f"{'xyz'[k]}_straightness", place[:, k]**2 * n[:, j] / 1e6) for k in range(3) for j in range(3) if j != k]
    rows += [("thermal_drift", t / 60 * n[:, k]) for k in (0, 1)]
    rows += [(name, sign * -np.expm1(-t / tau) * n[:, k]) for name, k, sign in (("thermal_growth", 2, -1), ("thermal_drift", 0, 1), ("thermal_drift", 1, 1))
             for tau in (10, 30, 90)]
    return [(name, shift[:, None]) for name, shift in rows]


HEADER = """schema = 1
title  = "a ball bar in eight sockets, twelve stations each"

[model]
name   = "single_socket"
method = "propagation"
"""


def scatter_toml(d):
    return f'[quantities.bar_zero]\nvalue = "0 um"\ncomponents = [ {{ distribution = "normal", u = "{d.scatter:g} um", per = "socket" }} ]\n'


def leave(program, d, q, left):
    """Readings with what each mounting of the bar left (um, by reading) in its zero."""
    return simulate(program, d, [q])[0] + left[:, None]
