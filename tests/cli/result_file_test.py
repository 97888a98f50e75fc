"""The result file opens in h5py and xarray without options and says what its numbers are."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np
import xarray

ROOT = pathlib.Path(__file__).resolve().parents[2]
GUMSHOE = sys.argv.pop(1)
SAMPLES = 20000


class ResultFile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = os.path.join(cls.folder.name, "rod.h5")
        subprocess.run([GUMSHOE, "run", "scenarios/rod_gauging.toml", "--samples", str(SAMPLES), "--out", cls.path],
                       cwd=ROOT, check=True, capture_output=True, text=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_root_says_how_it_was_made(self):
        with h5py.File(self.path) as file:
            for name in ("version", "git_hash", "instruction_set", "model", "method", "scenario_text", "scenario_hash"):
                self.assertIsInstance(file.attrs[name], str)
                self.assertTrue(file.attrs[name], name)
            self.assertEqual(file.attrs["program"], "gumshoe")
            self.assertEqual(file.attrs["format_version"], 1)
            self.assertEqual(file.attrs["complete"], 1)
            self.assertEqual(file.attrs["samples"], SAMPLES)
            self.assertEqual(file["samples_done"][0], SAMPLES)
            text = (ROOT / "scenarios/rod_gauging.toml").read_text(encoding="utf-8")
            self.assertEqual(file.attrs["scenario_text"], text)

    def test_every_dataset_has_units_name_and_named_dimensions(self):
        seen = []

        def check(name, item):
            if not isinstance(item, h5py.Dataset):
                return
            seen.append(name)
            self.assertTrue(item.attrs["units"], name)
            self.assertTrue(item.attrs["long_name"], name)
            if item.attrs.get("CLASS") == b"DIMENSION_SCALE":
                return
            for dimension in item.dims:
                self.assertTrue(dimension.label, name)
                self.assertEqual(len(dimension), 1, name)  # one scale attached
                self.assertTrue(dimension[0].name.endswith("/" + dimension.label), name)

        with h5py.File(self.path) as file:
            file.visititems(check)
            self.assertEqual(file["outputs/laser_z"].attrs["units"], "m")
            self.assertEqual(file["outputs/laser_z"].attrs["display_units"], "mm")
            self.assertAlmostEqual(file["outputs/laser_z"].attrs["display_factor"], 1000, places=9)
            self.assertEqual([d.label for d in file["outputs/laser_z"].dims], ["reading", "sample"])
        for name in ("summary/estimate", "budget/000/share", "outputs/status", "inputs/value", "readings/spindle_z"):
            self.assertIn(name, seen)

    def test_status_carries_cf_flags(self):
        with h5py.File(self.path) as file:
            status = file["outputs/status"]
            values, meanings = status.attrs["flag_values"], status.attrs["flag_meanings"].split()
            self.assertEqual(len(values), len(meanings))
            self.assertEqual(values.dtype, status.dtype)
            self.assertEqual(meanings[0], "ok")
            self.assertTrue(set(np.unique(status[()])) <= set(values))
            failed = status[()] != 0
            self.assertEqual(failed.sum(), file.attrs["failed"])
            for name in np.unique([m.decode() for m in file["summary/measurand"][()]]):
                covered = {int(r) for m, r in zip(file["summary/measurand"][()], file["summary/reading"][()])
                           if m.decode() == name}
                for reading in covered:
                    np.testing.assert_array_equal(np.isnan(file[f"outputs/{name}"][reading]), failed)

    def test_xarray_finds_names_and_the_summary_agrees(self):
        outputs = xarray.open_dataset(self.path, group="outputs", engine="netcdf4")
        summary = xarray.open_dataset(self.path, group="summary", engine="netcdf4")
        self.assertEqual(outputs["laser_z"].dims, ("reading", "sample"))
        self.assertEqual(outputs.sizes["sample"], SAMPLES)
        self.assertEqual(outputs["laser_z"].attrs["units"], "m")
        self.assertIn("reading", outputs.coords)
        self.assertEqual(summary["estimate"].dims, ("output",))
        for k in range(summary.sizes["output"]):
            row = summary.isel(output=k)
            values = outputs[str(row["measurand"].values)].isel(reading=int(row["reading"])).values
            values = values[np.isfinite(values)]
            self.assertEqual(len(values), int(row["valid"]))
            mean = np.sum(values.astype(np.longdouble)) / len(values)
            self.assertLess(abs(float(row["estimate"]) - mean), 1e-12 * abs(mean))
            if np.isfinite(row["standard_uncertainty"]):
                # The mean's rounding, 1e-16 of the estimate per value, bounds what u can lose.
                u = np.std(values.astype(np.longdouble), ddof=1)
                self.assertLess(abs(float(row["standard_uncertainty"]) - u), 1e-9 * u)
            inside = np.mean((values >= float(row["symmetric_low"])) & (values <= float(row["symmetric_high"])))
            with h5py.File(self.path) as file:
                self.assertLess(abs(inside - file.attrs["coverage_probability"]), 2 / len(values) + 1e-12)
        outputs.close()
        summary.close()

    def test_histogram_is_a_density(self):
        with h5py.File(self.path) as file:
            density, edges = file["summary/histogram_000"][()], file["summary/histogram_edges_000"][()]
            self.assertEqual(len(edges), len(density) + 1)
            self.assertAlmostEqual(float(np.sum(density * np.diff(edges))), 1, delta=1e-9)

    def test_same_run_again_same_numbers(self):
        again = os.path.join(self.folder.name, "again.h5")
        subprocess.run([GUMSHOE, "run", "scenarios/rod_gauging.toml", "--samples", str(SAMPLES), "--threads", "1",
                        "--out", again], cwd=ROOT, check=True, capture_output=True)
        with h5py.File(self.path) as a, h5py.File(again) as b:
            np.testing.assert_array_equal(a["outputs/laser_z"][()], b["outputs/laser_z"][()])
            np.testing.assert_array_equal(a["summary/estimate"][()], b["summary/estimate"][()])


if __name__ == "__main__":
    unittest.main()
