"""The sphere calibration of Fang 2022, chapter 4, and calls of the `gumshoe` program about it. Lengths mm, angles deg."""

import csv
import io
import json
import math
import pathlib
import subprocess
import tempfile

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PROGRAM = ROOT / "build" / "release" / "gumshoe"

PATTERN_1 = [(0, c) for c in range(0, 91, 5)]
PATTERN_2 = [(b, 90) for b in range(-20, 46, 5)]
POSES = PATTERN_1 + PATTERN_2
# Eq 4.47 as (B, C); its first pair is printed (0, 0), presumably C = 90 deg.
VALIDATION = [(0, 90), (4, 85), (8, 80), (12, 75), (16, 70), (12, 65), (8, 60), (4, 55), (0, 50)]

# Table 4.7: symbol, unit, given, mean of the identified, difference, standard deviation.
TABLE_4_7 = {
    "probe_x": ("d_rpx", "mm", 85.557, 85.567, 0.01, 0.012),
    "probe_y": ("d_rpy", "mm", 287.435, 287.430, -0.005, 0.006),
    "probe_z": ("d_rpz", "mm", 454.22, 454.221, 0.001, 0.008),
    "E_X0B": ("E_X0B", "mm", -0.417, -0.406, 0.011, 0.022),
    "E_Z0B": ("E_Z0B", "mm", 0.532, 0.534, 0.002, 0.020),
    "E_A0B": ("E_A0B", "deg", -0.2669, -0.2671, -0.1757e-3, 0.0009),
    "E_C0B": ("E_C0B", "deg", -0.1839, -0.1845, -0.5414e-3, 0.0013),
    "E_X0C": ("E_X0C", "mm", 0.23, 0.24, 0.01, 0.0168),
    "E_Y0C": ("E_Y0C", "mm", 0.367, 0.371, 0.004, 0.013),
    "E_A0C": ("E_A0C", "deg", 0.0434, 0.0434, -0.0073e-3, 0.0006),
    "E_B0C": ("E_B0C", "deg", 0.0121, 0.0122, 0.0625e-3, 0.0007),
}
NAMES = list(TABLE_4_7)
GIVEN = {name: row[2] for name, row in TABLE_4_7.items()}
UNIT = {name: row[1] for name, row in TABLE_4_7.items()}
# Tables 4.4 and 4.5: maximum, minimum, average of five repetitions.
TABLE_4_4 = {
    "probe_x": (85.572, 85.555, 85.564), "probe_y": (287.434, 287.422, 287.428), "probe_z": (454.227, 454.214, 454.220),
    "E_X0B": (-0.366, -0.431, -0.406), "E_Z0B": (0.559, 0.517, 0.544), "E_A0B": (-0.2669, -0.2671, -0.267),
    "E_C0B": (-0.181, -0.184, -0.184), "E_X0C": (0.235, 0.225, 0.230), "E_Y0C": (0.374, 0.364, 0.369),
    "E_A0C": (0.0434, 0.0432, 0.0433), "E_B0C": (0.0122, 0.0120, 0.0121),
}
AVERAGE = {name: row[2] for name, row in TABLE_4_4.items()}
DESIGN = {**{name: 0.0 for name in NAMES}, "probe_x": 85, "probe_y": 286, "probe_z": 457}
LINEAR = {"X": ("E_XX", "E_XY", "E_XZ"), "Y": ("E_YX", "E_YY", "E_YZ"), "Z": ("E_ZX", "E_ZY", "E_ZZ")}
SQUARENESS = ("S_XY", "S_XZ", "S_YZ")


def call(*words):
    done = subprocess.run([str(PROGRAM), *map(str, words)], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"gumshoe {words[0]}: {done.stderr}")
    return done.stdout


def conditions(poses):
    """Pattern 2 is where B moves: of poses of both patterns the last 14."""
    pattern = [1] * 19 + [2] * 14 if len(poses) == 33 else [0] * len(poses)
    angles = "\n".join(f"{k} = [" + ", ".join(f'"{p[i]} deg"' for p in poses) + "]" for i, k in enumerate("BC"))
    return f"[conditions]\n{angles}\npattern = {pattern}\n"


def drawn(name, half_width, per):
    scope = 'per = "reading"\n' if per == "reading" else ""
    return f'[quantities.{name}]\ndistribution = "rectangular"\nhalf_width = "{half_width}"\n{scope}'


def rotary(name, moves, degrees, scope):
    """`moving`: per pose, of the axis that moves. `clamped`: with one draw a pattern for the other. `all`: per pose,
    both. `run`: one draw a run, of the axis that moves."""
    if scope == "all":
        return drawn(name, f"{degrees} deg", "reading")
    text = f"[quantities.{name}.by.pattern]\n"
    for pattern in (1, 2):
        if pattern != moves and scope != "clamped":
            text += f'{pattern} = "0 deg"\n'
            continue
        per = ', per = "reading"' if pattern == moves and scope != "run" else ""
        text += (f'{pattern} = {{ value = "0 deg", components = [{{ distribution = "rectangular", '
                 f'half_width = "{degrees} deg"{per} }}] }}\n')
    return text


def scenario(evaluation="sequential", degrees=0.006, scope="moving", linear="reading", only=None, samples=100_000, extra=""):
    """Text of section 4.5's study. `only`: the contributors to be drawn, all if None."""
    text = (f'schema = 1\ntitle = "sphere calibration, study"\n[model]\nname = "sphere_calibration"\n'
            f'method = "virtual_experiment"\nevaluation = "{evaluation}"\n' + conditions(POSES) + "[quantities]\n")
    text += "".join(f'{name} = "{GIVEN[name]} {UNIT[name]}"\n' for name in NAMES)
    for name, moves in (("E_CC", 1), ("E_BB", 2)):
        if only is None or name in only:
            text += rotary(name, moves, degrees, scope)
    for name in sum(LINEAR.values(), ()):
        if only is None or name in only:
            text += drawn(name, "4 um", linear)
    for name in SQUARENESS:
        if only is None or name in only:
            text += drawn(name, "8 um/m", "run")
    return text + extra + f"[run]\nsamples = {samples}\nseed = 1\n"


class Result:
    """Errors of the eleven in mm and deg (parameter, sample), their summary, and what the fits say of themselves."""

    def __init__(self, file):
        with h5py.File(file) as f:
            scale = [1e3 if UNIT[name] == "mm" else 180 / math.pi for name in NAMES]
            self.errors = np.array([f[f"outputs/{name}"][0] * k for name, k in zip(NAMES, scale)])
            at = [list(f["summary/name"].asstr()).index(f"error of {name}") for name in NAMES]
            pick = lambda what: f[f"summary/{what}"][:][at] * scale
            self.mean, self.mean_se = pick("estimate"), pick("estimate_se")
            self.u, self.u_se = pick("standard_uncertainty"), pick("standard_uncertainty_se")
            self.rank = np.unique(f["outputs/rank"][0])
            self.condition = np.mean(f["outputs/condition_number"][0])
            self.residual = np.sqrt(np.mean(f["outputs/residual_rms"][0] ** 2)) * 1e6  # um
            self.failed = int(np.sum(f["outputs/status"][:] != 0))
        if self.failed:
            raise SystemExit(f"{self.failed} samples failed")


def run(**choices):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "study.toml"
        file.write_text(scenario(**choices))
        call("run", file, "--out", file.with_suffix(".h5"))
        return Result(file.with_suffix(".h5"))


def commands(machines, poses, evaluation="exact", **more):
    """X, Y, Z (machine, pose, 3) of machines given as dicts of the eleven; `more`: further columns by `name (unit)`."""
    header = [f"{name} ({UNIT[name]})" for name in NAMES] + ["B (deg)", "C (deg)", *more]
    with tempfile.NamedTemporaryFile("w", suffix=".csv", newline="") as table:
        writer = csv.writer(table, lineterminator="\n")
        writer.writerow(header)
        for machine in machines:
            for b, c in poses:
                writer.writerow([repr(float(machine[name])) for name in NAMES] + [b, c, *more.values()])
        table.flush()
        text = call("evaluate", "sphere_calibration", "--table", table.name, "--evaluation", evaluation)
    rows = list(csv.DictReader(io.StringIO(text)))
    return np.array([[float(r[f"{k} (mm)"]) for k in "XYZ"] for r in rows]).reshape(len(machines), len(poses), 3)


def fit(estimated, fixed, poses, xyz, evaluation, pattern):
    """`gumshoe estimate` of some of the eleven from commands without noise."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        lines = [f"{b},{c},{pattern}," + ",".join(repr(float(v)) for v in row) for (b, c), row in zip(poses, xyz)]
        (folder / "data.csv").write_text("B,C,pattern,X,Y,Z\n" + "\n".join(lines) + "\n")
        text = f'schema = 1\n[model]\nname = "sphere_calibration"\nevaluation = "{evaluation}"\n'
        for name in NAMES:
            text += f'[quantities.{name}]\nvalue = "{float(fixed[name])!r} {UNIT[name]}"\n'
            text += "estimated = true\n" if name in estimated else ""
        where = ('B = { column = "B", unit = "deg" }, C = { column = "C", unit = "deg" }, '
                 'pattern = { column = "pattern", unit = "1" }')
        for k in "XYZ":
            text += (f'[indications.{k}]\nreadings = {{ file = "data.csv", column = "{k}", unit = "mm", '
                     f'conditions = {{ {where} }} }}\n')
        (folder / "fit.toml").write_text(text)
        return json.loads(call("estimate", folder / "fit.toml", "--format", "json"))


LENGTHS_1 = ["probe_x", "probe_y", "probe_z", "E_X0C", "E_Y0C"]
LENGTHS_2 = ["E_X0B", "E_Z0B"]


def two_steps(evaluation, xyz, shift=0.0, handed_on=True):
    """Eqs 4.27 and 4.40 in turn with the orientations known; `shift` is added to pattern II's recorded Y. The second step
    takes the lengths of the first or, not `handed_on`, the true ones. Errors of the seven lengths and the rms of each
    step's residuals, in um."""
    first = fit(LENGTHS_1, GIVEN, PATTERN_1, xyz[:19], evaluation, 1)
    found = {**GIVEN, **{name: first["parameters"][name]["value"] for name in LENGTHS_1}}
    known = found if handed_on else GIVEN
    moved = xyz[19:] + np.array([0, shift, 0])
    second = fit(LENGTHS_2, known, PATTERN_2, moved, evaluation, 2)
    first_residuals = xyz[:19] - commands([found], PATTERN_1, evaluation, pattern=1)[0]
    found.update({name: second["parameters"][name]["value"] for name in LENGTHS_2})
    final = {**known, **{name: found[name] for name in LENGTHS_2}}
    after = [first_residuals, moved - commands([final], PATTERN_2, evaluation, pattern=2)[0]]
    return ({name: 1e3 * (found[name] - GIVEN[name]) for name in LENGTHS_1 + LENGTHS_2},
            [1e3 * np.sqrt(np.mean(a ** 2)) for a in after])
