"""The battery's score as tables: by family, and against the goals."""
import math
from collections import defaultdict

import numpy as np

from battery_score import lawful
from score import upper_limit
from tables import machine, show, table

TITLE = "# A battery of made-up sets with the traits of real data"


def wilson(k, n, z=1.96):
    """95 % limits of a share."""
    if not n:
        return math.nan, math.nan
    p, middle = k / n, (k + z * z / 2) / (n + z * z)
    half = z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    return max(0.0, middle - half), min(1.0, middle + half)


def share(k, n):
    """"0.95 (19 of 20; 0.76 to 0.99)" """
    low, high = wilson(k, n)
    return f"{k / n:.2f} ({k} of {n}; {low:.2f} to {high:.2f})" if n else ""


def finite(rows, key):
    return [r[key] for r in rows if r.get(key) is not None and math.isfinite(r[key])]


def quantile(rows, key, p):
    values = finite(rows, key)
    return float(np.quantile(values, p)) if values else math.nan


def counted(rows):
    return [r for r in rows if "failed" not in r]


def by_family(rows):
    groups = defaultdict(list)
    for r in rows:
        groups[r["family"]].append(r)
    return groups


HEAD = ["family", "sets", "right of what is plain", "wrong names", "alarms", "laws of the loop", "end / oracle, median", "95 %", "start / oracle",
        "end / replicate floor", "intervals of sizes", "predicted", "s"]


def right_of(group):
    told, right, wider = (sum(r[k] for r in group) for k in ("told", "right", "wider"))
    return f"{right} of {told}" + (f", {wider} in a wider class" if wider else "")


def inside(group):
    """Held-out readings in their prediction interval, of how many."""
    return [sum(r["predicted"][i] for r in group if "predicted" in r) for i in (0, 1)]


def predicted_of(group):
    k, n = inside(group)
    return f"{k / n:.2f}" if n else ""


def family_rows(rows, families):
    groups = by_family(rows)
    for f in families:
        group = counted(groups.get(f.name, []))
        if not group:
            continue
        n, hits = len(group), [h for r in group for h in r["intervals"]]
        yield (f.name, n, "" if f.null else right_of(group), "" if f.null else sum(bool(r["wrong"]) for r in group),
               f"{sum(r['alarm'] for r in group)}" if f.null else "", f"{sum(map(lawful, group))} of {n}",
               show(quantile(group, "after_over_oracle", 0.5)), show(quantile(group, "after_over_oracle", 0.95)),
               show(quantile(group, "before_over_oracle", 0.5)), show(quantile(group, "after_over_floor", 0.5)), f"{sum(hits)} of {len(hits)}" if hits else "", predicted_of(group), show(quantile(group, "seconds", 0.5), 1))


def goals(rows, families):
    """What is asked, what is, and whether it is met, by system and over all."""
    family, rows = {f.name: f for f in families}, counted(rows)
    rows = [r for r in rows if r["family"] in family]
    out = []
    for clean, limit in ((True, 0.05), (False, 0.08)):
        nulls = [r for r in rows if family[r["family"]].null and family[r["family"]].clean == clean]
        k, n = sum(r["alarm"] for r in nulls), len(nulls)
        if n:
            out.append((f"false alarms, {'clean' if clean else 'ugly'} nulls", "all", f"at most {limit:g}", f"{share(k, n)}, one-sided {upper_limit(k, n):.3f}",
                        verdict(upper_limit(k, n) <= limit, k / n <= limit)))
    out.append(("laws of the loop", "all", "1", share(sum(map(lawful, rows)), len(rows)), verdict(all(map(lawful, rows)))))
    systems = sorted({family[r["family"]].system for r in rows})
    for system in systems:
        own = [r for r in rows if family[r["family"]].system == system]
        there = [r for r in own if not family[r["family"]].null]
        hits = [h for r in there for h in r["intervals"]]
        out += names(there, system)
        if any("by_signature" in r for r in there):
            out += names([r.get("by_signature", r) for r in there], system, ", by signatures alone")
        if hits:
            out.append(("coverage of sizes", system, "0.90 to 0.98", share(sum(hits), len(hits)), within(sum(hits), len(hits), 0.90, 0.98)))
        k, n = inside(own)
        if n:
            out.append(("held-out readings in their prediction interval", system, "0.90 to 0.98", share(k, n), within(k, n, 0.90, 0.98)))
        if finite(own, "after_over_oracle"):
            m, q = (quantile(own, "after_over_oracle", p) for p in (0.5, 0.95))
            out += over_floor(own, system)
            out.append(("held out: end / oracle", system, "1.05; 1.2 in 95 %", f"{m:.3f}; {q:.3f}", verdict(m <= 1.05 and q <= 1.2)))
    return table(["what", "system", "goal", "is (95 % limits)", "met"], out)


def names(rows, system, how=""):
    told, right = sum(r["told"] for r in rows), sum(r["right"] for r in rows)
    if told:
        yield ("right of what is plain" + how, system, "at least 0.85", share(right, told), within(right, told, 0.85, 1))
    if rows:
        k = sum(bool(r["wrong"]) for r in rows)
        yield ("sets with a wrong name" + how, system, "at most 0.03", share(k, len(rows)), within(k, len(rows), 0, 0.03))


def over_floor(rows, system):
    """A held-out error over the replicate floor, and the oracle's: what noise and few readings add, nobody can avoid."""
    key = "after_over_floor"
    known = [{**r, "oracle": r[key] / r["after_over_oracle"]} for r in rows if finite([r], key) and finite([r], "after_over_oracle")]
    if not known:
        return
    ours, oracle = ([quantile(known, k, p) for p in (0.5, 0.95)] for k in (key, "oracle"))
    met = lambda pair: pair[0] <= 1.05 and pair[1] <= 1.2
    yield ("held out: end / replicate floor", system, "1.05; 1.2 in 95 %", f"{ours[0]:.3f}; {ours[1]:.3f}; oracle {oracle[0]:.3f}; {oracle[1]:.3f}",
           "yes" if met(ours) else "no" if met(oracle) else "no, nor by the oracle")


def within(k, n, low, high):
    """Whether a share is as asked, or its limits reach there."""
    least, most = wilson(k, n)
    return verdict(low <= k / n <= high, least <= high and most >= low)


def verdict(met, nearly=False):
    return "yes" if met else "within chance" if nearly else "no"


def wrong_names(rows):
    count = defaultdict(int)
    for r in counted(rows):
        for n in r["wrong"]:
            count[r["family"], n.replace("|", "or")] += 1
        if r["alarm"]:
            count[r["family"], " + ".join(r["found"]).replace("|", "or")] += 1
    return [(f, n, k) for (f, n), k in sorted(count.items(), key=lambda item: -item[1])]


def broken(rows):
    for r in counted(rows):
        if not lawful(r):
            what = [f"round {k} starts at {b:.3g} m ({name}), the one before ended at {a:.3g} m" for k, name, a, b in r["law_broken"][:1]]
            what += [] if r["ended"] else [f"no end after {r['rounds']} rounds"]
            what += [f"again: {', '.join(r['again'])}"] if r["again"] else []
            yield r["family"], r["seed"], "; ".join(what)


def seeds_of(rows):
    """How many seeds the families had, where some had fewer."""
    seeds = {name: len({r["seed"] for r in group}) for name, group in by_family(rows).items()}
    few, most = min(seeds.values()), max(seeds.values())
    return f"{few} seeds a family." if few == most else f"{few} to {most} seeds a family."


def page(rows, families, version, rounds, draws):
    failed = [r for r in rows if "failed" in r]
    parts = [
        f"This part is written by `scripts/tracing-study --battery`. {len(rows)} sets of {len(by_family(rows))} families (`tests/recovery/families.py`), "
        f"{version}, {machine()}. {seeds_of(rows)} Each set is traced in up to {rounds} rounds, {draws} bootstrap draws. "
        + (f"{len(failed)} gave no verdict." if failed else "Every one gave a verdict."),
        "*Right*: the effect's name, or a class that an oracle cannot split either; of what is in no catalogue, that it is an unknown effect and one of the "
        "conditions on which it depends. *What is plain* has a strength of 8 or more (`tests/recovery/README.md`). *Wrong*: a cause that is not "
        "there. Of mills the exact model says what an oracle cannot split and what is plain, because their readings jump; *by signatures alone*: the "
        "same without it, as up to 2026-11. *End / oracle*: held-out error at the end of the loop over that of an oracle, who knows noise and shape and "
        "fits the size to the same readings; *replicate floor* as the program states it. *Laws of the loop*: each round starts within 2 % of where the one before ended, the loop ends, and no name "
        "comes twice. Prediction intervals are those of `gumshoe run --predict` of the traced scenario, 95 %. Limits are Wilson's, 95 %; those of alarms Clopper and Pearson's, one-sided; *within chance*: the limits reach the goal.",
        "## Goals\n\n" + goals(rows, families),
        "## Families\n\n" + table(HEAD, family_rows(rows, families)),
        "## Wrong names and alarms\n\n" + table(["family", "what was said", "sets"], wrong_names(rows)[:60]),
        "## Laws that were broken\n\n" + table(["family", "seed", "what"], list(broken(rows))[:40]),
    ]
    if failed:
        parts.append("## Without a verdict\n\n" + table(["family", "seed", "why"], [(r["family"], r["seed"], r["failed"].replace("|", "/").replace("\n", " ")) for r in failed[:40]]))
    return "\n\n".join(parts)
