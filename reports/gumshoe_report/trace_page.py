"""What the page of a trace is filled with."""
import math
import types

import markupsafe

from . import figures, trace, trace_axes, trace_budgets, trace_errors, trace_figures

DRAWN = 8  # conditions in the figure of residuals
UNKNOWN_ORDER = "unknown"  # in place of the condition that gives the order of measurement
OF_RUNS = "the readings are treated as exact"  # a note on runs: tracing takes the noise from the residuals


def residual_figures(t, k, indication):
    """The residuals of one indication: in order, against conditions, by label."""
    rows = [r for r in t.residuals if r.indication == indication]
    if sum(math.isfinite(r.before) for r in rows) < 2:
        return None
    crosses, triangles = trace_figures.marks(rows)
    varying = trace_axes.columns(t)
    labels = trace_axes.labels(t)
    order = "the order of the rows" if t.order_name == UNKNOWN_ORDER else "the order of measurement"
    drawings = {"order": trace_figures.in_order(rows, f"o{k}", order),
                "against": trace_figures.against(rows, varying[:DRAWN], f"a{k}") if varying else "",
                "labels": trace_figures.by_label(rows, labels, t.blocks, f"l{k}")}
    return types.SimpleNamespace(
        indication=indication, in_order=order, left_out=[name for name, *_ in varying[DRAWN:]], final=any(r.final for r in rows),
        unscored=sum(not math.isfinite(r.before) for r in rows), several=len(varying) > 1,
        averaged=any(trace_figures.has_averages(rows, by_reading) for _, _, by_reading, _ in varying[:DRAWN]),
        dependent=any(chosen for *_, chosen in varying), outliers=crosses, beyond=triangles,
        **{name: markupsafe.Markup(drawing) for name, drawing in drawings.items()})


def drawn_finding(f, k):
    """A finding with its figure: the table's where there is one, since curves are means over what else varies."""
    by_cells = [trace_figures.cells(table, f"y{k}_{n}") for n, table in enumerate(f.cells)]
    return figures.with_figure(f, "".join(by_cells) or trace_figures.curves(f.curves, f"c{k}"))


def contents(r):
    """What the page of a trace is filled with."""
    words = trace.Trace(r.trace)
    indications = list(dict.fromkeys(row.indication for row in r.trace.residuals))
    drawn = [residual_figures(r.trace, k, indication) for k, indication in enumerate(indications)]
    findings = [drawn_finding(f, k) for k, f in enumerate(words.findings())]
    return dict(
        kicker="Tracing of residuals", title=r.title or r.model_title or r.model, t=words, findings=findings, rounds=list(words.rounds()),
        notes=[note for note in r.notes if not note.endswith(OF_RUNS)],
        sizes=markupsafe.Markup(trace_figures.sizes(words, "z")) if words.known else "",
        residuals=[d for d in drawn if d], candidates=list(words.candidates()), limits=list(words.limits()),
        budgets=trace_budgets.budgets(r.trace, words.standing), outcome=trace_budgets.outcome(words.standing),
        errors=trace_errors.rows(words), indications=indications)
