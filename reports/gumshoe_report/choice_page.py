"""What the page of a choice is filled with."""
import types

import markupsafe

from . import choice, choice_figures, choice_surface, rounding, sensitivity_figures, studies


def limiting(c):
    """The sections of sensitivity at the recommended setting, as those of an output."""
    for study in [*c.sensitivities, *c.shapley]:
        sobol, shapley = (study, None) if c.sensitivities else (None, study)
        yield types.SimpleNamespace(
            budget=None, sobol=sobol, shapley=studies.shapley(shapley) if shapley else None, pairs=None, why="",
            given_data=None, morris=None, dgsm=None, shapley_figure="",
            confidence=rounding.probability(getattr(study, "confidence", 0.95)),
            side_by_side=markupsafe.Markup(sensitivity_figures.side_by_side(None, sobol, shapley, "s0")))


def contents(r):
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
