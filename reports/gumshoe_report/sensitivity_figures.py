"""Figures of sensitivity: tornado plot and indices side by side, Morris."""
import math
import textwrap

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator

from . import resolved, rounding
from .figures import BLUE, GREY, GRID, INK, ORANGE, svg

MOST, FEWEST = 12, 4  # bars; the rest is one bar
VISIBLE = 5e-4        # of the variance: less is no bar of its own


def short(name, width=30):
    return "\n".join(textwrap.wrap(name, width, break_long_words=True)[:2]) or name


def bare(axes):
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", **GRID)
    axes.xaxis.set_major_locator(MaxNLocator(5))


def tornado(axes, contributions, order, rest, unit, factor):
    """Signed bars c_i u_i; what is left out as one root sum of squares."""
    for y, name in enumerate(order):
        c = contributions.get(name)
        if c is None:
            continue
        if not c.differentiable:
            axes.annotate("no derivative", (0, y), xytext=(4, 0), textcoords="offset points", va="center", fontsize=7.5,
                          color=ORANGE)
        elif not math.isfinite(c.contribution):
            axes.annotate("no standard uncertainty", (0, y), xytext=(4, 0), textcoords="offset points", va="center",
                          fontsize=7.5, color=ORANGE)
        elif c.contribution == 0:
            axes.annotate("0", (0, y), xytext=(4, 0), textcoords="offset points", va="center", fontsize=8, color=GREY)
        else:
            value = math.copysign(c.contribution, c.sensitivity) * factor
            axes.barh(y, value, height=0.55, color=BLUE if value > 0 else ORANGE, alpha=0.9)
    if rest:
        value = factor * math.sqrt(sum(c.contribution ** 2 for c in rest if math.isfinite(c.contribution)))
        axes.barh(len(order), value, height=0.55, color=GREY, alpha=0.6)
    axes.axvline(0, color=INK, linewidth=0.8)
    axes.spines["left"].set_visible(False)
    axes.margins(x=0.12)
    bare(axes)
    unit = rounding.unit_text(unit)
    axes.set_xlabel("c_i u_i" + (f", in {unit}" if unit else ""))
    axes.set_title("Budget (GUM): contributions", loc="left", fontsize=9, color=INK)


def index_bars(axes, rows, order, bars):
    """Bars with intervals; an index that is not resolved is pale and says why."""
    for key, shift, height, colour, label in bars:
        axes.barh([0], [0], color=colour, label=label)
        for y, name in enumerate(order):
            row = rows.get(name)
            if row is None or not math.isfinite(getattr(row, key)):
                continue
            word = getattr(row, key + "_verdict", getattr(row, "verdict", "resolved"))
            ends = [getattr(row, key + "_low"), getattr(row, key + "_high")]
            axes.barh(y + shift, max(getattr(row, key), 0), height=height, color=colour,
                      alpha=0.9 if word in ("resolved", "") else 0.35)
            axes.hlines(y + shift, *ends, color=INK, linewidth=1)
            if word not in ("resolved", ""):
                axes.text(max([0] + [end for end in ends if math.isfinite(end)]), y + shift,
                          " " + ("≈ 0" if word.startswith("zero") else word), va="center",
                          fontsize=6.5, color=GREY)
    lows = [getattr(r, bars[0][0] + "_low") for r in rows.values()]
    axes.set_xlim(left=min([0] + [low for low in lows if math.isfinite(low)]))
    axes.margins(x=0.1)
    bare(axes)


def side_by_side(budget, sobol, shapley, name):
    """Tornado plot of the budget, next to the indices of the same quantities if there are any."""
    contributions = {c.name: c for c in resolved.without_dust(budget).rows} if budget else {}
    indices = sobol or shapley
    rows = {i.input: i for i in indices.rows} if indices else {}
    bars = ([("first", -0.19, 0.32, BLUE, "first order"), ("total", 0.19, 0.32, ORANGE, "total")] if sobol else
            [("effect", 0, 0.5, BLUE, "Shapley effect")])

    def weight(n):
        share = contributions[n].share if n in contributions else math.nan
        values = [share, getattr(rows.get(n), bars[-1][0], math.nan)]
        return -max([v for v in values if math.isfinite(v)] + [0])
    names = sorted(dict.fromkeys([*contributions, *rows]), key=weight)
    order = [n for k, n in enumerate(names) if k < FEWEST or weight(n) <= -VISIBLE]
    order = order if len(order) <= MOST + 1 else order[:MOST]
    if len(order) + 1 >= len(names):
        order = names  # one bar for one quantity would hide its name and save nothing
    left_out = [n for n in names if n not in order]
    rest = [contributions[n] for n in left_out if n in contributions]
    has_budget = resolved.has_contributions(contributions.values())
    panels = has_budget + bool(rows)
    if panels == 0:
        return ""
    figure, grid = plt.subplots(1, panels, sharey=True, layout="constrained", squeeze=False,
                                figsize=(7.2, 0.95 + 0.34 * (len(order) + bool(left_out))))
    if has_budget:
        largest = max(c.contribution for c in contributions.values() if math.isfinite(c.contribution))
        unit, factor = rounding.finer(budget.display_units, largest * budget.display_factor)
        tornado(grid[0][0], contributions, order, rest, unit, factor * budget.display_factor)
    if rows:
        axes = grid[0][-1]
        if left_out:  # first, so that the axis has room for its bar
            axes.barh(len(order), sum(max(getattr(rows[n], bars[0][0]), 0) for n in left_out if n in rows), height=0.5,
                      color=GREY, alpha=0.6)
        index_bars(axes, rows, order, bars)
        axes.set_title("Monte Carlo: " + ("Sobol’ indices" if sobol else "Shapley effects"), loc="left", fontsize=9,
                       color=INK)
        axes.set_xlabel(f"share of variance, {rounding.probability(getattr(indices, 'confidence', 0.95))} intervals")
        if sobol:
            axes.legend(loc="center right" if left_out else "lower right", frameon=False, fontsize=8)
    labels = [short(n) for n in order] + ([f"{len(left_out)} others"] if left_out else [])
    grid[0][0].set_yticks(range(len(labels)), labels)
    grid[0][0].set_ylim(len(labels) - 0.4, -0.6)
    output = budget.output if budget else indices.output
    what = " and ".join((["tornado plot of the budget"] if has_budget else []) +
                        ([("Sobol' indices" if sobol else "Shapley effects")] if rows else []))
    return svg(figure, name, f"{what[0].upper()}{what[1:]} of {output}; the numbers are in the tables")


def name_points(axes, points, width, height):
    """Names next to their points, in the first place where they cover no other name and no point."""
    taken = [(x - 0.01 * width, y - 0.02 * height, x + 0.01 * width, y + 0.02 * height) for x, y, _ in points]
    for x, y, name in points:
        name = name if len(name) <= 26 else name[:25] + "…"
        w, h = 0.0165 * width * len(name), 0.05 * height
        for dx, dy in ((0.015, 0.01), (0.015, -0.06), (-0.015, 0.01), (-0.015, -0.06), (0.015, 0.07), (0.015, -0.12)):
            left = x + dx * width - (w if dx < 0 else 0)
            box = (left, y + dy * height, left + w, y + dy * height + h)
            if left >= 0 and not any(box[0] < t[2] and t[0] < box[2] and box[1] < t[3] and t[1] < box[3] for t in taken):
                break
        else:
            continue  # its number stands in the table
        taken.append(box)
        axes.text(x + dx * width, y + dy * height + h / 2, name, fontsize=7.5, color=INK, va="center",
                  ha="right" if dx < 0 else "left")


def morris(study, name):
    """mu* against sigma, with names: along the bottom linear and additive, high up non-linear or interacting."""
    known = [r for r in study.rows if math.isfinite(r.mean_absolute + r.standard_deviation)]
    if not known:
        return ""
    star = np.array([r.mean_absolute for r in known]) * study.display_factor
    sigma = np.array([r.standard_deviation for r in known]) * study.display_factor
    unit, factor = rounding.finer(study.display_units, max([*star, *sigma]))
    star, sigma = star * factor, sigma * factor
    top = 1.15 * max([*star, *sigma]) or 1
    figure, axes = plt.subplots(figsize=(5.4, 3.4), layout="constrained")
    axes.plot([0, top], [0, top], color=GREY, linewidth=0.7, linestyle=(0, (4, 2)))
    axes.text(top * 1.01, top, "σ = µ*", fontsize=7.5, color=GREY, va="center")
    axes.errorbar(star, sigma, xerr=[r.mean_absolute_se * study.display_factor * factor for r in known], fmt="o",
                  color=BLUE, ecolor=GREY, markersize=5, elinewidth=0.8)
    name_points(axes, [(star[k], sigma[k], known[k].input) for k in np.argsort(-star)[:MOST]], 1.25 * top, 1.2 * top)
    axes.set_xlim(0, 1.25 * top)
    axes.set_ylim(-0.12 * top, 1.08 * top)
    axes.grid(**GRID)
    unit = rounding.unit_text(unit)
    axes.set_xlabel("µ*: mean absolute elementary effect" + (f", {unit}" if unit else ""))
    axes.set_ylabel("σ of the effects" + (f", {unit}" if unit else ""))
    return svg(figure, name, f"Morris screening of {study.output}: mu* against sigma; the numbers are in the table")
