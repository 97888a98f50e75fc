"""Profiles: one measurand at many readings along one condition, such as the azimuth of a scan."""
import math
import re
import types

from .conditions import scale
from .explain import cancels, law_accounts, listed
from .rounding import after, finer, percent, significant

LEAST = 8    # points of a line
LINES = 6    # lines drawn; the tables have all
SHOWN = 6    # quantities with a colour of their own; the others together


def values(r, outputs):
    """Value of every condition at the readings of the outputs, SI."""
    read = {i.name for i in r.inputs} | {"label", "repeats", "reading"}  # what was read is no condition
    names = [n for n in r.reading_units if n not in read]
    found = {n: [getattr(r.readings[int(o.reading)], n, math.nan) for o in outputs] for n in names}
    return {n: v for n, v in found.items() if all(map(math.isfinite, v))}


def parts(name):
    """Labels and conditions in the name of an output: deviation[line 1, theta 50 deg]."""
    inside = re.search(r"\[(.*)\]$", name)
    return inside[1].split(", ") if inside else []


def along(conditions):
    """The condition that takes most values, time last; None if none takes enough."""
    ranked = sorted(conditions, key=lambda name: (name == "time", -len(set(conditions[name]))))
    return next((name for name in ranked if len(set(conditions[name])) >= LEAST), None)


def distinguishes_lines(column, place):
    """Whether every value of a label or condition holds for a line: at few places it names points, or is a reading."""
    places = {}
    for value, x in zip(column, place):
        places.setdefault(value, set()).add(x)
    return len(places) > 1 and min(map(len, places.values())) >= LEAST


def lines(outputs, conditions, name):
    """Outputs by line: those alike in all that distinguishes lines."""
    place = conditions[name]
    texts = [parts(o.name) for o in outputs]
    columns = [list(column) for column in zip(*texts)] if len({len(t) for t in texts}) == 1 else []
    shown = [column for column in columns if distinguishes_lines(column, place)]
    apart = shown + [column for n, column in conditions.items() if n != name and distinguishes_lines(column, place)]
    found = {}
    for k, o in enumerate(outputs):
        label = ", ".join(column[k] for column in shown)
        found.setdefault(tuple(column[k] for column in apart), (label, []))[1].append((place[k], o))
    return [types.SimpleNamespace(label=label, x=[x for x, _ in points], outputs=[o for _, o in points])
            for label, points in ((label, sorted(points, key=lambda p: p[0])) for label, points in found.values())
            if len({x for x, _ in points}) >= LEAST]


def of(r, outputs):
    """The profiles among the outputs: measurand, condition, lines."""
    groups = {}
    for o in outputs:
        if getattr(o, "reading", -1) >= 0 and int(o.reading) < len(r.readings):
            groups.setdefault(o.measurand, []).append(o)
    for measurand, group in groups.items():
        conditions = values(r, group)
        name = along(conditions)
        drawn = lines(group, conditions, name) if name else []
        if drawn:
            yield types.SimpleNamespace(measurand=measurand, along=name, units=r.reading_units[name], lines=drawn,
                                        scale=scale(r, name))


def of_variance(output, budgets, sobol):
    """Share of each quantity in the variance of an output; none where neither study accounts for it."""
    if sobol:
        rows = sobol[output.name].rows if output.name in sobol else []
        return {i.input: max(0.0, i.first) for i in rows if math.isfinite(i.first)}
    budget = budgets.get(output.name)
    found = {}
    law = budget is not None and budget.applicable and law_accounts(budget, output) and not cancels(budget)
    for c in budget.rows if law else ():
        if math.isfinite(c.share):  # all draws of one quantity together
            found[c.quantity] = found.get(c.quantity, 0.0) + c.share
    return found


def shares(profile, budgets, sobol):
    """Share of the variance of each quantity along each line: first-order indices where there are, else the budget's.
    The quantities in the order of their mean share, and by line a row for each of them."""
    tables = [[of_variance(o, budgets, sobol) for o in line.outputs] for line in profile.lines]
    everything = [row for rows in tables for row in rows if row]
    if not everything:
        return [], []
    mean = {}
    for row in everything:
        for name, share in row.items():
            mean[name] = mean.get(name, 0.0) + share / len(everything)
    order = [n for n in sorted(mean, key=lambda n: -mean[n]) if mean[n] > 0.005][:SHOWN]
    return order, [[[row.get(n, 0.0) if row else math.nan for row in rows] for n in order] for rows in tables]


def size(o):
    """u of an output as text."""
    u = o.standard_uncertainty * o.display_factor
    unit, factor = finer(o.display_units, u)
    return significant(factor * u) + after(unit)


def even(known):
    """Whether u is the same at all points: as it is written, or but for the scatter of so many Monte Carlo estimates."""
    low, high = (f(known, key=lambda o: o.standard_uncertainty) for f in (min, max))
    noise = max(o.standard_uncertainty_se if math.isfinite(o.standard_uncertainty_se) else 0.0 for o in known)
    reach = 2 * math.sqrt(2 * math.log(len(known))) * noise  # about the range of so many normal deviates
    return size(low) == size(high) or high.standard_uncertainty - low.standard_uncertainty <= reach


def widest(profile, budgets, sobol):
    """Where u is largest, and which quantities make it; "" where no output has one."""
    known = [(o.standard_uncertainty, line.label, x, o) for line in profile.lines for x, o in zip(line.x, line.outputs)
             if math.isfinite(o.standard_uncertainty)]
    if not known:
        return ""
    outputs = [o for *_, o in known]
    if even(outputs):
        sizes = list(dict.fromkeys(size(o) for o in sorted(outputs, key=lambda o: o.standard_uncertainty)))
        about = sizes[0] if len(sizes) == 1 else f"{sizes[0]} to {sizes[-1]}"
        text = f"The standard uncertainty of {profile.measurand} is {about} at every {profile.along}" + (
            "." if len(sizes) == 1 else "; that is no more than Monte Carlo estimates scatter.")
        shares = [of_variance(o, budgets, sobol) for o in outputs]
        mean = {name: sum(row.get(name, 0.0) for row in shares) / len(shares) for row in shares for name in row}
        return text + due(mean, " On average its variance is due to")
    ends = [(k, f(known, key=lambda point: point[0])) for k, f in (("largest", max), ("smallest", min))]
    told = [f"{word}, {size(o)}, at {profile.along} = {profile.scale.text(x)}" + (f" ({label})" if label else "")
            for word, (_, label, x, o) in ends]
    return (f"The standard uncertainty of {profile.measurand} is {told[0]}, and {told[1]}." +
            due(of_variance(ends[0][1][3], budgets, sobol), " Where it is largest, its variance is due to") + by_line(profile))


def due(shares, words):
    """The three largest shares of a variance in words; "" where none is worth a word."""
    found = sorted(shares.items(), key=lambda item: -item[1])[:3]
    main = [f"{name} {percent(share)}" for name, share in found if share > 0.05]
    return f"{words} {listed(main)}." if main else ""


def by_line(profile):
    """The largest u of each line, so that lines are compared."""
    ends = []
    for line in profile.lines[:LINES]:
        known = [o for o in line.outputs if math.isfinite(o.standard_uncertainty)]
        if known and line.label:
            ends.append(f"{size(max(known, key=lambda o: o.standard_uncertainty))} on {line.label}")
    return f" At most it is {'; '.join(ends)}." if len(ends) > 1 else ""
