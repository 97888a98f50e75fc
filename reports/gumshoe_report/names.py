"""Names of candidates as one says them; the program's own name is what its tables and files call them."""
import re

from .choice import joined

POWERS = {"2": "square", "3": "cube"}


def plain(name):
    """A name of a quantity, effect or label; not a label's value, which stays as it is marked on the part."""
    name, bracket, labels = name.partition("[")
    return name.replace("_", " ") + bracket + of_label(labels)


def of_label(text):
    """A label with its value, "tool_id T_2", and what may follow."""
    label, space, value = text.partition(" ")
    return label.replace("_", " ") + space + value


def of_quantity(rest):
    """rod_length[rod 2]: length of rod 2."""
    quantity, _, label = rest.partition("[")
    words, label = plain(quantity), label.removesuffix("]")
    if not label:
        return words
    return f"{words.removeprefix(plain(label.partition(' ')[0]) + ' ')} of {of_label(label)}"


def by(rest):
    return joined([plain(name) for name in rest.split("*")])


def scatter(rest):
    return "larger noise of single readings" if rest == "reading" else f"scatter by {joined([plain(name) for name in rest.split(',')])}"


def polynomial(rest):
    if rest.startswith("1/"):
        return f"inverse of {plain(rest[2:])}"
    name, _, power = rest.partition("^")
    return f"{POWERS[power]} of {plain(name)}" if power in POWERS else f"proportional to {plain(rest)}"


def harmonic(rest):
    times, _, angle = rest.partition("x")
    return f"{times} wave{'s' if times != '1' else ''} per turn of {plain(angle)}"


FORMS = {"declared": lambda rest: f"{of_quantity(rest)} (declared)",
         "scatter": scatter,
         "table": lambda rest: f"any value by {by(rest)}",
         "omnibus": lambda rest: f"any dependence on {by(rest)}",
         "product": lambda rest: f"product of {joined([of_label(part) for part in rest.split('*', 1)])}",
         "harmonic": harmonic, "polynomial": polynomial,
         "hysteresis": lambda rest: f"direction of motion of {plain(rest)}",
         "wave": lambda rest: f"a wave along {plain(rest)}",
         "drift": lambda rest: f"drift that levels off in {plain(rest)}",
         "lag": lambda rest: f"delayed effect of {plain(rest)}",
         "step": lambda rest: f"offset of {of_label(rest)}"}


def readable(name, shape=""):
    """A candidate as a reader says it; `shape`: what was held fixed of it."""
    family, colon, rest = name.partition(":")
    if family in ("step", "bend") and " after " in rest:
        course, _, reading = rest.partition(" after ")
        part = course.partition(" with ")[2]
        return f"{family} of {of_label(part)} after {reading}" if part else f"{family} after {reading}"
    if family == "while" and " from reading " in rest:
        course, _, readings = rest.partition(" from ")
        part = course.partition(" with ")[2]
        return f"difference{' of ' + of_label(part) if part else ''} from {readings}"
    if family in ("pulse", "shift") and " about " in rest:
        return f"{'pulse' if family == 'pulse' else 'gradual step'} about {rest.partition(' about ')[2]}"
    if family == "polynomial" and shape.startswith("square"):
        return f"square of {plain(rest)}"
    return FORMS[family](rest) if colon and family in FORMS else plain(name)
