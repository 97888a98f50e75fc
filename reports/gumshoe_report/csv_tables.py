"""The tables as CSV: display units, all digits (reports/README.md)."""
import csv
import io
import itertools
import json
import pathlib

from . import compensation, workbook
from .tables import coefficient, commands, point, spread

# Columns of each group of the file: [header, dataset, kind of unit]. Written by `gumshoe fields --format json`.
COLUMNS = json.loads((pathlib.Path(__file__).parent / "columns.json").read_text(encoding="utf-8"))


def cell(kind, key, row, study, r):
    """A field in display units. `study`: what the row belongs to, in the unit of its output."""
    if kind == "units":
        return row.display_units
    if kind == "output_units":
        return study.display_units
    value = getattr(r if kind == "run" else row, key)
    if kind == "point":
        return point(row, value)
    if kind == "difference":
        return spread(row, value)
    if kind == "output":
        return spread(study, value)
    return value


def line(group, row, study=None, r=None):
    """The columns of one row; those that an older file lacks are left out."""
    cells = {}
    for header, key, kind in COLUMNS[group]:
        if kind == "coefficient":
            cells[header], cells[f"{header}_unit"] = coefficient(study, row)
        elif kind in ("units", "output_units", "run") or hasattr(row, key):
            cells[header] = cell(kind, key, row, study, r)
    return cells


def plain(r):
    """Summary, budget and the tables of the other studies."""
    return {
        "summary": [line("summary", o, r=r) for o in r.outputs],
        "budget": [{"output": b.output, **line("budget", c, b), "degrees_of_freedom": c.degrees_of_freedom}
                   for b in r.budgets for c in b.rows],
        "validation": [line("validation", v) for v in r.validations],
        "comparison": [line("comparison", c) for c in r.comparisons]}


def sensitivity(r):
    def indices(group, studies):
        return [{"output": s.output, **line(group, i, s)} for s in studies for i in s.rows]
    return {
        **{name: indices(name, studies) for name, studies in (
            ("sensitivity", r.sensitivities), ("shapley", r.shapley), ("given_data", r.given_data))},
        "sensitivity_pairs": [{"output": s.output, **line("sensitivity/pairs", p)}
                              for s in r.sensitivities for p in s.pairs],
        "morris": indices("morris", r.morris), "dgsm": indices("dgsm", r.dgsm),
        "one_at_a_time": [{"table": t.title, "quantity": i.quantity, "step": spread(i, i.step),
                           "step_unit": i.display_units, "output": o.name, "unit": o.display_units,
                           "up": spread(o, i.up[k]), "down": spread(o, i.down[k])}
                          for t in r.one_at_a_time for i in t.rows for k, o in enumerate(t.outputs)]}


def decisions(r):
    """Joint regions, circular statistics, conformity, targets."""
    return {
        "joint": [{"region": k, "a": a.name, "b": b.name, "correlation": a.correlation[m],
                   "covariance": a.covariance[m] * a.display_factor * b.display_factor, "unit_a": a.display_units,
                   "unit_b": b.display_units, "k_p": j.k_p, "k_q": j.k_q, "coverage_probability": j.coverage_probability}
                  for k, j in enumerate(r.joint) for a in j.rows for m, b in enumerate(j.rows)],
        "fit": [{"a": a.name, "b": b.name, "correlation": a.correlation[m],
                 "covariance": a.covariance[m] * a.display_factor * b.display_factor, "unit_a": a.display_units,
                 "unit_b": b.display_units} for f in r.fit for a in f.rows for m, b in enumerate(f.rows)],
        "circular": [line("circular", c) for c in r.circular],
        "conformity": [line("conformity", c) for c in r.conformity],
        "target": [{"output": t.output, **line("target", i)} for t in r.targets for i in t.rows]}


def choice(c):
    """All candidates, the fresh runs and the optimum's neighbours; U and errors in the measurand's unit."""
    if c is None:
        return {}
    def chosen(values):
        return {v.name + ("" if v.kind == "evaluation" or v.display_units == "1" else f" ({v.display_units})"):
                c.evaluations[int(x)] if v.kind == "evaluation" else point(v, x) for v, x in zip(c.variables, values)}
    def figures(row):
        cells = list(line("choice/candidates", row, c).items())
        k = [name for name, _ in cells].index("valid")
        cases = {f"{n}[{case.name}]": spread(c, getattr(row, key)[k]) for k, case in enumerate(c.cases)
                 for n, key in (("U", "case_expanded"), ("U_se", "case_expanded_se"), ("mean_error_left", "case_left"))}
        return {**dict(cells[:k]), **cases, **dict(cells[k:])}
    def fresh(row):
        cells = line("choice/fresh", row)
        probability = cells.pop("probability")
        return {**cells, **figures(row), "probability": probability}
    return {"candidates": [{**chosen(row.values), **figures(row), "recommended": int(k == c.best)}
                           for k, row in enumerate(c.candidates)],
            "compared": [fresh(row) for row in c.fresh],
            "neighbours": [{"variable": c.variables[int(n.variable)].name,
                            **chosen(c.candidates[int(n.candidate)].values), **line("choice/neighbours", n),
                            "meets": c.candidates[int(n.candidate)].meets} for n in c.neighbours],
            **{name: lines for name, lines in sensitivity(c).items() if lines}}


def trace(t):
    """Findings, ranking, detection limits and every residual with its labels and conditions."""
    if t is None:
        return {}
    # What the hold-out blocks rejected is not compensated for.
    rejected = lambda f: t.vetoed and f.kind == "not_in_catalogue"
    beside = {**t.data.labels, **t.data.columns, **t.data.conditions}
    def heads(name, column):
        unit = getattr(column, "display_units", "1")
        return name if unit == "1" else f"{name} ({unit})"
    def value(column, k):
        x = column.values[k]
        return x if isinstance(x, str) else x * column.display_factor + column.display_offset
    def size(q):
        """What stands in a scenario is a point on its scale, anything else a difference."""
        if q.scenario_name:
            return {**{n: point(q, getattr(q, n)) for n in ("value", "low", "high")},
                    "standard_uncertainty": spread(q, q.standard_uncertainty)}
        return {n: spread(q, getattr(q, n)) for n in ("value", "standard_uncertainty", "low", "high")}
    return {"findings": [{"finding": f.name, "kind": f.kind, "p_value": f.p_value, "member": q.member, "quantity": q.name,
                          "labels": q.labels, "unit": q.display_units, **size(q), "suggestion": f.suggestion}
                         for f in t.findings for q in f.quantities],
            "compensation": [{"finding": k + 1, **one} for k, f in enumerate(t.findings) if not rejected(f)
                             for table in f.tables for one in compensation.lines(table)],
            "candidates": [{**line("trace/candidates", c), "correlation": c.correlation or ""} for c in t.candidates],
            "detection_limits": [line("trace/detection_limits", d) for d in t.limits],
            "of_indications": [line("trace/of_indications", e) for e in t.of_indications],
            "anomalous_blocks": [line("trace/anomalous_blocks", b) for b in t.anomalous_blocks],
            "outliers": [line("trace/outliers", o) for o in t.outliers],
            "residuals": [{"reading": row.reading + 1, "indication": row.indication, "order": row.order, "block": row.block,
                           "final": row.final, **{heads(n, c): value(c, row.reading) for n, c in beside.items()},
                           **line("residuals", row)} for row in t.residuals]}


def volume(v):
    """The grid of errors, each point with its commands, and what causes the largest one."""
    if v is None:
        return {}
    points = [{**{f"{a.name}_{a.display_units}": x for a, x in zip(v.axes, at)}, **line("volume/points", p), "unit": "m"}
              for at, p in zip(itertools.product(*map(commands, v.axes)), v.points)]
    return {"axes": [line("volume/axes", a) for a in v.axes], "points": points,
            "causes": [{**line("volume/causes", s), "error_unit": "m"} for s in v.shares]}


def text(lines):
    """A table as CSV; lines without a column leave it empty."""
    out = io.StringIO(newline="")
    writer = csv.DictWriter(out, list(dict.fromkeys(key for line in lines for key in line)))
    writer.writeheader()
    writer.writerows(lines)
    return out.getvalue()


def files(r, folder, stem):
    """Every table that has rows, and the budget as a workbook: their contents by the paths where they belong."""
    found = {folder / f"{stem}_{name}.csv": text(lines).encode("utf-8") for name, lines in
             {**plain(r), **sensitivity(r), **decisions(r), **choice(r.choice), **trace(r.trace), **volume(r.volume)}.items() if lines}
    if book := workbook.budget(r):
        found[folder / f"{stem}_budget.xlsx"] = book
    return found
