"""Figure of all outputs of one measurand: estimates with their intervals, on axes short enough to show the intervals."""
import math

import matplotlib.pyplot as plt
import numpy as np

from . import profile, rounding
from .figures import BLUE, GRID, extent, svg

HIDDEN = 40   # an axis this many times as long as a half-width of the intervals hides them
SHORTER = 0.3  # a split is worth it if each of its axes is at most this share of the whole
MOST = 8      # panels


def shown(o, si):
    return si * o.display_factor + o.display_offset


def middles(outputs):
    return [shown(o, extent(o)[0]) for o in outputs]


def length(outputs):
    return float(np.ptp(middles(outputs)))


def width(outputs):
    return max(float(np.median([extent(o)[1] * o.display_factor for o in outputs])), 1e-300)


def panels(outputs):
    """(title, outputs) of each panel: one for all, or one for each value of the label that brings near what is compared."""
    whole = [("", outputs)]
    if not length(outputs) > HIDDEN * width(outputs):
        return whole
    texts = [profile.parts(o.name) for o in outputs]
    splits = []
    for k in range(min(map(len, texts))):
        groups = {}
        for text, o in zip(texts, outputs):
            groups.setdefault(text[k], []).append(o)
        if 2 <= len(groups) <= MOST and min(map(len, groups.values())) > 1:
            splits.append((max(map(length, groups.values())), k, groups))
    longest, _, groups = min(splits, default=(math.inf, 0, {}))
    return list(groups.items()) if longest < SHORTER * length(outputs) else whole


def draw(axes, title, outputs, unit, factor, step):
    """Deviations from the middle of a panel."""
    middle = float(np.mean(middles(outputs)))
    middle = middle if step is None else round(middle, step)
    for k, o in enumerate(outputs):
        ends = [(shown(o, e) - middle) * factor for e in (o.symmetric_low, o.symmetric_high)]  # NaN draws nothing
        axes.plot(ends, [k, k], color=BLUE, linewidth=1.8, solid_capstyle="butt")
        if math.isfinite(o.estimate):
            axes.plot((shown(o, o.estimate) - middle) * factor, k, "o", color=BLUE, markersize=5)
    axes.set_yticks(range(len(outputs)), [o.name for o in outputs])
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(len(outputs) - 0.5, -0.5)
    axes.grid(axis="x", **GRID)
    axes.spines["left"].set_visible(False)
    origin = f"{rounding.fixed(middle, step)} {rounding.unit_text(outputs[0].display_units)}".strip()
    axes.set_xlabel(f"deviation from {origin}" + (f", in {rounding.unit_text(unit)}" if unit != "1" else ""))
    if title:
        axes.set_title(title, loc="left", fontsize=9)


def overview(outputs, name):
    """Estimate and symmetric interval of every output of one measurand."""
    parts = panels(outputs)
    unit, factor = rounding.finer(outputs[0].display_units, width(outputs))
    step = rounding.decimals(width(outputs))
    figure, grid = plt.subplots(len(parts), 1, figsize=(7.2, 0.7 * len(parts) + 0.26 * len(outputs)), layout="constrained", squeeze=False,
                                gridspec_kw={"height_ratios": [1.5 + len(group) for _, group in parts]})
    for axes, (title, group) in zip(grid[:, 0], parts):
        draw(axes, title, group, unit, factor, step)
    return svg(figure, name, f"Estimates and coverage intervals of {outputs[0].measurand}")
