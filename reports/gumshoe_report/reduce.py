"""What would reduce an uncertainty most, from the shares of its budget."""
import math
import types

from . import resolved
from .explain import APART, drawn_uncertainty, heavier, independent, listed
from .rounding import after, finer, percent, significant, unit_text
from .tables import spread

LISTED, WORTH = 5, 0.01  # rows; the least share of the variance that is worth an effort
HALVED = 0.75  # of its share of the variance goes with half the uncertainty of a quantity
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


class Part:
    """A quantity with its share of the variance. `left`: the share that is left without it; if not `left_known`, an upper
    bound. `alone`, `alone_known`: the same where all the others are known instead. `stated`: the share as text."""

    def __init__(self, name, components, share, left, left_known=True, alone=None, alone_known=True, stated=None):
        self.name, self.components, self.share = name, components, share
        self.left, self.left_known = left, left_known
        self.stated = percent(min(1.0, share)) if stated is None else stated
        self.alone, self.alone_known = share if alone is None else alone, alone_known


def by_law(b):
    """What is left is added up, because 1 less a share near 1 is rounding; so is a share of the square of DUST."""
    parts = [(c, share if share > resolved.DUST ** 2 else 0.0) for c, share in drawn_shares(b)]
    return [Part(c.name, [c], share, sum(s for k, (_, s) in enumerate(parts) if k != n)) for n, (c, share) in enumerate(parts)]


def by_indices(b, indices):
    of = lambda name: [c for c in b.rows if name in (c.name, c.quantity)]
    rows = [i for i in indices.rows if math.isfinite(i.first)]
    for i in rows:
        left, known = resolved.rest(i.first, i, [j for j in indices.rows if j is not i])
        low, high = resolved.ends(i)
        yield Part(i.input, of(i.input), i.first, left, known, high if low <= 0 else i.first, not low <= 0,
                   resolved.index_text(min(1.0, i.first), i))


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
    indices = sobol or given
    everything = by_law(b) if law else list(by_indices(b, indices)) if indices else []
    if b.applicable and not accounted and not everything:
        return unknown(b, u_monte_carlo, shapley)
    u = drawn_uncertainty(b) if law else u_monte_carlo
    parts = sorted((p for p in everything if p.share >= WORTH), key=lambda p: -p.share)
    if not parts or u <= 0:
        return None
    return Advice(b, u, law, parts, len(everything)).made()


class Advice:
    """The table and its sentence. `parts`: the quantities that are worth an effort, the largest first, of `count`."""

    def __init__(self, b, u, law, parts, count):
        self.b, self.u, self.law, self.parts, self.count = b, u, law, parts, count
        self.unit, self.factor = finer(b.display_units, spread(b, u))
        self.digits = 2
        self.flat = law and self.show(1 - HALVED * parts[0].share) == self.show(1)
        self.digits += self.flat  # two digits would all be equal

    def show(self, left, known=True):
        """u where this share of its variance is left."""
        text = significant(self.factor * spread(self.b, self.u * math.sqrt(max(0.0, left))), self.digits)
        return text if known else resolved.BELOW + text

    def size(self, left, known=True):
        text = self.show(left) + after(self.unit)
        return text if known else f"less than {text}"

    def sentence(self):
        first, now = self.parts[0], self.size(1)
        if self.flat:
            return (f"No single quantity matters much: {first.name} has the largest share of the variance, {percent(first.share)}, "
                    f"and half its uncertainty would bring u from {now} to {self.size(1 - HALVED * first.share)}.")
        text = f"Most is to be gained from {first.name}, {first.stated} of the variance"
        text += (f": half its uncertainty would bring u from {now} to {self.size(1 - HALVED * first.share)}" if self.law else
                 f": without it, u would fall from {now} to {self.size(first.left, first.left_known)}")
        if self.count > 1 and self.show(first.alone) != self.show(1):
            text += f"; without all the others it would fall to {self.size(first.alone, first.alone_known)}"
        return text + "."

    def made(self):
        rows = [types.SimpleNamespace(name=p.name, share=p.stated, exact=self.show(p.left, p.left_known),
                                      half=self.show(1 - HALVED * p.share) if self.law else "", how=how(p.components))
                for p in self.parts[:LISTED]]
        return types.SimpleNamespace(
            text=self.sentence(), unit=unit_text(self.unit), law=self.law, rows=rows, left=self.count - len(rows),
            few=self.law and any(heavier(c) > 1 for c in self.b.rows))
