"""Results that earlier versions wrote stay readable: tests/archive holds one of each format version, with its scenario.

A result is never written anew. A new format version adds its own; what cannot be read any more is refused by name
(damage_test.py).

usage: archive_test.py path/to/gumshoe [unittest options]
"""
import gzip
import unittest

import h5py
import numpy as np

from program import ROOT, InFolder, gumshoe

ARCHIVE = ROOT / "tests/archive"


class Archive(InFolder):
    def test_every_format_version(self):
        versions = sorted(ARCHIVE.glob("format_*.h5.gz"))
        self.assertTrue(versions)
        for packed in versions:
            with self.subTest(packed.name):
                result = self.folder / packed.stem
                result.write_bytes(gzip.decompress(packed.read_bytes()))
                report = gumshoe("report", result)
                self.assertEqual(report.returncode, 0, report.stderr)
                # The scenario still means the same: its samples are those of today's model.
                scenario = ARCHIVE / packed.name.replace(".h5.gz", ".toml")
                again = gumshoe("analyse", result, "--scenario", scenario)
                self.assertEqual(again.returncode, 0, again.stderr)
                today = gumshoe("run", scenario, "--out", self.folder / "today.h5", "--force")
                self.assertEqual(today.returncode, 0, today.stderr)
                with h5py.File(result) as old, h5py.File(self.folder / "today.h5") as new:
                    np.testing.assert_array_equal(old["outputs/sum"], new["outputs/sum"])
                    for name in ("estimate", "standard_uncertainty"):
                        np.testing.assert_allclose(old["summary"][name], new["summary"][name], rtol=1e-12)
                    self.assertLess(abs(old["summary/estimate"][0] - 3e-3), 5 * 5.1e-6 / 500**0.5)


if __name__ == "__main__":
    unittest.main()
