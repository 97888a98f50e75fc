#!/usr/bin/python3
"""Writes sets of readings with an undeclared effect, or none, and what is true of them apart.

    generate.py PROGRAM --out FOLDER [--truth FOLDER] [--system NAME] [--kinds null single pair alias outside scatter]
                [--noise KIND ...] [--strengths 3 5 8 15] [--seeds N] [--first-seed S] [--plain-names]
"""
import argparse
import sys
from pathlib import Path

import sets


def plan(system, wanted, noises, strengths, seeds):
    """(kind, what, strength, seed, noise) of everything asked for."""
    for seed in seeds:
        if "null" in wanted:
            yield from (("null", "", 0, seed, noise) for noise in noises)
        for kind, what in sets.kinds(system):
            if kind in wanted:
                yield from ((kind, what, s, seed, "white") for s in strengths)


def main(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--out", required=True)
    parser.add_argument("--truth")
    parser.add_argument("--system", choices=sets.SYSTEMS, nargs="+", default=list(sets.SYSTEMS))
    parser.add_argument("--kinds", nargs="+", default=["null", "single", "pair", "alias", "outside", "scatter"])
    parser.add_argument("--noise", nargs="+", choices=sets.NULLS, default=list(sets.NULLS))
    parser.add_argument("--strengths", nargs="+", type=float, default=[8.0])
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--plain-names", action="store_true", help="folders that say what is in them, for development")
    a = parser.parse_args(words)
    for name in a.system:
        system = sets.SYSTEMS[name]
        for point in plan(system, a.kinds, a.noise, a.strengths, range(a.first_seed, a.first_seed + a.seeds)):
            d, y, truth = sets.make(a.program, system, *point)
            kind, what, strength, seed, noise = point
            title = sets.title(*point)
            if a.plain_names:
                what = "+".join(what) if isinstance(what, tuple) else what
                title = f"{kind}-{what}-{strength:g}-{noise}-{seed}".replace("*", "any").replace(" ", "_").replace(":", "_")
            sets.write(Path(a.out) / name, Path(a.truth or a.out + ".truth") / name, title, d, y, truth, system)


if __name__ == "__main__":
    main(sys.argv[1:])
