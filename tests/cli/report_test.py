"""The report: one page that loads nothing, makes the browser complain about nothing, and prints."""
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

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]
GUMSHOE = sys.argv.pop(1)
MADE = pathlib.Path(GUMSHOE).resolve().parent / "tests/gumshoe_made_result"
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from gumshoe_report import explain


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


def browser(*arguments):
    with tempfile.TemporaryDirectory() as profile:
        return subprocess.run(
            ["/usr/bin/chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
             "--disable-dev-shm-usage", f"--user-data-dir={profile}", "--virtual-time-budget=5000",
             "--enable-logging=stderr", *arguments], capture_output=True, text=True, timeout=180)


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
                        "What would reach the target for height?", "One at a time: each error given",
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
        with h5py.File(older, "a") as file:
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
        with h5py.File(older, "a") as file:
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

        with h5py.File(empty, "a") as file:
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
        line = re.search("Constant in all samples: ([^<]*)", self.text)[1]
        still = {name for name, row in self.summary.items() if float(row["standard_uncertainty"]) == 0}
        self.assertIn("degrees_of_freedom", still)
        self.assertEqual({item.split(" = ")[0] for item in line.rstrip(".").split("; ")}, still)
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
