"""Conditions and indications of the readings in the unit that the scenario gives them."""
import math
import re
import types

from .rounding import COMMON, after

LABELLED, ALL = 6, 10  # digits of a value in a label; of one shown otherwise


def parts(name):
    """Labels and conditions in the name of an output: deviation[line 1, theta 50 deg]."""
    inside = re.search(r"\[(.*)\]$", name)
    return inside[1].split(", ") if inside else []


def labelled(r, name):
    """Unit, factor and offset by which the outputs' names show a condition, such as E[T 58 degC]; None where they do not."""
    found = {}
    for o in r.outputs:
        at = int(getattr(o, "reading", -1))
        for part in parts(o.name) if 0 <= at < len(r.readings) else ():
            shown = re.fullmatch(re.escape(name) + r" (-?[0-9.]+(?:e[-+]?\d+)?) (\S+)", part)
            if shown:
                found[getattr(r.readings[at], name)] = (float(shown[1]), shown[2])
    units = {unit for _, unit in found.values()}
    if len(units) != 1 or len(found) < 2:
        return None
    (low, (first, _)), (high, (last, _)) = min(found.items()), max(found.items())
    unit, = units
    if unit == COMMON.get(r.reading_units[name], ("",))[0]:
        return None  # its factor is known exactly
    shown = lambda value: float(f"{value:.{LABELLED}g}")
    alike = lambda a, b: abs(a - b) <= 1.1 * 10.0 ** (math.floor(math.log10(abs(b) or 1)) - LABELLED + 1)
    for digits in range(1, 16):  # the roundest factor that gives every label
        factor = float(f"{(last - first) / (high - low):.{digits}g}")
        for offset in (0.0, float(f"{first - factor * low:.{digits + 2}g}")):
            if all(alike(shown(factor * x + offset), value) for x, (value, _) in found.items()):
                return unit, factor, offset
    return None


def scale(r, name):
    """How values in SI are shown: as the file says, else as the labels do, else in the unit common in a workshop."""
    si = r.reading_units[name]
    row = r.reading_display.get(name) or next((i for i in r.inputs if (i.name, i.units) == (name, si)), None)
    of_labels = labelled(r, name) if row is None else None
    unit, factor, offset = of_labels or (*COMMON.get(si, (si, 1.0)), 0.0) if row is None else \
        (row.display_units, row.display_factor, row.display_offset)
    of = lambda x: x * factor + offset
    number = lambda x, digits=LABELLED if of_labels else ALL: f"{of(x):.{digits}g}".replace("-", "−")
    return types.SimpleNamespace(unit=unit, of=of, number=number, text=lambda x: number(x, LABELLED) + after(unit))
