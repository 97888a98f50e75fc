"""Figures of profiles: the estimate with its band, round the part or along a line, and which quantity matters where."""
import math

import matplotlib.pyplot as plt
import numpy as np

from . import profile, rounding
from .figures import BLUE, GREY, GRID, INK, ORANGE, PALE, svg

COLOURS = [BLUE, ORANGE, "#4c8f4a", "#8a5fa8", "#b08a1e", "#3aa0a8"]
REST = GREY
NARROW = 0.01  # of the largest deviation: an interval of this half-width is as narrow as the line
SPACE = "\u202f"
ROUND = math.radians(180)  # an angle that spans as much is drawn round


def is_round(p):
    """Whether a profile goes round: an angle over half a turn or more."""
    x = [v for line in p.lines for v in line.x]
    return p.units == "rad" and max(x) - min(x) >= ROUND


def deviations(p):
    """Unit, factor, and by line estimate, low and high end as shown."""
    outputs = [o for line in p.lines for o in line.outputs]
    ends = [abs(e) for o in outputs for e in (o.symmetric_low, o.symmetric_high) if math.isfinite(e)]
    size = (max(ends) if ends else 1.0) * outputs[0].display_factor
    unit, factor = rounding.finer(outputs[0].display_units, size)
    to = lambda o, e: (e * o.display_factor + o.display_offset) * factor
    return rounding.unit_text(unit), [
        tuple(np.array([to(o, e(o)) for o in line.outputs]) for e in (
            lambda o: o.estimate, lambda o: o.symmetric_low, lambda o: o.symmetric_high)) for line in p.lines]


def too_narrow(p):
    """What is said of intervals that the line of the estimates covers; "" where they show."""
    unit, drawn = deviations(p)
    largest = lambda values: max((float(v) for v in np.concatenate(values) if math.isfinite(v)), default=0.0)
    half = largest([(high - low) / 2 for _, low, high in drawn])
    if not 0 < half < NARROW * largest([np.abs(estimate) for estimate, *_ in drawn]):
        return ""
    return f"The intervals are too narrow to be seen: their half-width is at most {rounding.significant(half)}{unit and SPACE}{unit}."


def step(size):
    """A round number near a third of the size."""
    power = 10.0 ** math.floor(math.log10(size / 3))
    return next(s * power for s in (1, 2, 5, 10) if s * power >= size / 3)


def polar(p, drawn, unit, name, probability):
    """Deviations as distances from a circle, magnified: a dashed circle is zero."""
    reach = max(float(np.nanmax(np.abs(np.concatenate([low, high])))) for _, low, high in drawn) or 1.0
    shown = drawn[:profile.LINES]
    columns = 3 if len(shown) > 4 else min(2, len(shown))
    rows = math.ceil(len(shown) / columns)
    size = (4.2, 5.8, 7.2)[columns - 1]
    figure, grid = plt.subplots(rows, columns, figsize=(size, size / columns * rows + 0.3), layout="constrained",
                                squeeze=False, subplot_kw={"projection": "polar"})
    for axes in grid.flat[len(shown):]:
        axes.set_visible(False)
    turn = np.linspace(0, 2 * math.pi, 361)
    for axes, line, (estimate, low, high) in zip(grid.flat, p.lines, shown):
        x = np.array(line.x)
        close = len(x) > 2 and 2 * math.pi - (x[-1] - x[0]) < 1.5 * float(np.median(np.diff(x)))
        ring = lambda v: np.append(v, v[0]) if close else v
        angle = np.append(x, x[0] + 2 * math.pi) if close else x
        axes.fill_between(angle, ring(low), ring(high), color=PALE, linewidth=0)
        axes.plot(angle, ring(estimate), color=BLUE, linewidth=1.3)
        axes.plot(turn, 0 * turn, color=INK, linewidth=0.8, linestyle=(0, (4, 3)))
        axes.set_ylim(-3.2 * reach, 1.15 * reach)
        marks = step(reach)
        axes.set_yticks([-marks, 0, marks], ["", "", f"+{marks:g} {unit}"], fontsize=6.5)
        axes.set_rlabel_position(67)
        axes.tick_params(axis="x", labelsize=7, pad=-1)
        axes.grid(**GRID)
        axes.spines["polar"].set_visible(False)
        axes.set_title(line.label, fontsize=8, color=INK)
    return svg(figure, name, f"{p.measurand} round {p.along}, in {unit}, magnified, with symmetric coverage intervals for "
                             f"{rounding.probability(probability)}")


def straight(p, drawn, unit, name, probability):
    """Estimate and band against the condition, a panel for each line."""
    shown = drawn[:profile.LINES]
    x_unit = rounding.unit_text(p.scale.unit)
    columns = min(2, len(shown))
    rows = math.ceil(len(shown) / columns)
    figure, grid = plt.subplots(rows, columns, figsize=(7.2, 1.9 * rows + 0.5), layout="constrained", squeeze=False,
                                sharex=True, sharey=True)
    for axes in grid.flat[len(shown):]:
        axes.set_visible(False)
    for axes, line, (estimate, low, high) in zip(grid.flat, p.lines, shown):
        x = p.scale.of(np.array(line.x))
        axes.fill_between(x, low, high, color=PALE, linewidth=0)
        axes.plot(x, estimate, color=BLUE, linewidth=1.3)
        axes.grid(**GRID)
        axes.set_title(line.label, loc="left", fontsize=8, color=INK)
    for axes in grid[-1]:
        axes.set_xlabel(p.along + (f", {x_unit}" if x_unit else ""))
    for row in grid:
        row[0].set_ylabel(p.measurand + (f", {unit}" if unit else ""))
    return svg(figure, name, f"{p.measurand} along {p.along} with symmetric coverage intervals for "
                             f"{rounding.probability(probability)}")


def band(p, name, probability):
    """The measurand along the condition with its band."""
    unit, drawn = deviations(p)
    return (polar if is_round(p) else straight)(p, drawn, unit, name, probability)


def where(p, budgets, sobol, name):
    """u along the condition, cut into the shares of its variance: which quantity matters where."""
    order, tables = profile.shares(p, budgets, sobol)
    if not order:
        return ""
    shown = p.lines[:profile.LINES]
    u = [np.array([o.standard_uncertainty * o.display_factor for o in line.outputs]) for line in shown]
    unit, factor = rounding.finer(shown[0].outputs[0].display_units, max(float(np.nanmax(v)) for v in u))
    x_unit = rounding.unit_text(p.scale.unit)
    columns = min(2, len(shown))
    rows = math.ceil(len(shown) / columns)
    figure = plt.figure(figsize=(7.2, 1.9 * rows + 0.7), layout="constrained")
    top, key = figure.subfigures(2, 1, height_ratios=[1.9 * rows, 0.45])
    grid = top.subplots(rows, columns, squeeze=False, sharex=True, sharey="row")
    for axes in grid.flat[len(shown):]:
        axes.set_visible(False)
    for axes, line, height, table in zip(grid.flat, shown, u, tables):
        x = p.scale.of(np.array(line.x))
        stack = np.array(table)
        stack /= np.maximum(1, np.nansum(stack, axis=0))  # indices are estimates: their sum may exceed 1
        rest = np.clip(1 - np.nansum(stack, axis=0), 0, None)
        layers = np.vstack([stack, rest]) * height * factor
        axes.stackplot(x, layers, colors=COLOURS[:len(order)] + [REST], linewidth=0)
        axes.plot(x, height * factor, color=INK, linewidth=1.0)
        axes.set_title(line.label, loc="left", fontsize=8, color=INK)
    for row in grid:
        row[0].set_ylim(0, 1.05 * max(float(np.max(axes.dataLim.ymax)) for axes in row if axes.get_visible()))
    unit = rounding.unit_text(unit)
    for axes in grid[-1]:
        axes.set_xlabel(p.along + (f", {x_unit}" if x_unit else ""))
    for row in grid:
        row[0].set_ylabel("u" + (f", {unit}" if unit else ""))
    handles = [plt.Rectangle((0, 0), 1, 1, color=c) for c in COLOURS[:len(order)] + [REST]]
    key.legend(handles, [*order, "others and interactions"], loc="center", ncols=4, frameon=False, fontsize=8)
    return svg(figure, name, f"Standard uncertainty of {p.measurand} along {p.along}, cut into shares of its variance")
