#!/usr/bin/python3
"""A battery of made-up sets with the traits of real data: every family is traced in rounds (`gumshoe trace --loop`) and scored.

The families stand in families.py. The run goes on where it was broken off, unless the program has changed since.
"""
import argparse
import hashlib
import json
import multiprocessing
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import battery_sets
import battery_tables
import tables
from battery_score import row as scored
from families import FAMILIES
from predictions import covered

ROOT = Path(__file__).resolve().parents[2]
ROUNDS, DRAWS, SECONDS = 6, 199, 600


def one(job):
    """The row of one set; a bad set must not end a run of thousands."""
    program, family, seed = job
    out = dict(family=family.name, seed=seed)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        try:
            scenario, truth = battery_sets.make(program, family, seed, folder)
            begun = time.monotonic()
            run = subprocess.run([program, "trace", scenario, "--loop", str(ROUNDS), "--draws", str(DRAWS), "--threads", "1",
                                  "--out", folder / "found.h5", "--json", folder / "v.json"], capture_output=True, text=True, timeout=SECONDS)
            if run.returncode:
                return {**out, "failed": f"exit code {run.returncode}: {run.stderr.strip()[-200:]}"}
            out.update(seconds=time.monotonic() - begun, **scored(json.loads((folder / "v.json").read_text()), truth))
            traced = folder / f"{scenario.stem}.traced.toml"
            if traced.exists() and truth.get("final") and family.foretells(seed):
                out["predicted"] = covered(program, traced, truth["blocks"], truth["final"])
            return out
        except Exception as problem:
            return {**out, "failed": f"{type(problem).__name__}: {problem}"[:300]}


def keep(program, family, seed, folder):
    """Writes one set, to look at."""
    scenario, truth = battery_sets.make(program, family, seed, folder)
    print(f"{scenario}\ntruth: {json.dumps(truth)}")


def arguments(words):
    parser = argparse.ArgumentParser(prog="scripts/tracing-study --battery", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build" / "release" / "gumshoe"))
    parser.add_argument("--families", nargs="+", default=[""], help="those whose name contains one of these; see --list")
    parser.add_argument("--seeds", type=int, default=20, help="sets per family (20); five times as many nulls of expressions")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "tracing-battery", help="folder of rows.jsonl")
    parser.add_argument("--report", type=Path, help="page (default: OUT/battery.md)")
    parser.add_argument("--write", type=Path, metavar="FOLDER", help="writes the first set of the families there, and traces nothing")
    parser.add_argument("--list", action="store_true", help="prints the families")
    return parser.parse_args(words)


def earlier(file, program):
    """Rows of a run of the same program, or none."""
    lines = [json.loads(line) for line in file.open()] if file.exists() else []
    return lines[1:] if lines and lines[0]["program"] == program else None


def main(words):
    a = arguments(words)
    chosen = [f for f in FAMILIES if any(part in f.name for part in a.families)]
    if a.list:
        return print("\n".join(f.name for f in chosen))
    if a.write:
        for f in chosen:
            place = a.write / f.name.replace(" ", "_").replace(":", "_")
            place.mkdir(parents=True, exist_ok=True)
            keep(a.program, f, a.first_seed, place)
        return None
    program = hashlib.sha256(Path(a.program).read_bytes()).hexdigest()[:16]
    a.out.mkdir(parents=True, exist_ok=True)
    file = a.out / "rows.jsonl"
    rows = earlier(file, program)
    if rows is None:
        rows = []
        file.write_text(json.dumps(dict(program=program)) + "\n")
    known = {(r["family"], r["seed"]) for r in rows}
    jobs = [(a.program, f, seed) for f in chosen for seed in range(a.first_seed, a.first_seed + f.sets(a.seeds)) if (f.name, seed) not in known]
    jobs.sort(key=lambda job: (job[1].large, job[2]))  # broken off at any time, all families have had about as many
    with multiprocessing.Pool(a.processes) as pool, file.open("a") as log:
        for i, r in enumerate(pool.imap_unordered(one, jobs), 1):
            rows.append(r)
            log.write(json.dumps(r) + "\n")
            log.flush()
            if sys.stderr.isatty():
                print(f"\r{i} of {len(jobs)}", end="", file=sys.stderr, flush=True)
    version = subprocess.run([a.program, "--version"], capture_output=True, text=True).stdout.strip()
    report = a.report or a.out / "battery.md"
    own = [r for r in rows if r["family"] in {f.name for f in chosen}]
    tables.into(report, battery_tables.page(own, chosen, version, ROUNDS, DRAWS), battery_tables.TITLE)
    print(battery_tables.goals(own, chosen))
    print(f"{len(rows)} sets; {report}")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main(sys.argv[1:])
