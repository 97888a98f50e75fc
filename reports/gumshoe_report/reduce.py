"""What would reduce an uncertainty most, from the shares of its budget."""
import math
import types

from .explain import APART
from .rounding import after, finer, percent, significant, unit_text
from .tables import spread

LISTED, WORTH = 5, 0.01  # rows; the least share of the variance that is worth an effort


def how(components):
    """What to do about a quantity, by how it was evaluated."""
    sources = list(dict.fromkeys(c.source for c in components if c.source))
    if components and all(c.evaluation == "A" for c in components):
        return "more observations: four times as many halve it"
    if len(sources) == 1 and sources[0].startswith("step "):
        return f"a finer resolution ({sources[0]})"
    return f"a better source than “{sources[0]}”" if len(sources) == 1 else "better sources, such as a calibration"


def linear(b, sobol):
    """True where the law of propagation divides the variance: it applies, and the indices, if known, do not differ."""
    if not b.applicable or not b.combined_standard_uncertainty > 0:
        return False
    shares = {c.name: c.share for c in b.rows}
    return sobol is None or all(i.total - i.first <= APART and abs(shares.get(i.input, i.first) - i.first) <= APART
                                for i in sobol.rows)


def shares(b, sobol):
    """(name, components, share of the variance) and whether the shares are the law's; otherwise first-order indices."""
    if linear(b, sobol):
        return [(c.name, [c], c.share) for c in b.rows if math.isfinite(c.share)], True
    of = lambda name: [c for c in b.rows if name in (c.name, c.quantity)]
    return [(i.input, of(i.input), i.first) for i in (sobol.rows if sobol else ()) if math.isfinite(i.first)], False


def table(b, u_monte_carlo, sobol=None, shapley=None):
    """Rows and a sentence; None where no shares are known."""
    if b is None:
        return None
    correlated = abs(b.correlation_share) > WORTH
    if not math.isfinite(b.correlation_share):  # no budget: Shapley effects in place of Sobol' indices are a sign of correlation
        correlated = shapley is not None and sobol is None
    if correlated:
        largest = max(shapley.rows, key=lambda i: i.effect if math.isfinite(i.effect) else 0) if shapley and shapley.rows else None
        return types.SimpleNamespace(rows=[], text="The inputs depend on each other: what one of them contributes cannot be "
                                     "taken out of u alone." + (f" The largest Shapley effect is that of {largest.input}, "
                                                                f"{percent(largest.effect)}." if largest else ""))
    everything, law = shares(b, sobol)
    u = b.combined_standard_uncertainty if law else u_monte_carlo
    parts = sorted((p for p in everything if p[2] >= WORTH), key=lambda p: -p[2])
    if not parts or not math.isfinite(u) or u <= 0:
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
        text=text + ".", unit=unit_text(unit), law=law,
        rows=[types.SimpleNamespace(name=name, share=percent(min(1.0, s)), half=show(0.75 * s) if law else "", exact=show(s),
                                    how=how(components)) for name, components, s in parts[:LISTED]],
        left=len(parts) - LISTED)
