"""Three laser ball bars from sockets on the table to a tool on its contour, seen from the front, the right and above."""
import math

from .drawing import BLUE, INK, ORANGE, PALE, QUIET, Drawing

SCALE = 480  # length of the largest distance in the picture


def picture(v):
    b12, b23, b31 = (v(f"base_length_{i}", 0.4) for i in (1, 2, 3))
    x3 = (b12 ** 2 + b31 ** 2 - b23 ** 2) / (2 * b12)
    sockets = [(0, 0, 0), (b12, 0, 0), (x3, math.sqrt(max(b31 ** 2 - x3 ** 2, 0)), 0)]
    place = [v("origin_" + c) + v(c) for c in "xyz"]
    a, e, size, kind = v("angle"), v("elevation"), v("size"), v("contour")
    along = (math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e))
    left = (-math.sin(a), math.cos(a), 0)

    def at(turn, radius=1.0):
        return tuple(p + radius * size * (math.cos(turn) * s + v("sense", 1) * math.sin(turn) * t) for p, s, t in zip(place, along, left))

    scale = SCALE / max(b12, b31, abs(place[0]) + size, abs(place[2]) + size, 1e-9)
    flat = lambda p: (scale * (p[0] + 0.45 * p[1]), scale * (p[2] + 0.3 * p[1]))
    d = Drawing()
    d.path([flat(s) for s in sockets], INK, PALE, 1.0, closed=True)
    tool = at(0.6) if kind == 2 else tuple(p + 0.6 * size * s for p, s in zip(place, along)) if kind in (1, 3) else tuple(place)
    if kind == 3:
        turns = [v("sense", 1) * 2 * math.pi * k / round(v("sides", 4)) for k in range(round(v("sides", 4)))]
        corners = [tuple(place)]
        for turn in turns[:-1]:
            corners.append(tuple(p + size * (math.cos(turn) * s + math.sin(turn) * t) for p, s, t in zip(corners[-1], along, left)))
        d.path([flat(p) for p in corners], ORANGE, width=1.6, closed=True)
    elif kind == 2:
        d.path([flat(at(2 * math.pi * k / 72)) for k in range(72)], ORANGE, width=1.6, closed=True)
    elif kind == 1:
        d.path([flat(place), flat([p + size * s for p, s in zip(place, along)])], ORANGE, width=1.6, tip="end")
    for i, s in enumerate(sockets, 1):
        d.path([flat(s), flat(tool)], BLUE, width=3)
        d.circle(*flat(s), 6, INK, INK)
        x, y = flat(s)
        d.label(*((x, y - 20) if i < 3 else (x + 22, y - 4)), f"socket {i}", "middle" if i < 3 else "start")
    d.circle(*flat(tool), 8, INK, PALE, 1.6)
    x, y = flat(tool)
    d.label(x + 14, y + 8, "tool", bold=True)
    corner = flat((0, 0, 0))
    for direction, name in (((1, 0, 0), "x"), ((0, 1, 0), "y"), ((0, 0, 1), "z")):
        end = flat([0.17 * b12 * c for c in direction])
        d.path([corner, end], QUIET, tip="end")
        d.label(end[0] + 5, end[1] + 3, name, colour=QUIET)
    what = {1: ", which follows the line (orange)", 2: ", which follows the circle (orange)",
            3: ", which follows the polygon (orange)"}.get(kind, ", at the first point")
    caption = f"Three laser ball bars (blue) from sockets on the table to the tool{what}."
    return d.svg("Three laser ball bars to a tool"), caption + v.caption()
