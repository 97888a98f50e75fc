"""`gumshoe combine`: weighted mean, shared inputs and consistency against closed forms; the mean as a scenario.

usage: combine_test.py path/to/gumshoe [unittest options]
"""
import json
import math
import shutil
import unittest

import h5py

from lengths import K, Lengths
from program import ROOT, gumshoe

SAMPLES = 100_000


class Combine(Lengths):
    COMMAND, SAMPLES = "combine", SAMPLES

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.a = cls.result("a", reading=110)
        cls.b = cls.result("b", reading=110.006, u_reading=1)

    def combined(self, *words):
        run = gumshoe("combine", *words, "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def mean(self, *words):
        return self.combined(*words)["means"][0]

    # Estimates and the u of nonlinear results are those of samples, with the relative standard error 1 / sqrt(2 n); 5 of them.
    RELATIVE = 5 / math.sqrt(2 * SAMPLES)

    def test_independent_results_are_weighted_by_their_variances(self):
        row = self.mean(self.a, self.b)
        va, vb = 3**2 + 4**2, 1 + 4**2
        u = math.sqrt(1 / (1 / va + 1 / vb)) / 1000
        self.assertEqual((row["output"], row["unit"]), ("y", "mm"))
        self.assertAlmostEqual(row["standard_uncertainty"], u, delta=2 * self.RELATIVE * u)
        self.assertAlmostEqual(row["expanded_uncertainty"], K * u, delta=2 * self.RELATIVE * K * u)
        weights = [r["weight"] for r in row["results"]]
        self.assertAlmostEqual(weights[0], vb / (va + vb), delta=4 * self.RELATIVE)
        self.assertAlmostEqual(sum(weights), 1, delta=1e-12)
        self.assertAlmostEqual(row["estimate"], 10 + 0.006 * weights[1], delta=5 * 0.005 / math.sqrt(SAMPLES))
        # Of two results chi^2 = d^2 / (va + vb), and both have its root over k for E_n.
        chi = 6 / math.sqrt(va + vb)
        self.assertAlmostEqual(row["chi_squared"], chi**2, delta=0.03)
        self.assertAlmostEqual(row["probability"], math.erfc(chi / math.sqrt(2)), delta=0.01)
        for r, sign in zip(row["results"], (-1, 1)):
            self.assertAlmostEqual(r["normalised_error"], sign * chi / K, delta=0.01)
        self.assertTrue(row["consistent"])
        self.assertEqual((row["alike"], row["shared"]), (["reference"], []))

    def test_few_degrees_of_freedom_of_one_input_widen_no_other(self):
        """A t of 5 degrees of freedom has the standard deviation sqrt(5/3) u: its own, not that of the reference. Where one
        result is not linear, u is that of the samples for all; else it is u_c of the budgets."""
        def few(text):
            return text.replace('u = "3 um"', 'u = "3 um"\ndegrees_of_freedom = 5')
        three = [self.result(f"few{i}", reading=110 + 0.001 * i, seed=i, change=few) for i in (1, 2, 3)]
        row = self.mean(*three, "--same", "reference")
        for shared in row["shared"][0]["contributions"]:
            self.assertAlmostEqual(shared, -0.004, delta=1e-12)
        # Three equal weights from u with 5 degrees of freedom add 4 * 3 * (1/3) (2/3) / (5 - 2) of 9/3 (Meier 1953).
        self.assertAlmostEqual(row["standard_uncertainty"], math.sqrt(16 + 9 / 3 * (1 + 8 / 9)) / 1000, delta=1e-9)
        extra = '[quantities.zero]\nvalue = "110.004 mm"\n[quantities.bend]\nvalue = "1000 1/mm"\n[run]'
        bent = self.result("bent", formula="reading - reference + bend * (reading - zero)^2", reading=110.004,
                           change=lambda t: few(t).replace("[run]", extra) + "sensitivity = { sobol = 16384 }\n")
        row = self.mean(three[0], bent, "--same", "reference")
        self.assertAlmostEqual(row["shared"][0]["contributions"][0], -0.004, delta=0.04 * 0.004)
        self.assertAlmostEqual(row["results"][0]["standard_uncertainty"], math.sqrt(16 + 15) / 1000, delta=0.04 * 0.0056)

    def test_a_mean_does_not_move_with_the_number_of_samples(self):
        """Enough samples validate one result and not the other; both have the same u_c and degrees of freedom."""
        def of(digits):
            return lambda t: t.replace('u = "4 um"\n', "").replace(
                'u = "3 um"\n', 'u = "3 um"\ndegrees_of_freedom = 4\n').replace("digits = 1", f"digits = {digits}")
        a, undecided, decided = (self.result(f"moved{digits}{k}", reading=110 + k / 1000, change=of(digits))
                                 for digits, k in ((1, 0), (2, 1), (1, 1)))
        one, other = self.mean(a, undecided), self.mean(a, decided)
        for key in ("estimate", "standard_uncertainty", "expanded_uncertainty", "degrees_of_freedom"):
            self.assertEqual(one[key], other[key])
        self.assertEqual([r["weight"] for r in one["results"]], [0.5, 0.5])

    def test_a_shared_input_stays_in_the_mean_and_cancels_in_the_difference(self):
        # V = diag(9, 1) + 16: the weights are those of 9 and 1, u^2 = 16 + 1 / (1/9 + 1), and the difference has 9 + 1.
        row = self.mean(self.a, self.b, "--same", "reference")
        u = math.sqrt(16 + 0.9) / 1000
        self.assertAlmostEqual(row["standard_uncertainty"], u, delta=2 * self.RELATIVE * u)
        # A relative error e of u_i, times 25 or 17 um^2, stands next to the 10 um^2 of the difference in the weights.
        self.assertAlmostEqual(row["results"][0]["weight"], 0.1, delta=self.RELATIVE * (25 + 17) / 10)
        self.assertAlmostEqual(row["chi_squared"], 36 / 10, delta=2 * self.RELATIVE * 36 / 10 + 0.1)
        self.assertEqual(row["shared"][0]["component"], "reference")
        for shown in row["shared"][0]["contributions"]:
            self.assertAlmostEqual(shown, -0.004, delta=0.004 * self.RELATIVE)
        self.assertEqual(row["alike"], [])
        # With opposite signs the error of the reference cancels in the mean: V = [25, -16; -16, 17].
        other = self.result("opposite", formula="reading + reference - 2 * datum", reading=110.006, u_reading=1,
                            change=lambda t: t.replace("[run]", '[quantities.datum]\nvalue = "100 mm"\n[run]'))
        row = self.mean(self.a, other, "--same", "reference")
        u = math.sqrt((25 * 17 - 16**2) / (25 + 17 + 32)) / 1000
        self.assertAlmostEqual(row["standard_uncertainty"], u, delta=3 * self.RELATIVE * u)

    def test_equal_seeds_do_not_couple_results(self):
        # Both draw 'reading' from the same stream, but their scatter is not the same error.
        row = self.mean(self.a, self.result("c", reading=110.001))
        self.assertAlmostEqual(row["standard_uncertainty"], 0.005 / math.sqrt(2), delta=2 * self.RELATIVE * 0.005)

    def test_three_results_share_in_pairs(self):
        # The third has another reference: V = diag(9, 1, 4 + 16) with 16 between the first two.
        third = self.result("third", formula="reading - standard", reading=110, u_reading=2,
                            change=lambda t: t.replace("quantities.reference", "quantities.standard"))
        row = self.mean(self.a, self.b, third, "--same", "reference")
        first = 16 + 0.9
        u = math.sqrt(1 / (1 / first + 1 / 20)) / 1000
        self.assertAlmostEqual(row["standard_uncertainty"], u, delta=2 * self.RELATIVE * u)
        self.assertEqual(row["chi_squared_degrees_of_freedom"], 2)
        self.assertEqual(row["shared"][0]["contributions"][2], 0)

    def test_effective_degrees_of_freedom(self):
        # Two results with 5 degrees of freedom and equal u: (u^2 / 2)^2 / (2 (u / 2)^4 / 5) = 10 (JCGM 100, G.4.1). The
        # samples have u sqrt(5 / 3), of which the t quantile would count the degrees of freedom twice.
        plain = lambda t: t.replace('u = "4 um"\n', "").replace('u = "3 um"\n', 'u = "3 um"\ndegrees_of_freedom = 5\n')
        row = self.mean(*[self.result(f"few{k}", reading=110 + k / 1000, change=plain)
                          for k in range(2)])
        self.assertEqual(row["degrees_of_freedom"], 10)
        # The weights, 1/2 each, add 4 * 2 * (1/2)^2 / (5 - 2) to u^2 (Meier 1953).
        self.assertAlmostEqual(row["expanded_uncertainty"], 2.2281388520 * 0.003 / math.sqrt(2) * math.sqrt(5 / 3), delta=1e-9)

    def test_a_mean_does_not_move_with_the_seed(self):
        """Four readings each: by samples the standard deviation of a t with three degrees of freedom is anything."""
        few = lambda t: t.replace('u = "3 um"\n', 'u = "3 um"\ndegrees_of_freedom = 3\n').replace('u = "4 um"\n', "")
        means = []
        for seed in range(10, 130, 10):
            labs = [self.result(f"lab{k}", reading=110 + k / 1000, seed=seed + k, change=lambda t: few(t).replace(str(SAMPLES), "5000")) for k in range(3)]
            means.append(self.mean(*labs))
        self.assertEqual({round(m["standard_uncertainty"], 9) for m in means}, {round(0.003 * math.sqrt((1 + 8 / 3) / 3), 9)})
        self.assertEqual({m["degrees_of_freedom"] for m in means}, {9})

    def test_a_mean_of_three_observations_has_the_uncertainty_of_the_framework(self):
        """A t with two degrees of freedom has no variance, but u = s / sqrt(3) by GUM 4.2.3, and its U by G.4."""
        few = self.result("few", change=lambda text: text.replace('u = "3 um"\n', "").replace(
            'value = "10.0 mm"', 'observations = ["109.997 mm", "110.001 mm", "110.005 mm"]'))
        row = self.mean(self.a, few)
        va, vb = 3**2 + 4**2, 16 / 3 + 4**2
        p, freedom = va / (va + vb), 2 * (vb / (16 / 3))**2  # 32 effective degrees of freedom (G.4.1), of the weights (Meier 1953)
        more = 1 + 4 * p * (1 - p) / (round(freedom) - 2)
        self.assertAlmostEqual(row["standard_uncertainty"] * 1000, math.sqrt(more / (1 / va + 1 / vb)), delta=1e-9)
        self.assertAlmostEqual(row["results"][1]["weight"], va / (va + vb), delta=1e-9)
        said = gumshoe("compare", self.a, few, "--format", "json")
        one = json.loads(said.stdout)["comparisons"][0]
        self.assertAlmostEqual(one["standard_uncertainty"] * 1000, math.sqrt(va + vb), delta=2 * self.RELATIVE * 5)  # `before` is that of samples
        self.assertAlmostEqual(one["after"]["standard_uncertainty"] * 1000, math.sqrt(vb), delta=1e-9)
        self.assertGreater(one["after"]["expanded_uncertainty"] * 1000, K * math.sqrt(vb))  # k of few degrees of freedom
        self.assertLess(abs(one["normalised_error"]), 1)
        bend = '[quantities.zero]\nvalue = "110.004 mm"\n[quantities.bend]\nvalue = "1000 1/mm"\n[run]'
        bent = self.result("bent_too", formula="reading - reference + bend * (reading - zero)^2", reading=110.004,
                           change=lambda text: text.replace("[run]", bend))
        self.refused("y has no variance by Monte Carlo (the framework, which states its standard uncertainty, does not account for that of the others). "
                     "Leave the result out.", bent, few)

    def test_inconsistent_results_are_said(self):
        far = self.result("far", reading=110.030, u_reading=1)
        said = gumshoe("combine", self.a, far)
        self.assertEqual(said.returncode, 0)
        # Two are equally far from their mean: none of them is the likelier.
        self.assertIn("the results are not consistent, and U of the mean is too small: one of the two has an error that its budget lacks", said.stdout)
        three = gumshoe("combine", self.a, far, self.b)
        self.assertIn("a result, most likely number 2, has an error that its budget lacks", three.stdout)
        self.assertFalse(self.mean(self.a, far)["consistent"])
        self.assertTrue(self.mean(self.a, self.b)["consistent"])

    def test_order_changes_nothing(self):
        there, back = self.mean("--same", "reference", self.a, self.b), self.mean("--same=reference", self.b, self.a)
        for key in ("estimate", "standard_uncertainty", "chi_squared", "probability"):
            self.assertAlmostEqual(there[key], back[key], delta=1e-12 * abs(there[key]))

    def test_text(self):
        said = gumshoe("combine", self.a, self.b).stdout
        self.assertRegex(said, r"^y = \(10\.00\d+ \+- 0\.00\d+\) mm, k = 1\.96, 95 %\n  u = 3\.2 um; weighted mean of 2 results\n")
        self.assertIn("the budgets list alike: reference. Where one error is in several", said)
        self.assertIn("chi^2 = 0.8", said)
        self.assertIn("one error in several results: reference", gumshoe("combine", self.a, self.b, "--same", "reference").stdout)

    def test_the_mean_as_a_scenario_runs_to_the_same_result(self):
        out = self.folder / "mean.toml"
        row = self.mean(self.a, self.b, "--same", "reference", "--out", out)
        results = []
        for threads in (1, 2):
            h5 = self.folder / f"mean{threads}.h5"
            run = gumshoe("run", out, "--samples", SAMPLES, "--threads", threads, "--format", "json", "--out", h5)
            self.assertEqual(run.returncode, 0, run.stderr)
            one = json.loads(run.stdout)[0]
            with h5py.File(h5) as file:
                results.append(file["outputs/y"][:].tobytes())
        self.assertEqual(*results)
        self.assertAlmostEqual(one["estimate"], row["estimate"], delta=5 * 0.0042 / math.sqrt(SAMPLES))
        self.assertAlmostEqual(one["expanded_uncertainty"], row["expanded_uncertainty"],  # U of the samples
                               delta=2 * self.RELATIVE * row["expanded_uncertainty"])
        # Nothing else is replaced unasked.
        out.write_text("# mine\n")
        self.refused("not overwritten", self.a, self.b, "--out", out)

    def test_labels_and_several_measurands(self):
        two = [self.result(f"two{k}", reading=110 + k / 1000,
                           change=lambda t: t.replace('y = "', 'z = "reference"\ny = "')) for k in range(2)]
        self.assertEqual([m["output"] for m in self.combined(*two)["means"]], ["z", "y"])
        self.assertEqual([m["output"] for m in self.combined(*two, "--measurand", "y")["means"]], ["y"])
        self.assertEqual(self.combined(two[0], self.b)["single"], [f"z ({two[0]})"])
        self.refused("--out: a scenario has the mean of one measurand", *two, "--out", self.folder / "two.toml")
        self.refused("--measurand x: no two results have it", *two, "--measurand", "x")
        # The certificate's own length is all of z: two of them are one.
        self.refused("z: the results cannot be combined", *two, "--same", "reference", "--measurand", "z")

    def test_a_measurand_that_cannot_be_combined_does_not_stop_the_others(self):
        """z is the shared reference itself. y has 3 um of its own in each result and 4 um of the reference in both."""
        two = [self.result(f"some{k}", reading=110 + k / 1000,
                           change=lambda t: t.replace('y = "', 'z = "reference"\ny = "')) for k in range(2)]
        u = math.sqrt(16 + 9 / 2) / 1000
        for words in ((), ("--measurand", "y")):
            out = self.combined(*two, "--same", "reference", *words)
            self.assertEqual([m["output"] for m in out["means"]], ["y"])
            self.assertAlmostEqual(out["means"][0]["standard_uncertainty"], u, delta=2 * self.RELATIVE * u)
            self.assertEqual([row["output"] for row in out["left_out"]], [] if words else ["z"])
        said = gumshoe("combine", *two, "--same", "reference")
        self.assertEqual((said.returncode, said.stderr), (0, ""))
        self.assertIn("left out: z: the results cannot be combined (two of them differ by nothing but what they share)\n",
                      said.stdout)
        # The same of what else is wrong with one measurand: here the dimensions of z.
        other = self.result("metres", change=lambda t: t.replace('y = "', 'z = "reading / reference"\ny = "'))
        out = self.combined(two[0], other)
        self.assertEqual([m["output"] for m in out["means"]], ["y"])
        self.assertIn("different dimensions", out["left_out"][0]["what"])
        self.refused("--measurand x: no two results have it", self.a, self.b, "--measurand", "x")
        # If none can be combined, all are told.
        alone = [self.result(f"alone{k}", formula="reference", change=lambda t: t.replace('y = "', 'z = "reference"\ny = "'),
                             reading=110 + k / 1000) for k in range(2)]
        for name in "yz":
            self.refused(f"{name}: the results cannot be combined", *alone, "--same", "reference")

    def test_what_is_shared_and_squared_is_no_first_order(self):
        """r^2 is one error in both, whose covariance c_r u_r c_r u_r would be zero: they had agreed, E_n = 0.4."""
        def squared(name, reading, extra=""):
            return self.result(name, formula="reading + bend * reference^2", reading=reading, change=lambda t: t.replace(
                '"100 mm"', '"0 mm"').replace("[run]", '[quantities.bend]\nvalue = "100 1/mm"\n[run]') + extra)
        a, b = squared("square1", 10), squared("square2", 10.002)
        c, d = (squared(f"known{k}", 10 + k / 500, "sensitivity = { sobol = 4096 }\n") for k in range(2))
        for command in ("compare", "combine"):
            refused = gumshoe(command, a, b, "--same", "reference")
            self.assertEqual(refused.returncode, 2, refused.stdout)
            self.assertIn("y depends on reference otherwise than in proportion, or may", refused.stderr)
            self.assertIn("sobol", gumshoe(command, a, b, "--same", "reading").stderr)  # in proportion, or not?
            self.assertEqual(gumshoe(command, c, d, "--same", "reading").returncode, 0)
            self.assertIn("in one scenario.", gumshoe(command, c, d, "--same", "reference").stderr)

    def test_refusals(self):
        self.refused("a single result cannot be combined", self.a)
        copy = self.folder / "copy.h5"
        shutil.copy(self.a, copy)
        self.refused("are one measurement", self.a, self.b, copy)
        self.refused("not a quantity in the budgets of both results", self.a, self.b, "--same", "refrence")
        self.refused("Did you mean 'reference'?", self.a, self.b, "--same", "refrence")
        self.refused("different coverage probabilities", self.a, self.result("p99", p=0.99))
        self.refused("y: the results have different dimensions", self.a, self.result("ratio", formula="reading / reference"))
        self.refused("y has no standard uncertainty", self.a,
                     self.result("exact", change=lambda t: t.replace('u = "3 um"\n', "").replace('u = "4 um"\n', "")))
        other = self.result("other", change=lambda t: t.replace('y = "', 'other = "'))
        self.refused("no measurand in common", self.a, other)
        self.refused("missing.h5", self.a, self.folder / "missing.h5")
        self.refused("a.toml", self.folder / "a.toml", self.b)  # not a result
        self.refused("this is the file that is read", self.a, self.b, "--out", self.a)
        # A coefficient that does not exist at the estimate.
        kink = self.result("kink", formula="reading - reference + abs(reference - datum)", u_reading=1,
                           change=lambda t: t.replace("[run]", '[quantities.datum]\nvalue = "100 mm"\n[run]'))
        self.refused("y: what it shares is not known", self.a, kink, "--same", "reference")
        cell = self.folder / "cell.h5"
        shutil.copytree(ROOT / "scenarios", self.folder / "scenarios")
        run = gumshoe("trace", "scenarios/trace_load_cell.toml", "--draws", 19, "--out", cell, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.refused("holds no result to combine", self.a, cell)
        volume = self.folder / "volume.h5"
        self.assertEqual(gumshoe("volume", ROOT / "scenarios/volume_five_axis.toml", "--out", volume).returncode, 0)
        self.refused("gumshoe volume wrote it", self.a, volume)


if __name__ == "__main__":
    unittest.main()
