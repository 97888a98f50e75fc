"""`gumshoe volume`: the error of the tool's place over the working volume, its uncertainty and its causes.

usage: volume_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import pathlib
import re
import tempfile
import unittest

import h5py
import numpy as np

from plain_machine import DEG, place, side
from program import ROOT, InFolder, complaint, gumshoe

SHIPPED = ROOT / "scenarios" / "volume_five_axis.toml"
THREE = """schema = 1
[model]
name = "sphere_probing"
method = "virtual_experiment"
[machine]
workpiece_side = []
tool_side = ["X", "Y", "Z"]
"""
CUBE = """[volume]
X = { from = "0 mm", to = "400 mm", points = 3 }
Y = { from = "-300 mm", to = "300 mm", points = 5 }
Z = { from = "0 mm", to = "200 mm", points = 2 }
"""


class Volume(InFolder):
    def map(self, text, *options):
        file = self.folder / "volume.toml"
        file.write_text(text)
        run = gumshoe("volume", file, "--format", "json", "--out", self.folder / "v.h5", "--force", *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def test_one_squareness_error_is_a_linear_map(self):
        g = 100e-6
        out = self.map(THREE + f'[quantities]\nE_C0Y = "{g / DEG!r} deg"\n' + CUBE)
        self.assertEqual([a["points"] for a in out["axes"]], [3, 5, 2])
        self.assertEqual(len(out["points"]), 30)
        for k, p in enumerate(out["points"]):  # Z goes fastest
            x, y, z = 0.2 * (k // 10), -0.3 + 0.15 * (k // 2 % 5), 0.2 * (k % 2)
            for name, true in (("x", x), ("y", y), ("z", z), ("error_x", -y * math.sin(g)), ("error_y", y * (math.cos(g) - 1)),
                               ("error_z", 0), ("u_x", 0), ("u_length", 0), ("length", abs(y) * math.sqrt(2 - 2 * math.cos(g)))):
                self.assertAlmostEqual(p[name], true, delta=1e-13, msg=(k, name))
        worst = out["points"][out["largest"]]
        self.assertAlmostEqual(abs(worst["y"]), 0.3)
        self.assertEqual([c["name"] for c in out["causes"]], ["E_C0Y"])
        self.assertAlmostEqual(out["causes"][0]["error"], 0.3 * g, delta=1e-11)
        self.assertRegex(out["statement"], r"^The largest error is 0.030 mm \(u = 0 mm\), at X .* mm, Y -?300 mm, Z .* mm\. E_C0Y causes the largest part of it, 0.030 mm\.$")

    def test_a_map_of_nothing_or_of_what_is_uncertain_says_so(self):
        none = self.map(THREE + CUBE)
        self.assertEqual(none["statement"], "There is no error: the scenario states none of an axis, and no uncertain one.")
        # |N(0, u)| has the mean u sqrt(2 / pi), where nothing is wrong but uncertain.
        uncertain = self.map(THREE + '[quantities]\nE_C0Y = { value = "0 deg", u = "0.001 deg" }\n' + CUBE)
        worst = uncertain["points"][uncertain["largest"]]
        self.assertAlmostEqual(worst["length"], math.sqrt(2 / math.pi) * 0.3 * 0.001 * DEG, delta=0.03 * worst["length"])
        self.assertRegex(uncertain["statement"], r"^The largest error is .* This is the mean length of an uncertain error, whose mean is ")

    def test_mean_and_u_against_plain_matrices_and_linear_propagation(self):
        """Seven errors of a five-axis machine with a table that tilts and a point off its axes."""
        errors = {"E_X0B": (30e-6, 4e-6), "E_A0B": (5e-5, 1e-5), "E_Y0C": (-20e-6, 3e-6), "E_B0C": (-4e-5, 2e-5), "E_C0Y": (6e-5, 1e-5),
                  "E_BX": (3e-5, 2e-5), "E_ZZ": (8e-6, 5e-6)}
        sides = side(("B", (0.0, 0.0, 0.05)), "C", workpiece=True), side("X", "Y", "Z")
        tip, angles, n = {"probe_x": 0.01, "probe_y": -0.02, "probe_z": -0.15}, {"B": 30 * DEG, "C": -50 * DEG}, 20000
        def shown(name, v):
            return f'"{v / DEG!r} deg"' if name[2] in "ABC" else f'"{1e3 * v!r} mm"'
        text = THREE.replace("[]", '[{ axis = "B", point = ["0 mm", "0 mm", "50 mm"] }, "C"]') + "[quantities]\n"
        text += "".join(f"{name} = {{ value = {shown(name, v)}, u = {shown(name, u)} }}\n" for name, (v, u) in errors.items())
        text += 'probe_x = { value = "10 mm", u = "5 um" }\nprobe_y = "-20 mm"\nprobe_z = "-150 mm"\n'  # the tool's, not the machine's
        out = self.map(text + CUBE + f'B = "30 deg"\nC = "-50 deg"\nsamples = {n}\n')
        values = {name: v for name, (v, _) in errors.items()}
        for k, p in enumerate(out["points"]):
            commands = {"X": 0.2 * (k // 10), "Y": -0.3 + 0.15 * (k // 2 % 5), "Z": 0.2 * (k % 2), **angles}
            null = place(*sides, commands, tip)
            def error(changed={}):
                return place(*sides, commands, values | changed | tip) - null
            mean = error()
            parts = np.array([(error({name: v + u}) - error({name: v - u})) / 2 for name, (v, u) in errors.items()])
            u = np.sqrt((parts ** 2).sum(axis=0))
            along = math.sqrt(((parts @ (mean / np.linalg.norm(mean))) ** 2).sum())
            for i, c in enumerate("xyz"):
                self.assertAlmostEqual(p[c], null[i], delta=1e-12)
                self.assertAlmostEqual(p["error_" + c], mean[i], delta=5 * u[i] / math.sqrt(n) + 1e-12)
                self.assertAlmostEqual(p["u_" + c], u[i], delta=5 * u[i] / math.sqrt(2 * n))
            if np.linalg.norm(mean) > 5 * along:  # so long that its direction hardly varies
                self.assertAlmostEqual(p["u_length"], along, delta=0.03 * along)
        self.assertAlmostEqual(sum(c["share"] for c in out["causes"]), 1, delta=1e-9)
        worst = out["points"][out["largest"]]
        mean = math.dist((0, 0, 0), [worst["error_" + c] for c in "xyz"])
        self.assertAlmostEqual(sum(c["error"] for c in out["causes"]), mean, delta=5 * out["linear_u"] / math.sqrt(n))
        self.assertNotIn("probe_x", [c["name"] for c in out["causes"]][:3])

    def test_correlated_errors_cancel(self):
        text = THREE + '''[quantities]
E_XX = { value = "10 um", u = "3 um" }
E_X0X = { value = "10 um", u = "3 um" }
[[correlations]]
quantities = ["E_XX", "E_X0X"]
kind = "pearson"
matrix = [[1, -0.9], [-0.9, 1]]
source = "one fit"
'''
        out = self.map(text + CUBE)
        u = 3e-6 * math.sqrt(0.2)
        self.assertAlmostEqual(out["points"][0]["u_x"], u, delta=5 * u / math.sqrt(2e4))
        self.assertAlmostEqual(out["linear_u"], u, delta=5 * u / math.sqrt(2e4))

    def test_what_is_uncertain_across_the_error_is_told(self):
        """8 um along X, known to 2 um, by E_C0Y over 400 mm; 0 um along Y, known to 5 um, by E_C0X over 500 mm: the length
        has more than the 2 um that the shares divide."""
        text = THREE + "[quantities]\n" + '''E_C0X = { value = "0 um/m", u = "10 um/m" }
E_C0Y = { value = "20 um/m", u = "5 um/m" }
[volume]
X = { from = "0 mm", to = "500 mm", points = 2 }
Y = { from = "0 mm", to = "400 mm", points = 2 }
Z = "0 mm"
samples = 20000
'''
        out = self.map(text)
        worst = out["points"][out["largest"]]
        drawn = np.random.default_rng(1)
        length = np.hypot(0.5 * drawn.normal(0, 10e-6, 400000), 0.4 * drawn.normal(20e-6, 5e-6, 400000))
        self.assertAlmostEqual(worst["u_length"], length.std(), delta=5 * length.std() / math.sqrt(2 * 20000))
        self.assertAlmostEqual(out["linear_u"], 2e-6, delta=0.05e-6)
        self.assertIn("Along that error, E_C0Y contributes most to the variance", out["statement"])
        self.assertTrue(any("the length has u = 2.4 um, because what is uncertain across that direction" in n for n in out["notes"]))

    def test_the_law_of_propagation_needs_no_samples(self):
        """u and shares are of the declared covariances. Of what is drawn they have the direction of the mean error alone, which
        is known to u / sqrt(100) of 36 um: half a percent."""
        found = [self.map(SHIPPED.read_text(), "--samples", 100, "--seed", seed) for seed in (1, 2)]
        one, other = ({c["name"]: c for c in out["causes"]} for out in found)
        for name in one:
            self.assertEqual(one[name]["standard_uncertainty"], other[name]["standard_uncertainty"])
            self.assertAlmostEqual(one[name]["share"], other[name]["share"], delta=0.01, msg=name)
        self.assertAlmostEqual(found[0]["linear_u"] / found[1]["linear_u"], 1, delta=0.01)
        self.assertAlmostEqual(sum(c["share"] for c in found[0]["causes"]), 1, delta=1e-12)

    def test_the_scenario_as_understood_shows_the_volume(self):
        run = gumshoe("check", SHIPPED, "--explain")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("volume\n  189 points, 10000 samples\n  X: -0.2 m (-200 mm) to 0.2 m (200 mm), 9 points\n", run.stdout)
        self.assertIn("\n  C 0.785398163397 rad (45 deg)\n", run.stdout)

    def test_a_map_has_no_samples_to_replay_or_analyse(self):
        self.map(THREE + '[quantities]\nE_XX = { value = "10 um", u = "3 um" }\n' + CUBE)
        for command in (("replay", "v.h5", "--sample", 0), ("analyse", "v.h5")):
            run = gumshoe(*command, cwd=self.folder)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertIn("gumshoe volume made it", run.stderr)

    def test_joints_of_a_robot(self):
        text = (ROOT / "scenarios" / "serial_chain.toml").read_text().replace('"data/', f'"{ROOT}/scenarios/data/')
        out = self.map(text + '\n[volume]\nJ1 = { from = "-90 deg", to = "90 deg", points = 3 }\nJ2 = { from = "-120 deg", to = "-60 deg", points = 4 }\n'
                       'J3 = "45 deg"\nsamples = 1000\n')
        self.assertEqual(len(out["points"]), 12)
        self.assertGreater(min(p["u_length"] for p in out["points"]), 1e-5)
        self.assertNotIn("base_x", [c["name"] for c in out["causes"]])

    def test_any_number_of_threads_gives_the_same_bits(self):
        found = []
        for threads in (1, 3):
            run = gumshoe("volume", SHIPPED, "--samples", 3000, "--threads", threads, "--format", "json", "--out", self.folder / "t.h5", "--force")
            self.assertEqual(run.returncode, 0, run.stderr)
            found.append(run.stdout)
        self.assertEqual(*found)

    def test_the_file_and_the_page(self):
        run = gumshoe("volume", SHIPPED, "--samples", 1000, "--out", "v.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("there caused by", run.stdout)
        with h5py.File(self.folder / "v.h5") as f:
            v = f["volume"]
            statement = v.attrs["statement"]
            statement = statement.decode() if isinstance(statement, bytes) else statement
            shape = [int(n) for n in v["axes/points"]]
            self.assertEqual(shape, [9, 7, 3])
            length = v["points/length"][()].reshape(shape)
            self.assertEqual(np.argmax(length), v.attrs["largest"])
            self.assertEqual(v["points/length"].attrs["units"], "m" if isinstance(v["points/length"].attrs["units"], str) else b"m")
        run = gumshoe("report", "v.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        page = (self.folder / "v.html").read_text()
        self.assertIn(statement.split(",")[0].replace("um", "µm"), page.replace("\u202f", " "))
        self.assertEqual(page.count('<svg role="img" aria-label="Mean length') + page.count('<svg role="img" aria-label="Standard uncertainty'), 2)
        self.assertIn("What causes it", page)
        points = list(csv.DictReader(io.StringIO((self.folder / "v_points.csv").read_text())))
        self.assertEqual(len(points), 9 * 7 * 3)
        self.assertAlmostEqual(max(float(p["length"]) for p in points), length.max(), delta=1e-12)
        # The commands of a point: the last axis goes fastest, through three values.
        at = [tuple(float(p[f"{axis}_mm"]) for axis in "XYZ") for p in points]
        self.assertEqual(at, sorted(at))
        self.assertEqual(len({z for _, _, z in at}), 3)
        self.assertEqual({p["unit"] for p in points}, {"m"})
        causes = list(csv.DictReader(io.StringIO((self.folder / "v_causes.csv").read_text())))
        self.assertEqual({cause["error_unit"] for cause in causes}, {"m"})
        table = page[page.index("What causes it"):]
        for value, u in re.findall(r'</th><td class="n">([^<]*)</td><td class="n">([^<]*)</td>', table):
            decimals = lambda text: len(text.partition(".")[2])
            self.assertEqual(decimals(value), decimals(u), (value, u))  # to the place of u

    def test_what_is_wrong_is_said_where_it_is(self):
        by_label = THREE.replace("virtual_experiment", "propagation") + '''[indications.X]
readings = { file = "r.csv", column = "x", unit = "mm", labels = { s = "s" } }
[indications.Y]
readings = { file = "r.csv", column = "x", unit = "mm", labels = { s = "s" } }
[indications.Z]
readings = { file = "r.csv", column = "x", unit = "mm", labels = { s = "s" } }
[quantities.E_XX.by.s]
a = "1 um"
b = "2 um"
'''
        (self.folder / "r.csv").write_text("s,x\na,1\nb,2\n")
        rod = 'schema = 1\n[model]\nname = "rod_gauging"\nmethod = "virtual_experiment"\n'
        one = 'X = { from = "0 mm", to = "9 mm", points = 3 }\n'
        for name, text, *said in (
                ("no section", THREE, "[volume] is missing"),
                ("no machine", rod + "[volume]\n" + one, "volume: the scenario has no [machine]"),
                ("no range", THREE + '[volume]\nX = "5 mm"\n', "volume: no axes have a range"),
                ("four ranges", THREE.replace('"Z"]', '"Z", "A"]') + CUBE + 'A = { from = "0 deg", to = "9 deg", points = 3 }\n', "more than three axes have a range"),
                ("an unknown axis", THREE + "[volume]\n" + one + 'Q = "1 mm"\n', "the machine has no axis 'Q'"),
                ("no length", THREE + '[volume]\nX = { from = "1 mm", to = "1 mm", points = 3 }\n', "volume.X: the range has no length"),
                ("no end", THREE + '[volume]\nX = { from = "1 mm", points = 3 }\n', "volume.X.to is missing"),
                ("a wrong unit", THREE + '[volume]\nX = { from = "1 deg", to = "2 mm", points = 3 }\n', "is not a length"),
                ("a tool of two", THREE + "[volume]\n" + one + 'tool = ["1 mm", "2 mm"]\n', "volume.tool: X, Y and Z are needed"),
                ("values by label", by_label + "[volume]\n" + one, "volume: E_XX has several values, by label"),
                ("too long", THREE + '[volume]\nsamples = 1_000_000\nX = { from = "0 mm", to = "9 mm", points = 200 }\nY = { from = "0 mm", to = "9 mm", points = 200 }\n',
                 "volume: 40000 points and 1000000 samples take too long")):
            with self.subTest(name):
                file = self.folder / "wrong.toml"
                file.write_text(text)
                run = gumshoe("volume", file, "--out", self.folder / "w.h5")
                self.assertIsNone(complaint(run), run.stderr)
                for words in said:
                    self.assertIn(words, run.stderr)


if __name__ == "__main__":
    unittest.main()
