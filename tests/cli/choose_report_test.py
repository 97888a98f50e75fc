"""The report of gumshoe choose: what to set stands first, and every number is the file's.

usage: choose_report_test.py path/to/gumshoe [unittest options]
"""
import csv
import html.parser
import json
import math
import re
import subprocess
import sys
import tempfile
import types
import unittest

from program import ROOT, InFolder, gumshoe

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from browser import CLIPPED, CONTRAST, measured
from choose_test import TEXT
from gumshoe_report import choice, choice_surface


class Elements(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.loaded, self.ids, self.tags = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.ids += [v for n, v in attributes if n == "id"]
        self.loaded += [v for n, v in attributes if n in ("src", "srcset", "data", "poster") or (n.endswith("href") and tag != "a")]


def words_of(page):
    body = re.sub(r"<(style|svg|pre).*?</\1>", " ", page, flags=re.S)
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", body))  # the narrow space is a space, too


def labels(page):
    return " | ".join(re.findall('aria-label="([^"]*)"', page))


class Report(InFolder):
    def setUp(self):
        super().setUp()
        self.result, self.page = self.folder / "r.h5", self.folder / "r.html"

    def report(self, text, *more):
        """The page's text, and the answer as `choose --format json` gives it."""
        (self.folder / "s.toml").write_text(text)
        said = gumshoe("choose", self.folder / "s.toml", "--out", self.result, "--format", "json", *more)
        self.assertEqual(said.returncode, 0, said.stderr)
        made = gumshoe("report", self.result)
        self.assertEqual((made.returncode, made.stderr), (0, ""))
        page = self.page.read_text(encoding="utf-8")
        self.sound(page)
        return page, json.loads(said.stdout)

    def sound(self, page):
        found = Elements(page)
        self.assertEqual(len(found.ids), len(set(found.ids)), "identifiers clash")
        self.assertEqual([r for r in found.loaded if not r.startswith(("#", "data:"))], [])
        self.assertNotIn("script", found.tags)
        self.assertFalse({"nan", "inf", "None"} & set(re.split(r"\W+", words_of(page))))

    def table(self, name):
        with open(self.folder / f"r_{name}.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_what_to_set_stands_first(self):
        page, answer = self.report(TEXT)
        best = answer["recommended"]
        feed, readings = (best["settings"][k] for k in ("feed", "readings"))
        first = words_of(page[page.index('<section class="result">'):])
        found = re.match(r" Recommendation Set feed to ([\d.]+) mm/min and take (\d) readings?: measuring length takes "
                         r"([\d.]+) s and gives U = ([\d.]+) µm \(95 %\), which meets the target of 3 µm with a "
                         r"probability of ((?:more than )?[\d.]+) %\.", first)
        self.assertTrue(found, first[:300])
        self.assertAlmostEqual(float(found[1]), feed, delta=5e-4 * feed)
        self.assertEqual(int(found[2]), readings)
        self.assertAlmostEqual(float(found[3]), best["time"], delta=0.051)
        self.assertAlmostEqual(float(found[4]), best["average"]["U"], delta=0.051)
        self.assertIn("subtract" if best["average"]["bias"] > 0 else "add", first[:600])  # of a late trigger: too long
        slow = answer["compared"][0]
        ratio = slow["time"] / best["time"]
        self.assertRegex(first, rf"“slow” \(feed 30 mm/min, readings 12\) takes 2 min 11 s, {ratio:.2f} times as long")
        for heading in ("Time against uncertainty", "U over feed and readings", "How flat the optimum is", "In the worst case",
                        "What limits it", "The Pareto front", "All candidates"):
            self.assertTrue(heading in first, heading)
        for figure in ("Time against expanded uncertainty of all candidates", "Expanded uncertainty over feed and readings",
                       "Sobol' indices of error of length"):
            self.assertIn(figure, labels(page))
        self.assertEqual(page.count('class="chosen"'), 1)

    def test_csv_has_all_candidates(self):
        _, answer = self.report(TEXT)
        lines = self.table("candidates")
        self.assertEqual(len(lines), len(answer["candidates"]))
        for line, one in zip(lines, answer["candidates"]):
            self.assertAlmostEqual(float(line["feed (mm/min)"]), one["settings"]["feed"])
            self.assertAlmostEqual(float(line["U"]), one["average"]["U"])
            self.assertAlmostEqual(float(line["mean_error"]), one["average"]["bias"])
            self.assertAlmostEqual(float(line["U[late]"]), one["cases"]["late"]["U"])
            self.assertEqual(line["meets"] == "1", one["meets"])
            self.assertEqual(line["unit"], "um")
        self.assertEqual([line["recommended"] for line in lines].count("1"), 1)
        self.assertEqual([line["name"] for line in self.table("compared")], ["recommended", "slow"])
        self.assertEqual(len(self.table("neighbours")), len(answer["neighbours"]))
        self.assertEqual(len(self.table("sensitivity")), len(answer["limits"]))

    def test_none_meets_the_target(self):
        page, _ = self.report(TEXT.replace('target = "3 um"', 'target = "1 um"'))
        words = words_of(page)
        self.assertIn("No setting that was tried meets the target U = 1 µm. The nearest is: set feed to", words)
        self.assertFalse("recommended</td>" in page)

    def test_worst_case_limit_of_the_bias_and_no_correction(self):
        text = TEXT.replace("samples = 1_000", 'samples = 1_000\ntarget_of = "worst_case"\nbias = "0.5 um"\ndefinition = "uncorrected"')
        page, answer = self.report(text.replace('"6 ms"', '"0 ms"').replace('"8 ms"', '"1 ms"'))
        words = words_of(page)
        self.assertIn("in the worst case, “late”, which meets the target of 3 µm and a bias of at most 0.5 µm", words)
        self.assertIn("No correction is applied", words)
        self.assertIn("bias above its limit", words)  # at the highest feeds the case is late by more

    def test_what_cannot_be_and_what_fails_is_listed(self):
        # The root has no value where the way in the delay exceeds 2.5 um: at 1000 mm/min at the estimate, 6 ms; at
        # 31.6 mm/min (4.7 ms) in some samples, below never.
        text = TEXT.replace('"length + feed * delay + noise"', '"length + feed * delay + noise + 0 * sqrt(1 - feed * delay / most) * noise"')
        text = text.replace("[quantities]", '[quantities]\nmost = "4 um"').replace("readings = 12", "readings = 1")
        page, answer = self.report(text)
        failing = [c for c in answer["candidates"] if c["average"]["failed"]]
        self.assertTrue(failing and answer["skipped"]["count"])
        words = words_of(page)
        self.assertIn(f"{answer['skipped']['count']} combinations are impossible and were skipped: ", words)
        self.assertIn("the square root of a negative number", words)
        left_out = words[words.index("Left out"):]
        self.assertRegex(left_out, rf"{len(failing)} candidates? ha(s|ve) samples without a value")
        worst = max(failing, key=lambda c: c["average"]["failed"])["average"]
        self.assertIn(f"{worst['failed']} of {worst['valid'] + worst['failed']}", left_out)

    def test_one_variable_is_a_line_and_an_evaluation_needs_none(self):
        page, _ = self.report(TEXT.replace("readings = [1, 2, 3]\n", "").replace('target = "3 um"', 'target = "5 um"'))
        self.assertIn("Expanded uncertainty and time over feed", labels(page))
        text = (ROOT / "scenarios/choose_rod_readouts.toml").read_text()
        start, end = text.index("feed     = {"), text.index("# How long it takes")
        page, _ = self.report(text[:start] + 'evaluation = ["full", "conventional"]\n' + text[end:], "--samples", 500)
        self.assertNotIn("U over", words_of(page))
        self.assertIn("evaluate by “", words_of(page))

    def test_no_label_is_clipped_and_all_is_read_in_the_dark(self):
        page, _ = self.report(TEXT)
        self.assertEqual(measured(self.page, CLIPPED), [])
        # Texts upon the coloured map are not on the page's background.
        found = measured(self.page, CONTRAST.replace("svg text", "svg:not([aria-label*=region]) text"), dark=True)
        self.assertTrue(found["dark"])
        self.assertGreater(found["least"], 4.5)
        for head in re.findall(r"<thead>(.*?)</thead>", page, re.S):
            self.assertNotRegex(head, r'<th(?![^>]*scope="col)[ >]')

    def test_browser_has_no_complaint(self):
        self.report(TEXT)
        with tempfile.TemporaryDirectory() as profile:
            run = subprocess.run(["/usr/bin/chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                                  "--disable-background-networking", f"--user-data-dir={profile}", "--enable-logging=stderr",
                                  f"--screenshot={self.folder / 'p.png'}", self.page.as_uri()],
                                 capture_output=True, text=True, timeout=180)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertNotIn("CONSOLE", run.stderr)


def made_up(U, variables, target=1.0, best=0, coarse=None):
    """A choice whose U is a function of the variables."""
    rows = [types.SimpleNamespace(values=list(x), asked=U(*x), round=0 if coarse is None or coarse(*x) else 1, time=1.0, meets=0,
                                  failed=0) for x in variables[1]]
    return types.SimpleNamespace(candidates=rows, target=target, best=best, variables=[
        types.SimpleNamespace(name=n, kind="quantity", range=r, logarithmic=g, display_factor=2.0, display_offset=0.0)
        for n, r, g in variables[0]])


class Surface(unittest.TestCase):
    GRID = [(x, y, z) for x in (1.0, 2.0, 4.0) for y in (1.0, 3.0) for z in (1.0, 1.5, 2.0)]

    def test_the_most_influential_are_drawn_but_feed_and_speed_before_all(self):
        kinds = [("a", 1, 1), ("b", 0, 0), ("c", 1, 0)]
        c = made_up(lambda x, y, z: x ** 0.1 * y ** 2 * z, (kinds, self.GRID))
        self.assertEqual(choice_surface.drawn_variables(c), [2, 1])  # the range along x, though b matters more
        for name, k in (("feed", 0), ("spindle_speed", 2)):
            c.variables[k].name = name
        self.assertEqual(choice_surface.drawn_variables(c), [0, 2])

    def test_between_the_points_it_is_linear_on_the_scale(self):
        # ln U = 0.5 ln x + ln y: on a logarithmic scale a straight line in each row.
        c = made_up(lambda x, y, z: x ** 0.5 * y, ([("x", 1, 1), ("y", 0, 0), ("z", 0, 0)], self.GRID))
        rows = choice_surface.plane(c, [0, 1])
        self.assertEqual(len(rows), 6)  # z as in the recommended one
        _, lists, edges, centres, _, surface = choice_surface.mesh(c, [0, 1], rows)
        for j, y in enumerate(lists[1] / 2):
            for x, shown in zip(centres[0], surface[j]):
                self.assertAlmostEqual(shown, 0.5 * (x - math.log(2)) + math.log(y), places=12)  # x is shown doubled
        # Two ranges: a plane in (ln x, z) is met by triangles exactly.
        c = made_up(lambda x, y, z: x ** 0.5 * math.exp(z), ([("x", 1, 1), ("y", 0, 0), ("z", 1, 0)], self.GRID))
        *_, centres, _, surface = choice_surface.mesh(c, [0, 2], choice_surface.plane(c, [0, 2]))
        for j, z in enumerate(centres[1]):
            for x, shown in zip(centres[0], surface[j]):
                self.assertAlmostEqual(shown, 0.5 * (x - math.log(2)) + z / 2, places=9)

    def test_no_value_leaves_a_gap(self):
        c = made_up(lambda x, y, z: math.nan if x == 4 else x * y, ([("x", 1, 1), ("y", 0, 0), ("z", 0, 0)], self.GRID))
        *_, centres, _, surface = choice_surface.mesh(c, [0, 1], choice_surface.plane(c, [0, 1]))
        for x, shown in zip(centres[0], surface[0]):
            self.assertEqual(math.isnan(shown), x > math.log(2 * 2))  # beyond the last point that has one


class Words(unittest.TestCase):
    def test_numbers_are_those_one_keys_in(self):
        for x, text in ((27.9178, "27.92"), (12000.0, "12000"), (0.5, "0.5"), (-1.25, "−1.25"), (0.0, "0")):
            self.assertEqual(choice.plain_number(x), text)

    def test_samples_are_never_certain(self):
        self.assertEqual(choice.chance(1.0), "more than 99.9\u202f%")
        self.assertEqual(choice.chance(1e-80), "less than 0.1\u202f%")
        self.assertEqual(choice.chance(0.954), "95\u202f%")
        self.assertEqual(choice.chance(0.9965), "99.7\u202f%")  # half to even at 99.65: either way within the digits
        self.assertEqual(choice.chance(math.nan), "–")

    def test_durations(self):
        for seconds, text in ((0.25, "0.250 s"), (7.149, "7.1 s"), (105, "1 min 45 s"), (3700, "1 h 1 min")):
            self.assertEqual(choice.duration(seconds).replace("\u202f", " "), text)


if __name__ == "__main__":
    unittest.main()
