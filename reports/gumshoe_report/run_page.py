"""What the page of a run is filled with."""
import base64
import types

import markupsafe

from . import certificate, convergence, csv_tables, explain, failed, figures, overview_figure, profile, profile_figures, reduce
from . import region_figures, rounding, scatter, sensitivity_figures, spatial_figures, studies, tables, targets, workbook

OPEN = 2      # outputs shown in full; the others are folded
DRAWN = 8     # joint regions and conformity tests with a figure
LISTED = 200  # outputs with a section; the CSV tables have all
CARRIED = 3_000_000  # bytes of the tables that the page carries as links
MULTIPLES = 24  # most panels in the figure of all distributions
METHODS = {"propagation": "propagation of distributions (JCGM 101)",
           "virtual_experiment": "virtual experiment: distribution of the error",
           "prediction": "prediction: distribution of the readings, before they are taken"}


def by_output(items, key):
    return {getattr(item, key): item for item in items}


def of_target(t, budgets):
    return targets.target(t, budgets.get(t.output))


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
    wanted = {}
    for t in r.targets:
        wanted.setdefault(t.output, []).append(of_target(t, found["budget"]))
    circles = {c.name: studies.circular(c, None) for c in r.circular if c.remark}  # where the line misleads
    for k, output in enumerate(varying(r)[:LISTED]):
        of = types.SimpleNamespace(**{key: items.get(output.name) for key, items in found.items()})
        full = k < OPEN
        varies = not tables.constant(output)
        u = output.standard_uncertainty
        verdict = verdicts.get(output.name)
        accounted = not of.budget or explain.law_accounts(of.budget, output, verdict.verdict if verdict else "")
        yield types.SimpleNamespace(
            summary=tables.summary_row(output), circle=circles.get(output.name), open=full, varies=varies, targets=wanted.get(output.name, []),
            certificate=certificate.line(output, of.budget, verdict, r.coverage_probability),
            reduce=reduce.table(of.budget, u, of.sobol, of.shapley, of.given, accounted),
            distribution=picture(full and varies, figures.distribution, output, of.budget, r.coverage_probability, f"d{k}"),
            budget=tables.budget(of.budget, u, of.sobol) if of.budget else None, sobol=of.sobol,
            confidence=rounding.probability(of.sobol.confidence) if of.sobol else "",
            side_by_side=picture(full, sensitivity_figures.side_by_side, of.budget, of.sobol, of.shapley, f"s{k}"),
            scatter=picture(full, scatter.figure, r.path, output, of.budget, f"x{k}"),
            why=explain.why(of.budget, of.sobol, of.shapley, u, failed.reason(output)),
            condition=failed.condition(output, len(r.outputs) > 1),
            pairs=studies.pairs(of.sobol) if of.sobol and of.sobol.pairs else None,
            shapley_figure=picture(full and of.shapley and of.sobol, sensitivity_figures.side_by_side, None, None,
                                   of.shapley, f"h{k}"),
            shapley=studies.shapley(of.shapley) if of.shapley else None,
            given_data=studies.given_data(of.given, of.sobol) if of.given else None,
            morris=studies.morris(of.morris) if of.morris else None,
            morris_figure=picture(full and of.morris, sensitivity_figures.morris, of.morris, f"e{k}"),
            dgsm=studies.dgsm(of.dgsm, of.sobol) if of.dgsm else None,
            validation=tables.validation_row(verdict) if verdict else None)


def whole_run(r):
    """The studies that belong to no single output, by the names the templates use."""
    outputs = by_output(r.outputs, "name")
    return {
        "joints": [figures.with_figure(studies.joint(j), region_figures.joint(j, f"j{k}") if k < DRAWN else "")
                   for k, j in enumerate(r.joint)],
        "fits": [studies.fit(f, outputs) for f in r.fit],
        "circulars": [studies.circular(c, outputs.get(c.name)) for c in r.circular],
        "conformities": [figures.with_figure(studies.conformity(c, outputs.get(c.name)), region_figures.conformity(
            c, outputs.get(c.name), f"c{k}") if k < DRAWN else "") for k, c in enumerate(r.conformity)],
        "targets": [of_target(t, by_output(r.budgets, "output")) for t in r.targets if t.output not in {o.name for o in varying(r)}],
        "one_at_a_time": [studies.one_at_a_time(t) for t in r.one_at_a_time],
        "stopping": studies.stopping(r.stopping) if r.stopping else None}


def convergences(r):
    """The figures of the outputs shown in full; none without stored samples."""
    verdicts = by_output(r.validations, "name")
    drawn = [convergence.figure(r.path, o, verdicts.get(o.name), r.coverage_probability, f"t{k}")
             for k, o in enumerate(varying(r)[:OPEN])]
    return [markupsafe.Markup(d) for d in drawn if d]


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
            narrow=profile_figures.too_narrow(p), measurand=p.measurand, along=p.along, round=profile_figures.is_round(p), lines=len(p.lines),
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
        found.append((volume, "Standard uncertainty over the commanded points. Darker is larger; each measurand has its own scale."))
    return [(markupsafe.Markup(figure), caption) for figure, caption in found]


def overviews(r, drawn):
    """With many outputs: one figure per measurand, and all distributions small; without those `drawn` already."""
    outputs = [o for o in varying(r) if o.name not in drawn]
    if len(outputs) <= OPEN:
        return []
    groups = {}
    for output in outputs:
        groups.setdefault(output.measurand, []).append(output)
    found = [overview_figure.overview(g[:60], f"o{k}") for k, g in enumerate(groups.values()) if len(g) > 1]
    return [markupsafe.Markup(f) for f in found + [figures.small_multiples(outputs[:MULTIPLES], "m")]]


def contents(r):
    """What the page of a run is filled with."""
    shown = varying(r)
    along = list(profiles(r))
    return dict(
        spatial=spatial(r), profiles=along, asked=[of_target(t, by_output(r.budgets, "output")) for t in r.targets], left_out=max(0, len(shown) - LISTED), downloads=downloads(r), convergences=convergences(r), validations=[tables.validation_row(v) for v in r.validations[:LISTED]],
        left_out_samples=failed.explanation(r), diagnostics=[tables.diagnostic_text(o) for o in r.outputs if getattr(o, "diagnostic", 0)],
        effects=sorted({i.name.partition(".")[0] for i in r.inputs if "." in i.name}),
        tail=rounding.probability((1 - r.coverage_probability) / 2), kicker="Measurement uncertainty", title=r.title or r.model_title or r.model,
        method=METHODS.get(r.method, r.method), samples=rounding.thousands(r.samples), sections=list(sections(r)), **whole_run(r), overviews=overviews(r, set().union(*(p.names for p in along))),
        constants=[tables.constant_text(o) for o in r.outputs if o not in shown and not getattr(o, "diagnostic", 0)], numbered=tables.numbered(r),
        comparisons=[tables.comparison_row(c) for c in r.comparisons],
        printed=[tables.printed_row(p) for p in r.printed], inputs=[tables.input_row(i) for i in r.inputs],
        readings=tables.readings(r))
