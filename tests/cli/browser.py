"""Pages in a browser: what it complains of, how they print, and what a script in a copy of the page measures."""
import html.parser
import json
import pathlib
import re
import subprocess
import tempfile

import numpy as np


def browser(*arguments):
    with tempfile.TemporaryDirectory() as profile:
        return subprocess.run(
            ["/usr/bin/chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
             "--disable-dev-shm-usage", f"--user-data-dir={profile}", "--virtual-time-budget=5000",
             "--enable-logging=stderr", *arguments], capture_output=True, text=True, timeout=180)


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


def measured(page, script, width=1000, dark=False):
    """What `script`, a function's body, returns on a page of this width."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "page.html"
        text = pathlib.Path(page).read_text(encoding="utf-8")
        copy.write_text(text.replace("</body>", "<pre id='measured'></pre><script>document.getElementById('measured').textContent = "
                                     f"JSON.stringify((() => {{{script}}})())</script></body>"), encoding="utf-8")
        run = browser("--dump-dom", f"--window-size={width},1500", *(["--blink-settings=preferredColorScheme=0"] if dark else []),
                      copy.as_uri())
    found = re.search(r'<pre id="measured">(.*?)</pre>', run.stdout, re.S)
    assert found, run.stderr
    return json.loads(html.unescape(found[1]))


# Texts of figures that reach beyond their figure, which cuts them.
CLIPPED = """
const cut = [];
for (const details of document.querySelectorAll('details')) details.open = true;
for (const svg of document.querySelectorAll('svg')) {
  const room = svg.getBoundingClientRect();
  for (const text of svg.querySelectorAll('text')) {
    const box = text.getBoundingClientRect();
    if (box.left < room.left - 1 || box.right > room.right + 1 || box.top < room.top - 1 || box.bottom > room.bottom + 1)
      cut.push(text.textContent);
  }
}
return cut;
"""

# Least contrast (WCAG 2.1) of a text and the page behind it, over headings, paragraphs, table cells and figures.
CONTRAST = """
const light = colour => {
  const [r, g, b] = colour.match(/[\\d.]+/g).slice(0, 3).map(c => c / 255).map(c => c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const page = light(getComputedStyle(document.body).backgroundColor);
let least = 21;
for (const part of document.querySelectorAll('h1, h2, p, td, th, figcaption, svg text')) {
  const ink = light(getComputedStyle(part)[part.tagName === 'text' ? 'fill' : 'color']);
  least = Math.min(least, (Math.max(ink, page) + 0.05) / (Math.min(ink, page) + 0.05));
}
return {least, dark: page < 0.2};
"""


def filled_pages(page):
    """For every printed page, the share of its height down to the last ink."""
    with tempfile.TemporaryDirectory() as folder:
        pdf = pathlib.Path(folder) / "page.pdf"
        run = browser("--no-pdf-header-footer", f"--print-to-pdf={pdf}", pathlib.Path(page).as_uri())
        assert run.returncode == 0, run.stderr
        subprocess.run(["pdftoppm", "-r", "20", "-gray", pdf, pathlib.Path(folder) / "p"], check=True)
        shares = []
        for sheet in sorted(pathlib.Path(folder).glob("p-*.pgm")):
            kind, width, height, white = sheet.read_bytes().split(maxsplit=4)[:4]
            pixels = np.frombuffer(sheet.read_bytes()[-int(width) * int(height):], np.uint8).reshape(int(height), int(width))
            ink = np.flatnonzero((pixels < 250).any(axis=1))
            shares.append((ink[-1] + 1) / int(height) if len(ink) else 0.0)
    return shares
