"""One wrong input per message: the program says what is wrong, in the form that program.ill_formed() demands.

usage: messages_test.py path/to/gumshoe [unittest options]
"""
import os
import unittest

from program import ROOT, SCENARIO, InFolder, complaint, gumshoe
from choose_test import TEXT as CHOOSE

# Six readings with labels and a condition, in the scenario itself.
ROWS = SCENARIO[:SCENARIO.index("[indications")] + """[indications.spindle_z]
resolution = "1 um"
rows = [
  { rod = "a", setup = "1", values = ["-329.932 mm", "-329.931 mm"] },
  { rod = "b", setup = "1", values = ["-329.932 mm"] },
  { rod = "a", setup = "2", values = ["-329.932 mm"] },
]
"""
DATA = """schema = 1
[model]
name = "rod_gauging"
[indications.spindle_z]
readings = { file = "z.csv", column = "z", unit = "mm", labels = { rod = "rod" } }
"""
FORMULA = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "a + b"
[quantities]
a = { value = "1 mm", u = "1 um" }
b = { value = "2 mm", u = "1 um" }
"""
COMMAND = """schema = 1
[model]
name = "command"
command = ["python3", "model.py"]
[model.measurands]
y = "mm"
[quantities]
a = { value = "1 mm", u = "1 um" }
"""
FEED_SPEED = (ROOT / "scenarios/choose_feed_speed.toml").read_text()
PLAIN = 'value = "5 mm"\nu = "1 um"'
CORRELATED = '[[correlations]]\nquantities = ["rod_radius", "beam_pitch"]\nkind = "copula"\n'

# One result for all readings: its outputs have no labels.
TOOL = """schema = 1
[model]
name = "tool_length"
evaluation = "single"
[indications.spindle_z]
rows = [{ n = "1", values = ["-1000 mm"] }]
"""

# Two indications of a model, of which one lacks a reading.
SPHERE = """schema = 1
[model]
name = "sphere_calibration"
[indications]
X = { rows = [{ n = "1", values = ["1 mm"] }, { n = "2", values = ["1 mm"] }] }
Y = { rows = [{ n = "1", values = ["1 mm"] }] }
Z = { rows = [{ n = "1", values = ["1 mm"] }] }
"""
ROD_CHOICE = SCENARIO.replace('name = "rod_gauging"', 'name = "rod_gauging"\nmethod = "virtual_experiment"').replace(
    'readings = ["-329.932 mm", "-329.932 mm", "-329.931 mm"]\n', "") + """[choose]
measurand = "laser_z"
target = "5 um"
[choose.variables]
rod_radius = ["4.9 mm"]
[choose.time]
per_reading = "pause"
pause = "1 s"
"""

# (scenario, what is replaced or None for appending, by what, words of the message)
CHECKED = [
    # uncertainties
    (SCENARIO, PLAIN, 'value = "mm"', "it does not begin with a number"),
    (SCENARIO, PLAIN, 'value = "5,3 mm"', "the decimal sign must be a point"),
    (SCENARIO, PLAIN, 'value = "5_3 mm"', "only one number may stand here"),
    (SCENARIO, PLAIN, 'value = "1e999 mm"', "too large or too small"),
    (SCENARIO, PLAIN, 'value = "5 mm"\nhalf_width = "1 um"\nlow = "4 mm"\ndistribution = "rectangular"',
     "half_width is given together with low or high"),
    (SCENARIO, PLAIN, 'value = "5 mm"\ndistribution = "rectangular"', "Give half_width, or low and high."),
    (SCENARIO, PLAIN, 'distribution = "discrete"\nvalues = ["5 mm", "6 mm"]', 'use distribution = "empirical" for equal ones'),
    (SCENARIO, PLAIN, 'distribution = "discrete"\nvalues = ["5 mm", "6 mm"]\nprobabilities = [1]', "probabilities for 2 values"),
    (SCENARIO, PLAIN, 'distribution = "discrete"\nvalues = ["5 mm", "6 mm"]\nprobabilities = [0.5, 0.6]',
     "the probabilities add up to"),
    (SCENARIO, PLAIN, 'value = "5 mm"\ndistribution = "normal"', "Give u, or U with k."),
    (SCENARIO, PLAIN, 'components = [ { name = "x" } ]', "the distribution is missing"),
    (SCENARIO, PLAIN, 'observations = ["5 mm", "5.1 mm"]\nu = "1 um"', "together with another statement of uncertainty"),
    (SCENARIO, PLAIN, 'source = "a guess"', "neither a value nor an uncertainty is given"),
    (SCENARIO, PLAIN, 'value = "5 mm"\ndistribution = "rectangular"\nhalf_width = "6 mm"', "the distribution reaches -1"),
    (SCENARIO, PLAIN, 'value = true', "is not a length"),
    (SCENARIO, PLAIN, 'value = "5 mm"\nunit = "s"', "'s' is not a length"),
    # readings and their noise
    (SCENARIO, 'repeatability = { s = "0.4 um", degrees_of_freedom = 24 }', 'repeatability = "often"', "not understood"),
    (SCENARIO, 'repeatability = { s = "0.4 um", degrees_of_freedom = 24 }', 'repeatability = { pooled = true, s = "1 um" }',
     "s is given together with pooled"),
    (SCENARIO, 'repeatability = { s = "0.4 um", degrees_of_freedom = 24 }', 'repeatability = { pooled = 1 }',
     "expected true or false"),
    (ROWS, '"-329.932 mm", "-329.931 mm"] }', '"-329.932 mm"], repeats = 2 }', "repeats is given together with values"),
    (ROWS, "rows = [", 'readings = ["1 mm"]\nrows = [', "readings is given together with rows"),
    (ROWS, '{ rod = "b",', '{ reading = "b",', "'reading' cannot be a label"),
    (DATA, 'labels = { rod = "rod" } }', 'where = { rood = "a" } }', "is neither a label of these readings nor a column"),
    (DATA, ', labels = { rod = "rod" } }', ' }\nlabels = { rod = "a" }', "the labels of a data file are its columns"),
    (DATA, 'labels = { rod = "rod" } }', 'conditions = { fed = { column = "z" } } }', "rod_gauging has no condition 'fed'"),
    (DATA, 'labels = { rod = "rod" } }', 'conditions = { feed = { column = "z", unit = "mm" } } }', "'mm' is not a speed"),
    (DATA, ', labels = { rod = "rod" } }', ' }\n[conditions]\nfeed = ["1 mm/min", "2 mm/min"]', "conditions are listed, one per reading"),
    (ROWS, None, '[quantities.beam_yaw.by.rod.a.by.rod.b]\nvalue = "0 deg"\n', "is nested within itself"),
    (ROWS, None, '[quantities.beam_yaw]\nvalue = "0 deg"\nu = "1 deg"\nper = "rood"\n', "Did you mean 'rod'?"),
    (ROWS.replace('rod = "b", setup = "1"', 'rod = "b"'), None,
     '[quantities.beam_yaw]\nvalue = "0 deg"\nu = "1 deg"\nper = "setup"\n', "per = 'setup', but reading 2 does not have this label"),
    (SPHERE, None, "", "lacks an indication"),
    (SCENARIO, None, '[quantities.fillet_radius]\nvalue = "6 mm"\n', "fillet_radius exceeds rod_radius"),
    (ROWS, None, '[quantities.fillet_radius.by.rod]\na = "0 mm"\nb = "6 mm"\n',
     "fillet_radius exceeds rod_radius at reading 2 (rod b, setup 1) (physically impossible)"),
    # correlations
    (SCENARIO, None, CORRELATED, "either a coefficient or a matrix is needed"),
    (SCENARIO, None, CORRELATED + "matrix = [[1, 0.5], [0.4, 1]]\n", "correlations are symmetric"),
    (SCENARIO, None, CORRELATED.replace(', "beam_pitch"', "") + "coefficient = 0.5\n", "at least two quantities"),
    (SCENARIO, None, '[quantities.beam_yaw]\nu = "1 deg"\n' + CORRELATED.replace('"beam_pitch"', '"beam_pitch", "beam_yaw"')
     + "coefficient = -0.6\n", "the matrix is not positive semidefinite (its smallest eigenvalue is -0.2)"),
    (SCENARIO, None, CORRELATED.replace('"beam_pitch"', '"rod_radius"') + "coefficient = 0.5\n", "is named twice"),
    (SCENARIO, None, (CORRELATED + "coefficient = 0.5\n") * 2, "is already part of another correlation"),
    (ROWS, None, '[quantities.rod_length.by.rod]\na = { value = "1 mm", u = "1 um" }\nb = { value = "1 mm", u = "1 um" }\n'
     + CORRELATED.replace("rod_radius", "rod_length").replace("beam_pitch", "rod_length[rod a]") + "coefficient = 0.5\n", "has several draws"),
    (SCENARIO.replace(PLAIN, 'distribution = "discrete"\nvalues = ["5 mm", "6 mm"]\nprobabilities = [0.5, 0.5]'), None,
     CORRELATED.replace("copula", "spearman") + "coefficient = 0.5\n", "needs continuous distributions"),
    # run, analysis, estimate, trace
    (SCENARIO, None, '[run]\ndesign = "sobol"\nadaptive = { rule = "stein" }\n', "adaptive runs need independent samples"),
    (SCENARIO, None, '[analysis]\ncomparisons = [ { measurand = "laser_z", between = "rod", within = "rod" } ]\n', "must be different labels"),
    (SCENARIO, None, "[analysis]\nsensitivity = { second_order = true }\n", "needs a base size"),
    (SCENARIO, None, '[analysis]\njoint = "laser_z"\n', "expected an array"),
    (SCENARIO, None, '[analysis]\njoint = [["laser_z"]]\n', "each group needs at least two measurands"),
    (SCENARIO, None, '[analysis]\njoint = [["laser_z", "laser_zz"]]\n', "measurand here"),
    (SCENARIO, None, '[[analysis.one_at_a_time]]\ntitle = "x"\nsteps = { rod_radius = "0 mm" }\n', "the step of rod_radius is zero"),
    (SCENARIO, None, '[[analysis.conformity]]\nmeasurand = "laser_z"\n', "no tolerance limit"),
    (SCENARIO, None, '[[analysis.conformity]]\nmeasurand = "laser_z"\nlower = "2 mm"\nupper = "1 mm"\n', "lower must be below upper"),
    (SCENARIO, None, '[[analysis.conformity]]\nmeasurand = "laser_z"\nlower = "2 mm"\nguard_factor = 1\nguard_band = "1 um"\n',
     "both guard_band and guard_factor"),
    (SCENARIO, None, '[[analysis.conformity]]\nmeasurand = "laser_z"\nlower = "2 mm"\nprocess = "2 mm"\n', "must be one distribution"),
    (SCENARIO, None, "[estimate]\nwidth = 1\n", "the squared loss has no width"),
    (ROWS, None, '[trace]\nblocks = "setup"\nfinal = []\n', "the last quarter of the blocks"),
    (ROWS.replace('rod = "b", setup = "1"', 'rod = "b"'), None, '[trace]\nblocks = "setup"\n', "a reading has no label 'setup'"),
    (ROWS, None, "[trace]\nredone = [[]]\n", "a set-up step needs at least one label"),
    (ROWS, None, "[trace]\nredone = 3\n", "expected an array, found an integer. Write redone = [ ... ]."),
    (DATA, 'labels = { rod = "rod" } }', 'conditions = { feed = 3 } }', "the name of a column is expected, not an integer. "
     "Put it in quotes; a value that all rows share stands in [conditions]."),
    (DATA, None, '[trace.columns]\nfeed = { column = "z", unit = "mm/s" }\n', "it is a condition of the model rod_gauging"),
    (SCENARIO, None, '[effects.backlash]\nvalue = "1 um"\n', "it is a quantity of "),
    (SCENARIO, None, '[stated_effects.film]\nunit = "degC"\nformula = "feed"\n', "has its own zero"),
    (SCENARIO, None, '[stated_effects.film]\nunit = "um*s"\nformula = "1 / time"\nsize = { value = "1 um*s" }\n', "the formula has no finite value at reading"),
    (SCENARIO, None, '[stated_effects.film]\nunit = "um"\nformula = "feed"\n', "multiplied by a size in um, it gives"),
    (SCENARIO, None, '[stated_effects.film]\nunit = "ms"\nformula = "feed"\nquantity = "rod_length"\nindication = "spindle_z"\n', "the effect adds to a quantity"),
    (SCENARIO, None, '[stated_effects.film]\nunit = "um"\nformula = "feed"\nquantity = "rod_length"\n', "rod_length is a length"),
    # formulas, programs, machines
    (FORMULA, 'y = "a + b"', "", "no formula"),
    (FORMULA, 'y = "a + b"', 'y = "(a b"', "an operator or ')' is missing before 'b'"),
    (FORMULA, None, '[conditions]\na = "1 mm"\n', "names must be unique"),
    (FORMULA, 'y = "a + b"', 'status = "a + b"', "'status' cannot be the name of a measurand or of what is predicted"),
    (FORMULA, 'y = "a + b"', 'sample = "a + b"', "a dataset of the result file has this name"),
    (FORMULA, 'y = "a + b"', 'y = { formula = "a + b", unit = "s" }', "unit: 's' is not"),
    (FORMULA, "b = {", 'pi = { value = "2 mm" }\nb = {', "quantities.pi: this name is a constant of formulas"),
    (FORMULA, "[quantities]", '[conditions]\ne = 1\n[quantities]', "conditions.e: this name is a constant of formulas"),
    (FORMULA, "b = {", 'max = { value = "2 mm" }\nb = {', "quantities.max: this name is a function of formulas"),
    (FORMULA, "[quantities]", '[model.intermediates]\npi = "3"\n[quantities]', "cannot be the name of a formula (it is a constant"),
    (CHOOSE, "way = ", 'pi = "5 mm"\nway = ', "choose.time.pi: the name already has a meaning"),
    (FORMULA, "[quantities]", '[model.intermediates]\n"a b" = "1"\n[quantities]', "cannot be the name of a formula"),
    (COMMAND, 'y = "mm"', "", "nothing can be evaluated"),
    (COMMAND, 'y = "mm"', '"y,z" = "mm"', "cannot be a column"),
    ('schema = 1\n[model]\nname = "sphere_probing"\n[machine]\nworkpiece_side = ["C"]\ntool_side = ["X", "Y"]\n', None, "",
     "three slides bring the tip to the sphere"),
    ('schema = 1\n[model]\nname = "sphere_probing"\n[machine]\nworkpiece_side = [{ axis = "X", sense = 2 }]\ntool_side = ["Y", "Z"]\n',
     None, "", "is neither 1 nor -1"),
    ('schema = 1\n[model]\nname = "sphere_probing"\n[machine]\nworkpiece_side = [{ axis = "X", kind = "rotary" }]\ntool_side = ["Y", "Z"]\n',
     None, "", "X, Y, Z, U, V, W are linear"),
    (DATA, None, '[trace.columns]\ne = { column = "e" }\n[stated_effects.film]\nunit = "um"\nformula = "e"\n', "'e' has two meanings here"),
    # choices
    (CHOOSE, "readings = [1, 2, 3]", "readings = [1, 1]", "the value is listed twice"),
    (CHOOSE, "readings = [1, 2, 3]", 'evaluation = { low = "1", high = "2" }', "evaluations must be listed"),
    (CHOOSE, 'low = "10 mm/min"', 'low = "0 mm/min"', "not above 0"),
    (CHOOSE, "[choose.variables]\n", '[choose.variables]\nevaluation = ["fast"]\n', "has no evaluation 'fast'"),
    (CHOOSE, CHOOSE[CHOOSE.index("feed = {"):CHOOSE.index("[choose.time]")], "", "nothing to choose from"),
    (CHOOSE, 'feed = "10 mm/min"', 'feed = ["10 mm/min", "20 mm/min"]', "it differs between the readings"),
    (CHOOSE, 'feed = "10 mm/min"', 'feed = ["10 mm/min", "20 mm/min"]', "the readings are listed"),
    (ROD_CHOICE, '["4.9 mm"]', '["-5 mm"]', "rod_radius: -5 mm is impossible (must be above 0 mm)"),
    (ROD_CHOICE.replace("resolution", 'rows = [{ rod = "a", repeats = 1 }, { rod = "b", repeats = 1 }]\nresolution'), 'rod_radius = ["4.9 mm"]',
     'rod_length = ["5 mm"]\n[quantities.rod_length.by.rod]\na = "4 mm"\nb = "5 mm"', "its value differs between the readings"),
    (FEED_SPEED, 'measurand       = "effective_length"', 'measurand = "phase"', "does not yield 'phase'"),
    (CHOOSE, 'feed = "10 mm/min"', 'feed = { spread = ["10 mm/min", "20 mm/min"], readings = 1 }', "it is spread over the readings"),
    (CHOOSE, 'way = "5 mm"', 'way = "nan mm"', "not finite"),
    (FEED_SPEED, 'orientation_time = "1 s"', 'orientation_time = "-1 s"', "choose.time.orientation_time: -1 s is impossible (must be at least 0 s)"),
]


class Messages(InFolder):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "s.toml"
        (self.file.parent / "z.csv").write_text("z,rod,e\n-329.932,a,1\n-329.931,b,2\n")

    def test_the_bases_are_good(self):  # or the mistakes below would prove nothing
        for text in (SCENARIO, ROWS, DATA, FORMULA, CHOOSE):
            self.file.write_text(text)
            self.assertEqual(gumshoe("check", self.file).stderr, "")

    def test_scenarios(self):
        for text, old, new, words in CHECKED:
            with self.subTest(words, new=new):
                self.assertTrue(old is None or old in text)
                self.file.write_text(text + new if old is None else text.replace(old, new, 1))
                run = gumshoe("check", self.file)
                self.assertIsNone(complaint(run), run.stderr)
                self.assertIn(words, run.stderr)

    def refused(self, text, command, words):
        self.file.write_text(text)
        out = self.file.parent / "never.h5"
        run = gumshoe(*(self.file if w == "S" else out if w == "O" else w for w in command), cwd=self.file.parent)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn(words, run.stderr)

    def test_tables(self):
        table = self.file.parent / "t.csv"
        for model, header, more, words in [
            ("rod_gauging", "spindle_z (mm),laser_z (mm)", [], "is what the indications are evaluated for"),
            ("sphere_calibration", "X (mm)", [], "the other indications are given"),
            ("sphere_calibration", "sphere_distance (mm)", ["--evaluation", "joint"], "no column of readings"),
            ("rod_gauging", "spindle_z (mm)", ["--evaluation", "full", "--out", "none/x.csv"], "cannot be written"),
            ("sphere_calibration", "B (deg)", ["--evaluation", "closed_form"], "closed_form holds only at B = 0"),
            ("sphere_calibration", "thermal_growth.rate (um/h)", ["--evaluation", "closed_form"], "closed_form cannot include effects"),
            ("sphere_calibration", "feed (mm/min)=-1", [], "feed is negative"),
            ("sphere_calibration", "B_direction=2", [], "B_direction must be 1, -1 or 0"),
            ("sphere_calibration", "C_direction=2", [], "C_direction must be 1, -1 or 0"),
            ("sphere_calibration", "B_clamped=2", [], "B_clamped must be 0 or 1"),
            ("sphere_calibration", "C_clamped=2", [], "C_clamped must be 0 or 1"),
            ("tool_length", "inserts,spindle_z (mm)=2,0\n3,0", ["--evaluation", "peaks"], "inserts differ between readings"),
        ]:
            with self.subTest(words):
                header, _, rows = header.partition("=")
                table.write_text(header + "\n" + (rows or ",".join(["1"] * (header.count(",") + 1))) + "\n")
                run = gumshoe("evaluate", model, "--table", table, *more)
                self.assertIsNone(complaint(run), run.stderr)
                self.assertIn(words, run.stderr)

    def test_commands(self):
        fit = FORMULA + '[model.indications]\nz = "a * 2"\n[indications.z]\nreadings = ["2 mm"]\n'
        estimated = fit.replace('u = "1 um"', 'u = "1 um", estimated = true', 1)
        noise, own = 'repeatability = { s = "1 um" }', 'components = [ { distribution = "normal", u = "1 um", per = [] } ]'

        def two(readings, of_z, of_w):  # indications z and w
            return FORMULA.replace("u = ", "estimated = true, u = ", 1) + (
                f'[model.indications]\nz = "a * 2"\nw = "a"\n[indications.z]\n{readings}\n{of_z}\n'
                f'[indications.w]\n{readings}\n{of_w}\n')
        for text, command, words in [
            (SCENARIO, ["run", "S", "--out", "O" * 300], "too long"),
            (SCENARIO, ["estimate", "S"], "no quantity is marked estimated"),
            (estimated, ["estimate", "S"], "their own noise"),
            (estimated + noise + '\n[[expected]]\nfigure = "fit.mien"\nvalue = 1\nsource = "x"\n', ["gauge", "S"], "figure of this fit"),
            (fit.replace('u = "1 um"', "estimated = true"), ["estimate", "S"], "cannot determine"),
            (fit.replace('u = "1 um"', 'u = "1 um", estimated = true') + noise
             + '\n[[correlations]]\nquantities = ["a", "b"]\nkind = "copula"\ncoefficient = -1\n', ["estimate", "S"],
             "b: its prior is determined by those of other estimated quantities"),
            (TOOL + '[[expected]]\nfigure = "mean"\nof = "tool_length"\nlabels = { n = "1" }\nvalue = "1 mm"\nsource = "x"\n',
             ["gauge", "S"], "no output matches"),
            (ROWS + '[[expected]]\nfigure = "mean"\nof = "laser_z"\nlabels = { rod = "none" }\nvalue = "1 mm"\nsource = "x"\n',
             ["gauge", "S"], "no reading has rod = none"),
            (SCENARIO, ["schema", "--options", "nothing"], "there is no section"),
            (SCENARIO + '[[expected]]\nfigure = "mien"\nof = "laser_z"\nvalue = 1\nsource = "x"\n', ["gauge", "S"], "figure of this result"),
            (CHOOSE.replace('way = "5 mm"', 'way = "-5 m"'), ["choose", "S", "--out", "O"], "the time is negative"),
            (CHOOSE.replace("steps = 5", "steps = 1000").replace("readings = [1, 2, 3]", f"readings = {list(range(1, 1001))}"),
             ["choose", "S", "--out", "O"], "choose.variables: more than"),
            (ROD_CHOICE.replace('rod_radius = ["4.9 mm"]', 'fillet_radius = ["6 mm"]'), ["choose", "S", "--out", "O"],
             "choose: no combination of the variables"),
            (CHOOSE.replace("feed * delay", "feed * delay * sqrt(1 - spread * spread)", 1).replace(
                'length = "100 mm"', 'length = "100 mm"\nspread = { value = 0, u = 10 }'), ["choose", "S", "--out", "O"],
             "choose: every candidate fails"),
            (two('readings = ["1 mm"]', noise, ""), ["estimate", "S"], "no noise is declared, but"),
            (two('rows = [{ n = "1", values = ["1 mm"] }, { n = "2", values = ["1 mm"] }]', own, own), ["estimate", "S"],
             "readings share all of their noise"),
        ]:
            with self.subTest(words):
                self.refused(text, command, words)

    def test_estimates_without_a_scenario(self):
        text = FORMULA.replace('u = "1 um"', "estimated = true") + (
            '[model.indications]\nz = "a + b"\n[indications.z]\nrepeatability = { s = "1 um" }\n'
            'rows = [{ n = "1", values = ["3 mm"] }, { n = "2", values = ["3 mm"] }]\n')
        self.file.write_text(text)
        run = gumshoe("estimate", self.file, cwd=self.file.parent)
        self.assertEqual(run.returncode, 2, run.stderr)  # lest a script goes on with an older scenario
        self.assertIn("no scenario is written", run.stderr)
        self.assertIn("the data do not determine it", run.stderr)

    def test_noise_shared_by_many_readings(self):
        text = DATA.replace('labels = { rod = "rod" } }', 'labels = { n = "n" } }\ncomponents = [ { u = "1 um", per = [] } ]')
        (self.file.parent / "z.csv").write_text("z,n\n" + "".join(f"-329.932,{n}\n" for n in range(5001)))
        self.refused(text + '[quantities]\nrod_length = { value = "100 mm", estimated = true }\n', ["estimate", "S"],
                     "5001 readings share draws of their noise")

    def test_two_outputs_of_one_name(self):
        for words in (("--json", "x.json", "--report", "x.json"), ("--out", "x.h5", "--append", "x.h5"),
                      ("--out", "x.h5", "--json", "./x.h5")):
            run = gumshoe("trace", ROOT / "scenarios/trace_load_cell.toml", *words, cwd=self.file.parent)
            self.assertEqual(run.returncode, 2)
            self.assertIn(": two outputs of this command would be written to it. Choose two names.", run.stderr)

    def test_a_report_is_made_in_an_active_python_environment(self):
        """Its python3 comes first in PATH and has no packages; the generator's is /usr/bin/python3."""
        folder = self.file.parent
        (folder / "venv/bin").mkdir(parents=True)
        (folder / "venv/pyvenv.cfg").write_text("home = /usr/bin\ninclude-system-site-packages = false\n")
        (folder / "venv/bin/python3").symlink_to("/usr/bin/python3")
        self.file.write_text(SCENARIO)
        self.assertEqual(gumshoe("run", self.file, "--samples", 1000, "--out", folder / "r.h5").returncode, 0)
        run = gumshoe("report", folder / "r.h5", env={**os.environ, "PATH": f"{folder / 'venv/bin'}:/usr/bin:/bin"})
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_what_the_program_needs_and_does_not_find(self):
        self.file.write_text(SCENARIO.replace('"5 mm"', '"0.2 inch"'))  # common units need no database
        result, reports = self.file.parent / "r.h5", self.file.parent / "reports"
        self.assertEqual(gumshoe("run", self.file, "--samples", 1000, "--out", result).returncode, 0)
        reports.mkdir()
        (reports / "report.py").write_text("import os\nos.kill(os.getpid(), 9)\n")
        for command, variables, words in [
            (["check", "/proc/self/mem"], {}, "the file cannot be read (Input/output error)"),  # opens, but holds nothing
            (["check", self.file], {"UDUNITS2_XML_PATH": "none.xml"}, "the unit database of udunits2 cannot be read"),
            (["report", result], {"GUMSHOE_REPORTS": reports}, "the generator did not run to its end"),
            (["report", result], {"GUMSHOE_REPORTS": reports / "none"}, "report: the report generator '"),
            (["report", result], {"GUMSHOE_REPORTS": ""}, "(GUMSHOE_REPORTS names its folder). Unset GUMSHOE_REPORTS, or set "),
            (["trace", self.file, "--report", "x.html"], {"GUMSHOE_REPORTS": reports / "none"}, "report: the report generator '"),
        ]:
            with self.subTest(words):
                run = gumshoe(*command, env={**os.environ, **variables})
                self.assertIsNone(complaint(run), run.stderr)
                self.assertIn(words, run.stderr)

    def test_traced_scenario_of_another(self):
        self.file.write_text(ROWS)
        traced = self.file.parent / "s.traced.toml"
        for report, content, words in [("page.html", "mine", "was not written by gumshoe"), (traced.name, None, "two outputs of this command would be written to it")]:
            if content:
                traced.write_text(content)
            run = gumshoe("trace", self.file, "--out", self.file.parent / "r.h5", "--report", self.file.parent / report)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertIn(words, run.stderr)
            traced.unlink(missing_ok=True)


if __name__ == "__main__":
    unittest.main()
