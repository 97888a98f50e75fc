"""The report: one page that loads nothing, makes the browser complain about nothing, and prints."""
import csv
import html.parser
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]
GUMSHOE = sys.argv.pop(1)


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


if __name__ == "__main__":
    unittest.main()
