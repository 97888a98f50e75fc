"""The budgets of a trace, as declared and with what was found, side by side."""
import math
import types

from .resolved import without_dust
from .rounding import decimals, finer, fixed, significant, unit_text
from .tables import budget_row, point, spread, with_unit

# What becomes of the uncertainty, by the kind of finding.
OUTCOMES = {"scatter": "The scatter that was found is now part of the uncertainty.",
            "correction": "A larger uncertainty is not a step back: an unknown error has become a correction with a known uncertainty."}


def outcome(findings):
    """What the second budget contains that the first one does not, in sentences."""
    kinds = {"scatter" if f.kind == "scatter" else "correction" for f in findings}
    return " ".join(text for kind, text in OUTCOMES.items() if kind in kinds)


def size(c):
    return abs(c.contribution) if math.isfinite(c.contribution) else 0


def places(b):
    """Decimal places of an estimate: by U, else by u_c, else by the contributions that are known."""
    known = math.hypot(*map(size, b.rows))
    u = next((x for x in (b.expanded_uncertainty, b.combined_standard_uncertainty, known) if math.isfinite(x) and x > 0), math.nan)
    return decimals(spread(b, u))


def expanded(b):
    U = spread(b, b.expanded_uncertainty)
    return f"U = {with_unit(significant(U), b.display_units)}" if math.isfinite(U) else "no U"


def pair(before, after):
    """Both budgets of one output, component by component."""
    both = [without_dust(b) for b in (before, after)]
    u = [spread(b, b.combined_standard_uncertainty) for b in both]
    fine, factor = finer(before.display_units, max(u))
    sides = [{c.name: budget_row(b, c, factor) for c in b.rows} for b in both]
    largest = {}
    for c in (c for b in both for c in b.rows):
        largest[c.name] = max(largest.get(c.name, 0), size(c))
    return types.SimpleNamespace(
        output=before.output, fine=unit_text(fine), rows=[(name, sides[0].get(name), sides[1].get(name))
                                                          for name in sorted(largest, key=lambda n: (-largest[n], n))],
        u=[significant(factor * x) for x in u], reasons=[b.reason for b in both],
        results=[f"{with_unit(fixed(point(b, b.estimate), places(b)), b.display_units)}, {expanded(b)}" for b in both])


def budgets(t, standing):
    """Of each output; none where nothing was found that could have changed them."""
    after = {b.output: b for b in t.after}
    return [pair(b, after[b.output]) for b in t.before if b.output in after] if standing else []
