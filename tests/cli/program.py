"""The program from outside: run it, and what its messages must look like."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
GUMSHOE = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else ""

# One rod, three readouts, two uncertain quantities: small enough to break in one place at a time.
SCENARIO = """schema = 1
[model]
name = "rod_gauging"
[quantities.rod_radius]
value = "5 mm"
u = "1 um"
[quantities.beam_pitch]
value = "0.2836 deg"
u = "0.005 deg"
[indications.spindle_z]
readings = ["-329.932 mm", "-329.932 mm", "-329.931 mm"]
resolution = "1 um"
repeatability = { s = "0.4 um", degrees_of_freedom = 24 }
"""


def gumshoe(*words, seconds=60, **options):
    """Runs it to the end; stdout and stderr as text."""
    options.setdefault("stdout", subprocess.PIPE)
    return subprocess.run([GUMSHOE, *map(str, words)], stderr=subprocess.PIPE, text=True, errors="replace",
                          timeout=seconds, **options)


def complaint(run):
    """What is wrong with the way a refusal was said, or None: one or more lines `[place: ]error: ...`, exit code 2."""
    if run.returncode != 2:
        return f"exit code {run.returncode}, not 2"
    lines = [line for line in run.stderr.splitlines() if line != "Run with --help for more information."]
    if not lines:
        return "nothing on stderr"
    for line in lines:
        if not re.match(r"(\S[^\n]*?:( |\d+:\d+: ))?error: \S", line):
            return f"not in the grammar: {line[:200]!r}"
    if len(run.stderr) > 10000:
        return f"{len(run.stderr)} characters are not one clear message"
    if re.search(r"Traceback|terminate called|core dumped|HDF5-DIAG|std::", run.stderr):
        return "a trace instead of a message"
    return None


def places(run, file):
    """(line, column) of each message about the file."""
    return [(int(a), int(b)) for a, b in re.findall(rf"^{re.escape(str(file))}:(\d+):(\d+): error: ", run.stderr, re.M)]
