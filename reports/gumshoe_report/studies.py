"""The tables of the studies as text for people: sensitivity, joint regions, conformity, targets, adaptive runs."""
import math
import types

from .rounding import after, decimals, degrees_of_freedom, finer, fixed, percent, probability, resolved, significant, unit_text
from .tables import point, spread

NONE = "–"
RULES = {"simple_acceptance": "simple acceptance", "iso_14253_1": "ISO 14253-1", "ilac_g8": "ILAC-G8", "stated": "the stated guard band"}
EXACT = 1e-8  # a probability without samples is stated to this


def index(row, key, places=3):
    """(value, interval) of one index as text."""
    value = getattr(row, key, math.nan)
    if not math.isfinite(value):
        return NONE, ""
    low, high = (fixed(getattr(row, key + end), places) for end in ("_low", "_high"))
    return fixed(value, places), f"[{low}, {high}]"


def in_words(*verdicts):
    """One word if all are equal, else each after its name."""
    said = [(name, word) for name, word in verdicts if word]
    return said[0][1] if said and len({word for _, word in said}) == 1 else "; ".join(f"{n}: {w}" for n, w in said)


def sobol_verdict(i):
    """Older files have one verdict for both."""
    return in_words(("first order", getattr(i, "first_verdict", getattr(i, "verdict", ""))),
                    ("total", getattr(i, "total_verdict", "")))


def pairs(sobol, most=10):
    ordered = sorted(sobol.pairs, key=lambda p: -(p.second if math.isfinite(p.second) else -1))
    return types.SimpleNamespace(rows=[types.SimpleNamespace(
        names=f"{p.a} × {p.b}", second=fixed(p.second, 3), interval=f"[{fixed(p.low, 3)}, {fixed(p.high, 3)}]",
        verdict=p.verdict) for p in ordered[:most]], left=max(0, len(ordered) - most))


def given_data(study, sobol):
    """Rank-based first order and delta, next to the pick-freeze first order if it exists."""
    frozen = {i.input: i for i in sobol.rows} if sobol else {}
    known = lambda r: [v for v in (getattr(r, "first", -1), getattr(r, "delta", -1), -1) if math.isfinite(v)]
    lines = sorted(study.rows, key=lambda r: -max(known(r)))
    return types.SimpleNamespace(
        samples=study.samples, has_first=any(hasattr(r, "first") for r in lines), has_frozen=bool(frozen),
        has_delta=any(hasattr(r, "delta") for r in lines),
        rows=[types.SimpleNamespace(input=r.input, first=index(r, "first"), delta=index(r, "delta"),
                                    frozen=index(frozen[r.input], "first") if r.input in frozen else (NONE, ""),
                                    verdict=in_words(("first order", getattr(r, "first_verdict", "")),
                                                     ("δ", getattr(r, "delta_verdict", ""))))
              for r in lines])


def shapley(study):
    lines = sorted(study.rows, key=lambda r: -r.effect)
    return types.SimpleNamespace(
        base_rows=study.base_rows, dropped=study.dropped_rows, total=percent(sum(r.effect for r in lines)),
        rows=[types.SimpleNamespace(input=r.input, effect=percent(r.effect), verdict=r.effect_verdict,
                                    interval=f"[{percent(r.effect_low)}, {percent(r.effect_high)}]") for r in lines])


def in_finer_unit(row, size):
    """Unit and a function from SI differences to text, for numbers of this size."""
    unit, factor = finer(row.display_units, abs(spread(row, size)) or math.inf)
    return unit_text(unit), lambda value: significant(factor * spread(row, value))


def morris(study):
    lines = sorted(study.rows, key=lambda r: -r.mean_absolute)
    unit, show = in_finer_unit(study, max((r.mean_absolute for r in lines), default=0))
    return types.SimpleNamespace(
        trajectories=study.trajectories, dropped=study.dropped, unit=unit,
        rows=[types.SimpleNamespace(input=r.input, star=show(r.mean_absolute), se=show(r.mean_absolute_se),
                                    mean=show(r.mean), sigma=show(r.standard_deviation)) for r in lines])


def dgsm(study, sobol):
    totals = {i.input: i.total for i in sobol.rows} if sobol else {}
    lines = sorted(study.rows, key=lambda r: -(r.bound if math.isfinite(r.bound) else -1))
    return types.SimpleNamespace(
        points=study.points, dropped=study.dropped, exact=bool(study.exact), has_total=bool(totals),
        rows=[types.SimpleNamespace(input=r.input, nu=significant(r.nu, 3), nu_se=significant(r.nu_se),
                                    bound=index(r, "bound"), total=fixed(totals.get(r.input, math.nan), 3),
                                    empty=r.bound >= 1) for r in lines])


def one_at_a_time(table):
    def change(o, value):
        return significant(spread(o, value), 3)
    shown = []
    for k, o in enumerate(table.outputs):
        largest = max((abs(v) for r in table.rows for v in (r.up[k], r.down[k]) if math.isfinite(v)), default=0)
        unit, factor = finer(o.display_units, abs(spread(o, largest)) or math.inf)
        shown.append((unit, factor * o.display_factor))
    return types.SimpleNamespace(
        title=table.title,
        outputs=[types.SimpleNamespace(name=o.name, unit=unit_text(u)) for o, (u, _) in zip(table.outputs, shown)],
        rows=[types.SimpleNamespace(quantity=r.quantity, step=significant(spread(r, r.step), 3),
                                    unit=unit_text(r.display_units),
                                    changes=[(significant(f * r.up[k], 3), significant(f * r.down[k], 3))
                                             for k, (_, f) in enumerate(shown)]) for r in table.rows])


def with_error(value, error):
    """A value and its Monte Carlo standard error, two digits of it, as a pair of texts."""
    places = decimals(error)
    return fixed(value, 3 if places is None else min(places, 5)), "" if places is None else fixed(error, min(places, 5))


def joint(region):
    names = [row.name for row in region.rows]
    u = [math.sqrt(row.covariance[k]) for k, row in enumerate(region.rows)]
    return types.SimpleNamespace(
        names=names, p=probability(region.coverage_probability), remark=region.remark,
        k_p=with_error(region.k_p, region.k_p_se), k_q=with_error(region.k_q, region.k_q_se),
        ellipsoid=math.isfinite(region.k_p), rectangle=math.isfinite(region.k_q),
        two=len(names) == 2,
        rows=[types.SimpleNamespace(name=row.name, unit=unit_text(row.display_units),
                                    estimate=fixed(point(row, row.estimate), decimals(spread(row, u[k]))),
                                    u=significant(spread(row, u[k])),
                                    side=significant(spread(row, region.k_q * u[k])),
                                    correlation=[fixed(c, 3) for c in row.correlation])
              for k, row in enumerate(region.rows)])


def fit(study, outputs):
    """The covariance that a least-squares fit gives by itself, next to u of Monte Carlo."""
    def size(row, value):
        return significant(spread(row, value)) if math.isfinite(value) else "undetermined" if value > 0 else NONE
    scaled = math.isfinite(study.scatter)
    tested = math.isfinite(study.chi_squared)
    unit, show = in_finer_unit(study, study.scatter) if scaled else ("", None)
    return types.SimpleNamespace(
        meaning=study.meaning, equations=study.equations, freedom=degrees_of_freedom(study.degrees_of_freedom),
        s=show(study.scatter) + (f"\u202f{unit}" if unit else "") if scaled else "",
        chi_squared=significant(study.chi_squared, 3) if tested else "",
        probability=chance(study.probability) if tested else "",
        advice="" if tested and study.probability >= 0.05 else
        "The readings scatter more than the scenario declares: an uncertainty is missing, or an effect." if tested else
        "It holds if every indication has an independent error of one size. Where u of Monte Carlo differs, the declared errors "
        "differ in size or act on many readings alike, or the readings scatter more, or less, than the scenario declares." if scaled else "",
        rows=[types.SimpleNamespace(name=row.name.removeprefix("error of "), unit=unit_text(row.display_units),
                                    u=size(row, row.standard_uncertainty),
                                    u_monte_carlo=size(row, outputs[row.name].standard_uncertainty)
                                    if row.name in outputs else NONE,
                                    correlation=[fixed(c, 2) for c in row.correlation]) for row in study.rows])


def circular(row, output):
    """Circular statistics next to the linear ones of the same output."""
    places = decimals(spread(row, row.standard_deviation))
    show = lambda value: fixed(point(row, value), places)
    return types.SimpleNamespace(
        name=row.name, unit=unit_text(row.display_units), mean=show(row.mean_direction),
        deviation=fixed(spread(row, row.standard_deviation), places), length=fixed(row.resultant_length, 3),
        arc=(show(row.low), show(row.high)), remark=row.remark, linear=None if output is None else
        types.SimpleNamespace(mean=show(output.estimate),
                              deviation=fixed(spread(output, output.standard_uncertainty), places),
                              shortest=(show(output.shortest_low), show(output.shortest_high))))


def chance(p, se=math.nan, least=0.0):
    """A probability with as many digits as its standard error allows; a bound where samples do not resolve it."""
    if not (math.isfinite(se) and se > 0) or not least <= p <= 1 - least:
        return resolved(p, least or EXACT)
    places = max(0, decimals(100 * se))
    if places > 9:
        return f"{fixed(100 * p, 9)}\u202f%"
    return f"({fixed(100 * p, places)} ± {fixed(100 * se, places)})\u202f%"


def places_of_test(c, output):
    """Decimal places of limits and estimate, by U and guard band as in the statement."""
    U = getattr(output, "expanded_uncertainty", math.nan)
    if not math.isfinite(U):
        U = (getattr(output, "symmetric_high", math.nan) - getattr(output, "symmetric_low", math.nan)) / 2
    known = [p for p in (decimals(spread(c, U) / 2), decimals(spread(c, abs(c.guard_band)))) if p is not None]
    return max(0, *known) if known else None


def conformity(c, output):
    places = places_of_test(c, output)
    least = getattr(c, "least_risk", 0.0)
    show = lambda value: fixed(point(c, value), places)
    at = lambda *keys: [show(getattr(c, k)) for k in keys]
    get = lambda key: getattr(c, key, math.nan)
    risks = []
    if math.isfinite(c.specific_consumer_risk):
        risks.append(("specific consumer’s risk", chance(c.specific_consumer_risk, c.conformance_probability_se, least),
                      "this item was accepted; the probability that it does not conform, 1 − p_c"))
    if math.isfinite(c.specific_producer_risk):
        risks.append(("specific producer’s risk", chance(c.specific_producer_risk, c.conformance_probability_se, least),
                      "this item was rejected; the probability that it conforms, p_c"))
    if math.isfinite(get("posterior_conformance")):
        risks.append(("p_c, with the process", chance(c.posterior_conformance, get("posterior_conformance_se"), least),
                      "conformance probability from this measurement and the process together"))
    if math.isfinite(c.process_conformance):
        risks.append(("process conformance", chance(c.process_conformance, least=1e-6),
                      f"share of the process that conforms, before measuring; mean {show(c.process_mean)}, "
                      f"standard deviation {fixed(spread(c, c.process_u), places)}{unit_after(c)}"))
    if math.isfinite(c.global_consumer_risk):
        risks.append(("global consumer’s risk R_C", chance(c.global_consumer_risk, get("global_consumer_risk_se"), least),
                      "the probability that an item of the process does not conform and is accepted by such a measurement"))
        risks.append(("global producer’s risk R_P", chance(c.global_producer_risk, get("global_producer_risk_se"), least),
                      "the probability that an item of the process conforms and is rejected by such a measurement"))
    return types.SimpleNamespace(
        name=c.name, rule=RULES.get(c.rule, ""), unit=unit_text(c.display_units), estimate=show(c.estimate), accepted=bool(c.accepted),
        tolerance=at("lower", "upper"), acceptance=at("acceptance_lower", "acceptance_upper"),
        guard=fixed(spread(c, c.guard_band), places), guarded=c.guard_band != 0, statement=c.statement,
        p_c=chance(c.conformance_probability, c.conformance_probability_se, least), risks=risks)


def unit_after(row):
    return after(row.display_units)


def stopping(s):
    rules = {"jcgm_101": "JCGM 101, clause 7.9", "stein": "two-stage rule (Stein)"}
    count = lambda n: f"{n:,}".replace(",", "\u202f") if n else "not reached"
    lines = []
    for r in s.rows:
        unit, show = in_finer_unit(r, r.tolerance)
        lines.append((r.name, show(r.tolerance) + (f"\u202f{unit}" if unit else "")))
    return types.SimpleNamespace(rule=rules.get(s.rule, s.rule), digits=s.digits, block=count(s.block),
                                 jcgm=count(s.jcgm_trials), stein=count(s.stein_trials), trials=count(s.trials),
                                 reached=bool(s.reached), statement=s.statement, tolerances=lines)
