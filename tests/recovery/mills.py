"""A mill with four round inserts on a laser tool setter: eight set-ups, four clampings each, many feeds and speeds.

What moves the tool's centre by g moves its start as well: it reads g more, of a feed that starts g lower, so that
another flute may trigger. What acts after the trigger leaves the phase."""
from dataclasses import replace

import numpy as np

import shapes
from design import Cell, Design, by_program, final_blocks, room_temperature
from scenario_text import reclamp as scatter_toml
from shapes import along

MODEL = "tool_length"
OUTPUTS = ("spindle_z",)
FEEDS = (4.0, 10.0, 20.0, 40.0)
SPEEDS = (4500.0, 6000.0, 8000.0, 10000.0)


def design(rng, setups=8, clampings=4, feeds=FEEDS, speeds=SPEEDS, **more):
    rows, t = [], 200.0
    for setup in range(1, setups + 1):
        for clamp in "abcd"[:clampings]:
            for feed, speed in zip(rng.choice(feeds, 3, replace=len(feeds) < 3), rng.choice(speeds, 3, replace=len(speeds) < 3)):
                rows.append((str(setup), clamp, feed, speed, float(rng.integers(0, 360)), t))
                t += rng.uniform(60, 150)
            t += rng.uniform(60, 200)
        t += rng.uniform(200, 900)
    setup, clamp, feed, speed, angle, time = map(np.array, zip(*rows))
    room = room_temperature(rng, time)
    cells = [Cell("tool_length", "mm", round(176.6 + rng.uniform(-0.1, 0.1), 3), label="setup", level=str(s), free=True, step=0.01)
             for s in range(1, setups + 1)]
    cells += [Cell("laser_z", "mm", -1172.015, 0.001), Cell("holder_angle", "deg", 140.0, 0.05), Cell("offset", "mm", 4.0, 0.01),
              Cell("beam_radius", "mm", 0.2, 0.0003)]
    # Seats that are known to differ; more uncertain ones would leave jumps that no derivative sees.
    cells += [Cell(f"wear_{k}", "mm", w, 0.00002) for k, w in ((2, 0.0004), (3, 0.0001), (4, 0.0003))]
    cells += [Cell("inserts", "1", 4.0), Cell("insert_radius", "mm", 5.0), Cell("insert_thickness", "mm", 3.2),
              Cell("insert_radial_angle", "deg", -12.0), Cell("insert_axial_angle", "deg", 6.0)]
    final = final_blocks(rng, setups)
    return Design(MODEL, {"setup": setup, "clamp": clamp},
                  {"feed": (feed, "mm/min"), "spindle_speed": (speed, "rpm"), "start_angle": (angle, "deg"),
                   "start_height": (np.full(len(time), 2.0), "mm"), "time": (time.round(1), "s")},
                  {"temperature": (room.round(2), "degC")}, cells, "setup", final, (("setup", "clamp"),), **more)


def simulate(program, d, vectors, extra=()):
    return by_program(program, d, OUTPUTS, vectors, extra)


def lifted(program, d, q, growth):
    """Readings of a tool longer by `growth` um, reading by reading."""
    start, unit = d.conditions["start_height"]
    lower = replace(d, conditions={**d.conditions, "start_height": (start - growth / 1e3, unit)})
    return simulate(program, lower, [q])[0] + growth[:, None]


def moving(profile):
    """An effect that moves the tool's centre by size times profile. Its strength is that of the profile: a jump to the
    next tooth counts for much and says nothing."""
    def of(d, rng):
        one = profile(d, rng)
        read = lambda program, size, q: lifted(program, d, q, size * one)
        read.smooth = one[:, None]
        return read
    return of


@along(1.0)
def latency(d, rng):
    return -d.value("feed") / 60 * shapes.gaining(d, rng)


@along(1.0)
def confirmation(d, rng):
    """Further revolutions until the receiver believes; um a revolution."""
    return -1e3 * d.value("feed") / d.value("spindle_speed")


@moving
def nose(d, rng):
    """The bearings' balls press the spindle forward, and the shaft warms a little with it; um at 10 000 rpm."""
    return (d.value("spindle_speed") / 1e4) ** 1.95


def run_out(d, rng):
    """The engine's own tilt of the tool (its geometry has tests of its own), a size in mrad towards any side: which flute comes
    lowest, and by how much, decides what triggers."""
    towards = rng.uniform(0, 2 * np.pi)

    def tilt(size):
        return {"tool_runout.tilt_x (mrad)": size * np.cos(towards), "tool_runout.tilt_y (mrad)": size * np.sin(towards)}

    def read(program, size, q):
        return simulate(program, d, [q], [tilt(size)])[0]
    read.tilt = tilt
    read.parts = {"tilt_x": np.cos(towards), "tilt_y": np.sin(towards)}
    return read


ADDED = {
    "tool_runout": (run_out, "tilt_x", "mrad", ("feed", "spindle_speed", "start_angle"), "+"),
    "trigger_latency": (latency, "delay", "ms", ("feed",), "+"),
    "revolution_confirm": (confirmation, "revolutions", "1", ("feed", "spindle_speed"), "+"),
    "spindle_axial_shift": (nose, "at_once", "um", ("spindle_speed",), "+"),
    "thermal_growth": (moving(shapes.drift), "rate", "um/h", ("time",)),
    "thermal_growth:warming": (moving(shapes.warming), None, None, ("time",), "+"),
    "room": (along(1.0)(shapes.room), None, None, ("temperature",)),
    "bump": (along(1.0)(shapes.passing(500, 1000)), None, None, ("time",)),
    "jump": (along(1.0)(shapes.giving_way), None, None, ("time",)),
    "wave": (along(1.0)(shapes.wave), None, None, ("temperature",)),
    "cubic": (along(1.0)(shapes.cubic("spindle_speed")), None, None, ("spindle_speed",)),
    "product": (along(1.0)(shapes.room_by_feed), None, None, ("feed", "temperature")),
}
# An insert that is lower moves readings without limit; one that is higher, by a tooth's feed at most.
TOWARDS = {f"wear_{k}": -1 for k in (2, 3, 4)}
SINGLES = ("trigger_latency", "revolution_confirm", "spindle_axial_shift", "thermal_growth", "thermal_growth:warming")
PAIRS = (("trigger_latency", "thermal_growth"), ("spindle_axial_shift", "trigger_latency"))
OUTSIDE = ("bump", "jump", "wave", "cubic", "product")
ALIASES = ((dict(), "trigger_latency", ("trigger_latency", "servo_lag", "sampling_rate")),
           (dict(feeds=(20.0,)), "trigger_latency", ()),
           (dict(speeds=(6000.0,)), "trigger_latency", ("trigger_latency", "revolution_confirm", "servo_lag", "sampling_rate")))

CATALOGUE = []


def own_catalogue(d):
    """Smooth over a tooth: what moves the tool is read in full on the average."""
    feed, speed, t = d.value("feed"), d.value("spindle_speed"), d.time
    rows = [("trigger_latency", -feed / 60), ("servo_lag", -feed / 60), ("sampling_rate", -feed / 120),
            ("revolution_confirm", -1e3 * feed / speed), ("spindle_axial_shift", (speed / 1e4)**2), ("thermal_growth", t / 3600)]
    rows += [("thermal_growth", -np.expm1(-t / 60 / tau)) for tau in (10, 30, 90)]
    rows += [("spindle_axial_shift", -speed**2 * np.expm1(-t / 60 / tau)) for tau in (3, 10, 30)]
    return [(name, x[:, None]) for name, x in rows]


HEADER = """schema = 1
title  = "a mill on a laser tool setter, eight set-ups"

[model]
name   = "tool_length"
method = "propagation"
"""


def leave(program, d, q, left):
    """Readings with what each clamping left (um, by reading) in the tool's height."""
    return lifted(program, d, q, left)
