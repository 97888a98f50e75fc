"""Names of candidates as one says them; the program's own name is what its tables and files call them."""
import re

from .choice import joined

POWERS = {"2": "square", "3": "cube"}


def plain(name):
    return name.replace("_", " ")


def of_quantity(rest):
    """rod_length[rod 2]: length of rod 2."""
    quantity, _, label = rest.partition("[")
    label = label.rstrip("]")
    words = plain(quantity)
    if not label:
        return words
    kind = label.split(" ")[0]
    return f"{words.removeprefix(kind + ' ')} of {label}"


def by(rest):
    return joined([plain(name) for name in rest.split("*")])


def polynomial(rest):
    if rest.startswith("1/"):
        return f"inverse of {plain(rest[2:])}"
    name, _, power = rest.partition("^")
    return f"{POWERS[power]} of {plain(name)}" if power in POWERS else f"proportional to {plain(rest)}"


def harmonic(rest):
    times, _, angle = rest.partition("x")
    return f"{times} wave{'s' if times != '1' else ''} per turn of {plain(angle)}"


FORMS = {"declared": lambda rest: f"{of_quantity(rest)} (declared)",
         "scatter": lambda rest: f"scatter by {joined([plain(name) for name in rest.split(',')])}",
         "table": lambda rest: f"any value by {by(rest)}",
         "omnibus": lambda rest: f"any smooth dependence on {by(rest)}",
         "product": lambda rest: f"product of {by(rest)}",
         "harmonic": harmonic, "polynomial": polynomial,
         "hysteresis": lambda rest: f"direction of motion of {plain(rest)}",
         "wave": lambda rest: f"a wave along {plain(rest)}",
         "drift": lambda rest: f"drift that levels off in {plain(rest)}",
         "step": lambda rest: f"offset of {plain(rest)}"}


def readable(name, shape=""):
    """A candidate as a reader says it; `shape`: what was held fixed of it."""
    family, colon, rest = name.partition(":")
    if family == "step" and " after " in rest:
        return f"step after {rest.partition(' after ')[2]}"
    if family in ("pulse", "shift") and " about " in rest:
        return f"{'pulse' if family == 'pulse' else 'gradual step'} about {rest.partition(' about ')[2]}"
    if family == "polynomial" and shape.startswith("square"):
        return f"square of {plain(rest)}"
    return FORMS[family](rest) if colon and family in FORMS else plain(name)
