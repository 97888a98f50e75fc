"""A round-insert mill turning over the beam of a laser tool setter: along the beam, and from above."""
import math

from .drawing import BLUE, INK, LINE, ORANGE, PALE, QUIET, Drawing

WIDE = 74  # pixels of the tool's radius


def along(d, v):
    r, insert = v("tool_radius", 10e-3), v("insert_radius", 6e-3)
    scale = WIDE / r
    offset = max(-2.2 * WIDE, min(2.2 * WIDE, v("offset") * scale))
    axis, R = -offset, min(insert, r) * scale
    seat, body = WIDE - R, max(WIDE - 0.75 * R, 0.3 * WIDE)
    d.path([(axis - body, 1.1 * R), (axis + body, 1.1 * R), (axis + body, 105), (axis + 0.45 * body, 128), (axis + 0.45 * body, 160),
            (axis - 0.45 * body, 160), (axis - 0.45 * body, 128), (axis - body, 105)], fill=PALE, closed=True)
    for side in (-1, 1):
        d.circle(axis + side * seat, R, R, INK, f"color-mix(in srgb, {BLUE} 22%, transparent)")
    d.path([(axis, 172), (axis, -24)], QUIET, width=0.8, dash="9 3 2 3")
    d.path([(axis - 0.45 * body - 20, 160), (axis + 0.45 * body + 20, 160), (axis + 0.45 * body + 20, 184), (axis - 0.45 * body - 20, 184)],
           fill=LINE, closed=True)
    d.label(axis, 167, "spindle", "middle")
    beam = max(3.0, v("beam_radius") * scale)
    d.circle(0, 0, beam, ORANGE, f"color-mix(in srgb, {ORANGE} 45%, transparent)", 1.4)
    if abs(offset) > 14:
        d.size((axis, -18), (0, -18), v.text("offset"), (0, -18))
        d.path([(0, -4), (0, -24)], QUIET, width=0.7)
    left = axis - WIDE
    d.size((left - 16, 0), (left - 16, 160), v.text("tool_length"), (-8, -4), "end")
    d.path([(left - 22, 0), (axis, 0)], QUIET, width=0.7)
    d.path([(axis + seat, R), (axis + seat + R * 0.7, R + R * 0.7)], QUIET, width=0.9, tip="end")
    d.label(axis + WIDE + 10, R + 0.5 * R, v.text("insert_radius"))
    d.size((axis, 92), (axis + WIDE, 92), v.text("tool_radius"), (WIDE / 2 + 10, -4), "start")
    d.label(beam + 6, -12, v.text("beam_radius", "beam, radius"), "start", ORANGE)
    d.label(axis, -62, "along the beam", "middle", QUIET)


def above(d, v, x0):
    """X to the right along the beam, Y upwards."""
    r = v("tool_radius", 10e-3)
    scale = 0.85 * WIDE / r
    radius, y = r * scale, -max(-130.0, min(130.0, v("offset") * scale)) + 60
    yaw = v("beam_yaw")
    d.path([(x0 + s * math.cos(yaw), 60 + s * math.sin(yaw)) for s in (-112, 116)], ORANGE, width=3, tip="end")
    d.circle(x0, y, radius, INK, PALE)
    flutes = max(1, min(12, round(v("inserts", 2))))
    first = v("start_angle") + v("holder_angle")
    for k in range(flutes):
        a = first + 2 * math.pi * k / flutes
        tip = (x0 + radius * math.cos(a), y + radius * math.sin(a))
        inner = (x0 + 0.55 * radius * math.cos(a), y + 0.55 * radius * math.sin(a))
        d.path([inner, tip], BLUE, width=5)
    d.path([(x0 - 6, y), (x0 + 6, y)], QUIET)
    d.path([(x0, y - 6), (x0, y + 6)], QUIET)
    d.arc(x0, y, 1.16 * radius, 1.16 * radius, 195, 262, QUIET, tip="end")
    d.label(x0 + 116 * math.cos(yaw) + 6, 56 + 116 * math.sin(yaw), v.text("beam_yaw", "beam, yaw"), "start", ORANGE)
    d.label(x0, y - 1.16 * radius - 22, f"{v.text('spindle_speed')}, {flutes} insert" + ("s" if flutes > 1 else ""), "middle")
    d.label(x0, y - 1.16 * radius - 44, "from above", "middle", QUIET)


def picture(v):
    d = Drawing()
    along(d, v)
    above(d, v, 350)
    return d.svg("A round-insert mill turning over a laser beam, along the beam and from above"), \
        "The mill turns while it is fed into the beam; lengths across the axis to scale." + v.caption()
