"""Wrong input never crashes and never yields a number: exit code 2 and one clear message, with its place.

usage: bad_input_test.py path/to/gumshoe [unittest options]
"""
import random
import unittest

import h5py

from program import SCENARIO, Refusals, complaint, gumshoe, places


def swap(old, new):
    assert old in SCENARIO, old
    return SCENARIO.replace(old, new, 1)


def of_radius(text):
    return swap('value = "5 mm"\nu = "1 um"', text)


def of_pitch(text, more=""):
    return swap('[quantities.beam_pitch]\nvalue = "0.2836 deg"\nu = "0.005 deg"', text) + more


# name: (scenario, line of the mistake, words of the message)
MISTAKES = {
    "unknown unit": (of_radius('value = "5 parsnip"'), 5, ["quantities.rod_radius.value", "parsnip"]),
    "unknown unit of u": (of_radius('value = "5 mm"\nu = "1 parsnip"'), 6, ["quantities.rod_radius.u", "parsnip"]),
    "wrong dimension": (of_radius('value = "5 N"'), 5, ["quantities.rod_radius.value", "'5 N'", "length"]),
    "an angle for a length": (of_radius('value = "5 deg"'), 5, ["length"]),
    "no unit": (of_radius("value = 5"), 5, ["unit"]),
    "misspelt key": (of_radius('valeu = "5 mm"'), 5, ["'valeu'", "Did you mean 'value'?"]),
    "misspelt section": (swap("[quantities.rod_radius]", "[quantites.rod_radius]"), 4, ["Did you mean 'quantities'?"]),
    "misspelt quantity": (swap(".rod_radius]", ".rod_radus]"), 4, ["'rod_radus'", "Did you mean 'rod_radius'?"]),
    "misspelt indication": (swap("spindle_z", "spindel_z"), 10, ["Did you mean 'spindle_z'?"]),
    "unknown model": (swap('"rod_gauging"', '"rod_gaugin"'), 3, ["Did you mean 'rod_gauging'?"]),
    "no model": (swap('[model]\nname = "rod_gauging"\n', ""), 1, ["model"]),
    "unknown effect": (SCENARIO + '[effects.triger_latency]\ndelay = "1 ms"\n', 14, ["Did you mean 'trigger_latency'?"]),
    "unknown quantity of an effect": (SCENARIO + '[effects.trigger_latency]\ndelya = "1 ms"\n', 15, ["Did you mean 'delay'?"]),
    "unknown method": (swap('"rod_gauging"', '"rod_gauging"\nmethod = "guess"'), 4, ["'guess'", "propagation"]),
    "another schema": (swap("schema = 1", "schema = 2"), 1, ["schema"]),
    "no schema": (swap("schema = 1", "title = 'x'"), 1, ["schema"]),
    "a direction that is none": (SCENARIO + "[conditions]\ndirection = 2\n", 15, ["direction must be 1, -1 or 0"]),
    "negative feed": (SCENARIO + '[conditions]\nfeed = "-4 mm/min"\n', 15, ["feed is negative"]),
    "negative radius": (of_radius('value = "-5 mm"'), 5, ["rod_radius", "-5 mm", "above 0"]),
    "radius of zero": (of_radius('value = "0 mm"'), 5, ["rod_radius", "above 0"]),
    "radius that can become negative": (of_radius('value = "5 mm"\ndistribution = "rectangular"\nhalf_width = "6 mm"'), 5, ["rod_radius"]),
    "fillet larger than the rod": (SCENARIO + '[quantities.fillet_radius]\nvalue = "6 mm"\n', 14, ["fillet_radius", "rod_radius"]),
    "fraction of 0": (SCENARIO + "[quantities.trigger_fraction]\nvalue = 0\n", 15, ["trigger_fraction", "above 0"]),
    "fraction of 1": (SCENARIO + "[quantities.trigger_fraction]\nvalue = 1\n", 15, ["trigger_fraction", "below 1"]),
    "pitch of 90 deg": (of_pitch('[quantities.beam_pitch]\nvalue = "90 deg"'), 8, ["beam_pitch", "90"]),
    "duplicate quantity": (SCENARIO + '[quantities.rod_radius]\nvalue = "5 mm"\n', 14, ["rod_radius"]),
    "duplicate key": (of_radius('value = "5 mm"\nvalue = "6 mm"'), 6, ["value"]),
    "NaN in text": (of_radius('value = "nan mm"'), 5, ["rod_radius", "finite"]),
    "NaN": (SCENARIO + "[quantities.trigger_fraction]\nvalue = nan\n", 15, ["trigger_fraction", "finite"]),
    "infinity": (of_radius('value = "inf mm"'), 5, ["rod_radius", "finite"]),
    "too large": (of_radius('value = "1e400 mm"'), 5, ["rod_radius", "1e400"]),
    "degrees of freedom of observations": (of_radius('observations = ["5 mm", "5.1 mm", "5.2 mm"]\ndegrees_of_freedom = 7'), 6,
                                           ["3 observations have 2", "Leave it out"]),
    "process without a value": (SCENARIO + '[[analysis.conformity]]\nmeasurand = "laser_z"\nupper = "11 mm"\nprocess = { u = "3 um" }\n',
                                17, ["process", "has no value"]),
    "process by observations": (
        SCENARIO + '[[analysis.conformity]]\nmeasurand = "laser_z"\nupper = "11 mm"\nprocess = { observations = ["9 mm", "10 mm"] }\n', 17,
        ["is stated by observations", "spread of what the process makes", "standard deviation"]),
    "NaN as an uncertainty": (of_radius('value = "5 mm"\nu = "nan um"'), 6, ["rod_radius.u"]),
    "NaN as a reading": (swap('"-329.931 mm"', '"nan mm"'), 11, ["readings"]),
    "negative u": (of_radius('value = "5 mm"\nu = "-1 um"'), 6, ["above 0"]),
    "U without k": (of_radius('value = "5 mm"\nU = "1 um"'), 6, ["k"]),
    "low above high": (of_radius('distribution = "rectangular"\nlow = "6 mm"\nhigh = "5 mm"'), 6, ["low"]),
    "unknown distribution": (of_radius('value = "5 mm"\ndistribution = "normla"\nu = "1 um"'), 6, ["Did you mean 'normal'?"]),
    "no indication": (SCENARIO.split("[indications")[0], 1, ["indications.spindle_z", "missing"]),
    "no readings": (SCENARIO.split("readings =")[0], 10, ["indications.spindle_z", "no readings"]),
    "readings without a value": (SCENARIO.split("readings =")[0] + "readings = []\n", 11, ["empty"]),
    "readings from no file": (SCENARIO.split("readings =")[0] + 'readings = { file = "none.csv", column = "z", unit = "mm" }\n', 11, ["none.csv"]),
    "label without readings": (of_pitch('[quantities.beam_pitch.by.setup]\n1 = "0.2836 deg"'), 7, ["'setup'"]),
    "label value without a row": (
        of_pitch('[quantities.beam_pitch.by.setup]\n1 = "0.2836 deg"', 'labels = { setup = "2" }\n'), 7, ["no value for setup = '2'"]),
    "label without rows": (of_pitch("[quantities.beam_pitch.by.setup]", 'labels = { setup = "2" }\n'), 7, ["no value for setup = '2'"]),
    "trace by an unknown label": (SCENARIO + '[trace]\nblocks = "setup"\n', 15, ["trace.blocks", "'setup'"]),
    "trace with few draws": (SCENARIO + "[trace]\ndraws = 10\n", 15, ["trace.draws", "99"]),
    "trace in an unknown order": (SCENARIO + '[trace]\norder = "tiem"\n', 15, ["Did you mean 'time'?"]),
    "signature of the readings": (
        SCENARIO + '[stated_effects.film]\nunit = "1"\nformula = "2 * spindle_z"\n', 16, [":16:16:", "explains itself"]),
    "signature of another dimension": (SCENARIO + '[stated_effects.film]\nunit = "um"\nformula = "feed"\n', 16, [":16:12:", "spindle_z"]),
    "unknown scope": (swap('u = "0.005 deg"', 'u = "0.005 deg"\nper = "setup"'), 10, ["'setup'"]),
    # 1 and 2 as well as 2 and 3 alike, 1 and 3 opposite: eigenvalues 1.9, 1.9, -0.8.
    "correlation matrix not positive definite": (
        SCENARIO + '[quantities.beam_yaw]\nu = "0.01 deg"\n[[correlations]]\nquantities = ["rod_radius", "beam_pitch", "beam_yaw"]\n'
        'kind = "copula"\nmatrix = [[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]]\n', 16, ["positive semidefinite", "-0.8"]),
    "correlation of what is not drawn": (
        SCENARIO + '[[correlations]]\nquantities = ["rod_radius", "beam_yaw"]\nkind = "copula"\ncoefficient = 0.5\n', 14, ["beam_yaw"]),
    "correlation beyond 1": (
        SCENARIO + '[[correlations]]\nquantities = ["rod_radius", "beam_pitch"]\nkind = "copula"\ncoefficient = 1.5\n', 17, ["coefficient"]),
    "correlation without a kind": (
        SCENARIO + '[[correlations]]\nquantities = ["rod_radius", "beam_pitch"]\ncoefficient = 0.5\n', 14, ["kind", "copula"]),
    "no samples": (SCENARIO + "[run]\nsamples = 0\n", 15, ["samples"]),
    "one sample": (SCENARIO + "[run]\nsamples = 1\n", 15, ["samples"]),
    "samples below zero": (SCENARIO + "[run]\nsamples = -5\n", 15, ["samples"]),
    "half a sample": (SCENARIO + "[run]\nsamples = 1.5\n", 15, ["samples"]),
    "samples in words": (SCENARIO + '[run]\nsamples = "many"\n', 15, ["samples"]),
    "coverage probability of 1": (SCENARIO + "[analysis]\ncoverage_probability = 1\n", 15, ["coverage_probability"]),
    "no TOML": ("schema = = 1\n", 1, []),
    "nested without end": ("a = " + "[" * 100000, 1, []),
    "a key of very many parts": (".".join("a" * 27500) + " = 1\n", 1, ["keys are nested more than"]),
    "a header of very many parts": ("\n[" + ".".join("a" * 27500) + "]\n", 2, ["keys are nested more than"]),
    "tables in tables of many parts": ("\n\n" + "".join("a.b.c.d.e.f = {" for _ in range(200)), 3, ["keys are nested more than"]),
}

garbage = random.Random(1).randbytes
# name: bytes that are no scenario and no table
FILES = {
    "empty": b"",
    "binary": garbage(5000),
    "zeros": bytes(5000),
    "broken UTF-8": b"schema = 1\ntitle = '\xff\xfe\xfd'\n",
    "10 MB of garbage": garbage(10_000_000),
    "10 MB of garbage without NUL": garbage(10_000_000).replace(b"\0", b"x"),
    "10 MB of letters": b"x" * 10_000_000,
    "10 MB of lines": b"a = 1\n" * 1_700_000,
}

# name: (CSV, line or None, words)
TABLES = {
    "text in a number": ("rod_radius (mm)\n5\nfive\n", 3, ["'five'"]),
    "number with a tail": ("rod_radius (mm)\n5x\n", 2, ["'5x'"]),
    "decimal comma": ('rod_radius (mm)\n"5,0"\n', 2, ["'5,0'"]),
    "empty cell": ("rod_radius (mm),beam_yaw (deg)\n5,\n", 2, ["''"]),
    "empty cell between quotes": ('rod_radius (mm)\n5\n""\n', 3, ["''"]),
    "NaN": ("rod_radius (mm)\nnan\n", 2, ["nan"]),
    "infinity": ("rod_radius (mm)\ninf\n", 2, ["inf"]),
    "too large": ("rod_radius (mm)\n1e999\n", 2, ["1e999"]),
    "unknown column": ("rod_radus (mm)\n5\n", 1, ["Did you mean 'rod_radius'?"]),
    "column of our own": ("rod_radius (mm),status\n5,ok\n", 1, ["'status'"]),
    "column without a name": ("rod_radius (mm),\n5,1\n", 1, ["name"]),
    "repeated column": ("rod_radius (mm),rod_radius (mm)\n5,5\n", 1, ["rod_radius", "twice"]),
    "column repeated in another unit": ("rod_radius (mm),rod_radius (um)\n5,5000\n", 1, ["rod_radius", "twice"]),
    "unknown unit": ("rod_radius (parsnip)\n5\n", 1, ["parsnip"]),
    "wrong dimension": ("rod_radius (N)\n5\n", 1, ["'N'", "length"]),
    "no unit": ("rod_radius\n5\n", 1, ["rod_radius", "states no unit", "rod_radius (mm)"]),
    "row too short": ("rod_radius (mm),beam_yaw (deg)\n5,0\n5\n", 3, ["1 cell", "2"]),
    "row too long": ("rod_radius (mm)\n5,6\n", 2, ["2 cells"]),
    "quote not closed": ('"rod_radius (mm)\n5\n', 1, ["quote"]),
    "unknown effect": ("triger_latency.delay (ms)\n1\n", 1, ["Did you mean 'trigger_latency.delay'?"]),
    "unknown quantity of an effect": ("trigger_latency.dely (ms)\n1\n", 1, ["Did you mean 'trigger_latency.delay'?"]),
}


class BadInput(Refusals):
    # scenarios

    def test_good_scenario_is_good(self):  # or the mistakes below would prove nothing
        run = gumshoe("check", self.good)
        self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_mistakes_in_a_scenario(self):
        out = self.folder / "never.h5"
        for name, (text, line, words) in MISTAKES.items():
            path = self.write("bad.toml", text)
            for command in (["check"], ["check", "--explain"], ["run", "--samples", 1000, "--out", out]):
                with self.subTest(name, command=command[0]):
                    out.unlink(missing_ok=True)
                    run = gumshoe(command[0], path, *command[1:])
                    self.refused(run, words)
                    self.assertIn(line, [at for at, _ in places(run, path)], run.stderr)
                    self.assertFalse(out.exists())

    def test_all_mistakes_at_once(self):
        path = self.write("bad.toml", SCENARIO.replace("5 mm", "5 N").replace("0.005 deg", "0.005 parsnip").replace("resolution", "resolutoin"))
        run = gumshoe("check", path)
        self.refused(run, ["parsnip", "'5 N'", "Did you mean 'resolution'?"])
        self.assertEqual([line for line, _ in places(run, path)], [5, 9, 12])

    def test_mistakes_in_the_data_of_a_scenario(self):
        text = SCENARIO.split("readings =")[0] + 'readings = { file = "data.csv", column = "z", unit = "mm" }\n'
        path, data = self.write("data.toml", text), self.folder / "data.csv"
        self.write("data.csv", "z\n-329.932\n-329.931\n")
        self.assertEqual(gumshoe("check", path).returncode, 0)
        for name, (csv, words) in {
            "text in a number": ("z\n-329.932\nhigh\n", ["data.csv:3:1: error:", "'high'"]),
            "NaN": ("z\n-329.932\nnan\n", ["data.csv:3:1: error:"]),
            "no such column": ("y\n-329.932\n", ["'z'"]),
            "repeated column": ("z,z\n1,1\n", ["twice"]),
            "row too long": ("z\n-329.932\n-329.932,5\n", ["data.csv:3:"]),
            "no rows": ("z\n", []),
            **{name: (csv, []) for name, csv in FILES.items()},
        }.items():
            with self.subTest(name):
                self.write("data.csv", csv)
                self.refused(gumshoe("check", path), words)
        data.unlink()
        data.mkdir()
        self.refused(gumshoe("check", path), ["directory"])
        data.rmdir()

    # files that are none of ours

    def test_files_that_are_no_input(self):
        for name, content in FILES.items():
            path = self.write("garbage", content)
            for command in (["check", path], ["run", path, "--out", self.folder / "never.h5"],
                            ["evaluate", "rod_gauging", "--table", path], ["replay", path, "--sample", 1], ["report", path]):
                with self.subTest(name, command=command[0]):
                    self.refused(gumshoe(*command), [str(path)])

    def test_a_directory_and_nothing(self):
        for path, word in ((self.folder, "directory"), (self.folder / "nothing", "does not exist")):
            for command in (["check", path], ["run", path, "--out", self.folder / "never.h5"],
                            ["evaluate", "rod_gauging", "--table", path], ["replay", path, "--sample", 1], ["report", path]):
                with self.subTest(word, command=command[0]):
                    self.refused(gumshoe(*command), [str(path), word])

    def test_results_that_are_damaged(self):
        whole = self.result.read_bytes()
        damaged = bytearray(whole)
        for i in range(600, 3000, 7):
            damaged[i] ^= 0x5A
        self.write("half.h5", whole[: len(whole) // 2])
        self.write("damaged.h5", bytes(damaged))
        with h5py.File(self.folder / "foreign.h5", "w") as file:
            file["x"] = [1, 2, 3]
        with h5py.File(self.folder / "other.h5", "w") as file:
            file.attrs["program"] = "another"
        with h5py.File(self.folder / "later.h5", "w") as file:
            file.attrs["program"] = "gumshoe"
            file.attrs["format_version"] = 99
        for name, words in {"half": [], "damaged": [], "foreign": [], "other": ["another program"], "later": ["another format version"]}.items():
            path = self.folder / f"{name}.h5"
            for command in (["replay", path, "--sample", 1], ["report", path]):
                with self.subTest(name, command=command[0]):
                    self.refused(gumshoe(*command), [str(path), *words])

    def test_temperatures_below_absolute_zero(self):
        text = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "length * (1 + alpha * (temperature - reference))"
[quantities]
length = { value = "1 m", u = "1 um" }
alpha = "11 um/m/K"
reference = "20 degC"
temperature = VALUE
"""
        path = self.folder / "cold.toml"
        for value, wrong in (('"-400 degC"', "-400 degC is below absolute zero (-273.15 degC)"),
                             ('{ value = "-273.16 degC", u = "0.1 K" }', "-273.16 degC is below"),
                             ('{ distribution = "rectangular", low = "-300 degC", high = "20 degC" }', "-300 degC is below"),
                             ('"-500 degF"', "-500 degF is below absolute zero (-459.67 degF)"),
                             ('"-273.15 degC"', ""), ('"-400 K"', ""),
                             ('{ value = "20 degC", components = [{ distribution = "rectangular", half_width = "300 degC" }] }', "")):
            with self.subTest(value):
                path.write_text(text.replace("VALUE", value))
                run = gumshoe("check", path)
                if wrong:
                    self.refused(run, ["cold.toml:10:", "quantities.temperature", wrong])
                else:  # in K it may be a difference
                    self.assertEqual(run.returncode, 0, run.stderr)
        self.write("cold.csv", "t\n20\n-400\n")
        path.write_text(text.replace("temperature = VALUE\n", "") +
                        '[indications.temperature]\nreadings = { file = "cold.csv", column = "t", unit = "degC" }\n')
        self.refused(gumshoe("check", path), ["cold.csv:3:1: error:", "-400 degC is below absolute zero"])

    def test_result_whose_scenario_has_changed(self):
        path, result = self.write("changing.toml", SCENARIO), self.folder / "changing.h5"
        self.assertEqual(gumshoe("run", path, "--samples", 1000, "--out", result).returncode, 0)
        path.write_text(SCENARIO.replace("5 mm", "6 mm"))
        self.refused(gumshoe("replay", result, "--sample", 1), [str(path)])
        path.unlink()
        self.refused(gumshoe("replay", result, "--sample", 1), [str(path)])

    # tables

    def test_mistakes_in_a_table(self):
        out = self.folder / "never.csv"
        for name, (csv, line, words) in TABLES.items():
            path = self.write("bad.csv", csv)
            for more in ([], ["--out", out]):
                with self.subTest(name, more=bool(more)):
                    out.unlink(missing_ok=True)
                    run = gumshoe("evaluate", "rod_gauging", "--table", path, *more)
                    self.refused(run, words)
                    self.assertIn(line, [at for at, _ in places(run, path)], run.stderr)
                    self.assertFalse(out.exists())

    # words of the command line

    def test_mistakes_in_the_command_line(self):
        run = ["run", self.good, "--out", self.folder / "never.h5"]
        for name, (command, words) in {
            **{f"--samples {n}": ([*run, "--samples", n], ["--samples"]) for n in ("0", "-5", "abc", "1.5", "1", "", "nan", "1e30", "1e6x")},
            **{f"--seed {n}": ([*run, "--seed", n], ["--seed"]) for n in ("-1", "abc", "1.5", "")},
            **{f"--threads {n}": ([*run, "--threads", n], ["--threads", f"'{n}' is not a whole number from 0 to 1024"])
               for n in ("-1", "abc", "1.5", "1025", "")},
            "too many samples": ([*run, "--samples", "1e13"], ["--samples", "at most 1099511627776"]),
            "--format": ([*run, "--format", "xml"], ["xml"]),
            "unknown option": ([*run, "--sampels", "5"], ["--sampels"]),
            "unknown short option": ([*run, "-x", "5"], ["unknown option '-x' of gumshoe run", "--help"]),
            "no scenario": (["run"], ["scenario"]),
            "unknown model": (["evaluate", "rod_gaugin", "--table", self.table], ["Did you mean 'rod_gauging'?"]),
            "unknown evaluation": (["evaluate", "rod_gauging", "--table", self.table, "--evaluation", "ful"], ["'ful'"]),
            "no table": (["evaluate", "rod_gauging"], ["--table"]),
            "models": (["models", "rod_gaugin"], ["Did you mean 'rod_gauging'?"]),
            "models, far off": (["models", "zzz"], ["'zzz'"]),
            "effects": (["effects", "trigger_latencey"], ["Did you mean 'trigger_latency'?"]),
            "effects, far off": (["effects", "zzz"], ["'zzz'"]),
            "no command": ([], []),
            "unknown command": (["frobnicate"], ["frobnicate"]),
            **{f"--sample {n}": (["replay", self.result, "--sample", n], ["--sample"]) for n in ("1e30", "-1", "abc", "1.5", "nan", "")},
            **{f"--sample {n}": (["replay", self.result, "--sample", n], ["is beyond the run"]) for n in ("1000", "1e15")},
            "no sample": (["replay", self.result], ["--sample"]),
            "an empty name": (["run", self.good, "--out", ""], ["--out: the text is empty", "leave the option out"]),
            "an empty scenario": (["check", ""], ["scenario: the text is empty"]),
        }.items():
            with self.subTest(name):
                self.refused(gumshoe(*command), words)

    def test_seed_zero_is_a_seed(self):  # the scenario's format allows it
        run = gumshoe("run", self.good, "--samples", 1000, "--seed", 0, "--out", self.folder / "zero.h5")
        self.assertEqual(run.returncode, 0, run.stderr)

    # places that cannot be written

    def test_unwritable_outputs(self):
        inside_a_file = self.good / "x"
        for command in (["run", self.good, "--samples", 1000, "--out"], ["evaluate", "rod_gauging", "--table", self.table, "--out"],
                        ["report", self.result, "--out"]):
            for path in (inside_a_file, self.folder, "/dev/full"):
                with self.subTest(command[0], path=str(path)):
                    self.refused(gumshoe(*command, path), [str(self.good) if path is inside_a_file else str(path)])
        self.assertEqual(self.good.read_text(), SCENARIO)

    def test_what_is_not_ours_is_not_overwritten(self):
        foreign = self.write("letter.txt", "dear reader")
        hdf5 = self.folder / "theirs.h5"
        with h5py.File(hdf5, "w") as file:
            file["x"] = [1, 2, 3]
        for path, why in ((foreign, "not overwritten"), (hdf5, "not overwritten"), (self.good, "it would be overwritten")):
            before = path.read_bytes()
            with self.subTest(path.name):
                self.refused(gumshoe("run", self.good, "--samples", 1000, "--out", path), [str(path), why])
                self.assertEqual(path.read_bytes(), before)

    def test_no_command_destroys_its_own_input(self):
        table, result = self.write("own.csv", "rod_radius (mm)\n5\n"), self.write("own.h5", self.result.read_bytes())
        for path, command in ((table, ["evaluate", "rod_gauging", "--table", table, "--out", table]), (result, ["report", result, "--out", result])):
            before = path.read_bytes()
            with self.subTest(command[0]):
                self.refused(gumshoe(*command), [str(path)])
                self.assertEqual(path.read_bytes(), before)


if __name__ == "__main__":
    unittest.main()
