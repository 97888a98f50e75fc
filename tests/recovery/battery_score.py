"""What one trace of a set, with its rounds, is worth: plain counts, added up by `battery_tables.py`."""
import itertools
import math
import re

from score import covered, is_shape, number, plain, same_place

SAME = 0.02      # relative difference of errors between the end of a round and the start of the next
STRENGTH = 7.95  # from 8 on, as far as sizes are set to 1 %, an effect is plain to see
UNKNOWN = "not in the catalogue"


def names(finding):
    return {plain(n) for n in (finding.get("members") or [finding["name"]])}


def allowed(effect):
    """Names that an oracle could not refuse: by its signature, and by the exact model where readings jump with a size."""
    return {plain(n) for key in ("twins", "unsplit", "unsplit_exact") for n in [effect["name"], *effect.get(key, [])]}


def seen(effect):
    """Strength: of what it changes alone and, where others may take its part by the exact model, of what they leave."""
    return min(effect["strength"], effect.get("beside", effect["strength"]))


def by_signature(truth):
    """The truth as it is judged without the exact model."""
    return {**truth, "effects": [{k: v for k, v in e.items() if k not in ("beside", "unsplit_exact")} for e in truth["effects"]]}


def a_shape(finding):
    return finding["kind"] == "not_in_catalogue" or is_shape(finding["name"])


def right(finding, effect):
    """The name, or a class that an oracle could not split either; what is in no catalogue: what it depends on."""
    if a_shape(finding):
        return effect["outside"] and same_place(finding.get("depends_on", []), effect["depends_on"])
    known = {n for n in names(finding) if not is_shape(n)}
    return bool(known & allowed(effect)) and (plain(effect["name"]) in known or effect["outside"]) and known <= allowed(effect)


def holds_its_shape(finding, effect):
    """A class with a shape of what is in no catalogue: `scatter:cycle | step:cycle 1`."""
    return effect["outside"] and any(same_place(re.split("[:*^ ]", m)[1:2], effect["depends_on"]) for m in finding.get("members", []) if is_shape(m))


def wrong(finding, truth):
    """A cause that is not there, alone or as a class of such."""
    if a_shape(finding) or any(holds_its_shape(finding, e) for e in truth["effects"]):
        return False
    if finding["kind"] == "scatter" and truth["expected"] == "scatter":
        return False
    return not any(names(finding) & allowed(e) for e in truth["effects"])


def later(table):
    """What rounds after the first add: names only."""
    added = [n for r in table[1:] if not r["vetoed"] for n in r["added"] if n != UNKNOWN]
    return [dict(name=n, members=n.split(" | "), kind="scatter" if n.startswith("scatter:") else "named") for n in added]


def said(verdict):
    """Findings, and what is a verdict of its own: that something repeats, that a block differs. Both name conditions, no cause."""
    unknown = lambda name, depends: dict(kind="not_in_catalogue", name=name, members=[], quantities=[], depends_on=depends)
    fit = verdict.get("lack_of_fit", {})
    blocks = [unknown(f"{b['name']} differs", b["name"].split(" ")[:1]) for b in verdict.get("anomalous_blocks", [])]
    return verdict["findings"] + ([unknown("lack of fit", fit["depends_on"])] if fit.get("found") else []) + blocks


def row(verdict, truth):
    findings, effects = said(verdict), truth["effects"]
    plain_to_see = [e for e in effects if seen(e) >= STRENGTH]
    out = dict(found=[f["name"] for f in findings], kinds=[f["kind"] for f in findings], depends=[f["depends_on"] for f in findings], vetoed=verdict["vetoed"],
               told=len(plain_to_see), right=sum(any(right(f, e) for f in findings) for e in plain_to_see),
               wider=sum(any(plain(e["name"]) in names(f) for f in findings) and not any(right(f, e) for f in findings) for e in plain_to_see),
               wrong=[f["name"] for f in findings + later(verdict["rounds"]) if effects and wrong(f, truth)],
               alarm=not effects and any(truth["expected"] != "scatter" or f["kind"] != "scatter" for f in findings))
    out["intervals"] = [hit for e in effects for f in findings if right(f, e) and not a_shape(f) for hit in covered(f, e)]
    if any("unsplit_exact" in e for e in effects):
        signature = row(verdict, by_signature(truth))
        out["by_signature"] = {k: signature[k] for k in ("told", "right", "wider", "wrong")}
    return {**out, **rounds(verdict["rounds"]), **errors(verdict, truth)}


def rounds(table):
    """The laws of the loop."""
    breaks = []
    for k, (a, b) in enumerate(itertools.pairwise(table), 2):
        for before, after in (("before", "after"), ("holdout_before", "holdout_after")):
            if b[before] is not None and a[after] is not None and not abs(b[before] - a[after]) <= SAME * a[after]:
                breaks.append([k, before, a[after], b[before]])
    kept = [n for r in table if not r["vetoed"] for n in set(r["added"]) - {UNKNOWN}]
    last = table[-1]
    return dict(rounds=len(table), law_broken=breaks, ended=not last["added"] or last["vetoed"], again=sorted({n for n in kept if kept.count(n) > 1}))


def lawful(r):
    return not r["law_broken"] and r["ended"] and not r["again"]


def errors(verdict, truth):
    """Held-out errors at the end of the loop, over the noise the program states, and over what an oracle leaves."""
    rms, last = verdict["rms"], verdict["rounds"][-1]
    after, before = number(last["holdout_after"]), number(rms.get("holdout_before"))
    cut = number(last["holdout_after_winsorised"])  # the floor has no bad readings either
    over = lambda x, floor: x / floor if floor and floor > 0 else math.nan
    floor, oracle = number(rms.get("holdout_noise")), number(truth.get("held_out_um")) * 1e-6
    return dict(after_over_floor=over(cut, number(rms.get("replicate_floor"))), after_over_noise=over(after, floor), after_over_oracle=over(after, oracle), before_over_oracle=over(before, oracle))
