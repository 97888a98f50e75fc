"""Adds a stranger's effect and a stranger's model to a copy of the tree, as CONTRIBUTING describes, builds only what is
needed and runs the contracts on them. Then it makes a mistake in each: the contracts must find it.

usage: walk.py [folder of the copy]     default: build/walk. The copy and its build are kept: the next walk is short.
"""
import filecmp
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
WALK = ROOT / "tests/walk"
MOST_UNITS = 35  # that one effect may recompile
MOST_LINES = 100  # of a model's header: its card, its names and its physics


def run(*command, cwd, fails=False):
    """Output of a command; ends the walk if it does not end as it should."""
    done = subprocess.run([str(c) for c in command], cwd=cwd, capture_output=True, text=True)
    if (done.returncode != 0) != fails:
        sys.exit(f"{done.stdout[-6000:]}{done.stderr[-6000:]}\nwalk: error: {' '.join(map(str, command))} "
                 + ("does not fail" if fails else "fails"))
    return done.stdout + done.stderr


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)  # with today's time: what was built from another text is built anew


def mirror(copy):
    """Makes `copy` the tree as it is, builds apart; files that are equal keep their times."""
    names = run("git", "ls-files", "-co", "--exclude-standard", cwd=ROOT).splitlines()
    wanted = {name for name in names if (ROOT / name).is_file()}
    for path in [p for p in copy.rglob("*") if p.is_file()]:
        name = path.relative_to(copy).as_posix()
        if not name.startswith("build/") and name not in wanted:
            path.unlink()
    for name in sorted(wanted):
        if not (copy / name).is_file() or not filecmp.cmp(ROOT / name, copy / name, shallow=False):
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, copy / name)
            shutil.copymode(ROOT / name, copy / name)


def build(copy):
    return run("cmake", "--build", "build/dev", "--target", "gumshoe", "gumshoe_contracts", cwd=copy)


def contracts(copy, fails=False):
    return run("build/dev/tests/gumshoe_contracts", cwd=copy, fails=fails)


def including(copy, changed):
    """Translation units of the whole project, tests and all, that read one of the changed files."""
    roots = [copy / "engine", copy / "tests", copy / "build/dev/engine/generated"]
    direct = {}

    def closure(file, seen):
        if file in seen:
            return
        seen.add(file)
        if file not in direct and not file.is_file():
            direct[file] = []  # made by the build
        if file not in direct:
            names = re.findall(r'^\s*#\s*include\s*"([^"]+)"', file.read_text(errors="replace"), re.M)
            places = [[p / name for p in [file.parent, *roots] if (p / name).is_file()] for name in names]
            direct[file] = [found[0].resolve() for found in places if found]
        for other in direct[file]:
            closure(other, seen)

    units = [pathlib.Path(u["directory"], u["file"]).resolve()
             for u in json.loads((copy / "build/dev/compile_commands.json").read_text())]
    hit = []
    for unit in units:
        seen = set()
        closure(unit, seen)
        hit += [unit.name] * bool(seen & changed)
    return hit, len(units)


def insert_row(catalogue, row, after):
    """Writes a row after the last one that matches `after`, or at the end."""
    lines = catalogue.read_text().splitlines()
    at = max([i for i, line in enumerate(lines) if re.match(after, line)], default=len(lines) - 1)
    write(catalogue, "\n".join([*lines[:at + 1], row, *lines[at + 1:]]) + "\n")


def add_effect(copy):
    folder, catalogue = copy / "engine/effects/rod_growth", copy / "engine/effects/catalogue.def"
    shutil.copytree(WALK / "effect/rod_growth", folder, copy_function=shutil.copyfile, dirs_exist_ok=True)
    insert_row(catalogue, "GUMSHOE_EFFECT(rod_growth, RodGrowth)", r"GUMSHOE_EFFECT\(reclamp,")
    run("cmake", "--preset", "dev", cwd=copy)
    hit, units = including(copy, {catalogue.resolve(), (folder / "rod_growth.h").resolve()})
    print(f"effect: one folder, one line; {len(hit)} of {units} translation units read it: {', '.join(sorted(hit))}")
    built = re.findall(r"Building CXX object (\S+)", build(copy))
    print(f"effect: {len(built)} of them were needed and built")
    if not 0 < len(built) <= len(hit) < MOST_UNITS:
        sys.exit(f"walk: error: an effect may recompile fewer than {MOST_UNITS} units, those that read it: {built}")
    contracts(copy)
    if "rod_growth" not in run("build/dev/gumshoe", "effects", cwd=copy):
        sys.exit("walk: error: gumshoe effects does not list rod_growth")
    print("effect: the contracts hold")


def add_model(copy):
    folder = copy / "engine/models/ball_distance"
    shutil.copytree(WALK / "model/ball_distance", folder, copy_function=shutil.copyfile, dirs_exist_ok=True)
    insert_row(copy / "engine/models/catalogue.def", "GUMSHOE_MODEL(ball_distance, BallDistance)", "GUMSHOE_MODEL")
    lines = len((folder / "ball_distance.h").read_text().splitlines())
    print(f"model: one folder, one line; its header has {lines} lines")
    if lines > MOST_LINES:
        sys.exit(f"walk: error: the header has more than {MOST_LINES} lines")
    build(copy)
    contracts(copy)
    result = copy / "build/ball_distance.h5"
    result.unlink(missing_ok=True)
    run("build/dev/gumshoe", "run", folder / "example.toml", "--samples", "1000", "--out", result, cwd=copy)
    print("model: the contracts hold, its example runs")


def mistake(copy, name, right, wrong):
    """The contracts find a mistake in a file."""
    file = copy / name
    text = file.read_text()
    if text.count(right) != 1:
        sys.exit(f"walk: error: {name} does not contain '{right}' once")
    write(file, text.replace(right, wrong))
    build(copy)
    said = contracts(copy, fails=True)
    if file.stem not in said:
        sys.exit(f"{said[-6000:]}\nwalk: error: the contracts fail, but not at {file.stem}")
    write(file, text)
    print(f"mistake: '{wrong}' for '{right}' is found")


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__)
        sys.exit(0)
    copy = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/walk").resolve()
    copy.mkdir(parents=True, exist_ok=True)
    mirror(copy)
    run("cmake", "--preset", "dev", cwd=copy)
    build(copy)
    contracts(copy)
    print(f"copy in {copy}: built, the contracts hold", flush=True)
    add_effect(copy)
    add_model(copy)
    mistake(copy, "engine/effects/rod_growth/rod_growth.h", "q[0] * event.time", "(q[0] + 1e-15) * event.time")
    mistake(copy, "engine/models/ball_distance/ball_distance.h", "length<T>(b - a) / growth(at)",
            "length<T>(b - a) * growth(at)")


main()
