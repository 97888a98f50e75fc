#!/usr/bin/python3
"""Fang 2022, Tables 2.2 to 2.7: computed numbers compared with the printed ones. Writes rods.md next to this file.

    rods.py [PROGRAM]      # default: build/release/gumshoe of this checkout
"""

import csv
import io
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]

# Table 2.1. The standard rod's elevation is printed as 0, see errata.
RODS = {
    "standard": {"fillet_radius (mm)": 0.0, "bottom_elevation (deg)": 90.0, "bottom_azimuth (deg)": 0.0,
                 "rod_length (mm)": 133.702},
    "rod1": {"fillet_radius (mm)": 0.03, "bottom_elevation (deg)": 89.922, "bottom_azimuth (deg)": 127.710,
             "rod_length (mm)": 160.591},
    "rod2": {"fillet_radius (mm)": 0.03, "bottom_elevation (deg)": 88.041, "bottom_azimuth (deg)": 144.086,
             "rod_length (mm)": 179.822},
}
NAMES = {"standard": "standard", "rod1": "#1", "rod2": "#2"}
COMMON = {"rod_radius (mm)": 5.0, "holder_angle (deg)": 0.0, "beam_radius (mm)": 0.2, "trigger_fraction (1)": 0.5}

# Printed: table, yaw and pitch (deg), then Z'_d of each rod as text, so that its digits are known.
HEIGHTS = [
    ("2.2", 0.0, 0.0, {"standard": "0", "rod1": "0.0041", "rod2": "0.1376"}),
    ("2.3", 0.6241, 0.2836, {"standard": "0.0246", "rod1": "0.0205", "rod2": "0.1119"}),
    ("2.4", 0.0, 0.0, {"standard": "0", "rod1": "0.0041", "rod2": "0.1376"}),
    ("2.5", 0.6241, 0.2836, {"standard": "0.025", "rod1": "0.021", "rod2": "0.112"}),
    ("2.6", 0.6240, 0.5729, {"standard": "0.054", "rod1": "0.050", "rod2": "0.083"}),
    ("2.7", 0.9424, 0.0911, {"standard": "0.007", "rod1": "0.003", "rod2": "0.128"}),
]
# Printed: height of the laser axis of each rod, and their range; `setup` is the label in the readouts' file.
LASER = [
    ("2.4", "0", {"standard": "-510.288", "rod1": "-510.290", "rod2": "-510.287"}, None),
    ("2.5", "1", {"standard": "-509.864", "rod1": "-509.870", "rod2": "-509.866"}, "0.006"),
    ("2.6", "2", {"standard": "-508.372", "rod1": "-508.374", "rod2": "-508.365"}, "0.009"),
    ("2.7", "3", {"standard": "-510.223", "rod1": "-510.214", "rod2": "-510.220"}, "0.007"),
]
ERRATA = "../errata.md#"
NOTES = {
    ("height", "2.3", "standard"): ("0.0246 is the value for R_f = 0.03 mm", "fang-table-2.1"),
    ("height", "2.6", None): ("printed values are those with yaw and pitch exchanged", "fang-table-2.6"),
    ("height", "2.7", None): ("truncated, not rounded", "fang-table-2.7"),
    ("laser", "2.6", None): ("follows from the exchanged angles", "fang-table-2.6"),
    ("laser", "2.7", None): ("follows from the truncated Z'_d", "fang-table-2.7"),
    ("range", "2.6", None): ("follows from the exchanged angles", "fang-table-2.6"),
    ("range", "2.7", None): ("not even the range of the printed heights", "fang-table-2.7"),
}


def evaluate(program, points):
    """Z'_d in mm for every point (a dict with the program's own column names)."""
    columns = list(points[0])
    with tempfile.NamedTemporaryFile("w", suffix=".csv", newline="") as table:
        writer = csv.DictWriter(table, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(points)
        table.flush()
        done = subprocess.run([str(program), "evaluate", "rod_gauging", "--table", table.name],
                              stdout=subprocess.PIPE, text=True, check=True)
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    if len(rows) != len(points):
        raise SystemExit(f"rods.py: {len(points)} points gave {len(rows)} rows")
    failed = [row for row in rows if row["status"] != "ok"]
    if failed:
        raise SystemExit(f"rods.py: not solved: {failed[0]}")
    return [float(row["bottom_height (mm)"]) for row in rows]


def point(rod, yaw, pitch, **changes):
    return {**COMMON, **RODS[rod], "beam_yaw (deg)": yaw, "beam_pitch (deg)": pitch,
            **{f"{name} (mm)": value for name, value in changes.items()}}


def readouts():
    """Mean spindle height in mm of every (setup, rod)."""
    for path in sorted((ROOT / "scenarios" / "data").rglob("*.csv")):
        rows = list(csv.DictReader(path.open(newline="")))
        if rows and {"setup", "rod", "readout", "spindle_z_mm", "rod_length_mm"} <= set(rows[0]):
            break
    else:
        raise SystemExit("rods.py: no readings of Tables 2.4 to 2.7 under scenarios/data")
    cells = {}
    for row in rows:
        cells.setdefault((row["setup"], row["rod"]), []).append(float(row["spindle_z_mm"]))
        if float(row["rod_length_mm"]) != RODS[row["rod"]]["rod_length (mm)"]:
            raise SystemExit(f"rods.py: {path.name}: rod length differs from Table 2.1: {row}")
    return {key: sum(values) / len(values) for key, values in cells.items()}, path


def agrees(value, printed):
    """Within half a unit of the last printed digit."""
    decimals = len(printed.partition(".")[2]) or 4
    return abs(value - float(printed)) <= 0.5 * 10.0**-decimals * (1 + 1e-9)


def note(kind, table, rod, good):
    if good:
        return "agrees"
    text, anchor = NOTES.get((kind, table, rod)) or NOTES.get((kind, table, None)) or ("unexplained", None)
    return f"**differs**: {text} ([errata]({ERRATA}{anchor}))" if anchor else f"**differs**: {text}"


def section(title, header, rows):
    lines = [f"## {title}", "", "| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return lines + [""]


def main():
    program = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build" / "release" / "gumshoe"
    if not program.exists():
        raise SystemExit(f"rods.py: {program} does not exist (not built?) scripts/build first")
    wanted = [(table, rod, yaw, pitch) for table, yaw, pitch, _ in HEIGHTS for rod in RODS]
    points = [point(rod, yaw, pitch) for _, rod, yaw, pitch in wanted]
    # What the printed numbers seem to have been computed with.
    variants = [("2.3", "standard", "R_f = 0.03 mm", point("standard", 0.6241, 0.2836, fillet_radius=0.03))]
    variants += [("2.6", rod, "yaw 0.5729, pitch 0.6240", point(rod, 0.5729, 0.6240)) for rod in RODS]
    variants += [("2.6", "standard", "the same, R_f = 0.03 mm", point("standard", 0.5729, 0.6240, fillet_radius=0.03)),
                 ("2.7", "standard", "R_f = 0.03 mm", point("standard", 0.9424, 0.0911, fillet_radius=0.03))]
    solved = evaluate(program, points + [v[3] for v in variants])
    ours = {(table, rod): z for (table, rod, _, _), z in zip(wanted, solved)}
    varied = dict(zip(((t, rod, text) for t, rod, text, _ in variants), solved[len(points):]))

    lines = ["# Fang 2022, chapter 2: computed and printed values", "",
             "Written by `reports/reproduction/rods.py` from `gumshoe evaluate rod_gauging`; do not edit.", "",
             "*Agrees* means: within half a unit of the last printed digit. Rods as in Table 2.1 (the standard rod with",
             "elevation 90 deg and fillet radius 0), beam radius 0.2 mm, trigger at half of the beam's disc, holder angle 0.",
             "Lengths in mm, angles in deg.", ""]

    rows = []
    for table, yaw, pitch, printed in HEIGHTS:
        for rod in RODS:
            z, good = ours[table, rod], agrees(ours[table, rod], printed[rod])
            rows.append([table, f"{yaw:.4f}", f"{pitch:.4f}", NAMES[rod], printed[rod], fixed(z, 9),
                         fixed(1e3 * (z - float(printed[rod])), 3), note("height", table, rod, good)])
    lines += section("Height of the bottom centre at the trigger, Z'_d",
                     ["table", "yaw", "pitch", "rod", "printed", "ours", "ours - printed (um)", ""], rows)

    rows = [[table, NAMES[rod], text, next(p for t, _, _, p in HEIGHTS if t == table)[rod], fixed(z, 9)]
            for (table, rod, text), z in varied.items()]
    lines += section("What the differing numbers were computed with",
                     ["table", "rod", "with", "printed", "ours"], rows)

    means, source = readouts()
    rows, ranges = [], []
    for table, setup, printed, printed_range in LASER:
        heights = {}
        for rod in RODS:
            mean, length = means[setup, rod], RODS[rod]["rod_length (mm)"]
            heights[rod] = mean - length - ours[table, rod]
            rows.append([table, NAMES[rod], fixed(mean, 6), f"{length:.3f}", printed[rod], fixed(heights[rod], 6),
                         note("laser", table, rod, agrees(heights[rod], printed[rod]))])
        spread = span(heights.values())
        ignored = span(means[setup, rod] - RODS[rod]["rod_length (mm)"] for rod in RODS)
        exchanged = {rod: means[setup, rod] - RODS[rod]["rod_length (mm)"] -
                     varied["2.6", rod, "yaw 0.5729, pitch 0.6240"] for rod in RODS} if table == "2.6" else {}
        ranges.append([table, printed_range or "-", fixed(spread, 6),
                       fixed(span(map(float, printed.values())), 3),
                       fixed(span(exchanged.values()), 6) if exchanged else "-", fixed(ignored, 3),
                       note("range", table, None, agrees(spread, printed_range)) if printed_range else ""])
    lines += [f"Readings: `{source.relative_to(ROOT)}`, three a cell; the height of the laser axis is the mean reading less",
              "rod length less Z'_d (eq. 2.38).", ""]
    lines += section("Height of the laser axis", ["table", "rod", "mean reading", "L_r", "printed", "ours", ""], rows)
    lines += section("Range of the laser axis over the three rods",
                     ["table", "printed range", "ours", "of the printed heights", "yaw and pitch exchanged",
                      "geometry ignored (Z'_d = 0)", ""], ranges)
    (HERE / "rods.md").write_text("\n".join(lines).rstrip() + "\n")


def span(values):
    values = list(values)
    return max(values) - min(values)


def fixed(x, decimals):
    text = f"{x:.{decimals}f}"
    return text[1:] if text.startswith("-") and not text.strip("-0.") else text


if __name__ == "__main__":
    main()
