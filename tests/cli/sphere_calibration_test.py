"""The sphere calibration from outside: commands at points, the tip from commands, bias of an approximation, a fit.

usage: sphere_calibration_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import unittest

from program import ROOT, InFolder, complaint, gumshoe

DEG = math.pi / 180
POSES = [(0, c) for c in range(0, 91, 5)] + [(b, 90) for b in range(-20, 46, 5)]
TRUTH = {"probe_x": 85.2, "probe_y": 286.9, "probe_z": 453.1, "E_X0B": -0.3, "E_Z0B": 0.61, "E_X0C": 0.11, "E_Y0C": -0.2,
         "E_A0B": 0.31, "E_C0B": -0.12, "E_A0C": -0.05, "E_B0C": 0.08}
UNITS = {name: "deg" if name[2] in "AC" or name == "E_B0C" else "mm" for name in TRUTH}


class SphereCalibration(InFolder):
    def rows(self, header, *points, evaluation="exact", code=0):
        table = self.folder / "points.csv"
        table.write_text("\n".join(",".join(map(str, row)) for row in (header, *points)) + "\n")
        self.run = gumshoe("evaluate", "sphere_calibration", "--table", table, "--evaluation", evaluation)
        self.assertEqual(self.run.returncode, code, self.run.stderr)
        return list(csv.DictReader(io.StringIO(self.run.stdout)))

    def xyz(self, row):
        return [float(row[f"{name} (mm)"]) for name in ("X", "Y", "Z")]

    def test_without_errors_by_hand(self):
        # C = 90 deg carries the probe, seen from the C axis, from (x, y) to (-y, x).
        clean = {name: 0 for name in TRUTH if name.startswith("E_")}
        header = [f"{name} ({UNITS[name]})" for name in clean] + ["B (deg)", "C (deg)"]
        at_0, at_90, down = self.rows(header, [*clean.values(), 0, 0], [*clean.values(), 0, 90], [*clean.values(), 90, 0])
        for row, expected in (
                (at_0, (-184.183 - 85.564, 287.428, 15.5 + 454.220)),
                (at_90, (-184.183 - 50 - (287.428 + 180), -180 - (85.564 - 50), 15.5 + 454.220)),
                # B = 90 deg carries (x, z), seen from the B axis at (-120, -110), to (z, -x).
                (down, (-184.183 + 120 - (-454.220 + 110), 287.428, 15.5 + 110 + (85.564 + 120)))):
            for got, want in zip(self.xyz(row), expected):
                self.assertAlmostEqual(got, want, delta=1e-11)

    def test_units_and_linear_errors(self):
        header = ["B (rad)", "C (deg)", "E_XY (um)", "E_ZZ (mm)", "S_XZ (um/m)", "S_XY (um/m)", "S_YZ (urad)"]
        plain, added = self.rows(header, [12 * DEG, 75, 0, 0, 0, 0, 0], [12 * DEG, 75, 3, -0.002, 8, 5, -6])
        x, y, z = self.xyz(plain)
        expected = (x + 3e-3 + 8e-6 * z - 5e-6 * y, y + 6e-6 * z, z - 0.002)
        for got, want in zip(self.xyz(added), expected):
            self.assertAlmostEqual(got, want, delta=1e-11)

    def test_commands_give_the_tip_back(self):
        header = ["B (deg)", "C (deg)", "E_CC (deg)", "sphere_y (mm)", "A (deg)"]
        point = [-17, 33, 0.04, 2, 90]
        x, y, z = self.xyz(self.rows(header, point)[0])
        row = self.rows([*header, "X (mm)", "Y (mm)", "Z (mm)"], [*point, repr(x), repr(y), repr(z + 0.01)])[0]
        # A = 90 deg lifts a sphere that is offset from the axis along Y.
        for name, want in (("tip_x", -184.183), ("tip_y", 0), ("tip_z", 15.5 + 2 + 0.01)):
            self.assertAlmostEqual(float(row[f"{name} (mm)"]), want, delta=1e-11)

    def test_closed_forms_know_their_patterns(self):
        header = ["B (deg)", "C (deg)", "pattern"]
        good = self.rows(header, [0, 33, 0], [0, 33, 1], [20, 90, 0], [0, 90, 2], evaluation="closed_form")
        exact = self.rows(header, [0, 33, 0], [0, 33, 1], [20, 90, 0], [0, 90, 2])
        for a, b in zip(good, exact):
            self.assertEqual(a["status"], "ok")
            for near, truth in zip(self.xyz(a), self.xyz(b)):
                self.assertAlmostEqual(near, truth, delta=0.011)
        bad = self.rows(header, [20, 33, 0], [20, 90, 1], [0, 33, 2], evaluation="closed_form", code=2)
        self.assertEqual([row["status"] for row in bad], ["out_of_domain"] * 3)
        self.assertIsNone(complaint(self.run))
        self.assertIn("points.csv:2:1: error: closed_form holds only at B = 0", self.run.stderr)

    def test_a_virtual_experiment_shows_the_bias_of_an_approximation(self):
        # The machine stays exact whatever the evaluation; at one pose the error is the difference of the two commands.
        exact, small = (self.xyz(self.rows(["B (deg)", "C (deg)"], [45, 90], evaluation=e)[0]) for e in ("exact", "small_angle"))
        scenario = self.folder / "bias.toml"
        scenario.write_text('schema = 1\n[model]\nname = "sphere_calibration"\nmethod = "virtual_experiment"\n'
                            'evaluation = "small_angle"\n[conditions]\nB = "45 deg"\nC = "90 deg"\n'
                            '[quantities.sphere_distance]\nvalue = "184.183 mm"\nu = "1 um"\n[run]\nsamples = 1000\n')
        run = gumshoe("run", scenario, "--out", self.folder / "bias.h5", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        for result, a, b in zip(json.loads(run.stdout), exact, small):
            self.assertAlmostEqual(result["estimate"], a - b, delta=1e-11)
        self.assertGreater(abs(exact[2] - small[2]), 0.015)

    def test_noiseless_commands_give_the_machine_back(self):
        header = [f"{name} ({UNITS[name]})" for name in TRUTH] + ["B (deg)", "C (deg)"]
        rows = self.rows(header, *([*TRUTH.values(), b, c] for b, c in POSES))
        data = "B,C,X,Y,Z\n" + "".join(f"{b},{c},{','.join(map(repr, self.xyz(row)))}\n" for (b, c), row in zip(POSES, rows))
        (self.folder / "data.csv").write_text(data)
        angles = 'conditions = { B = { column = "B", unit = "deg" }, C = { column = "C", unit = "deg" } }'
        text = 'schema = 1\n[model]\nname = "sphere_calibration"\n'
        text += "".join(f"[quantities.{name}]\nestimated = true\n" for name in TRUTH)
        text += "".join(f'[indications.{name}]\nreadings = {{ file = "data.csv", column = "{name}", unit = "mm", {angles} }}\n' for name in "XYZ")
        (self.folder / "fit.toml").write_text(text)
        run = gumshoe("estimate", self.folder / "fit.toml", "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        fit = json.loads(run.stdout)
        self.assertEqual(fit["rank"], 11)
        for name, truth in TRUTH.items():
            self.assertAlmostEqual(fit["parameters"][name]["value"], truth, delta=1e-7)

    def noisy(self):
        """Commands at all poses with an error of micrometres that anyone can compute again."""
        header = [f"{name} ({UNITS[name]})" for name in TRUTH] + ["B (deg)", "C (deg)"]
        rows = self.rows(header, *([*TRUTH.values(), b, c] for b, c in POSES))
        return [[b, c, *(x + 5e-3 * math.sin(7 * i + 3 * k) for k, x in enumerate(self.xyz(row)))]
                for i, ((b, c), row) in enumerate(zip(POSES, rows))]

    def test_joint_is_the_fit_of_estimate(self):
        data = self.noisy()
        found = self.rows(["B (deg)", "C (deg)", "X (mm)", "Y (mm)", "Z (mm)"], *([repr(x) for x in row] for row in data),
                          evaluation="joint")[0]
        self.assertEqual(float(found["rank (1)"]), 11)
        self.assertAlmostEqual(float(found["residual_rms (um)"]), 5 / math.sqrt(2), delta=0.5)
        (self.folder / "data.csv").write_text("B,C,X,Y,Z\n" + "".join(",".join(map(repr, row)) + "\n" for row in data))
        angles = 'conditions = { B = { column = "B", unit = "deg" }, C = { column = "C", unit = "deg" } }'
        text = 'schema = 1\n[model]\nname = "sphere_calibration"\n'
        text += "".join(f"[quantities.{name}]\nestimated = true\n" for name in [*TRUTH, "sphere_distance"])
        text += "".join(f'[indications.{name}]\nreadings = {{ file = "data.csv", column = "{name}", unit = "mm", {angles} }}\n' for name in "XYZ")
        without = text.replace("[quantities.sphere_distance]\nestimated = true\n", "")
        (self.folder / "fit.toml").write_text(without)
        run = gumshoe("estimate", self.folder / "fit.toml", "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        for name, value in json.loads(run.stdout)["parameters"].items():
            # Two ways to the same minimum; near it 1e-9 of a quantity is 1e-12 of the squares.
            self.assertAlmostEqual(float(found[f"{name} ({UNITS[name]})"]), value["value"], delta=1e-9 * max(1, abs(value["value"])))
        # The artefact's place cannot be told from the machine's.
        (self.folder / "fit.toml").write_text(text)
        run = gumshoe("estimate", self.folder / "fit.toml", cwd=self.folder)
        words = run.stdout + run.stderr
        self.assertIn("indistinguishable", words)
        for name in ("sphere_distance", "probe_x", "E_X0C", "E_X0B"):
            self.assertIn(name, words[words.index("indistinguishable") - 40:])

    def study(self, *changes, scenario="sphere_calibration", samples=20_000):
        text = (ROOT / f"scenarios/{scenario}.toml").read_text()
        text = text.replace("samples = 100_000", f"samples = {samples}")
        text = "\n".join(line for line in text.split("\n") if not line.startswith("sensitivity"))
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        (self.folder / "study.toml").write_text(text)
        run = gumshoe("run", self.folder / "study.toml", "--out", self.folder / "study.h5", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        return {result["output"].removeprefix("error of "): result for result in json.loads(run.stdout)}

    def test_standard_uncertainties_of_the_study(self):
        # Recomputed independently with numpy; four standard errors of ours and half a digit of theirs.
        names = ("probe_x", "probe_y", "probe_z", "E_X0B", "E_Z0B", "E_A0B", "E_C0B", "E_X0C", "E_Y0C", "E_A0C", "E_B0C")
        narrow = ("0.0121", "0.0048", "0.0024", "0.0219", "0.0210", "0.00108", "0.00121", "0.0132", "0.0117", "0.00078", "0.00089")
        printed = ("0.0777", "0.0263", "0.0024", "0.139", "0.134", "0.00108", "0.00121", "0.0720", "0.0628", "0.00078", "0.00089")
        for scenario, expected in (("sphere_calibration", narrow), ("sphere_calibration_printed", printed)):
            found = self.study(scenario=scenario)
            for name, text in zip(names, expected):
                u, digits = float(text), len(text.split(".")[1])
                # Theirs is a Monte Carlo, too: twice the variance.
                tolerance = 0.5 * 10**-digits + 4 * u * math.sqrt(2 / (2 * 20_000))
                self.assertAlmostEqual(found[name]["standard_uncertainty"], u, delta=tolerance, msg=name)

    def test_dominance(self):
        run = gumshoe("run", ROOT / "scenarios/sphere_calibration.toml", "--out", self.folder / "study.h5", "--samples", 10_000, "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        found = {r["output"].removeprefix("error of "): r["sobol"] for r in json.loads(run.stdout)}
        # Shares of variance, recomputed independently to a per cent or so; the sums of the terms of one direction.
        for output, contributors, share in (
                ("probe_x", ("E_CC",), 0.93), ("probe_y", ("E_CC",), 0.66), ("probe_y", ("S_",), 0.21),
                ("E_X0C", ("E_CC",), 0.65), ("E_X0C", ("E_Z",), 0.28), ("E_X0B", ("E_BB",), 0.90),
                ("E_C0B", ("E_Y",), 1), ("E_B0C", ("E_Z",), 1), ("probe_z", ("E_Z",), 1)):
            total = sum(v["total"]["value"] for k, v in found[output].items() if k.startswith(contributors))
            self.assertAlmostEqual(total, share, delta=0.05, msg=output)

    def test_methods_beside_each_other(self):
        method = 'evaluation = "sequential"'
        u = {e: {name: r["standard_uncertainty"] for name, r in self.study((method, f'evaluation = "{e}"')).items()}
             for e in ("sequential", "joint", "joint_weighted")}
        # Planes are immune to rotary errors, a joint fit with equal weights is not; with the right weights it is best.
        for name in ("E_A0B", "E_C0B", "E_A0C", "E_B0C"):
            self.assertGreater(u["joint"][name], 1.5 * u["sequential"][name])
        for name in TRUTH:
            for other in ("sequential", "joint"):
                self.assertLess(u["joint_weighted"][name], 1.02 * u[other][name], msg=name)
        self.assertAlmostEqual(u["joint_weighted"]["E_X0B"], 0.0138, delta=0.00005 + 4 * 0.0138 / math.sqrt(20_000))

    def test_correlations_under_independent_noise(self):
        errors = ("E_BB", "E_CC", "E_X", "E_Y", "E_Z", "S_")
        text = (ROOT / "scenarios/sphere_calibration.toml").read_text()
        sections = text.replace("\n[quantities.", "\n\0[quantities.").replace("\n[run]", "\n\0[run]").split("\0")
        kept = [s for s in sections if not s.startswith(tuple(f"[quantities.{e}" for e in errors))]
        noise = "".join(f'[indications.{k}]\ncomponents = [ {{ distribution = "normal", u = "5 um", per = "reading" }} ]\n' for k in "XYZ")
        text = "".join(kept[:-1]) + noise + kept[-1]
        text = text.replace('evaluation = "sequential"', 'evaluation = "joint"').replace("samples = 100_000", "samples = 20_000")
        text = "\n".join(line for line in text.split("\n") if not line.startswith("sensitivity"))
        (self.folder / "noise.toml").write_text(text)
        run = gumshoe("run", self.folder / "noise.toml", "--out", self.folder / "noise.h5", "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        found = {r["output"].removeprefix("error of "): r for r in json.loads(run.stdout)}
        for a, b, r in (("E_X0C", "E_B0C", 0.97), ("E_A0B", "E_C0B", 0.95), ("E_Y0C", "E_A0C", -0.94)):
            self.assertAlmostEqual(found[a]["joint"][0]["correlation"][f"error of {b}"], r,
                                   delta=0.005 + 4 * (1 - r * r) / math.sqrt(20_000))

    def test_bad_data(self):
        data = self.noisy()
        header = ["B (deg)", "C (deg)", "X (mm)", "Y (mm)", "Z (mm)"]
        # Where all lengths are in a wrong unit the fit is as good as ever: the declared machine tells.
        for factor, axes in ((1000, (2, 3, 4)), (1e-3, (2, 3, 4)), (1e-3, (2,))):
            wrong = [[x * factor if k in axes else x for k, x in enumerate(row)] for row in data]
            self.rows(header, *wrong, evaluation="joint", code=2)
            self.assertIn("X spreads over", self.run.stderr)
            self.assertIn("is a unit wrong?", self.run.stderr)
        self.rows(header[:4], *(row[:4] for row in data), evaluation="joint", code=2)
        self.assertIn("column 'Z' is missing", self.run.stderr)
        self.rows(header, data[0], evaluation="joint", code=2)
        self.assertIn("one pose cannot determine the axes", self.run.stderr)
        # Poses repeated, or at one B only: an answer, and how much of it the data bear.
        rank = lambda rows: self.rows(header, *rows, evaluation="joint")[0]["rank (1)"]
        self.assertEqual(rank(data + data[-3:]), "11")
        self.assertEqual(rank(data[:19]), "7")
        self.assertIn("the poses determine 7 of 11 directions; along the others the unknowns keep their declared values",
                      self.run.stderr)
        self.assertEqual(rank([data[0], data[25]]), "6")

    def test_a_run_names_what_the_poses_cannot_see(self):
        shift = '[quantities.sphere_distance]\nvalue = "184.183 mm"\nu = "5 um"\n[run]'
        text = (ROOT / "scenarios/sphere_calibration_printed.toml").read_text().replace("[run]", shift)
        (self.folder / "unseen.toml").write_text(text.replace("samples = 100_000", "samples = 1000"))
        run = gumshoe("run", self.folder / "unseen.toml", "--out", self.folder / "unseen.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        note = next(line for line in run.stdout.splitlines() if "indistinguishable" in line)
        for name in ("sphere_distance -1 mm", "probe_x +1 mm", "E_X0B +1 mm", "E_X0C +1 mm"):
            self.assertIn(name, note)

    def test_procedures_refuse_what_they_cannot_use(self):
        points = [[b, c, 0, 0, 0] for b, c in ((0, 0), (0, 30), (0, 60), (10, 80), (20, 90), (30, 90))]
        header = ["B (deg)", "C (deg)", "X (mm)", "Y (mm)", "Z (mm)"]
        self.rows(header, *points, evaluation="sequential", code=2)
        self.assertIn("C of reading 4 is 80 deg, of reading 5 90 deg", self.run.stderr)
        self.rows(header, *points, evaluation="joint_weighted", code=2)
        self.assertIn("a table declares nothing", self.run.stderr)

    def test_example(self):
        run = gumshoe("check", ROOT / "engine/models/sphere_calibration/example.toml")
        self.assertEqual(run.returncode, 0, run.stderr)


if __name__ == "__main__":
    unittest.main()
