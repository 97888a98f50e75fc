"""Figures as inline SVG: text stays text, no identifiers clash, nothing is loaded from elsewhere."""
import io
import math
import re
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import markupsafe
import numpy as np
from matplotlib.ticker import MaxNLocator

from . import rounding

BLUE, ORANGE, GREY, PALE, INK = "#0b5fa5", "#c8500a", "#6b7280", "#d5e3f0", "#1f2933"  # apart for every eye
BAND, NOISE, RULE, GRID = "#eef0f3", "#b6bcc6", "#d5d9df", {"color": "#e5e7eb", "linewidth": 0.7}
# Colours that the page sets (style.css), so that a figure is light or dark as the page is.
OF_PAGE = {BLUE: "blue", ORANGE: "orange", GREY: "grey", PALE: "tint", INK: "ink", BAND: "band", NOISE: "noise",
           RULE: "line", GRID["color"]: "grid", "#ffffff": "page"}

matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "gumshoe", "font.size": 9, "axes.spines.top": False,
    "axes.spines.right": False, "axes.edgecolor": GREY, "axes.labelcolor": INK, "xtick.color": GREY,
    "ytick.color": GREY, "xtick.labelcolor": INK, "ytick.labelcolor": INK, "axes.linewidth": 0.7,
    "xtick.major.width": 0.7, "ytick.major.width": 0.7, "axes.axisbelow": True, "axes.unicode_minus": True,
    "text.parse_math": False, "text.color": INK,
})


def fit_labels(figure):
    """Breaks the axis labels and titles that are longer than the figure has room for, with a margin for wide letters."""
    figure.draw_without_rendering()
    for axes in figure.axes:
        box = axes.get_window_extent()
        for text, room in ((axes.xaxis.label, box.width), (axes.yaxis.label, box.height), (axes.title, box.width),
                           (axes._left_title, box.width)):
            drawn = text.get_window_extent()
            long = drawn.height if text.get_rotation() == 90 else drawn.width
            if text.get_visible() and "\n" not in text.get_text() and long > 1.02 * room:
                text.set_text("\n".join(textwrap.wrap(text.get_text(), max(8, int(0.85 * len(text.get_text()) * room / long)),
                                                      break_on_hyphens=False)))
    figure.draw_without_rendering()


def exponents_to_labels(figure):
    """Puts the exponent of an axis behind its label: matplotlib writes it at the end of the axis, on other text."""
    figure.draw_without_rendering()
    for axis in (axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)):
        power = re.fullmatch(r"1e([-\u2212]?\d+)", axis.get_offset_text().get_text())
        if power and any(tick.get_visible() and tick.get_text() for tick in axis.get_ticklabels()):
            axis.get_offset_text().set_visible(False)
            times = "× 10" + power[1].replace("\u2212", "-").translate(rounding.RAISED)
            axis.set_label_text(f"{axis.get_label_text()}, {times}" if axis.get_label_text() else times)


def with_figure(row, drawing):
    row.figure = markupsafe.Markup(drawing)
    return row


def svg(figure, name, title):
    """The figure as an <svg> element whose ids start with `name`."""
    buffer = io.StringIO()
    exponents_to_labels(figure)
    fit_labels(figure)
    figure.savefig(buffer, format="svg", transparent=True, metadata={"Date": None})
    plt.close(figure)
    text = buffer.getvalue()
    text = text[text.index("<svg"):]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.S)
    text = re.sub(r'\s(xmlns(:\w+)?)="[^"]*"', "", text)
    text = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", text.replace("xlink:href", "href"))
    # The font that the layout was measured in, or one as wide.
    text = re.sub(r"(font: ?[^;\"]*?px)[^;\"]*", r"\1 'DejaVu Sans', Verdana, sans-serif", text)
    text = re.sub(r"(fill|stroke): (#[0-9a-f]{6})\b", lambda m: f"{m[1]}: var(--{OF_PAGE[m[2]]})" if m[2] in OF_PAGE else
                  m[0], text)
    width = re.search(r'width="([\d.]+)pt"', text).group(1)
    text = re.sub(r'(<svg[^>]*?) (?:height|width)="[\d.]+pt"', r"\1", text)
    text = re.sub(r'(<svg[^>]*?) (?:height|width)="[\d.]+pt"', r"\1", text)
    escaped = title.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
    return text.replace("<svg", f'<svg role="img" aria-label="{escaped}" style="max-width:{width}pt"', 1)


def first_known(*values):
    return next((float(v) for v in values if math.isfinite(v)), 0.0)


def extent(output):
    """Middle and half-width of what is known of an output, SI: with few trials not all of it exists."""
    edges = output.histogram_edges if len(output.histogram_edges) else [math.nan]
    middle = first_known(output.estimate, output.symmetric_low / 2 + output.symmetric_high / 2, edges[0] / 2 + edges[-1] / 2)
    return middle, first_known(output.standard_uncertainty, (output.shortest_high - output.shortest_low) / 4,
                               (edges[-1] - edges[0]) / 4)


def deviation(output):
    """Reference (display units), unit and factor: shown = (SI value in display units - reference) * factor."""
    middle, size = extent(output)
    size *= output.display_factor
    unit, factor = rounding.finer(output.display_units, size)
    places = rounding.decimals(size)
    reference = middle * output.display_factor + output.display_offset
    return (reference if places is None else round(reference, places)), unit, factor, places


def scaler(output):
    reference, unit, factor, places = deviation(output)
    to_axis = lambda si: (np.asarray(si) * output.display_factor + output.display_offset - reference) * factor
    shown = f"{rounding.fixed(reference, places)} {rounding.unit_text(output.display_units)}".strip()
    return to_axis, f"deviation of {output.name} from {shown}" + (f", in {rounding.unit_text(unit)}" if unit != "1" else "")


def view(output, to_axis, budget):
    """Axis limits: the intervals with room on both sides, not the farthest sample of a million."""
    ends = [output.symmetric_low, output.symmetric_high, output.shortest_low, output.shortest_high]
    if budget is not None and budget.applicable and math.isfinite(budget.expanded_uncertainty):
        ends += [budget.estimate - budget.expanded_uncertainty, budget.estimate + budget.expanded_uncertainty]
    edges = to_axis(output.histogram_edges)
    middle, size = extent(output)
    ends = [end for end in ends if math.isfinite(end)] or [middle - size, middle + size]
    low, high = float(np.min(to_axis(ends))), float(np.max(to_axis(ends)))
    room = 0.35 * (high - low) or 1
    if len(edges):
        return max(low - room, min(edges[0], low - 0.05 * room)), min(high + room, max(edges[-1], high + 0.05 * room))
    return low - room, high + room


def histogram(axes, output, to_axis):
    if len(output.histogram):
        edges = to_axis(output.histogram_edges)
        scale = (output.histogram_edges[-1] - output.histogram_edges[0]) / (edges[-1] - edges[0])
        axes.stairs(output.histogram * scale, edges, fill=True, color=PALE)
        axes.stairs(output.histogram * scale, edges, color=BLUE, linewidth=0.8)
    axes.set_ylim(bottom=0)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)


def distribution(output, budget, p, name):
    to_axis, label = scaler(output)
    figure, (top, low) = plt.subplots(2, 1, sharex=True, figsize=(7.2, 3.5), layout="constrained",
                                      gridspec_kw={"height_ratios": [4, 1.25], "hspace": 0})
    histogram(top, output, to_axis)
    limits = view(output, to_axis, budget)
    rows = [("symmetric", to_axis([output.symmetric_low, output.symmetric_high]), BLUE, "-"),
            ("shortest", to_axis([output.shortest_low, output.shortest_high]), ORANGE, "-")]
    u = budget.combined_standard_uncertainty if budget is not None and budget.applicable else 0
    spread = float(to_axis(budget.estimate + u) - to_axis(budget.estimate)) if u > 0 else 0
    highest = top.get_ylim()[1] / 1.05
    if spread > 0:  # u may be smaller than what two numbers of double precision differ by
        x = np.linspace(*limits, 400)
        centre = float(to_axis(budget.estimate))
        top.plot(x, np.exp(-0.5 * ((x - centre) / spread) ** 2) / (spread * math.sqrt(2 * math.pi)), color=INK,
                 linewidth=1.1, linestyle=(0, (4, 2)), label="GUM framework: normal, u_c")
        ends = budget.estimate + np.array([-1, 1]) * budget.expanded_uncertainty
        rows.append(("GUM  y ± U", to_axis(ends), INK, (0, (4, 2))))
        peak = 1 / (spread * math.sqrt(2 * math.pi))
        highest = max(peak, highest)
    if math.isfinite(output.estimate):  # unlike the bars of a discrete distribution
        top.axvline(float(to_axis(output.estimate)), color=INK, linewidth=1, linestyle=(0, (1, 2)), ymax=0.94, label="estimate")
    top.set_ylim(0, 1.18 * highest)  # room for the curve and the legend
    if top.get_legend_handles_labels()[0]:
        top.legend(loc="upper right", frameon=False, fontsize=8)
    rows = [row for row in rows if np.isfinite(row[1]).all()]
    for k, (text, ends, colour, style) in enumerate(rows):
        low.plot(ends, [-k, -k], color=colour, linewidth=1.8, linestyle=style)
        low.plot(ends, [-k, -k], color=colour, marker="|", markersize=8, linestyle="none", markeredgewidth=1.8)
        for end in ends:
            if limits[0] < end < limits[1]:
                top.axvline(end, color=colour, linewidth=0.6, linestyle=style, alpha=0.6)
    low.set_ylim(min(-len(rows), -1) + 0.4, 0.6)
    low.set_yticks([-k for k in range(len(rows))], [row[0] for row in rows])
    low.tick_params(axis="y", length=0)
    low.spines["left"].set_visible(False)
    low.set_xlim(*limits)
    low.set_xlabel(label)
    top.tick_params(axis="x", length=0)
    top.set_title(f"Probability density and intervals for {rounding.probability(p)}", loc="left", fontsize=9, color=INK)
    return svg(figure, name, f"Distribution of {output.name} with its coverage intervals")


def small_multiples(outputs, name, columns=4):
    count = math.ceil(len(outputs) / columns)
    figure, grid = plt.subplots(count, columns, figsize=(7.2, 1.35 * count), layout="constrained", squeeze=False)
    for axes in grid.flat[len(outputs):]:
        axes.set_visible(False)
    for axes, o in zip(grid.flat, outputs):
        to_axis, label = scaler(o)
        histogram(axes, o, to_axis)
        axes.set_xlim(*view(o, to_axis, None))
        for ends, colour in (((o.symmetric_low, o.symmetric_high), BLUE), ((o.shortest_low, o.shortest_high), ORANGE)):
            for end in to_axis([end for end in ends if math.isfinite(end)]):
                axes.axvline(end, color=colour, linewidth=0.8)
        axes.set_title(o.name.replace("[", "\n[", 1), fontsize=7, color=INK, loc="left")
        axes.tick_params(axis="x", labelsize=7)
        axes.xaxis.set_major_locator(MaxNLocator(4))
        unit = label.rpartition(", in ")[2]
        axes.set_xlabel(unit if unit != label else "", fontsize=7, loc="right", labelpad=0)
    return svg(figure, name, "Distributions of all outputs")
