"""The tables of a report: rows of text for people."""
import math
import re
import types

from . import budget_order, conditions, resolved
from .explain import cancels, independent
from .rounding import after, decimals, finer, fixed, percent, significant, unit_text

FOLDED_BELOW = 5e-4  # shares that the page sums up in one line when a budget is long
LONG = 10            # rows of a budget that are all shown
FOLDED_INDEX = 5e-3  # the same of indices, where the law of propagation has no shares


def point(row, value):
    return value * row.display_factor + row.display_offset


def spread(row, value):
    return value * row.display_factor


def commands(axis):
    """Commanded values of an axis of a volume, in its display unit."""
    first, last, intervals = spread(axis, getattr(axis, "from")), spread(axis, axis.to), int(axis.points) - 1
    return [round(first + (last - first) * k / intervals, 9) for k in range(intervals + 1)]


def of_failures(o, show):
    """What the interval is if the samples without a value had any values: its bounds by rank, where there are some."""
    low, high = (with_unit(show(end), o.display_units) if math.isfinite(end) else ""
                 for end in (o.symmetric_low_rank, o.symmetric_high_rank))
    if low and high:
        ends = with_unit(f"[{show(o.symmetric_low_rank)}, {show(o.symmetric_high_rank)}]", o.display_units)
        return f"Whatever their values, the symmetric interval lies within {ends}."
    if low or high:
        bound, end = ("upper", f"lower end is at least {low}") if low else ("lower", f"upper end is at most {high}")
        return f"With so many of them no {bound} bound can be given for the symmetric interval; its {end}."
    return "With so many of them no bounds can be given for the symmetric interval."


def places_of(o):
    """Decimal places of an output: two digits of u, or of a quarter of the interval where no u exists."""
    width = (o.shortest_high - o.shortest_low) / 4
    return decimals(spread(o, o.standard_uncertainty if math.isfinite(o.standard_uncertainty) else width))


def summary_row(o):
    places = places_of(o)
    show = lambda value: fixed(point(o, value), places)
    total = o.valid + o.failed
    return types.SimpleNamespace(
        name=o.name, unit=unit_text(o.display_units), estimate=show(o.estimate),
        called="median" if getattr(o, "estimate_is_median", 0) else "estimate",
        u=fixed(spread(o, o.standard_uncertainty), places), U=significant(spread(o, getattr(o, "expanded_uncertainty", math.nan))),
        k=fixed(getattr(o, "coverage_factor", math.nan), 2), symmetric=(show(o.symmetric_low), show(o.symmetric_high)),
        shortest=(show(o.shortest_low), show(o.shortest_high)),
        failed=f"{o.failed} of {total}" if o.failed else "",
        rank=of_failures(o, show) if o.failed else "",
        estimate_se=significant(spread(o, o.estimate_se)), u_se=significant(spread(o, o.standard_uncertainty_se)),
        skewness=fixed(o.skewness, 2), kurtosis=fixed(o.kurtosis, 2), warning=o.warning,
        said=bool(o.warning) and o.warning.partition(": ")[2] in o.statement,
        tail_remark=getattr(o, "tail_remark", ""), statement=o.statement)


def constant(o):
    """The same in every sample: there is no distribution to show."""
    return o.standard_uncertainty == 0 and o.symmetric_low == o.symmetric_high


def with_unit(text, units):
    return text + after(units)


def constant_text(o):
    return f"{o.name} = {with_unit(fixed(point(o, o.estimate), None), o.display_units)}" + (
        f" ({o.failed} of {o.valid + o.failed} samples failed)" if o.failed else "")


def diagnostic_text(o):
    """A figure that says how the evaluation went: its value, or the range that holds most of its values."""
    if constant(o):
        return constant_text(o)
    places = places_of(o)
    ends = " to ".join(fixed(point(o, x), places) for x in (o.symmetric_low, o.symmetric_high))
    return f"{o.name} {with_unit(ends, o.display_units)}"


def numbered(r):
    """Outputs like length_1, length_2, seen_1, seen_2 as one table, a row per number; None if there are none such."""
    found = {}
    for o in r.outputs:
        match = re.fullmatch(r"(.+)_(\d+)", o.name)
        if match:
            found.setdefault(match[1], {})[int(match[2])] = o
    numbers = sorted({k for stem in found.values() for k in stem})
    stems = {name: rows for name, rows in found.items() if sorted(rows) == numbers}
    if len(numbers) < 2 or len(stems) < 2:
        return None
    flags = r.model == "tool_length" and "seen" in stems  # an expression may call anything so
    def cell(o):
        u = o.standard_uncertainty
        if constant(o):
            return fixed(point(o, o.estimate), None), ""
        return fixed(point(o, o.estimate), places_of(o)), significant(spread(o, u))
    return types.SimpleNamespace(
        flags=flags, hidden=flags and any(o.symmetric_low < 1 for o in stems["seen"].values()),
        heads=[(name, unit_text(rows[numbers[0]].display_units), not all(map(constant, rows.values())))
               for name, rows in stems.items()],
        rows=[(k, [(*cell(rows[k]), not all(map(constant, rows.values()))) for rows in stems.values()]) for k in numbers])


def coefficient(b, c):
    """A sensitivity coefficient and its unit: the output's over the quantity's, "1" where both are the same."""
    return c.sensitivity * b.display_factor / c.display_factor, over(b.display_units, c.display_units)


def readable_coefficient(b, c):
    """The same as people write it: 12.3 and um/deg in place of 0.0123 and mm/deg."""
    value, unit = coefficient(b, c)
    if unit == "1":
        return value, unit
    fine, factor = finer(b.display_units, abs(value))
    return factor * value, over(fine, c.display_units)


def over(unit, divisor):
    """The quotient of two units, as units::quotient() of the engine writes it."""
    if divisor == unit:
        return "1"
    if divisor == "1":
        return unit
    return f"{unit}/({divisor})" if any(sign in divisor for sign in "/. *") else f"{unit}/{divisor}"


def share_text(b, c):
    """The share of a contribution by the law of propagation."""
    return "–" if cancels(b) else "0" if c.contribution == 0 and c.differentiable else percent(c.share)


def budget_row(b, c, factor):
    """`factor`: from the output's display unit to the unit of the contributions."""
    u = spread(c, c.standard_uncertainty)
    slope, slope_unit = readable_coefficient(b, c)
    return types.SimpleNamespace(
        name=c.name, unit=unit_text(c.display_units) or "1", estimate=fixed(point(c, c.estimate), decimals(u)) if math.isfinite(c.estimate) else "",
        u=significant(u) if math.isfinite(c.standard_uncertainty) else "none", evaluation=c.evaluation,
        distribution=c.distribution, dof=f"{c.degrees_of_freedom:.4g}" if math.isfinite(c.degrees_of_freedom) else "∞",
        differentiable=bool(c.differentiable),
        sensitivity=significant(slope, 3), sensitivity_unit=unit_text(slope_unit),
        contribution=significant(factor * spread(b, c.contribution)), share=share_text(b, c),
        width=max(0.0, min(100.0, 100 * c.share)) if math.isfinite(c.share) and not cancels(b) else 0,
        scope=c.scope, source=c.source)


def is_small(group, has_gum):
    """Whether a group of rows is one of those that a long budget sums up in one line."""
    if not has_gum:
        return group.first < FOLDED_INDEX
    return not group.resolved() >= FOLDED_BELOW and all(
        c.differentiable and math.isfinite(c.share) and c.share < FOLDED_BELOW for c in group.rows)


def folded(groups, has_gum):
    """The groups that the page sums up in one line: small ones of a long budget, and those that have no effect at all."""
    small = [g for g in groups if is_small(g, has_gum)]
    count = lambda some: sum(len(g.rows) for g in some)
    if count(groups) <= LONG:
        small = [g for g in small if has_gum and all(c.contribution == 0 for c in g.rows)]
    return small if count(small) > 3 else []


def group_rows(b, group, factor):
    """The rows of a group as text; the first one has the cell of the Monte Carlo column for all."""
    for k, c in enumerate(group.rows):
        row = budget_row(b, c, factor)
        row.span, row.quantity = (len(group.rows) if k == 0 else 0), c.quantity
        row.monte_carlo = resolved.index_text(group.first, group.index)
        yield row


def folded_share(groups, has_gum):
    if has_gum:
        total = sum(c.share for g in groups for c in g.rows)
        return percent(total) if total else "0"
    known = [g for g in groups if math.isfinite(g.first)]
    return resolved.stated(sum(g.first for g in known), math.hypot(*(resolved.half_width(g.index) for g in known if g.index)))


def second_order(b):
    """What terms of second order do, where it is much."""
    u = b.combined_standard_uncertainty
    if not u > 0 or not (abs(b.second_order_uncertainty / u - 1) > 0.05 or abs(b.second_order_bias) > 0.1 * u):
        return []
    size = lambda value: with_unit(significant(spread(b, value)), b.display_units)
    shift = f" and shift the mean by {size(b.second_order_bias)}" if b.second_order_bias else ""
    return [f"second-order terms change u_c to {size(b.second_order_uncertainty)}{shift}"]


def budget(b, u_monte_carlo=math.nan, sobol=None):
    """The budget of one output as text; `u_monte_carlo` in SI."""
    b = resolved.without_dust(b)
    ordered = budget_order.groups(budget_order.alike(b.rows), sobol)
    has_gum = any(math.isfinite(c.share) for c in b.rows) or not all(c.differentiable for c in b.rows) or b.applicable
    left_out = folded(ordered, has_gum)
    u = b.combined_standard_uncertainty
    dof = b.effective_degrees_of_freedom
    fine, factor = finer(b.display_units, spread(b, u) if u > 0 else abs(spread(b, u_monte_carlo)))
    alone = math.hypot(*(c.contribution for c in b.rows if math.isfinite(c.contribution)))
    without_shares = [f"the inputs are correlated, and their contributions of {significant(factor * spread(b, alone))}{after(fine)} cancel to "
                      f"u_c = {significant(factor * spread(b, u))}{after(fine)}, so that they are no shares of the variance"] if cancels(b) else []
    return types.SimpleNamespace(
        output=b.output, unit=unit_text(b.display_units), applicable=bool(b.applicable), reason=b.reason, cancels=cancels(b),
        rows=[row for g in ordered if g not in left_out for row in group_rows(b, g, factor)],
        folded=sum(len(g.rows) for g in left_out), folded_share=folded_share(left_out, has_gum),
        folded_below=percent(FOLDED_BELOW if has_gum else FOLDED_INDEX), has_gum=has_gum,
        has_monte_carlo=any(math.isfinite(g.first) for g in ordered), linear=not u == 0,
        drawn=resolved.has_contributions(b.rows),
        correlation="" if independent(b) else "they cancel" if cancels(b) else percent(b.correlation_share), fine_unit=unit_text(fine),
        interactions=resolved.interactions(b, sobol), u=significant(spread(b, u)),
        u_fine=significant(factor * spread(b, u)), u_monte_carlo=significant(factor * spread(b, u_monte_carlo)),
        dof="∞" if math.isinf(dof) else "not defined, inputs correlated" if math.isnan(dof) else fixed(dof, 0),
        k=fixed(b.coverage_factor, 2), U=significant(spread(b, b.expanded_uncertainty)),
        estimate=fixed(point(b, b.estimate), decimals(spread(b, u))),
        remarks=second_order(b) + without_shares + [text for text in (getattr(b, "remark", ""),) if text])


def validation_row(v):
    fine, factor = finer(v.display_units, spread(v, v.delta) or math.inf)
    size = lambda value: significant(factor * spread(v, value))
    return types.SimpleNamespace(name=v.name, verdict=v.verdict, reason=v.reason, digits=v.digits, delta=size(v.delta),
                                 d_low=size(v.d_low), d_high=size(v.d_high), tolerance=size(v.monte_carlo_tolerance),
                                 unit=unit_text(fine))


def comparison_row(c):
    u = c.standard_uncertainty if math.isfinite(c.standard_uncertainty) else c.expanded_uncertainty / 2
    places = decimals(spread(c, u))
    show = lambda value: fixed(spread(c, value), places)
    return types.SimpleNamespace(
        name=c.name, unit=unit_text(c.display_units), d=show(c.difference), u=show(c.standard_uncertainty),
        rss=show(c.root_sum_square), U=show(c.expanded_uncertainty), en=fixed(c.normalised_error, 2),
        consistent=abs(c.normalised_error) <= 1, judged=math.isfinite(c.normalised_error))


def printed_row(p):
    known = math.isfinite(p.expanded_uncertainty) and p.expanded_uncertainty > 0
    places = decimals(spread(p, p.expanded_uncertainty if known else abs(p.ours - p.printed)))
    show = lambda value: fixed(point(p, value), places)
    return types.SimpleNamespace(
        output=p.output, source=p.source, unit=unit_text(p.display_units), printed=f"{point(p, p.printed):.10g}"
        .replace("-", "−"), ours=show(p.ours), difference=fixed(spread(p, p.ours - p.printed), places),
        U=fixed(spread(p, p.expanded_uncertainty), places), known=known,
        within=abs(p.ours - p.printed) <= p.expanded_uncertainty)


def input_row(i):
    u = spread(i, i.standard_uncertainty)
    return types.SimpleNamespace(
        name=i.name, labels=i.labels, value=fixed(point(i, i.value), decimals(u)), unit=unit_text(i.display_units) or "1",
        u=("none" if not math.isfinite(u) else significant(u) if u > 0 else "exact"), distribution=i.distribution,
        evaluation=i.evaluation, scope=i.scope, source=i.source)


def readings(r):
    """Head and rows of the readings table."""
    names = [n for n in (vars(r.readings[0]) if r.readings else {}) if n not in ("label", "repeats")]
    shown = {n: conditions.scale(r, n) for n in names}
    heads = [f"{n} ({unit_text(shown[n].unit)})" if unit_text(shown[n].unit) else n for n in names]
    lines = [[shown[n].number(getattr(row, n)) for n in names] for row in r.readings]
    if not names and len(r.readings) < 2:  # nothing was read and nothing commanded
        return types.SimpleNamespace(heads=[], lines=[])
    return types.SimpleNamespace(heads=heads, lines=[(row.label, row.repeats, line)
                                                     for row, line in zip(r.readings, lines)])
