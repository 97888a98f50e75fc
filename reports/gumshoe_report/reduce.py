"""What would reduce an uncertainty most, from the shares of its budget."""
import math
import types

from .explain import APART, drawn_uncertainty, heavier, independent, listed
from .rounding import after, finer, percent, significant, unit_text
from .tables import spread

LISTED, WORTH = 5, 0.01  # rows; the least share of the variance that is worth an effort
OF_THE_DATA = "stated for every indication"  # the program's own words for `u` of an indication


def how(components):
    """What to do about a quantity, by how it was evaluated."""
    sources = list(dict.fromkeys(c.source for c in components if c.source))
    if components and all(c.source == OF_THE_DATA for c in components):
        return "more indications in a reading: four times as many halve it"
    if components and all(c.evaluation == "A" for c in components):
        return "more observations: four times as many halve it at least"
    if len(sources) == 1 and sources[0].startswith("step "):
        return f"a finer resolution ({sources[0]})"
    return f"a better source than “{sources[0]}”" if len(sources) == 1 else "better sources, such as a calibration"


def drawn_shares(b):
    """The components with their shares by the law, where a t distribution contributes its variance."""
    total = (drawn_uncertainty(b) / b.combined_standard_uncertainty) ** 2
    return [(c, c.share * heavier(c) ** 2 / total) for c in b.rows if math.isfinite(c.share)]


def linear(b, sobol):
    """Whether the law of propagation divides the variance: it applies, and the indices, if known, do not differ."""
    if not b.applicable or not b.combined_standard_uncertainty > 0:
        return False
    shares = {c.name: share for c, share in drawn_shares(b)}
    return sobol is None or all(i.total - i.first <= APART and abs(shares.get(i.input, i.first) - i.first) <= APART
                                for i in sobol.rows)


def shares(b, indices, law):
    """(name, components, share of the variance), by the law or by first-order indices."""
    if law:
        return [(c.name, [c], share) for c, share in drawn_shares(b)]
    of = lambda name: [c for c in b.rows if name in (c.name, c.quantity)]
    return [(i.input, of(i.input), i.first) for i in (indices.rows if indices else ()) if math.isfinite(i.first)]


def sentence(text):
    return types.SimpleNamespace(rows=[], text=text)


def unknown(b, u_monte_carlo, shapley):
    """In place of the table, where the law does not account for the variance and no first-order indices are known."""
    unit, factor = finer(b.display_units, spread(b, u_monte_carlo))
    of = lambda u: significant(factor * spread(b, u)) + after(unit)
    text = (f"The shares of the budget do not say what would reduce u: they are of first order, by which u would be "
            f"{of(b.combined_standard_uncertainty)}; Monte Carlo gives {of(u_monte_carlo)}. ")
    known = sorted((i for i in shapley.rows if math.isfinite(i.effect)), key=lambda i: -i.effect) if shapley else []
    if known:
        return sentence(text + f"The largest Shapley effect is that of {known[0].input}, {percent(known[0].effect)}.")
    study = "sobol = 65536" if independent(b) else "shapley = 4096"
    return sentence(text + f"Set sensitivity = {{ {study} }} in [analysis] to obtain the share of each quantity.")


def without_u(b):
    """In place of the table, where no standard uncertainty exists that anything could reduce."""
    few = [c.name for c in b.rows if c.evaluation == "A" and c.distribution == "t" and c.degrees_of_freedom <= 2]
    return sentence("No standard uncertainty exists, so that no quantity has a share of it." + (
        f" More observations of {listed(few)} would give it one: a t distribution has a standard uncertainty only with more "
        "than 2 degrees of freedom." if few else ""))


def table(b, u_monte_carlo, sobol=None, shapley=None, given=None, accounted=True):
    """Rows and a sentence; None where no shares are known.

    `given`: first-order indices from the samples alone, which serve where there is no `sobol`. `accounted`: whether the
    law of propagation accounts for the variance by Monte Carlo (explain.law_accounts)."""
    if b is None:
        return None
    if not math.isfinite(u_monte_carlo):
        return without_u(b)
    correlated = not independent(b)
    if not math.isfinite(b.correlation_share):  # no budget: Shapley effects in place of Sobol' indices are a sign of correlation
        correlated = shapley is not None and sobol is None
    if correlated:
        largest = max(shapley.rows, key=lambda i: i.effect if math.isfinite(i.effect) else 0) if shapley and shapley.rows else None
        return sentence("The inputs depend on each other: what one of them contributes cannot be taken out of u alone."
                        + (f" The largest Shapley effect is that of {largest.input}, {percent(largest.effect)}."
                           if largest else ""))
    law = accounted and linear(b, sobol)
    everything = shares(b, sobol or given, law)
    if b.applicable and not accounted and not everything:
        return unknown(b, u_monte_carlo, shapley)
    u = drawn_uncertainty(b) if law else u_monte_carlo
    parts = sorted((p for p in everything if p[2] >= WORTH), key=lambda p: -p[2])
    if not parts or u <= 0:
        return None
    unit, factor = finer(b.display_units, spread(b, u))
    show = lambda share: significant(factor * spread(b, u * math.sqrt(max(0.0, 1 - share))))
    with_unit = lambda text: text + after(unit)
    first, _, share = parts[0]
    text = f"Most is to be gained from {first}, {percent(min(1.0, share))} of the variance"
    if law:
        text += f": half its uncertainty would bring u from {with_unit(show(0))} to {with_unit(show(0.75 * share))}"
    else:
        text += f": without it, u would fall from {with_unit(show(0))} to {with_unit(show(share))}"
    if len(everything) > 1:
        text += f"; without all the others it would fall to {with_unit(show(1 - share))}"
    return types.SimpleNamespace(
        text=text + ".", unit=unit_text(unit), law=law, few=law and any(heavier(c) > 1 for c in b.rows),
        rows=[types.SimpleNamespace(name=name, share=percent(min(1.0, s)), half=show(0.75 * s) if law else "", exact=show(s),
                                    how=how(components)) for name, components, s in parts[:LISTED]],
        left=len(parts) - LISTED)
