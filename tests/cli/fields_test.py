"""What stands in a result file is described, in its README, and each description means something."""
import re
import subprocess
import tempfile
import unittest

import h5py

from program import GUMSHOE, MADE, ROOT

README = ROOT / "engine/store/README.md"


class Fields(unittest.TestCase):
    def test_every_field_has_a_meaning_and_no_table_says_a_name_twice(self):
        for table in re.split(r"\n(?=\*\*`)", subprocess.run([GUMSHOE, "fields"], check=True, capture_output=True, text=True).stdout):
            rows = [line.split(" | ") for line in table.splitlines() if line.startswith("| `")]
            names = [row[0] for row in rows]
            self.assertEqual(len(names), len(set(names)), table[:60])
            for row in rows:
                self.assertTrue(row[2].strip(), row)

    def test_what_stands_in_a_file_is_described(self):
        described = set(re.findall(r"`([^`|]+)`", README.read_text(encoding="utf-8")))
        names = {re.sub(r".*/(?=.)", "", name) for name in described}
        unknown = []

        def check(path, item):
            path = re.sub(r"(?<=[/_])\d{3}(?=/|$)", "<k>", path)
            if path.startswith(("outputs/", "readings/", "data/")) or "/keys/" in path:  # named by model and scenario
                return
            if isinstance(item, h5py.Dataset):
                if (b"but not a netCDF variable" not in bytes(item.attrs.get("NAME", b""))
                        and item.attrs["long_name"] != "names of the rows"):
                    unknown.extend({path.split("/")[-1]} - names)
            else:
                unknown.extend(f"{path}@{a}" for a in item.attrs if a not in names)

        with tempfile.TemporaryDirectory() as folder:
            for words in ([], ["--trace", "class"], ["--trace", "not_in_catalogue"]):
                subprocess.run([MADE, *words, f"{folder}/made.h5"], check=True)
                with h5py.File(f"{folder}/made.h5") as file:
                    file.visititems(check)
        self.assertEqual(sorted(set(unknown)), [])


if __name__ == "__main__":
    unittest.main()
