"""Outputs of earlier runs as input quantities: value, shape, degrees of freedom, and what they depend on together.

usage: from_result_test.py path/to/gumshoe [unittest options]
"""
import math
import shutil
import unittest

import h5py
import numpy as np

from lengths import Lengths
from program import ROOT, gumshoe

SAMPLES = 100_000
SE = 5 / math.sqrt(2 * SAMPLES)  # 5 relative standard errors of a u

SUM = """schema = 1
[model]
name = "expression"
[model.measurands]
{measurands}
[quantities]
{quantities}
[run]
samples = 100000
"""


class FromResult(Lengths):
    COMMAND, SAMPLES = "run", SAMPLES

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.a = cls.result("a")
        cls.b = cls.result("b", reading=10.006, u_reading=1, seed=2)
        cls.pair = cls.ran("pair", measurands='s = "p + q"\nd = "p - q"\nr = "p^2"',
                           quantities='p = { value = "1", u = "0.2" }\nq = { value = "3", u = "0.1" }')

    @classmethod
    def ran(cls, name, measurands, quantities, more=""):
        file = cls.write(name, measurands, quantities, more)
        out = cls.folder / f"{name}.h5"
        run = gumshoe("run", file, "--out", out)
        assert run.returncode == 0, run.stderr
        return out

    @classmethod
    def write(cls, name, measurands, quantities, more=""):
        file = cls.folder / f"{name}.toml"
        file.write_text(SUM.format(measurands=measurands, quantities=quantities) + more)
        return file

    def figures(self, result, output="y"):
        with h5py.File(result) as f:
            names = [n.decode() for n in f["summary/name"][:]]
            row = names.index(output)
            budget = f[f"budget/{row:03d}"]
            return {"estimate": f["summary/estimate"][row], "u": f["summary/standard_uncertainty"][row],
                    "u_c": budget.attrs.get("combined_standard_uncertainty", budget["combined_standard_uncertainty"][()]
                                            if "combined_standard_uncertainty" in budget else None),
                    "values": f["outputs/" + output][:].ravel()}

    def refused(self, name, quantities, *words):
        run = gumshoe("check", self.write(name, 'y = "x"', quantities))
        self.assertEqual(run.returncode, 2, run.stdout)
        for word in words:
            self.assertIn(word, run.stderr)
        self.assertIn(f"{name}.toml:", run.stderr)

    def test_an_output_keeps_its_estimate_u_and_shape(self):
        out = self.ran("square", 'y = "x"', 'x = { from = "pair.h5:r" }')
        new, old = self.figures(out), self.figures(self.pair, "r")
        self.assertAlmostEqual(new["u"], np.std(old["values"]), delta=SE * new["u"])
        self.assertAlmostEqual(new["estimate"], old["estimate"], delta=5 * new["u"] / math.sqrt(SAMPLES))
        # The law of propagation knows the u of the samples exactly.
        self.assertAlmostEqual(new["u_c"], np.std(old["values"]), delta=1e-9)
        for share in (0.025, 0.5, 0.975):  # the order statistic's standard error, by the density near it
            a, b = np.quantile(old["values"], share), np.quantile(new["values"], share)
            width = np.diff(np.quantile(old["values"], [share - 0.01, share + 0.01]))[0] / 0.02
            self.assertAlmostEqual(a, b, delta=5 * width * math.sqrt(share * (1 - share) / SAMPLES))

    def test_a_component_is_a_deviation_with_its_estimate_whatever_is_stored(self):
        """y = 5 +- 0.2, as samples, as figures alone, and exact, on a value of 10."""
        uncertain = ('y = "a"', 'a = { value = "5", u = "0.2" }')
        self.ran("kept", *uncertain)
        self.ran("not_kept", *uncertain, more="store_samples = false\n")
        self.ran("exact", 'y = "a"', 'a = { value = "5" }')
        for earlier in ("kept", "not_kept", "exact"):
            for value, total in (('value = "10", ', 15), ("", 5)):
                with self.subTest(earlier, value=value):
                    text = f'x = {{ {value}components = [{{ name = "c", from = "{earlier}.h5:y" }}, {{ name = "d", u = "0.1" }}] }}'
                    new, u = self.figures(self.ran("sum_" + earlier + str(total), 'y = "x"', text)), 0.1 if earlier == "exact" else math.hypot(0.2, 0.1)
                    self.assertAlmostEqual(new["estimate"], total, delta=5 * 0.3 / math.sqrt(SAMPLES))
                    self.assertAlmostEqual(new["u"], u, delta=2 * SE * u)

    def test_outputs_of_one_file_keep_their_joint_distribution(self):
        """Sums of rectangular inputs, whose dependence no Gaussian copula has: every new sample is one of the earlier run."""
        self.ran("sums", 'p = "a + b"\nq = "a - 2 * b"', 'a = { value = "1", half_width = "0.3", distribution = "rectangular" }\n'
                 'b = { value = "3", half_width = "0.2", distribution = "rectangular" }')
        two = 'p = { from = "sums.h5:p" }\nq = { from = "sums.h5:q" }'
        new = self.figures(self.ran("of_both", 'y = "p + q"', two))
        with h5py.File(self.folder / "sums.h5") as f:
            earlier = np.sort((f["outputs/p"][:] + f["outputs/q"][:]).ravel())
        at = np.clip(np.searchsorted(earlier, new["values"]), 1, len(earlier) - 1)
        off = np.minimum(np.abs(earlier[at] - new["values"]), np.abs(earlier[at - 1] - new["values"]))
        shift = 1e-5  # the samples are about the estimate, of which their mean differs by a part of its standard error
        self.assertLess(off.max(), 1e-3 * np.std(earlier) + shift)
        self.assertAlmostEqual(new["u_c"], np.std(earlier), delta=1e-9)
        self.assertAlmostEqual(new["u"], np.std(earlier), delta=SE * new["u"])
        for share in (0.005, 0.025, 0.2, 0.8, 0.975, 0.995):
            self.assertAlmostEqual(np.quantile(new["values"], share), np.quantile(earlier, share), delta=0.003)
        run = gumshoe("check", self.folder / "of_both.toml")
        self.assertIn("drawn together", run.stdout)
        # Given one of them the other is drawn by its correlation alone, which Shapley effects need, and nothing else does.
        self.assertNotIn("Gaussian copula", run.stdout)
        text = (self.folder / "of_both.toml").read_text() + "\n[analysis]\nsensitivity = { shapley = 64 }\n"
        (self.folder / "shared.toml").write_text(text)
        self.assertIn("Shapley effects: p, q are drawn given one another as by a Gaussian copula", gumshoe("check", self.folder / "shared.toml").stdout)

    def test_two_outputs_of_one_file_keep_their_correlation(self):
        out = self.ran("both", 'y = "s + d"\nz = "s"', 's = { from = "pair.h5:s" }\nd = { from = "pair.h5:d" }')
        # s + d = 2 p, of which u is 0.4; of independent s and d it would be 0.316.
        new = self.figures(out)
        self.assertAlmostEqual(new["u"], 0.4, delta=2 * SE * 0.4)
        self.assertAlmostEqual(new["u_c"], 0.4, delta=2 * SE * 0.4)
        rho = np.corrcoef(self.figures(out)["values"], self.figures(out, "z")["values"])[0, 1]
        self.assertAlmostEqual(rho, 2 * 0.04 / (0.4 * math.sqrt(0.05)), delta=5 / math.sqrt(SAMPLES))

    def test_results_with_one_certificate(self):
        two = 'x = {{ from = "a.h5:y"{0} }}\nw = {{ from = "b.h5:y"{0} }}'
        independent = gumshoe("check", self.write("loose", 'y = "x - w"', two.format("")))
        self.assertIn("treated as independent", independent.stdout + independent.stderr)
        self.assertAlmostEqual(self.figures(self.ran("loose", 'y = "x - w"', two.format("")))["u"],
                               math.sqrt(3**2 + 1 + 2 * 4**2) * 1e-6, delta=2 * SE * 7e-6)
        tied = self.ran("tied", 'y = "x - w"', two.format(', same = ["reference"]'))
        # The reference cancels: sqrt(3^2 + 1) um is left. Its u from samples has an error of the u of x and w.
        self.assertAlmostEqual(self.figures(tied)["u"], math.sqrt(10) * 1e-6, delta=4 * SE * 7e-6)

    def test_an_error_of_a_result_that_the_scenario_states_itself(self):
        own = 'x = { from = "a.h5:y", same = ["reference"] }\nreference = { value = "100 mm", u = "UU um" }'
        out = self.ran("own", 'y = "x + reference"', own.replace("UU", "4"))  # back to the reading
        self.assertAlmostEqual(self.figures(out)["u"], 3e-6, delta=4 * SE * 7e-6)
        self.refused("other_u", own.replace("UU", "5") + '\n', "'reference' has u = 5e-06 here and 4e-06 in ",
                     "one error has one uncertainty")

    def test_what_is_left_of_a_result_less_an_error_of_it_is_the_rest(self):
        """A reference and the mean of five observations: the variance of the t drawn is twice the framework's u squared."""
        few = self.ran("with_mean", 'y = "reference + d"', 'reference = { value = "100 mm", u = "5 um" }\n'
                       'd = { value = "0 mm", u = "4 um", degrees_of_freedom = 4 }')
        out = self.ran("rest", 'y = "x - reference"', f'x = {{ from = "{few.name}:y", same = ["reference"] }}\n'
                       'reference = { value = "100 mm", u = "5 um" }')
        new = self.figures(out)
        self.assertAlmostEqual(new["u_c"], 4e-6, delta=1e-10)
        # 4 um sqrt(4 / 2), from two draws of which each has a u of 7.5 um and 5 um: u^2 of the t to 2 %.
        self.assertAlmostEqual(new["u"], 4e-6 * math.sqrt(2), delta=0.03 * 5.7e-6)

    def test_degrees_of_freedom_go_on(self):
        few = self.ran("few", 'y = "a"', 'a = { value = "1 mm", u = "1 um", degrees_of_freedom = 4 }')
        out = self.ran("of_few", 'y = "x + b"', f'x = {{ from = "{few.name}:y" }}\nb = {{ value = "0 mm", u = "1 um" }}')
        new = self.figures(out)
        self.assertAlmostEqual(new["u_c"], math.sqrt(2) * 1e-6, delta=1e-12)
        with h5py.File(out) as f:
            budget = f["budget/000"]
            freedom = budget.attrs.get("effective_degrees_of_freedom")
            freedom = budget["effective_degrees_of_freedom"][()] if freedom is None else freedom
        self.assertEqual(freedom, 16)  # Welch and Satterthwaite: (1 + 1)^2 / (1 / 4)
        # Monte Carlo keeps the t distribution: its variance is 4 / (4 - 2) of that.
        self.assertAlmostEqual(new["u"], math.sqrt(3) * 1e-6, delta=0.05e-6)

    def budget(self, result, output):
        with h5py.File(result) as f:
            names = [n.decode() for n in f["summary/name"][:]]
            budget = f[f"budget/{names.index(output):03d}"]
            get = lambda name: budget.attrs[name] if name in budget.attrs else budget[name][()]
            return get("combined_standard_uncertainty"), get("effective_degrees_of_freedom")

    def test_the_law_of_propagation_takes_results_together_as_their_budgets_do(self):
        """y = a + b and z = a - b, a with 4 degrees of freedom: the samples of a have twice the variance u^2, so that their
        correlation is 5/7 and that of the budgets 1/2. y - z = 2 b and y + z = 2 a know nothing of the other input."""
        two = 'a = { value = "3 um", u = "1 um", degrees_of_freedom = 4 }\n' \
              'b = { value = "1 um", distribution = "rectangular", half_width = "1 um" }'
        few = self.ran("sum_and_difference", 'y = "a + b"\nz = "a - b"\nt = "2 * y"', two)
        c = 'c = { value = "1 um", u = "0.5 um", degrees_of_freedom = 9 }'
        out = self.ran("of_sum_and_difference", 'v = "p - q + c"\nw = "p + q + c"',
                       f'p = {{ from = "{few.name}:y" }}\nq = {{ from = "{few.name}:z" }}\n{c}')
        for output, u in (("v", math.sqrt(4 / 3 + 0.25)), ("w", math.sqrt(4 + 0.25))):
            u_c, freedom = self.budget(out, output)
            self.assertAlmostEqual(u_c, u * 1e-6, delta=1e-11)
            self.assertTrue(math.isnan(freedom), freedom)  # 361 and 4; y and z have 7 each, which no sum of them has
        shown = gumshoe("analyse", out, "--budget").stdout
        self.assertIn("no effective degrees of freedom", shown)
        # The samples are still those of the earlier run, a with its own variance.
        self.assertAlmostEqual(self.figures(out, "v")["u"], math.sqrt(4 / 3 + 0.25 * 9 / 7) * 1e-6, delta=2 * SE * 1.3e-6)
        # One error has its degrees of freedom in every sum.
        both = self.ran("of_one_error", 'w = "p + q"', f'p = {{ from = "{few.name}:y" }}\nq = {{ from = "{few.name}:t" }}')
        u_c, freedom = self.budget(both, "w")
        self.assertAlmostEqual(u_c, 3 * math.sqrt(4 / 3) * 1e-6, delta=1e-11)
        self.assertEqual(freedom, math.floor((4 / 3)**2 * 4))

    def test_estimates_with_one_s_keep_its_degrees_of_freedom(self):
        one = self.ran("one_s", 'y = "2 * a"\nz = "3 * a"', 'a = { value = "3 um", u = "1 um", degrees_of_freedom = 4 }')
        out = self.ran("of_one_s", 'w = "p + q"', f'p = {{ from = "{one.name}:y" }}\nq = {{ from = "{one.name}:z" }}')
        u_c, freedom = self.budget(out, "w")
        self.assertAlmostEqual(u_c, 5e-6, delta=1e-11)
        self.assertEqual(freedom, 4)

    def test_budgets_that_do_not_account_for_u_are_said(self):
        """The square of b has no first order at 0: how it depends on a + b is in the samples alone."""
        few = self.ran("square_of_one", 'y = "a + b"\nz = "b^2"', 'a = { value = "3", u = "1", degrees_of_freedom = 4 }\n'
                       'b = { value = "0.1", u = "1" }')
        file = self.write("of_square", 'w = "p + q"', f'p = {{ from = "{few.name}:y" }}\nq = {{ from = "{few.name}:z" }}')
        self.assertIn("p, q: the law of propagation takes the correlation of their samples", gumshoe("check", file).stdout)

    def test_a_result_without_samples_is_normal_or_t(self):
        bare = self.ran("bare", 'y = "a"', 'a = { value = "1 mm", u = "1 um" }', "store_samples = false\n")
        file = self.write("of_bare", 'y = "x"', 'x = { from = "bare.h5:y" }')
        self.assertIn("its samples are not stored", gumshoe("check", file).stdout)
        self.assertAlmostEqual(self.figures(self.ran("of_bare", 'y = "x"', 'x = { from = "bare.h5:y" }'))["u"], 1e-6,
                               delta=2 * SE * 1e-6)

    def test_a_component_and_a_deviation_from_a_value(self):
        out = self.ran("deviation", 'y = "x + z"',
                       'x = { value = "100 mm", from = "a.h5:y" }\n'
                       'z = { value = "0 mm", components = [{ from = "b.h5:y" }, { u = "2 um" }] }')
        new = self.figures(out)
        self.assertAlmostEqual(new["estimate"], 0.1 + (10 - 100 + 10.006 - 100) * 1e-3, delta=1e-7)

    def test_a_changed_result_changes_the_run(self):
        mine = self.folder / "mine.h5"
        shutil.copy(self.a, mine)
        file = self.write("later", 'y = "x"', 'x = { from = "mine.h5:y" }')
        out = self.folder / "later.h5"
        self.assertEqual(gumshoe("run", file, "--out", out).returncode, 0)
        first = self.figures(out)["values"]
        again = gumshoe("run", file, "--out", out)
        self.assertEqual(again.returncode, 0, again.stderr)
        np.testing.assert_array_equal(first, self.figures(out)["values"])
        shutil.copy(self.b, mine)
        self.assertEqual(gumshoe("run", file, "--out", out).returncode, 0)
        self.assertNotEqual(first.mean(), self.figures(out)["values"].mean())
        replay = gumshoe("replay", out, "--sample", "7")
        self.assertEqual(replay.returncode, 0, replay.stderr)

    def test_mistakes_are_named(self):
        self.refused("no_colon", 'x = { from = "a.h5" }', "FILE.h5:OUTPUT")
        self.refused("no_file", 'x = { from = "none.h5:y", unit = "mm" }', "none.h5")
        self.refused("no_output", 'x = { from = "pair.h5:t" }', "it has s, d, r")
        self.refused("unit", 'x = { from = "a.h5:y", unit = "deg" }', "is in mm")
        self.refused("two", 'x = { from = "a.h5:y", u = "1 um" }', "the result states the uncertainty")
        self.refused("same", 'x = { from = "a.h5:y", same = ["referense"] }', "Did you mean 'reference'?")
        self.refused("alone", 'x = { from = "a.h5:y", same = ["reference"] }', "nothing else here has 'reference'")
        self.refused("one_of_two", 'x = { from = "pair.h5:s", same = ["p"] }\nw = { from = "pair.h5:d" }\np = { value = "1", u = "0.2" }',
                     ":8:5: error: w is of the same run as x, and 'p' is in the budget of both", 'Add same = ["p"] to w')
        self.refused("no_from", 'x = { value = "1 mm", u = "1 um", same = ["a"] }', "there is no result")
        (self.folder / "text.h5").write_text("no result")
        shard, trace = self.folder / "shard.h5", self.folder / "trace.h5"
        self.assertEqual(gumshoe("run", self.folder / "a.toml", "--shard", "1/2", "--out", shard).returncode, 0)
        self.refused("shard", 'x = { from = "shard.h5:y", unit = "mm" }', "it is shard 1/2 of a run", "gumshoe merge")
        self.assertEqual(gumshoe("trace", ROOT / "scenarios/trace_thermometer.toml", "--out", trace).returncode, 0)
        self.refused("trace", 'x = { from = "trace.h5:y", unit = "mm" }', "holds no outputs", "gumshoe trace wrote it")
        self.refused("text", 'x = { from = "text.h5:y", unit = "mm" }', "text.h5")


if __name__ == "__main__":
    unittest.main()
