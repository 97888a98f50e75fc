"""The budgets as a workbook (Office Open XML, ECMA-376): a sheet per output, whose sums are formulas."""
import io
import math
import re
import zipfile
from xml.sax.saxutils import escape, quoteattr

from .explain import independent
from .rounding import decimals, probability
from .tables import coefficient, point, spread

TYPES = "application/vnd.openxmlformats-officedocument.spreadsheetml"
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
HEAD = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
MOST_DECIMALS = 12
BOLD, PERCENT, DECIMALS = 1, 2, 3  # styles; from DECIMALS on with 0, 1, 2, ... decimal places
FORMATS = "".join(f'<numFmt numFmtId="{164 + k}" formatCode="0{"." if k else ""}{"0" * k}"/>' for k in range(MOST_DECIMALS + 1))
STYLES = (f'{HEAD}<styleSheet xmlns="{MAIN}"><numFmts count="{MOST_DECIMALS + 1}">{FORMATS}</numFmts><fonts count="2"><font><sz val="11"/><name val="Calibri"/></font>'
          '<font><b/><sz val="11"/><name val="Calibri"/></font></fonts><fills count="2"><fill><patternFill '
          'patternType="none"/></fill><fill><patternFill patternType="gray125"/></fill></fills><borders count="1"><border/>'
          '</borders><cellStyleXfs count="1"><xf/></cellStyleXfs>'
          f'<cellXfs count="{DECIMALS + MOST_DECIMALS + 1}"><xf/><xf fontId="1" applyFont="1"/>'
          '<xf numFmtId="10" applyNumberFormat="1"/>'
          + "".join(f'<xf numFmtId="{164 + k}" applyNumberFormat="1"/>' for k in range(MOST_DECIMALS + 1)) +
          '</cellXfs><cellStyles count="1"><cellStyle name="Normal" '
          'xfId="0" builtinId="0"/></cellStyles></styleSheet>')
SHEETS = 100  # outputs with a sheet of their own; more share one
COLUMNS = ("quantity", "estimate", "u", "unit", "type", "distribution", "degrees of freedom", "c", "unit of c", "|c| u",
           "unit of |c| u", "share", "share, Monte Carlo", "scope", "source")


class Formula:
    """A formula and the value that a reader without a calculator sees."""

    def __init__(self, text, value):
        self.text, self.value = text, value


def letters(column):
    text = ""
    while column >= 0:
        text, column = chr(65 + column % 26) + text, column // 26 - 1
    return text


def cell(value, row, column, style=0):
    if value is None or value == "" or isinstance(value, float) and not math.isfinite(value):
        value = "infinite" if value == math.inf else ""
        if not value:
            return ""
    at = f'r="{letters(column)}{row}"' + (f' s="{style}"' if style else "")
    if isinstance(value, Formula):
        return f"<c {at}><f>{escape(value.text)}</f><v>{value.value!r}</v></c>" if math.isfinite(value.value) else ""
    if isinstance(value, (int, float)):
        return f"<c {at}><v>{value!r}</v></c>"
    text = re.sub("[\x00-\x08\x0b\x0c\x0e-\x1f]", "", str(value))
    return f'<c {at} t="inlineStr"><is><t xml:space="preserve">{escape(text)}</t></is></c>'


def sheet(rows):
    """`rows`: lists of values or (value, style)."""
    lines = []
    for k, values in enumerate(rows, 1):
        cells = [cell(*((v, k, c) if not isinstance(v, tuple) else (v[0], k, c, v[1]))) for c, v in enumerate(values)]
        lines.append(f'<row r="{k}">{"".join(cells)}</row>')
    return (f'{HEAD}<worksheet xmlns="{MAIN}"><cols><col min="1" max="1" width="30" customWidth="1"/>'
            f'<col min="2" max="13" width="14" customWidth="1"/><col min="14" max="15" width="32" customWidth="1"/></cols>'
            f'<sheetData>{"".join(lines)}</sheetData></worksheet>')


def component_row(b, c):
    value, unit = coefficient(b, c)
    return [c.name, point(c, c.estimate), spread(c, c.standard_uncertainty), c.display_units, c.evaluation,
            c.distribution, c.degrees_of_freedom or math.inf, value, unit, spread(b, c.contribution), b.display_units,
            (c.share, PERCENT), (c.monte_carlo_share, PERCENT), c.scope, c.source]


def rounded(value, u):
    """A cell with as many decimal places as two digits of u need; all digits stay in the file."""
    places = decimals(u)
    return (value, DECIMALS + max(0, places)) if places is not None and places <= MOST_DECIMALS else value


def shown_row(b, c):
    """A component as people read it: estimate and u to two digits of u, the contribution to two digits."""
    row = component_row(b, c)
    u, contribution = row[2], row[9]
    return [row[0], rounded(row[1], u), rounded(u, u), *row[3:7], rounded(row[7], abs(row[7]) / 10), row[8],
            rounded(contribution, contribution), *row[10:]]


def stated_result(o, p):
    """What the result states of an output, by the samples or, where it is validated, by the GUM framework."""
    if o is None:
        return []
    u, U = spread(o, o.standard_uncertainty), spread(o, getattr(o, "expanded_uncertainty", math.nan))
    line = lambda name, value, size=u, unit=o.display_units: [(f"stated result: {name}", BOLD), *[""] * 8, rounded(value, size), unit]
    interval = f"{probability(p)} interval".replace("\u202f", " ")
    return [[], line("estimate", point(o, o.estimate)), line("standard uncertainty u", u), line("expanded uncertainty U", U, U),
            line("coverage factor k", getattr(o, "coverage_factor", math.nan), 0.1, ""),
            *(line(f"{kind} {interval}, {end} end", point(o, getattr(o, f"{kind}_{key}"))) for kind in ("symmetric", "shortest")
              for key, end in (("low", "lower"), ("high", "upper")))]


def all_results(outputs, p):
    """The stated results of many outputs in one table."""
    return [[(name, BOLD) for name in ("output", "estimate", "u", f"U, {probability(p)}".replace("\u202f", " "), "k", "symmetric, lower end",
                                       "symmetric, upper end", "unit")]] + [
        [o.name, point(o, o.estimate), spread(o, o.standard_uncertainty), spread(o, getattr(o, "expanded_uncertainty", math.nan)),
         getattr(o, "coverage_factor", math.nan), point(o, o.symmetric_low), point(o, o.symmetric_high), o.display_units] for o in outputs]


def all_rows(budgets):
    """Many budgets in one table."""
    return [[(name, BOLD) for name in ("output", *COLUMNS)]] + [[b.output, *shown_row(b, c)] for b in budgets for c in b.rows]


def budget_rows(b, p, verdict=None, output=None):
    """The budget in the output's unit. u_c is a formula over the contributions, unless inputs are correlated.
    verdict: of the validation by Monte Carlo; unless it is "validated", the certificate has another U. output: what is stated."""
    rows = [[(b.output, BOLD)], [(name, BOLD) for name in COLUMNS]] + [shown_row(b, c) for c in b.rows]
    if not b.applicable:
        return rows + [[], [f"GUM framework not applicable: {b.reason}"], *stated_result(output, p)]
    last, u, U = len(rows), spread(b, b.combined_standard_uncertainty), spread(b, b.expanded_uncertainty)
    total = Formula(f"SQRT(SUMSQ(J3:J{last}))", u) if independent(b) else u
    row_of_u = last + 2 + (not independent(b))
    below = lambda name, value, unit="": [(name, BOLD), *[""] * 8, value, unit]
    return rows + [
        below("estimate y", point(b, b.estimate), b.display_units),
        *([] if independent(b) else [below("correlations", (b.correlation_share, PERCENT))]),
        below("combined standard uncertainty u_c", total, b.display_units),
        below("effective degrees of freedom", b.effective_degrees_of_freedom or math.inf),
        below("coverage factor k", b.coverage_factor),
        below(f"expanded uncertainty U, {probability(p)}".replace("\u202f", " "),
              Formula(f"J{row_of_u + 2}*J{row_of_u}", U), b.display_units),
        *([] if verdict in (None, "validated") else [
            [f"GUM framework: {verdict} by Monte Carlo, whose U and k the result states"]]), *stated_result(output, p)]


def sheet_names(outputs):
    """At most 31 characters, without []:*?/\\, each once."""
    names = []
    for output in outputs:
        name = re.sub(r"[\[\]:*?/\\']", " ", output).strip()[:31] or "budget"
        number = 2
        while name.lower() in (n.lower() for n in names):
            tail = f" {number}"
            name, number = name[:31 - len(tail)] + tail, number + 1
        names.append(name)
    return names


def budget(r):
    """The bytes of the workbook; None of a result without a budget."""
    budgets = [b for b in r.budgets if b.rows]
    if not budgets:
        return None
    verdicts = {v.name: v.verdict for v in r.validations}
    outputs = {o.name: o for o in r.outputs}
    contents = {"budgets": all_rows(budgets), "results": all_results(r.outputs, r.coverage_probability)} if len(budgets) > SHEETS else dict(
        zip(sheet_names([b.output for b in budgets]),
            (budget_rows(b, r.coverage_probability, verdicts.get(b.output), outputs.get(b.output)) for b in budgets)))
    names = list(contents)
    sheets = "".join(f'<sheet name={quoteattr(n)} sheetId="{k}" r:id="rId{k}"/>' for k, n in enumerate(names, 1))
    related = "".join(f'<Relationship Id="rId{k}" Type="{OFFICE}/worksheet" Target="worksheets/sheet{k}.xml"/>'
                      for k in range(1, len(names) + 1))
    parts = "".join(f'<Override PartName="/xl/worksheets/sheet{k}.xml" ContentType="{TYPES}.worksheet+xml"/>'
                    for k in range(1, len(names) + 1))
    files = {
        "[Content_Types].xml": f'{HEAD}<Types xmlns="{PACKAGE}/content-types"><Default Extension="rels" ContentType="application/'
                               f'vnd.openxmlformats-package.relationships+xml"/><Default Extension="xml" ContentType="application/xml"/>'
                               f'<Override PartName="/xl/workbook.xml" ContentType="{TYPES}.sheet.main+xml"/><Override '
                               f'PartName="/xl/styles.xml" ContentType="{TYPES}.styles+xml"/>{parts}</Types>',
        "_rels/.rels": f'{HEAD}<Relationships xmlns="{PACKAGE}/relationships"><Relationship Id="rId1" '
                       f'Type="{OFFICE}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'{HEAD}<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets>{sheets}</sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'{HEAD}<Relationships xmlns="{PACKAGE}/relationships">{related}<Relationship Id="rId'
                                      f'{len(names) + 1}" Type="{OFFICE}/styles" Target="styles.xml"/></Relationships>',
        "xl/styles.xml": STYLES,
        **{f"xl/worksheets/sheet{k}.xml": sheet(rows) for k, rows in enumerate(contents.values(), 1)}}
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), text.encode("utf-8"), zipfile.ZIP_DEFLATED)
    return out.getvalue()
