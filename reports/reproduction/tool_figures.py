"""Figures of tools.md, written to reports/figures/tool_*.svg; with TOOL_FIGURES_PNG set to a folder, there as PNG too."""

import os
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import mills
from mills import EXAMPLE_1, EXAMPLE_2, EXAMPLE_3, EXPERIMENT, EXPERIMENT_LENGTH

matplotlib.rcParams.update({"font.family": "DejaVu Sans", "font.size": 9, "svg.hashsalt": "gumshoe",
                            "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
                            "grid.color": "#e3e8ee", "grid.linewidth": 0.7, "axes.edgecolor": "#52606d"})
FLUTES = {1: "#1b4f8a", 2: "#c2571a", 3: "#2f7d4f"}
INK, MARK, PALE = "#1f2933", "#b3402f", "#7b8794"
FOLDER = mills.ROOT / "reports" / "figures"


def save(figure, name):
    figure.savefig(FOLDER / f"{name}.svg", metadata={"Date": None}, facecolor="white")
    if os.environ.get("TOOL_FIGURES_PNG"):
        figure.savefig(pathlib.Path(os.environ["TOOL_FIGURES_PNG"]) / f"{name}.png", dpi=110, facecolor="white")
    plt.close(figure)


def broken(x, y, drop):
    """With a gap where the curve jumps."""
    gap = np.flatnonzero(np.diff(y) < -drop)
    return np.insert(x.astype(float), gap + 1, np.nan), np.insert(y, gap + 1, np.nan)


def by_flute(ax, tool, shift=0.0, scale=1e3):
    fine = np.arange(0, 360, 0.25)
    z, which = mills.flutes(tool, fine)
    for k in range(1, int(tool["inserts (1)"]) + 1):
        x, y = broken(fine, np.where(which == k, z, np.nan), 5e-4)
        ax.plot(x, scale * (y + shift), color=FLUTES[k], lw=1.6, label=f"flute {k} triggers")
    ax.set_xlim(0, 360)
    ax.set_xticks(range(0, 361, 60))


def curves():
    figure, axes = plt.subplots(2, 2, figsize=(10, 6.4))
    fine = np.arange(0, 360, 0.25)
    ax = axes[0, 0]
    for changes, style, label in (({}, {"color": FLUTES[1], "lw": 1.6}, "h = 0"),
                                  ({"start_height": 0.005}, {"color": PALE, "lw": 1.2}, "h = 5 µm"),
                                  ({"feed": 10}, {"color": FLUTES[3], "lw": 1.4}, "10 mm/min, h = 0")):
        ax.plot(*broken(fine, 1e3 * mills.curve(EXAMPLE_1, fine, **changes), 0.5), label=label, **style)
    ax.plot([69, 94], [-1.4, -13.5], "x", color=MARK, ms=6, mew=1.5, label="printed extremes, h = 0")
    ax.plot([9, 33], [-1.4, -13.5], "+", color=MARK, ms=7, mew=1.3, label="printed, h = 5 µm")
    ax.set_title("Example 1: equal teeth, 30 mm/min at 1000 rpm", fontsize=9.5)
    ax.set_xlim(0, 360)
    ax.set_xticks(range(0, 361, 60))
    ax.set_ylim(-18.5, 0)
    ax.legend(fontsize=7.5, ncol=2, loc="lower center", frameon=False)
    ax = axes[0, 1]
    by_flute(ax, EXAMPLE_2)
    ax.set_title("Example 2: tooth 2 worn by 5 µm", fontsize=9.5)
    ax.legend(fontsize=7.5, frameon=False, loc="lower left")
    ax = axes[1, 0]
    by_flute(ax, EXAMPLE_3)
    ax.set_title("Example 3: teeth 2 and 3 worn by 6 and 10 µm, 500 rpm", fontsize=9.5)
    ax.legend(fontsize=7.5, frameon=False, loc="lower left")
    ax = axes[1, 1]
    by_flute(ax, EXPERIMENT, EXPERIMENT_LENGTH, 1.0)
    ax.axhline(EXPERIMENT_LENGTH, color=INK, lw=0.9, ls="--")
    ax.text(355, EXPERIMENT_LENGTH - 0.0001, "presetter 176.641", fontsize=7.5, ha="right", va="top", color=INK)
    for level, name in ((176.640, "B"), (176.637, "A")):
        ax.axhline(level, color=MARK, lw=0.8, ls=":")
        ax.text(355, level - 0.0001, f"printed peak {name} {level:.3f}", fontsize=7.5, ha="right", va="top", color=MARK)
    ax.set_title("Experiment: tooth 2 worn by 2 µm, h = 5 mm", fontsize=9.5)
    ax.ticklabel_format(useOffset=False, axis="y")
    ax.legend(fontsize=7.5, frameon=False, loc="lower left")
    for ax in axes[:, 0]:
        ax.set_ylabel("Z$_t$ / µm")
    axes[0, 1].set_ylabel("Z$_t$ / µm")
    axes[1, 1].set_ylabel("L$_t$ + Z$_t$ / mm")
    for ax in axes[1]:
        ax.set_xlabel("start angle / deg")
    figure.tight_layout()
    save(figure, "tool_curves")


def polygons(angles, coarse, fine, exact):
    figure, ax = plt.subplots(figsize=(7.6, 3.4))
    ax.plot(*broken(angles, 1e3 * exact, 0.5), color=FLUTES[1], lw=1.8, label="engine")
    ax.plot(*broken(angles, 1e3 * coarse, 0.9), color=FLUTES[2], lw=1.1, marker=".", ms=3,
            label="264 vertices, steps of 0.71 ms")
    ax.plot(angles, 1e3 * fine, ".", color=FLUTES[3], ms=3, label="1200 vertices, steps of 0.20 ms")
    ax.plot([0, 69, 94], [-6.5, -1.4, -13.5], "x", color=MARK, ms=8, mew=1.8, zorder=5, label="printed")
    ax.set_xlabel("start angle / deg")
    ax.set_ylabel("Z$_t$ / µm")
    ax.set_xlim(0, 179)
    ax.set_ylim(-16.5, -0.3)
    ax.legend(frameon=False, fontsize=8, loc="lower center", ncol=4, columnspacing=1.2, handletextpad=0.5)
    figure.tight_layout()
    save(figure, "tool_polygons")


def spread(rows):
    """Rows of (n, range / f_z, standard deviation / f_z)."""
    figure, ax = plt.subplots(figsize=(6.4, 3.9))
    w = np.linspace(0, 1, 200)
    ax.fill_between(w, w**1.5 / np.sqrt(12), np.sqrt(w**2 / 4 - w**3 / 6), color="#e8eef5", lw=0)
    ax.text(0.52, 0.236, "possible at all", fontsize=8, color=PALE, rotation=24, ha="center")
    colours = ["#0b2a4a", "#1b4f8a", "#2f7d4f", "#c2571a", "#b3402f"]
    for colour, n in zip(colours, sorted({r[0] for r in rows})):
        chosen = [(a, b) for m, a, b in rows if m == n]
        ax.plot(*zip(*chosen), ".", color=colour, ms=4, label=f"n = {n}")
    ax.axhline(1 / np.sqrt(12), color=INK, lw=0.8, ls="--")
    ax.text(0.21, 1 / np.sqrt(12) + 0.003, "1/√12", fontsize=8)
    ax.set_xlim(0.2, 1.01)
    ax.set_ylim(0.03, 0.31)
    ax.set_xlabel("range of the readings / f$_z$")
    ax.set_ylabel("standard deviation / f$_z$")
    ax.legend(frameon=False, fontsize=8, loc="lower right")
    figure.tight_layout()
    save(figure, "tool_spread")


def grid(series):
    """Series of (label, phases, shortfall in mm): shortfall of the highest reading over the phase of the start."""
    figure, ax = plt.subplots(figsize=(7.2, 3.4))
    for colour, (label, phase, short) in zip(["#b3402f", "#c2571a", "#2f7d4f", "#1b4f8a", "#0b2a4a"], series):
        ax.plot(phase, 1e3 * short, color=colour, lw=1.4, label=label)
    ax.set_xlabel("phase of the first start angle within the spacing 360 / m")
    ax.set_ylabel("shortfall / µm")
    ax.set_xlim(0, 1)
    ax.set_ylim(0, None)
    ax.legend(frameon=False, fontsize=8, ncol=3)
    figure.tight_layout()
    save(figure, "tool_grid")
