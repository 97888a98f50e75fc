"""Stored draws of the inputs against a measurand: points, the mean in bins, and the line of the sensitivity coefficient."""
import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator

from . import rounding
from .figures import BLUE, GREY, GRID, INK, ORANGE, scaler, svg

PANELS, POINTS, BINS = 6, 1500, 12


def means(x, y):
    """Means in bins of equal numbers: x, y."""
    order = np.argsort(x, kind="stable")
    parts = [p for p in np.array_split(order, BINS) if len(p)]
    return np.array([x[p].mean() for p in parts]), np.array([y[p].mean() for p in parts])


def panel(axes, draw, x, y, slope):
    """`x`, `y` in the units of the axes; `slope` of the law of propagation, NaN where there is none."""
    step = max(1, len(x) // POINTS)
    axes.plot(x[::step], y[::step], "o", color=BLUE, markersize=1.6, markeredgewidth=0, alpha=0.35, rasterized=True)
    if math.isfinite(slope):
        ends = np.array([x.min(), x.max()])
        axes.plot(ends, slope * (ends - x.mean()) + y.mean(), color=ORANGE, linewidth=1.1, linestyle=(0, (5, 2)))
    axes.plot(*means(x, y), "o-", color=INK, markersize=2.6, linewidth=1)
    unit = rounding.unit_text(draw.display_units)
    axes.set_xlabel(draw.name + (f", {unit}" if unit else ""), fontsize=8)
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes.tick_params(labelsize=7.5)
    axes.grid(**GRID)


def figure(output, values, draws, budget, name):
    """`values`: of the output by sample; `draws`: name, display columns and values by sample, the largest first."""
    good = np.isfinite(values)
    shown = [d for d in draws if np.ptp(d.values[good]) > 0][:PANELS] if good.sum() >= 10 * BINS else []
    if not shown:
        return ""
    to_axis, label = scaler(output)
    y = to_axis(values[good])
    per_si = float(to_axis(1.0) - to_axis(0.0))
    slopes = {c.name: c.sensitivity for c in budget.rows} if budget else {}
    columns = min(3, len(shown))
    lines = math.ceil(len(shown) / columns)
    drawn, grid = plt.subplots(lines, columns, sharey=True, squeeze=False, layout="constrained", dpi=150,
                               figsize=(7.2 if columns > 1 else 4.2, 0.3 + 2.1 * lines))
    for axes in grid.flat[len(shown):]:
        axes.set_visible(False)
    for axes, d in zip(grid.flat, shown):
        panel(axes, d, d.values[good] * d.display_factor + d.display_offset, y,
              slopes.get(d.name, math.nan) * per_si / d.display_factor)
    for line in grid:
        unit = label.rpartition(", in ")[2] if ", in " in label else ""
        line[0].set_ylabel(output.name + (f", deviation in {unit}" if unit else ""), fontsize=8)
    return svg(drawn, name, f"Inputs against {output.name}: samples, means in bins and the linear model")
