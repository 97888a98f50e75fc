"""The rows of a budget in their order: those of one quantity together where an index belongs to all of them."""
import math
import types

ALIKE = 4      # components of many readings that each have a row of their own
BEYOND = 0.01  # by which an index must exceed a share of the budget to count in its place


def alike(rows):
    """Components of one quantity that differ in nothing but the reading, as one row; few of them stay apart."""
    groups = {}
    for c in rows:
        groups.setdefault((c.quantity, c.standard_uncertainty, c.distribution, c.evaluation, c.source, c.scope,
                           c.name.rpartition(":")[2] if ":" in c.name else "", bool(c.differentiable)), []).append(c)
    for (quantity, *_, part, _), group in groups.items():
        if len(group) <= ALIKE:
            yield from group
            continue
        same = {c.sensitivity for c in group}
        known = lambda key: [v for v in (getattr(c, key) for c in group) if math.isfinite(v)]
        total = lambda key: sum(known(key)) if known(key) else math.nan
        yield types.SimpleNamespace(**{
            **vars(group[0]), "name": f"{quantity}{f':{part}' if part else ''}, {len(group)} alike", "estimate": math.nan,
            "sensitivity": same.pop() if len(same) == 1 else math.nan, "share": total("share"),
            "monte_carlo_share": total("monte_carlo_share"),
            "contribution": math.hypot(*known("contribution")) if known("contribution") else math.nan})


def finite(values):
    return [v for v in values if math.isfinite(v)]


class Group:
    """Rows that share a cell of the Monte Carlo column: one component, or all of a quantity with one index."""

    def __init__(self, rows, index):
        self.rows = sorted(rows, key=lambda c: -max(finite([c.share]) + [0.0]))
        self.index = index
        self.first = index.first if index else rows[0].monte_carlo_share
        self.share = sum(finite(c.share for c in rows)) if any(finite(c.share for c in rows)) else math.nan

    def resolved(self):
        """The part of the index that lies above the error of the samples."""
        return max(finite([self.index.first_low if self.index and hasattr(self.index, "first_low") else self.first]) + [0.0])

    def weight(self):
        """By which groups are ordered: the share of the budget, unless samples show more; the index where there is none."""
        contribution = math.hypot(*finite(c.contribution for c in self.rows))
        if math.isfinite(self.share):
            return self.resolved() if self.resolved() > self.share + BEYOND else self.share, contribution
        return max(finite([self.first]) + [0.0]), contribution


def groups(rows, sobol):
    """The groups of a budget, the largest first."""
    indices = {i.input: i for i in sobol.rows} if sobol else {}
    found = {}
    for c in rows:
        whole = c.name not in indices and c.quantity in indices and not math.isfinite(c.monte_carlo_share)
        found.setdefault(("quantity", c.quantity) if whole else ("row", c.name), []).append(c)
    made = [Group(members, indices.get(name)) for (_, name), members in found.items()]
    return sorted(made, key=lambda g: g.weight(), reverse=True)
