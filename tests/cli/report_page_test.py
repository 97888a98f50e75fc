"""The report: one page that loads nothing, makes the browser complain about nothing, and prints.

usage: report_page_test.py path/to/gumshoe [unittest options]
"""
import base64
import csv
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import types
import unittest

import h5py

from program import GUMSHOE, ROOT, InOneFolder

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from browser import CLIPPED, CONTRAST, Resources, browser, filled_pages, measured
from gumshoe_report import page, tables
from sealed import changed


def squeezed(text):
    """Without spaces of any kind, hyphens told from minus signs: line breaks differ on paper."""
    return re.sub(r"\s+", "", text.replace("\u2212", "-"))


class Report(InOneFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.result = cls.folder / "rod.h5"
        subprocess.run([GUMSHOE, "run", "scenarios/rod_gauging.toml", "--samples", "20000", "--out", cls.result],
                       cwd=ROOT, check=True, capture_output=True)
        subprocess.run([GUMSHOE, "report", cls.result], cwd=ROOT, check=True, capture_output=True)
        cls.page = cls.folder / "rod.html"
        cls.text = cls.page.read_text(encoding="utf-8")
        with h5py.File(cls.result) as file:
            cls.statements = [s.decode() for s in file["summary/statement"][()]]

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


class Curve(InOneFolder):
    """Many outputs from all readings together: some never vary, some are numbered by flute."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = cls.folder
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

    def test_only_flutes_are_hidden(self):
        """An expression may call its measurands seen_1 and length_1, too."""
        output = lambda name, value: types.SimpleNamespace(name=name, estimate=value, standard_uncertainty=0.1, symmetric_low=value - 0.2,
                                                           symmetric_high=value + 0.2, shortest_low=value, shortest_high=value,
                                                           display_units="1", display_factor=1, display_offset=0)
        outputs = [output(f"{stem}_{k}", 0.5) for stem in ("seen", "length") for k in (1, 2)]
        for model, hidden in (("tool_length", True), ("expression", False)):
            found = tables.numbered(types.SimpleNamespace(model=model, outputs=outputs))
            self.assertEqual((bool(found.hidden), bool(found.flags), len(found.rows)), (hidden, hidden, 2))


class Names(InOneFolder):
    def test_names_that_are_not_utf_8(self):
        folder = os.fsencode(self.folder)
        for name in (b"\xff\xfe", b"caf\xe9"):
            with self.subTest(name):
                stem = os.path.join(folder, name)
                shutil.copy(ROOT / "scenarios/expression.toml", stem + b".toml")
                for words in ([b"run", stem + b".toml", b"--samples", b"1000", b"--out", stem + b".h5"], [b"report", stem + b".h5"]):
                    run = subprocess.run([GUMSHOE, *words], cwd=ROOT, capture_output=True)
                    self.assertEqual(run.returncode, 0, run.stderr)
                self.assertIn(name + b".html", run.stdout)
                page_text = pathlib.Path(os.fsdecode(stem + b".html")).read_bytes().decode("utf-8")
                self.assertIn(name.decode("utf-8", "replace") + ".toml", page_text)
                again = subprocess.run([GUMSHOE, b"report", stem + b".h5"], cwd=ROOT, capture_output=True)
                self.assertEqual(again.returncode, 0, again.stderr)
                shutil.copy(stem + b".h5", self.folder / "plain.h5")
                plain = subprocess.run([GUMSHOE, "report", self.folder / "plain.h5", "--force"], cwd=ROOT, capture_output=True)
                self.assertEqual(plain.returncode, 0, plain.stderr)
        for table in self.folder.glob("*.csv"):
            table.read_bytes().decode("utf-8")


class Question(unittest.TestCase):
    def test_first_sentence_of_the_question_only(self):
        for text, asked in (
                ("# Question: how well? \n#:schema s.json\n#\n# The study of X, section 4.\nschema = 1", "How well?"),
                ("# Question: how well do 3.5 mm rods,\n# e.g. steel ones, gauge it? The tool of Y.\n", "How well do 3.5 mm rods, e.g. steel ones, gauge it?"),
                ("# Copyright A. B. Smith\n#\n# question: which?\n", "Which?"),
                ("# Question: what does it show?\n#     gumshoe trace s.toml\n# Written by hand.\n", "What does it show?"),
                ("# Two rods, compared. Nothing else.\n", "Two rods, compared."),
                ("schema = 1\n# Question: no\n", "")):
            self.assertEqual(page.question(text), asked)


if __name__ == "__main__":
    unittest.main()
