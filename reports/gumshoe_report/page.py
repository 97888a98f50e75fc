"""The page: gathers tables and figures and fills the template."""
import itertools
import pathlib
import types

import jinja2
import markupsafe

from . import figures, rounding, tables

HERE = pathlib.Path(__file__).parent
OPEN = 2      # outputs shown in full; the others are folded
MULTIPLES = 24  # most panels in the figure of all distributions
METHODS = {"propagation": "propagation of distributions (JCGM 101)",
           "virtual_experiment": "virtual experiment: distribution of the error"}


def question(text):
    """The comment in which a scenario opens: '# Question: ...', may run over several lines."""
    lines = itertools.takewhile(lambda line: line.startswith("#"), text.splitlines())
    words = " ".join(line.lstrip("# ").strip() for line in lines if not line.startswith("#:")) # "#:schema" is for editors
    return words.removeprefix("Question:").strip()


def by_output(items, key):
    return {getattr(item, key): item for item in items}


def sections(r):
    budgets, sobols = by_output(r.budgets, "output"), by_output(r.sensitivities, "output")
    verdicts = by_output(r.validations, "name")
    for k, output in enumerate(r.outputs):
        budget, sobol, full = budgets.get(output.name), sobols.get(output.name), k < OPEN
        yield types.SimpleNamespace(
            summary=tables.summary_row(output), open=full,
            distribution=markupsafe.Markup(figures.distribution(output, budget, r.coverage_probability, f"d{k}"))
            if full else "",
            budget=tables.budget(budget, output.standard_uncertainty) if budget else None,
            sobol=sobol, sobol_figure=markupsafe.Markup(figures.sobol(sobol, f"s{k}")) if sobol and sobol.rows and full
            else "", validation=tables.validation_row(verdicts[output.name]) if output.name in verdicts else None)


def overviews(r):
    """With many outputs: one figure per measurand, and all distributions small."""
    if len(r.outputs) <= OPEN:
        return []
    groups = {}
    for output in r.outputs:
        groups.setdefault(output.measurand, []).append(output)
    found = [figures.overview(g[:60], f"o{k}") for k, g in enumerate(groups.values()) if len(g) > 1]
    return [markupsafe.Markup(f) for f in found + [figures.small_multiples(r.outputs[:MULTIPLES], "m")]]


def render(r):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters.update(percent=rounding.percent, fixed=rounding.fixed)
    return environment.get_template("template.html.j2").render(
        r=r, title=r.title or r.model_title or r.model, question=question(r.scenario_text),
        method=METHODS.get(r.method, r.method), p=rounding.probability(r.coverage_probability),
        samples=f"{r.samples:,}".replace(",", "\u202f"), sections=list(sections(r)), overviews=overviews(r),
        comparisons=[tables.comparison_row(c) for c in r.comparisons],
        printed=[tables.printed_row(p) for p in r.printed], inputs=[tables.input_row(i) for i in r.inputs],
        readings=tables.readings(r), css=markupsafe.Markup((HERE / "style.css").read_text(encoding="utf-8")))
