"""Figures of a choice: U over two variables with the region that meets the target, or over one."""
import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LinearSegmentedColormap, TwoSlopeNorm
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator
from matplotlib.tri import LinearTriInterpolator, Triangulation

from .choice import axis_label, plain_number, refuted
from .figures import BLUE, GREY, GRID, INK, ORANGE, PALE, svg

FEASIBLE = LinearSegmentedColormap.from_list("target", [  # a step at the target, in the middle
    (0, BLUE), (0.5, "#cfe2f2"), (0.5, "#fde3d0"), (1, ORANGE)])
MARK, LIGHT = "#1f2934", "#fefefe"  # on the map, whose colours stay when the page is dark
PREFERRED = ("feed", "spindle_speed")  # what a reader looks for first


def numeric(c):
    return [k for k, v in enumerate(c.variables) if v.kind != "evaluation"]


def influence(c, k):
    """Share of the variance of ln U over the coarse grid that this variable's values explain."""
    groups = {}
    for row in c.candidates:
        if row.round == 0 and row.asked > 0:
            groups.setdefault(row.values[k], []).append(math.log(row.asked))
    everything = [x for g in groups.values() for x in g]
    mean = np.mean(everything) if everything else 0
    return sum(len(g) * (np.mean(g) - mean) ** 2 for g in groups.values())


def drawn_variables(c):
    """At most two numeric variables, by position: feed and speed, else those U depends on most. The range first."""
    known = [k for k in numeric(c) if len({row.values[k] for row in c.candidates}) > 1]
    named = [k for name in PREFERRED for k in known if c.variables[k].name == name]
    chosen = named if len(named) == 2 else sorted(known, key=lambda k: -influence(c, k))[:2]
    return sorted(chosen, key=lambda k: (not c.variables[k].range, chosen.index(k)))


def on_scale(v, x):
    return np.log(x) if v.logarithmic else np.asarray(x, float)


def plane(c, axes):
    """Candidates of the plane through the recommended setting: one per place, the nearest in the other variables.

    A list's value must be the recommended one's; a range's at most half a coarse step off."""
    best = c.candidates[int(c.best)]
    found = {}
    for row in c.candidates:
        away = 0.0
        for k, v in enumerate(c.variables):
            if k in axes:
                continue
            coarse = np.unique([on_scale(v, r.values[k]) for r in c.candidates if r.round == 0])
            reach = 0.501 * float(np.max(np.diff(coarse))) if v.range and len(coarse) > 1 else 1e-9
            distance = abs(float(on_scale(v, row.values[k]) - on_scale(v, best.values[k])))
            away = math.inf if distance > reach + 1e-12 * abs(best.values[k]) else away + distance / max(reach, 1e-300)
        place = tuple(row.values[k] for k in axes)
        if math.isfinite(away) and (place not in found or away < found[place][0]):
            found[place] = (away, row)
    return [row for _, row in found.values()]


def colours(c, logs):
    """Scale of ln(U / target) with the target in the middle."""
    known = logs[np.isfinite(logs)]
    low, high = min(known.min(), -0.05), max(known.max(), 0.05)
    return TwoSlopeNorm(0, max(low, -math.log(20)), min(high, math.log(20)))


def ticks(v, axis, values):
    """Of a list its values, at 0, 1, ...; of a range plain numbers."""
    if v is None or not v.range:
        axis.set_ticks(range(len(values)), [plain_number(x) for x in values])
        axis.set_tick_params(length=0)
    else:
        if v.logarithmic:
            (axis.axes.set_xscale if axis.axis_name == "x" else axis.axes.set_yscale)("log")
            axis.set_major_locator(LogLocator(subs=(1, 3) if values[-1] > 8 * values[0] else (1, 2, 3, 5, 7)))
            axis.set_minor_formatter(FuncFormatter(lambda *_: ""))
        else:
            axis.set_major_locator(MaxNLocator(7))
        axis.set_major_formatter(FuncFormatter(lambda x, _: plain_number(x)))


def mesh(c, picked, rows):
    """Edges in display units and ln(U / target) between the tried places: along a range linear on its scale."""
    shown = [np.array([r.values[k] for r in rows]) * c.variables[k].display_factor + c.variables[k].display_offset
             for k in picked]
    logs = np.array([math.log(r.asked / c.target) if r.asked > 0 else math.nan for r in rows])
    lists = [np.unique(s) for s in shown]
    edges, centres = [], []
    for k, s in zip(picked, shown):
        v = c.variables[k]
        if v.range:
            grid = np.linspace(*on_scale(v, np.array([s.min(), s.max()])), 161)
            edges.append(np.exp(grid) if v.logarithmic else grid)
            centres.append((grid[1:] + grid[:-1]) / 2)
        else:
            count = len(np.unique(s))
            edges.append(np.arange(count + 1) - 0.5)
            centres.append(np.arange(count))
    vx, vy = (c.variables[k] for k in picked)
    surface = np.full((len(centres[1]), len(centres[0])), math.nan)
    if vx.range and vy.range:
        usable = np.isfinite(logs)
        place = [on_scale(v, s)[usable] for v, s in zip((vx, vy), shown)]
        unit = [(p - p.min()) / max(np.ptp(p), 1e-300) for p in place]
        x, y = np.meshgrid(*[(m - p.min()) / max(np.ptp(p), 1e-300) for m, p in zip(centres, place)])
        surface = LinearTriInterpolator(Triangulation(*unit), logs[usable])(x, y).filled(math.nan)
    else:
        for j, value in enumerate(lists[1]):
            row = np.flatnonzero(shown[1] == value)
            row = row[np.argsort(shown[0][row])]
            if vx.range:
                surface[j] = np.interp(centres[0], on_scale(vx, shown[0][row]), logs[row], left=math.nan,
                                       right=math.nan)
            else:
                surface[j, np.searchsorted(lists[0], shown[0][row])] = logs[row]
    return shown, lists, edges, centres, logs, surface


def heat(c, name):
    """U over two variables through the recommended setting, the target's colour white; "" where two do not vary."""
    picked = drawn_variables(c)
    rows = plane(c, picked)
    if len(picked) < 2 or any(len({r.values[k] for r in rows}) < 2 for k in picked):
        return "", ""
    shown, lists, edges, centres, logs, surface = mesh(c, picked, rows)
    if not np.isfinite(surface).any():
        return "", ""
    vx, vy = (c.variables[k] for k in picked)
    norm = colours(c, logs)
    figure, axes = plt.subplots(figsize=(7.2, 3.6 if vy.range else 1.3 + 0.45 * len(lists[1])), layout="constrained")
    image = axes.pcolormesh(*edges, np.ma.masked_invalid(surface), cmap=FEASIBLE, norm=norm, rasterized=True)
    middle = [np.exp(m) if v.range and v.logarithmic else m for v, m in zip((vx, vy), centres)]
    if vy.range and np.nanmin(surface) < 0 < np.nanmax(surface):
        axes.contour(*middle, np.ma.masked_invalid(surface), levels=[0], colors=MARK, linewidths=1.3)
    elif vx.range:
        for j, line in enumerate(surface):
            for k in np.flatnonzero(np.diff(np.sign(line)) != 0):
                if np.isfinite(line[k] + line[k + 1]):
                    axes.vlines(edges[0][k + 1], j - 0.5, j + 0.5, color=MARK, linewidth=1.3)
    place = [s if v.range else np.searchsorted(l, s) for v, s, l in zip((vx, vy), shown, lists)]
    confirmed = lambda r: bool(r.meets) and not refuted(r)
    meets = np.array([confirmed(r) for r in rows])
    if vx.range:
        axes.plot(place[0][meets], place[1][meets], "o", color=MARK, markersize=3)
        axes.plot(place[0][~meets], place[1][~meets], "o", markerfacecolor="none", markeredgecolor=MARK, markersize=3,
                  markeredgewidth=0.6)
        failed = np.array([r.failed > 0 for r in rows])
        axes.plot(place[0][failed], place[1][failed], "x", color=MARK, markersize=5, markeredgewidth=0.8)
    else:
        for x, y, r in zip(*place, rows):
            axes.text(x, y, plain_number(float(f"{r.asked * c.display_factor:.2g}")) if r.asked > 0 else "no value",
                      ha="center", va="center", fontsize=8, weight="bold" if confirmed(r) else "normal",
                      color=LIGHT if r.asked > 0 and abs(norm(math.log(r.asked / c.target)) - 0.5) > 0.35 else MARK)
    best = c.candidates[int(c.best)]
    at = [best.values[k] * v.display_factor + v.display_offset for k, v in zip(picked, (vx, vy))]
    at = [a if v.range else int(np.searchsorted(l, a)) for a, v, l in zip(at, (vx, vy), lists)]
    axes.plot(at[0], at[1] if vx.range else at[1] + 0.3, "*", color=LIGHT, markersize=13, markeredgecolor=MARK, zorder=5,
              clip_on=False)
    ticks(vx, axes.xaxis, lists[0])
    ticks(vy, axes.yaxis, lists[1])
    axes.set_xlabel(axis_label(vx.name, vx.display_units))
    axes.set_ylabel(axis_label(vy.name, vy.display_units))
    bar = figure.colorbar(image, ax=axes, pad=0.02, aspect=18 if vy.range else 10)
    target = c.target * c.display_factor
    places = [m * 10.0 ** e for e in range(math.floor(math.log10(target)) - 2, math.floor(math.log10(target)) + 3)
              for m in (1, 1.5, 2, 3, 4, 5, 7)]
    marks = [m for m in places if norm.vmin <= math.log(m / target) <= norm.vmax and
             abs(norm(math.log(m / target)) - 0.5) > 0.08]
    height = lambda m: norm(math.log(m / target))
    marks = [m for k, m in enumerate(marks) if k == 0 or height(m) - height(marks[k - 1]) > 0.04]
    marks = [target, *marks]
    bar.set_ticks([math.log(m / target) for m in marks], labels=[plain_number(m) for m in marks])
    bar.ax.tick_params(length=2)
    bar.outline.set_visible(False)
    bar.set_label(axis_label("U", c.display_units), fontsize=8)
    what = f"{vx.name.replace('_', ' ')} and {vy.name.replace('_', ' ')}"
    return svg(figure, name, f"Expanded uncertainty over {what}, with the region that meets the target"), what


def legend(c):
    """What the caption of the surface has to explain."""
    picked = drawn_variables(c)
    ranges = [c.variables[k].range for k in picked]
    return {"dots": any(ranges), "lines": any(ranges),
            "others": [k for k in range(len(c.variables)) if k not in picked],
            "other_ranges": any(v.range for k, v in enumerate(c.variables) if k not in picked)}


def line(c, name):
    """U and time over the one numeric variable, the others as recommended; "" if there is none."""
    picked = drawn_variables(c)[:1]
    rows = plane(c, picked) if picked else []
    if len(rows) < 2:
        return "", ""
    v = c.variables[picked[0]]
    rows.sort(key=lambda r: r.values[picked[0]])
    x = [r.values[picked[0]] * v.display_factor + v.display_offset for r in rows]
    figure, (top, low) = plt.subplots(2, 1, sharex=True, figsize=(7.2, 4.2), layout="constrained",
                                      gridspec_kw={"height_ratios": [2, 1]})
    U, se = ([getattr(r, key) * c.display_factor for r in rows] for key in ("asked", "asked_se"))
    top.errorbar(x, U, yerr=se, fmt="o-", color=BLUE, ecolor=GREY, elinewidth=0.8, markersize=4, linewidth=1)
    top.axhline(c.target * c.display_factor, color=ORANGE, linewidth=1, linestyle=(0, (5, 2)))
    top.fill_between(x, 0, c.target * c.display_factor, color=PALE, alpha=0.6, linewidth=0)
    top.set_ylim(bottom=0)
    low.plot(x, [r.time for r in rows], "o-", color=GREY, markersize=4, linewidth=1)
    best = c.candidates[int(c.best)]
    top.plot([best.values[picked[0]] * v.display_factor + v.display_offset], [best.asked * c.display_factor], "*",
             color=ORANGE, markersize=14, markeredgecolor="white", zorder=5)
    if v.logarithmic:
        ticks(v, low.xaxis, x)
    top.set_ylabel(axis_label("U", c.display_units))
    low.set_ylabel("time, s")
    low.set_xlabel(axis_label(v.name, v.display_units))
    for axes in (top, low):
        axes.grid(**GRID)
    return svg(figure, name, f"Expanded uncertainty and time over {v.name}"), v.name.replace("_", " ")
