"""A probe behind two rotary axes, B and C on B, touches the top of a sphere in eight sessions. The machine is written
here anew, with rotation matrices."""
import numpy as np

import shapes
from design import Cell, Design, final_blocks, room_temperature
from shapes import along

MODEL = "sphere_calibration"
OUTPUTS = ("X", "Y", "Z")
FEEDS = (15.0, 30.0, 60.0, 120.0)
ARCSEC = np.pi / 180 / 3600
SCATTER = (0.0, 0.0, 1.0)  # along which indications a session's seat scatters
CLAMP = 3.0                # um, where it is declared
MACHINE = dict(probe_x=85.564, probe_y=287.428, probe_z=454.220, E_X0B=-0.406, E_Z0B=0.544, E_A0B=-0.267, E_C0B=-0.184,
               E_X0C=0.230, E_Y0C=0.369, E_A0C=0.0433, E_B0C=0.0121)
LINKS = dict(link_B_x=-120.0, link_B_z=110.0, link_C_x=50.0, link_C_y=180.0)


def design(rng, sessions=8, feeds=FEEDS, one_way=False, clamped_upwards=False, wide=False, **more):
    rows, t = [], 600.0
    for session in range(1, sessions + 1):
        turned = [(0.0, c) for c in rng.choice(np.arange(-90, 91, 15), 5, replace=False)]
        swung = [(b, 90.0) for b in rng.choice(np.arange(-20, 46, 5), 4, replace=False)]
        both = [(float(rng.integers(-4, 10) * 5), float(rng.integers(-6, 7) * 15)) for _ in range(3)]
        plan = turned + swung + both
        for i in rng.permutation(len(plan)):
            b, c = plan[i]
            up = 1.0 if one_way else rng.choice([-1.0, 1.0])
            clamp = (up + 1) / 2 if clamped_upwards else float(rng.integers(0, 2))
            rows.append((str(session), float(b), float(c), rng.choice(feeds), rng.choice([-1.0, 1.0]), up, clamp, t))
            t += rng.uniform(60, 150)
        t += rng.uniform(300, 1500)
    session, b, c, feed, b_up, c_up, clamp, time = map(np.array, zip(*rows))
    room = room_temperature(rng, time)
    known = lambda name: round(MACHINE[name] + rng.uniform(-0.004, 0.004), 3)
    angle = lambda name: name[:3] in ("E_A", "E_B", "E_C")
    # A machine just set up is known to 5 mm and half a degree, and that is declared.
    prior = lambda name: dict(u=0.5 if angle(name) else 5.0) if wide else dict(free=True, step=0.002)
    cells = [Cell(name, "deg" if angle(name) else "mm", known(name), **prior(name)) for name in MACHINE]
    cells += [Cell(f"S_{plane}", "um/m", 0.0, 4.0) for plane in ("XY", "XZ", "YZ")]
    cells += [Cell("sphere_distance", "mm", 184.183, 0.003), Cell("sphere_radius", "mm", 12.5, 0.0005), Cell("tip_radius", "mm", 3.0, 0.0005)]
    cells += [Cell(name, "mm", value) for name, value in LINKS.items()]
    final = final_blocks(rng, sessions)
    more = {"noise": 2.0, **more}
    return Design(MODEL, {"session": session},
                  {"B": (b, "deg"), "C": (c, "deg"), "feed": (feed, "mm/min"), "B_direction": (b_up, "1"), "C_direction": (c_up, "1"),
                   "C_clamped": (clamp, "1"), "time": (time.round(1), "s")},
                  {"temperature": (room.round(2), "degC")}, cells, "session", final, (("session",),), **more)


def turn(axis, angle):
    """Rodrigues: matrices (..., 3, 3) about unit vectors (..., 3) by angles (...)."""
    x, y, z = np.moveaxis(np.asarray(axis, float), -1, 0)
    o = np.zeros_like(x)
    k = np.stack([o, -z, y, z, o, -x, -y, x, o], -1).reshape(*np.shape(x), 3, 3)
    s, c = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    return np.eye(3) + s * k + (1 - c) * (k @ k)


def commands(q, B, C):
    """Commands X, Y, Z in mm; q: name -> array or number in mm, deg, um/m; B, C in rad, as the axes truly stand."""
    g = {name: np.broadcast_to(np.asarray(v, float), B.shape) for name, v in q.items()}
    unit = lambda *v: np.stack(np.broadcast_arrays(*v), -1) / np.linalg.norm(np.stack(np.broadcast_arrays(*v), -1), axis=-1, keepdims=True)
    rad, one, zero = np.pi / 180, np.ones_like(B), np.zeros_like(B)
    b = unit(-np.tan(g["E_C0B"] * rad), one, np.tan(g["E_A0B"] * rad))
    c = unit(np.tan(g["E_B0C"] * rad), -np.tan(g["E_A0C"] * rad), one)
    on_b = np.stack([g["link_B_x"] + g["E_X0B"], zero, -(g["link_B_z"] + g["E_Z0B"])], -1)
    on_c = np.stack([g["link_C_x"] + g["E_X0C"], g["link_C_y"] + g["E_Y0C"], zero], -1)
    probe = np.stack([g["probe_x"], -g["probe_y"], -g["probe_z"]], -1)
    times = lambda m, v: (m @ v[..., None])[..., 0]
    r = on_b + times(turn(b, B), on_c - on_b + times(turn(c, C), probe - on_c))
    top = np.stack([-g["sphere_distance"], zero, g["sphere_radius"] + g["tip_radius"]], -1)
    return top - r


def simulate(program, d, vectors, extra=(), B_error=0.0, C_error=0.0):
    """um, (number of vectors, readings, 3); errors of the rotary axes in rad."""
    B, C = d.value("B") * np.pi / 180, d.value("C") * np.pi / 180
    out = []
    for vector in vectors:
        q = {name: values for (name, _), values in d.gather(vector).items()}
        nominal, actual = commands(q, B, C), commands(q, B + B_error, C + C_error)
        actual[:, 0] += 1e-6 * (q["S_XZ"] * nominal[:, 2] - q["S_XY"] * nominal[:, 1])
        actual[:, 1] -= 1e-6 * q["S_YZ"] * nominal[:, 2]
        out.append(1e3 * actual)
    return np.array(out)


def turning(profile):
    """An error of the C axis of size times profile, arcsec."""
    def of(d, rng):
        one = ARCSEC * profile(d, rng)
        return lambda program, size, q: simulate(program, d, [q], C_error=size * one)[0]
    return of


@turning
def eccentric(d, rng):
    """A graduated disc off its centre, seen through the tangent, so not quite one harmonic."""
    c, phase = d.value("C") * np.pi / 180, rng.uniform(0, 2 * np.pi)
    return np.arctan2(0.05 * np.sin(c - phase), 1 + 0.05 * np.cos(c - phase)) / 0.05


@turning
def oval(d, rng):
    return np.sin(2 * d.value("C") * np.pi / 180 + rng.uniform(0, 2 * np.pi))


@turning
def play(d, rng):
    return -0.5 * shapes.hysteresis(d.value("C_direction"), rng.uniform(20, 60, d.readings), 5.0)


@turning
def brake(d, rng):
    return d.value("C_clamped") * (1 - 0.04 * rng.random(d.readings))


@along(0.0, 0.0, 1.0)
def latency(d, rng):
    return -d.value("feed") / 60 * shapes.gaining(d, rng)


def drift(d, rng):
    """The column bends away as it warms up, with two time constants."""
    where = rng.uniform(0, 2 * np.pi)
    return shapes.warming(d, rng)[:, None] * np.array([np.cos(where), np.sin(where), 0.0])


def approach(d):
    """Azimuth about the stylus and angle from it of the approach, in the probe's frame."""
    b, c = d.value("B") * np.pi / 180, d.value("C") * np.pi / 180
    towards = np.stack([np.sin(b) * np.cos(c), -np.sin(b) * np.sin(c), -np.cos(b)], -1)
    return np.arctan2(towards[:, 1], towards[:, 0]), np.abs(np.sin(b))


@along(0.0, 1.0, 0.0)
def jump(d, rng):
    day = d.time[d.training()]
    return shapes.jump(d.time, rng.uniform(np.quantile(day, 0.3), np.quantile(day, 0.7)), 60)


@along(0.0, 1.0, 0.0)
def product(d, rng):
    return shapes.room(d, rng) * shapes.unit(d.value("B"))


ADDED = {
    "c_encoder_eccentricity": (eccentric, None, None, ("C",)),
    "c_encoder_ovality": (oval, None, None, ("C",)),
    "c_axis_reversal": (play, "backlash", "arcsec", ("C_direction",), "+"),
    "c_brake_shift": (brake, "angle", "arcsec", ("C_clamped",)),
    "trigger_latency": (latency, "delay", "ms", ("feed",), "+"),
    "thermal_growth": (along(0.0, 0.0, 1.0)(shapes.drift), "rate", "um/h", ("time",)),
    "thermal_drift": (drift, None, None, ("time",)),
    "room": (along(0.0, 0.0, 1.0)(shapes.room), None, None, ("temperature",)),
    "bump": (along(0.6, 0.8, 0.0)(shapes.passing(1200, 2400)), None, None, ("time",)),
    "jump": (jump, None, None, ("time",)),
    "wave": (along(0.0, 0.6, 0.8)(shapes.wave), None, None, ("temperature",)),
    "cubic": (along(1.0, 0.0, 0.0)(shapes.cubic("feed")), None, None, ("feed",)),
    "product": (product, None, None, ("temperature", "B")),
}
SINGLES = ("c_encoder_eccentricity", "c_encoder_ovality", "c_axis_reversal", "c_brake_shift", "trigger_latency", "thermal_growth",
           "thermal_drift", "declared:S_XY")
PAIRS = (("c_encoder_eccentricity", "c_axis_reversal"), ("thermal_drift", "c_encoder_ovality"), ("trigger_latency", "thermal_growth"))
OUTSIDE = ("bump", "jump", "wave", "cubic", "product")
ALIASES = ((dict(clamped_upwards=True), "c_axis_reversal", ("c_axis_reversal", "c_brake_shift")),
           (dict(one_way=True), "c_axis_reversal", ()),
           (dict(feeds=(60.0,)), "trigger_latency", ()))
CATALOGUE = []


def own_catalogue(d):
    """Small changes of this file's machine, by the catalogue's formulas."""
    B, C = d.value("B") * np.pi / 180, d.value("C") * np.pi / 180
    base = simulate(None, d, [d.values()])[0]
    rows = [(name, simulate(None, d, [d.values()], **{axis: ARCSEC * x})[0] - base) for name, axis, x in (
        ("b_encoder_eccentricity", "B_error", np.cos(B)), ("b_encoder_eccentricity", "B_error", np.sin(B)),
        ("c_encoder_eccentricity", "C_error", np.cos(C)), ("c_encoder_eccentricity", "C_error", np.sin(C)),
        ("b_encoder_ovality", "B_error", np.cos(2 * B)), ("b_encoder_ovality", "B_error", np.sin(2 * B)),
        ("c_encoder_ovality", "C_error", np.cos(2 * C)), ("c_encoder_ovality", "C_error", np.sin(2 * C)),
        ("b_axis_reversal", "B_error", -0.5 * d.value("B_direction")), ("c_axis_reversal", "C_error", -0.5 * d.value("C_direction")),
        ("c_brake_shift", "C_error", d.value("C_clamped")))]
    one = np.eye(3)
    t = d.time / 60
    rows += [("trigger_latency", -d.value("feed")[:, None] / 60 * one[2]), ("pretravel", np.ones((d.readings, 1)) * one[2]),
             ("thermal_growth", t[:, None] / 60 * one[2]), ("gravity_sag", np.sin(B)[:, None] * one[2])]
    rows += [("thermal_growth", -np.expm1(-t / tau)[:, None] * one[2]) for tau in (10, 30, 90)]
    rows += [("thermal_drift", t[:, None] * one[k]) for k in (0, 1)]
    rows += [("thermal_drift", -np.expm1(-t / tau)[:, None] * one[k]) for k in (0, 1) for tau in (10, 30, 90)]
    rows += [(f"{'xyz'[k]}_scale", base[:, k:k + 1] * one[k]) for k in range(3)]
    rows += [(f"{'xyz'[k]}_straightness", base[:, k:k + 1]**2 * one[j]) for k in range(3) for j in range(3) if j != k]
    azimuth, off = approach(d)
    rows += [("pretravel_lobing", (off**3 * f(3 * azimuth))[:, None] * one[2]) for f in (np.cos, np.sin)]
    return rows


HEADER = """schema = 1
title  = "a probe behind two rotary axes touches a sphere in eight sessions"

[model]
name   = "sphere_calibration"
method = "propagation"
"""


def scatter_toml(d):
    return (f'[quantities.sphere_z]\nvalue = "0 mm"\ncomponents = [ {{ distribution = "normal", u = "{d.scatter:g} um", per = "session" }} ]\n')


def leave(program, d, q, left):
    """Readings with what each session's seating of the sphere left (um, by reading) in its height."""
    return simulate(program, d, [q])[0] + left[:, None] * np.array(SCATTER)
