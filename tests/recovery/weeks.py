#!/usr/bin/python3
"""Weekly campaigns of an axis, appended to a history: how often does evidence for anything ever reach 1/alpha?

usage: weeks.py path/to/gumshoe [--machines 40] [--weeks 52] [--missing nothing]
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import tempfile

import axis

STATED = "".join(f'[stated_effects.{name}]\nindication = "d"\nformula = "{formula}"\nunit = "{unit}"\n' for name, formula, unit in (
    ("reversal", "direction", "um"), ("bow", "x^2", "um/m^2"), ("drift", "t", "um/h"), ("warm", "T", "um/K"),
    ("growth", "t * x", "um/(m h)")))


def campaigns(program, missing, machine, weeks, noise="plain"):
    """The histories after each week, as the verdicts have them."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for week in range(weeks):
            axis.write(folder, missing, 1000 * machine + week, noise, False)
            (folder / "s.toml").write_text(axis.scenario(False, 99) + STATED)
            run = subprocess.run([program, "trace", "s.toml", "--append", "h.h5", "--format", "json", "--threads", "1"],
                                 cwd=folder, capture_output=True, text=True, check=True)
            yield json.loads(run.stdout)["history"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("--machines", type=int, default=40)
    parser.add_argument("--weeks", type=int, default=52)
    parser.add_argument("--missing", choices=axis.MISSING, default="nothing")
    parser.add_argument("--noise", choices=axis.NOISE, default="plain")
    a = parser.parse_args()
    most = lambda machine: max(h["log10_overall"] for h in campaigns(a.program, a.missing, machine, a.weeks, a.noise))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        reached = sorted(pool.map(most, range(a.machines)))
    print(f"{sum(r >= 1.30103 for r in reached)} of {a.machines} machines ever reached 20 to 1 in {a.weeks} weeks; "
          f"largest evidence {10 ** reached[-1]:.3g} to 1, median {10 ** reached[len(reached) // 2]:.2g}")


if __name__ == "__main__":
    main()
