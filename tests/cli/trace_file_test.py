"""What a trace stores, and what it says on a terminal, from made-up outcomes of every kind.

usage: trace_file_test.py path/to/gumshoe [unittest options]
"""
import math
import re
import unittest

import h5py
import numpy as np

from made_traces import KINDS, Made, made, root_mean_square
from program import complaint, gumshoe


class File(Made):
    def test_every_dataset_says_what_it_is(self):
        def check(name, item):
            if isinstance(item, h5py.Dataset):
                self.assertTrue((item.attrs.get("units") or item.attrs["units_note"]) and item.attrs["long_name"], name)
                if item.attrs.get("CLASS") != b"DIMENSION_SCALE":
                    for dimension in item.dims:
                        self.assertEqual(len(dimension), 1, name)
                        self.assertTrue(dimension[0].name.endswith("/" + dimension.label), name)
        for kind in KINDS:
            with self.subTest(kind), h5py.File(self.file(kind)) as file:
                file.visititems(check)
                self.assertEqual((file.attrs["program"], file.attrs["complete"]), ("gumshoe", 1))
                self.assertTrue(file.attrs["scenario_text"] and file.attrs["scenario_hash"])
                self.assertEqual(file["trace"].attrs["verdict"], self.said[kind]["verdict"])

    def test_residuals_stand_beside_what_they_may_depend_on(self):
        with h5py.File(self.file("named")) as file:
            r, data = file["residuals"], file["data"]
            self.assertEqual(r["final"].attrs["flag_meanings"].split(), ["training", "final"])
            self.assertEqual(list(r["final"].attrs["flag_values"]), [0, 1])
            final = r["final"][()] == 1
            self.assertEqual({b.decode() for b in r["block"][()][final]}, {"7", "8"})
            self.assertEqual(r.attrs["blocks"], "setup")
            # The sizes that are told come from these rows.
            told = self.said["named"]["rms"]
            for side in ("before", "after"):
                self.assertAlmostEqual(root_mean_square(r[side][()][~final]) / told[side], 1, places=12)
                self.assertAlmostEqual(root_mean_square(r[side][()][final]) / told[f"holdout_{side}"], 1, places=12)
            # Slope against feed: the latency of 1.5 ms, on readings that go downwards, and nothing of it after.
            feed = data["conditions/feed"][()][r["reading"][()]]
            noise = r["noise_u"][0] / math.sqrt(np.sum((feed - feed.mean()) ** 2))
            slope = lambda side: np.polyfit(feed, r[side][()], 1)[0]
            self.assertAlmostEqual(slope("before"), -1.5e-3, delta=4 * noise)
            self.assertAlmostEqual(slope("after"), 0, delta=4 * noise)
            self.assertAlmostEqual(data["conditions/feed"].attrs["display_factor"], 60000)
            temperature = data["columns/temperature"]
            self.assertEqual((temperature.attrs["units"], temperature.attrs["display_units"]), ("K", "degC"))
            self.assertAlmostEqual(temperature[0] + temperature.attrs["display_offset"], 20)
            self.assertEqual([v.decode() for v in data["labels/rod"][()][[0, -1]]], ["rod 1", "rod 2"])

    def test_findings_with_all_their_sizes(self):
        with h5py.File(self.file("class")) as file:
            f = file["trace/findings/000"]
            self.assertEqual((f.attrs["kind"], len(f["members"])), ("class", 2))
            q = f["quantities"]
            self.assertEqual([m.decode() for m in q["member"]], ["thermal_growth", "rod_expansion"])
            self.assertEqual([m.decode() for m in q["units"]], ["m", "K-1"])
            shown = q["value"][()] * q["display_factor"][()]
            np.testing.assert_allclose(shown, [3.1, 11.2])
        with h5py.File(self.file("two_findings")) as file:
            curves = file["trace/findings/001/curves"]
            self.assertEqual([curves[k].attrs["against"] for k in curves], ["time", "setup"])
            self.assertEqual(len(curves["000/x"]), len(curves["000/y"]))
            self.assertEqual([v.decode() for v in curves["001/level"]], list("12345678"))
            self.assertEqual(curves["000"].attrs["size_display_units"], "um")
        with h5py.File(self.file("named")) as file:
            limits = file["trace/detection_limits/value"][()]
            self.assertTrue(np.isinf(limits[2]) and np.isfinite(limits[[0, 1, 3]]).all())
            self.assertEqual(file["budget_after/000"].attrs["units"], "m")
            self.assertNotIn("trigger_latency.delay", [n.decode() for n in file["budget_before/000/name"]])
        with h5py.File(self.file("insufficient_data")) as file:
            self.assertNotIn("candidates", file["trace"])
            self.assertTrue(math.isnan(file["trace/rms"].attrs["before"]))

    def test_no_samples_are_promised(self):
        for command in (("replay", self.file("named"), "--sample", 0), ("analyse", self.file("named"))):
            run = gumshoe(*command)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertIn("gumshoe trace made it", run.stderr)


class Text(unittest.TestCase):
    def test_for_a_terminal(self):
        text = made("named", "--text")
        self.assertIn("found: trigger_latency, p = 0.001\n", text)
        self.assertIn("delay = 1.520 ms, u = 0.041 ms, 95 % [1.430, 1.610]", text)
        self.assertRegex(text, r"in sample \(training data\) +1\.2 +0\.40 +0\.39 \(95 %: 0\.34 to 0\.44\)")
        self.assertIn("refused: within its uncertainty", text)
        text = made("class", "--text")
        self.assertRegex(text, r"either thermal_growth\n    growth = 3\.10 um.*\n  or rod_expansion\n    expansion = 11\.2 um/m/K")
        self.assertIn("to split them: let the spindle rest", text)
        self.assertIn("z_scale, scale: undetectable in these data", made("nothing_found", "--text"))
        text = made("insufficient_data", "--text")
        self.assertIn("these data cannot decide", text)
        for kind in KINDS:
            self.assertFalse({"nan", "inf"} & set(re.split(r"\W+", made(kind, "--text"))), kind)


if __name__ == "__main__":
    unittest.main()
