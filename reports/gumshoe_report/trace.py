"""What `gumshoe trace` found, as text for people: what it is, how sure, what is left, and what was refused."""
import math
import re
import types

from . import compensation, names
from .choice import SPACE, joined, with_unit
from .rounding import decimals, finer, fixed, of_all, percent, significant, unit_text
from .tables import point, spread

LISTED = 12  # candidates and detection limits on the page; the CSV tables have all
FAMILIES = {"effect": "effect", "declared": "declared quantity", "stated": "stated in the scenario",
            "shape": "generic shape", "omnibus": "omnibus test", "scatter": "scatter"}
CHOSEN = ("named", "in the class", "describes", "explains")  # how the outcome of a candidate that was chosen begins
AS_WELL = " fits better, as chance could have it"  # how the remark on a shape ends to which a known effect was preferred
LEAST = 0.001  # the smallest probability that is printed: tails of an approximation are known no better


def in_words(name):
    """What was found, as a headline says it; names of effects that may be it are divided by " | "."""
    if " | " in name:
        return " or ".join(map(in_words, name.split(" | ")))
    family, _, rest = name.partition(":")
    return f"{names.of_quantity(rest)} is not what was declared" if family == "declared" and rest else names.readable(name)


def suited(unit, size):
    """Unit and factor in which a size has one to three digits before the point; lengths from nm to mm."""
    unit, factor = finer(unit, size)
    if unit == "um" and 0 < size * factor < 0.1:
        return "nm", 1e3 * factor
    if unit == "um" and size * factor >= 1000:
        return "mm", 1e-3 * factor
    return unit, factor


def of_limit(row):
    """Unit and factor of a detection limit: lengths of um and mm alike, so that equal limits read alike."""
    value = abs(spread(row, row.value))
    unit, factor = ("mm", 1e-3) if row.display_units == "um" else (row.display_units, 1.0)
    finest, further = suited(unit, factor * value)
    return finest, factor * further


def shown_unit(row, size):
    """A unit in which a difference of this size (SI) has digits before the point, and its factor from SI."""
    unit, factor = suited(row.display_units, abs(spread(row, size)))
    return unit, factor * row.display_factor


def capitalised(text):
    return text[:1].upper() + text[1:]


UNDECIDED = "the held-out readings neither confirm nor reject it"
UNKNOWN = "an unknown effect"


def counted(names):
    """Unknown effects together: "3 unknown effects"."""
    n = names.count(UNKNOWN)
    if n < 2:
        return names
    first = names.index(UNKNOWN)
    return [*names[:first], f"{n} unknown effects", *(x for x in names[first:] if x != UNKNOWN)]


def known_correlation(c):
    """Correlation with the best candidate; "" where none is stored, because that one has no signature or is far better."""
    return fixed(c.correlation, 2) if c.correlation else ""


class Trace:
    """The group `trace` with its units."""

    def __init__(self, t):
        self.t = t
        sizes = [x for x in (t.rms.noise, t.rms.after, t.rms.before) if math.isfinite(x) and x > 0]
        self.known = math.isfinite(t.rms.before)
        self.unit, self.factor = shown_unit(t.rms, max(sizes, default=0))
        self.places = decimals(self.factor * (sizes[0] if sizes else math.nan))
        # A name may hold spaces and brackets: those of what was tried are known.
        tried = {c.name for c in t.candidates} | {m for f in t.findings for m in f.members}
        known = [re.escape(name) for name in sorted(tried, key=len, reverse=True) if ":" in name]
        self.names = re.compile("|".join([*known, r"\b(?:table|omnibus|product|harmonic|hysteresis|polynomial|drift|lag|wave):[\w*^/]+"]))
        # A shape that the hold-out blocks rejected is reported and not added; scatter outlives their veto.
        self.rejected = [f for f in t.findings if self.is_rejected(f)]
        self.standing = [f for f in t.findings if not self.is_rejected(f)]
        self.found = bool(self.standing)
        self.added = any(r.after != r.before for r in t.residuals if math.isfinite(r.before))
        self.apart = any(r.final for r in t.residuals)

    shown_unit = staticmethod(shown_unit)

    def warns(self):
        """Whether the card needs attention: neither found nor found to be sound."""
        return not self.found and (self.t.verdict != "nothing_found" or bool(self.t.vetoed) or self.exceeds())

    def is_rejected(self, f):
        return bool(self.t.vetoed) and f.kind == "not_in_catalogue"

    def in_remark(self, text):
        """Candidates by their readable names."""
        return self.names.sub(lambda m: names.readable(m[0]), text)

    def statements(self):
        return [self.in_remark(text) for text in self.t.statements]

    def plain(self):
        """What it means, in one paragraph."""
        return self.in_remark(" ".join(self.t.plain))

    def number(self, si):
        """A residual's size, to the place that the noise asks for, but to three digits at most."""
        x = self.factor * si
        if not math.isfinite(x):
            return "–"
        limit = decimals(abs(x), 3)
        return fixed(x, self.places if limit is None or self.places is None else min(self.places, max(limit, 0)))

    def size(self, si):
        return with_unit(self.number(si), self.unit)

    def p(self, value):
        """A p-value of the bootstrap, which cannot be less than one draw in all."""
        if not math.isfinite(value):
            return "not known"
        least = 1 / (self.t.draws + 1)
        if value >= 0.995:
            return "> 0.99"
        return ("≤ " if value <= 1.001 * least else "= ") + significant(value, 2 if value > 0.01 else 1)

    def exceeds(self):
        """Whether the held-out readings are off by more than noise alone gives."""
        return self.t.rms.holdout_after > self.t.rms.holdout_noise_high

    def headline(self):
        off = "held-out readings are off by more than noise"
        if not self.exceeds():
            return self.found_headline()
        return capitalised(off) if not self.t.findings and not self.t.vetoed else f"{self.found_headline()}; {off}"

    def found_headline(self):
        t = self.t
        said = lambda findings: joined(counted([f"one of {len(f.members)} effects" if f.kind == "class" else
                                                UNKNOWN if f.kind == "not_in_catalogue" else in_words(f.name) for f in findings]))
        if self.standing:
            return f"Found: {said(self.standing)}" + (f"; withdrawn: {said(self.rejected)}" if self.rejected else "")
        if self.rejected:
            return f"Found, and withdrawn: {said(self.rejected)}"
        if t.verdict == "insufficient_data":
            return "These data cannot decide"
        if t.vetoed:
            return "Found, and withdrawn"
        if t.lack_of_fit.found:
            return "Lack of fit: a part of the error repeats"
        if t.anomalous_blocks:
            return f"{t.anomalous_blocks[0].name} differs from the others"
        return "Nothing found"

    def explanation(self):
        """How sure the verdict is."""
        t = self.t
        if t.verdict == "insufficient_data":
            return "What is missing is stated below."
        chance = f"the false-alarm rate of the search was limited to {significant(100 * t.alpha, 1)}{SPACE}%"
        if t.vetoed:
            return (f"The search found something (p {self.p(t.p_anything)}), but it does not improve the prediction of the "
                    f"hold-out blocks. {'It is not' if self.standing else 'Nothing is'} added to the model.")
        return (f"{t.tried} candidates were tried; {chance}. For the whole search, p {self.p(t.p_anything)}.")

    def key_figures(self):
        r = self.t.rms
        if not self.known:
            return []
        kept = math.isfinite(r.holdout_after)
        before, after, noise = ((r.holdout_before, r.holdout_after, r.holdout_noise) if kept else
                                (r.before, r.after, r.noise))
        where = "hold-out" if kept else "in sample"
        found = [(f"error before, {where}", self.size(before)), (f"error after, {where}", self.size(after))]
        if not self.added:
            found = [(f"error, {where}", self.size(before))]
        low, high = (r.holdout_noise_low, r.holdout_noise_high) if kept else (r.noise_low, r.noise_high)
        found.append(("noise alone", self.size(noise)) if not math.isfinite(high) else
                     (f"noise alone, 95{SPACE}%", with_unit(f"[{self.number(low)}, {self.number(high)}]", self.unit)))
        if math.isfinite(r.replicate_floor):
            found.append((f"replicate floor, 95{SPACE}%", with_unit(
                f"[{self.number(r.replicate_floor_low)}, {self.number(r.replicate_floor_high)}]", self.unit)))
        if math.isfinite(r.share_removed) and self.added:
            found.append(("share of the removable mean square removed", self.removed()))
        return found

    def of_blocks(self, text):
        """Final blocks with the label whose values they are."""
        return f"{self.t.blocks} {text}" if self.apart and self.t.blocks and not text.startswith(self.t.blocks) else text

    def removed(self):
        """Above 1 what is left is less than the noise expected: chance, and not more than all. Below 0 it has grown."""
        share = self.t.rms.share_removed
        return "all" if share > 1 else "nothing" if share < 0 else of_all(share)

    def sizes(self, f):
        """One line per size; of a class every member's. Sizes of one unit are shown in one."""
        largest = {}
        for q in f.quantities:
            size = max(abs(spread(q, x)) for x in (q.value, q.standard_uncertainty))
            largest[q.display_units] = max(largest.get(q.display_units, 0), size)
        lines = []
        for q in f.quantities:
            scale = q.scenario_name and q.display_offset  # a point on a scale has its own unit
            unit, factor = (q.display_units, 1) if scale else suited(q.display_units, largest[q.display_units])
            u = factor * spread(q, q.standard_uncertainty)
            shift = point if q.scenario_name else spread  # what stands nowhere is a difference
            places = decimals(u)
            show = lambda x: fixed(factor * shift(q, x), places)
            lines.append(types.SimpleNamespace(
                member=q.member, said=names.readable(q.member), name=names.plain(q.name), labels=q.labels, value=show(q.value),
                u=fixed(u, places), low=show(q.low), high=show(q.high), unit=unit_text(unit), where=q.scenario_name))
        return lines

    def to_do(self, f):
        """What a machinist does about a finding, and by how much."""
        if self.is_rejected(f):
            return "Do not correct for it: the hold-out blocks reject it. Measure more blocks to decide."
        if f.kind == "named" and f.quantities:
            size = "; ".join(f"{q.name} {with_unit(q.value, q.unit)}, 95{SPACE}% interval [{q.low}, {q.high}]"
                             for q in self.sizes(f))
            if getattr(f, "implausible", ""):
                return f"Find its cause before you correct for it: a size {f.implausible} is likely an alias of another effect's."
            if f.name.startswith("declared:"):
                return f"Check what is declared. The readings say: {size}."
            if getattr(self.t, "unconfirmed", 0):
                return f"Measure another block before you correct for it: {UNDECIDED}. {capitalised(size)}."
            return f"Correct for it: {size}."
        if f.kind == "class":
            return f"Measure next: {f.suggestion}." if f.suggestion else "Other conditions must be varied to distinguish the causes."
        if f.kind == "scatter" and len(f.members) > 1:
            return "Until further readings distinguish the causes, include it in the uncertainty budget."
        if f.kind == "scatter":
            return "It cannot be corrected for; include it in the uncertainty budget."
        if f.tables and getattr(self.t, "unconfirmed", 0):
            return f"Measure another block before you correct by the table of {names.by('*'.join(f.depends_on))} below: {UNDECIDED}."
        if f.tables and all(map(compensation.of_labels, f.tables)):
            return "The table below has the differences. Correct for them where they are errors; the sizes of parts are none."
        if f.tables:
            return f"Correct by the table of {names.by('*'.join(f.depends_on))} below; its cause is unknown."
        if not f.curves:
            return "Its cause is unknown."
        return "Its cause is unknown; the curve below describes it within the range of the data."

    def title(self, f):
        if f.kind == "class" and len(f.members) <= 3:
            return capitalised(" or ".join(map(in_words, f.members)))
        if f.kind == "not_in_catalogue":
            return "An unknown effect" + (f": {names.readable(f.described_by)}" if f.described_by else "")
        return f"One of {len(f.members)} effects" if f.kind == "class" else capitalised(in_words(f.name))

    def as_well(self, f):
        """The remark on an unknown effect that fits better than a known one; empty if there is none."""
        return next((x for x in f.remarks if f.kind in ("named", "class") and x.endswith(AS_WELL)), "")

    def preferred(self, f):
        """How a finding was preferred to its rivals, in sentences that hold for every way in which it was chosen."""
        better = f" {capitalised(self.in_remark(self.as_well(f)))}; a known effect is preferred." if self.as_well(f) else ""
        if f.kind == "class":
            return (f"These data cannot distinguish these {len(f.members)} effects: each explains the residuals as well as the best "
                    f"of them, or less well by no more than chance gives.{better}")
        if f.kind == "named":
            return f"The search preferred it to all other candidates; “What was tried” gives the reasons.{better}"
        if f.kind == "scatter":
            return ("This error has no fixed size: it takes a new value each time." if len(f.members) < 2 else
                    f"The readings scatter, or one of these is there: {joined([names.readable(m) for m in f.members[1:]])}. "
                    "These data cannot distinguish them.")
        return "No candidate explains this structure."

    def dependence(self, f):
        """What a finding depends on; noise of single readings on nothing."""
        on = [] if f.kind == "scatter" and f.depends_on == ["reading"] else [names.plain(name) for name in f.depends_on]
        return joined(on) if on else ""

    def findings(self):
        for f in self.t.findings:
            # Sizes found together, and scatter, are not corrected for having been the largest.
            alone = len({q.member for q in f.quantities}) == len(f.quantities)
            yield types.SimpleNamespace(
                corrected=f.kind in ("named", "class") and alone, kind=f.kind, title=self.title(f),
                rejected=self.is_rejected(f), preferred=self.preferred(f), members=[(names.readable(m), m) for m in f.members], to_do=self.to_do(f),
                cells=f.tables, tables=[] if self.is_rejected(f) else [compensation.table(table) for table in f.tables],
                p=self.p(f.p_value), depends_on=self.dependence(f), suggestion=f.suggestion,
                remarks=[self.in_remark(x) for x in f.remarks if x not in (f"described by {f.described_by}", self.as_well(f))], sizes=self.sizes(f),
                removed=of_all(f.removed_share) if f.removed_share > 0 else "", curves=f.curves)

    def candidates(self, ranked=None):
        ranked = self.t.candidates if ranked is None else ranked
        top = max((c.statistic for c in ranked if math.isfinite(c.statistic)), default=0)
        for c in ranked[:LISTED]:
            yield types.SimpleNamespace(
                said=names.readable(c.name, c.shape), name=c.name, shape=c.shape, family=FAMILIES.get(c.family, c.family), parameters=c.parameters,
                statistic=significant(c.statistic, 3), width=100 * c.statistic / top if top > 0 and c.statistic > 0 else 0,
                p=significant(c.p_single), left=percent(c.identifiable), absorbed=c.absorbed_by,
                correlation=known_correlation(c), outcome=self.in_remark(c.outcome), kept=c.outcome.startswith(CHOSEN))

    def rounds(self):
        """Every round of `--loop` with what it added and its ranking; none if there was one round."""
        for k, r in enumerate(self.t.rounds):
            added = ("nothing: the hold-out blocks are not predicted better" if r.vetoed else
                     "; ".join(counted([UNKNOWN if a == "not in the catalogue" else in_words(a)
                                        for a in r.added])) or "nothing")
            yield types.SimpleNamespace(
                number=k + 1, added=added, candidates=list(self.candidates(r.candidates))[:LISTED // 2] if k else [],
                errors=[self.number(getattr(r, key)) for key in ("before", "after", "holdout_before", "holdout_after", "noise")])

    def limits(self):
        for d in self.t.limits[:LISTED]:
            unit, factor = of_limit(d)
            seen = math.isfinite(d.value)
            yield types.SimpleNamespace(effect=d.effect, said=names.readable(d.effect), quantity=names.plain(d.quantity), seen=seen, value=with_unit(
                significant(factor * spread(d, d.value)), unit) if seen else "undetectable in these data")

    def noise(self):
        """What of the noise is estimated, in sentences."""
        n = self.t.noise
        if not self.known:
            return []
        text = []
        if not n.declared:
            text.append(f"The scenario declares no noise; the residuals show a standard deviation of {self.size(n.scale)} "
                        "of a reading.")
        elif n.scale == 1:
            text.append("The noise is taken as declared.")
        else:
            text.append(f"The residuals scatter {significant(n.scale, 3)} times as much as declared.")
        if n.declared and n.chi_squared_p < 1:  # 1: not judged
            p = n.chi_squared_p
            size = f"less than {LEAST:g}" if p < LEAST else f"more than {1 - LEAST:g}" if p > 1 - LEAST else significant(p)
            text.append(f"Under the declared uncertainties, residuals as large as those before any finding have a probability of {size} "
                        "(a lognormal distribution, fitted to the size of the noise in simulated data).")
        if n.correlation:
            text.append(f"Successive readings have a correlation of {fixed(n.correlation, 2)}.")
        if n.scatter:
            text.append(f"In addition there is scatter by {joined([names.plain(s.strip()) for s in n.scatter.split(',')])}, "
                        f"standard deviation {self.size(n.scatter_u)}.")
        r = self.t.rms
        if math.isfinite(r.replicate_floor):
            equal = "of equal conditions" if self.t.lack_of_fit.cells > 1 else "that follow each other"
            text.append(f"Readings {equal} scatter by {self.size(r.replicate_floor)}, 95{SPACE}% interval "
                        f"[{self.number(r.replicate_floor_low)}, {self.number(r.replicate_floor_high)}]; what repeats and "
                        "what drifts slowly does not count.")
        return text

    def repeats(self):
        """What is left that repeats, and blocks that differ, in sentences."""
        lack, text = self.t.lack_of_fit, []
        if self.known and math.isfinite(lack.p_value) and (lack.found or lack.cells > 1):
            text.append(f"What repeats with the conditions and is not explained is {self.size(lack.size)}, p {self.p(lack.p_value)}. "
                        f"It depends on {joined(lack.depends_on)}." if lack.found else
                        f"What is left does not repeat with the conditions more than chance gives, p {self.p(lack.p_value)} "
                        f"({lack.cells} sets of equal conditions).")
        for b in self.t.anomalous_blocks:
            text.append(f"{capitalised(b.name)} differs: its readings scatter by {self.size(b.spread)}, those of the other "
                        f"blocks by {self.size(b.others)}, p {self.p(b.p_value)}.")
        return text

    def outliers(self):
        for o in self.t.outliers[:LISTED]:
            unit, factor = shown_unit(o, o.residual)
            yield types.SimpleNamespace(reading=o.reading, block=o.block, weight=fixed(o.weight, 2),
                                        residual=with_unit(significant(factor * o.residual), unit))
