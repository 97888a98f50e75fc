"""gumshoe trace says what is left: what repeats, what scatters, which reading or block differs.

usage: trace_floor_test.py path/to/gumshoe [unittest options]
"""
import json
import pathlib
import sys
import unittest

from program import InFolder, gumshoe

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "recovery"))
import repeats

SEEDS = 5


class Floor(InFolder):
    def trace(self, missing, seed=1, *words):
        repeats.write(self.folder, missing, seed)
        run = gumshoe("trace", "s.toml", "--force", "--threads", "1", *(words or ("--format", "json")), cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout if words else json.loads(run.stdout)

    def each(self, missing):
        return [self.trace(missing, seed) for seed in range(1, SEEDS + 1)]

    def test_the_floor_is_the_scatter_of_a_reading(self):
        """Whatever repeats, drifts, is bad in one reading or shifts a block: 1 um. Four cycles of 18 leave about 36 degrees
        of freedom, so that the mean of five is known within 5 %; 0.2 is four of that."""
        for missing in ("nothing", "alternating_reversal", "correlated_pattern", "drift_by_position", "first_cycle_shifted", "one_bad"):
            floors = [v["rms"]["replicate_floor"] * 1e6 for v in self.each(missing)]
            self.assertAlmostEqual(sum(floors) / SEEDS, 1, delta=0.2, msg=missing)

    def test_the_interval_of_the_floor_holds_the_truth(self):
        """In 95 of 100; of 15, fewer than 11 have a chance of 1 in 5,000."""
        intervals = [v["rms"]["replicate_floor_interval95"] for m in ("nothing", "alternating_reversal", "drift_by_position")
                     for v in self.each(m)]
        self.assertGreaterEqual(sum(low < 1e-6 < high for low, high in intervals), 11)

    def test_what_repeats_is_no_scatter(self):
        """Neither labels nor serial correlation take what comes back in every cycle."""
        for missing in ("alternating_reversal", "correlated_pattern"):
            for v in self.each(missing):
                self.assertEqual(v["verdict"], "not_in_catalogue")
                self.assertEqual(v["findings"][0]["depends_on"], ["x", "direction"])
                self.assertLess(v["noise"]["correlation"], 0.5)
                self.assertLess(v["rms"]["after"], 1.3e-6)
                self.assertFalse(v["lack_of_fit"]["found"])

    def test_lack_of_fit_is_a_verdict(self):
        """A reading comes back without a condition that says how: its place in the block does, and two labels together."""
        repeats.write_unrecorded(self.folder, sides=2)
        v = json.loads(gumshoe("trace", "s.toml", "--format", "json", "--threads", "1", cwd=self.folder).stdout)
        self.assertEqual(v["verdict"], "lack_of_fit")
        self.assertAlmostEqual(v["lack_of_fit"]["size"] * 1e6, 3, delta=0.5)
        self.assertIn("run", v["lack_of_fit"]["depends_on"])
        self.assertTrue(v["plain"][0].startswith("A repeatable part of"), v["plain"])

    def test_noise_alone_and_after_compare(self):
        """Both are the noise that was put in, 1 um; the fit's own noise would agree with its residuals whatever they are. 72
        readings less four offsets and two coefficients or so leave 66 degrees of freedom, so that one is known within 9 %, the
        mean of five within 4 %: the limits are four of these. The 18 held-out readings, which the fit did not see, lie within
        their interval in 95 of 100; fewer than three of five do so in 1 of 860."""
        all_ = self.each("nothing")
        for what in ("after", "noise"):
            sizes = [1e6 * v["rms"][what] for v in all_]
            self.assertTrue(all(abs(size - 1) < 0.36 for size in sizes), (what, sizes))
            self.assertAlmostEqual(sum(sizes) / SEEDS, 1, delta=0.16, msg=what)
        holds = lambda name, x: sum(low < x(v["rms"]) < high for v in all_ for low, high in [v["rms"][name]])
        self.assertGreaterEqual(holds("noise_interval95", lambda r: 1e-6), 3)
        self.assertGreaterEqual(holds("holdout_noise_interval95", lambda r: r["holdout_after"]), 3)

    def test_the_bad_reading_is_named(self):
        v = self.trace("one_bad")
        self.assertEqual(len(v["outliers"]), 1)
        bad = v["outliers"][0]
        self.assertEqual(bad["block"], "cycle 3")
        self.assertIn("x 350 mm", bad["reading"])
        self.assertAlmostEqual(bad["residual"], 30, delta=4)  # um
        self.assertIn(bad["reading"], self.trace("one_bad", 1, "--format", "text"))

    def test_the_block_that_differs_is_named(self):
        for v in self.each("first_cycle_shifted"):
            self.assertEqual([f["described_by"] for f in v["findings"]], ["step:cycle 1"])
            self.assertEqual(v["plain"][0], "cycle 1 differs from the others by a constant.")
        named = [[b["name"] for b in v["anomalous_blocks"]] for v in self.each("third_cycle_noisy")]
        self.assertGreaterEqual(sum("cycle 3" in names for names in named), 3)
        self.assertFalse(any(set(names) - {"cycle 3"} for names in named))

    def test_a_held_out_error_beyond_its_interval_comes_first(self):
        for v in self.each("last_cycle_tilted"):
            self.assertTrue(v["plain"][0].startswith("Held-out readings differ from the model by"), v["plain"])
            self.assertIn("cycle 5, x 400 mm", v["plain"][0])

    def test_nothing_agrees_whose_chance_is_small(self):
        for missing in repeats.MISSING:
            for v in self.each(missing):
                if v["p_anything"] <= v["alpha"]:
                    self.assertNotIn("agree", " ".join(v["plain"]), missing)

    def test_a_veto_leaves_no_finding_beside_it(self):
        """What is listed was added, or it is one shape without a cause, which is reported only."""
        for missing in repeats.MISSING:
            for v in self.each(missing):
                if v["vetoed"] and v["findings"]:
                    kinds = [f["kind"] for f in v["findings"] if f["kind"] != "scatter"]
                    self.assertIn(kinds, ([], ["not_in_catalogue"]), missing)

    def test_scatter_outlives_a_veto_beside_it(self):
        """The declared model shows it, too. Its size is that of 18 clampings: within four of its standard errors of 5 um. What
        noise there is, is that of what stands, not of what was rejected."""
        repeats.write_turning_slope(self.folder)
        v = json.loads(gumshoe("trace", "s.toml", "--format", "json", "--threads", "1", cwd=self.folder).stdout)
        self.assertTrue(v["vetoed"])
        self.assertEqual(sorted(f["kind"] for f in v["findings"]), ["not_in_catalogue", "scatter"])
        scatter = next(f for f in v["findings"] if f["kind"] == "scatter")
        self.assertEqual(scatter["members"], ["scatter:day,clamp"])
        self.assertAlmostEqual(scatter["quantities"][0]["value"], 5, delta=4 * 5 / 36**0.5)
        self.assertGreater(v["noise"]["scale"], 1.8)  # a slope over 500 mm of +-2.5 um is left, of 1.7 um


if __name__ == "__main__":
    unittest.main()
