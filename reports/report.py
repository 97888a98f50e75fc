#!/usr/bin/python3
"""Report of a result file: one self-contained HTML page and CSV tables next to it.

report.py RESULT.h5 [--out FILE.html] [--csv DIR] [--page-only] [--force]
"""
import argparse
import os
import pathlib
import sys
import traceback
import warnings

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))  # whatever the environment says of paths
os.environ["MPLBACKEND"] = "Agg"
warnings.simplefilter("ignore")  # a figure without room for its axes is drawn all the same
try:
    from gumshoe_report import csv_tables, output, page, read
except (ImportError, MemoryError) as problem:
    sys.exit(f"error: the report generator does not start ({problem}).")


def main():
    parser = argparse.ArgumentParser(description="One self-contained HTML page and CSV tables from a result file.")
    parser.add_argument("result", type=pathlib.Path, help="result file (HDF5)")
    parser.add_argument("--out", type=pathlib.Path, help="HTML file (default: next to the result)")
    parser.add_argument("--csv", type=pathlib.Path, help="folder for the CSV tables (default: next to the HTML)")
    parser.add_argument("--page-only", action="store_true", help="no CSV tables, no list of what was written")
    parser.add_argument("--force", action="store_true", help="replace files that another scenario or program wrote")
    arguments = parser.parse_args()
    sys.stdout.reconfigure(errors="surrogateescape")  # names of files as they are
    sys.stderr.reconfigure(errors="surrogateescape")
    out = arguments.out or arguments.result.with_suffix(".html")
    folder = arguments.csv or out.parent
    try:
        result = read.result(arguments.result)
        tables = {} if arguments.page_only else csv_tables.files(result, folder, out.stem)
        written = {out: f"{page.render(result)}<!-- {output.signature(result)} -->\n".encode("utf-8", "replace"), **tables}
        if tables:
            folder.mkdir(parents=True, exist_ok=True)
        with output.Claim(out):
            output.check(out, tables, result, arguments.force)
            output.publish(written)
        if arguments.page_only:
            return 0
    except (read.NotAResult, output.Refused) as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 2
    except MemoryError:
        print("error: the page needs more memory than there is.", file=sys.stderr)
        return 2
    except OSError as problem:
        print(f"error: '{problem.filename or out}' cannot be written ({problem.strerror}).", file=sys.stderr)
        return 2
    try:
        print(*written, sep="\n", flush=True)
    except OSError as problem:
        print(f"error: standard output cannot be written ({problem.strerror}).", file=sys.stderr)
        sys.stdout = None  # nothing is left to flush at exit
        return 2
    return 0


def fault(problem):
    """Where an error arose that nobody foresaw, in a line."""
    place = traceback.extract_tb(problem.__traceback__)[-1]
    return f"{type(problem).__name__}: {problem}, {pathlib.Path(place.filename).name}, line {place.lineno}"


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Exception as problem:
        print(f"error: the page cannot be made ({fault(problem)}). This is a fault of the report.", file=sys.stderr)
        sys.exit(2)
