"""What would reach the target of one output, as text for people."""
import math
import types

from .rounding import after, significant, unit_text
from .tables import spread

FEW = 3  # different uncertainties of one quantity that are listed; of more, the smallest and the largest


def size(t, value):
    return significant(spread(t, value)) + after(t.display_units) if math.isfinite(value) else "–"


class Row:
    """One quantity. The file has the root sum square of its draws, such as one for each set-up; what a scenario states and
    people change is the standard uncertainty of one draw. All draws of a quantity are scaled together."""

    def __init__(self, r, budget):
        self.r = r
        draws = [c.standard_uncertainty for c in budget.rows if c.quantity == r.quantity] if budget else []
        known = math.isclose(math.hypot(*draws), r.present, rel_tol=1e-6) if draws else False
        self.draws = draws if known else [r.present]

    def scaled(self, value):
        """The uncertainties of the draws where their root sum square is `value`."""
        if value == math.inf:
            return "any"
        if not math.isfinite(value):
            return "none"
        factor = value / self.r.present if self.r.present > 0 else 1
        sizes = list(dict.fromkeys(significant(spread(self.r, factor * u)) for u in sorted(self.draws)))
        return " and ".join(sizes) if len(sizes) <= FEW else f"{sizes[0]} to {sizes[-1]}"

    def shown(self):
        r = self.r
        return types.SimpleNamespace(
            quantity=r.quantity, unit=unit_text(r.display_units) or "1", present=self.scaled(r.present), draws=len(self.draws),
            allowed=self.scaled(r.allowed), gum=self.scaled(r.allowed_gum), cost=significant(r.cost, 3),
            cheapest=self.scaled(r.cheapest) if math.isfinite(r.cheapest) else "–")

    def improved(self):
        """Its part of the cheapest combination, in words."""
        return f"{self.r.quantity} {self.scaled(self.r.cheapest)}{after(self.r.display_units)} ({self.scaled(self.r.present)} now)"


def sentence(t):
    alone = [r.quantity for r in t.rows if r.allowed == r.allowed and r.allowed < r.present]
    if not math.isfinite(t.present):
        text = f"Wanted: U = {size(t, t.wanted)}."
    elif t.present <= t.wanted:
        text = (f"The target is already met: U = {size(t, t.present)} does not exceed {size(t, t.wanted)}. The allowed values show "
                "how far each quantity may grow.")
    elif alone:
        text = (f"U = {size(t, t.present)} must be reduced to {size(t, t.wanted)}; improving a single quantity is enough: "
                f"{', '.join(alone)}.")
    else:
        text = f"U = {size(t, t.present)} must be reduced to {size(t, t.wanted)}; improving a single quantity is not enough."
    if math.isfinite(t.reached):
        text += f" The cheapest combination reaches {size(t, t.reached)} at {significant(t.cost_ratio, 3)} times the present cost."
    return text


def target(t, budget=None):
    """`budget`: of the same output, if it has one."""
    rows = [Row(r, budget) for r in t.rows]
    lines = [row.shown() for row in rows]
    has_gum = any(not math.isnan(r.allowed_gum) for r in t.rows) or budget is None or bool(budget.applicable)
    stated = [x for line in lines for x in (line.allowed, *([line.gum] if has_gum else []))]
    return types.SimpleNamespace(
        output=t.output, text=sentence(t), statement=t.statement, rows=lines, has_gum=has_gum, none="none" in stated,
        any="any" in stated, several=any(line.draws > 1 for line in lines), has_cost=any(math.isfinite(r.cost) for r in t.rows),
        cheapest=", ".join(row.improved() for row in rows if math.isfinite(row.r.cheapest) and row.r.cheapest < row.r.present))
