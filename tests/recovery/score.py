#!/usr/bin/python3
"""Scores a verdict against the truth. Reads the public verdict file only.

    score.py VERDICT.json TRUTH.json
"""
import json
import math
import sys

from units import factor

SHAPES = ("polynomial:", "harmonic:", "step:", "pulse:", "shift:", "hysteresis:", "drift:", "product:", "omnibus:", "table:", "wave:")


def plain(name):
    """Of an indication's own version, or of a formula, the name alone."""
    return name.removeprefix("stated:").split(" of ")[0]


def is_shape(name):
    return name.startswith(SHAPES)


def same_place(said, true):
    """Conditions agree; the order of measurement is time."""
    said = {"time" if s == "order" else s for s in said}
    return bool(said & set(true))


def credit(finding, effect):
    """Of one finding for one effect that is there; None: it speaks of something else."""
    name, members = plain(effect["name"]), [plain(m) for m in finding.get("members", [])]
    alike = {plain(n) for n in effect.get("twins", []) + effect.get("unsplit", [])}
    if finding["kind"] == "named":
        return 1.0 if plain(finding["name"]) == name else None
    if finding["kind"] == "class" and name in members:
        others = {m for m in members if m != name and not is_shape(m)}
        return 1.0 if alike and others <= alike else 0.5
    return None


def score(verdict, truth):
    findings = verdict.get("findings", [])
    out = dict(system=truth["system"], kind=truth["kind"], noise=truth["noise"], strength=truth["nominal_strength"], seed=truth["seed"],
               expected=truth["expected"], verdict=verdict["verdict"], what="+".join(e["name"] for e in truth["effects"]) or truth["kind"],
               found=bool(findings), names=[f["name"] for f in findings], intervals=[], right_intervals=[])
    out["false_alarm"] = (truth["expected"] == "nothing_found" and bool(findings)
                          or truth["expected"] == "scatter" and any(f["kind"] != "scatter" for f in findings))
    out["naming"] = {"nothing_found": nothing, "scatter": scatter, "not_in_catalogue": outside}.get(truth["expected"], named)(
        findings, truth, out)
    out["intervals"] = out["intervals"] + out["right_intervals"]
    out["wrong_name"] = out["naming"] < 0
    out["oracle"] = max([e.get("power_catalogue", 0) for e in truth["effects"]], default=math.nan)
    rms = verdict.get("rms", {})
    before, after, noise = (number(rms.get(k)) for k in ("holdout_before", "holdout_after", "noise"))
    noise = number(rms.get("holdout_noise", noise))
    out["after_over_noise"] = after / noise if noise > 0 else math.nan
    out["before_over_noise"] = before / noise if noise > 0 else math.nan
    out["harm"] = after > 1.05 * before
    return out


def number(x):
    return math.nan if x is None else float(x)


def nothing(findings, truth, out):
    for f in findings:
        out["intervals"] += [False for q in f.get("quantities", []) if f["kind"] in ("named", "class")]
    return -1.0 if any(f["kind"] in ("named", "class", "scatter") for f in findings) else 0.0


def scatter(findings, truth, out):
    total = 0.0
    for f in findings:
        right = "scatter:" + ",".join(truth["scatter"])
        if f["kind"] == "scatter":
            labels = f["name"].removeprefix("scatter:").split(",")
            total = max(total, 1.0 if set(labels) == set(truth["scatter"]) else 0.5)
        elif f["kind"] == "class" and right in f["members"]:  # a wider class, and in the nulls an alarm all the same
            total = max(total, 0.5)
        elif f["kind"] in ("named", "class"):
            return -1.0
    return total


def outside(findings, truth, out):
    """What no catalogue has: to be described by the conditions it depends on, not given a cause."""
    depends = {c for e in truth["effects"] for c in e["depends_on"]}
    total = 0.0
    for f in findings:
        if f["kind"] == "not_in_catalogue" or is_shape(f["name"]):
            total = max(total, 1.0 if same_place(f.get("depends_on", []), depends) else 0.5)
        elif f["kind"] in ("named", "class", "scatter"):
            out["intervals"] += [False for _ in f.get("quantities", [])]
            return -1.0
    return total


def named(findings, truth, out):
    """Mean over the effects that are there, a wrong name taking one off."""
    left, total = list(truth["effects"]), 0.0
    wrong = 0
    for f in findings:
        best = max(((credit(f, e), i) for i, e in enumerate(left) if credit(f, e) is not None), default=None)
        if best:
            effect = left.pop(best[1])
            total += best[0]
            out["right_intervals"] += covered(f, effect)
        elif f["kind"] in ("class", "scatter") or f["kind"] == "named" and not is_shape(f["name"]):
            wrong += 1
            out["intervals"] += [False for _ in f.get("quantities", [])]
    return max(-1.0, (total - wrong) / len(truth["effects"]))


def covered(finding, effect):
    """Whether the interval holds the true size; a declared quantity's may be its value or how far it is off."""
    if effect.get("quantity") is None or plain(finding["name"]) not in (plain(effect["name"]), plain(finding.get("members", [""])[0])):
        return []
    if plain((finding.get("members") or [finding["name"]])[0]) != plain(effect["name"]):
        return []
    # An effect of one size may have been given another, nearer to the catalogue's.
    several = effect.get("sizes", {}) if len(effect.get("sizes", {})) > 1 else {effect["quantity"]: effect.get("size")}
    out = []
    for q in finding.get("quantities", []):
        name = q["name"].split("[")[0].split(".")[-1]
        if name not in several:
            continue
        per = factor(effect["unit"], q["unit"])
        low, high = q["interval95"]
        true = [x * per for x in ([effect["off"], effect["absolute"]] if "off" in effect else [several[name]])]
        out.append(bool(low <= min(true, key=lambda t: abs(t - q["value"])) <= high))
    return out


def upper_limit(alarms, n, level=0.95):
    """Clopper and Pearson's one-sided upper limit: as few alarms have this much chance left."""
    low, high = 0.0, 1.0
    for _ in range(60 if alarms < n else 0):
        p = (low + high) / 2
        left = sum(math.exp(math.lgamma(n + 1) - math.lgamma(k + 1) - math.lgamma(n - k + 1) + k * math.log(p) + (n - k) * math.log1p(-p))
                   for k in range(alarms + 1))
        low, high = (p, high) if left > 1 - level else (low, p)
    return high


if __name__ == "__main__":
    print(json.dumps(score(*(json.load(open(path)) for path in sys.argv[1:3])), indent=1))
