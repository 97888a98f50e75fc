"""The result file opens in h5py and xarray without options and says what its numbers are."""
import subprocess
import unittest
import warnings

import h5py
import netCDF4
import numpy as np
import xarray

from program import GUMSHOE, MADE, ROOT, InOneFolder

SAMPLES = 20000


def check_dataset(test, name, item):
    """Units, a name, and one scale on each dimension. Whether it is a dataset at all."""
    if not isinstance(item, h5py.Dataset):
        return False
    test.assertTrue(item.attrs.get("units") or item.attrs["units_note"], name)
    test.assertNotRegex(item.attrs.get("units", ""), "see |units", name)  # programs parse it
    test.assertTrue(item.attrs["long_name"], name)
    if item.attrs.get("CLASS") != b"DIMENSION_SCALE":
        for dimension in item.dims:
            test.assertTrue(dimension.label, name)
            test.assertEqual(len(dimension), 1, name)  # one scale attached
            test.assertTrue(dimension[0].name.endswith("/" + dimension.label), name)
    return True


class ResultFile(InOneFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.path = cls.folder / "rod.h5"
        subprocess.run([GUMSHOE, "run", "scenarios/rod_gauging.toml", "--samples", str(SAMPLES), "--out", cls.path],
                       cwd=ROOT, check=True, capture_output=True, text=True)

    def test_root_says_how_it_was_made(self):
        with h5py.File(self.path) as file:
            for name in ("version", "git_hash", "instruction_set", "model", "method", "scenario_text", "scenario_hash"):
                self.assertIsInstance(file.attrs[name], str)
                self.assertTrue(file.attrs[name], name)
            self.assertEqual(file.attrs["program"], "gumshoe")
            self.assertEqual(file.attrs["format_version"], 2)
            self.assertEqual(file.attrs["complete"], 1)
            self.assertEqual(file.attrs["samples"], SAMPLES)
            self.assertEqual(file["samples_done"][0], SAMPLES)
            text = (ROOT / "scenarios/rod_gauging.toml").read_text(encoding="utf-8")
            self.assertEqual(file.attrs["scenario_text"], text)

    def test_every_dataset_has_units_name_and_named_dimensions(self):
        seen = []

        def check(name, item):
            if check_dataset(self, name, item):
                seen.append(name)

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
        again = self.folder / "again.h5"
        subprocess.run([GUMSHOE, "run", "scenarios/rod_gauging.toml", "--samples", str(SAMPLES), "--threads", "1",
                        "--out", again], cwd=ROOT, check=True, capture_output=True)
        with h5py.File(self.path) as a, h5py.File(again) as b:
            np.testing.assert_array_equal(a["outputs/laser_z"][()], b["outputs/laser_z"][()])
            np.testing.assert_array_equal(a["summary/estimate"][()], b["summary/estimate"][()])


class EveryStudy(InOneFolder):
    """A made-up result with all groups, as the store writes it."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.path = cls.folder / "full.h5"
        subprocess.run([MADE, cls.path], check=True)

    def groups(self):
        found = []
        with h5py.File(self.path) as file:
            file.visititems(lambda name, item: found.append(name) if isinstance(item, h5py.Group) else None)
        return found

    def test_every_dataset_has_units_name_and_named_dimensions(self):
        with h5py.File(self.path) as file:
            file.visititems(lambda name, item: check_dataset(self, name, item))

    def test_every_group_opens_in_xarray_without_complaint(self):
        groups = self.groups()
        for name in ("sensitivity/000", "sensitivity/000/pairs", "shapley/000", "given_data/000", "morris/000",
                     "dgsm/000", "one_at_a_time/000", "joint/001", "fit/000", "circular", "conformity", "target/000",
                     "stopping"):
            self.assertIn(name, groups)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for name in groups:
                with xarray.open_dataset(self.path, group=name, engine="netcdf4") as group:
                    for variable in group.variables.values():
                        self.assertTrue(variable.attrs["long_name"], name)

    def test_netcdf4_finds_every_dimension(self):
        with netCDF4.Dataset(self.path) as file:
            matrix = file["joint/001/covariance"]
            self.assertEqual(matrix.dimensions, ("output", "other_output"))
            self.assertEqual(file["one_at_a_time/000/up"].dimensions, ("row", "output"))
            self.assertEqual(file["sensitivity/000/pairs/second"].dimensions, ("pair",))

    def test_matrices_stand_the_right_way(self):
        with h5py.File(self.path) as file:
            joint = file["joint/001"]
            r, cov, names = joint["correlation"][()], joint["covariance"][()], joint["name"][()]
            self.assertEqual([n.decode() for n in names], ["height", "runout", "runout_angle"])
            np.testing.assert_allclose(cov, cov.T, rtol=1e-14)
            u = np.sqrt(np.diag(cov))
            np.testing.assert_allclose(r, cov / np.outer(u, u), rtol=1e-12)
            self.assertEqual(joint["covariance"].attrs["units_note"], "see units")  # two lengths and an angle
            self.assertEqual(file["joint/000/covariance"].attrs["units"], "(m)2")
            self.assertNotIn("gum_covariance", joint)
            table = file["one_at_a_time/000"]  # row runout_x moves the second output only
            self.assertEqual(table["quantity"][2].decode(), "runout_x")
            self.assertEqual(table["up"].shape, (3, 2))
            self.assertAlmostEqual(table["up"][2, 1], 92e-6)

    def test_what_has_no_value_is_nan_and_said(self):
        with h5py.File(self.path) as file:
            for name in ("conformity/process_mean", "target/000/allowed", "dgsm/000/bound", "conformity/lower"):
                self.assertTrue(np.isnan(file[name][()]).any(), name)
                self.assertIn("NaN", file[name].attrs["long_name"])


if __name__ == "__main__":
    unittest.main()
