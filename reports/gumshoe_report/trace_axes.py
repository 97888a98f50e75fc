"""What residuals are drawn against: conditions, recorded columns and labels of a trace, by reading."""
import math

from .rounding import COMMON


def labels(t):
    """Values of each label by reading; what scatters by two labels together comes first."""
    of = {name: column.values for name, column in t.data.labels.items()}
    joint = [f.depends_on for f in t.findings
             if f.kind == "scatter" and len(f.depends_on) > 1 and all(name in of for name in f.depends_on)]
    return {**{", ".join(names): [", ".join(values) for values in zip(*(of[n] for n in names))] for names in joint}, **of}


def axis_unit(column, values):
    """Unit, factor and offset in which values (SI) of a condition or column stand along an axis, the same in every figure."""
    unit, factor, offset = column.display_units, column.display_factor, column.display_offset
    if unit == column.units and unit in COMMON:
        unit, factor = COMMON[unit]
    if unit == "s" and max(values) - min(values) > 600:
        unit, factor = "min", 1 / 60
    return unit, factor, offset


def columns(t):
    """What residuals are drawn against: conditions and recorded columns that vary, those that a finding depends on
    first. (name, unit, values by reading, whether a finding depends on it)"""
    chosen = {name for f in t.findings for name in f.depends_on}
    found = []
    for name, column in {**t.data.columns, **t.data.conditions}.items():
        if len({v for v in column.values if math.isfinite(v)}) < 2:
            continue
        unit, factor, offset = axis_unit(column, column.values)
        found.append((name, unit, [v * factor + offset for v in column.values], name in chosen))
    return sorted(found, key=lambda c: not c[3])
