"""The page: fills the template with what the page of a run, a choice, a trace or a volume consists of."""
import itertools
import pathlib
import re

import jinja2
import markupsafe

from . import choice_page, mathml, pictures, rounding, run_page, studies, trace_page, volume_page

HERE = pathlib.Path(__file__).parent


def question(text):
    """The comment in which a scenario opens, '# Question: ...', to its first question mark, else its first sentence."""
    lines = itertools.takewhile(lambda line: line.startswith("#"), text.lstrip("\ufeff").splitlines())
    # "#:schema" is for editors; an indented line is a command, and ends the sentence
    lines = ["" if line.startswith("#    ") else line.lstrip("# ").strip() for line in lines if not line.startswith("#:")]
    asked = next((k for k, line in enumerate(lines) if line.lower().startswith("question:")), 0)
    lines = itertools.dropwhile(lambda line: not line, lines[asked:])
    words = re.sub(r"(?i)^question:\s*", "", " ".join(itertools.takewhile(bool, lines)))
    following = r"(?=\s+[A-Z0-9“\"(]|$)"
    end = re.search(r"\?" + following, words) or re.search(r"(?<![.\s]\w)(?<!\b(?:vs|no|cf))[.!]" + following, words)
    words = words[:end.end()] if end else words
    return words[:1].upper() + words[1:]


def measurement(r):
    """The picture on top and the equations of the model."""
    picture, caption = pictures.of(r)
    return {"picture": picture, "picture_caption": caption,
            "equations": [(mathml.equation(e.text), e.where) for e in r.equations]}


def subscripts(text):
    """The few symbols of our own sentences, as one writes them: c_i, u_c, p_c, R_C, R_P."""
    return markupsafe.Markup(re.sub(r"\b([cupR])_([icCP])\b", r"\1<sub>\2</sub>", str(markupsafe.escape(text))))


def symbols(text):
    """Units in sentences of the program as one writes them."""
    return re.sub(r"([\d\])] ?)um\b", "\\1µm", text)


def render(r):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters.update(percent=rounding.percent, fixed=rounding.fixed, subscripts=subscripts, thousands=rounding.thousands, unit_text=rounding.unit_text, after=rounding.after,
                               symbols=symbols,
                               verdicts=studies.sobol_verdict)
    template, contents = ("choice.html.j2", choice_page.contents(r)) if r.choice else \
        ("trace.html.j2", trace_page.contents(r)) if r.trace else \
        ("volume.html.j2", volume_page.contents(r)) if r.volume else ("run.html.j2", run_page.contents(r))
    return environment.get_template(template).render(
        r=r, question=question(r.scenario_text), p=rounding.probability(r.coverage_probability), **measurement(r), **contents,
        css=markupsafe.Markup((HERE / "style.css").read_text(encoding="utf-8")))
