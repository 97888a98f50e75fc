#!/usr/bin/python3
"""Draws rod_gauging.svg: the measurement seen along the beam, and from the side. Angles and fillet exaggerated,
the geometry computed: at the drawn height the shadow covers half of the disc."""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Arc, Circle, Polygon, Rectangle

matplotlib.rcParams.update({"font.family": "DejaVu Sans", "font.size": 10, "svg.hashsalt": "gumshoe",
                            "mathtext.fontset": "dejavusans"})

ROD, FILLET, BEAM = 1.0, 0.2, 0.42
ELEVATION, AZIMUTH, PITCH = np.radians([76, 50, 8.0])
STEEL, EDGE, LIGHT, SHADE, INK, MARK = "#c9d1da", "#4a5663", "#ffb3a7", "#b3402f", "#1f2933", "#1b4f8a"


def lower_edge(yaw, pitch, n=161):
    """Lower edge (y, z) of the rod's shadow along a direction, bottom centre at 0."""
    rho, cot, g = ROD - FILLET, 1 / np.tan(ELEVATION), yaw - AZIMUTH
    across = rho * abs(np.sin(pitch) + np.cos(pitch) * cot * np.cos(g))
    slope = np.cos(pitch) * cot * np.sin(g)
    w = np.linspace(-np.pi / 2, np.pi / 2, n)[1:-1]
    p = slope + across / rho * np.tan(w)
    q = np.hypot(1, p)
    y = np.concatenate([[-ROD], rho * np.sin(w) + FILLET * p / q, [ROD]])
    z = slope * rho * np.sin(w) - across * np.cos(w) - FILLET / q
    z = np.concatenate([[-slope * rho], z, [slope * rho]])
    return y, z + np.cos(pitch) * FILLET / np.sin(ELEVATION)


def trigger_height():
    """Height of the bottom centre (vertical) at which half of the disc is covered."""
    y, z = lower_edge(0, PITCH)
    fine = np.linspace(-BEAM, BEAM, 4001)
    edge, c = np.interp(fine, y, z), np.sqrt(np.maximum(0, BEAM**2 - fine**2))
    low, high = -2.0, 2.0
    for _ in range(60):
        lift = (low + high) / 2
        share = np.trapz(np.clip(c - edge - lift, 0, 2 * c), fine) / (np.pi * BEAM**2)
        low, high = (lift, high) if share > 0.5 else (low, lift)
    return lift / np.cos(PITCH)


def dimension(ax, x, low, high, text, side=1, gap=0.05, size=11):
    ax.annotate("", (x, low), (x, high), arrowprops=dict(arrowstyle="<|-|>", color=MARK, lw=1.1, shrinkA=0, shrinkB=0,
                                                         mutation_scale=9))
    ax.text(x + side * gap, (low + high) / 2, text, color=MARK, va="center", ha="left" if side > 0 else "right",
            fontsize=size)


def note(ax, text, tip, at, **style):
    ax.annotate(text, tip, at, fontsize=9, color=INK, ha=style.get("ha", "left"), va=style.get("va", "center"),
                arrowprops=dict(arrowstyle="-", color="#52606d", lw=0.8, shrinkA=2, shrinkB=0), zorder=7)


def along_the_beam(ax, height):
    y, z = lower_edge(0, PITCH)
    centre = height * np.cos(PITCH)
    body = np.column_stack([np.r_[y, ROD, -ROD], np.r_[z + centre, 1.8, 1.8]])
    disc = Circle((0, 0), BEAM, facecolor=LIGHT, edgecolor="none", zorder=1)
    ax.add_patch(disc)
    ax.add_patch(Polygon(body, closed=True, facecolor=STEEL, edgecolor=EDGE, lw=1.4, zorder=2))
    covered = Polygon(body, closed=True, facecolor=SHADE, edgecolor="none", alpha=0.5, zorder=3)
    ax.add_patch(covered)
    covered.set_clip_path(disc)
    ax.add_patch(Circle((0, 0), BEAM, fill=False, edgecolor=SHADE, lw=1.4, zorder=4))
    ax.plot([0, 0], [centre, 1.32], color=EDGE, lw=0.9, dashes=(8, 3, 2, 3), zorder=3)
    ax.plot([-0.62, 0.62], [0, 0], color=SHADE, lw=0.9, dashes=(8, 3, 2, 3), zorder=4)
    ax.plot(0, 0, marker="o", color=SHADE, ms=4.5, zorder=5)
    ax.plot(0, centre, marker="o", color=MARK, ms=4.5, zorder=5)
    ax.plot([0, 0.7], [centre, centre], color=MARK, lw=0.8, zorder=4)
    ax.plot([0.5, 0.7], [0, 0], color=MARK, lw=0.8, zorder=4)
    dimension(ax, 0.63, 0, centre, "$Z'_d$")
    note(ax, "bottom centre $O_r$", (-0.015, centre + 0.02), (-0.9, 0.72))
    note(ax, "shadow covers\nhalf of the disc", (-0.2, 0.2), (-1.3, -0.36), ha="center")
    note(ax, "laser axis", (0, 0), (0.34, -0.62), ha="left")
    k = np.searchsorted(y, 0.93)
    note(ax, "fillet $R_f$", (y[k], z[k] + centre), (1.12, 0.02), ha="left")
    note(ax, "rod, radius $R_r$,\nbottom tilted", (0.62, 1.0), (1.12, 1.0), ha="left")
    note(ax, "beam's disc,\nradius $R_l$", (-BEAM * 0.6, -BEAM * 0.8), (-0.62, -0.9), ha="center")
    ax.set_xlim(-1.75, 1.95)
    ax.set_ylim(-1.12, 1.62)


def from_the_side(ax, height):
    x, z = lower_edge(-np.pi / 2, 0)  # seen along Y: x to the right
    left, right, top = -2.7, 2.7, 2.15
    tan, half = np.tan(PITCH), BEAM / np.cos(PITCH)

    def band(a, b, low, high, **style):
        ax.add_patch(Polygon([(a, a * tan + low), (b, b * tan + low), (b, b * tan + high), (a, a * tan + high)],
                             closed=True, **style))

    # What passes: the lower part, below the shadow's mean edge at half coverage.
    band(left, 0, -half, half, facecolor=LIGHT, edgecolor="none", zorder=1)
    band(0, right, -half, 0, facecolor=LIGHT, edgecolor="none", zorder=1)
    band(0, right, 0, half, facecolor=SHADE, alpha=0.22, edgecolor="none", zorder=1)
    ax.add_patch(Polygon(np.column_stack([np.r_[x, ROD, -ROD], np.r_[z + height, top, top]]), closed=True,
                         facecolor=STEEL, edgecolor=EDGE, lw=1.4, zorder=2))
    ax.plot([left - 0.25, right + 0.25], [(left - 0.25) * tan, (right + 0.25) * tan], color=SHADE, lw=0.9,
            dashes=(8, 3, 2, 3), zorder=4)
    ax.plot([left, right], [0, 0], color="#7b8794", lw=0.7, ls=":", zorder=3)
    for at, text in ((left, "transmitter"), (right, "receiver")):
        x0 = at - 0.42 if at < 0 else at
        ax.add_patch(Rectangle((x0, at * tan - 0.62), 0.42, 1.24, facecolor="#5d6b7a", edgecolor=EDGE, zorder=3))
        ax.text(x0 + 0.21, at * tan - 0.72, text, ha="center", va="top", fontsize=9, color=INK)
    # Holder and spindle, and the axis.
    ax.add_patch(Polygon([(-1.35, top), (1.35, top), (1.35, top + 0.35), (-1.35, top + 0.35)], closed=True,
                         facecolor="#aab4bf", edgecolor=EDGE, lw=1.2, zorder=2))
    ax.add_patch(Rectangle((-1.75, top + 0.35), 3.5, 0.75, facecolor="#e4e8ec", edgecolor=EDGE, lw=1.2, zorder=2))
    ax.text(1.05, top + 0.72, "spindle", ha="center", va="center", fontsize=9, color=INK, zorder=5)
    ax.plot([0, 0], [-0.75, top + 1.35], color=EDGE, lw=0.9, dashes=(8, 3, 2, 3), zorder=4)
    reference = top + 0.35
    for z0, colour in ((reference, INK), (height, MARK), (0, SHADE)):
        ax.plot(0, z0, marker="o", color=colour, ms=4.5, zorder=6)
    # Dimensions.
    ax.plot([0, 1.62], [height, height], color=MARK, lw=0.8, zorder=4)
    ax.plot([0, 1.62], [0, 0], color=MARK, lw=0.8, zorder=4)
    ax.plot([1.35, 2.25], [reference, reference], color=MARK, lw=0.8, zorder=4)
    ax.plot([1.62, 2.25], [height, height], color=MARK, lw=0.8, zorder=4)
    dimension(ax, 1.5, 0, height, "$Z'_d$")
    dimension(ax, 2.12, height, reference, "$L_r$")
    ax.plot([-1.75, -2.2], [reference, reference], color=MARK, lw=0.8)
    ax.annotate("", (-2.1, reference), (-2.1, reference + 0.85), arrowprops=dict(arrowstyle="-|>", color=MARK, lw=1.1,
                shrinkA=0, shrinkB=0, mutation_scale=9))
    ax.text(-2.2, reference + 0.45, "spindle readout $Z'_s$\n(machine Z)", color=MARK, ha="right", va="center", fontsize=9)
    ax.add_patch(Arc((0, 0), 4.3, 4.3, theta1=180, theta2=180 + np.degrees(PITCH), color=INK, lw=1.0, zorder=5))
    ax.text(-2.28, -0.16, r"$\beta$", fontsize=11, color=INK, va="center", ha="center", zorder=6)
    note(ax, "$O_{ts}$: laser axis on\nthe spindle axis", (-0.02, -0.02), (-0.5, -1.0), ha="center", va="top")
    ax.annotate("", (-1.32, 1.0), (-1.32, 1.65), arrowprops=dict(arrowstyle="-|>", color=INK, lw=1.2, mutation_scale=10))
    ax.text(-1.42, 1.33, "feed", ha="right", va="center", fontsize=9, color=INK)
    ax.text(0.55, -1.28, r"laser height $= Z'_s - L_r - Z'_d$", fontsize=11.5, color=INK, ha="left", va="center")
    ax.set_xlim(-3.75, 3.35)
    ax.set_ylim(-1.65, top + 1.45)


def main():
    height = trigger_height()
    figure, (first, second) = plt.subplots(1, 2, figsize=(11, 4.6), gridspec_kw={"width_ratios": [1, 1.25]})
    along_the_beam(first, height)
    from_the_side(second, height)
    for ax in (first, second):
        ax.set_aspect("equal")
        ax.axis("off")
    figure.text(0.21, 0.94, "along the beam: the photodiode's view", fontsize=11, color=INK, ha="center")
    figure.text(0.735, 0.94, "from the side, at the instant of the trigger", fontsize=11, color=INK, ha="center")
    figure.subplots_adjust(left=0.01, right=0.99, top=0.92, bottom=0.02, wspace=0.04)
    path = pathlib.Path(__file__).with_suffix(".svg")
    figure.savefig(path, metadata={"Date": None}, facecolor="white")
    if len(sys.argv) > 1:  # a PNG to look at
        figure.savefig(sys.argv[1], dpi=130, facecolor="white")


if __name__ == "__main__":
    main()
