"""Conditions and indications of the readings in the unit that the scenario gives them."""
import types

from .rounding import COMMON, after

DIGITS = 6  # of a value in text


def scale(r, name):
    """How values in SI are shown: as the file says or, of a file that does not say it, in the unit common in a workshop."""
    si = r.reading_units[name]
    row = r.reading_display.get(name)
    unit, factor, offset = (row.display_units, row.display_factor, row.display_offset) if row else (*COMMON.get(si, (si, 1.0)), 0.0)
    of = lambda x: x * factor + offset
    number = lambda x, digits=10: f"{of(x):.{digits}g}".replace("-", "−")
    return types.SimpleNamespace(unit=unit, of=of, number=number, text=lambda x: number(x, DIGITS) + after(unit))
