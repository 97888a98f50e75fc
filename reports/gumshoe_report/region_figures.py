"""Figures of regions: joint coverage regions, conformity."""
import itertools
import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Ellipse, Rectangle
from matplotlib.ticker import MaxNLocator

from . import rounding
from .figures import BLUE, GREY, GRID, INK, ORANGE, PALE, histogram, scaler, svg, view


def drawn_pairs(region):
    """Pairs of outputs that both vary, at most six."""
    varying = [k for k, row in enumerate(region.rows) if row.covariance[k] > 0]
    return list(itertools.combinations(varying, 2))[:6]


def joint(region, name):
    """For each pair: the ellipse (of several measurands: the ellipsoid's shadow) and the rectangle."""
    couples = drawn_pairs(region)
    if not couples or not math.isfinite(region.k_q):
        return ""
    columns = min(3, len(couples))
    lines = math.ceil(len(couples) / columns)
    size = (2.6 * columns, 2.6 * lines) if columns > 1 else (4.2, 3.4)
    figure, grid = plt.subplots(lines, columns, figsize=size, layout="constrained", squeeze=False)
    for axes in grid.flat[len(couples):]:
        axes.set_visible(False)
    for axes, (a, b) in zip(grid.flat, couples):
        scaled = []
        for k in (a, b):
            row = region.rows[k]
            u = math.sqrt(row.covariance[k]) * row.display_factor
            unit, factor = rounding.finer(row.display_units, u)
            scaled.append((u * factor, rounding.unit_text(unit), factor * row.display_factor))
        (ua, unit_a, fa), (ub, unit_b, fb) = scaled
        axes.add_patch(Rectangle((-region.k_q * ua, -region.k_q * ub), 2 * region.k_q * ua, 2 * region.k_q * ub,
                                 fill=False, edgecolor=ORANGE, linewidth=1.4, linestyle=(0, (5, 2))))
        if math.isfinite(region.k_p):
            matrix = np.array([[ua ** 2, region.rows[a].covariance[b] * fa * fb],
                               [region.rows[a].covariance[b] * fa * fb, ub ** 2]])
            values, vectors = np.linalg.eigh(matrix)
            axis = region.k_p * np.sqrt(np.clip(values, 0, None))
            axes.add_patch(Ellipse((0, 0), 2 * axis[1], 2 * axis[0], facecolor=PALE, edgecolor=BLUE, linewidth=1.4,
                                   angle=math.degrees(math.atan2(vectors[1, 1], vectors[0, 1])), zorder=0))
        axes.plot(0, 0, "+", color=INK, markersize=7)
        reach = 1.18 * max(region.k_q, region.k_p if math.isfinite(region.k_p) else 0)
        axes.set_xlim(-reach * ua, reach * ua)
        axes.set_ylim(-reach * ub, reach * ub)
        axes.grid(**GRID)
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.yaxis.set_major_locator(MaxNLocator(5))
        axes.set_xlabel(region.rows[a].name + (f", {unit_a}" if unit_a else ""), fontsize=8)
        axes.set_ylabel(region.rows[b].name + (f", {unit_b}" if unit_b else ""), fontsize=8)
    names = ", ".join(row.name for row in region.rows)
    return svg(figure, name, f"Joint coverage regions of {names}: ellipse and rectangle as deviations from the estimates")


def conformity(c, output, name):
    """The distribution with what lies beyond the tolerance shaded, and the acceptance limits."""
    if output is None or not len(output.histogram):
        return ""
    to_axis, label = scaler(output)
    figure, axes = plt.subplots(figsize=(7.2, 2.3), layout="constrained")
    histogram(axes, output, to_axis)
    edges = to_axis(output.histogram_edges)
    density = output.histogram * (output.histogram_edges[-1] - output.histogram_edges[0]) / (edges[-1] - edges[0])
    tolerance = [float(to_axis(v)) if math.isfinite(v) else v for v in (c.lower, c.upper)]
    acceptance = [float(to_axis(v)) if math.isfinite(v) else v for v in (c.acceptance_lower, c.acceptance_upper)]
    for limit, side in zip(tolerance, (-1, 1)):
        if math.isfinite(limit):
            beyond = np.minimum(edges, limit) if side < 0 else np.maximum(edges, limit)  # bins within: no width
            axes.stairs(density, beyond, fill=True, color=ORANGE, alpha=0.75)
    low, high = view(output, to_axis, None)
    known = [v for v in tolerance + acceptance if math.isfinite(v)]
    low, high = min([low] + known), max([high] + known)
    room = 0.05 * (high - low)
    axes.set_xlim(low - room, high + room)
    top = 1.08 * density.max()
    axes.set_ylim(0, top)
    if c.guard_band != 0:
        for t, a in zip(tolerance, acceptance):
            if math.isfinite(t):
                axes.axvspan(min(t, a), max(t, a), color=GREY, alpha=0.13, linewidth=0)
    for limits, colour, style, text in ((tolerance, INK, "-", "tolerance limit"),
                                        (acceptance if c.guard_band != 0 else [], BLUE, (0, (4, 2)), "acceptance limit")):
        drawn = [v for v in limits if math.isfinite(v)]
        for k, v in enumerate(drawn):
            axes.axvline(v, color=colour, linewidth=1.2, linestyle=style, label=text if k == 0 else None)
    axes.plot(float(to_axis(c.estimate)), 0.02 * top, "^", color=BLUE if c.accepted else ORANGE, markersize=8,
              linestyle="none", label="estimate", clip_on=False, zorder=5)
    axes.legend(loc="upper center", ncols=3, frameon=False, fontsize=8, bbox_to_anchor=(0.5, 1.24))
    axes.set_xlabel(label)
    return svg(figure, name, f"Distribution of {c.name} with tolerance and acceptance limits; beyond the tolerance shaded")
