"""The page: gathers tables and figures and fills the template."""
import base64
import itertools
import math
import pathlib
import re
import types

import jinja2
import markupsafe

from . import certificate, choice, choice_figures, choice_surface, convergence, csv_tables, explain, figures, mathml
from . import pictures, profile, profile_figures, reduce, region_figures, rounding, scatter, sensitivity_figures, spatial_figures, studies, tables, trace, trace_figures, workbook

HERE = pathlib.Path(__file__).parent
OPEN = 2      # outputs shown in full; the others are folded
DRAWN = 8     # joint regions and conformity tests with a figure
LISTED = 200  # outputs with a section; the CSV tables have all
CARRIED = 3_000_000  # bytes of the tables that the page carries as links
MULTIPLES = 24  # most panels in the figure of all distributions
METHODS = {"propagation": "propagation of distributions (JCGM 101)",
           "virtual_experiment": "virtual experiment: distribution of the error",
           "prediction": "prediction: distribution of the readings, before they are taken"}


def question(text):
    """The comment in which a scenario opens, '# Question: ...', to its first question mark, else its first sentence."""
    lines = itertools.takewhile(lambda line: line.startswith("#"), text.lstrip("\ufeff").splitlines())
    lines = [line.lstrip("# ").strip() for line in lines if not line.startswith("#:")]  # "#:schema" is for editors
    asked = next((k for k, line in enumerate(lines) if line.lower().startswith("question:")), 0)
    lines = itertools.dropwhile(lambda line: not line, lines[asked:])
    words = re.sub(r"(?i)^question:\s*", "", " ".join(itertools.takewhile(bool, lines)))
    following = r"(?=\s+[A-Z0-9“\"(]|$)"
    end = re.search(r"\?" + following, words) or re.search(r"(?<![.\s]\w)(?<!\b(?:vs|no|cf))[.!]" + following, words)
    words = words[:end.end()] if end else words
    return words[:1].upper() + words[1:]


def by_output(items, key):
    return {getattr(item, key): item for item in items}


def varying(r):
    """Measurands that have a distribution; if none has, all."""
    measurands = [o for o in r.outputs if not getattr(o, "diagnostic", 0)] or r.outputs
    return [o for o in measurands if not tables.constant(o)] or measurands


def sections(r):
    found = {key: by_output(items, "output") for key, items in
             {"budget": r.budgets, "sobol": r.sensitivities, "shapley": r.shapley, "given": r.given_data,
              "morris": r.morris, "dgsm": r.dgsm}.items()}
    verdicts = by_output(r.validations, "name")
    picture = lambda full, draw, *arguments: markupsafe.Markup(draw(*arguments)) if full else ""
    targets = {}
    for t in r.targets:
        targets.setdefault(t.output, []).append(studies.target(t))
    for k, output in enumerate(varying(r)[:LISTED]):
        of = types.SimpleNamespace(**{key: items.get(output.name) for key, items in found.items()})
        full = k < OPEN
        u = output.standard_uncertainty
        yield types.SimpleNamespace(
            summary=tables.summary_row(output), open=full, targets=targets.get(output.name, []),
            certificate=certificate.line(output, of.budget, verdicts.get(output.name), r.coverage_probability),
            reduce=reduce.table(of.budget, u, of.sobol, of.shapley),
            distribution=picture(full, figures.distribution, output, of.budget, r.coverage_probability, f"d{k}"),
            budget=tables.budget(of.budget, u, of.sobol) if of.budget else None, sobol=of.sobol,
            confidence=rounding.probability(of.sobol.confidence) if of.sobol else "",
            side_by_side=picture(full, sensitivity_figures.side_by_side, of.budget, of.sobol, of.shapley, f"s{k}"),
            scatter=picture(full, scatter.figure, r.path, output, of.budget, f"x{k}"),
            why=explain.why(of.budget, of.sobol, of.shapley, u),
            pairs=studies.pairs(of.sobol) if of.sobol and of.sobol.pairs else None,
            shapley_figure=picture(full and of.shapley and of.sobol, sensitivity_figures.side_by_side, None, None,
                                   of.shapley, f"h{k}"),
            shapley=studies.shapley(of.shapley) if of.shapley else None,
            given_data=studies.given_data(of.given, of.sobol) if of.given else None,
            morris=studies.morris(of.morris) if of.morris else None,
            morris_figure=picture(full and of.morris, sensitivity_figures.morris, of.morris, f"e{k}"),
            dgsm=studies.dgsm(of.dgsm, of.sobol) if of.dgsm else None,
            validation=tables.validation_row(verdicts[output.name]) if output.name in verdicts else None)


def with_figure(row, drawing):
    row.figure = markupsafe.Markup(drawing)
    return row


def whole_run(r):
    """The studies that belong to no single output, by the names the templates use."""
    outputs = by_output(r.outputs, "name")
    return {
        "joints": [with_figure(studies.joint(j), region_figures.joint(j, f"j{k}") if k < DRAWN else "")
                   for k, j in enumerate(r.joint)],
        "circulars": [studies.circular(c, outputs.get(c.name)) for c in r.circular],
        "conformities": [with_figure(studies.conformity(c, outputs.get(c.name)), region_figures.conformity(
            c, outputs.get(c.name), f"c{k}") if k < DRAWN else "") for k, c in enumerate(r.conformity)],
        "targets": [studies.target(t) for t in r.targets if t.output not in {o.name for o in varying(r)}],
        "one_at_a_time": [studies.one_at_a_time(t) for t in r.one_at_a_time],
        "stopping": studies.stopping(r.stopping) if r.stopping else None}


def convergences(r):
    """The figures of the outputs shown in full; none without stored samples."""
    verdicts = by_output(r.validations, "name")
    drawn = [convergence.figure(r.path, o, verdicts.get(o.name), r.coverage_probability, f"t{k}")
             for k, o in enumerate(varying(r)[:OPEN])]
    return [markupsafe.Markup(d) for d in drawn if d]


def measurement(r):
    """The picture on top and the equations of the model."""
    picture, caption = pictures.of(r)
    return {"picture": picture, "picture_caption": caption,
            "equations": [(mathml.equation(e.text), e.where) for e in r.equations]}


def downloads(r):
    """The budget as links that carry the files."""
    book, lines = workbook.budget(r), csv_tables.plain(r)["budget"]
    link = lambda kind, data: f"data:{kind};base64,{base64.b64encode(data).decode()}"
    return [] if book is None or len(book) + len(lines) * 200 > CARRIED else [
        ("budget.xlsx", link("application/vnd.openxmlformats-officedocument.spreadsheetml.sheet", book)),
        ("budget.csv", link("text/csv", csv_tables.text(lines).encode("utf-8")))]


def profiles(r):
    """Measurands along a condition: figures, and where the uncertainty is largest and why."""
    budgets, sobol = by_output(r.budgets, "output"), by_output(r.sensitivities, "output")
    for k, p in enumerate(profile.of(r, varying(r))):
        yield types.SimpleNamespace(
            measurand=p.measurand, along=p.along, round=profile_figures.is_round(p), lines=len(p.lines),
            drawn=min(len(p.lines), profile.LINES), sobol=bool(sobol), widest=profile.widest(p, budgets, sobol),
            band=markupsafe.Markup(profile_figures.band(p, f"p{k}", r.coverage_probability)),
            where=markupsafe.Markup(profile_figures.where(p, budgets, sobol, f"w{k}")),
            names={o.name for line in p.lines for o in line.outputs})


def spatial(r):
    """Figures in space and what they show."""
    shown = varying(r)
    contour, volume = spatial_figures.contour(r, shown), spatial_figures.volume(r, shown)
    found = [(contour, "The commanded contour, dashed, and the measured one with its deviations magnified. Pale: symmetric coverage intervals.")] if contour else []
    if volume:
        found.append((volume[0], f"Standard uncertainty over the commanded points, in {volume[1]}."))
    return [(markupsafe.Markup(figure), caption) for figure, caption in found]


def overviews(r, drawn):
    """With many outputs: one figure per measurand, and all distributions small; without those `drawn` already."""
    outputs = [o for o in varying(r) if o.name not in drawn]
    if len(outputs) <= OPEN:
        return []
    groups = {}
    for output in outputs:
        groups.setdefault(output.measurand, []).append(output)
    found = [figures.overview(g[:60], f"o{k}") for k, g in enumerate(groups.values()) if len(g) > 1]
    return [markupsafe.Markup(f) for f in found + [figures.small_multiples(outputs[:MULTIPLES], "m")]]


def subscripts(text):
    """The few symbols of our own sentences, as one writes them: c_i, u_c, p_c, R_C, R_P."""
    return markupsafe.Markup(re.sub(r"\b([cupR])_([icCP])\b", r"\1<sub>\2</sub>", str(markupsafe.escape(text))))


def symbols(text):
    """Units in sentences of the program as one writes them."""
    return re.sub(r"(\d ?)um\b", "\\1µm", text)


def run_page(r):
    """What the page of a run is filled with."""
    shown = varying(r)
    along = list(profiles(r))
    return dict(
        spatial=spatial(r), profiles=along, asked=[studies.target(t) for t in r.targets], left_out=max(0, len(shown) - LISTED), downloads=downloads(r), convergences=convergences(r), validations=[tables.validation_row(v) for v in r.validations[:LISTED]],
        diagnostics=[tables.diagnostic_text(o) for o in r.outputs if getattr(o, "diagnostic", 0)],
        effects=sorted({i.name.partition(".")[0] for i in r.inputs if "." in i.name}),
        kicker="Measurement uncertainty", title=r.title or r.model_title or r.model,
        method=METHODS.get(r.method, r.method), samples=thousands(r.samples), sections=list(sections(r)), **whole_run(r), overviews=overviews(r, set().union(*(p.names for p in along))),
        constants=[tables.constant_text(o) for o in r.outputs if o not in shown and not getattr(o, "diagnostic", 0)], numbered=tables.numbered(r.outputs),
        comparisons=[tables.comparison_row(c) for c in r.comparisons],
        printed=[tables.printed_row(p) for p in r.printed], inputs=[tables.input_row(i) for i in r.inputs],
        readings=tables.readings(r))


def limiting(c):
    """The sections of sensitivity at the recommended setting, as those of an output."""
    for study in [*c.sensitivities, *c.shapley]:
        sobol, shapley = (study, None) if c.sensitivities else (None, study)
        yield types.SimpleNamespace(
            budget=None, sobol=sobol, shapley=studies.shapley(shapley) if shapley else None, pairs=None, why="",
            given_data=None, morris=None, dgsm=None, shapley_figure="",
            confidence=rounding.probability(getattr(study, "confidence", 0.95)),
            side_by_side=markupsafe.Markup(sensitivity_figures.side_by_side(None, sobol, shapley, "s0")))


def choice_page(r):
    """What the page of a choice is filled with."""
    c = r.choice
    words = choice.Choice(c, r.coverage_probability)
    surface, over = choice_surface.heat(c, "u")
    heat = bool(surface)
    if not heat:
        surface, over = choice_surface.line(c, "u")
    failing = sorted((row for row in c.candidates if row.failed), key=lambda row: -row.failed)
    return dict(
        kicker="Choice of settings", title=r.title or r.model, c=words, chance=choice.chance(c.probability),
        best=words.line(words.fresh, words.fresh.setting), gains=words.gains(),
        fresh=[(row.name, words.line(row, row.setting), row.source) for row in c.fresh],
        pareto=markupsafe.Markup(choice_figures.pareto(c, "p")),
        front=[(words.values(row), words.line(row), row is words.best) for row in words.front()],
        surface=markupsafe.Markup(surface), over=over, heat=heat, **choice_surface.legend(c),
        neighbours=words.neighbours(),
        sections=list(limiting(c)), failing_count=len(failing),
        failing=[(words.values(row), words.line(row)) for row in failing[:choice.LISTED]],
        all=[(words.values(row), words.line(row))
             for row in sorted(c.candidates, key=lambda row: row.time)[:choice.MOST]])


def residual_figures(t, k, indication):
    """The residuals of one indication: in order, against conditions, by label."""
    rows = [r for r in t.residuals if r.indication == indication]
    if sum(math.isfinite(r.before) for r in rows) < 2:
        return None
    varying = trace.columns(t)
    labels = trace.labels(t)
    drawings = {"order": trace_figures.in_order(rows, f"o{k}"),
                "against": trace_figures.against(rows, varying[:DRAWN], f"a{k}") if varying else "",
                "labels": trace_figures.by_label(rows, labels, t.blocks, f"l{k}")}
    return types.SimpleNamespace(
        indication=indication, left_out=[name for name, *_ in varying[DRAWN:]], final=any(r.final for r in rows),
        unscored=sum(not math.isfinite(r.before) for r in rows), several=len(varying) > 1,
        dependent=any(chosen for *_, chosen in varying), outliers=any(r.weight < 0.5 for r in rows),
        **{name: markupsafe.Markup(drawing) for name, drawing in drawings.items()})


def trace_page(r):
    """What the page of a trace is filled with."""
    words = trace.Trace(r.trace)
    indications = list(dict.fromkeys(row.indication for row in r.trace.residuals))
    drawn = [residual_figures(r.trace, k, indication) for k, indication in enumerate(indications)]
    findings = [with_figure(f, trace_figures.curves(f.curves, f"c{k}")) for k, f in enumerate(words.findings())]
    return dict(
        kicker="Tracing of residuals", title=r.title or r.model_title or r.model, t=words, findings=findings,
        sizes=markupsafe.Markup(trace_figures.sizes(words, "z")) if words.known else "",
        residuals=[d for d in drawn if d], candidates=list(words.candidates()), limits=list(words.limits()),
        budgets=list(words.budgets()), indications=indications)


def thousands(n):
    return f"{int(n):,}".replace(",", "\u202f")


def render(r):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters.update(percent=rounding.percent, fixed=rounding.fixed, subscripts=subscripts, thousands=thousands, unit_text=rounding.unit_text, after=rounding.after,
                               symbols=symbols,
                               verdicts=studies.sobol_verdict)
    template, contents = ("choice.html.j2", choice_page(r)) if r.choice else \
        ("trace.html.j2", trace_page(r)) if r.trace else ("run.html.j2", run_page(r))
    return environment.get_template(template).render(
        r=r, question=question(r.scenario_text), p=rounding.probability(r.coverage_probability), **measurement(r), **contents,
        css=markupsafe.Markup((HERE / "style.css").read_text(encoding="utf-8")))
