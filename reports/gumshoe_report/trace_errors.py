"""The table of errors before and after: of the hold-out, of its worst block and reading, and in sample."""
import math
import re
import types

from .rounding import decimals, fixed, unit_text


def named(t, row):
    labels = ", ".join(f"{name} {column.values[row.reading]}" for name, column in t.data.labels.items())
    return f"reading {row.reading + 1}" + (f" ({labels})" if labels else "")


def worst_readings(t):
    """(what, note, before, after) of the largest residuals of the hold-out, each of one reading."""
    r = t.rms
    held_out = [row for row in t.residuals if row.final and math.isfinite(row.before)]
    equal = lambda key, value: [row for row in held_out if math.isclose(abs(getattr(row, key)), value, rel_tol=1e-6)]
    stated = re.match(r"reading (\d+)\b", r.worst_point)
    number = int(stated[1]) - 1 if stated else None
    find = lambda key, value: min(equal(key, value), key=lambda row: row.reading != number, default=None)
    first, last = find("before", r.worst_point_before), find("after", r.worst_point_after)
    if first is None or last is None:
        return [("largest residual of one reading", f"after: {r.worst_point}; before, it may be another one",
                 r.worst_point_before, r.worst_point_after)] if math.isfinite(r.worst_point_before) else []
    line = lambda what, row: (what, named(t, row), abs(row.before), abs(row.after))
    same = first is last or math.isclose(abs(last.before), r.worst_point_before, rel_tol=1e-6)
    return [line("largest residual of one reading", last)] if same else [
        line("largest residual of one reading before", first), line("largest residual of one reading after", last)]


def rows(words):
    """The rows of the table: what, before, after, noise with its interval."""
    r, found = words.t.rms, []
    def noise(middle, low, high):
        if not math.isfinite(middle):
            return ""
        interval = f" [{words.number(low)}, {words.number(high)}]" if math.isfinite(low) and math.isfinite(high) else ""
        return words.number(middle) + interval
    def add(what, note, before, after, text=""):
        if math.isfinite(before) or math.isfinite(after):
            found.append(types.SimpleNamespace(what=what, note=note, before=words.number(before), after=words.number(after), noise=text))
    add("hold-out", words.of_blocks(r.holdout), r.holdout_before, r.holdout_after,
        noise(r.holdout_noise, r.holdout_noise_low, r.holdout_noise_high))
    add("worst block", words.of_blocks(r.worst_block), r.worst_block_before, r.worst_block_after)
    for line in worst_readings(words.t):
        add(*line)
    add("in sample", "training data: used for the search and the fit, so too optimistic", r.before, r.after,
        noise(r.noise, r.noise_low, r.noise_high))
    return found + [of_indication(e, words.shown_unit) for e in words.t.of_indications]


def of_indication(e, shown_unit):
    apart = math.isfinite(e.holdout_after)
    was, now = (e.holdout_before, e.holdout_after) if apart else (e.before, e.after)
    unit, factor = shown_unit(e, max(was, now))
    places = decimals(factor * max(was, now))
    return types.SimpleNamespace(
        what=f"{e.name}, {'hold-out' if apart else 'in sample'}{unit_text(unit) and f' ({unit_text(unit)})'}", note="",
        before=fixed(factor * was, places), after=fixed(factor * now, places), noise="")
