"""One set of a family: its files, and what is true."""
import importlib
import sys

import sets

# Systems with generators of their own: module, scenario, data file, what may be said of each thing missing.
APART = {"laser_scan": "scans_test", "laser_ball_bar": "contours_test"}
SYSTEMS = {**sets.SYSTEMS, **sets.EXPRESSIONS}


def make(program, family, seed, folder):
    """(scenario, truth)"""
    if family.system in APART:
        return apart(family, seed, folder)
    system = SYSTEMS[family.system]
    d, y, truth = sets.make(program, system, "several" if family.missing else "null", family.missing, 0, seed, family.noise,
                            floor=family.system != "tool_length", exact=family.system == "tool_length", **family.options)
    return sets.write(folder, folder / "truth", "set", d, y, truth, system), truth


def apart(family, seed, folder):
    words = sys.argv
    sys.argv = [words[0]]  # these modules take the program from the command line
    generator = importlib.import_module(APART[family.system])
    sys.argv = words
    kind = family.missing[0][0].replace("_", " ") if family.missing else "nothing"
    scenario = generator.write(folder, kind, seed)
    names = sorted(generator.KINDS[kind])
    effects = [dict(name=n, twins=names, unsplit=[], strength=s, outside=False, quantity=None, depends_on=[]) for n, (_, s) in zip(names, family.missing)]
    return scenario, dict(expected="named" if effects else "nothing_found", effects=effects, scatter=[])
