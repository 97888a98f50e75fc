"""Shipped scenarios, each broken in one place: `gumshoe check` accepts them or says what is wrong, in form, at once.

usage: mutations_test.py path/to/gumshoe [--all] [unittest options]

A line `key = value` gets a value of the wrong kind, size or unit, or its key is misspelt, repeated or left out. By default
a fixed sample of some hundred; --all tries every one of some ten thousand.
"""
import hashlib
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

from program import ROOT, complaint, gumshoe

ALL = "--all" in sys.argv
sys.argv = [w for w in sys.argv if w != "--all"]
SAMPLE = 400
VALUES = ('"x"', "-1", "0", "nan", "inf", '""', "[]", "{}", "true", "1e308", '"5 N"', '"-5 mm"', '"1e999 um"', '[1, "a"]',
          "2026-01-01", '"5 % mm"', '"\\u0000"', "[[[[]]]]", '{ value = "1 mm", value2 = 3 }', '"' + "x" * 5000 + '"')
LINE = re.compile(r"^(\s*)([A-Za-z_]\w*)(\s*=\s*)(\S.*)$")


def misspelt(key):
    return key[:-2] + key[-1] + key[-2] if len(key) > 3 and key[-1] != key[-2] else key + "q"


def mutations(text):
    lines = text.split("\n")
    for i, line in enumerate(lines):
        found = LINE.match(line)
        if not found or found[4].rstrip().endswith(("[", "{", '"""', "'''")):
            continue
        space, key, equals, _ = found.groups()
        for value in VALUES:
            yield f"{key} = {value}", lines[:i] + [space + key + equals + value] + lines[i + 1:], None
        yield f"{key} misspelt", lines[:i] + [space + misspelt(key) + line[len(space + key):]] + lines[i + 1:], key
        yield f"{key} twice", lines[:i + 1] + lines[i:], None
        yield f"{key} left out", lines[:i] + lines[i + 1:], None


def chosen(scenarios):
    """(file, what, lines, key) of a fixed sample: the least hashes."""
    every = [(file, what, lines, key) for file in scenarios for what, lines, key in mutations(file.read_text())]
    if ALL:
        return every
    return sorted(every, key=lambda m: hashlib.sha256(f"{m[0].name} {m[1]} {len(m[2])}".encode()).digest())[:SAMPLE]


class Mutations(unittest.TestCase):
    def test_each_is_accepted_or_refused_in_form(self):
        refused = 0
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(ROOT / "scenarios", pathlib.Path(folder) / "s", ignore=shutil.ignore_patterns("gauge"))
            for file, what, lines, key in chosen(sorted((ROOT / "scenarios").glob("*.toml"))):
                broken = pathlib.Path(folder) / "s" / file.name
                broken.write_text("\n".join(lines))
                with self.subTest(f"{file.name}: {what[:60]}"):
                    run = gumshoe("check", broken, seconds=20)
                    if run.returncode == 0:
                        continue
                    refused += 1
                    self.assertIsNone(complaint(run), run.stderr[:200])
                    self.assertIn(file.name, run.stderr)
        self.assertGreater(refused, 0.4 * (1 if ALL else SAMPLE))


if __name__ == "__main__":
    unittest.main()
