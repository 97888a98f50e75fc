"""Report of a trace, from made-up outcomes of every kind: that the page says what is stored.

usage: trace_report_test.py path/to/gumshoe [unittest options]
"""
import math
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import h5py
import numpy as np

from made_traces import KINDS, Made, root_mean_square
from program import ROOT, InOneFolder, gumshoe

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from browser import CLIPPED, measured
from choose_report_test import Elements, labels, words_of
from gumshoe_report import csv_tables, page, read, trace, trace_axes, trace_figures


class Written(InOneFolder):
    def test_a_quantity_without_a_unit_stands_in_the_page(self):
        """A dimensionless factor known only with an uncertainty."""
        scenario = self.folder / "factor.toml"
        scenario.write_text("""schema = 1
[model]
name = "expression"
[model.indications]
y = "a + b * x"
[model.measurands]
m = "(y - a) / b"
[quantities]
a = { estimated = true, value = "0 um" }
b = { value = 0.5, u = 0.01 }
[conditions]
x = ["0 um", "10 um", "20 um", "30 um", "40 um", "50 um", "60 um", "70 um"]
[indications.y]
readings = ["0.1 um", "5.2 um", "9.9 um", "15.1 um", "20.2 um", "24.8 um", "30.1 um", "35 um"]
u = "0.1 um"
""")
        page = self.folder / "factor.html"
        run = gumshoe("trace", scenario, "--draws", "19", "--out", self.folder / "factor.h5", "--report", page)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("0.01", page.read_text(encoding="utf-8"))


class Page(Made):
    def test_candidates_have_readable_names(self):
        self.assertEqual(trace.in_words("scatter:cycle | omnibus:time"), "scatter by cycle or any dependence on time")
        for kind in KINDS:
            prose = re.sub(r"(?s)<(code|pre|script|style)\b.*?</\1>|<[^>]*>", " ", self.pages[kind])
            self.assertNotRegex(prose, r"\b(?:table|omnibus|product|harmonic|hysteresis|polynomial|drift|lag|wave|step|scatter|declared):\w")

    def test_pages_are_sound(self):
        for kind, page in self.pages.items():
            with self.subTest(kind):
                found = Elements(page)
                self.assertEqual(len(found.ids), len(set(found.ids)), "identifiers clash")
                self.assertEqual([r for r in found.loaded if not r.startswith(("#", "data:"))], [])
                self.assertNotIn("script", found.tags)
                self.assertFalse({"nan", "inf", "None", "NaN"} & set(re.split(r"\W+", words_of(page))))

    def first(self, kind):
        page = self.pages[kind]
        return words_of(page[page.index('<section class="result">'):])[:700]

    def test_what_it_is_stands_first(self):
        for kind, headline in {"named": "Found: trigger latency", "class": "Found: one of 2 effects",
                               "scatter": "Found: scatter by rod and setup", "vetoed": "Found, and withdrawn",
                               "not_in_catalogue": "Found: an unknown effect",
                               "two_findings": "Found: trigger latency and an unknown effect",
                               "nothing_found": "Nothing found", "lack_of_fit": "Held-out readings are off by more than noise",
                               "insufficient_data": "These data cannot decide"}.items():
            self.assertRegex(self.first(kind), f"^ {headline}[; ]")
            plain = self.said[kind]["plain"][0].replace(" um", " µm")
            self.assertIn(plain, self.first(kind))

    def test_errors_before_and_after_are_the_files(self):
        rms = self.said["named"]["rms"]
        um = lambda name: f"{1e6 * rms[name]:.2f}"
        first = self.first("named")
        self.assertIn(f"error before, hold-out{um('holdout_before')} µm", first)
        self.assertIn(f"error after, hold-out{um('holdout_after')} µm", first)
        self.assertIn("p ≤ 0.001", first)  # one draw in a thousand is the least that can be told
        text = words_of(self.pages["named"])
        part = text[text.index("Before and after"):text.index("Residuals In the order")]
        for name in ("before", "after", "holdout_before", "holdout_after", "worst_block_after"):
            self.assertIn(um(name), part)
        low, high = (f"{1e6 * x:.2f}" for x in rms["holdout_noise_interval95"])
        self.assertIn(f"[{low}, {high}]", part)
        self.assertIn("in sample", part)
        self.assertIn("neither for the search nor for the fit", part)

    def test_what_is_left_is_said(self):
        text = words_of(self.pages["lack_of_fit"])
        for words in ("not explained is 2.9", "It depends on feed and rod", "Setup 3 differs", "reading 7 (setup 1, rod 1)", "replicate floor"):
            self.assertIn(words, text)
        said = self.said["lack_of_fit"]
        self.assertEqual((said["verdict"], said["lack_of_fit"]["depends_on"]), ("lack_of_fit", ["feed", "rod"]))
        self.assertEqual([b["name"] for b in said["anomalous_blocks"]], ["setup 3"])
        self.assertEqual([(e["name"], e["unit"]) for e in said["of_indications"]], [("spindle_z", "um"), ("pitch", "mrad")])
        self.assertAlmostEqual(said["of_indications"][1]["holdout_before"], 0.031)
        self.assertAlmostEqual(float(self.table("lack_of_fit", "of_indications")[1]["holdout_after"]), 0.03)
        self.assertIn("pitch, hold-out (µrad)31", text)
        self.assertEqual([(o["block"], o["weight"]) for o in said["outliers"]], [("setup 1", 0.21)])
        self.assertEqual(self.table("lack_of_fit", "outliers")[0]["reading"], "reading 7 (setup 1, rod 1)")
        with h5py.File(self.file("lack_of_fit")) as file:
            self.assertEqual(file["trace/lack_of_fit"].attrs["found"], 1)
            self.assertAlmostEqual(file["trace/outliers/residual"][0], -9.1e-6)

    def test_nothing_is_corrected_for_that_held_out_readings_do_not_confirm(self):
        for kind in ("named", "not_in_catalogue"):
            t = read.result(self.file(kind)).trace
            self.assertEqual(t.unconfirmed, 0)
            self.assertRegex(trace.Trace(t).to_do(t.findings[0]), "^Correct (for it|by the table)")
            t.unconfirmed = 1
            self.assertRegex(trace.Trace(t).to_do(t.findings[0]), "^Measure another block before you correct (for it|by the table)")

    def test_what_the_held_out_readings_reject_is_not_called_found(self):
        """The page of a rejected shape says so wherever it speaks of it, and offers no correction."""
        r = read.result(self.file("not_in_catalogue"))
        r.trace.vetoed = 1
        words = words_of(page.render(r))
        self.assertIn(" Found, and withdrawn: an unknown effect", words)
        self.assertIn("Do not correct for it: the hold-out blocks reject it", words)
        self.assertNotRegex(words, "Found: |Correct by|Table of compensation|Add the correction|left out and all else is fitted")
        self.assertEqual(csv_tables.trace(r.trace)["compensation"], [])
        # Scatter outlives the veto.
        t = r.trace
        t.findings = read.result(self.file("scatter")).trace.findings + t.findings
        words = trace.Trace(t)
        self.assertEqual(words.found_headline(), "Found: scatter by rod and setup; withdrawn: an unknown effect")
        self.assertRegex(words.to_do(t.findings[0]), "include it in the uncertainty budget")
        self.assertRegex(words.explanation(), r"It is not added to the model\.$")

    def test_how_a_finding_was_preferred(self):
        """A shape may fit better, and members of a class may lag: neither is denied."""
        for kind in ("named", "class"):
            r = read.result(self.file(kind))
            f, = r.trace.findings
            f.remarks = [*f.remarks, "polynomial:feed^2 with zero in the middle fits better, as chance could have it"]
            words = words_of(page.render(r))
            said = "Square of feed with zero in the middle fits better, as chance could have it; a known effect is preferred."
            self.assertEqual(words.count(said), 1)
            self.assertEqual(words.count("as chance could have it"), 1)
            self.assertNotRegex(words, "better than every rival|equally well")
        self.assertIn("The search preferred it to all other candidates", words_of(self.pages["named"]))
        self.assertIn("or less well by no more than chance gives", words_of(self.pages["class"]))

    def test_the_size_of_the_noise_is_bounded(self):
        t = read.result(self.file("named")).trace
        for p, said in ((1.9e-258, "of less than 0.001 "), (0.0123, "of 0.012 "), (0.99999, "of more than 0.999 ")):
            t.noise.chi_squared_p = p
            text = " ".join(trace.Trace(t).noise())
            self.assertIn(said, text)
            self.assertIn("lognormal", text)
            self.assertNotIn("chi-squared", text)
        t.noise.chi_squared_p = 1  # not judged
        self.assertNotIn("probability", " ".join(trace.Trace(t).noise()))
        self.assertEqual(trace.Trace(t).p(1.0), "> 0.99")

    def test_the_hold_out_is_not_said_to_be_used_once(self):
        """After a rejection, and in each further round, the same blocks judge again."""
        for page_ in self.pages.values():
            self.assertNotIn("only once", page_)
        self.assertIn("the same blocks judge what is left", self.pages["named"])

    def test_residuals_beyond_the_axis_are_marked(self):
        r = read.result(self.file("named"))
        rows = [row for row in r.trace.residuals if math.isfinite(row.before)]
        self.assertNotIn("Triangles", words_of(page.render(r)))
        rows[5].before, rows[9].before, rows[9].weight = 1.0, -1.0, 0.1  # m
        drawn = []
        with unittest.mock.patch.object(trace_figures, "svg", lambda figure, *_: drawn.append(figure) or ""):
            trace_figures.in_order(rows, "o", "the order of measurement")
            trace_figures.against(rows, trace_axes.columns(r.trace), "a")
            trace_figures.by_label(rows, trace_axes.labels(r.trace), "setup", "l")
        for figure in drawn[:2]:
            axes = figure.axes[0]  # before
            for marker in "^v":
                self.assertTrue(any(line.get_marker() == marker and len(line.get_xdata()) for line in axes.lines), marker)
        for axes in drawn[2].axes:  # every residual within
            low, high = axes.get_ylim()
            self.assertTrue(all(low <= y <= high for line in axes.lines for y in line.get_ydata()))
        self.assertEqual(words_of(page.render(r)).count("Triangles: "), 2)

    def test_a_hump_of_few_readings_shows_in_their_averages(self):
        """Of 26 readings at as many places: bins of three, and not two bins that happen to hold so many."""
        x = np.arange(26.0)
        centre, mean, half = trace_figures.averages(x, np.exp(-((x - 15) / 4) ** 2))
        self.assertEqual(len(centre), 8)
        self.assertLess(abs(centre[mean.argmax()] - 15), 2)
        self.assertGreater(mean.max(), 0.8)

    def test_sizes_are_rounded_by_their_uncertainty(self):
        self.assertRegex(words_of(self.pages["named"]), r"delay ?trigger_latency\.delay ?1\.520 ?0\.041 ?\[1\.430, 1\.610\] ?ms")
        self.assertRegex(words_of(self.pages["class"]), r"expansion ?rod_expansion\.expansion ?11\.2 ?1\.1 ?\[8\.9, 13\.5\] ?µm/m/K")

    def test_a_class_comes_with_what_would_split_it(self):
        text = words_of(self.pages["class"])
        self.assertIn("Measure next: let the spindle rest for an hour", text)
        self.assertIn("These data cannot distinguish these 2 effects", text)

    def test_what_was_refused_says_why(self):
        text = words_of(self.pages["named"])
        tried = text[text.index("What was tried"):text.index("Detection limits")]
        for reason in ("the same as trigger_latency, which is a cause", "within its uncertainty", "absorbed by laser_z"):
            self.assertIn(reason, tried)
        self.assertEqual(self.pages["named"].count('<tr class="chosen"><th scope="row">trigger latency<small><code>'), 1)
        self.assertRegex(text, r"z_scale ?scale ?undetectable in these data")

    def test_both_budgets_side_by_side(self):
        text = words_of(self.pages["named"])
        part = text[text.index("Uncertainty of laser_z, before and after"):].replace("&#8239;", " ")
        self.assertRegex(part, r"trigger_latency\.delay ?new ?– ?0\.041 ms")
        with h5py.File(self.file("named")) as file:
            for side in ("before", "after"):
                U = file[f"budget_{side}/000"].attrs["expanded_uncertainty"] * 1e3
                self.assertRegex(part, rf"U = {U:.4f} mm")
        self.assertNotIn("Uncertainty of", words_of(self.pages["class"]))

    def test_figures_show_one_residual_where_nothing_was_added(self):
        both = labels(self.pages["named"])
        for what in ("in the order of measurement", "against each condition", "by label"):
            self.assertIn(f"Residuals {what}, before and after", both)
            self.assertIn(f"Residuals {what}", labels(self.pages["nothing_found"]))
            self.assertNotIn(f"Residuals {what}, before and after", labels(self.pages["nothing_found"]))
        self.assertIn("Error of the unknown effect against feed", labels(self.pages["not_in_catalogue"]))
        self.assertEqual(labels(self.pages["insufficient_data"]), "What is measured")
        self.assertIn("rod, setup</text>", self.pages["scatter"])  # what scatters by both is drawn by both

    def test_an_unknown_effect_has_a_table_of_compensation(self):
        text = words_of(self.pages["not_in_catalogue"])
        part = text[text.index("Table of compensation"):]
        self.assertRegex(part, r"feed \(mm/min\) ?rod ?error of spindle z \(µm\) ?correction \(µm\) ?u \(µm\) ?readings")
        self.assertRegex(part, r"120 ?rod 2 ?1\.20 ?−1\.20 ?0\.10 ?18")
        rows = self.table("not_in_catalogue", "compensation")
        self.assertEqual((len(rows), rows[-1]["rod"], rows[-1]["unit"]), (8, "rod 2", "um"))
        self.assertAlmostEqual(float(rows[-1]["correction"]), -1.2)
        self.assertAlmostEqual(float(rows[-1]["feed (mm/min)"]), 120)

    def test_csv(self):
        residuals = self.table("named", "residuals")
        self.assertEqual(len(residuals), 192)
        first = residuals[0]
        self.assertAlmostEqual(float(first["feed (mm/min)"]), 4)
        self.assertAlmostEqual(float(first["temperature (degC)"]), 20)
        self.assertEqual((first["rod"], first["setup"], first["final"], first["unit"]), ("rod 1", "1", "0", "mm"))
        before = [float(r["before"]) for r in residuals if r["final"] == "0"]
        self.assertAlmostEqual(root_mean_square(before) * 1e-3 / self.said["named"]["rms"]["before"], 1, places=9)
        sizes = self.table("class", "findings")
        self.assertEqual([(s["member"], s["unit"]) for s in sizes], [("thermal_growth", "um"), ("rod_expansion", "um/m/K")])
        self.assertAlmostEqual(float(sizes[1]["high"]), 13.5)
        self.assertEqual(len(self.table("named", "candidates")), 6)
        self.assertEqual(self.table("named", "detection_limits")[2]["value"], "inf")

    def test_page_only(self):
        alone = self.folder / "alone"
        alone.mkdir()
        run = subprocess.run(["/usr/bin/python3", ROOT / "reports/report.py", self.file("named"), "--out", alone / "p.html",
                              "--page-only"], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))
        self.assertEqual([p.name for p in alone.iterdir()], ["p.html"])

    def test_no_label_is_clipped_and_headings_have_a_scope(self):
        self.assertEqual(measured(self.file("two_findings").with_suffix(".html"), CLIPPED), [])
        for page in self.pages.values():
            for head in re.findall(r"<thead>(.*?)</thead>", page, re.S):
                self.assertNotRegex(head, r'<th(?![^>]*scope="col)[ >]')

    def test_the_picture_stands_on_top(self):
        page = self.pages["named"]
        self.assertLess(page.index('class="measurement"'), page.index("Found: trigger latency"))
        self.assertIn("<math", page)

    def test_browser_has_no_complaint(self):
        with tempfile.TemporaryDirectory() as profile:
            run = subprocess.run(["/usr/bin/chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                                  "--disable-background-networking", f"--user-data-dir={profile}", "--enable-logging=stderr",
                                  f"--screenshot={self.folder / 'p.png'}", self.file("two_findings").with_suffix(".html").as_uri()],
                                 capture_output=True, text=True, timeout=180)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertNotIn("CONSOLE", run.stderr)


if __name__ == "__main__":
    unittest.main()
