"""Slices of a working volume: the mean error as colour and arrows, and its standard uncertainty."""
import matplotlib
import matplotlib.pyplot as plt
import numpy as np

from . import rounding
from .figures import INK, svg

SLICES = 3  # of the first axis: the first, the middle and the last


def slices(count):
    return sorted({0, (count - 1) // 2, count - 1}) if count > SLICES else list(range(count))


def edges(values):
    """Of the cells about evenly spaced values."""
    half = (values[1] - values[0]) / 2
    return np.append(values - half, values[-1] + half)


def label(axis):
    return f"{axis.name}, {rounding.unit_text(axis.display_units)}"


def panels(grid, name, values, title, colours, arrows=None):
    """A panel for each slice across the axis that has fewest points; `values` by grid point, `arrows` their components."""
    cut, shown = grid.cut, grid.plane
    chosen = slices(len(grid.commands[cut])) if cut is not None else [None]
    figure, axes = plt.subplots(1, len(chosen), figsize=(7.2, 2.9 if len(chosen) > 1 else 4.2), layout="constrained", squeeze=False,
                                sharex=True, sharey=True)
    first, second = (grid.commands[k] for k in shown)
    most = float(np.max(values)) or 1.0
    for panel, k in zip(axes.flat, chosen):
        at = grid.at(values, k)
        mesh = panel.pcolormesh(edges(first), edges(second), at.T, cmap=colours, vmin=0, vmax=most, edgecolor="face", linewidth=0.3)
        if arrows is not None:
            scale = most / (0.9 * min(np.ptp(first) / len(first), np.ptp(second) / len(second)))
            panel.quiver(first, second, grid.at(arrows[0], k).T, grid.at(arrows[1], k).T, angles="xy", scale_units="xy", scale=scale,
                         color=INK, width=0.006)
        if k is not None:
            axis = grid.axes[cut]
            panel.set_title(f"{axis.name} {grid.commands[cut][k]:g} {rounding.unit_text(axis.display_units)}", loc="left", fontsize=8, color=INK)
        panel.set_xlabel(label(grid.axes[shown[0]]))
    axes[0][0].set_ylabel(label(grid.axes[shown[1]]))
    figure.colorbar(mesh, ax=axes, shrink=0.9, label=grid.unit)
    return svg(figure, name, title)


def line(grid, name, values, u, title):
    """Along a single axis: the error's length with a band of two standard uncertainties."""
    figure, axes = plt.subplots(figsize=(7.2, 3.2), layout="constrained")
    at = grid.commands[0]
    axes.fill_between(at, values - 2 * u, values + 2 * u, alpha=0.25, linewidth=0)
    axes.plot(at, values, color=INK)
    axes.set_xlabel(label(grid.axes[0]))
    axes.set_ylabel(grid.unit)
    return svg(figure, name, title)


def maps(grid):
    """Figures of the error and of its u, with their captions."""
    if len(grid.axes) == 1:
        return [(line(grid, "error", grid.length, grid.u_length, "Length of the error along the axis"),
                 "Mean length of the error; shaded: two standard uncertainties.")]
    arrows = grid.arrows()
    magnified = "; arrows: its part in the plane, of one scale in all panels" if arrows is not None else ""
    return [(panels(grid, "error", grid.length, "Mean length of the error over the volume", matplotlib.colormaps["Oranges"], arrows),
             f"Mean length of the error{magnified}."),
            (panels(grid, "u", grid.u_length, "Standard uncertainty of the error's length over the volume", matplotlib.colormaps["Blues"]),
             "Standard uncertainty of the length of the error.")]
