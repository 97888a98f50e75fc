"""The tables as CSV: display units, all digits (reports/README.md)."""
import csv
import math

from .tables import point, spread


def of(row, points="", spreads="", source=None):
    """Members of a row in display units; `source` has the factor if the row has none."""
    by = source or row
    return {**{n: point(by, getattr(row, n)) for n in points.split()},
            **{n: spread(by, getattr(row, n)) for n in spreads.split()}}


def plain(r):
    """Summary, budget and what stands beside them."""
    ends = "symmetric_low symmetric_high shortest_low shortest_high"
    return {
        "summary": [{"output": o.name, "unit": o.display_units, **of(o, "estimate"),
                     **of(o, "", "standard_uncertainty"), **of(o, ends), "coverage_probability": r.coverage_probability,
                     **of(o, "", "estimate_se standard_uncertainty_se"), "valid": o.valid, "failed": o.failed,
                     "warning": o.warning, "statement": o.statement} for o in r.outputs],
        "budget": [{"output": b.output, "quantity": c.name, "unit": c.display_units, **of(c, "estimate"),
                    **of(c, "", "standard_uncertainty"), "type": c.evaluation, "distribution": c.distribution,
                    "degrees_of_freedom": c.degrees_of_freedom or math.inf, "differentiable": c.differentiable,
                    "sensitivity": c.sensitivity * b.display_factor / c.display_factor,
                    "contribution": spread(b, c.contribution), "contribution_unit": b.display_units,
                    "share_gum": c.share, "share_monte_carlo": c.monte_carlo_share, "scope": c.scope,
                    "source": c.source} for b in r.budgets for c in b.rows],
        "validation": [{"output": v.name, "unit": v.display_units, **of(v, "", "delta d_low d_high monte_carlo_tolerance"),
                        "digits": v.digits, "verdict": v.verdict, "reason": v.reason} for v in r.validations],
        "comparison": [{"comparison": c.name, "a": c.a, "b": c.b, "unit": c.display_units,
                        **of(c, "", "difference standard_uncertainty root_sum_square expanded_uncertainty"),
                        "normalised_error": c.normalised_error} for c in r.comparisons]}


def sensitivity(r):
    def indices(studies):
        return [{"output": s.output, "input": i.input, **{n: v for n, v in vars(i).items() if n != "input"}}
                for s in studies for i in s.rows]
    return {
        "sensitivity": indices(r.sensitivities), "shapley": indices(r.shapley), "given_data": indices(r.given_data),
        "sensitivity_pairs": [{"output": s.output, "a": p.a, "b": p.b, "second": p.second, "low": p.low, "high": p.high,
                               "verdict": p.verdict} for s in r.sensitivities for p in s.pairs],
        "morris": [{"output": m.output, "input": i.input, "unit": m.display_units,
                    **of(i, "", "mean_absolute mean_absolute_se mean standard_deviation", m)}
                   for m in r.morris for i in m.rows],
        "dgsm": [{"output": d.output, "input": i.input, "nu_si": i.nu, "nu_se_si": i.nu_se, "bound": i.bound,
                  "bound_low": i.bound_low, "bound_high": i.bound_high} for d in r.dgsm for i in d.rows],
        "one_at_a_time": [{"table": t.title, "quantity": i.quantity, **of(i, "", "step"), "step_unit": i.display_units,
                           "output": o.name, "unit": o.display_units, "up": spread(o, i.up[k]),
                           "down": spread(o, i.down[k])} for t in r.one_at_a_time for i in t.rows
                          for k, o in enumerate(t.outputs)]}


def decisions(r):
    """Joint regions, circular statistics, conformity, targets."""
    return {
        "joint": [{"region": k, "a": a.name, "b": b.name, "correlation": a.correlation[m],
                   "covariance": a.covariance[m] * a.display_factor * b.display_factor, "unit_a": a.display_units,
                   "unit_b": b.display_units, "k_p": j.k_p, "k_q": j.k_q, "coverage_probability": j.coverage_probability}
                  for k, j in enumerate(r.joint) for a in j.rows for m, b in enumerate(j.rows)],
        "circular": [{"output": c.name, "unit": c.display_units, **of(c, "mean_direction low high", "standard_deviation"),
                      "resultant_length": c.resultant_length, "remark": c.remark} for c in r.circular],
        "conformity": [{"output": c.name, "unit": c.display_units,
                        **of(c, "lower upper acceptance_lower acceptance_upper estimate process_mean",
                             "guard_band process_u"), "accepted": c.accepted,
                        **{n: v for n, v in vars(c).items() if n.startswith(("conformance", "specific", "global",
                                                                             "posterior", "process_conformance"))},
                        "statement": c.statement} for c in r.conformity],
        "target": [{"output": t.output, "quantity": i.quantity, "unit": i.display_units,
                    **of(i, "", "present allowed allowed_gum cheapest"), "cost": i.cost}
                   for t in r.targets for i in t.rows]}


def choice(c):
    """All candidates, the fresh runs and the optimum's neighbours; U and errors in the measurand's unit."""
    if c is None:
        return {}
    def chosen(values):
        return {v.name + ("" if v.kind == "evaluation" or v.display_units == "1" else f" ({v.display_units})"):
                c.evaluations[int(x)] if v.kind == "evaluation" else point(v, x) for v, x in zip(c.variables, values)}
    def figures(row):
        cases = {f"{n}[{case.name}]": spread(c, getattr(row, key)[k]) for k, case in enumerate(c.cases)
                 for n, key in (("U", "case_expanded"), ("U_se", "case_expanded_se"), ("mean_error_left", "case_left"))}
        return {"time_s": row.time, "number_of_readings": row.readings, "unit": c.display_units, "U": spread(c, row.expanded),
                "U_se": spread(c, row.expanded_se), "mean_error": spread(c, row.mean), "mean_error_se": spread(c, row.mean_se),
                "standard_deviation": spread(c, row.standard_deviation), **cases, "valid": row.valid, "failed": row.failed,
                "meets": row.meets}
    return {"candidates": [{**chosen(row.values), **figures(row), "pareto": row.pareto, "round": row.round,
                            "recommended": int(k == c.best)} for k, row in enumerate(c.candidates)],
            "compared": [{"name": row.name, "setting": row.setting, "source": row.source, **figures(row),
                          "probability": row.probability} for row in c.fresh],
            "neighbours": [{"variable": c.variables[int(n.variable)].name,
                            **chosen(c.candidates[int(n.candidate)].values), "time_ratio": n.time_ratio,
                            "U_ratio": n.expanded_ratio, "near": n.near, "meets": c.candidates[int(n.candidate)].meets}
                           for n in c.neighbours],
            **{name: lines for name, lines in sensitivity(c).items() if lines}}


def trace(t):
    """Findings, ranking, detection limits and every residual with its labels and conditions."""
    if t is None:
        return {}
    beside = {**t.data.labels, **t.data.columns, **t.data.conditions}
    def heads(name, column):
        unit = getattr(column, "display_units", "1")
        return name if unit == "1" else f"{name} ({unit})"
    def value(column, k):
        x = column.values[k]
        return x if isinstance(x, str) else x * column.display_factor + column.display_offset
    return {"findings": [{"finding": f.name, "kind": f.kind, "p_value": f.p_value, "member": q.member, "quantity": q.name,
                          "labels": q.labels, "unit": q.display_units,
                          **of(q, *(("value low high", "standard_uncertainty") if q.scenario_name else
                                    ("", "value standard_uncertainty low high"))), "suggestion": f.suggestion}
                         for f in t.findings for q in f.quantities],
            "candidates": [vars(c) for c in t.candidates],
            "detection_limits": [{"effect": d.effect, "quantity": d.quantity, "unit": d.display_units, **of(d, "", "value")}
                                 for d in t.limits],
            "residuals": [{"reading": row.reading + 1, "indication": row.indication, "order": row.order, "block": row.block,
                           "final": row.final, **{heads(n, c): value(c, row.reading) for n, c in beside.items()},
                           "unit": row.display_units, **of(row, "measured", "before after noise_u"), "weight": row.weight}
                          for row in t.residuals]}


def write(r, folder, stem):
    """Every table that has rows. Returns the paths."""
    written = []
    for name, lines in {**plain(r), **sensitivity(r), **decisions(r), **choice(r.choice), **trace(r.trace)}.items():
        if lines:
            path = folder / f"{stem}_{name}.csv"
            with open(path, "w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, list(dict.fromkeys(key for line in lines for key in line)))
                writer.writeheader()
                writer.writerows(lines)
            written.append(path)
    return written
