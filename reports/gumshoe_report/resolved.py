"""What the samples resolve of the indices next to a budget, and what of a budget is more than numerical noise."""
import math
import types

from .rounding import percent

DUST = 1e-12         # of the largest contribution: less is the rounding of double precision
LEAST_REST = 1e-6    # of the variance: what is left of it by 1 - S1 is not stated more finely
BELOW = "<\u202f"


def without_dust(b):
    """The budget with contributions of zero where rounding has left something else."""
    if not b.rows:
        return b
    largest = max((c.contribution for c in b.rows if math.isfinite(c.contribution)), default=0)
    none = {"contribution": 0.0, "sensitivity": 0.0, "share": 0.0}
    rows = [types.SimpleNamespace(**{**vars(c), **(none if c.contribution < DUST * largest else {})}) for c in b.rows]
    bias = b.second_order_bias if abs(b.second_order_bias) > DUST * b.combined_standard_uncertainty else 0.0
    return types.SimpleNamespace(**{**vars(b), "rows": rows, "second_order_bias": bias})


def has_contributions(rows):
    """Whether a budget has bars to draw."""
    return any(c.differentiable and 0 < c.contribution < math.inf for c in rows)


def ends(i, key="first"):
    return getattr(i, key + "_low", math.nan), getattr(i, key + "_high", math.nan)


def half_width(i):
    low, high = ends(i)
    return (high - low) / 2 if math.isfinite(high - low) else 0.0


def bound(share):
    """"< 2.1 %" """
    return percent(share) if share < 5e-4 and share > 0 else BELOW + (percent(share) if share > 0 else percent(1e-3))


def stated(share, half):
    """A share that the samples give to ± half; a bound where zero lies within."""
    return percent(share) if share > half else bound(share + half)


def index_text(share, index):
    """A first-order index in a budget; `index` None where no interval is known."""
    if index is None or not all(map(math.isfinite, ends(index))):
        return percent(share)
    low, high = ends(index)
    return percent(share) if low > 0 else bound(high)


def interactions(b, sobol):
    """1 less the sum of all first-order indices as text: no result where it lies within the errors of these, or where no
    total index exceeds its first order."""
    found = b.monte_carlo_interactions
    if sobol is None or not math.isfinite(found):
        return percent(found)
    half = math.hypot(*(half_width(i) for i in sobol.rows))
    acting = any(ends(i, "total")[0] > ends(i)[1] for i in sobol.rows)
    return percent(found) if found > half and acting else "not resolved"


def rest(share, i, others):
    """(share of the variance that is left once a quantity is known, whether the samples resolve it). Where they do not,
    the share is an upper bound: by the interval of its first-order index, or by the totals of all others."""
    low, high = ends(i)
    left = 1 - share
    if not math.isfinite(high):
        return max(left, LEAST_REST), left > LEAST_REST
    if high < 1 and left > LEAST_REST:
        return left, True
    totals = [ends(j, "total")[1] for j in others]
    known = [1 - low, *([sum(totals)] if all(map(math.isfinite, totals)) else [])]
    return min(1.0, max(min(known), LEAST_REST)), False
