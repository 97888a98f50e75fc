"""The report: one page that loads nothing, makes the browser complain about nothing, and prints."""
import base64
import csv
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
import zipfile
import io
import math
from xml.etree import ElementTree

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
GUMSHOE = sys.argv.pop(1)
MADE = pathlib.Path(GUMSHOE).resolve().parent / "tests/gumshoe_made_result"
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from browser import CLIPPED, CONTRAST, browser, filled_pages, measured
from sealed import changed
from gumshoe_report import certificate, convergence, explain, mathml, page, read, reduce, scatter, tables, workbook


class Resources(html.parser.HTMLParser):
    """What a browser would load: src, href of anything but links in the text, data, poster ..."""

    def __init__(self):
        super().__init__()
        self.found, self.tags, self.ids = [], [], []

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        for name, value in attributes:
            if name == "id":
                self.ids.append(value)
            if name in ("src", "srcset", "data", "poster", "action") or (name.endswith("href") and tag != "a"):
                self.found.append(value)


def squeezed(text):
    """Without spaces of any kind, hyphens told from minus signs: line breaks differ on paper."""
    return re.sub(r"\s+", "", text.replace("\u2212", "-"))


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.result = cls.folder / "rod.h5"
        subprocess.run([GUMSHOE, "run", "scenarios/rod_gauging.toml", "--samples", "20000", "--out", cls.result],
                       cwd=ROOT, check=True, capture_output=True)
        subprocess.run([GUMSHOE, "report", cls.result], cwd=ROOT, check=True, capture_output=True)
        cls.page = cls.folder / "rod.html"
        cls.text = cls.page.read_text(encoding="utf-8")
        with h5py.File(cls.result) as file:
            cls.statements = [s.decode() for s in file["summary/statement"][()]]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_nothing_is_loaded(self):
        resources = Resources()
        resources.feed(self.text)
        self.assertNotIn("script", resources.tags)
        self.assertIn("svg", resources.tags)
        outside = [r for r in resources.found if not r.startswith(("#", "data:"))]
        self.assertEqual(outside, [])
        self.assertNotRegex(self.text, r"url\((?!#)")
        self.assertNotIn("@import", self.text)
        self.assertEqual(len(resources.ids), len(set(resources.ids)), "identifiers clash")

    def test_browser_has_no_complaint(self):
        picture = self.folder / "page.png"
        run = browser(f"--screenshot={picture}", "--window-size=1100,2000", self.page.as_uri())
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertGreater(picture.stat().st_size, 20000)  # an empty page of this size packs to less
        self.assertNotIn("CONSOLE", run.stderr)

    def test_complaints_would_be_seen(self):
        broken = self.folder / "broken.html"
        broken.write_text("<title>x</title><script>console.error('broken')</script>")
        run = browser(f"--screenshot={self.folder / 'broken.png'}", broken.as_uri())
        self.assertIn("CONSOLE", run.stderr)

    def test_the_answer_comes_first_and_how_it_was_made_last(self):
        headings = re.findall(r"<h[23]>([^<]*)", self.text)
        first = [h for k, h in enumerate(headings) if h not in headings[:k]]
        wanted = ["Result", "Uncertainty budget", "What would reduce it", "Distribution", "Sensitivity: what the variance comes from",
                  "Several measurands together", "Validation of the GUM framework", "How many trials", "How to reproduce these numbers"]
        self.assertEqual([h for h in first if h in wanted], wanted)

    def test_pages_fit_every_width_and_light(self):
        for width in (1000, 600):
            self.assertEqual(measured(self.page, CLIPPED, width), [], "clipped labels")
        self.assertLessEqual(measured(self.page, "return document.documentElement.scrollWidth", 600), 600)
        wide = "return [...document.querySelectorAll('.equation')].map(e => e.scrollWidth - e.clientWidth)"
        self.assertEqual(measured(self.page, wide), [0, 0])  # no equation is cut
        seen = measured(self.page, """
            const cells = [...document.querySelectorAll('.budget tbody tr:first-child td.share')];
            return cells.map(c => c.getBoundingClientRect().right);""", 600)
        self.assertTrue(seen and max(seen) <= 600, seen)  # contributions and shares stand beside their quantity
        for dark in (False, True):
            found = measured(self.page, CONTRAST, dark=dark)
            self.assertEqual(found["dark"], dark)
            self.assertGreater(found["least"], 4.5)  # WCAG 2.1, level AA

    def test_clipped_labels_would_be_seen(self):
        broken = self.folder / "cut.html"
        broken.write_text('<body><svg width="50" height="20"><text x="30" y="10">too long</text></svg></body>')
        self.assertEqual(measured(broken, CLIPPED), ["too long"])

    def test_no_printed_page_is_half_empty(self):
        shares = filled_pages(self.page)
        self.assertGreater(min(shares[:-1]), 0.5, shares)
        self.assertGreater(shares[-1], 0.02, shares)

    def test_headings_of_columns_have_a_scope(self):
        heads = re.findall(r"<thead>(.*?)</thead>", self.text, re.S)
        self.assertTrue(heads)
        for head in heads:
            for tag, inside in re.findall(r"<th\b([^>]*)>(.*?)</th>", head, re.S):
                self.assertRegex(tag, r'scope="col(group)?"')
                self.assertTrue(inside.strip())
        for row in re.findall(r"<tbody>.*?</tbody>", self.text, re.S):
            self.assertNotRegex(row, r'<th(?![^>]*scope="row")[ >]')

    def test_picture_shows_the_scenarios_values(self):
        picture = self.text[self.text.index('class="picture"'):]
        picture = picture[:picture.index("</svg>")]
        for words in ("beam pitch 0.2836°", "rod length 179.822", "trigger fraction 0.500", "bottom height 0.11"):
            self.assertIn(words, picture)
        self.assertLess(self.text.index('class="picture"'), self.text.index("<h2>Result</h2>"))

    def test_equations_are_typeset(self):
        maths = re.findall(r"<math.*?</math>", self.text, re.S)
        self.assertEqual(len(maths), 2)
        self.assertEqual(re.sub("<[^>]+>", "", maths[0]), "laserz=spindlez−rod\u00a0length−bottom\u00a0height")

    def test_what_does_not_exist_is_not_drawn(self):
        ends = ("symmetric_low", "symmetric_high", "shortest_low", "shortest_high")  # none with too few trials
        for absent in (ends, (*ends, "estimate", "standard_uncertainty"), ("estimate",), ("standard_uncertainty",)):
            few = self.folder / "few.h5"
            shutil.copy(self.result, few)
            with changed(few) as file:
                for name in absent:
                    file[f"summary/{name}"][()] = math.nan
            run = subprocess.run([GUMSHOE, "report", few], cwd=ROOT, capture_output=True, text=True)
            self.assertEqual((run.returncode, run.stderr), (0, ""), absent)
            words = re.sub(r"<[^>]+>", " ", few.with_suffix(".html").read_text(encoding="utf-8"))
            self.assertFalse({"nan", "inf"} & set(re.split(r"\W+", words)))

    def test_budget_can_be_taken_away(self):
        links = dict(re.findall(r'download="rod_(budget\.\w+)" href="data:[^;]*;base64,([^"]*)"', self.text))
        self.assertEqual(base64.b64decode(links["budget.csv"]), (self.folder / "rod_budget.csv").read_bytes())
        self.assertEqual(base64.b64decode(links["budget.xlsx"]), (self.folder / "rod_budget.xlsx").read_bytes())

    def test_prints_the_result(self):
        pdf = self.folder / "page.pdf"
        run = browser("--no-pdf-header-footer", f"--print-to-pdf={pdf}", self.page.as_uri())
        self.assertEqual(run.returncode, 0, run.stderr)
        information = subprocess.run(["pdfinfo", pdf], check=True, capture_output=True, text=True).stdout
        self.assertGreaterEqual(int(re.search(r"Pages:\s+(\d+)", information).group(1)), 1)
        self.assertIn("A4", information)
        printed = squeezed(subprocess.run(["pdftotext", pdf, "-"], check=True, capture_output=True, text=True).stdout)
        self.assertTrue(self.statements and self.statements[0])
        self.assertIn(squeezed(self.statements[0]), printed)
        self.assertNotIn("budget.xlsx", printed)  # paper has no links

    def test_tables_have_all_digits(self):
        with open(self.folder / "rod_summary.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        with h5py.File(self.result) as file:
            summary = file["summary"]
            self.assertEqual(len(rows), len(summary["estimate"]))
            for k, row in enumerate(rows):
                shown = summary["estimate"][k] * summary["display_factor"][k] + summary["display_offset"][k]
                self.assertEqual(float(row["estimate"]), shown)
                self.assertEqual(row["unit"], summary["display_units"][k].decode())

    def test_what_is_no_result_is_refused(self):
        letter = self.folder / "letter.h5"
        letter.write_text("no result")
        for path in (letter, self.folder / "missing.h5", self.folder):
            run = subprocess.run([GUMSHOE, "report", path], cwd=ROOT, capture_output=True, text=True)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn("error:", run.stderr)
            self.assertNotIn("Traceback", run.stderr)


class EveryStudy(unittest.TestCase):
    """A made-up result with all groups; its numbers are those of tests/made/full_results.cpp."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.result = cls.folder / "full.h5"
        subprocess.run([MADE, cls.result], check=True)
        subprocess.run([GUMSHOE, "report", cls.result], cwd=ROOT, check=True, capture_output=True)
        cls.page = cls.folder / "full.html"
        cls.text = cls.page.read_text(encoding="utf-8")
        cls.words = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", cls.text))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def table(self, name):
        with open(self.folder / f"full_{name}.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_every_section_is_there(self):
        for heading in ("Conformity", "Several measurands together", "Angles on the circle", "Second order", "Shapley effects",
                        "From the stored samples alone", "Screening by elementary effects", "Derivative-based bounds",
                        "What would reach the target", "One at a time: each error given",
                        "How many trials"):
            self.assertIn(heading, self.words)
        for label in ("Tornado plot of the budget and Sobol' indices of height",
                      "Tornado plot of the budget and Shapley effects of runout", "Morris screening of height",
                      "Joint coverage regions of height, runout:", "Distribution of runout with tolerance"):
            self.assertIn(f'aria-label="{label}', self.text)

    def test_identifiers_do_not_clash_and_nothing_is_loaded(self):
        resources = Resources()
        resources.feed(self.text)
        self.assertEqual(len(resources.ids), len(set(resources.ids)), "identifiers clash")
        self.assertEqual([r for r in resources.found if not r.startswith(("#", "data:"))], [])
        self.assertNotIn("script", resources.tags)
        self.assertFalse({"nan", "inf"} & set(re.split(r"\W+", self.words)))

    def test_browser_has_no_complaint(self):
        run = browser(f"--screenshot={self.folder / 'page.png'}", "--window-size=1100,2000", self.page.as_uri())
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertNotIn("CONSOLE", run.stderr)

    def test_risks_stand_beside_their_definitions(self):
        self.assertRegex(self.text, r"conformance probability p<sub>c</sub></th><td[^>]*>\(99.78 ± 0.18\)\W%</td><td>the "
                                    r"probability, given this measurement")
        self.assertRegex(self.text, r"global producer’s risk R<sub>P</sub></th><td[^>]*>\(15.10 ± 0.10\)\W%</td><td>the "
                                    r"probability that an item of the process conforms and is rejected")
        self.assertIn('accepted</span>', self.text)
        self.assertIn('rejected</span>', self.text)

    def test_numbers_are_rounded_by_the_gum(self):
        self.assertIn("2.448 <span", self.text)  # k_p = 2.4477 with a standard error of 0.011
        self.assertRegex(self.text, r"<td class=\"n\">171</td><td class=\"n\">11</td>")  # circular, u to two digits
        self.assertIn("U = 0.0041\u202fmm must be reduced to 0.0030\u202fmm", self.text)

    def test_heavy_tails_are_prominent(self):
        banner = self.text.index('class="warning banner">no standard uncertainty: Hill')
        self.assertLess(banner, self.text.index("What to know"))
        self.assertIn("heavy tails, Hill", self.text)

    def test_csv_has_every_study_in_display_units(self):
        shares = [float(row["effect"]) for row in self.table("shapley")]
        self.assertAlmostEqual(sum(shares), 1)
        conformity = self.table("conformity")[0]
        self.assertAlmostEqual(float(conformity["upper"]), 12.3516)
        self.assertAlmostEqual(float(conformity["guard_band"]), 0.003)
        joint = {(r["region"], r["a"], r["b"]): r for r in self.table("joint")}
        self.assertAlmostEqual(float(joint["0", "height", "runout"]["covariance"]), -0.55 * 0.0021 * 1.7)  # mm um
        steps = {(r["quantity"], r["output"]): r for r in self.table("one_at_a_time")}
        self.assertAlmostEqual(float(steps["runout_x", "runout"]["up"]), 92)
        self.assertAlmostEqual(float(steps["rod_length", "height"]["down"]), -0.1)
        self.assertAlmostEqual(float(self.table("morris")[3]["mean_absolute"]), 0.0016)
        for name in ("sensitivity_pairs", "given_data", "dgsm", "circular", "target"):
            self.assertTrue(self.table(name), name)

    def test_older_files_and_files_without_studies_still_work(self):
        older = self.folder / "older.h5"
        shutil.copy(self.result, older)
        with changed(older) as file:
            for name in ("shapley", "given_data", "morris", "dgsm", "one_at_a_time", "joint", "circular", "conformity",
                         "target", "stopping"):
                del file[name]
            study = file["sensitivity/000"]
            del study["pairs"], study.attrs["confidence"], file["summary/tail_remark"]
            study.move("first_verdict", "verdict")  # one verdict for both
            del study["total_verdict"]
            for budget in file["budget"].values():
                del budget.attrs["remark"]
        run = subprocess.run([GUMSHOE, "report", older], cwd=ROOT, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        text = (self.folder / "older.html").read_text(encoding="utf-8")
        self.assertIn("Tornado plot", text)
        for absent in ("Conformity", "Several measurands", "Morris", "How many trials"):
            self.assertNotIn(absent, text)
        with changed(older) as file:
            del file["sensitivity"], file["budget"]
        run = subprocess.run([GUMSHOE, "report", older], cwd=ROOT, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_studies_without_a_single_number_still_make_a_page(self):
        empty = self.folder / "empty.h5"
        shutil.copy(self.result, empty)

        def forget(name, item):
            if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and not name.endswith(("factor", "offset")):
                item[...] = float("nan")
            for key, value in item.attrs.items():
                if isinstance(value, float) and not key.endswith(("factor", "offset", "confidence", "probability")):
                    item.attrs[key] = float("nan")

        with changed(empty) as file:
            for name in ("sensitivity", "shapley", "given_data", "morris", "dgsm", "one_at_a_time", "joint", "circular",
                         "conformity", "target", "stopping"):
                file[name].visititems(forget)
        run = subprocess.run([GUMSHOE, "report", empty], cwd=ROOT, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, "")
        words = re.sub(r"<[^>]+>", " ", (self.folder / "empty.html").read_text(encoding="utf-8"))
        self.assertFalse({"nan", "inf"} & set(re.split(r"\W+", words)))
        self.assertNotIn("Budget and", words)  # nothing to compare

    def test_printed_text_and_json_have_the_studies(self):
        text = subprocess.run([MADE, "--text"], check=True, capture_output=True, text=True).stdout
        for words in ("ellipsoid k_p = 2.448, rectangle k_q = 2.212", "height: accepted", "runout: rejected",
                      "global producer's risk 15.1 %", "beam_pitch 0.576", "Shapley effects of runout",
                      "u of beam_pitch 0.11 deg", "640000 trials"):
            self.assertIn(words, text)
        made = {o["output"]: o for o in
                json.loads(subprocess.run([MADE, "--json"], check=True, capture_output=True, text=True).stdout)}
        self.assertAlmostEqual(made["height"]["sobol"]["beam_pitch"]["total"]["value"], 0.576)
        self.assertAlmostEqual(made["height"]["targets"][0]["quantities"]["beam_pitch"]["allowed"], 0.11)
        self.assertEqual(made["height"]["targets"][0]["quantities"]["beam_pitch"]["allowed_gum"], "any")
        self.assertAlmostEqual(made["runout"]["joint"][0]["correlation"]["height"], -0.55)
        self.assertIsNone(made["runout"]["conformity"][0]["lower"])
        self.assertNotIn("sobol", made["loss"])


def renamed(thing, names):
    """The same result with other names of outputs and inputs."""
    if isinstance(thing, types.SimpleNamespace):
        return types.SimpleNamespace(**{key: renamed(value, names) for key, value in vars(thing).items()})
    if isinstance(thing, list):
        return [renamed(item, names) for item in thing]
    return names.get(thing, thing) if isinstance(thing, str) else thing


class LongNames(unittest.TestCase):
    def test_no_label_is_clipped(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            subprocess.run([MADE, folder / "full.h5"], check=True)
            result = read.result(folder / "full.h5")
            long = {"height": "height_of_the_lower_face[rod standard of laboratory 12, setup 3 after lunch, spindle warm]",
                    "runout": "runout_of_the_tool_holder_with_its_shank[holder 4711, clamped anew for every reading]",
                    "beam_pitch": "pitch_of_the_beam_against_the_machine[after alignment with the long rod, setup 12]"}
            (folder / "long.html").write_text(page.render(renamed(result, long)), encoding="utf-8")
            self.assertEqual(measured(folder / "long.html", CLIPPED), [])


class Workbook(unittest.TestCase):
    """The budget as Office Open XML, read again without the writer."""

    NAMES = {"m": workbook.MAIN, "r": workbook.OFFICE}

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        path = pathlib.Path(cls.temporary.name) / "full.h5"
        subprocess.run([MADE, path], check=True)
        cls.result = read.result(path)
        cls.archive = zipfile.ZipFile(io.BytesIO(workbook.budget(cls.result)))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def sheets(self):
        """{name of the sheet: {"A1": (value, formula)}}, as the relations say."""
        self.assertIsNone(self.archive.testzip())
        parse = lambda name: ElementTree.fromstring(self.archive.read(name))
        types = {e.get("PartName") for e in parse("[Content_Types].xml") if e.get("PartName")}
        self.assertLessEqual(types, {"/" + name for name in self.archive.namelist()})
        targets = {e.get("Id"): e.get("Target") for e in parse("xl/_rels/workbook.xml.rels")}
        found = {}
        for sheet in parse("xl/workbook.xml").iterfind(".//m:sheet", self.NAMES):
            cells = {}
            for c in parse("xl/" + targets[sheet.get(f"{{{workbook.OFFICE}}}id")]).iterfind(".//m:c", self.NAMES):
                text = c.find("m:is/m:t", self.NAMES)
                value = text.text if text is not None else float(c.find("m:v", self.NAMES).text)
                formula = c.find("m:f", self.NAMES)
                cells[c.get("r")] = (value, formula.text if formula is not None else None)
            found[sheet.get("name")] = cells
        return found

    def test_sums_agree_with_the_result(self):
        sheets, checked = self.sheets(), 0
        self.assertEqual(len(sheets), len(self.result.budgets))
        for cells, b in zip(sheets.values(), self.result.budgets):
            self.assertEqual(cells["A1"][0], b.output)
            if not b.applicable:
                continue
            column = {int(at[1:]): value for at, (value, _) in cells.items() if at[0] == "J" and isinstance(value, float)}
            components = [column[k] for k in range(3, 3 + len(b.rows)) if k in column]
            label = {value: int(at[1:]) for at, (value, _) in cells.items() if at[0] == "A"}
            u, k = label["combined standard uncertainty u_c"], label["coverage factor k"]
            U = next(row for text, row in label.items() if text.startswith("expanded uncertainty"))
            self.assertAlmostEqual(column[u], b.combined_standard_uncertainty * b.display_factor)
            if f"J{u}" in cells and cells[f"J{u}"][1]:
                self.assertEqual(cells[f"J{u}"][1], f"SQRT(SUMSQ(J3:J{2 + len(b.rows)}))")
                self.assertAlmostEqual(math.sqrt(sum(x * x for x in components)), column[u], delta=1e-6 * column[u])
                checked += 1
            self.assertEqual(cells[f"J{U}"][1], f"J{k}*J{u}")
            self.assertAlmostEqual(column[U], b.expanded_uncertainty * b.display_factor)
        self.assertTrue(checked)

    def test_names_of_sheets_are_legal_and_unique(self):
        long = "bottom_height[rod standard, setup 1]"
        names = workbook.sheet_names([long, long, "a/b", "A b", ""])
        self.assertEqual(len({n.lower() for n in names}), 5)
        for name in names:
            self.assertRegex(name, r"^[^\[\]:*?/\\']{1,31}$")


class Equations(unittest.TestCase):
    """MathML says what the formula says: parentheses where they are needed and nowhere else."""

    def shown(self, text):
        """The formula in one line: fractions as (a)/(b), powers as a^(b), indices as a_(b)."""
        def walk(e):
            inside = [walk(child) for child in e]
            text = (e.text or "").strip()
            return {"mfrac": lambda: "({})/({})".format(*inside), "msup": lambda: "{}^({})".format(*inside),
                    "msub": lambda: "{}_({})".format(*inside), "msqrt": lambda: f"sqrt({''.join(inside)})",
                    }.get(e.tag, lambda: text + "".join(inside))()
        return walk(ElementTree.fromstring(str(mathml.equation(text)).replace("&#x2061;", "")))

    def test_structure(self):
        for text, shown in (
                ("y = -(a + b)/(c*d) - (e - f)", "y=(−(a+b))/(c·d)−(e−f)"),
                ("y = a - (b + c) + (d + e)", "y=a−(b+c)+d+e"),
                ("y = a*(b + c)*(d*g)", "y=a·(b+c)·d·g"),
                ("y = (a*b)^2 - (-a)^2^x_1", "y=(a·b)^(2)−(−a)^(2^(x_(1)))"),
                ("y = a/b/c", "y=((a)/(b))/(c)"),
                ("growth = alpha*length*sqrt(abs(t_0 - t))", "growth=α·length·sqrt(|t_(0)−t|)"),
                ("E_X0B = 2.5e-6*f(x, y)", "E_(X0B)=2.5·10^(−6)·f(x,y)")):
            self.assertEqual(self.shown(text), shown, text)

    def test_what_cannot_be_read_stays_as_it_is_written(self):
        self.assertEqual(mathml.equation("y = (a < b"), "<code>y = (a &lt; b</code>")


class Question(unittest.TestCase):
    def test_first_sentence_of_the_question_only(self):
        for text, asked in (
                ("# Question: how well? \n#:schema s.json\n#\n# The study of X, section 4.\nschema = 1", "How well?"),
                ("# Question: how well do 3.5 mm rods,\n# e.g. steel ones, gauge it? The tool of Y.\n", "How well do 3.5 mm rods, e.g. steel ones, gauge it?"),
                ("# Copyright A. B. Smith\n#\n# question: which?\n", "Which?"),
                ("# Two rods, compared. Nothing else.\n", "Two rods, compared."),
                ("schema = 1\n# Question: no\n", "")):
            self.assertEqual(page.question(text), asked)


class Coefficients(unittest.TestCase):
    def test_units_are_those_that_people_write(self):
        def unit(output, si_output, factor, of, si, by, slope):
            b = types.SimpleNamespace(display_units=output, units=si_output, display_factor=factor)
            c = types.SimpleNamespace(display_units=of, units=si, display_factor=by, sensitivity=slope)
            value, written = tables.coefficient(b, c)
            return float(f"{value:.6g}"), written
        degree = 180 / math.pi
        self.assertEqual(unit("mm", "m", 1e3, "deg", "rad", degree, 5e-3), (87.2665, "um/deg"))  # 5 mm times pi / 180
        self.assertEqual(unit("mm", "m", 1e3, "um", "m", 1e6, -1.0), (-1.0, "1"))
        self.assertEqual(unit("mm", "m", 1e3, "1", "1", 1.0, 0.3), (300.0, "mm"))
        self.assertEqual(unit("mm", "m", 1e3, "um/m/K", "1/K", 1e6, 0.04), (0.04, "um/(um/m/K)"))


class Reduce(unittest.TestCase):
    def budget(self, shares, **more):
        rows = [types.SimpleNamespace(name=n, quantity=n, share=s, monte_carlo_share=math.nan, evaluation=e, source="x")
                for n, s, e in shares]
        return types.SimpleNamespace(**{**dict(rows=rows, applicable=1, correlation_share=0.0, display_units="um", display_factor=1e6,
                                     combined_standard_uncertainty=10e-6), **more})

    def test_what_is_left_without_a_quantity(self):
        found = reduce.table(self.budget([("a", 0.64, "A"), ("b", 0.36, "B")]), 10e-6)
        first, second = found.rows
        # u without a: 10 sqrt(0.36) = 6.0; with half of u(a): 10 sqrt(1 - 0.75 0.64) = 7.2; without b: 8.0
        self.assertEqual((first.name, first.exact, first.half, second.exact), ("a", "6.0", "7.2", "8.0"))
        self.assertIn("observations", first.how)
        self.assertIn("source", second.how)

    def test_correlated_inputs_have_no_such_table(self):
        self.assertEqual(reduce.table(self.budget([("a", 0.6, "A")], correlation_share=0.4), 10e-6).rows, [])

    def test_without_the_law_indices_decide(self):
        indices = types.SimpleNamespace(rows=[types.SimpleNamespace(input="a", first=0.19, total=0.2),
                                              types.SimpleNamespace(input="b", first=0.75, total=0.76)])
        wrong = reduce.table(self.budget([("a", 0.9, "B"), ("b", 0.1, "B")]), 20e-6, indices)  # the law sees no kink
        self.assertEqual([(r.name, r.exact) for r in wrong.rows], [("b", "10"), ("a", "18")])
        found = reduce.table(self.budget([("a", math.nan, "B"), ("b", math.nan, "B")], applicable=0), 20e-6, indices)
        self.assertEqual([(r.name, r.exact) for r in found.rows], [("b", "10"), ("a", "18")])


class Certificate(unittest.TestCase):
    def test_signs_that_people_write(self):
        self.assertEqual(certificate.typeset("z[rod-2] = (-1.20 +- 0.03) um, k = 1.96, 95 %"),
                         "z[rod-2] = (−1.20 ± 0.03) µm, k = 1.96, 95 %")

    def test_of_a_validated_budget(self):
        o = types.SimpleNamespace(name="L")
        b = types.SimpleNamespace(applicable=1, expanded_uncertainty=99e-9, estimate=10.0033871e-3, display_units="mm",
                                  display_factor=1e3, display_offset=0.0, effective_degrees_of_freedom=math.inf, coverage_factor=1.96)
        v = types.SimpleNamespace(verdict="validated")
        self.assertEqual(certificate.line(o, b, v, 0.95).replace("\u202f", " "), "L = (10.003387 ± 0.000099) mm, k = 1.96, 95 %")
        v.verdict = "not validated"
        self.assertEqual(certificate.line(o, b, v, 0.95), "")


class Scatter(unittest.TestCase):
    """y = 3 a + b squared in um, c moves nothing: which inputs are drawn, and that a curve counts as a line does."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.path = pathlib.Path(temporary.name) / "draws.h5"
        a, b, c = x = np.random.default_rng(7).normal(size=(3, 4000))
        y = 1e-6 * (3 * a + b ** 2)
        with h5py.File(self.path, "w") as file:
            file["outputs/y"] = [np.where(np.arange(4000) % 9, y, math.nan)]  # failed samples have no value
            group = file.create_group("draws")
            for name, texts in (("component", "abc"), ("display_units", ["um"] * 3)):
                group.create_dataset(name, data=list(texts), dtype=h5py.string_dtype())
            group["display_factor"], group["deviation"] = [1e6] * 3, 1e-6 * x
        self.output = types.SimpleNamespace(
            name="y", measurand="y", reading=0, estimate=1e-6, standard_uncertainty=math.sqrt(11) * 1e-6, symmetric_low=-5e-6,
            symmetric_high=8e-6, shortest_low=-5e-6, shortest_high=8e-6, histogram_edges=np.zeros(0), display_units="um",
            display_factor=1e6, display_offset=0.0)

    def test_what_moves_the_measurand_is_drawn(self):
        drawn = scatter.figure(self.path, self.output, None, "x")
        labels = re.findall(r"<text[^>]*>([^<]*)</text>", drawn)
        self.assertEqual([label for label in labels if label in ("a, µm", "b, µm", "c, µm")], ["a, µm", "b, µm"])

    def test_shares_that_bins_explain(self):
        y, known = scatter.draws(self.path, self.output)
        self.assertTrue(np.isfinite(y).all())
        a, b, c = (scatter.explained(d.x, y) for d in known)
        # Var y = 9 + 2; bins lose little of a's 9 / 11 and of b's 2 / 11.
        self.assertAlmostEqual(a, 9 / 11, delta=0.05)
        self.assertAlmostEqual(b, 2 / 11, delta=0.05)
        self.assertLess(c, scatter.VISIBLE)

    def test_without_draws_there_is_no_figure(self):
        with h5py.File(self.path, "a") as file:
            del file["draws"]
        self.assertEqual(scatter.figure(self.path, self.output, None, "x"), "")


class Convergence(unittest.TestCase):
    def test_running_figures(self):
        x = 1e6 + np.random.default_rng(1).normal(size=5000)  # far from zero: no cancellation
        counts, mean, spread, ends = convergence.track(x, 0.9)
        self.assertEqual((counts[0], counts[-1]), (100, 5000))
        for k in (0, 7, -1):
            first = x[:counts[k]]
            self.assertAlmostEqual(mean[k], first.mean(), places=6)
            self.assertAlmostEqual(spread[k], first.std(ddof=1), places=6)
            np.testing.assert_allclose(ends[k], np.quantile(first, [0.05, 0.95]))


CURVE = """schema = 1
[model]
name = "tool_length"
evaluation = "characteristic_curve"
[conditions]
spindle_speed = "1000 rpm"
feed = "30 mm/min"
start_angle = {{ spread = ["0 deg", "360 deg"], readings = 8 }}
start_height = "5 mm"
[quantities]
offset = {{ value = "4.9 mm", u = "0.02 mm" }}
[indications.spindle_z]
readings = [{}]
components = [ {{ u = "0.5 um", per = "reading" }} ]
[run]
samples = 100
"""


class Curve(unittest.TestCase):
    """Many outputs from all readings together: some never vary, some are numbered by flute."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.temporary.name)
        table = "spindle_speed (rpm),feed (mm/min),start_height (mm),offset (mm),start_angle (deg)\n"
        (folder / "curve.csv").write_text(table + "".join(f"1000,30,5,4.9,{45 * k}\n" for k in range(8)))
        seen = subprocess.run([GUMSHOE, "evaluate", "tool_length", "--table", folder / "curve.csv"], check=True,
                              capture_output=True, text=True).stdout
        heights = [row["spindle_z (mm)"] for row in csv.DictReader(seen.splitlines())]
        (folder / "curve.toml").write_text(CURVE.format(", ".join(f'"{z} mm"' for z in heights)))
        for words in (("run", folder / "curve.toml", "--out", folder / "curve.h5"), ("report", folder / "curve.h5")):
            subprocess.run([GUMSHOE, *words], cwd=ROOT, check=True, capture_output=True)
        cls.text = (folder / "curve.html").read_text(encoding="utf-8")
        with open(folder / "curve_summary.csv", encoding="utf-8") as file:
            cls.summary = {row["output"]: row for row in csv.DictReader(file)}

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_what_never_varies_is_one_line_and_no_distribution(self):
        lines = [re.search(f"{words}: ([^<]*)", self.text)[1].rstrip(".")
                 for words in ("Constant in all samples", "How the evaluation went")]  # measurands, diagnostics
        line = "; ".join(lines)
        still = {name for name, row in self.summary.items() if float(row["standard_uncertainty"]) == 0}
        self.assertIn("degrees_of_freedom", still)
        self.assertEqual({item.split(" = ")[0] for item in line.split("; ")}, still)
        self.assertIn("degrees_of_freedom = 5", line)  # eight readings less two flutes less the phase
        for name in still:
            self.assertFalse(f"<h2>{name}</h2>" in self.text or f'<span class="symbol">{name}</span>' in self.text, name)
        self.assertTrue("<h2>tool_length</h2>" in self.text)

    def test_flutes_stand_side_by_side(self):
        table = self.text[self.text.index("One by one"):]
        table = table[:table.index("</table>")]
        rows = re.findall(r'<tr><th scope="row">(\d+)</th>(.*?)</tr>', table)
        self.assertEqual([number for number, _ in rows], ["1", "2"])
        for number, cells in rows:
            values = re.findall(r'strong">([^<]*)<', cells)
            length = float(self.summary[f"flute_length_{number}"]["estimate"])
            self.assertAlmostEqual(float(values[0].replace("\u2212", "-")), length, delta=1e-4)
            self.assertEqual(float(values[2]), float(self.summary[f"seen_{number}"]["estimate"]))


class WhyTheyDiffer(unittest.TestCase):
    """The sentence follows its rules (reports/README.md): each reason alone gives its own words and no other."""

    WORDS = {"flat": "the slope c_i is zero", "kink": "kink", "together": "act together", "tails": "s/√n",
             "correlated": "inputs are correlated"}

    def sentence(self, row=None, first=0.5, total=0.5, correlation=0.0, u=1.0):
        """Two inputs that share the variance evenly, one of them changed."""
        row = {"name": "a", "share": 0.5, "sensitivity": 1.0, "differentiable": 1, "distribution": "normal",
               "degrees_of_freedom": 0.0, **(row or {})}
        other = {**row, "name": "b", "share": 0.5, "sensitivity": 1.0, "differentiable": 1, "distribution": "normal"}
        budget = types.SimpleNamespace(rows=[types.SimpleNamespace(**r) for r in (row, other)], applicable=True,
                                       correlation_share=correlation, combined_standard_uncertainty=1.0)
        indices = types.SimpleNamespace(rows=[
            types.SimpleNamespace(input="a", first=first, total=total),
            types.SimpleNamespace(input="b", first=0.5, total=0.5 + (total - first))])
        return explain.why(budget, indices, None, u)

    def reasons(self, sentence):
        return {name for name, words in self.WORDS.items() if words in sentence}

    def test_agreement_is_said(self):
        self.assertIn("agree", self.sentence())
        self.assertEqual(self.reasons(self.sentence()), set())

    def test_each_reason(self):
        none = float("nan")
        self.assertEqual(self.reasons(self.sentence({"share": 0.0, "sensitivity": 0.0})), {"flat"})
        self.assertEqual(self.reasons(self.sentence({"share": none, "sensitivity": none, "differentiable": 0})), {"kink"})
        self.assertEqual(self.reasons(self.sentence(first=0.2)), {"together"})
        self.assertEqual(self.reasons(self.sentence({"distribution": "t", "degrees_of_freedom": 4.0, "share": 0.3})),
                         {"tails"})
        self.assertEqual(self.reasons(self.sentence({"share": 0.3}, correlation=0.2)), {"correlated"})
        self.assertIn("not linear over the range", self.sentence({"share": 0.3}))

    def test_without_a_law_of_propagation_there_is_nothing_to_compare(self):
        none = float("nan")  # as of a virtual experiment
        row = types.SimpleNamespace(name="a", share=none, sensitivity=none, differentiable=1, distribution="normal",
                                    degrees_of_freedom=0.0)
        budget = types.SimpleNamespace(rows=[row], applicable=False, correlation_share=none, combined_standard_uncertainty=none)
        indices = types.SimpleNamespace(rows=[types.SimpleNamespace(input="a", first=0.5, total=1.0)])
        self.assertEqual(explain.why(budget, indices, None, 1.0), "")

    def test_size_of_the_difference(self):
        self.assertIn("most for a (0.20)", self.sentence({"share": 0.3}))
        self.assertIn("1.41 times u_c", self.sentence({"share": 0.3}, u=1.41))


if __name__ == "__main__":
    unittest.main()
