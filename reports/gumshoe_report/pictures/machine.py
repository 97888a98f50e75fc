"""A machine as the chain of its axes from the bed to the workpiece and to the tool."""
import math

from .drawing import BLUE, INK, LINE, ORANGE, PALE, QUIET, Drawing

SEEN = {"X": (0.87, -0.35), "Y": (0.80, 0.42), "Z": (0.0, 1.0)}  # the machine's directions, seen from the front and above
BOX, GAP = 58, 16


def glyph(d, axis, x, y, low):
    """One axis in its box: an arrow along a slide, a turn about a rotary axis, whose point stands below."""
    half = BOX / 2
    d.path([(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)], LINE,
           PALE, closed=True)
    ux, uy = SEEN[axis.direction]
    a, b = (x - 21 * ux, y - 21 * uy), (x + 21 * ux, y + 21 * uy)
    if axis.kind == "linear":
        d.path([a, b], BLUE, width=2, tip="both")
    else:
        d.path([a, b], QUIET, width=0.9, dash="7 2 2 2")
        flat = 5 if axis.direction == "Z" else 15
        d.arc(x, y, 15 if axis.direction == "Z" else 7, flat, -50, 235, ORANGE, 2, tip="end")
    d.label(x - half + 4, y + half - 14, axis.name, bold=True)
    if any(abs(p) > 1e-9 for p in (axis.x, axis.y, axis.z)):
        d.label(x, y - half - 15 - 13 * low, "({:.4g}, {:.4g}, {:.4g}) mm".format(*(1e3 * p for p in (axis.x, axis.y, axis.z)))
                .replace("-", "−"), "middle", QUIET, 9)


def end(d, x, y, what):
    """What the outermost axis carries."""
    if what == "sphere":
        d.circle(x, y + 4, 13, INK, f"color-mix(in srgb, {BLUE} 25%, transparent)")
        d.path([(x, y - 9), (x, y - 22)], INK, width=2)
    else:
        d.path([(x - 9, y + 24), (x + 9, y + 24), (x + 9, y + 8), (x - 9, y + 8)], fill=LINE, closed=True)
        d.path([(x, y + 8), (x, y - 14)], INK, width=1.6)
        d.circle(x, y - 17, 4, ORANGE, ORANGE)
    d.label(x, y - BOX / 2 - 15, what, "middle", QUIET)


def chain(d, axes, y=0.0):
    """Sphere and workpiece side at the left, bed in the middle, tool side and probe at the right."""
    sides = {side: [a for a in axes if a.carries == side] for side in ("workpiece", "tool")}
    reach = {}
    d.path([(-BOX / 2, y - 13), (BOX / 2, y - 13), (BOX / 2, y + 13), (-BOX / 2, y + 13)], fill=LINE, closed=True)
    d.label(0, y - 4, "bed", "middle")
    for side, sign, what in (("workpiece", -1, "sphere"), ("tool", 1, "probe")):
        x = sign * BOX / 2
        for k, axis in enumerate(sides[side]):
            d.path([(x, y), (x + sign * GAP, y)], INK)
            x += sign * (GAP + BOX)
            glyph(d, axis, x - sign * BOX / 2, y, k % 2)
        d.path([(x, y), (x + sign * GAP, y)], INK)
        end(d, x + sign * (GAP + 16), y, what)
        d.label(x + sign * (GAP + 32), y + BOX / 2 + 10, f"{side} side", "end" if sign > 0 else "start", QUIET)
        reach[side] = x + sign * (GAP + 32)
    return reach


def triad(d, x, y):
    for name, (ux, uy) in SEEN.items():
        d.path([(x, y), (x + 26 * ux, y + 26 * uy)], QUIET, tip="end")
        d.label(x + 36 * ux - 4, y + 36 * uy - 4, name, colour=QUIET, size=11)


def picture(v):
    d = Drawing()
    reach = chain(d, v.axes)
    triad(d, reach["workpiece"] + 14, -92)
    at = lambda name: ", ".join(f"{1e3 * v(f'{name}_{c}'):.6g}".replace("-", "−") for c in "xyz")
    d.label(reach["workpiece"] + 70, -84, f"probe ({at('probe')}) mm from the spindle’s reference point")
    d.label(reach["workpiece"] + 70, -104, f"sphere ({at('sphere')}) mm in the workpiece’s frame")
    return d.svg("The axes of the machine between sphere and probe"), \
        "Axes from the bed outwards: slides move along the arrow, rotary axes turn about the line." + v.caption()
