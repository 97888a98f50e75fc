"""Figures and tables of the report: every study is there, nothing is clipped, and the figures say what the numbers say.

usage: report_figures_test.py path/to/gumshoe [unittest options]
"""
import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

import h5py
import numpy as np

from program import GUMSHOE, MADE, ROOT, InOneFolder

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from browser import CLIPPED, Resources, browser, measured
from gumshoe_report import convergence, page, read, scatter
from sealed import changed


class EveryStudy(InOneFolder):
    """A made-up result with all groups; its numbers are those of tests/made/full_results.cpp."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.result = cls.folder / "full.h5"
        subprocess.run([MADE, cls.result], check=True)
        subprocess.run([GUMSHOE, "report", cls.result], cwd=ROOT, check=True, capture_output=True)
        cls.page = cls.folder / "full.html"
        cls.text = cls.page.read_text(encoding="utf-8")
        cls.words = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", cls.text))

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
        fit = {(r["a"], r["b"]): r for r in self.table("fit")}
        self.assertAlmostEqual(float(fit["height", "runout"]["covariance"]), -0.44 * 0.0021 * 1.7)  # mm um
        for name in ("sensitivity_pairs", "given_data", "dgsm", "circular", "target"):
            self.assertTrue(self.table(name), name)

    def test_older_files_and_files_without_studies_still_work(self):
        older = self.folder / "older.h5"
        shutil.copy(self.result, older)
        with changed(older) as file:
            for name in ("shapley", "given_data", "morris", "dgsm", "one_at_a_time", "joint", "fit", "circular", "conformity",
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
        for absent in ("Conformity", "Several measurands", "What the fit itself says", "Morris", "How many trials"):
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
            for name in ("sensitivity", "shapley", "given_data", "morris", "dgsm", "one_at_a_time", "joint", "fit", "circular",
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
        for words in ("ellipsoid k_p = 2.448, rectangle k_q = 2.212", "height: accepted",
                      "least squares: 24 indications, 22 degrees of freedom, s = 0.002 mm; u by the fit itself: height 0.00168 mm, runout 1.87 um", "runout: rejected",
                      "global producer's risk 15.1 %", "beam_pitch 0.576", "Shapley effects of runout",
                      "u of beam_pitch 0.11 deg", "640000 trials"):
            self.assertIn(words, text)
        made = {o["output"]: o for o in
                json.loads(subprocess.run([MADE, "--json"], check=True, capture_output=True, text=True).stdout)}
        self.assertAlmostEqual(made["height"]["sobol"]["beam_pitch"]["total"]["value"], 0.576)
        self.assertAlmostEqual(made["height"]["targets"][0]["quantities"]["beam_pitch"]["allowed"], 0.11)
        self.assertEqual(made["height"]["targets"][0]["quantities"]["beam_pitch"]["allowed_gum"], "any")
        self.assertAlmostEqual(made["runout"]["joint"][0]["correlation"]["height"], -0.55)
        self.assertAlmostEqual(made["runout"]["fit"]["standard_uncertainty"], 1.1 * 1.7)
        self.assertAlmostEqual(made["runout"]["fit"]["correlation"]["height"], -0.5)
        self.assertNotIn("fit", made["loss"])
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


if __name__ == "__main__":
    unittest.main()
