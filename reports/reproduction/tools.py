#!/usr/bin/python3
"""Fang 2022, chapter 3: computed curves and numbers compared with the printed ones, and conclusions on feed, speed and
start angles. Writes tools.md and figures/tool_*.svg next to this file.

    tools.py [PROGRAM]      # default: build/release/gumshoe of this checkout; a few minutes
"""

import pathlib
import sys

import numpy as np

import mills
import polygon_steps
import tool_facts
import tool_figures
from mills import EXAMPLE_1, EXAMPLE_2, EXAMPLE_3, EXPERIMENT, EXPERIMENT_LENGTH

DEGREES = np.arange(360)
ERRATA = "../errata.md#"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
    return lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows] + [""]


def um(x, decimals=2):
    text = f"{1e3 * x:.{decimals}f}"
    return text[1:] if text.startswith("-") and not text.strip("-0.") else text


def below(x):
    """A difference that should vanish, in mm, as the power of ten of nm above it; rounding noise counts as 1e-6."""
    return f"1e{max(-6, int(np.ceil(np.log10(max(1e6 * x, 1e-6)))))} nm"


def agrees(value, printed):
    """Within half a unit of the last printed digit."""
    decimals = len(str(printed).partition(".")[2])
    return abs(value - float(printed)) <= 0.5 * 10.0**-decimals * (1 + 1e-9)


def verdict(good, anchor="fang-3-polygons", text="polygons and steps"):
    return "agrees" if good else f"**differs**: {text} ([errata]({ERRATA}{anchor}))"


def whole(z, best):
    """Height and whole degrees of the extreme, those of the second flute half a turn on left out."""
    at = np.flatnonzero(np.abs(z - best(z)) < 1e-9)
    return best(z), int(at[0] % 180)


def examples(lines):
    found = {name: mills.curve(tool, DEGREES, **changes) for name, tool, changes in (
        ("1", EXAMPLE_1, {}), ("h", EXAMPLE_1, {"start_height": 0.005}), ("v", EXAMPLE_1, {"feed": 10}))}
    exact = {name: mills.extremes(tool, **changes) for name, tool, changes in (
        ("1", EXAMPLE_1, {}), ("h", EXAMPLE_1, {"start_height": 0.005}), ("v", EXAMPLE_1, {"feed": 10}),
        ("2", EXAMPLE_2, {}), ("3", EXAMPLE_3, {}), ("X", EXPERIMENT, {}))}
    rows = []

    def row(what, printed, ours, note):
        rows.append([what, printed, f"{ours:.6f}", um(ours - float(printed), 3), note])

    def angle(what, printed, ours):
        rows.append([what, printed, f"{ours} deg", f"{ours - int(printed)} deg",
                     verdict(ours == int(printed))])

    for name, label, high, low, at_high, at_low in (
            ("1", "example 1", "-0.0014", "-0.0135", 69, 94), ("h", "example 1, h = 0.005", "-0.0014", "-0.0135", 9, 33),
            ("v", "example 1, 10 mm/min", "-0.0014", "-0.0061", None, None)):
        for which, best, printed, at in (("highest", np.max, high, at_high), ("lowest", np.min, low, at_low)):
            z, degree = whole(found[name], best)
            row(f"{label}: {which} Z_t", printed, z, verdict(agrees(z, printed)))
            if at is not None:
                angle(f"{label}: at start angle", at, degree)
    row("example 1: Z_t at start angle 0", "-0.0065", found["1"][0], verdict(agrees(found["1"][0], "-0.0065")))

    def tops(name):  # the highest maximum of each flute
        best = {}
        for at, z, k in exact[name][0]:
            if k not in best or z > best[k][1]:
                best[k] = (at, z)
        return best
    two, three, cut = tops("2"), tops("3"), tops("X")
    difference = [("example 2: peak A - peak B", "0.005", two[1][1] - two[2][1]),
                  ("example 3: peak A - peak B", "0.01", three[1][1] - three[3][1]),
                  ("example 3: peak A - peak C", "0.006", three[1][1] - three[2][1])]
    for what, printed, ours in difference:
        row(what, printed, ours, verdict(agrees(ours, printed)))
    b, a = EXPERIMENT_LENGTH + cut[1][1], EXPERIMENT_LENGTH + cut[2][1]
    row("experiment: L_t + Z_t at peak B, simulated", "176.640", b, verdict(agrees(b, "176.640")))
    row("experiment: L_t + Z_t at peak A, simulated", "176.637", a,
        verdict(agrees(a, "176.637"), "fang-3-experiment", "the printed difference exceeds the wear"))
    row("experiment: peak B - peak A, simulated", "0.003", b - a,
        verdict(agrees(b - a, "0.003"), "fang-3-experiment", "it is the wear, 0.002"))

    lines += ["## Printed and ours", "",
              "Z_t is the height of the tool's centre above the beam's axis at the trigger, highest and lowest over the",
              "whole degrees of the start angle as in the thesis; differences of peaks are those of the maxima themselves.", ""]
    lines += table(["what", "printed", "ours", "ours - printed (um)", ""], rows)
    lines += ["## All maxima and minima", "",
              "Behind each maximum the curve falls off. *Flute* is the one that triggers there. Where the offset is less than",
              "the radius at which an insert is lowest, each flute crosses the beam's axis twice and has two maxima, the",
              "second lower: there are twice as many peaks as teeth ([errata](" + ERRATA + "fang-3-peaks)).", ""]
    rows = []
    for name, label in (("1", "example 1"), ("h", "example 1, h = 0.005"), ("v", "example 1, 10 mm/min"),
                        ("2", "example 2"), ("3", "example 3"), ("X", "experiment")):
        def text(list_of):
            return ", ".join(f"{um(z, 3)} at {at:.3f} ({k})" for at, z, k in list_of)
        rows.append([label, text(exact[name][0]), text(exact[name][1])])
    lines += table(["curve", "maxima, um at deg (flute)", "minima, um at deg (flute)"], rows)
    lines += ["The highest point of a whole curve is that of the hump of one insert, whatever the feed: half of the disc is",
              "covered by a round edge of radius R that stands R_l^2 / (6 R) deeper than a straight one would.", ""]
    rows = []
    for label, tool, name in (("example 1", EXAMPLE_1, "1"), ("example 3", EXAMPLE_3, "3"), ("experiment", EXPERIMENT, "X")):
        sag = tool["beam_radius (mm)"]**2 / (6 * tool["insert_radius (mm)"])
        rows.append([label, um(-sag, 3), um(max(z for _, z, _ in exact[name][0]), 3)])
    lines += table(["tool", "-R_l^2 / (6 R), um", "highest maximum, um"], rows)
    flank = max(np.max(np.abs(mills.curve(t, DEGREES) - mills.curve(t, DEGREES, insert_thickness=0)))
                for t in (EXAMPLE_1, EXAMPLE_2, EXAMPLE_3, EXPERIMENT))
    turned = np.max(np.abs(mills.curve(EXAMPLE_1, DEGREES + 60) - mills.curve(EXAMPLE_1, DEGREES, start_height=0.005)))
    lines += [f"The flank never matters here: inserts without thickness change no height of the four tools by more than "
              f"{below(flank)}.", "Raising the start by 5 um turns the curve by 60 deg towards smaller start angles (left "
              f"over: {below(turned)}).", ""]
    return found["1"], exact["1"]


def discretisation(lines, exact_curve):
    settings = [("264 vertices, 0.71 ms", 264, 7.1e-4), ("300 vertices, 0.70 ms", 300, 7e-4),
                ("1200 vertices, 0.20 ms", 1200, 2e-4)]
    half = np.arange(180)
    sought = [("Z_t at 0 deg", "-0.0065", EXAMPLE_1, {}, None), ("highest", "-0.0014 at 69", EXAMPLE_1, {}, np.max),
              ("lowest", "-0.0135 at 94", EXAMPLE_1, {}, np.min),
              ("h = 0.005, highest", "-0.0014 at 9", EXAMPLE_1, {"start_height": 0.005}, np.max),
              ("h = 0.005, lowest", "-0.0135 at 33", EXAMPLE_1, {"start_height": 0.005}, np.min),
              ("10 mm/min, highest", "-0.0014", EXAMPLE_1, {"feed": 10}, np.max),
              ("10 mm/min, lowest", "-0.0061", EXAMPLE_1, {"feed": 10}, np.min)]
    columns = []
    for _, vertices, step in settings:
        def stepped(changes):
            tool = {**EXAMPLE_1, **{mills.column(k): v for k, v in changes.items()}}
            return np.array([polygon_steps.trigger_height(tool, a, vertices, step) for a in half])
        columns.append({str(changes): stepped(changes) for changes in ({}, {"start_height": 0.005}, {"feed": 10})})
    runs = {str(changes): mills.curve(EXAMPLE_1, half, **changes) for changes in ({}, {"start_height": 0.005}, {"feed": 10})}

    def text(z, best):
        if best is None:
            return f"{z[0]:.5f}"
        at = np.flatnonzero(np.abs(z - best(z)) < 1e-9)
        return f"{best(z):.5f} at {at[0]}" + (f" to {at[-1]}" if len(at) > 1 else "")
    rows = [[what, printed, text(columns[0][str(c)], best), text(columns[1][str(c)], best), text(columns[2][str(c)], best),
             text(runs[str(c)], best)] for what, printed, _, c, best in sought]
    lines += ["## The printed discretisation", "", "<a id=\"discretisation\"></a>",
              "The thesis lays polygons about cutting edge and beam, lets time run in steps and takes the first step at which",
              "more than half is covered; vertices and step are not stated. `polygon_steps.py` does so, in lines of its own.",
              "A cutting edge of about 256 to 300 vertices and a step of about 0.7 ms (4.2 deg and 0.35 um at 1000 rpm and",
              "30 mm/min) come out at the printed values within 1.1e-4 mm and 1 deg; finer ones run towards the engine's. So",
              "the printed values are lower by what a polygon cuts off the edge (sides of 0.14 mm in a beam of 0.4 mm) and by",
              "up to a step of descent. The two numbers of the first column were found by trying; their neighbours do nearly",
              "as well, and nothing depends on them.", ""]
    lines += table(["example 1", "printed"] + [s[0] for s in settings] + ["engine"], rows)
    lines += ["![the curve by polygons and steps, and exact](../figures/tool_polygons.svg)", ""]
    tool_figures.polygons(half, columns[0]["{}"], columns[2]["{}"], runs["{}"])


def readings(lines):
    """What an ambiguous place of the source is worth."""
    rows = []

    def row(what, z):
        rows.append([what, um(np.max(z), 3), um(np.min(z), 3)])
    row("as we read it", mills.curve(EXAMPLE_1, DEGREES))
    for what, changes in (("radial angle +8 instead of -8", {"insert_radial_angle": 8}),
                          ("axial angle +5 instead of -5", {"insert_axial_angle": 5}),
                          ("offset along +Y, as in the text", {"offset": -4}),
                          ("beam radius 0.1 instead of 0.2", {"beam_radius": 0.1}),
                          ("eq. 3.23 with t in s: sixty times the speed", {"spindle_speed": 60000})):
        row(what, mills.curve(EXAMPLE_1, DEGREES, **changes))
    backwards = {**EXAMPLE_1, "spindle_speed (rpm)": -1000}
    row("turning the other way (1200 vertices, 0.20 ms)",
        np.array([polygon_steps.trigger_height(backwards, a, 1200, 2e-4) for a in range(180)]))
    lines += ["## What an ambiguous place is worth", "",
              "Example 1 over whole degrees, in um ([errata](" + ERRATA + "fang-3-conventions)):", ""]
    lines += table(["reading", "highest Z_t", "lowest Z_t"], rows)
    rows = []
    for offset in (4, 6, 7, 7.083, 7.2):
        z = mills.curve(EXAMPLE_3, DEGREES, offset=offset)
        rows.append([offset, um(np.max(z), 3), um(np.min(z), 3)])
    lines += ["Example 3, whose offset is not printed; its inserts are lowest at a radius of 7.083:", ""]
    lines += table(["offset", "highest Z_t", "lowest Z_t"], rows)


def main():
    if len(sys.argv) > 1:
        mills.PROGRAM = pathlib.Path(sys.argv[1])
    if not mills.PROGRAM.exists():
        raise SystemExit(f"tools.py: {mills.PROGRAM} does not exist (not built?) scripts/build first")
    lines = ["# Fang 2022, chapter 3: computed and printed values", "",
             "Written by `reports/reproduction/tools.py` from `gumshoe evaluate tool_length`; do not edit.", "",
             "*Agrees* means: within half a unit of the last printed digit. Tools as in Tables 3.1 to 3.4, where needed with",
             "the readings of [errata](../errata.md#fang-3); beam radius 0.2 mm, trigger at half of the beam's disc. Lengths in",
             "mm, angles in deg, unless stated; v feed, N_s spindle speed, n inserts, f_z = v / (n N_s) feed per tooth.", "",
             "![characteristic curves](../figures/tool_curves.svg)", ""]
    one, extremes = examples(lines)
    tool_figures.curves()
    discretisation(lines, one)
    readings(lines)
    tool_facts.write(lines, table, um, below)
    (mills.HERE / "tools.md").write_text("\n".join(lines).rstrip() + "\n")


if __name__ == "__main__":
    main()
