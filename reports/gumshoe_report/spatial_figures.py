"""Figures in space: uncertainty over a grid of points, and a contour with its deviations magnified."""
import math

import matplotlib
import matplotlib.pyplot as plt
import numpy as np

from . import rounding
from .figures import BLUE, GRID, INK, PALE, svg
from .pictures.values import Values

PANELS = 4           # contours, heights
SIDE = 9             # cells of a grid with their numbers
CONTOUR = ("contour", "x", "y", "z", "size", "angle", "elevation", "sense", "sides", "feed", "contour_start")


def millimetres(x):
    return f"{1e3 * x:g}".replace("-", "−")


def reading(r, output):
    """Conditions of an output's reading; none if it has no reading of its own."""
    at = int(getattr(output, "reading", -1))
    return vars(r.readings[at]) if 0 <= at < len(r.readings) else {}


def measurands(r, outputs):
    found = {}
    for o in outputs:
        if reading(r, o):
            found.setdefault(o.measurand, []).append(o)
    return found


def grid_of(r, outputs):
    """Outputs by height and place, if their conditions x and y are a full grid."""
    heights = {}
    for o in outputs:
        c = reading(r, o)
        if not all(isinstance(c.get(name), float) and math.isfinite(c[name]) for name in "xyz"):
            return {}
        heights.setdefault(c["z"], {})[c["x"], c["y"]] = o
    for cells in heights.values():
        xs, ys = {x for x, _ in cells}, {y for _, y in cells}
        if min(len(xs), len(ys)) < 3 or max(len(xs), len(ys)) > SIDE or len(cells) != len(xs) * len(ys):
            return {}
    return heights if sum(map(len, heights.values())) == len(outputs) else {}


def volume(r, outputs):
    """u of every measurand over a grid of commanded points, a panel for each height; empty without such a grid.
    Measurands differ in kind and size: each has its own unit and its own scale of colours."""
    found = [(name, grid) for name, group in measurands(r, outputs).items() if (grid := grid_of(r, group))][:PANELS]
    if not found:
        return ""
    columns = min(PANELS, max(len(grid) for _, grid in found))
    u = lambda o: o.standard_uncertainty * o.display_factor
    colours = matplotlib.colormaps["Blues"]
    figure, panels = plt.subplots(len(found), columns, figsize=(7.2, 7.2 / max(3, columns) * len(found) * 0.95 + 0.4),
                                  layout="constrained", squeeze=False)
    for row, (name, grid) in zip(panels, found):
        shown = [o for cells in grid.values() for o in cells.values()]
        most = max(map(u, shown)) or 1
        unit, factor = rounding.finer(shown[0].display_units, most)
        heights = sorted(grid)[:columns]
        for axes, z in zip(row, heights):
            xs, ys = sorted({x for x, _ in grid[z]}), sorted({y for _, y in grid[z]})
            for (x, y), o in grid[z].items():
                share = u(o) / most
                at = xs.index(x), ys.index(y)
                axes.add_patch(plt.Rectangle((at[0] - 0.5, at[1] - 0.5), 1, 1, facecolor=colours(0.75 * share), edgecolor="none"))
                axes.text(*at, rounding.significant(u(o) * factor), ha="center", va="center", fontsize=7,
                          color="#fefefe" if share > 0.75 else "#101010")
            axes.set_xlim(-0.5, len(xs) - 0.5), axes.set_ylim(-0.5, len(ys) - 0.5)
            axes.set_xticks(range(len(xs)), [millimetres(x) for x in xs], fontsize=7)
            axes.set_yticks(range(len(ys)), [millimetres(y) for y in ys], fontsize=7)
            of = f"u of {name}" + (f" in {rounding.unit_text(unit)}" if rounding.unit_text(unit) else "")
            axes.set_title(f"{of}, z {millimetres(z)} mm", loc="left", fontsize=8, color=INK)
        for axes in row[len(heights):]:
            axes.set_visible(False)
        row[0].set_ylabel("y, mm")
    for column in panels.T:
        lowest = [axes for axes in column if axes.get_visible()][-1]
        lowest.set_xlabel("x, mm")
    return svg(figure, "volume", "Standard uncertainty over the commanded points")


def contours(r, outputs):
    """Contours whose tool positions and errors are among the outputs: conditions, and rows of (tool, output)."""
    tools, found = {}, {}
    for o in outputs:
        if o.measurand in ("tool_x", "tool_y", "tool_z"):
            tools.setdefault(int(o.reading), {})[o.measurand[-1]] = o.estimate
    for o in outputs:
        c = reading(r, o)
        if o.measurand == "contour_error" and c.get("contour", 0) > 0 and len(tools.get(int(o.reading), ())) == 3:
            found.setdefault(tuple(c.get(name) for name in CONTOUR), []).append((c["time"], tools[int(o.reading)], o))
    return {key: sorted(rows, key=lambda row: row[0]) for key, rows in found.items() if len(rows) >= 8}


def polygon(c):
    """Corners of a commanded polygon in its plane, m, one a column."""
    turn = c["sense"] * 2 * math.pi / c["sides"] * np.arange(c["sides"])
    sides = c["size"] * np.array([np.cos(turn), np.sin(turn)])
    return np.cumsum(sides, axis=1) - sides


def nearest(corners, points):
    """Nearest points of a polygon, and unit vectors outwards there."""
    best = np.full(points.shape[1], np.inf)
    on, out = np.zeros_like(points), np.zeros_like(points)
    centre = corners.mean(axis=1, keepdims=True)
    for start, end in zip(corners.T, np.roll(corners, -1, axis=1).T):
        side = end - start
        share = np.clip(((points.T - start) @ side) / (side @ side), 0, 1)
        foot = start[:, None] + side[:, None] * share
        normal = np.array([side[1], -side[0]]) / np.hypot(*side)
        normal *= math.copysign(1, normal @ (start - centre[:, 0]))
        away = points - foot
        distance = np.hypot(*away)
        at_corner = ((share <= 0) | (share >= 1)) & (distance > 0)
        with np.errstate(invalid="ignore", divide="ignore"):
            outwards = np.where(at_corner, away / distance, normal[:, None])
        closer = distance < best
        best = np.where(closer, distance, best)
        on, out = np.where(closer, foot, on), np.where(closer, outwards, out)
    return on, out


def contour(r, outputs):
    """Commanded contours, dashed, and measured ones with their deviations magnified; empty where there are none."""
    if r.model != "laser_ball_bar" or r.method == "virtual_experiment":
        return ""
    shown = list(contours(r, outputs).items())[:PANELS]
    if not shown:
        return ""
    values = Values(r)
    columns = min(2, len(shown))
    lines = math.ceil(len(shown) / columns)
    figure, panels = plt.subplots(lines, columns, figsize=(7.2 if columns > 1 else 4.8, 3.6 * lines + (0 if columns > 1 else 0.9)),
                                  layout="constrained", squeeze=False)
    for axes in panels.flat[len(shown):]:
        axes.set_visible(False)
    for axes, (key, rows) in zip(panels.flat, shown):
        c = dict(zip(CONTOUR, key))
        a, e = c["angle"], c["elevation"]
        along = np.array([math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)])
        left = np.array([-math.sin(a), math.cos(a), 0.0])
        zero = np.array([values("origin_" + n) + c[n] for n in "xyz"])
        at = np.array([[tool[n] for n in "xyz"] for _, tool, _ in rows]) - zero
        u, v = at @ along, at @ left
        ends = np.array([[o.estimate, o.symmetric_low, o.symmetric_high] for _, _, o in rows]).T
        largest = float(np.nanmax(np.abs(ends))) or 1e-6
        power = 10.0 ** math.floor(math.log10(0.25 * c["size"] / largest))
        times = next(s * power for s in (5, 2, 1) if s * power <= 0.25 * c["size"] / largest)
        if c["contour"] == 3:
            corners = polygon(c)
            on, n = nearest(corners, np.array([u, v]))
            axes.plot(*(1e3 * np.append(corners, corners[:, :1], axis=1)), color=INK, linewidth=0.8, linestyle=(0, (4, 3)))
        elif c["contour"] == 2:
            n = np.array([u, v]) / np.hypot(u, v)
            on, turn = c["size"] * n, np.linspace(0, 2 * math.pi, 361)
            axes.plot(1e3 * c["size"] * np.cos(turn), 1e3 * c["size"] * np.sin(turn), color=INK, linewidth=0.8, linestyle=(0, (4, 3)))
        else:
            n, on = np.array([0 * u, 0 * u + 1]), np.array([u, 0 * u])
            axes.plot([0, 1e3 * c["size"]], [0, 0], color=INK, linewidth=0.8, linestyle=(0, (4, 3)))
        estimate, low, high = (1e3 * (on + times * d * n) for d in ends)
        axes.fill(np.append(low[0], high[0][::-1]), np.append(low[1], high[1][::-1]), color=PALE, linewidth=0)
        axes.plot(*estimate, color=BLUE, linewidth=1.3, marker="o", markersize=2)
        axes.set_aspect("equal", adjustable="datalim")
        axes.grid(**GRID)
        axes.set_title(f"{6e4 * c['feed']:g} mm/min, deviations × {times:.0f}", loc="left", fontsize=8, color=INK)
        axes.set_xlabel("along the contour’s direction, mm" if c["contour"] == 1 or a or e else "X, mm")
        axes.set_ylabel("to its left, mm" if c["contour"] == 1 or a or e else "Y, mm")
    return svg(figure, "contour", "Commanded contour, dashed, and measured one with magnified deviations")
