"""Stored draws of the inputs against a measurand: samples, means in bins, and the line of the sensitivity coefficient."""
import math
import types

import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator

from . import rounding
from .figures import BLUE, GRID, INK, ORANGE, scaler, svg

PANELS, SAMPLES, BINS = 6, 4000, 16
VISIBLE = 0.01  # of the variance, explained by the means in bins; less is not drawn


def draws(path, output):
    """The output's first samples and the deviations drawn for them, SI; (None, []) where they are not stored."""
    with h5py.File(path, "r") as file:
        group, values = file.get("draws"), file.get(f"outputs/{output.measurand}")
        if group is None or values is None or values.ndim != 2:
            return None, []
        y = values[min(int(output.reading), values.shape[0] - 1), :SAMPLES]
        known = np.isfinite(y)
        rows = zip(group["component"].asstr()[()], group["display_units"].asstr()[()], group["display_factor"][()],
                   group["deviation"][:, :SAMPLES])
        return y[known], [types.SimpleNamespace(name=name, display_units=unit, factor=factor, x=x[known])
                          for name, unit, factor, x in rows]


def means(x, y):
    """Means in bins of equal numbers: x, y."""
    parts = np.array_split(np.argsort(x, kind="stable"), BINS)
    return np.array([x[p].mean() for p in parts]), np.array([y[p].mean() for p in parts])


def explained(x, y):
    """Share of the variance of y that its means in bins explain, less what chance gives them."""
    share = means(x, y)[1].var() / y.var() if np.ptp(x) > 0 and y.var() > 0 else 0.0
    return max(0.0, share - (BINS - 1) / len(y))


def panel(axes, draw, y, slope):
    """`y` in the units of the axis, `slope` of it by the input in SI, NaN where there is none."""
    unit, finer = rounding.finer(draw.display_units, draw.x.std() * draw.factor)
    factor = finer * draw.factor
    x = draw.x * factor
    axes.plot(x, y, "o", color=BLUE, markersize=1.5, markeredgewidth=0, alpha=0.3, rasterized=True)
    if math.isfinite(slope):
        ends = np.array([draw.x.min(), draw.x.max()])
        axes.plot(ends * factor, slope * (ends - draw.x.mean()) + y.mean(), color=ORANGE, linewidth=1.2,
                  linestyle=(0, (5, 2)))
    axes.plot(*means(x, y), "o-", color=INK, markersize=2.6, linewidth=1)
    unit = rounding.unit_text(unit)
    axes.set_xlabel(draw.name + (f", {unit}" if unit else ""), fontsize=8)
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes.tick_params(labelsize=7.5)
    axes.grid(**GRID)


def figure(path, output, budget, name):
    """The inputs that explain most of the output; "" without stored draws."""
    values, known = draws(path, output)
    if values is None or len(values) < 10 * BINS:
        return ""
    to_axis, label = scaler(output)
    y = to_axis(values)
    weight = {d.name: explained(d.x, y) for d in known}
    shown = sorted((d for d in known if weight[d.name] > VISIBLE), key=lambda d: -weight[d.name])[:PANELS]
    if not shown:
        return ""
    slopes = {c.name: c.sensitivity for c in budget.rows} if budget else {}
    columns = 2 if len(shown) == 4 else min(3, len(shown))
    lines = math.ceil(len(shown) / columns)
    drawn, grid = plt.subplots(lines, columns, sharey=True, squeeze=False, layout="constrained", dpi=150,
                               figsize=(7.2 if columns > 1 else 4.2, 0.3 + 2.1 * lines))
    for axes in grid.flat[len(shown):]:
        axes.set_visible(False)
    for axes, d in zip(grid.flat, shown):
        panel(axes, d, y, slopes.get(d.name, math.nan) * float(to_axis(1.0) - to_axis(0.0)))
    unit = label.rpartition(", in ")[2] if ", in " in label else ""
    for line in grid:
        line[0].set_ylabel(output.name + (f", deviation in {unit}" if unit else ""), fontsize=8)
    return svg(drawn, name, f"Inputs against {output.name}: samples, means in bins and the linear model")
