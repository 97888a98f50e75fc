"""Bias of approximations, printed slips taken literally, and errors of probed points, for sphere_calibration.md."""

import numpy as np

import sphere_figures
import sphere_study as study
from sphere_study import GIVEN, NAMES
from sphere_text import table, um

RADIANS = np.pi / 180


def bias(lines, found):
    exact = study.commands([GIVEN], study.POSES)[0]
    shift = GIVEN["probe_z"] * GIVEN["E_A0B"] * RADIANS
    cases = [("exact", {}), ("closed_form", {}), ("closed_form", {"handed_on": False}), ("closed_form", {"shift": shift}),
             ("small_angle", {}), ("small_angle", {"handed_on": False})]
    label = {"exact": "exact chain", "closed_form": "closed forms", "small_angle": "product (4.7) to (4.10)"}
    rows = []
    for evaluation, choices in cases:
        errors, rms = study.two_steps(evaluation, exact, **choices)
        name = label[evaluation] + (", eq 4.38 as printed" if "shift" in choices else "")
        rows.append([name, "true" if "handed_on" in choices else "of the first"]
                    + [um(errors[n], 1) for n in study.LENGTHS_1 + study.LENGTHS_2] + [um(r, 1) for r in rms])
    lines += ["## Bias", "",
              "Exact commands without noise, orientations known, reduced in the thesis' two steps by `gumshoe estimate`: pattern",
              "I for five lengths, then pattern II for two, with the first five as found or true. µm.", ""]
    lines += table(["reduced with", "first five"] + study.LENGTHS_1 + study.LENGTHS_2 + ["rms I", "rms II"], rows)
    lines += ["The thesis' Monte Carlo makes its data with the same closed forms as it fits, so it cannot show these biases; the",
              "experiment can. Mean errors of the three evaluations over 100,000 runs, µm and 0.001 deg, ± standard error:", ""]
    rows = []
    for (case, evaluation), r in found.items():
        if case in ("as above", "0.04 deg"):
            rows.append([f"`{evaluation}`, {'0.006 deg' if case == 'as above' else case}"]
                        + [f"{um(1e3 * m, 3)} ± {1e3 * s:.3f}" for m, s in zip(r.mean, r.mean_se)])
    lines += table([""] + NAMES, rows)
    worst = max(np.abs(r.mean / r.mean_se).max() for (case, _), r in found.items() if case == "as above")
    second = 1e3 * (0.04 * RADIANS) ** 2 / 6 * np.hypot(GIVEN["probe_y"] + 180 + GIVEN["E_Y0C"], GIVEN["probe_x"] - 50 - GIVEN["E_X0C"])
    clean = [np.abs(study.run(evaluation=e, only=(), samples=8).errors).max() for e in ("sequential", "joint")]
    lines += [f"Largest at 0.006 deg: {worst:.1f} standard errors; the rows share their draws. Without noise `sequential` and",
              f"`joint` return the given values within {max(clean):.0e} mm or deg. Second-order bias is far below all this: a "
              f"scatter of C by 0.04 deg",
              f"shortens the probe's radius about C in the mean by r u²/2 = {second:.3f} µm; what `joint_weighted` shows at 0.04 deg "
              "is of that order.", ""]
    rows = []
    for evaluation in ("small_angle", "closed_form"):
        for pattern, poses, cut in ((1, study.PATTERN_1, slice(0, 19)), (2, study.PATTERN_2, slice(19, 33))):
            d = 1e3 * np.abs(study.commands([GIVEN], poses, evaluation, pattern=pattern)[0] - exact[cut]).max(axis=0)
            rows.append([label[evaluation], "I" if pattern == 1 else "II"] + [um(v, 2) for v in d])
    lines += ["Largest difference of the commands from the exact chain, µm:", ""]
    lines += table(["", "pattern", "X", "Y", "Z"], rows)
    lines += [f"Eq 4.38 without d_rpz E_A0B: Y of pattern II off by {abs(shift):.3f} mm at the given values, "
              f"{abs(study.AVERAGE['probe_z'] * study.AVERAGE['E_A0B'] * RADIANS):.3f} at the averages of Tables 4.4 and 4.5.", ""]


def slips(lines):
    """What a slip in the printed equations does to the commands of the 33 poses if it is taken literally."""
    exact = study.commands([GIVEN], study.POSES)[0]
    turned = {**GIVEN, "E_A0B": GIVEN["E_C0B"], "E_C0B": GIVEN["E_A0B"], "E_A0C": GIVEN["E_B0C"], "E_B0C": GIVEN["E_A0C"]}
    as_radians = {**GIVEN, **{n: GIVEN[n] / RADIANS for n in ("E_A0C", "E_B0C")}}
    wrong_plane = np.degrees(np.arctan(np.tan(GIVEN["E_B0C"] * RADIANS) / np.tan(GIVEN["E_A0C"] * RADIANS)))
    cases = [("4.13: R_p left out (R_c + R_p taken 3 less)", GIVEN, {"tip_radius (mm)": 1e-9}),
             ("Table 4.3: tip radius 6", GIVEN, {"tip_radius (mm)": 6}),
             ("4.15, 4.16: degrees taken as radians", as_radians, {}),
             ("4.17: d_rcx, d_rcy for D_rcx, D_rcy in the sums of X and Y", "offsets", (GIVEN["E_X0C"], GIVEN["E_Y0C"], 0)),
             (f"4.29: normal of the other plane, E_C0B = {wrong_plane:.2f}", {**GIVEN, "E_C0B": wrong_plane}, {}),
             ("Table 4.1: names exchanged, A with C of B, A with B of C", turned, {}),
             ("E_Z0B along +Z, as ISO", {**GIVEN, "E_Z0B": -GIVEN["E_Z0B"]}, {}),
             ("4.48, 4.51: S_XY, S_XZ, S_YZ of 8 µm/m with the other sign", None, 8)]
    rows = []
    for label, machine, more in cases:
        if machine == "offsets":
            change = np.array([more])
        elif machine is None:
            plus, minus = [study.commands([GIVEN], study.POSES, **{f"{n} (um/m)": s * more for n in study.SQUARENESS})[0] for s in (1, -1)]
            change = plus - minus
        else:
            change = study.commands([machine], study.POSES, **more)[0] - exact
        rows.append([label] + [um(v) for v in 1e3 * np.abs(change).max(axis=0)])
    lines += ["Slips, symbols and names of the printed source if they are taken literally: largest change of a command over the",
              "33 poses, µm. Which of them the thesis' own program had is not known.", ""]
    lines += table(["", "X", "Y", "Z"], rows)


def volume(lines, base, clamped):
    pick = lambda r, n: [{k: GIVEN[k] + e for k, e in zip(NAMES, column)} for column in r.errors[:, :n].T]
    reference = study.commands([GIVEN], study.VALIDATION)[0]
    before = study.commands([study.DESIGN], study.VALIDATION)[0] - reference
    at_average = (study.commands([study.DESIGN], study.VALIDATION) - study.commands([study.AVERAGE], study.VALIDATION))[0]
    after = study.commands(pick(base, 1000), study.VALIDATION) - reference
    after_clamped = study.commands(pick(clamped, 1000), study.VALIDATION) - reference
    sphere_figures.validation(before, after)
    lines += ["## What it means for a probed point", "",
              "Commands by design values (before) and by the identified ones of a run (after) less those of the true machine:",
              "that far the tip is off. First at the nine pairs of eq 4.47 (Figures 4.16, 4.17 in kind), 1,000 runs.", "",
              "![error at the pairs of eq 4.47](../figures/sphere_validation.svg)", ""]
    rows = []
    for k, name in enumerate("XYZ"):
        rows.append([name, {"X": "2.838", "Y": "", "Z": ""}[name], f"{np.abs(before[:, k]).max():.3f} ({np.abs(at_average[:, k]).max():.3f})",
                     {"X": "0.024", "Y": "0.028", "Z": "0.030"}[name],
                     *[f"{np.median(np.abs(a[:, :, k]).max(axis=1)):.4f} ({np.quantile(np.abs(a[:, :, k]).max(axis=1), 0.95):.4f})"
                       for a in (after, after_clamped)]])
    lines += table(["largest of nine, mm", "before, printed", "before, ours (at the averages of 4.4, 4.5)", "after, printed",
                    "after, ours: median (95 %)", "after, with the clamped axis' error"], rows)
    lines += ["Printed *after* also holds the errors of the poses' own readings, ours only what the calibration leaves behind, and",
              "nothing of the artefact's error, which would add to X one to one at every pose.",
              "Before depends on the links through the B and C radii, so it need not agree.", ""]
    b, c = np.arange(-45, 46, 15), np.arange(-90, 91, 15)
    grid = [(int(i), int(j)) for i in b for j in c]
    truth = study.commands([GIVEN], grid)[0]
    first = np.linalg.norm(study.commands([study.DESIGN], grid)[0] - truth, axis=1)
    rows = [["before, design values", um(1e3 * np.sqrt(np.mean(first ** 2))), um(1e3 * first.max()), ""]]
    for label, r in (("after, 0.006 deg", base), ("after, with the clamped axis' error", clamped)):
        rest = np.linalg.norm(study.commands(pick(r, 400), grid) - truth, axis=2)
        if r is base:
            quantile = np.quantile(rest, 0.95, axis=0)
        rms, most = np.sqrt(np.mean(rest ** 2, axis=1)), rest.max(axis=1)
        rows.append([label, f"{um(1e3 * np.median(rms))} ({um(1e3 * np.quantile(rms, 0.95))})",
                     f"{um(1e3 * np.median(most))} ({um(1e3 * np.quantile(most, 0.95))})",
                     f"{min(first.max() / np.quantile(most, 0.95), 1e9):.0f}"])
    sphere_figures.volume(b, c, first.reshape(len(b), -1), 1e3 * quantile.reshape(len(b), -1))
    lines += [f"Over all angles, B from -45 to 45 and C from -90 to 90 deg by 15 ({len(grid)} poses, whether or not X, Y, Z stay",
              "within Table 4.2), length of the error in µm; 400 runs, median (95 %):", ""]
    lines += table(["", "rms over the volume", "largest in the volume", "before / after (95 %), largest"], rows)
    lines += ["![error over B and C](../figures/sphere_volume.svg)", "",
              "Dots: poses of the calibration; crosses: eq 4.47. Where no pose was measured, at negative C, the calibration is",
              "extrapolated.", ""]
    travel = study.commands([GIVEN], study.POSES)[0]
    limits = np.array([[-1876, -142.2], [-329, 172], [183, 685]])
    out = [[int(np.sum((travel[cut, k] < limits[k, 0]) | (travel[cut, k] > limits[k, 1]))) for k in range(3)]
           for cut in (slice(0, 19), slice(19, 33))]
    lines += [f"With these links {out[0][0]}, {out[0][1]}, {out[0][2]} of the 19 poses of pattern I and {out[1][0]}, {out[1][1]}, "
              f"{out[1][2]} of the 14 of pattern II leave the travel of Table 4.2 in X, Y, Z",
              f"(Y = {travel[0, 1]:.1f} at B = C = 0, of which d_rpy alone is {GIVEN['probe_y']}: so no links would do).", ""]
