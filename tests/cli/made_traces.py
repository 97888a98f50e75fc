"""Results of traces that are made up, one of every kind, with their pages."""
import csv
import json
import math
import subprocess

import numpy as np

from program import MADE, InOneFolder, gumshoe

KINDS = ("named", "class", "scatter", "not_in_catalogue", "two_findings", "vetoed", "nothing_found", "lack_of_fit",
         "insufficient_data")


def made(*words):
    run = subprocess.run([MADE, "--trace", *words], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return run.stdout


def root_mean_square(x):
    return math.sqrt(np.mean(np.square(x)))


class Made(InOneFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.said, cls.pages = {}, {}
        for kind in KINDS:
            made(kind, str(cls.file(kind)))
            cls.said[kind] = json.loads(made(kind, "--json"))
            report = gumshoe("report", cls.file(kind))
            assert (report.returncode, report.stderr) == (0, ""), report.stderr
            cls.pages[kind] = cls.file(kind).with_suffix(".html").read_text(encoding="utf-8")

    @classmethod
    def file(cls, kind):
        return cls.folder / f"{kind}.h5"

    def table(self, kind, name):
        with open(self.folder / f"{kind}_{name}.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))
