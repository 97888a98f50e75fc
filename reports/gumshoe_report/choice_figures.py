"""Figure of a choice: time against U of all candidates, with the Pareto front."""
import matplotlib.pyplot as plt
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator
from matplotlib.transforms import Bbox

from .choice import axis_label, duration, plain_number, refuted
from .figures import BLUE, GREY, GRID, INK, ORANGE, svg


CLOCK = ([1, 2, 3, 5, 7, 10, 15, 20, 30, 45] + [60 * x for x in (1, 1.5, 2, 3, 5, 7, 10, 15, 20, 30)] +
         [3600 * x for x in (1, 2, 4, 8, 16, 24)])


def short(seconds):
    """A duration without its zeros."""
    text = duration(seconds).replace(".0\u202f", "\u202f")
    return text.replace("\u202fmin 0\u202fs", "\u202fmin").replace("\u202fh 0\u202fmin", "\u202fh")


def time_axis(axis, times):
    """Ticks at the times that a clock shows."""
    low, high = min(times), max(times)
    if high > 5 * low:
        axis.axes.set_xscale("log")
    marks = [t for t in CLOCK if 0.95 * low <= t <= 1.05 * high]
    if high > 5 * low and len(marks) > 2:
        while len(marks) > 9:
            marks = marks[::2]
        axis.set_major_locator(FixedLocator(marks))
        axis.set_minor_locator(NullLocator())
    elif high > 5 * low:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda t, _: short(t)))
    axis.set_minor_formatter(FuncFormatter(lambda t, _: ""))


def logarithmic_U(axis, values):
    """A scale with plain numbers; logarithmic if U varies much."""
    if max(values) > 4 * min(values):
        axis.axes.set_yscale("log")
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_minor_formatter(FuncFormatter(lambda *_: ""))
    axis.set_major_formatter(FuncFormatter(lambda u, _: plain_number(u)))


def places(at_right):
    """Where the name of a point may stand, the best place first: offset in points, alignment."""
    sides = [(-7, "right"), (7, "left")] if at_right else [(7, "left"), (-7, "right")]
    return [(dx, dy, side) for dy in (0, 10, -10, 20, -20, 30, -30) for dx, side in sides]


def name_points(axes, points, marks):
    """Names next to their points, where they cover neither another name nor a mark."""
    axes.figure.draw_without_rendering()
    to_pixels = axes.transData.transform
    taken = [Bbox.from_bounds(x - 6, y - 6, 12, 12) for x, y in map(to_pixels, [(t, U) for t, U, _ in points] + marks)]
    inside = axes.get_window_extent()
    for time, U, name in points:
        at_right = axes.transAxes.inverted().transform(to_pixels((time, U)))[0] > 0.6
        for dx, dy, side in places(at_right):
            text = axes.annotate(name, (time, U), xytext=(dx, dy), textcoords="offset points", fontsize=8, color=INK, va="center", ha=side,
                                 bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.6})
            box = text.get_window_extent()
            if inside.x0 <= box.x0 and box.x1 <= inside.x1 and not box.count_overlaps(taken):
                break
            text.remove()
        else:
            continue  # its numbers stand in the table
        taken.append(box)


def pareto(c, name):
    rows = [r for r in c.candidates if r.asked > 0 and r.time > 0]
    if len(rows) < 2:
        return ""
    U = lambda r: r.asked * c.display_factor
    figure, axes = plt.subplots(figsize=(7.2, 3.9), layout="constrained")
    outcome = lambda r: "misses the target" if not r.meets else "not confirmed" if refuted(r) else "meets the target"
    for text, look in (("misses the target", {"color": GREY, "markeredgewidth": 0}),
                       ("not confirmed", {"markeredgecolor": BLUE, "markerfacecolor": "none", "markeredgewidth": 0.8}),
                       ("meets the target", {"color": BLUE, "markeredgewidth": 0})):
        group = [r for r in rows if outcome(r) == text]
        if group:
            axes.plot([r.time for r in group], [U(r) for r in group], "o", markersize=3.2, linestyle="none", label=text,
                      alpha=1 if text == "not confirmed" else 0.45, **look)
    front = sorted((r for r in rows if r.pareto), key=lambda r: r.time)
    axes.step([r.time for r in front], [U(r) for r in front], where="post", color=INK, linewidth=1,
              label="Pareto front")
    axes.axhline(c.target * c.display_factor, color=ORANGE, linewidth=1, linestyle=(0, (5, 2)))
    others = [r for r in c.fresh[1:] if r.asked > 0]
    if others:
        axes.plot([r.time for r in others], [U(r) for r in others], "D", color=INK, markersize=5.5, linestyle="none",
                  markerfacecolor="white", label="compared")
    best = c.fresh[0]
    if best.asked > 0:
        axes.plot([best.time], [U(best)], "*", color=ORANGE, markersize=14, markeredgecolor="white",
                  label="recommended" if c.reached else "least U", zorder=5)
    drawn = [*rows, *others]
    time_axis(axes.xaxis, [r.time for r in drawn])
    logarithmic_U(axes.yaxis, [U(r) for r in drawn])
    name_points(axes, [(r.time, U(r), r.name) for r in others], [(best.time, U(best))] if best.asked > 0 else [])
    axes.annotate(f"target {plain_number(c.target * c.display_factor)}", (1, c.target * c.display_factor),
                  xycoords=("axes fraction", "data"), xytext=(0, 3), textcoords="offset points", fontsize=8,
                  color=ORANGE, ha="right")
    axes.grid(**GRID)
    axes.set_xlabel("time that measuring takes")
    axes.set_ylabel(axis_label("U", c.display_units))
    handles = axes.get_legend_handles_labels()[0]
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1), ncols=5 if len(handles) <= 5 else 3, frameon=False,
                fontsize=8, handletextpad=0.4, columnspacing=1.4)
    return svg(figure, name, "Time against expanded uncertainty of all candidates, with the Pareto front")
