"""A ball bar about its socket, seen from the front and above; a ball that rotary axes turn."""
import math

from .drawing import BLUE, INK, LINE, ORANGE, PALE, QUIET, Drawing
from .machine import SEEN, triad


def seen(place, scale=1.0):
    """A point (x, y, z) on the page."""
    return tuple(scale * sum(c * SEEN[axis][k] for c, axis in zip(place, "XYZ")) for k in (0, 1))


def socket(v):
    """The bars of the first step from the fixed ball, to scale."""
    reference = [v(f"reference_{a}") for a in "xyz"]
    stations = [[r.get(f"station_{a}", v(f"station_{a}")) for a in "xyz"] for r in v.readings
                if r.get("step", v("step", 1)) == v("step", 1)]
    bars = [[s - o for s, o in zip(station, reference)] for station in stations]
    if not bars:  # a choice records no readings
        return "", ""
    longest = max(math.hypot(*bar) for bar in bars) or 1
    d = Drawing()
    d.path([(-16, -14), (16, -14), (16, -40), (-16, -40)], fill=LINE, closed=True)
    d.circle(0, -4, 10, INK, PALE, 1.8)
    d.label(0, -56, "socket with the fixed ball", "middle")
    for bar in bars:
        x, y = seen(bar, 170 / longest)
        d.path([(0, -4), (x, y - 4)], BLUE, width=3)
        d.circle(x, y - 4, 7, ORANGE, ORANGE)
    x, y = seen(max(bars, key=lambda b: seen(b)[1]), 170 / longest)
    d.label(x + 12, y - 2, "moving ball, on the machine", colour=ORANGE)
    d.label(x + 12, y - 20, f"{len(bars)} stations, bars of " + ", ".join(
        dict.fromkeys(f"{1e3 * math.hypot(*b):.4g} mm" for b in bars)), colour=BLUE)
    triad(d, d.box[0] - 50, -30)
    return d.svg("Ball bars from a socket to the stations of the moving ball"), \
        "The bars of the first step from the front and above, to scale." + v.caption()


def turned(v):
    """From the pivot to the ball as it stands with all angles at 0, and where the commanded angles put it."""
    point = [v(f"point_{a}") for a in "xyz"]
    alpha, beta, gamma = (v(name) for name in ("alpha", "beta", "gamma"))
    x, y, z = point
    x, y = x * math.cos(gamma) - y * math.sin(gamma), x * math.sin(gamma) + y * math.cos(gamma)
    x, z = x * math.cos(beta) + z * math.sin(beta), -x * math.sin(beta) + z * math.cos(beta)
    up = z + v("z_alpha_gamma")
    turned_to = (x, y * math.cos(alpha) - up * math.sin(alpha), y * math.sin(alpha) + up * math.cos(alpha))
    unturned = (*point[:2], point[2] + v("z_alpha_gamma"))
    scale = 190 / (math.hypot(*unturned) or 1)
    d = Drawing()
    start, end = seen(unturned, scale), seen(turned_to, scale)
    d.path([(0, 0), start], QUIET, width=1.2, dash="6 3")
    d.path([(0, 0), end], INK, width=3)
    d.circle(*start, 5, QUIET, PALE)
    d.circle(*end, 7, ORANGE, ORANGE)
    d.circle(0, 0, 9, BLUE, PALE, 1.8)
    d.circle(0, 0, 2, BLUE, BLUE)
    d.label(14, 10, "pivot", colour=BLUE)
    d.label(start[0] - 10, start[1] - 18, "all angles at 0", "end", QUIET)
    stated = [name for name in ("alpha", "beta", "gamma") if v(name)]
    d.label(end[0] + 12, end[1] - 4, ", ".join(v.text(name) for name in stated) or "ball", colour=ORANGE)
    triad(d, d.box[0] - 50, 0)
    return d.svg("The ball from its pivot, before and after the rotation"), \
        "The ball from its pivot, from the front and above, to scale." + v.caption()
