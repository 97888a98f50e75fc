"""Three rods gauge a laser tool setter in eight set-ups, from both sides, at four feeds."""
import numpy as np

import shapes
from design import Cell, Design, by_program, final_blocks, room_temperature
from scenario_text import reclamp as scatter_toml
from shapes import along

MODEL = "rod_gauging"
OUTPUTS = ("spindle_z",)
FEEDS = (4.0, 30.0, 100.0, 300.0)
RODS = {"1": (90.0, 20.0, 81.7), "2": (89.922, 127.710, 130.6), "3": (88.041, 144.086, 179.8)}  # elevation, azimuth, length


def design(rng, setups=8, feeds=FEEDS, directions=(-1.0, 1.0), **more):
    rows, t = [], 300.0
    for setup in range(1, setups + 1):
        for rod in rng.permutation(list(RODS)):
            holder = rng.choice([0, 90, 180, 270])
            plan = [(f, d) for d in directions for f in rng.choice(feeds, 4 // len(directions), replace=len(feeds) < 4)]
            for feed, direction in rng.permutation(plan):
                rows.append((str(setup), str(rod), feed, direction, holder, t))
                t += rng.uniform(90, 210)
            t += rng.uniform(120, 300)
        t += rng.uniform(300, 1200)
    setup, rod, feed, direction, holder, time = map(np.array, zip(*rows))
    room = room_temperature(rng, time)
    cells = [Cell("laser_z", "mm", round(-510 + rng.uniform(-1, 1), 3), label="setup", level=str(s), free=True, step=0.01)
             for s in range(1, setups + 1)]
    for level, (elevation, azimuth, length) in RODS.items():
        cells += [Cell("rod_length", "mm", length, 0.0005, "rod", level),
                  Cell("bottom_elevation", "deg", elevation, 0.002, "rod", level),
                  Cell("bottom_azimuth", "deg", azimuth, 0.05, "rod", level)]
    for s in range(1, setups + 1):
        cells += [Cell("beam_pitch", "deg", round(rng.uniform(0.1, 0.6), 4), 0.004, "setup", str(s)),
                  Cell("beam_yaw", "deg", round(rng.uniform(-1, 1), 4), 0.01, "setup", str(s))]
    cells += [Cell("beam_radius", "mm", 0.2, 0.003), Cell("trigger_fraction", "1", 0.5, 0.01)]
    cells += [Cell("holder_angle", "deg", float(h), 0.1, "holder", h) for h in sorted(set(holder), key=int)]
    final = final_blocks(rng, setups)
    return Design(MODEL, {"rod": rod, "setup": setup, "holder": holder},
                  {"feed": (feed.astype(float), "mm/min"), "direction": (direction.astype(float), "1"),
                   "time": (time.astype(float).round(1), "s")},
                  {"temperature": (room.round(2), "degC")}, cells, "setup", final, (("rod", "setup"),), **more)


def simulate(program, d, vectors, extra=()):
    return by_program(program, d, OUTPUTS, vectors, extra)


# Effects: (design, rng) -> (shift of the indication in um at size 1, (n, 1)); sizes as catalogued, where they are.

@along(1.0)
def latency(d, rng):
    return d.value("direction") * d.value("feed") / 60 * shapes.gaining(d, rng)  # mm/s times ms


@along(1.0)
def reversal(d, rng):
    return 0.5 * shapes.hysteresis(d.value("direction"), rng.uniform(1, 5, d.readings), 1.0)


@along(1.0)
def reversal_of_one(d, rng):
    """One rod sits loosely: it tips by the side from which the beam is approached."""
    return 0.5 * shapes.hysteresis(d.value("direction"), rng.uniform(1, 5, d.readings), 1.0) * (d.labels["rod"] == "3")


@along(1.0)
def film(d, rng):
    """A film of coolant that the rod wipes off slowly: thicker at low feed."""
    return 1 / d.value("feed")


@along(1.0)
def scale(d, rng):
    """um/m; the screw's pitch shows in it."""
    z = d.gather(d.values())
    height = z["laser_z", "mm"] + z["rod_length", "mm"]
    return -height / 1e3 + 0.02 * np.sin(2 * np.pi * height / 10)


# name in the catalogue, quantity and unit there (None: none that compares), what it depends on, sign
ADDED = {
    "trigger_latency": (latency, "delay", "ms", ("feed", "direction"), "+"),
    "z_reversal": (reversal, "backlash", "um", ("direction",), "+"),
    "z_reversal[rod 3]": (reversal_of_one, "backlash", "um", ("rod",), "+"),
    "thermal_growth": (along(1.0)(shapes.drift), "rate", "um/h", ("time",)),
    "thermal_growth:warming": (along(1.0)(shapes.warming), None, None, ("time",), "+"),
    "z_scale": (scale, "E_ZZ", "um/m", ("rod",)),
    "stated:coolant_film": (film, "size", "um*mm/min", ("feed",), "+"),
    "room": (along(1.0)(shapes.room), None, None, ("temperature",)),
    "bump": (along(1.0)(shapes.passing(700, 1500)), None, None, ("time",)),
    "jump": (along(1.0)(shapes.giving_way), None, None, ("time",)),
    "wave": (along(1.0)(shapes.wave), None, None, ("temperature",)),
    "cubic": (along(1.0)(shapes.cubic("feed")), None, None, ("feed",)),
    "product": (along(1.0)(shapes.room_by_feed), None, None, ("feed", "temperature")),
}

SINGLES = ("trigger_latency", "z_reversal", "thermal_growth", "thermal_growth:warming", "stated:coolant_film",
           "declared:rod_length[rod 3]", "declared:beam_pitch[setup *]")
PAIRS = (("trigger_latency", "z_reversal"), ("thermal_growth", "trigger_latency"), ("z_reversal", "declared:rod_length[rod 3]"))
OUTSIDE = ("bump", "jump", "wave", "cubic", "product")
# An alias: what the design leaves out, the truth, what cannot be told from it; "" stands for "absorbed, nothing to see".
ALIASES = ((dict(feeds=(30.0,)), "trigger_latency", ("trigger_latency", "z_reversal")),
           (dict(feeds=(30.0,), directions=(-1.0,)), "trigger_latency", ()),
           (dict(), "z_scale", ("z_scale", "rod_expansion")))

# What the oracle knows in addition to the declared quantities: engine effects by their columns, at these shapes.
CATALOGUE = [("trigger_latency", "trigger_latency.delay (ms)", 1.0, {}), ("z_reversal", "z_reversal.backlash (um)", 1.0, {}),
             ("z_scale", "z_scale.E_ZZ (um/m)", 10.0, {}), ("rod_expansion", "rod_expansion.temperature_difference (K)", 1.0, {}),
             ("thermal_growth", "thermal_growth.rate (um/h)", 1.0, {}),
             *(("thermal_growth", "thermal_growth.amplitude (um)", 1.0, {"thermal_growth.time_constant (min)": tau})
               for tau in (10.0, 30.0, 90.0)),
             ("beam_offset", "beam_offset.x (mm)", 0.1, {}), ("beam_offset", "beam_offset.y (mm)", 0.1, {}),
             ("rod_runout", "rod_runout.x (um)", 10.0, {}), ("rod_runout", "rod_runout.y (um)", 10.0, {})]

HEADER = """schema = 1
title  = "three rods gauge a laser tool setter"

[model]
name   = "rod_gauging"
method = "propagation"

[quantities]
rod_radius    = "5 mm"
fillet_radius = "0.03 mm"
"""
STATED = """
[stated_effects.coolant_film]
indication = "spindle_z"
formula    = "1 / feed"
unit       = "um*mm/min"
meaning    = "coolant that a slow rod does not wipe off"
"""


def leave(program, d, q, left):
    """Readings with what each clamping left (um, by reading) in the rod's height."""
    return simulate(program, d, [q])[0] + left[:, None]
