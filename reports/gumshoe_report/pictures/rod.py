"""A measuring rod lowered into the beam of a laser tool setter: from the side, and along the beam."""
import math

from .drawing import BLUE, INK, LINE, ORANGE, PALE, QUIET, Drawing, chord, magnified

HALF = 52  # pixels of the rod's radius


def rod(d, slope, v):
    """The rod above its bottom line z = slope x; shortened."""
    edge, top = slope * HALF, 165
    d.path([(-HALF, top), (-HALF, -edge), (HALF, edge), (HALF, top)], fill=PALE, width=1.4)
    d.path([(-HALF - 8, top - 46), (-12, top - 38), (12, top - 54), (HALF + 8, top - 46)], LINE, width=7)
    d.path([(-HALF - 26, top), (HALF + 26, top), (HALF + 26, top + 26), (-HALF - 26, top + 26)], fill=LINE, closed=True)
    d.label(0, top + 8, "spindle", "middle")
    d.path([(0, top - 4), (0, -26)], QUIET, width=0.8, dash="9 3 2 3")
    d.size((-HALF - 34, 0), (-HALF - 34, top), v.text("rod_length"), (-8, -6), "end")
    d.path([(-HALF - 40, 0), (0, 0)], QUIET, width=0.7)
    d.size((0, 92), (HALF, 92), v.text("rod_radius"), (HALF / 2 + 10, -4), "start")


def side(d, v):
    elevation, azimuth = v("bottom_elevation", math.pi / 2), v("bottom_azimuth") + v("holder_angle")
    bottom, pitch = math.atan2(math.cos(elevation) * -math.cos(azimuth), math.sin(elevation)), v("beam_pitch")
    by = magnified(bottom, pitch)
    slope, rise, thick = math.tan(by * bottom), math.tan(by * pitch), 9
    rod(d, slope, v)
    lowest = min((slope - rise) * x for x in (-HALF, HALF)) - chord(v("trigger_fraction", 0.5)) * thick  # over the axis
    beam = lambda x: rise * x + lowest
    far = 150
    d.path([(-far, beam(-far) + thick), (far, beam(far) + thick), (far, beam(far) - thick), (-far, beam(-far) - thick)],
           "none", f"color-mix(in srgb, {ORANGE} 32%, transparent)", closed=True)
    d.path([(-far, beam(-far)), (far + 14, beam(far + 14))], ORANGE, dash="9 3 2 3", tip="end")
    d.label(far + 20, beam(far + 14) - 4, v.text("beam_pitch"), "start", ORANGE)
    d.label(-far, beam(-far) - 30, v.text("beam_radius"), "start", ORANGE)
    if "bottom_height" in v.outputs:
        d.path([(0, 0), (HALF + 70, 0)], QUIET, width=0.7)
        d.path([(HALF + 62, 48), (HALF + 62, 0)], BLUE, tip="end")
        d.path([(HALF + 62, beam(HALF + 62) - 24), (HALF + 62, beam(HALF + 62))], BLUE, tip="end")
        d.label(HALF + 70, 42, v.text("bottom_height"), "start", BLUE)
    d.label(0, min(beam(-far), beam(far)) - 58, "across the beam", "middle", QUIET)
    return by


def along(d, v, x0):
    """The disc of the beam and the rod's shadow in it."""
    radius = 58
    height = radius * chord(v("trigger_fraction", 0.5))
    d.circle(x0, 0, radius, ORANGE, f"color-mix(in srgb, {ORANGE} 32%, transparent)", 1.4)
    d.path([(x0 - 92, 120), (x0 - 92, height), (x0 + 92, height), (x0 + 92, 120)], INK,
           f"color-mix(in srgb, {INK} 38%, transparent)", 1.2)
    d.label(x0, 92, "shadow of the rod", "middle")
    d.label(x0, -radius - 20, v.text("trigger_fraction"), "middle", ORANGE)
    d.label(x0, -radius - 48, "along the beam, at the trigger", "middle", QUIET)


def picture(v):
    d = Drawing()
    by = side(d, v)
    along(d, v, 410)
    caption = "The rod’s shadow covers the beam" + (f"; angles drawn {by} times as large" if by > 1 else "") + "; not to scale."
    return d.svg("A measuring rod lowered into a laser beam, across and along the beam"), caption + v.caption()
