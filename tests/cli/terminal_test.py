"""What a reader of the terminal and a program that reads its output get: the answer, names, selection, hints, help.

usage: terminal_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

os.environ["HDF5_USE_FILE_LOCKING"] = "FALSE"
import h5py
import xarray

from program import GUMSHOE, ROOT, InOneFolder, complaint, gumshoe

# y = a + b + c + d + f with u = 5, 4, 3, 2, 1 um: u_c^2 = 55 um^2, shares 25/55, 16/55, 9/55 ...
SUM = """schema = 1
title = "a sum"
[model]
name = "expression"
[model.measurands]
y = "a + b + c + d + f"
twice = "2 * a"
[quantities]
a = { value = "10 mm", u = "5 um" }
b = { value = "20 mm", u = "4 um" }
c = { value = "30 mm", u = "3 um" }
d = { value = "40 mm", u = "2 um" }
f = { value = "50 mm", u = "1 um" }
[run]
samples = 400_000
"""
FEEDS = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "r - a"
[quantities]
a = { value = "1 mm", u = "1 um" }
[conditions]
feed = "10 mm/min"
[indications.r]
readings = { file = "r.csv", column = "r", unit = "mm", conditions = { feed = { column = "feed", unit = "mm/min" } } }
resolution = "1 um"
[run]
samples = 4000
"""


class Terminal(InOneFolder):
    def run_text(self, text, *words, name="case", code=0):
        path = self.folder / f"{name}.toml"
        path.write_text(text)
        run = gumshoe("run", path, "--out", self.folder / f"{name}.h5", *words)
        self.assertEqual(run.returncode, code, run.stderr)
        self.said = run.stderr
        return run.stdout

    def refusal(self, text, name="bad"):
        path = self.folder / f"{name}.toml"
        path.write_text(text)
        run = gumshoe("check", path)
        self.assertIsNone(complaint(run), run.stderr[:500])
        return run.stderr

    # the answer

    def test_the_largest_contributions_of_whole_quantities(self):
        """Indices by quantity, where the quantity has a component by label: none is left out."""
        text = """schema = 1
[model]
name = "rod_gauging"
method = "virtual_experiment"
[quantities.rod_length.by.rod]
1 = { value = "160 mm", u = "3 um" }
2 = { value = "180 mm", u = "3 um" }
[quantities.beam_pitch]
value = "0 deg"
u = "0.0001 deg"
[indications.spindle_z.readings]
file = "read.csv"
column = "z"
unit = "mm"
labels = { rod = "rod" }
[run]
samples = 1000
[analysis]
sensitivity = { sobol = 256, by = "quantity" }
"""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            (path / "read.csv").write_text("rod,z\n1,-300\n2,-280\n")
            (path / "s.toml").write_text(text)
            run = gumshoe("run", path / "s.toml", "--out", path / "s.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stdout, r"largest contributions \(first-order Sobol' indices\): rod_length (100|99|9\d) %")

    def test_the_terminal_alone_gives_value_u_k_and_the_three_largest_contributions(self):
        text = self.run_text(SUM)
        found = re.search(r"^y = \((\S+) \+- (\S+)\) mm, k = (\S+), 95 %$", text, re.M)
        self.assertIsNotNone(found, text)
        u = math.sqrt(55) / 1000
        # U to two digits; the estimate within five standard errors and its rounding.
        self.assertEqual((found[2], found[3]), (f"{1.96 * u:.3f}", "1.96"))
        self.assertAlmostEqual(float(found[1]), 150, delta=5 * u / math.sqrt(400_000) + 5e-4)
        line = re.search(r"^  largest contributions: (.*)$", text, re.M)[1]
        self.assertEqual(line, "a 5.0 um (45 %), b 4.0 um (29 %), c 3.0 um (16 %); 2 more")
        self.assertIn("  u = 7.4 um; shortest 95 % coverage interval [", text)

    def test_control_characters_of_a_title_are_shown(self):
        text = self.run_text(SUM.replace('"a sum"', r'"a\u0000b\u001b[2Jc\u009b"'), "--samples", "1000")
        self.assertEqual(text.split("\n")[0], r"a\x00b\x1b[2Jc\x9b")
        check = gumshoe("check", self.folder / "case.toml", "--explain")
        self.assertIn(r"title: a\x00b\x1b[2Jc\x9b" + "\n", check.stdout)

    def test_u_stands_in_the_unit_that_suits_it(self):
        text = self.run_text(SUM.replace('"5 um"', '"0.052 um"').replace('y = "a + b + c + d + f"\n', ""))
        self.assertIn("u = 0.10 um; ", text)  # of 2 a = 20 mm: 0.104 um
        self.assertIn("largest contributions: a 0.10 um (100 %)", text)

    def test_effective_degrees_of_freedom_stand_beside_k(self):
        text = self.run_text(SUM.replace('a = { value = "10 mm", u = "5 um" }',
                                         'a = { value = "10 mm", u = "5 um", degrees_of_freedom = 9 }'), "--budget")
        self.assertRegex(text, r"(?m)^  a +10 mm +5\.0 um +B +\w+ +9 ")

    def test_the_budget_is_a_table_that_closes(self):
        text = self.run_text(SUM, "--budget")
        block = text[text.index("uncertainty budget of y"):text.index("\ntwice = ")].splitlines()
        self.assertEqual([line.split()[0] for line in block[2:7]], list("abcdf"))
        self.assertIn("combined standard uncertainty", block[7])
        self.assertTrue(block[7].endswith("7.4 um"), block[7])
        self.assertTrue(block[-1].strip().startswith("expanded uncertainty"), block[-1])
        rows = list(csv.DictReader(io.StringIO(self.run_text(SUM, "--budget", "--format", "csv"))))
        self.assertEqual([(row["output"], row["quantity"]) for row in rows], [(y, q) for y in ("y", "twice") for q in "abcdf"])
        self.assertAlmostEqual(sum(float(row["share_gum"]) for row in rows[:5]), 1, delta=1e-5)
        self.assertEqual([float(row["sensitivity"]) for row in rows], [1] * 5 + [2, 0, 0, 0, 0])

    def test_json_and_csv_carry_what_text_and_report_carry(self):
        rows = json.loads(self.run_text(SUM, "--format", "json"))
        y = rows[0]
        u = math.sqrt(55) / 1000
        # Of the samples or of the framework: a quantile of 400,000 samples is known to half a percent.
        self.assertAlmostEqual(y["expanded_uncertainty"], 1.959964 * u, delta=0.01 * u)
        self.assertAlmostEqual(y["coverage_factor"], y["expanded_uncertainty"] / y["standard_uncertainty"], delta=1e-2)
        self.assertAlmostEqual(y["gum"]["expanded_uncertainty"], 1.959964 * u, delta=1e-8)
        self.assertIn(y["validation"]["verdict"], ("validated", "undecided"))
        self.assertEqual([c["component"] for c in y["budget"]], list("abcdf"))
        self.assertEqual([round(c["contribution"] * 1000) for c in y["budget"]], [5, 4, 3, 2, 1])
        self.assertEqual({c["contribution_unit"] for c in y["budget"]}, {"mm"})
        self.assertAlmostEqual(y["gum"]["combined_standard_uncertainty"], u, delta=1e-9)
        self.assertAlmostEqual(y["estimate_se"], u / math.sqrt(400_000), delta=0.02 * u / math.sqrt(400_000))
        self.assertEqual(len(y["shortest_se"]), 2)
        for key in ("warning", "statement", "certificate", "labels", "measurand", "reading"):
            self.assertIn(key, y)
        self.assertTrue(y["certificate"].startswith("y = (150.00"), y["certificate"])
        self.assertEqual((y["run"]["samples"], y["run"]["title"]), (400_000, "a sum"))
        self.assertIn("notes", y["run"])
        row = next(csv.DictReader(io.StringIO(self.run_text(SUM, "--format", "csv"))))
        for key in ("expanded_uncertainty", "coverage_factor", "degrees_of_freedom", "estimate_se", "warning",
                    "gum_effective_degrees_of_freedom", "gum_combined_standard_uncertainty", "validation_verdict",
                    "certificate", "coverage_probability"):
            self.assertIn(key, row)
        self.assertEqual(row["validation_verdict"], y["validation"]["verdict"])

    def test_without_a_standard_uncertainty_there_is_no_certificate(self):
        text = self.run_text(SUM.replace('a = { value = "10 mm", u = "5 um" }',
                                         'a = { observations = ["10 mm", "10.01 mm", "10.02 mm"] }'))
        self.assertIn("y = ", text)
        self.assertNotRegex(text, r"(?m)^y = \(")

    # names, selection, many readings

    def readings(self, count, rows=None):
        (self.folder / "r.csv").write_text("r,feed\n" + "".join(rows or (f"{2 + i / 1000},{10 * (i + 1)}\n" for i in range(count))))

    def test_readings_that_differ_in_conditions_only_have_names_of_their_own(self):
        self.readings(3)
        rows = json.loads(self.run_text(FEEDS, "--format", "json", name="feeds"))
        names = [f"y[feed {10 * (i + 1)} mm/min]" for i in range(3)]
        self.assertEqual([row["output"] for row in rows], names)
        self.assertEqual([row["output"] for row in csv.DictReader(io.StringIO(self.run_text(FEEDS, "--format", "csv", name="feeds")))], names)
        with h5py.File(self.folder / "feeds.h5") as file:
            self.assertEqual([name.decode() for name in file["outputs/reading"]], [name[2:-1] for name in names])
            self.assertEqual(file["by_output"][names[1].replace("/", "_")]["budget"], file["budget/001"])
            self.assertEqual(file.attrs["Conventions"], "CF-1.11")
            self.assertRegex(file.attrs["date"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
            self.assertTrue(file.attrs["host"])
            self.assertGreater(file.attrs["duration"], 0)
        with xarray.open_dataset(self.folder / "feeds.h5", group="summary", engine="netcdf4") as summary:
            one = summary.sel(output=names[2])
            self.assertEqual(one["name"].item(), names[2])
            self.assertEqual(float(one["estimate"]), float(summary["estimate"][2]))
        with xarray.open_dataset(self.folder / "feeds.h5", group="outputs", engine="netcdf4") as outputs:
            self.assertEqual(outputs["y"].sel(reading="feed 20 mm/min").shape, (4000,))

    def test_readings_that_differ_in_nothing_that_has_a_name_are_numbered(self):
        listed = ', '.join(f'{{ n = "{n}", values = ["{2 + i / 10} mm"] }}' for i, n in enumerate("aab"))
        text = FEEDS.split("readings = {")[0] + f"rows = [{listed}]\n" + 'resolution = "1 um"\n[run]\nsamples = 2000\n'
        rows = json.loads(self.run_text(text, "--format", "json", name="numbered"))
        self.assertEqual(len({row["output"] for row in rows}), len(rows))

    def test_many_readings_are_answered_in_one_line(self):
        self.readings(60)
        text = self.run_text(FEEDS, name="many")
        self.assertLess(len(text.splitlines()), 15, text)
        line = re.search(r"^y at 60 readings: from (\S+) mm \(feed 10 mm/min\) to (\S+) mm \(feed 600 mm/min\)", text, re.M)
        self.assertIsNotNone(line, text)
        self.assertAlmostEqual(float(line[1]), 1, delta=1e-3)
        self.assertAlmostEqual(float(line[2]), 1.059, delta=1e-3)
        self.assertIn("largest contributions: ", text)
        self.assertEqual(len(re.findall(r"^y\[feed", self.run_text(FEEDS, "--all", name="many"), re.M)), 60)

    def test_measurands_select_what_is_printed_and_reported(self):
        chosen = SUM + '[analysis]\nmeasurands = ["twice"]\n'
        self.assertNotRegex(self.run_text(chosen), r"(?m)^y = ")
        self.assertEqual([row["output"] for row in json.loads(self.run_text(chosen, "--format", "json"))], ["twice"])
        with h5py.File(self.folder / "case.h5") as file:
            self.assertEqual([name.decode() for name in file["summary/name"]], ["twice"])
            self.assertEqual(set(file["outputs"]) & {"y", "twice"}, {"y", "twice"})  # the samples of all are kept
        self.assertIn("'twic' is not a measurand here. Did you mean 'twice'?", self.refusal(chosen.replace('"twice"', '"twic"')))

    def test_counts_are_diagnostics(self):
        (self.folder / "tool.toml").write_text((ROOT / "scenarios/tool_length_curve.toml").read_text().replace("data/", f"{ROOT}/scenarios/data/"))
        run = gumshoe("run", self.folder / "tool.toml", "--samples", "2000", "--out", self.folder / "tool.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stdout, r"(?m)^diagnostics: .*seen_flutes = ")
        self.assertNotRegex(run.stdout, r"(?m)^(error of )?seen_\w+ = ")

    def test_draws_of_the_inputs_are_stored_on_request(self):
        self.run_text(SUM.replace("samples = 400_000", "samples = 5000\nstore_inputs = true"), name="draws")
        with xarray.open_dataset(self.folder / "draws.h5", group="draws", engine="netcdf4") as draws, \
                xarray.open_dataset(self.folder / "draws.h5", group="outputs", engine="netcdf4") as outputs:
            self.assertEqual(list(draws["component"].values), list("abcdf"))
            total = draws["deviation"].sum("component").values
            self.assertLess(abs(outputs["y"].values[0] - 0.150 - total).max(), 1e-15)  # y is their sum
            twice = outputs["twice"].values[0] - 0.020
            self.assertLess(abs(twice - 2 * draws["deviation"].sel(component="a").values).max(), 1e-15)

    # hints

    def test_hints_name_what_is_there(self):
        plain = 'a = { value = "10 mm", u = "5 um" }'
        for changed, words in {
            'distribution = "uniform", half_width = "1 um"': "'uniform' is unknown. Did you mean 'rectangular'?",
            'distribution = "Gaussian", u = "1 um"': "'Gaussian' is unknown. Did you mean 'normal'?",
            'distribution = "weibull-ish", u = "1 um"': "Use one of rectangular",
            'uncertainty = "1 um"': "unknown key 'uncertainty'. Write u for a standard uncertainty, or U with k for an expanded one.",
            'standard_uncertainty = "1 um"': "Did you mean 'u'?",
            'expanded_uncertainty = "1 um"': "Did you mean 'U'?",
            'half_with = "1 um"': "Did you mean 'half_width'?",
            'distribtion = "normal"': "Did you mean 'distribution'?",
            'half_width = "1 um"': 'Try: distribution = "rectangular"',
            'u = "1 um", low = "9 mm"': "the key 'low' means nothing together with the others",
        }.items():
            with self.subTest(changed):
                said = self.refusal(SUM.replace(plain, f'a = {{ value = "10 mm", {changed} }}'))
                self.assertIn(words, said)
                self.assertEqual(len(said.splitlines()), 1, said)  # one cause, one message

    def test_hints_of_the_command_line(self):
        (self.folder / "line.toml").write_text(SUM)
        for words, said in {("--seed", "x"): "Write a number such as 1.", ("--samples", "x"): "Write a number such as 1e6.",
                            ("--sampels", "10"): "Did you mean '--samples'?"}.items():
            run = gumshoe("run", self.folder / "line.toml", *words)
            self.assertIsNone(complaint(run))
            self.assertIn(said, run.stderr)
            self.assertNotIn("1e6" if words[0] == "--seed" else "\0", run.stderr)

    def test_messages_are_capped(self):
        (self.folder / "r.csv").write_text(",".join(["r"] * 200_000) + "\n" + ",".join(["1"] * 200_000) + "\n")
        self.assertLess(len(self.refusal(FEEDS, "wide")), 10_000)
        (self.folder / "r.csv").write_text("x" * 1_000_000 + ",feed\n1,1\n")
        self.assertLess(len(self.refusal(FEEDS, "long")), 10_000)

        keys = "".join(f'key{i} = 1\n' for i in range(60))
        said = self.refusal(SUM.replace("[run]\n", "[run]\n" + keys), "keys")
        self.assertEqual(len(said.splitlines()), 51)
        self.assertTrue(said.endswith("there are 10 more problems.\n"))

    def test_a_wrong_column_is_said_once(self):
        self.readings(3)
        said = self.refusal(FEEDS.replace('column = "r"', 'column = "rr"'), "column")
        self.assertEqual(len(said.splitlines()), 1, said)
        self.assertIn("has no column 'rr'", said)

    # conformity

    def test_conformity_in_text_has_limits_rule_and_bounds(self):
        test = '[[analysis.conformity]]\nmeasurand = "y"\nlower = "149.98 mm"\nupper = "150.02 mm"\n'
        u = math.sqrt(55) / 1000
        inside = math.erf(0.02 / u / math.sqrt(2))
        for rule, said, width in (("simple_acceptance", "simple acceptance", 0), ("iso_14253_1", "ISO 14253-1", 1.65 * u),
                                  ("ilac_g8", "ILAC-G8", 1.96 * u)):
            text = self.run_text(SUM + test + f'rule = "{rule}"\n')
            found = re.search(r"conformity of y: accepted, conformance probability (\S+) %.*\n  tolerance from 149.9800? mm to 150.0200? mm, "
                              r"acceptance from (\S+) mm to (\S+) mm, .*decision rule ([^,]+), guard band w = (\S+)( um| mm|)", text)
            self.assertIsNotNone(found, text)
            self.assertEqual(found[4], said)
            self.assertAlmostEqual(float(found[1]), 100 * inside, delta=0.1)
            self.assertAlmostEqual(float(found[2]), 149.98 + width, delta=2e-4)
        wide = test.replace("149.98", "149").replace("150.02", "151")
        text = self.run_text(SUM + wide)
        # 400,000 samples inside: at 95 % confidence more than 1 - 3/400000.
        self.assertIn("conformance probability > 99.9992 %, specific consumer's risk < 0.0008 %", text)
        row = json.loads(self.run_text(SUM + wide, "--format", "json"))[0]["conformity"][0]
        self.assertAlmostEqual(row["conformance_probability_low"], 0.05 ** (1 / 400_000), delta=1e-9)
        narrow = test.replace("149.98", "149.99").replace("150.02", "150.01")
        self.assertIn("leave no room for acceptance", self.run_text(SUM + narrow + 'rule = "ilac_g8"\n'))
        self.assertIn("a guard band is given together with rule", self.refusal(SUM + test + 'rule = "ilac_g8"\nguard_band = "1 um"\n'))

    # help

    def test_every_command_has_an_example_that_is_accepted(self):
        for name in re.findall(r"^  (\w+)  +\w", gumshoe("--help").stdout.split("Subcommands:")[1], re.M):
            with self.subTest(name):
                text = gumshoe(name, "--help").stdout
                example = re.search(r"^Example: .*\n +gumshoe (.*)$", text, re.M)
                self.assertIsNotNone(example, text)
                self.assertEqual(example[1].split()[0], name)
                self.assertLessEqual(set(re.findall(r"--[\w-]+", example[1])), set(re.findall(r"--[\w-]+", text)))
                for word in example[1].split():
                    if word.startswith("scenarios/"):
                        self.assertTrue((ROOT / word).exists())

    def test_manual_page_and_completion_name_every_command(self):
        names = re.findall(r"^  (\w+)  +\w", gumshoe("--help").stdout.split("Subcommands:")[1], re.M)
        man, completion = gumshoe("man").stdout, gumshoe("completion").stdout
        for name in names:
            self.assertIn(f"\n.SS {name}", man)
            self.assertRegex(completion, rf"\n    {name}\) options=\"--help")
        self.assertNotRegex(man, r"(?m)^'")
        said = subprocess.run(["bash", "-c", completion + "COMP_WORDS=(gumshoe r); COMP_CWORD=1; _gumshoe; echo ${COMPREPLY[@]}\n"
                               "COMP_WORDS=(gumshoe run --bud); COMP_CWORD=2; _gumshoe; echo ${COMPREPLY[@]}"],
                              capture_output=True, text=True)
        self.assertEqual(said.stdout.split("\n")[:2], ["run report replay", "--budget"], said.stderr)

    def test_install(self):
        build = pathlib.Path(GUMSHOE).parent
        if not (build / "cmake_install.cmake").exists():
            self.skipTest("not a build folder")
        prefix = self.folder / "installed"
        subprocess.run(["cmake", "--install", build, "--prefix", prefix], check=True, capture_output=True)
        program = prefix / "bin/gumshoe"
        (self.folder / "line.toml").write_text(SUM)
        def run(*words):
            return subprocess.run([program, *words], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(run("run", "line.toml", "--samples", "2000", "--out", "installed.h5").returncode, 0)
        self.assertEqual(run("report", "installed.h5").returncode, 0)
        self.assertIn("PASS", run("gauge", prefix / "share/gumshoe/scenarios/gauge/borehole_normal.toml").stdout)
        for file in ("share/man/man1/gumshoe.1", "share/bash-completion/completions/gumshoe", "include/gumshoe_plugin.h"):
            self.assertTrue((prefix / file).exists(), file)


if __name__ == "__main__":
    unittest.main()
