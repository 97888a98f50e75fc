"""Figures of sphere_calibration.md, written to reports/figures/sphere_*.svg; with SPHERE_FIGURES_PNG set to a folder,
there as PNG too."""

import os
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import sphere_study as study

matplotlib.rcParams.update({"font.family": "DejaVu Sans", "font.size": 9, "svg.hashsalt": "gumshoe",
                            "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#52606d"})
AXES = {"X": "#1b4f8a", "Y": "#c2571a", "Z": "#2f7d4f"}
PARTS = ["#1b4f8a", "#7fa6cf", "#b3402f", "#9aa5b1", "#c2a11a", "#2f7d4f"]
FOLDER = study.ROOT / "reports" / "figures"


def save(figure, name):
    figure.savefig(FOLDER / f"{name}.svg", metadata={"Date": None}, facecolor="white")
    if os.environ.get("SPHERE_FIGURES_PNG"):
        figure.savefig(pathlib.Path(os.environ["SPHERE_FIGURES_PNG"]) / f"{name}.png", dpi=110, facecolor="white")
    plt.close(figure)


def dominance(shares, labels):
    """Shares of variance, (parameter, contributor), of the two half-ranges side by side."""
    figure, axes = plt.subplots(1, len(shares), figsize=(10, 3.9), sharey=True)
    rows = np.arange(len(study.NAMES))[::-1]
    for ax, (title, table) in zip(axes, shares.items()):
        left = np.zeros(len(rows))
        for k, label in enumerate(labels):
            ax.barh(rows, 100 * table[:, k], left=left, color=PARTS[k], label=label, height=0.72)
            left += 100 * table[:, k]
        ax.set_title(title, fontsize=9.5)
        ax.set_xlim(0, 100)
        ax.set_xlabel("share of the variance / %")
    axes[0].set_yticks(rows, study.NAMES)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="lower center", ncol=len(labels), frameon=False, fontsize=8)
    figure.tight_layout(rect=(0, 0.07, 1, 1))
    save(figure, "sphere_dominance")


def correlation(matrix):
    figure, ax = plt.subplots(figsize=(6.4, 5.4))
    image = ax.imshow(matrix, cmap="RdBu_r", vmin=-1, vmax=1)
    ticks = np.arange(len(study.NAMES))
    ax.set_xticks(ticks, study.NAMES, rotation=60, ha="right")
    ax.set_yticks(ticks, study.NAMES)
    for i in ticks:
        for j in ticks:
            if i != j and abs(matrix[i, j]) >= 0.1:
                ax.text(j, i, f"{matrix[i, j]:.2f}".replace("0.", "."), ha="center", va="center", fontsize=7,
                        color="white" if abs(matrix[i, j]) > 0.6 else "#1f2933")
    figure.colorbar(image, ax=ax, shrink=0.8, label="correlation")
    figure.tight_layout()
    save(figure, "sphere_correlation")


def validation(before, after):
    """Error of the probed point at the nine pairs of eq 4.47 in mm: (pose, 3), and (sample, pose, 3)."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.7))
    x = np.arange(len(study.VALIDATION))
    for k, name in enumerate("XYZ"):
        axes[0].plot(x, before[:, k], "o-", color=AXES[name], ms=4, lw=1.4, label=name)
        low, high = 1e3 * np.quantile(after[:, :, k], [0.025, 0.975], axis=0)
        at = x + 0.22 * (k - 1)
        axes[1].vlines(at, low, high, color=AXES[name], lw=5, alpha=0.45)
        axes[1].plot(at, 1e3 * np.mean(after[:, :, k], axis=0), "o", color=AXES[name], ms=3.5, label=name)
    axes[0].set_title("Before: design values", fontsize=9.5)
    axes[1].set_title("After: identified values (dot: mean; bar: 95 % of the runs)", fontsize=9.5)
    axes[0].set_ylabel("error of the probed point / mm")
    axes[1].set_ylabel("error of the probed point / µm")
    for ax in axes:
        ax.axhline(0, color="#7b8794", lw=0.8)
        ax.set_xticks(x, [f"{c}, {b}" for b, c in study.VALIDATION], fontsize=7.5)
        ax.set_xlabel("C, B / deg")
        ax.legend(frameon=False, fontsize=8, ncol=3, loc="best")
    figure.tight_layout()
    save(figure, "sphere_validation")


def volume(b, c, before, after):
    """Length of the error over B and C: before in mm, after its 95 % quantile in um, both (B, C)."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.7))
    for ax, z, title, unit in ((axes[0], before, "Before: design values", "mm"),
                               (axes[1], after, "After: exceeded in 5 % of the runs", "µm")):
        image = ax.contourf(c, b, z, levels=10, cmap="viridis")
        figure.colorbar(image, ax=ax, label=f"length of the error / {unit}")
        for poses, mark in ((study.POSES, "o"), (study.VALIDATION, "X")):
            ax.plot([p[1] for p in poses], [p[0] for p in poses], mark, ms=4 if mark == "o" else 5.5, color="white",
                    mec="#1f2933", mew=0.6, clip_on=False, zorder=5)
        ax.set_title(title, fontsize=9.5)
        ax.set_xlabel("C / deg")
        ax.set_ylabel("B / deg")
        ax.set_xticks(range(-90, 91, 30))
        ax.set_yticks(range(-45, 46, 15))
    figure.tight_layout()
    save(figure, "sphere_volume")
