"""A table of compensation: the error of an unknown effect at each combination of levels, and what corrects it."""
import types

from .rounding import decimals, finer, fixed, unit_text

MOST = 60  # rows on the page; the CSV table has all


def unit_of(t):
    """Unit of errors and corrections, with its factor from SI: one for the whole table."""
    factor = t.size_display_factor
    size = max(max(abs(row.y), row.u) for row in t.rows) * factor
    unit, further = finer(t.size_display_units, size)
    if unit == "um" and 0 < size * further < 0.1:
        unit, further = "nm", 1e3 * further
    return unit, factor * further


def shown(key):
    """A condition's values in its unit, or a label's."""
    if isinstance(key.values[0], str):
        return key.values, ""
    return [x * key.display_factor + key.display_offset for x in key.values], key.display_units


def of_labels(t):
    """Whether all levels are parts, people or machines by name: what differs from one to the next may be what was to be measured."""
    return all(isinstance(key.values[0], str) for key in t.keys.values())


def is_reference(t, row):
    """Whether a part is one of those that the others are compared with: its difference is zero by definition."""
    return of_labels(t) and row.y == 0 and row.u == 0


def table(t):
    """Heads and rows as text. What is subtracted from an indication corrects it: its error with the other sign."""
    unit, factor = unit_of(t)
    places = decimals(factor * min((row.u for row in t.rows if row.u > 0), default=0))
    heads, columns = [], []
    for name, key in t.keys.items():
        values, of = shown(key)
        heads.append(name.replace("_", " ") + (f" ({unit_text(of)})" if unit_text(of) else ""))
        columns.append([v if isinstance(v, str) else f"{v:.6g}".replace("-", "−") for v in values])
    def line(keys, row):
        if is_reference(t, row):
            return types.SimpleNamespace(keys=keys, error="reference", correction="", u="", readings=int(row.readings))
        return types.SimpleNamespace(keys=keys, error=fixed(factor * row.y, places), correction=fixed(-factor * row.y, places),
                                     u=fixed(factor * row.u, places), readings=int(row.readings))
    lines = [line(keys, row)
             for keys, row in zip(zip(*columns), t.rows)]
    return types.SimpleNamespace(heads=heads, rows=lines[:MOST], more=max(0, len(lines) - MOST), unit=unit_text(unit),
                                 indication=t.indication.replace("_", " "), of_labels=of_labels(t))


def lines(t):
    """The rows for the CSV table, in the units of the page."""
    unit, factor = unit_of(t)
    keys = {name: shown(key) for name, key in t.keys.items()}
    for k, row in enumerate(t.rows):
        yield {**{name + (f" ({of})" if of not in ("", "1") else ""): values[k] for name, (values, of) in keys.items()},
               "error": factor * row.y, "correction": -factor * row.y, "standard_uncertainty": factor * row.u, "unit": unit,
               "readings": int(row.readings)}
