"""What generators apart from the study share: sets of named kinds, traced by the program, and a table of what was found."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest


def found_in(program, write, kind, seed):
    """Names that a trace of one set finds: of each finding the members. @param write: (folder, kind, seed) -> scenario"""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        run = subprocess.run([program, "trace", write(path, kind, seed), "--out", path / "out.h5", "--format", "json"],
                             capture_output=True, text=True, timeout=600)
        assert run.returncode == 0, run.stderr
        return [f["members"] or [f["name"]] for f in json.loads(run.stdout)["findings"]]


def score(found, kinds, n):
    """A line per kind, of n sets. @param kinds: name to what may be said of it; nothing: nothing may"""
    for kind, right in kinds.items():
        seen = [found(kind, 100 + i) for i in range(n)]
        good = sum(any(right & set(names) for names in s) if right else not s for s in seen)
        print(f"| {kind} | {good} of {n} | {'; '.join(' + '.join(' or '.join(m) for m in s) or 'nothing' for s in seen)} |", flush=True)


def main(found, kinds):
    """With --score N the table, else the tests."""
    if "--score" in sys.argv:
        score(found, kinds, int(sys.argv[sys.argv.index("--score") + 1]))
    else:
        unittest.main()
