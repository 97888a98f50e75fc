"""How estimate, standard uncertainty and interval settle as trials are added, from the samples of the file."""
import math

import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FuncFormatter, NullFormatter

from . import rounding
from .figures import BLUE, GREY, GRID, INK, ORANGE, PALE, scaler, svg

FIRST, STEPS = 100, 40  # trials of the first point, points
MOST = 20_000_000       # trials; more would take minutes to draw


def samples(path, output):
    """Valid samples in the order of the run; empty where none are stored."""
    with h5py.File(path, "r") as file:
        dataset = file.get(f"outputs/{output.measurand}")
        if dataset is None or dataset.ndim != 2 or dataset.shape[1] > MOST:
            return np.zeros(0)
        values = dataset[min(int(output.reading), dataset.shape[0] - 1)]
    return values[np.isfinite(values)]


def track(x, p):
    """n, mean, standard deviation and ends of the symmetric interval of the first n."""
    counts = np.unique(np.geomspace(min(FIRST, len(x)), len(x), STEPS).astype(int))
    sums, squares = np.cumsum(x - x[0]), np.cumsum((x - x[0]) ** 2)
    mean = sums[counts - 1] / counts
    spread = np.sqrt(np.maximum(squares[counts - 1] - counts * mean ** 2, 0) / np.maximum(counts - 1, 1))
    ends = np.array([np.quantile(x[:n], [(1 - p) / 2, (1 + p) / 2]) for n in counts])
    return counts, mean + x[0], spread, ends


def figure(path, output, validation, p, name):
    """Deviations from the final values; the band is the numerical tolerance of JCGM 101, clause 7.9."""
    x = samples(path, output)
    if len(x) < 10 * FIRST or not output.standard_uncertainty > 0:
        return ""
    counts, mean, spread, ends = track(x, p)
    size = output.standard_uncertainty * output.display_factor
    unit, factor = rounding.finer(output.display_units, 0.05 * size)
    scale = factor * output.display_factor
    drawn, axes = plt.subplots(figsize=(7.2, 2.6), layout="constrained")
    if validation is not None and math.isfinite(validation.delta) and validation.delta > 0:
        axes.axhspan(-scale * validation.delta, scale * validation.delta, color=PALE, linewidth=0, zorder=0,
                     label="± δ, the digits of u that are stated")
    for values, final, colour, style, text in (
            (ends[:, 0], ends[-1, 0], BLUE, (0, (2, 2)), "lower end"), (ends[:, 1], ends[-1, 1], BLUE, "-", "upper end"),
            (spread, spread[-1], ORANGE, "-", "u"), (mean, mean[-1], INK, "-", "estimate")):
        axes.plot(counts, scale * (values - final), color=colour, linestyle=style, linewidth=1.2, label=text)
    axes.axhline(0, color=GREY, linewidth=0.6)
    axes.set_xscale("log")
    late = counts >= 0.01 * counts[-1]
    top = max(scale * np.abs(v[late] - v[-1]).max() for v in (mean, spread, ends[:, 0], ends[:, 1]))
    top = 1.3 * max(top, scale * validation.delta if validation is not None and math.isfinite(validation.delta) else 0)
    axes.set_ylim(-top, top)
    axes.set_xlim(counts[0], counts[-1])
    axes.grid(**GRID)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda n, _: f"{n:,.0f}".replace(",", "\u202f")))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("trials")
    axes.set_ylabel("from the final value" + (f", {rounding.unit_text(unit)}" if rounding.unit_text(unit) else ""))
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1), ncols=5, frameon=False, fontsize=8, columnspacing=1.2,
                handlelength=1.8)
    return svg(drawn, name, f"Convergence of the Monte Carlo: estimate, u and interval of {output.name} over the trials")
