"""`gumshoe compare`: differences, E_n and changes against closed forms; inputs that both results share; two traces.

usage: compare_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import shutil
import sys
import unittest

import h5py

from lengths import K, Lengths
from program import ROOT, SCENARIO, gumshoe

sys.path.append(str(ROOT / "tests" / "recovery"))
import axis

SAMPLES = 200_000


class Compare(Lengths):
    COMMAND, SAMPLES = "compare", SAMPLES

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.before = cls.result("before")
        cls.after = cls.result("after", reading=10.012, u_reading=1, seed=2)

    def compared(self, *words):
        run = gumshoe("compare", *words, "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def test_independent_results_differ_by_the_closed_form(self):
        # The estimates are means of the samples: 5 standard errors of their difference, in mm and relative to U.
        u = math.sqrt(5**2 + 1 + 4**2) / 1000
        error = 5 * u / math.sqrt(SAMPLES)
        row = self.compared(self.before, self.after)["comparisons"][0]
        self.assertEqual((row["name"], row["unit"]), ("y", "mm"))
        self.assertAlmostEqual(row["difference"], 0.012, delta=error)
        # U and k are those of the framework, which is exact here; u is that of the samples: se u / sqrt(2 n).
        self.assertAlmostEqual(row["expanded_uncertainty"], K * u, delta=1e-9)
        self.assertAlmostEqual(row["standard_uncertainty"], u, delta=error)
        self.assertAlmostEqual(row["normalised_error"], 0.012 / (K * u), delta=error / (K * u))
        self.assertIn("agree within", row["verdict"])
        self.assertEqual(row["alike"], ["reference"])
        change = {c["quantity"]: (c["before"], c["after"]) for c in row["contributions"]}
        self.assertEqual(list(change), ["reading"])  # that of the reference did not change
        self.assertAlmostEqual(change["reading"][0], 0.003, delta=1e-9)
        self.assertAlmostEqual(change["reading"][1], 0.001, delta=1e-9)

    def test_an_input_that_is_correlated_cannot_be_shared(self):
        """What its partner has of it is not in the budgets; without --same, nothing is claimed of it."""
        tied = [self.result(f"tied{seed}", seed=seed, change=lambda t: t + '[[correlations]]\nquantities = ["reading", "reference"]\n'
                            'kind = "pearson"\ncoefficient = 0.5\n') for seed in (1, 2)]
        self.refused("--same reference: it is correlated with reading", *tied, "--same", "reference")
        self.assertIsNotNone(self.compared(*tied)["comparisons"][0]["normalised_error"])
        said = gumshoe("combine", *tied, "--same", "reference")
        self.assertIn("it is correlated with reading", said.stderr)

    def test_a_shared_input_cancels(self):
        # Same sign of its coefficient in both: only the readings' 3 um and 1 um remain, and 12 um is more than U = 6.2 um.
        row = self.compared(self.before, self.after, "--same", "reference")["comparisons"][0]
        self.assertAlmostEqual(row["expanded_uncertainty"], K * math.sqrt(3**2 + 1) / 1000, delta=self.error(math.sqrt(3**2 + 1)))
        self.assertGreater(row["normalised_error"], 1)
        self.assertIn("differ by more", row["verdict"])
        self.assertEqual((row["same"], row["alike"]), (["reference"], []))
        # The opposite sign adds up: u^2 = 3^2 + 1 + (4 + 4)^2.
        other = self.result("opposite", formula="reading + reference", u_reading=1)
        row = self.compared(self.before, other, "--same", "reference")["comparisons"][0]
        self.assertAlmostEqual(row["expanded_uncertainty"], K * math.sqrt(3**2 + 1 + 8**2) / 1000,
                               delta=self.error(math.sqrt(3**2 + 1 + 8**2)))

    def error(self, u):
        """Five standard errors of U, mm: k = U / u has the relative error 1 / sqrt(2 n) of each result's u, and stands
        with the covariance 4 um * 4 um in U^2 = U_a^2 + U_b^2 - 2 k_a k_b cov."""
        return 5 * K * 4**2 / math.sqrt(SAMPLES) / u / 1000

    def test_order_turns_the_sign_and_nothing_else(self):
        there = self.compared(self.before, self.after)["comparisons"][0]
        back = self.compared(self.after, self.before)["comparisons"][0]
        for key, sign in (("difference", -1), ("normalised_error", -1), ("expanded_uncertainty", 1)):
            self.assertEqual(back[key], sign * there[key])

    def test_text_says_the_verdict_and_what_changed(self):
        said = gumshoe("compare", self.before, self.after).stdout
        self.assertRegex(said, r"^y: after - before = 0\.0\d+ mm, U = 0\.0\d+ mm, E_n = 0\.\d\d: the results agree")
        self.assertIn("reading from 3.0 um to 1.0 um (67 % smaller)", said)
        self.assertIn("list alike: reference. Where one error is in both", said)
        self.assertIn("only after: z", gumshoe("compare", self.before, self.two_measurands()).stdout)

    def two_measurands(self):
        return self.result("two", formula="reading", u_reading=1,
                           change=lambda text: text.replace('y = "reading"', 'y = "reading"\nz = "reference"'))

    def test_traces_are_compared_by_their_residuals(self):
        shutil.copytree(ROOT / "scenarios", self.folder / "scenarios")
        data = self.folder / "scenarios/data/linear_axis.csv"
        files = []
        for name in ("before", "after"):
            files.append(self.folder / f"trace_{name}.h5")
            run = gumshoe("trace", "scenarios/trace_linear_axis.toml", "--draws", 19, "--out", files[-1], "--force",
                          cwd=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.correct(data)
        both = self.compared(*files)
        with h5py.File(files[0]) as file:
            rms = file["trace/rms"].attrs
            for key, attribute in (("rms", "before"), ("rms_with_findings", "after"), ("holdout", "holdout_before"),
                                   ("holdout_with_findings", "holdout_after")):
                self.assertAlmostEqual(both["before"][key], rms[attribute] * rms["display_factor"], delta=1e-9)
            names = [file[f"trace/findings/{k}"].attrs["name"] for k in sorted(file["trace/findings"])]
        self.assertEqual(both["before"]["findings"], names)
        said = gumshoe("compare", *files).stdout
        # The table was most of the error.
        self.assertLess(both["after"]["holdout"], both["before"]["holdout"] / 2)
        self.assertRegex(said, r"  held-out readings: from \S+ um to \S+ um \(\d+ % smaller\)\n")
        self.assertIn("expected after correcting what was found: ", said)
        self.refused("a trace and a result of measurands cannot be compared", files[0], self.before)
        cells = []
        for name in ("load_cell", "thermometer"):
            cells.append(self.folder / f"{name}.h5")
            run = gumshoe("trace", f"scenarios/trace_{name}.toml", "--draws", 19, "--out", cells[-1], cwd=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
        self.refused("the traces have residuals of different dimensions", *cells)
        self.refused("the traces are of different models (linear_axis and expression)", files[0], cells[0])
        self.refused("two traces have no budgets to compare", *files, "--same", "reference")

    def test_traces_that_find_one_effect_say_what_became_of_its_size(self):
        """Of an axis whose play grows from 4 um to 6 um."""
        files = []
        for k, play in enumerate((4, 6)):
            rows = ["cycle,x,direction,d"]
            for cycle in range(6):
                rows += [f"{cycle},{x},{way}1,{-play / 2 * int(way + '1') + 0.3 * math.sin(7.3 * cycle + 1.7 * x + k):.3f}"
                         for way, xs in (("+", range(0, 500, 50)), ("-", range(450, -1, -50))) for x in xs]
            (self.folder / "r.csv").write_text("\n".join(rows) + "\n")
            (self.folder / "play.toml").write_text(axis.LINEAR_AXIS)
            files.append(self.folder / f"play{k}.h5")
            run = gumshoe("trace", "play.toml", "--draws", 99, "--out", files[-1], "--force", cwd=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
        size, = self.compared(*files)["sizes"]
        self.assertEqual((size["finding"], size["quantity"], size["unit"]), ("axis_reversal", "backlash", "um"))
        self.assertAlmostEqual(size["difference"], 2, delta=0.1)
        self.assertAlmostEqual(size["normalised_error"], size["difference"] / size["expanded_uncertainty"], delta=1e-9)
        self.assertRegex(gumshoe("compare", *files).stdout, r"axis_reversal\.backlash: before [34]\.\d+ um, u = \S+; after [56]\.\d+ um, u = \S+; "
                         r"E_n = \d+\.\d\d: they differ by more")

    def correct(self, data):
        """Takes the mean over the cycles, by position and direction, off the readings."""
        head, *rows = [line.split(",") for line in data.read_text().splitlines()]
        cells = {}
        for row in rows:
            cells.setdefault((row[1], row[2]), []).append(float(row[4]))
        for row in rows:
            cell = cells[row[1], row[2]]
            row[4] = f"{float(row[4]) - sum(cell) / len(cell):.3f}"
        data.write_text("".join(",".join(row) + "\n" for row in [head, *rows]))

    def test_refusals(self):
        self.refused("not a quantity in the budgets of both results", self.before, self.after, "--same", "refrence")
        self.refused("Did you mean 'reference'?", self.before, self.after, "--same", "refrence")
        self.refused("different coverage probabilities", self.before, self.result("p99", p=0.99))
        other = self.result("other", change=lambda text: text.replace("y = ", "other = ", 1))
        self.refused("no measurand in common", self.before, other)
        errors = self.folder / "virtual.toml"
        errors.write_text(SCENARIO.replace('name = "rod_gauging"', 'name = "rod_gauging"\nmethod = "virtual_experiment"'))
        virtual = self.folder / "virtual.h5"
        self.assertEqual(gumshoe("run", errors, "--samples", 1000, "--out", virtual).returncode, 0)
        self.refused("one of the results holds errors of a virtual experiment, the other values", self.before, virtual)
        self.refused("y: the results have different dimensions", self.before, self.result("ratio", formula="reading / reference"))
        self.refused("before.toml", self.folder / "before.toml", self.after)  # not a result
        volume = self.folder / "volume.h5"
        self.assertEqual(gumshoe("volume", ROOT / "scenarios/volume_five_axis.toml", "--out", volume).returncode, 0)
        self.refused("gumshoe volume wrote it", volume, self.after)
        damaged = self.folder / "damaged.h5"
        data = bytearray(self.before.read_bytes())
        data[-60] ^= 1  # within the record
        damaged.write_bytes(data)
        self.refused("damaged.h5", damaged, self.after)


if __name__ == "__main__":
    unittest.main()
