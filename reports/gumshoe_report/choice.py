"""What `gumshoe choose` found, as text for people: what to set, how sure, why, and compared with what."""
import math
import types

from .rounding import after, decimals, fixed, percent, probability, significant, unit_text
from .tables import point, spread

SPACE = "\u202f"
LISTED = 40  # rows of the front and of failing candidates on the page
NOT_CONFIRMED = "not confirmed by fresh samples"
MOST = 400   # rows of all candidates; the CSV table has all


def with_unit(text, unit):
    return text + after(unit)


def plain_number(x):
    """A setting as one keys it in: four digits, never an exponent where there is room."""
    if not math.isfinite(x):
        return "–"
    return (f"{x:.4g}" if 1e-4 <= abs(x) < 1e4 or x == 0 else f"{x:.6g}").replace("-", "−")


def duration(seconds):
    if not math.isfinite(seconds):
        return "–"
    if seconds < 100:
        return f"{significant(seconds, 3) if seconds < 1 else fixed(seconds, 1)}{SPACE}s"
    whole = round(seconds)
    if whole < 3600:
        return f"{whole // 60}{SPACE}min {whole % 60}{SPACE}s"
    return f"{whole // 3600}{SPACE}h {whole % 3600 // 60}{SPACE}min"


def chance(p):
    """Without a false certainty: 1 is never reached by samples."""
    if not math.isfinite(p):
        return "–"
    if p > 0.999 or p < 0.001:
        return f"more than 99.9{SPACE}%" if p > 0.5 else f"less than 0.1{SPACE}%"
    return fixed(100 * p, 1 if p > 0.99 or p < 0.01 else 0) + SPACE + "%"


def joined(parts):
    return parts[0] if len(parts) == 1 else ", ".join(parts[:-1]) + " and " + parts[-1]


def axis_label(name, units):
    return name.replace("_", " ") + (f", {unit_text(units)}" if unit_text(units) else "")


def refuted(row):
    """Whether a candidate met the target in the search and not with fresh samples; older files do not say so."""
    return bool(getattr(row, "refuted", 0))


class Choice:
    """The group `choice` with its units: `show` makes text of it."""

    def __init__(self, c, coverage_probability):
        self.c, self.p = c, coverage_probability
        self.best = c.candidates[int(c.best)]
        self.fresh, self.compared = c.fresh[0], c.fresh[1:]
        self.places = self.digits(self.fresh.asked)
        self.unit = unit_text(c.display_units)
        self.corrected = c.definition == "corrected"
        self.worst, self.bounded = c.target_of == "worst_case", math.isfinite(c.bias_limit)
        self.refuted = sum(map(refuted, c.candidates))
        self.chooses_evaluation = any(v.kind == "evaluation" for v in c.variables)

    def digits(self, U):
        """Decimal places for two digits of U, for three near the target: otherwise 2.96 and 3.04 would both be 3.0."""
        close = math.isfinite(U) and abs(U / self.c.target - 1) < 0.05
        return decimals(spread(self.c, U), 3 if close else 2)

    def length(self, si, size=None):
        """A difference in the measurand's unit, to the place that U (or `size`) asks for."""
        if not math.isfinite(si):
            return "no value"
        places = self.digits(size) if size is not None else self.places
        return with_unit(fixed(spread(self.c, si), places), self.c.display_units)

    def target(self):
        return with_unit(plain_number(spread(self.c, self.c.target)), self.c.display_units)

    def value(self, v, x):
        """One variable's value as text with its unit."""
        if v.kind == "evaluation":
            return f"“{self.c.evaluations[int(x)]}”"
        return with_unit(plain_number(point(v, x)), v.display_units)

    def case(self, row):
        return self.c.cases[int(row.worst)].name if self.c.cases else ""

    def valueless(self):
        """Cases in which the recommended setting has no U."""
        return [case.name for k, case in enumerate(self.c.cases) if not math.isfinite(self.fresh.case_expanded[k])]

    def order(self):
        """What to do, in an imperative sentence."""
        known = list(zip(self.c.variables, self.best.values))
        parts = [f"{v.name.replace('_', ' ')} to {self.value(v, x)}" for v, x in known
                 if v.kind in ("condition", "quantity")]
        acts = ["set " + joined(parts)] if parts else []
        for v, x in known:
            if v.kind == "readings":
                acts.append(f"take {int(x)} reading" + ("s" if x != 1 else ""))
            elif v.kind == "evaluation":
                acts.append(f"evaluate by {self.value(v, x)}")
        return joined(acts)

    def recommendation(self):
        c, f = self.c, self.fresh
        worst = f" in the worst case, “{self.case(f)}”" if self.worst else ""
        result = (f"measuring {c.measurand} takes {duration(f.time)} and gives U = {self.length(f.asked)} "
                  f"({probability(self.p)}){worst}")
        bias = f" and a bias of at most {self.limit()}" if self.bounded else ""
        if not c.reached and c.probability >= c.confirm_probability:
            return (f"In the search no setting met the target U = {self.target()}{bias}. With fresh samples the nearest one "
                    f"does, with a probability of {chance(c.probability)}: {self.order()}; {result}.")
        if not c.reached:
            return (f"No setting that was tried meets the target U = {self.target()}{bias}. The nearest is: "
                    f"{self.order()}; {result}.")
        order = self.order()
        text = f"{order[0].upper()}{order[1:]}: {result}"
        sure = f"{chance(c.probability)}"
        if not c.confirmed:
            return (f"{text}; it meets the target of {self.target()}{bias} with a probability of only {sure}, where "
                    f"{chance(c.confirm_probability)} was asked for.")
        return f"{text}, which meets the target of {self.target()}{bias} with a probability of {sure}."

    def limit(self):
        return with_unit(plain_number(spread(self.c, self.c.bias_limit)), self.c.display_units)

    def correction(self):
        if not self.corrected:
            return (f"No correction is applied; the mean error of {self.length(self.fresh.mean)} is part of U.")
        size = fixed(spread(self.c, abs(self.fresh.mean)), self.places)
        if float(size) == 0:
            return "The mean error is so small that there is nothing to correct."
        verb, end = ("add", "to") if self.fresh.mean < 0 else ("subtract", "from")
        return (f"This U holds after a correction: {verb} {with_unit(size, self.c.display_units)} {end} every result, "
                f"whose mean error is {self.length(self.fresh.mean)}.")

    def unconfirmed(self):
        """What became of candidates that met the target in the search only, in words."""
        count = self.refuted
        if not count:
            return ""
        met = "1 candidate" if count == 1 else f"{count} candidates"
        run = self.c.tried - bool(self.c.confirmed)
        return (f"In the search {met} met the target without being confirmed by fresh samples. "
                f"{'It' if count == 1 else f'{run} of them'} {'was' if run == 1 else 'were'} run with fresh samples and missed "
                "the required probability" +
                ("." if run == count else "; each of the others has a U at least as large as one of these."))

    def refused(self, row):
        """Why a candidate does not meet the target; "" if it does."""
        c = self.c
        if row.meets:
            return NOT_CONFIRMED if refuted(row) else ""
        if not row.valid:
            return "all samples failed"
        if row.asked > c.target:
            return "U above the target"
        if abs(row.mean) > c.bias_limit:
            return "bias above its limit"
        return "too many samples failed" if row.failed else "bias above its limit in a case"

    def line(self, row, setting=None):
        """Time, U and what goes with it, of a candidate or of a fresh run."""
        c = self.c
        places = self.digits(row.asked)
        show = lambda x: fixed(spread(c, x), places)
        return types.SimpleNamespace(
            setting=setting, time=duration(row.time), U=show(row.asked),
            U_se=significant(spread(c, row.asked_se), 1), average=show(row.expanded), mean=show(row.mean),
            meets=not self.refused(row), refused=self.refused(row),
            failed=f"{row.failed} of {row.valid + row.failed}" if row.failed else "",
            cases=[(show(u), show(left)) for u, left in zip(row.case_expanded, row.case_left)] if c.cases else [])

    def values(self, row):
        return [self.c.evaluations[int(x)] if v.kind == "evaluation" else plain_number(point(v, x))
                for v, x in zip(self.c.variables, row.values)]

    def fixed(self, positions):
        """Some variables as recommended, in words."""
        chosen = [(self.c.variables[k], self.best.values[k]) for k in positions]
        return joined([f"{v.name.replace('_', ' ')} {self.value(v, x)}" for v, x in chosen]) if chosen else ""

    def heads(self):
        return [(v.name, unit_text(v.display_units)) for v in self.c.variables]

    def gains(self):
        """The settings compared with the recommended one, in words."""
        def times(ratio):
            return (f"{significant(ratio, 3)} times as long" if ratio > 1.005 else "as long" if ratio > 0.995 else
                    f"only {significant(ratio, 2)} times as long")
        return [f"“{r.name}” ({r.setting}) takes {duration(r.time)}, {times(r.time / self.fresh.time)}, with "
                f"U = {self.length(r.asked, r.asked)}" + ("" if r.meets else ", which misses the target")
                for r in self.compared]

    def neighbours(self):
        c = self.c
        sign = lambda ratio: "±0" if abs(ratio - 1) < 5e-4 else ("+" if ratio > 1 else "") + percent(ratio - 1)
        found = []
        for n in c.neighbours:
            v, row = c.variables[int(n.variable)], c.candidates[int(n.candidate)]
            found.append(types.SimpleNamespace(
                name=v.name, value=self.value(v, row.values[int(n.variable)]),
                now=self.value(v, self.best.values[int(n.variable)]), time=sign(n.time_ratio),
                U=sign(n.expanded_ratio) if math.isfinite(n.expanded_ratio) else "–", near=bool(n.near),
                refused=self.refused(row)))
        return found

    def noise(self):
        """Standard error of a U of the search, as a share."""
        return percent(self.best.asked_se / self.best.asked) if self.best.asked > 0 else "–"

    def flatness(self):
        """How much room there is, in words."""
        c = self.c
        if not c.near_count:
            return ""
        spans = []
        for v in c.variables:
            if v.kind == "evaluation":
                continue
            low, high = self.value(v, v.near_low), self.value(v, v.near_high)
            spans.append(f"{v.name.replace('_', ' ')} {low}" if low == high else
                         f"{v.name.replace('_', ' ')} from {low} to {high}")
        many = "1 candidate meets" if c.near_count == 1 else f"{c.near_count} candidates meet"
        return (f"{many} the target within {significant(100 * c.near_share, 2)}{SPACE}% of the recommended time" +
                (f": {joined(spans)}." if spans else "."))

    def resolutions(self):
        """The last steps of the ranges, in words."""
        found = []
        for v in self.c.variables:
            if v.range and v.resolution > 0:
                values = sorted({r.values[self.c.variables.index(v)] for r in self.c.candidates})
                if v.logarithmic:
                    step = percent((values[-1] / values[0]) ** v.resolution - 1)
                elif v.kind == "readings":
                    step = plain_number(max(1, round(v.resolution * (values[-1] - values[0]))))
                else:
                    step = with_unit(significant(v.resolution * spread(v, values[-1] - values[0]), 2), v.display_units)
                found.append(f"{step} in {v.name.replace('_', ' ')}")
        return joined(found) if found else ""

    def limits(self):
        """The inputs that the error's variance at this setting comes from, the largest first, in words."""
        study = next(iter(self.c.sensitivities or self.c.shapley), None)
        if study is None:
            return ""
        key = "total" if self.c.sensitivities else "effect"
        groups = {}  # readings of one quantity together
        for r in study.rows:
            if getattr(r, key) > 0:
                name = r.input.split("[")[0] if "[reading" in r.input else r.input
                groups.setdefault(name, []).append(getattr(r, key))
        largest = sorted(((sum(g), name, len(g)) for name, g in groups.items()), reverse=True)
        named = [f"{name} ({f'{n} readings, ' if n > 1 else ''}{'at most ' if n > 1 and key == 'total' else ''}"
                 f"{percent(min(share, 1))})" for share, name, n in largest[:3] if share >= 0.05]
        if not named:
            return ""
        return (f"The largest shares of the remaining variance{', interactions included' if key == 'total' else ''}: "
                f"{joined(named)}.")

    def front(self):
        rows = sorted((r for r in self.c.candidates if r.pareto), key=lambda r: r.time)
        step = max(1, math.ceil(len(rows) / LISTED))
        return [r for k, r in enumerate(rows) if k % step == 0 or k == len(rows) - 1 or r is self.best]
