"""The program from outside: run it, and what its messages must look like."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
GUMSHOE = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else ""

# Models of tests that say `python3` mean this interpreter, also where a wrapper comes first in PATH.
os.environ["PATH"] = f"{pathlib.Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"

MADE = str(pathlib.Path(GUMSHOE).parent / "tests/gumshoe_made_result")  # writes made-up results with every study

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

# Two measurands, of which one fails in a few percent of 20,001 samples.
FORMULA = """schema = 1
[model]
name = "expression"
[model.measurands]
root = "sqrt(a)"
sum = "a + b"
[quantities]
a = { value = "1", u = "0.5" }
b = { value = "2", u = "0.1" }
[run]
samples = 20_001
max_failed_share = 0.1
"""


class InFolder(unittest.TestCase):
    """Each test has a new, empty folder."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)


class InOneFolder(unittest.TestCase):
    """The tests of a class share a folder, empty at first."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)


class Refusals(InOneFolder):
    """A good scenario, its result and a table, next to which bad ones are refused."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.good = cls.folder / "good.toml"
        cls.good.write_text(SCENARIO)
        cls.result = cls.folder / "good.h5"
        run = gumshoe("run", cls.good, "--samples", 1000, "--out", cls.result)
        assert run.returncode == 0, run.stderr
        cls.table = cls.folder / "good.csv"
        cls.table.write_text("rod_radius (mm)\n5\n")

    def refused(self, run, words=(), stdout=""):
        self.assertIsNone(complaint(run), run.stderr[:500])
        self.assertEqual(run.stdout or "", stdout)
        for word in words:
            self.assertIn(word, run.stderr)

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path


HUNG = 600  # seconds after which a program hangs, on any machine


def gumshoe(*words, seconds=HUNG, **options):
    """Runs the program to its end; stdout and stderr as text. Every error message on stderr must be well formed."""
    options.setdefault("stdout", subprocess.PIPE)
    run = subprocess.run([GUMSHOE, *map(str, words)], stderr=subprocess.PIPE, text=True, errors="replace",
                         timeout=seconds, **options)
    for line in run.stderr.splitlines():
        if re.match(MESSAGE, line):
            assert (fault := ill_formed(line)) is None, f"{fault}: {line[:300]!r}"
    return run


MESSAGE = r"(\S[^\n]*?:( |\d+:\d+: ))?error: (?=\S)"


def ill_formed(line):
    """What is wrong with the form `[place: ]error: what is wrong (why). What to do?` of a message, or None."""
    said = re.sub(MESSAGE, "", line, count=1)
    sentences, _, code = said.partition(" Try: ")
    if " Try: " in said and not re.match(r'[\w.]+ = |[\[{"]', code):
        return "what stands after 'Try:' is not code"
    if not sentences.endswith((".", "?")):
        return "no full stop or question mark at the end"
    if re.search(r"[.?!,;:][.?!]$| \(\)|\.\)\.", sentences) and not sentences.endswith("..."):
        return "two marks in a row"
    if re.search(r"[a-z)'\"][.?] [a-z]", sentences):
        return "a sentence begins without a capital"
    if re.search(r"\bdid you mean\b|^did|^use ", sentences):
        return "the remedy begins without a capital"
    return None


def complaint(run):
    """What is wrong with the way a refusal was said, or None: one or more lines `[place: ]error: ...`, exit code 2."""
    if run.returncode != 2:
        return f"exit code {run.returncode}, not 2"
    lines = [line for line in run.stderr.splitlines() if line != "Run with --help for more information."]
    if not lines:
        return "nothing on stderr"
    for line in lines:
        if not re.match(MESSAGE, line):
            return f"not in the grammar: {line[:200]!r}"
    if len(run.stderr) > 10000:
        return f"{len(run.stderr)} characters are not one clear message"
    if re.search(r"Traceback|terminate called|core dumped|HDF5-DIAG|std::", run.stderr):
        return "a trace instead of a message"
    return None


def places(run, file):
    """(line, column) of each message about the file."""
    return [(int(a), int(b)) for a, b in re.findall(rf"^{re.escape(str(file))}:(\d+):(\d+): error: ", run.stderr, re.M)]
