"""Evidence that adds up over campaigns, by the program.

usage: weeks_test.py path/to/gumshoe [unittest options]
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py

import axis
import weeks

GUMSHOE = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else ""


class Weeks(unittest.TestCase):
    def test_what_is_there_is_shown_and_nothing_else(self):
        """A reversal of 3 um in noise of 1 um: its evidence grows week by week, that of the others does not."""
        found = list(weeks.campaigns(GUMSHOE, "reversal", 1, 4))
        evidence = [{e["name"]: e for e in h["effects"]} for h in found]
        self.assertEqual([h["campaigns"] for h in found], [1, 2, 3, 4])
        for before, after in zip(evidence, evidence[1:]):
            self.assertGreater(after["reversal"]["log10_evidence"], before["reversal"]["log10_evidence"] + 5)
        for name, e in evidence[-1].items():
            if name != "reversal":
                self.assertLess(e["log10_evidence"], 1)
        size, = evidence[-1]["reversal"]["quantities"]
        self.assertAlmostEqual(size["value"], 3, delta=4 * size["u"])
        # Of 90 training readings a week; without the effect the noise looks correlated, which costs up to a factor of 3.
        self.assertGreater(size["u"], 0.9 / (4 * 90) ** 0.5)
        self.assertLess(size["u"], 3 / (4 * 90) ** 0.5)

    def test_a_log_that_grows_is_not_counted_again(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            run = lambda: subprocess.run([GUMSHOE, "trace", "s.toml", "--append", "h.h5", "--force"], cwd=folder, capture_output=True, text=True)
            axis.write(folder, "reversal", 1)
            (folder / "s.toml").write_text(axis.scenario(True) + weeks.STATED)
            self.assertEqual(run().returncode, 0)
            table = next(folder.glob("*.csv"))
            head, *rows = table.read_text().splitlines()
            axis.write(folder, "reversal", 2)
            later = lambda cycle, x, direction, t, *rest: ",".join([str(int(cycle) + 6), x, direction, str(int(t) + 100_000), *rest])
            more = [later(*row.split(",")) for row in table.read_text().splitlines()[1:]]
            for lines, words in (([*rows, *more], f"it holds {len(rows)} of these {len(rows) + len(more)} readings already, of campaign 1"),
                                 (rows[:-5], f"it holds {len(rows) - 5} of these")):
                table.write_text("\n".join([head, *lines]) + "\n")
                refused = run()
                self.assertEqual(refused.returncode, 2)
                self.assertIn(words, refused.stderr)
            table.write_text("\n".join([head, *more]) + "\n")
            self.assertEqual(run().returncode, 0)

    def test_a_repaired_machine(self):
        """A reversal of 3 um in the first week, and none in the next two: it was shown, and the weeks disagree about its size."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for seed, what in ((1, "reversal"), (2, "nothing"), (3, "nothing")):
                axis.write(folder, what, seed)
                (folder / "s.toml").write_text(axis.scenario(True) + weeks.STATED)
                said = subprocess.run([GUMSHOE, "trace", "s.toml", "--append", "h.h5", "--json", "v.json", "--force"], cwd=folder, capture_output=True, text=True)
                self.assertEqual(said.returncode, 0, said.stderr)
            self.assertRegex(said.stdout, r"for reversal: it was shown after campaign 1 \(\S+ to 1\); the campaigns disagree about its size")
            one, = (e for e in json.loads((folder / "v.json").read_text())["history"]["effects"] if e["name"] == "reversal")
            size, = one["quantities"]
            self.assertLess(abs(size["last"]), 4 * size["last_u"])
            self.assertLess(one["agreement"], 1e-3)
            self.assertEqual(one["peak"], 1)

    def test_the_file(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            run = lambda *words: subprocess.run([GUMSHOE, "trace", "s.toml", *words], cwd=folder, capture_output=True, text=True)
            for seed in (1, 2):
                axis.write(folder, "reversal", seed)
                (folder / "s.toml").write_text(axis.scenario(True) + weeks.STATED)
                said = run("--append", "h.h5")
                self.assertEqual(said.returncode, 0, said.stderr)
            self.assertIn("evidence over 2 campaigns in h.h5", said.stdout)
            self.assertRegex(said.stdout, r"to 1 for reversal: shown; reversal.size 3\.\d")
            with h5py.File(folder / "h.h5") as file:
                self.assertEqual(file.attrs["campaigns"], 2)
                self.assertEqual(file["evidence/effect"].asstr()[0], "reversal")
                self.assertEqual(set(file["campaigns"]), {"000", "001"})
                self.assertEqual(file["campaigns/000/score"].shape, file["campaigns/000/quantity"].shape)
            (folder / "s.toml").write_text(axis.scenario(True))
            self.assertIn("none.h5 has 1 campaign, but no evidence", run("--append", "none.h5").stdout)
            (folder / "s.toml").write_text(axis.scenario(True) + weeks.STATED)
            again = run("--append", "h.h5")
            self.assertEqual(again.returncode, 2)
            self.assertIn("it holds these readings already", again.stderr)
            table = next(folder.glob("*.csv"))
            head, *rows = table.read_text().splitlines()
            table.write_text("\n".join([head, *reversed(rows)]) + "\n")
            self.assertIn("it holds these readings already", run("--append", "h.h5").stderr)
            axis.write(folder, "reversal", 3)
            (folder / "other.toml").write_text(axis.LINEAR_AXIS)
            before = (folder / "h.h5").read_bytes()
            other = subprocess.run([GUMSHOE, "trace", "other.toml", "--append", "h.h5"], cwd=folder, capture_output=True, text=True)
            self.assertEqual(other.returncode, 2)
            self.assertIn("h.h5: it is the history of another model (", other.stderr)
            self.assertIn("here it is linear_axis, '", other.stderr)
            self.assertEqual((folder / "h.h5").read_bytes(), before)
            # Another equation makes another model, although both are called `expression`; spaces do not.
            text = axis.scenario(True) + weeks.STATED
            (folder / "s.toml").write_text(text.replace("gain * x + offset", "gain * abs(x) + offset"))
            other = run("--append", "h.h5")
            self.assertEqual(other.returncode, 2, other.stdout)
            self.assertIn("h.h5: it is the history of another model (expression, 'd = gain * x + offset'; here it is expression, "
                          "'d = gain * abs(x) + offset'). Append to a history of its own.", other.stderr)
            self.assertEqual((folder / "h.h5").read_bytes(), before)
            (folder / "s.toml").write_text(text.replace("gain * x + offset", "gain*x  + offset"))
            self.assertEqual(run("--append", "h.h5").returncode, 0)
            (folder / "s.toml").write_text(text)
            with h5py.File(folder / "h.h5", "a") as file:
                cut = file["campaigns/000/information"][:-1]
                del file["campaigns/000/information"]
                file["campaigns/000/information"] = cut
            axis.write(folder, "reversal", 3)
            self.assertIn("changed by another program", run("--append", "h.h5").stderr)
            for content, words in ((b"no HDF5", "cannot be read as a history"), ((folder / "results/s.traced.h5").read_bytes(), "it is no history")):
                (folder / "other.h5").write_bytes(content)
                refused = run("--append", "other.h5")
                self.assertEqual(refused.returncode, 2, refused.stderr)
                self.assertIn(words, refused.stderr)
                self.assertEqual((folder / "other.h5").read_bytes(), content)


if __name__ == "__main__":
    unittest.main()
