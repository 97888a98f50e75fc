"""Figures of a trace: residuals before (orange) and after (blue), and what is not in the catalogue."""
import math
import textwrap
import types

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator

from . import compensation
from .choice import axis_label
from .figures import BAND, BLUE, GREY, GRID, INK, NOISE, ORANGE, PALE, RULE, svg
from .rounding import finer
from .trace_axes import axis_unit

SIDES = (("before", ORANGE), ("after", BLUE))
WIDE = 9.2  # inches, of the figures with many points
LEVELS = 60  # of a label, beyond them it is not drawn
DISTINCT = 12  # values of a condition that are averaged one by one; beyond them in bins
LEAST = 3  # readings of an average
MANY = 400  # residuals; beyond them the points are an image in the figure, or the page were megabytes
DOTS = 200  # per inch, of such an image
LINES = 4  # in the figure of a table; beyond them the table says it better
UNCHANGED = (("before", BLUE),)  # nothing was added: there is one residual only


def sides(rows):
    same = all(r.after == r.before for r in rows if math.isfinite(r.before))
    return UNCHANGED if same else SIDES


def scored(rows):
    """Rows with a residual, and its values in display units (both sides, NaN where not scored)."""
    rows = [r for r in rows if math.isfinite(r.before)]
    factor = rows[0].display_factor if rows else 1
    return rows, {side: np.array([getattr(r, side) for r in rows]) * factor for side, _ in SIDES}


def scale(rows):
    """Unit and further factor of the residuals' axis: from their middle size before."""
    _, values = scored(rows)
    return finer(rows[0].display_units, float(np.sqrt(np.nanmean(values["before"] ** 2))))


def limits(values):
    """End of one axis for both sides, with room: the largest residual, or 1.6 times the 98 % quantile if that is less, so
    that one bad reading does not hide all others."""
    both = np.abs(np.concatenate(list(values.values())))
    both = both[np.isfinite(both)]
    top = min(float(both.max()), 1.6 * float(np.quantile(both, 0.98))) if len(both) else 1
    return 1.12 * (top or 1)


def mark_beyond(axes, x, y, top):
    """Triangles at the edge for residuals, or means of them, beyond the axis."""
    for side, marker in ((1, "^"), (-1, "v")):
        beyond = side * y > top
        axes.plot(x[beyond], np.full(beyond.sum(), side * 0.965 * top), marker, color=INK, markersize=4.5, markeredgewidth=0, zorder=5)


def marks(rows):
    """Whether there are outliers within the axis, and residuals beyond it."""
    rows, values = scored(rows)
    top = limits(values)
    outlier = np.array([r.weight < 0.5 for r in rows])
    return (any((outlier & (np.abs(v) <= top)).any() for v in values.values()),
            any((np.abs(v) > top).any() for v in values.values()))


def band(axes, rows, factor, x):
    """Two standard uncertainties of the noise; along x where readings differ in it."""
    u = np.array([r.noise_u * r.display_factor for r in rows])
    known = np.isfinite(u) & (u > 0) & np.isfinite(x)
    if known.any():
        u, x = 2 * factor * u[known], np.asarray(x)[known]
        if np.ptp(u) < 0.05 * u.max():
            axes.axhspan(-np.median(u), np.median(u), color=BAND, linewidth=0, zorder=0)
        else:
            places = np.unique(x)
            wide = np.array([np.median(u[x == place]) for place in places])
            axes.fill_between(places, -wide, wide, color=BAND, linewidth=0, zorder=0)
    axes.axhline(0, color=GREY, linewidth=0.6, zorder=0.5)


def and_after(shown):
    return ", before and after" if len(shown) > 1 else ""


def in_order(rows, name, order):
    """Residuals one after the other, blocks and final blocks marked. `order`: "the order of measurement", or of the rows."""
    rows = sorted(rows, key=lambda r: (r.order, r.reading))
    rows, values = scored(rows)
    unit, factor = scale(rows)
    values = {side: v * factor for side, v in values.items()}
    shown = sides(rows)
    figure, grid = plt.subplots(len(shown), 1, sharex=True, sharey=True, figsize=(WIDE, 0.9 + 1.5 * len(shown)),
                                layout="constrained", squeeze=False, dpi=DOTS)
    grid = grid[:, 0]
    x = np.arange(1, len(rows) + 1)
    edges = [0] + [k for k in range(1, len(rows)) if rows[k].block != rows[k - 1].block] + [len(rows)]
    size = 2.6 if len(rows) > 300 else 3.6
    top = limits(values)
    for axes, (side, colour) in zip(grid, shown):
        band(axes, rows, factor, x)
        for first, last in zip(edges, edges[1:]):
            if rows[first].final:
                axes.axvspan(first + 0.5, last + 0.5, color=PALE, alpha=0.55, linewidth=0, zorder=0.2)
            if first:
                axes.axvline(first + 0.5, color=RULE, linewidth=0.6, zorder=0.3)
        outlier = np.array([r.weight < 0.5 for r in rows])
        axes.plot(x[~outlier], values[side][~outlier], "o", color=colour, markersize=size, markeredgewidth=0, alpha=0.75,
                  rasterized=len(rows) > MANY)
        inside = outlier & (np.abs(values[side]) <= top)
        axes.plot(x[inside], values[side][inside], "x", color=INK, markersize=4.5)
        mark_beyond(axes, x, values[side], top)
        axes.set_ylim(-top, top)
        axes.yaxis.set_major_locator(MaxNLocator(5))
        axes.set_ylabel(axis_label(side if len(shown) > 1 else "residual", unit))
    grid[-1].set_xlim(0.5, len(rows) + 0.5)
    grid[-1].set_xlabel(f"reading, in {order}")
    blocks = [(first, last) for first, last in zip(edges, edges[1:]) if rows[first].block]
    if 1 < len(blocks) <= 30 and len(blocks) == len({rows[first].block for first, _ in blocks}):  # each in one place
        above = grid[0].secondary_xaxis("top")
        above.set_xticks([(first + last + 1) / 2 for first, last in blocks], [rows[first].block for first, _ in blocks])
        above.tick_params(length=0, labelsize=8)
        above.spines["top"].set_visible(False)
    return svg(figure, name, f"Residuals in {order}" + and_after(shown))


def averages(x, y):
    """Mean and twice its standard error, per value or in bins of equal numbers: x, mean, half-width."""
    good = np.isfinite(x) & np.isfinite(y)
    x, y = x[good], y[good]
    values = np.unique(x)
    if len(values) <= DISTINCT:
        groups = [x == v for v in values]
    else:
        bins = min(max(DISTINCT, min(30, len(x) // 8)), len(x) // LEAST)
        edges = np.unique(np.quantile(x, np.linspace(0, 1, bins + 1)))
        groups = [(x >= a) & ((x < b) | ((x <= b) & (b == edges[-1]))) for a, b in zip(edges, edges[1:])]
    groups = [g for g in groups if g.sum() >= LEAST]
    spread = [2 * y[g].std(ddof=1) / math.sqrt(g.sum()) for g in groups]
    return np.array([x[g].mean() for g in groups]), np.array([y[g].mean() for g in groups]), np.array(spread)


def has_averages(rows, by_reading):
    """Whether the figure against a condition shows averages."""
    rows, values = scored(rows)
    return len(averages(np.array([by_reading[r.reading] for r in rows]), values["before"])[0]) > 0


def points(axes, x, y, final, colour):
    """Every residual, those of final blocks open, and their averages."""
    for which, face in ((~final, colour), (final, "white")):
        axes.plot(x.jittered[which], y[which], "o", color=colour, markerfacecolor=face, markersize=2.8,
                  markeredgewidth=0.5 if face == "white" else 0, alpha=0.5, rasterized=len(y) > MANY)
    centre, mean, half = averages(x.values, y)
    axes.errorbar(centre, mean, half, color=INK, marker="o", markersize=3.2, linewidth=1, capsize=1.8, zorder=4)
    if len(x.distinct) <= 6:
        axes.xaxis.set_major_locator(FixedLocator(x.distinct))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:.4g}".replace("-", "−")))
    else:
        axes.xaxis.set_major_locator(MaxNLocator(7))
    axes.grid(axis="y", **GRID)
    return centre, mean


def abscissa(rows, by_reading):
    """Values of a condition by row; few distinct ones side by side, so that one sees how many there are."""
    x = np.array([by_reading[r.reading] for r in rows])
    distinct = np.unique(x[np.isfinite(x)])
    jitter = np.zeros(len(x))
    if len(distinct) <= DISTINCT:
        within = np.linspace(-1, 1, 41)[(np.arange(len(x)) * 17) % 41]
        jitter = within * min(0.35 * np.diff(distinct).min(), 0.02 * (distinct[-1] - distinct[0]))
    return types.SimpleNamespace(values=x, distinct=distinct, jittered=x + jitter)


def against(rows, columns, name):
    """Residuals against every condition that varies, before at the left and after at the right; if nothing was added,
    two conditions in a row."""
    rows, values = scored(rows)
    unit, factor = scale(rows)
    shown = sides(rows)
    lines = math.ceil(len(columns) * len(shown) / 2)
    figure, grid = plt.subplots(lines, 2, sharey=True, figsize=(WIDE, 0.4 + 1.9 * lines), layout="constrained",
                                squeeze=False, dpi=DOTS)
    top = limits({side: v * factor for side, v in values.items()})
    final = np.array([bool(r.final) for r in rows])
    panels = [(column, side) for column in columns for side in shown]
    for axes, ((title, x_unit, by_reading, chosen), (side, colour)) in zip(grid.flat, panels):
        x = abscissa(rows, by_reading)
        band(axes, rows, factor, x.values)
        centre, mean = points(axes, x, values[side] * factor, final, colour)
        mark_beyond(axes, x.jittered, values[side] * factor, top)
        mark_beyond(axes, centre, mean, top)
        axes.set_ylim(-top, top)
        axes.set_xlabel(axis_label(title, x_unit), fontweight="bold" if chosen else "normal")
    for axes in grid.flat[len(panels):]:
        axes.set_visible(False)
    for line in grid:
        line[0].set_ylabel(axis_label("residual", unit))
    if len(shown) > 1:
        for axes, (side, colour) in zip(grid[0], shown):
            axes.set_title(side, loc="left", fontsize=9, color=colour, fontweight="bold")
    return svg(figure, name, "Residuals against each condition" + and_after(shown))


def in_sequence(levels):
    """Numbers by size, words as they appear."""
    try:
        return sorted(levels, key=float)
    except ValueError:
        return levels


def by_label(rows, labels, blocks, name):
    """Mean residual of every value of a label with twice its standard error."""
    rows, values = scored(rows)
    unit, factor = scale(rows)
    both = sides(rows)
    shown = [(title, of) for title, of in labels.items()
             if 2 <= len({of[r.reading] for r in rows}) <= min(LEVELS, len(rows) // 2)]
    if not shown:
        return ""
    figure, grid = plt.subplots(len(shown), 1, figsize=(WIDE, 0.2 + 1.75 * len(shown)), layout="constrained", squeeze=False,
                                dpi=DOTS)
    for axes, (title, of) in zip(grid[:, 0], shown):
        levels = in_sequence(list(dict.fromkeys(of[r.reading] for r in rows)))
        place = {level: k for k, level in enumerate(levels)}
        at = np.array([place[of[r.reading]] for r in rows])
        axes.axhline(0, color=GREY, linewidth=0.6, zorder=0.5)
        for side, colour in both:
            y = values[side] * factor
            for k in range(len(levels)):
                here = y[(at == k) & np.isfinite(y)]
                if not len(here):
                    continue
                offset = 0 if len(both) == 1 else -0.14 if side == "before" else 0.14
                half = 2 * here.std(ddof=1) / math.sqrt(len(here)) if len(here) > 1 else 0
                axes.plot(k + offset + np.linspace(-0.07, 0.07, len(here)), here, "o", color=colour, markersize=2.2,
                          markeredgewidth=0, alpha=0.3, rasterized=len(rows) > MANY)
                axes.errorbar(k + offset, here.mean(), half, color=colour, marker="o", markersize=4.2, linewidth=1.3,
                              capsize=2.4, zorder=4, label=side if k == 0 else None)
        if title == blocks:
            for k, level in enumerate(levels):
                if any(r.final for r in rows if of[r.reading] == level):
                    axes.axvspan(k - 0.5, k + 0.5, color=PALE, alpha=0.55, linewidth=0, zorder=0)
        axes.set_xlim(-0.5, len(levels) - 0.5)
        axes.set_xticks(range(len(levels)), levels, rotation=90 if max(map(len, levels)) * len(levels) > 110 else 0)
        axes.tick_params(axis="x", length=0)
        axes.yaxis.set_major_locator(MaxNLocator(5))
        axes.set_xlabel(title)
        axes.set_ylabel(axis_label("residual", unit))
    if len(both) > 1:
        grid[0, 0].legend(loc="lower left", bbox_to_anchor=(-0.01, 1), ncols=2, frameon=False, fontsize=8)
    return svg(figure, name, "Residuals by label" + and_after(both))


def sizes(t, name):
    """Standard deviations of the residuals before, after and of noise alone, with what chance makes of it."""
    r, w = t.t.rms, t.factor
    found = [("hold-out", t.of_blocks(r.holdout), r.holdout_before, r.holdout_after,
              (r.holdout_noise, r.holdout_noise_low, r.holdout_noise_high)),
             ("worst block", t.of_blocks(r.worst_block), r.worst_block_before, r.worst_block_after, None),
             ("in sample", "training data", r.before, r.after, (r.noise, r.noise_low, r.noise_high))]
    found = [row for row in found if math.isfinite(row[2])]
    figure, axes = plt.subplots(figsize=(7.2, 0.65 + (0.66 if t.added else 0.48) * len(found)), layout="constrained")
    for k, (_, _, before, after, noise) in enumerate(found):
        bars = [("before", before, ORANGE), ("after", after, BLUE)] if t.added else [("residuals", before, BLUE)]
        bars += [("noise alone, with its range by chance (95\u202f%)", noise[0], NOISE)] if noise else []
        for place, (what, x, colour) in enumerate(bars):
            if not math.isfinite(x):
                continue
            y = k + 0.27 * (place - (1 if t.added else 0.5))
            axes.barh(y, w * x, height=0.25, color=colour, label=what if k == 0 else None)
            end = x
            if noise and place == len(bars) - 1 and math.isfinite(noise[1]) and math.isfinite(noise[2]):
                axes.plot([w * noise[1], w * noise[2]], [y, y], color=INK, linewidth=1, marker="|", markersize=5)
                end = max(x, noise[2])
            axes.annotate(t.number(x), (w * end, y), xytext=(5, 0), textcoords="offset points", va="center", fontsize=8)
    axes.invert_yaxis()
    axes.set_yticks(range(len(found)), [f"{kind}\n{textwrap.shorten(what.split(';')[0], 34, placeholder=' …')}" for kind, what, *_ in found])
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.set_xlim(0, 1.1 * w * max(x for row in found for x in (*row[2:4], *(row[4] or ())) if math.isfinite(x)))
    axes.set_xlabel(axis_label("residual standard deviation", t.unit))
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1), ncols=3, frameon=False, fontsize=8)
    return svg(figure, name, f"Residual standard deviation{' before and after' if t.added else ''}, compared with noise alone")


def cells(t, name):
    """An unknown effect by all that it depends on: a line along the key of most levels for each combination of the others."""
    keys = {n: compensation.shown(key) for n, key in t.keys.items()}
    numeric = [n for n, (values, _) in keys.items() if not isinstance(values[0], str)]
    if not numeric:
        return ""
    along = max(numeric, key=lambda n: len(set(keys[n][0])))
    others = [n for n in keys if n != along]
    groups = {}
    for k in range(len(t.rows)):
        groups.setdefault(tuple(keys[n][0][k] for n in others), []).append(k)
    if len(groups) > LINES:
        return ""
    unit, factor = compensation.unit_of(t)
    figure, axes = plt.subplots(figsize=(7.2, 2.8), layout="constrained")
    axes.axhline(0, color=GREY, linewidth=0.6)
    for (level, members), colour in zip(groups.items(), (BLUE, ORANGE, INK, GREY)):
        members.sort(key=lambda k: keys[along][0][k])
        x, y, u = ([f(k) for k in members] for f in (lambda k: keys[along][0][k], lambda k: factor * t.rows[k].y,
                                                       lambda k: 2 * factor * t.rows[k].u))
        # The groups of a label have its name: "probe P1".
        what = ", ".join((v if isinstance(v, str) else f"{axis_label(n, '')} {v:.4g}").replace("-", "−") for n, v in zip(others, level))
        axes.errorbar(x, y, u, color=colour, marker="o", markersize=3.5, linewidth=1.3, capsize=2.2, label=what or None)
    if others:
        axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 1), ncols=2, frameon=False, fontsize=8)
    axes.grid(**GRID)
    axes.set_xlabel(axis_label(along, keys[along][1]))
    axes.set_ylabel(axis_label(f"error in {t.indication}", unit))
    return svg(figure, name, f"Error of the unknown effect against {along.replace('_', ' ')}")


def curves(found, name):
    """What is not in the catalogue, against what it depends on; twice its standard uncertainty shaded."""
    if not found:
        return ""
    figure, grid = plt.subplots(1, len(found), sharey=True, squeeze=False, layout="constrained",
                                figsize=(7.2 if len(found) > 1 else 4.8, 2.5))
    size = max(abs(p.y) for c in found for p in c.rows) * found[0].size_display_factor
    unit, further = finer(found[0].size_display_units, size)
    for axes, c in zip(grid[0], found):
        scaled = further * c.size_display_factor
        y, u = (scaled * np.array([getattr(p, key) for p in c.rows]) for key in ("y", "u"))
        if hasattr(c.rows[0], "level"):
            axes.errorbar(range(len(y)), y, 2 * u, color=INK, marker="o", markersize=4, linestyle="none", capsize=2.4)
            axes.set_xticks(range(len(y)), [p.level for p in c.rows], rotation=90 if len(y) > 12 else 0)
            axes.set_xlabel(c.against.replace("_", " "))
        else:
            along, factor, offset = axis_unit(c, [p.x for p in c.rows])
            x = np.array([p.x * factor + offset for p in c.rows])
            axes.fill_between(x, y - 2 * u, y + 2 * u, color=PALE, linewidth=0)
            axes.plot(x, y, color=BLUE, linewidth=1.5)
            axes.set_xlabel(axis_label(c.against, along))
        axes.axhline(0, color=GREY, linewidth=0.6)
        axes.grid(**GRID)
    indication = found[0].indication.replace("_", " ")
    grid[0, 0].set_ylabel(axis_label(f"in {indication}", unit))
    return svg(figure, name, "Size of what is not in the catalogue: " +
               ", ".join(f"against {c.against}" for c in found))
