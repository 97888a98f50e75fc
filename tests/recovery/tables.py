"""What the study found, as tables and plain sentences."""
import math
import platform
from collections import defaultdict

import numpy as np

from score import upper_limit

BEGIN, END = "<!-- study: begin -->", "<!-- study: end -->"
DATA_BEGIN, DATA_END = "<!-- measured data: begin -->", "<!-- measured data: end -->"


def machine():
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.processor())
    return f"{model}, {platform.system()}"


def by(rows, *keys):
    groups = defaultdict(list)
    for row in rows:
        groups[tuple(row.get(k) for k in keys)].append(row)
    return dict(sorted(groups.items(), key=lambda item: [str(k) if not isinstance(k, (int, float)) else f"{k:09.2f}" for k in item[0]]))


def table(head, rows):
    text = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(text + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def mean(values):
    values = [v for v in values if v is not None and not (isinstance(v, float) and math.isnan(v))]
    return float(np.mean(values)) if values else math.nan


def median(values):
    values = [v for v in values if v is not None and not math.isnan(v)]
    return float(np.median(values)) if values else math.nan


def show(x, digits=2):
    return "" if x is None or math.isnan(x) else f"{x:.{digits}f}"


def false_alarms(rows):
    out = []
    for (system, noise), group in by([r for r in rows if r["kind"] == "null" and "failed" not in r], "system", "noise").items():
        n, alarms = len(group), sum(r["false_alarm"] for r in group)
        kinds = by([r for r in group if r["false_alarm"]], "verdict")
        out.append((system, noise, n, alarms, f"{alarms / n:.3f}", f"{upper_limit(alarms, n):.3f}",
                    ", ".join(f"{len(v)} {k[0]}" for k, v in kinds.items())))
    return out


def effect_rows(rows, kinds):
    out = []
    chosen = [r for r in rows if r["kind"] in kinds and "failed" not in r]
    for (system, kind, case, strength), group in by(chosen, "system", "kind", "case", "strength").items():
        out.append((system, f"{kind} {case}", f"{strength:g}", len(group), show(mean([r["found"] for r in group])), show(mean([r["oracle"] for r in group])),
                    show(mean([r["naming"] for r in group])), show(mean([r["naming"] == 1 for r in group])), show(mean([r["wrong_name"] for r in group])),
                    show(median([r["after_over_noise"] for r in group])), show(median([r["before_over_noise"] for r in group]))))
    return out


def summary(rows):
    """Figures of the whole, by system."""
    out = []
    for (system,), group in by([r for r in rows if "failed" not in r], "system").items():
        there = [r for r in group if r["kind"] in ("single", "pair", "alias")]
        plain = [r for r in there if r["strength"] >= 8]
        outside = [r for r in group if r["kind"] == "outside" and r["strength"] >= 8]
        right = [hit for r in group for hit in r["right_intervals"]]
        intervals = [hit for r in group for hit in r["intervals"]]
        changed = [r for r in group if not math.isnan(r["after_over_noise"])]
        out.append((system, show(mean([r["naming"] for r in plain])), show(mean([r["wrong_name"] for r in there])),
                    f"{show(mean(right))} of {len(right)}",
                    f"{show(mean(intervals))} of {len(intervals)}", show(median([r["after_over_noise"] for r in there if r["found"]]), 3),
                    show(mean([r["verdict"] == "not_in_catalogue" for r in outside])), show(mean([r["naming"] == 1 for r in outside])),
                    show(mean([r["wrong_name"] for r in outside])), show(mean([r["harm"] for r in changed]), 3)))
    return out


HEAD_NULL = ["system", "noise", "sets", "false alarms", "share", "upper 95 % limit", "which"]
HEAD_EFFECT = ["system", "what is there", "strength", "sets", "something found", "oracle finds", "naming", "right", "wrong name", "after / noise",
               "before / noise"]
HEAD_SUMMARY = ["system", "naming at 8 and more", "wrong names", "coverage, right names", "coverage, all intervals", "held-out after / noise, median", "outside: not in the catalogue",
                "outside: right", "outside: wrong name", "harm"]


def short(rows):
    failed = [r for r in rows if "failed" in r]
    text = table(HEAD_NULL, false_alarms(rows)) + "\n" + table(HEAD_EFFECT, effect_rows(rows, ("single", "pair", "alias", "outside", "scatter")))
    text += "\n" + table(HEAD_SUMMARY, summary(rows))
    return text + "".join(f"failed: {r['system']} {r['kind']} {r['case']} {r['noise']} {r['strength']:g} seed {r['seed']}: {r['failed']}\n" for r in failed[:10])


def report(rows, run):
    failed = [r for r in rows if "failed" in r]
    seconds = [r["seconds"] for r in rows if "seconds" in r]
    judged = (f"This was judgement run {run['judgements']} on seeds that no earlier run has had" if run["judgement"]
              else "These are development seeds: the search may have been tuned on them")
    parts = [
        f"Sets of readings of several measurements with an undeclared effect, or with none, made by `tests/recovery` with formulas of its own. {judged} "
        f"(from seed {run['first_seed']}). {len(rows)} sets: {run['nulls']} nulls per system and kind of noise with {run['null_draws']} bootstrap draws, "
        f"{run['effects']} sets per effect and strength with {run['draws']}. {run['version']}, {run['date']}, {run['machine']}, {run['processes']} processes, "
        f"{run['seconds'] / 60:.0f} min in all, {show(median(seconds))} s a set (median). "
        + (f"{len(failed)} runs gave no verdict and are in no table." if failed else "Every run gave a verdict."),
        "Strength is the length of the effect's signature in standard deviations, after declared and free quantities took what they can: beta times the root of "
        "g'WMg, training blocks only. Something of strength 3 is at the edge of what can be seen.",
        "### False alarms where nothing is\n\nNominal 0.05. `clamp_declared`: scatter between clampings, declared; `clamp_undeclared`: not declared, so "
        "that scatter is the right answer and anything else an alarm. `quantised`: 0.3 um of noise read in steps of "
        "1 um, declared.\n\n" + table(HEAD_NULL, false_alarms(rows)),
        "### Found and named\n\n\"Oracle finds\" is the power of somebody who knows the noise and tests the catalogue's exact signatures and nothing else, at the same "
        "0.05 over all of them. Naming: +1 the right name, or the class where the oracle cannot split it; +0.5 a wider class that holds the truth; 0 silence; "
        "-1 a wrong name; the mean of two where two effects are there.\n\n" + table(HEAD_EFFECT, effect_rows(rows, ("single", "pair", "scatter"))),
        "### Where the data cannot tell\n\nAliased by design: one feed, one direction, or two effects of one signature. Case by number as in the generator. Where the "
        "declared model absorbs all of it, silence is right and naming is 0.\n\n" + table(HEAD_EFFECT, effect_rows(rows, ("alias",))),
        "### In no catalogue\n\nA bump or a jump in time, a wave over temperature, a cubic of a condition, a product of two. Right: described by the conditions it "
        "depends on.\n\n" + table(HEAD_EFFECT, effect_rows(rows, ("outside",))),
        "### All together\n\nHarm: the held-out error rose by more than 5 %. Coverage of 95 % intervals: of all, those of wrong names are misses.\n\n"
        + table(HEAD_SUMMARY, summary(rows)),
    ]
    if failed:
        parts.append("### Without a verdict\n\n" + table(["system", "what", "why", "runs"], [
            (k[0], k[1], k[2].replace("|", "/"), len(v)) for k, v in by([dict(r, failed=r["failed"][:120]) for r in failed], "system", "case", "failed").items()][:20]))
    return "\n\n".join(parts)


def into(path, text, title="# Tracing a residual to a missing effect\n\n## Study on made-up readings"):
    """Replaces the study's part of the report, leaves what people wrote around it."""
    old = path.read_text() if path.exists() else f"{title}\n\n{BEGIN}\n{END}\n"
    if BEGIN not in old:
        old += f"\n## Study on made-up readings\n\n{BEGIN}\n{END}\n"
    head, rest = old.split(BEGIN, 1)
    path.write_text(head + BEGIN + "\n" + text + "\n" + END + rest.split(END, 1)[1])


def include(path, page):
    """Puts another page at the report's end, its headings one level down."""
    text = "\n".join("#" + line if line.startswith("#") else line for line in page.read_text().rstrip().splitlines())
    old = path.read_text() if path.exists() else "# Tracing a residual to a missing effect\n"
    if DATA_BEGIN not in old:
        old = old.rstrip() + f"\n\n{DATA_BEGIN}\n{DATA_END}\n"
    head, rest = old.split(DATA_BEGIN, 1)
    path.write_text(head + DATA_BEGIN + "\n" + text + "\n" + DATA_END + rest.split(DATA_END, 1)[1])
