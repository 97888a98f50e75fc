"""Why budget and indices differ, in words made from the numbers by stated rules (reports/README.md)."""
import math

from .rounding import fixed, percent

APART = 0.05      # shares nearer than this say the same
NEGLIGIBLE = 0.01  # a share the reader would cross out


def first_orders(indices):
    """What a budget's share is compared with, by input: (share, total)."""
    if indices is None:
        return {}
    pairs = {i.input: (i.effect, i.effect) if hasattr(i, "effect") else (i.first, i.total) for i in indices.rows}
    return {name: pair for name, pair in pairs.items() if all(map(math.isfinite, pair))}


def independent(b):
    """Whether a budget has no share of correlations, but for rounding."""
    return not abs(b.correlation_share) > 1e-12


def law_accounts(b, output, verdict=""):
    """The framework is validated, or accounts_for_variance() of the engine: the variances by the law of propagation and
    by Monte Carlo differ by no more than APART and twice the Monte Carlo standard error."""
    u, law, se = output.standard_uncertainty, drawn_uncertainty(b), output.standard_uncertainty_se
    return verdict == "validated" or not math.isfinite(u) or (
        abs(u * u - law * law) <= APART * u * u + (4 * u * se if math.isfinite(se) else 0))


def cancels(b):
    """contributions_cancel() of the engine: contributions of correlated inputs are then no shares of the variance."""
    return b.correlation_share < -1


def drawn_uncertainty(b):
    """u_c, where a t distribution contributes its standard deviation and not its scale s/sqrt(n)."""
    wider = sum(c.share * (heavier(c) ** 2 - 1) for c in b.rows if math.isfinite(c.share))
    return b.combined_standard_uncertainty * math.sqrt(1 + wider)


def listed(names, most=4):
    names = list(names)
    if len(names) > most:
        names = names[:most] + [f"{len(names) - most} more"]
    return names[0] if len(names) == 1 else ", ".join(names[:-1]) + " and " + names[-1]


def heavier(c):
    """How much larger the standard deviation of a t distribution is than the s/sqrt(n) of the budget."""
    is_t = c.distribution == "t"
    return math.sqrt(c.degrees_of_freedom / (c.degrees_of_freedom - 2)) if is_t and c.degrees_of_freedom > 2 else 1.0


def reasons(budget, indices, shapley, left_out=""):
    """`left_out`: what failed samples have to do with it; "" if none failed."""
    found, told = [left_out] if left_out else [], set()
    known = first_orders(indices) or first_orders(shapley)
    rows = {c.name: c for c in budget.rows}
    kinks = [n for n, c in rows.items() if not c.differentiable and n in known]
    if kinks:
        found.append(f"the measurand has a kink at the estimate in {listed(kinks)}, where no sensitivity coefficient "
                     f"exists; the samples give {'it' if len(kinks) == 1 else 'them'} a total of "
                     f"{fixed(sum(known[n][1] for n in kinks), 2)}")
        told.update(kinks)
    flat = [n for n, c in rows.items() if n in known and n not in told and c.share < NEGLIGIBLE and known[n][1] > APART]
    if flat and indices is None and not independent(budget):
        found.append(f"{listed(flat)} {'has' if len(flat) == 1 else 'have'} next to no contribution of {'its' if len(flat) == 1 else 'their'} "
                     "own, but correlated inputs share their Shapley effects")
    elif flat:
        totals = listed(f"{n} (total {fixed(known[n][1], 2)})" for n in flat)
        zero = all(rows[n].sensitivity == 0 for n in flat)
        found.append(f"the slope c_i is {'zero' if zero else 'next to zero'} at the estimate, so the budget does not "
                     f"see {totals}, but the output is not linear in " + ("it" if len(flat) == 1 else "them"))
        told.update(flat)
    if indices is not None:
        acting = [i.input for i in indices.rows if i.total - i.first > APART]
        if len(acting) > 1:
            found.append(f"{listed(acting)} act together: their totals exceed their first-order indices, and a budget "
                         "has no row for interactions")
    tails = [f"{n} (ν = {c.degrees_of_freedom:.3g}, by {fixed(heavier(c), 2)})" for n, c in rows.items()
             if heavier(c) > 1.05 and c.share > NEGLIGIBLE]
    if tails:
        found.append(f"the t distribution that is drawn is wider than the s/√n of the budget for {listed(tails)}")
    if math.isfinite(budget.correlation_share) and abs(budget.correlation_share) > NEGLIGIBLE:
        found.append("inputs are correlated, and their contributions cancel" if cancels(budget) else
                     f"inputs are correlated: the budget puts {percent(budget.correlation_share)} into one row, "
                     + ("the Shapley effects divide it among the inputs" if shapley is not None else
                        "which belongs to no single quantity"))
    return found


def why(budget, indices, shapley, u_monte_carlo, left_out=""):
    """One sentence on budget and indices; "" where there is nothing to compare. u_monte_carlo in SI; `left_out`: as in reasons()."""
    known = first_orders(indices) or first_orders(shapley)
    rows = [c for c in budget.rows if c.name in known] if budget else []
    shares = budget is not None and (budget.applicable or any(math.isfinite(c.share) or not c.differentiable for c in rows))
    if not rows or not shares:
        return ""
    if not math.isfinite(u_monte_carlo):
        return "No standard uncertainty exists, and so no variance that the indices could divide: they do not settle, whatever they show."
    apart = {c.name: abs((c.share if math.isfinite(c.share) else 0.0) - known[c.name][0]) for c in rows}
    worst = max(apart, key=apart.get)
    hidden = max((known[c.name][1] - known[c.name][0] for c in rows), default=0)
    u = budget.combined_standard_uncertainty
    ratio = u_monte_carlo / u if u > 0 and math.isfinite(u_monte_carlo) else math.nan
    what = "Shapley effects" if indices is None else "indices"
    size = f" The Monte Carlo standard uncertainty is {fixed(ratio, 2)} times u_c." \
        if math.isfinite(ratio) and abs(ratio - 1) > APART else ""
    if budget.applicable and apart[worst] <= APART and hidden <= APART:
        because = f" The reason: {left_out}." if size and left_out else ""
        return f"Budget and {what} agree: no share differs by more than {fixed(max(apart[worst], 0.001), 3)}." + size + because
    found = reasons(budget, indices, shapley, left_out) or ["the model is not linear over the range of its inputs"]
    most = "" if cancels(budget) else f" most for {worst} ({fixed(apart[worst], 2)}),"
    return f"Budget and {what} differ,{most} because " + "; ".join(found) + "." + size
