"""Calibration with a sphere: the probe on the turned axes at B = C = 0 to scale, and the machine's chain."""
from .drawing import BLUE, INK, LINE, ORANGE, PALE, QUIET, Drawing
from .machine import chain, triad


def side(d, v, y0):
    """X to the right, Z upwards; O_r at the origin."""
    probe = (v("probe_x"), -v("probe_z"))
    b, c = (v("link_B_x") + v("E_X0B"), -(v("link_B_z") + v("E_Z0B"))), v("link_C_x") + v("E_X0C")
    radius, tip = v("sphere_radius"), v("tip_radius")
    corners = [(0, 0), probe, b, (c, 0), (probe[0], probe[1] - 2 * radius - tip)]
    high = max(z for _, z in corners) - min(z for _, z in corners) or 1
    scale = 230 / high
    at = lambda p: (scale * p[0], y0 + scale * p[1])
    (px, pz), (bx, bz), (ox, oz), cx = at(probe), at(b), at((0, 0)), scale * c
    d.path([(ox, oz), (bx, bz)], INK, width=3)
    d.path([(bx, bz), (cx, bz), (cx, oz - 16), (px, oz - 16), (px, pz)], INK, width=3)
    d.path([(cx, oz + 18), (cx, pz - 6)], QUIET, width=0.9, dash="9 3 2 3")
    d.label(cx, oz + 24, v.text("link_C_x", "C axis, link"), "start", BLUE)
    d.circle(bx, bz, 9, BLUE, PALE, 1.8)
    d.circle(bx, bz, 2, BLUE, BLUE)
    d.label(bx - 14, bz - 4, v.text("link_B_z", "B axis, link"), "end", BLUE)
    d.circle(ox, oz, 3, INK, INK)
    d.label(ox - 8, oz + 8, "origin O_r", "end")
    d.circle(px, pz, max(2.5, scale * tip), ORANGE, ORANGE)
    r = max(6, scale * radius)
    d.circle(px, pz - r - max(2.5, scale * tip), r, INK, f"color-mix(in srgb, {BLUE} 25%, transparent)")
    d.path([(px - r, pz - r - 3), (px - 70, pz - r - 3), (px - 70, pz - r - 40)], LINE, width=6)
    d.label(px + r + 10, pz - r - 8, v.text("sphere_radius"))
    right = max(px, cx) + 40
    d.size((right, oz), (right, pz), v.text("probe_z"), (8, -4), "start")
    d.path([(px + 6, pz), (right + 6, pz)], QUIET, width=0.7)
    d.path([(ox, oz), (right + 6, oz)], QUIET, width=0.7)
    d.label(px, pz - 2 * r - 30, v.text("probe_x"), "middle")


def picture(v):
    d = Drawing()
    chain(d, v.axes)
    left = d.box[0]
    inner = Drawing()
    side(inner, v, 0)
    top, centre = -inner.box[1], (inner.box[0] + inner.box[2]) / 2
    drop = -95 - top
    d.elements.append(f'<g transform="translate({-centre:.1f} {-drop:.1f})">' + "".join(inner.elements) + "</g>")
    d.reach((inner.box[0] - centre, -inner.box[1] + drop), (inner.box[2] - centre, -inner.box[3] + drop))
    triad(d, left + 14, drop + top - 60)
    return d.svg("The axes of the machine between sphere and probe, and the probe above the sphere"), \
        "Above: axes from the bed outwards. Below: the machine at B = C = 0 seen along Y, to scale." + v.caption()
