#!/usr/bin/python3
"""Judges `gumshoe trace` on sets of readings with an undeclared effect, or none, and writes reports/tracing.md.

The sets are made anew by tests/recovery (seeds of development and of judgement are different), traced on two processes,
and scored by the public verdict files. A judgement run is counted in tests/recovery/judgements.csv.
"""
import argparse
import csv
import datetime
import json
import multiprocessing
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import sets
import tables
from generate import plan
from score import score

ROOT = Path(__file__).resolve().parents[2]
COUNTER = Path(__file__).with_name("judgements.csv")


def trace(program, scenario, draws, seconds=600):
    """(verdict or None, seconds, what was said)."""
    out = scenario.parent
    begun = time.monotonic()
    try:
        run = subprocess.run([program, "trace", scenario, "--json", out / "verdict.json", "--out", out / "traced.h5", "--draws", str(draws),
                              "--threads", "1"], capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None, seconds, "no verdict in time"
    said = run.stderr.strip()[-300:]
    file = out / "verdict.json"
    if not file.exists():
        return None, time.monotonic() - begun, f"exit code {run.returncode}: {said}"
    return json.loads(file.read_text()), time.monotonic() - begun, said


def one(job):
    program, folder, name, point, draws, keep = job
    system = sets.SYSTEMS[name]
    kind, what, strength, seed, noise = point
    row = dict(system=name, kind=kind, noise=noise, strength=strength, seed=seed, case=case_of(what))
    try:
        d, y, truth = sets.make(program, system, *point)
        title = sets.title(*point)
        scenario = sets.write(Path(folder) / name, Path(folder) / "truth" / name, title, d, y, truth, system)
        verdict, seconds, said = trace(program, scenario, draws)
        row.update(seconds=seconds, set=title, readings=int(y.size))
        if verdict is None:
            return {**row, "failed": said}
        row.update(score(verdict, truth))
        row["expected_class"] = [bool(e.get("twins") or e.get("unsplit")) for e in truth["effects"]]
        if not keep:
            shutil.rmtree(scenario.parent)
        return row
    except Exception as problem:  # one bad set must not end a study of thousands
        return {**row, "failed": f"{type(problem).__name__}: {problem}"[:300]}


def case_of(what):
    return "+".join(what) if isinstance(what, tuple) else str(what)


def identity(row):
    return tuple(str(row[k]) for k in ("system", "kind", "case", "noise", "seed")) + (float(row["strength"]),)


def identity_of(job):
    kind, what, strength, seed, noise = job[3]
    return identity(dict(system=job[2], kind=kind, case=case_of(what), strength=strength, seed=seed, noise=noise))


def jobs(a):
    for name in a.systems:
        system = sets.SYSTEMS[name]
        for kinds, noises, strengths, count, draws in (
                (["null"], a.noises, (0,), a.sets, a.null_draws),
                (["single", "pair", "alias", "outside", "scatter"], (), a.strengths, a.effect_sets, a.draws)):
            kinds = [k for k in kinds if not a.kinds or k in a.kinds]
            for point in plan(system, kinds, noises, strengths, range(a.first_seed, a.first_seed + count)):
                # What is aliased or outside is asked at strengths that are plain to see.
                if point[0] in ("alias",) and point[2] < 8:
                    continue
                yield (a.program, a.out, name, point, draws, a.keep)


def arguments(words):
    parser = argparse.ArgumentParser(prog="scripts/tracing-study", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", type=int, help="nulls per system and kind of noise (20; 500 in a judgement)")
    parser.add_argument("--effect-sets", type=int, help="sets per effect and strength (sets / 10 or / 25, at least 2)")
    parser.add_argument("--draws", type=int, default=499, help="bootstrap draws where something is there (499)")
    parser.add_argument("--null-draws", type=int, default=199, help="and where nothing is (199)")
    parser.add_argument("--strengths", type=float, nargs="+", default=list(sets.STRENGTHS))
    parser.add_argument("--systems", nargs="+", choices=sets.SYSTEMS, default=list(sets.SYSTEMS))
    parser.add_argument("--kinds", nargs="+", help="null single pair alias outside scatter; all by default")
    parser.add_argument("--noises", nargs="+", choices=sets.NULLS, default=list(sets.NULLS), help="of the nulls; all by default")
    parser.add_argument("--first-seed", type=int, default=1, help="of development")
    parser.add_argument("--judgement", action="store_true", help="fresh seeds, counted; writes the report")
    parser.add_argument("--resume", action="store_true", help="go on with the run in OUT: its seeds, and what it has not traced yet")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--keep", action="store_true", help="keep every set's folder")
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "tracing-study")
    parser.add_argument("--report", type=Path, help="by default reports/tracing.md of a judgement, else OUT/tracing.md")
    parser.add_argument("--program", default=str(ROOT / "build" / "release" / "gumshoe"))
    a = parser.parse_args(words)
    a.sets = a.sets or (500 if a.judgement else 20)
    a.effect_sets = a.effect_sets if a.effect_sets is not None else max(2, a.sets // (25 if a.judgement else 10))
    a.report = a.report or (ROOT / "reports" / "tracing.md" if a.judgement else a.out / "tracing.md")
    return a


def judgements():
    return list(csv.DictReader(COUNTER.open())) if COUNTER.exists() else []


def count_judgement(a, version):
    """Takes seeds that no run has had, and writes the run down before it begins."""
    runs = judgements()
    a.first_seed = sets.JUDGEMENT + 10_000 * len(runs)
    with COUNTER.open("a", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        if not runs:
            out.writerow(["run", "date", "version", "first_seed", "nulls_per_system_and_noise", "sets_per_effect_and_strength", "draws"])
        out.writerow([len(runs) + 1, datetime.date.today(), version, a.first_seed, a.sets, a.effect_sets, a.draws])


def main(words):
    a = arguments(words)
    version = subprocess.run([a.program, "--version"], capture_output=True, text=True).stdout.strip()
    log_file = a.out / "rows.jsonl"
    rows = [json.loads(line) for line in log_file.open()] if a.resume else []
    if a.judgement and a.resume:
        a.first_seed = int(judgements()[-1]["first_seed"])
    elif a.judgement:
        count_judgement(a, version)
    a.out.mkdir(parents=True, exist_ok=True)
    known = {identity(r) for r in rows}
    # By seeds: broken off at any time, all kinds have had about as many.
    pending = sorted((job for job in jobs(a) if identity_of(job) not in known), key=lambda job: job[3][3])
    begun = time.monotonic()
    with multiprocessing.Pool(a.processes) as pool, log_file.open("a" if a.resume else "w") as log:
        for i, row in enumerate(pool.imap_unordered(one, pending), 1):
            rows.append(row)
            log.write(json.dumps(row) + "\n")
            if sys.stderr.isatty():
                print(f"\r{i} of {len(pending)}", end="", file=sys.stderr, flush=True)
    run = dict(version=version, date=str(datetime.date.today()), machine=tables.machine(), seconds=time.monotonic() - begun, first_seed=a.first_seed,
               nulls=a.sets, effects=a.effect_sets, draws=a.draws, null_draws=a.null_draws, judgement=a.judgement, judgements=len(judgements()),
               processes=a.processes)
    a.report.parent.mkdir(parents=True, exist_ok=True)
    tables.into(a.report, tables.report(rows, run))
    if a.judgement:  # what the program says of measured data stands below
        subprocess.run([sys.executable, ROOT / "reports" / "reproduction" / "tracing_data.py", a.program], check=True)
    print(tables.short(rows))
    print(f"{len(rows)} sets in {run['seconds']:.0f} s; {a.report}")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main(sys.argv[1:])
