"""gumshoe plan: textbook designs, closed forms, brute force over all plans and over simulated data; costs, set-ups, messages.

usage: plan_test.py path/to/gumshoe [unittest options]
"""
import csv
import itertools
import json
import math
import statistics
import unittest

import numpy as np

from program import ROOT, InFolder, complaint, gumshoe

DATA = "setup,x,warmth,y\n" + "".join(f"1,{x},1,{y}\n" for x, y in ((0, 0.3), (1, 1.2), (2, -0.4), (3, 0.1)))

# Scale and expansion coincide in the data, where the warmth is 1.
TEXT = """schema = 1
title = "made up"
[model]
name = "expression"
[model.indications]
y = "a + b * x"
[conditions]
x = 0
warmth = 1
[quantities]
a = { estimated = true, value = 0 }
b = { value = 0 }
[indications.y]
readings = { file = "d.csv", column = "y", unit = "1", labels = { setup = "setup" }, conditions = { x = "x", warmth = "warmth" } }
components = [{ distribution = "normal", u = 1, per = "reading" }]
[stated_effects.scale]
formula = "x"
unit = "1"
[stated_effects.expansion]
formula = "x * warmth"
unit = "1"
[plan]
GOALS
[plan.readings]
READINGS
"""
NORMAL = statistics.NormalDist()
Z = NORMAL.inv_cdf(0.975)
SPLIT = 'split = ["scale", "expansion"]\nsizes = { scale = 2, expansion = 1 }\nalpha = 0.05\npower = 0.9'


class Plan(InFolder):
    def write(self, goals, readings='x = { from = 0, to = 3, step = 1 }\nwarmth = [1, 2]', text=TEXT, data=DATA):
        (self.folder / "d.csv").write_text(data)
        self.file = self.folder / "s.toml"
        self.file.write_text(text.replace("GOALS", goals).replace("READINGS", readings))
        return self.file

    def run_plan(self, *more):
        return gumshoe("plan", self.file, "--out", self.folder / "plan.csv", "--force", *more)

    def planned(self, *given, **named):
        self.write(*given, **named)
        run = self.run_plan("--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def table(self):
        with open(self.folder / "plan.csv", newline="") as file:
            return list(csv.DictReader(file))

    @staticmethod
    def noncentrality(readings, of, size):
        """Of an effect given the other one and the constant, by plain least squares."""
        x = np.array(readings, dtype=float)
        columns = {"scale": x[:, 0], "expansion": x[:, 0] * x[:, 1]}
        others = np.column_stack([np.ones(len(x)), columns["expansion" if of == "scale" else "scale"]])
        g = size * columns[of]
        return float(np.sum((g - others @ np.linalg.lstsq(others, g, rcond=None)[0]) ** 2))

    def test_a_class_splits_by_the_fewest_readings_of_all_plans(self):
        answer = self.planned(SPLIT)
        self.assertTrue(answer["met"])
        there = [(x, 1) for x in range(4)]
        allowed = [(x, w) for x in range(4) for w in (1, 2)]
        needed = (Z + NORMAL.inv_cdf(0.9)) ** 2  # the other tail adds less than 1e-5

        def good(more):
            return all(self.noncentrality(there + list(more), of, size) >= needed * (1 - 1e-4)
                       for of, size in (("scale", 2), ("expansion", 1)))

        least = next(n for n in range(1, 9)
                     if any(good(more) for more in itertools.combinations_with_replacement(allowed, n)))
        self.assertEqual(answer["count"], least)
        rows = [(float(r["x"]), float(r["warmth"])) for r in self.table()]
        self.assertEqual(len(rows), least)
        self.assertTrue(good(rows))
        for goal in answer["goals"]:
            size = 2 if goal["of"] == "scale" else 1
            lam = self.noncentrality(there + rows, goal["of"], size)
            power = NORMAL.cdf(math.sqrt(lam) - Z) + NORMAL.cdf(-math.sqrt(lam) - Z)
            self.assertAlmostEqual(goal["power_after"], power, places=6)
            self.assertAlmostEqual(goal["power_before"], 0.05, places=3)

    def test_power_is_the_share_of_simulated_data(self):
        goal = next(g for g in self.planned(SPLIT)["goals"] if g["of"] == "scale")
        rows = np.array([(x, 1) for x in range(4)] + [(float(r["x"]), float(r["warmth"])) for r in self.table()])
        x, warmth = rows.T
        rng = np.random.default_rng(3)
        sets = 20_000
        y = 2 * x[:, None] + rng.standard_normal((len(x), sets))
        columns = np.column_stack([np.ones(len(x)), x * warmth, x])
        inverse = np.linalg.inv(columns.T @ columns)
        z = (inverse @ columns.T @ y)[2] / math.sqrt(inverse[2, 2])
        p = goal["power_after"]
        self.assertAlmostEqual(np.mean(np.abs(z) > Z), p, delta=5 * math.sqrt(p * (1 - p) / sets))

    @staticmethod
    def power(noncentrality, freedom, alpha):
        """Of a two-sided t-test: integrated over the estimated noise, with its own quantile."""
        s = np.linspace(0, 12, 200_001)[1:]
        log = freedom / 2 * math.log(freedom / 2) - math.lgamma(freedom / 2)
        weight = 2 * np.exp(log + (freedom - 1) * np.log(s) - freedom * s**2 / 2) * (s[1] - s[0])

        def share(t, shift):
            beyond = np.vectorize(lambda z: 0.5 * math.erfc(z / math.sqrt(2)))
            coarse = np.linspace(0, 12, 4_001)  # the tail is smooth: interpolated
            return float(np.sum(weight * np.interp(s, coarse, beyond(coarse * t - shift) + beyond(coarse * t + shift))))

        low, high = 0.0, 1e4
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if share(middle, 0) > alpha else (low, middle)
        return share(high, math.sqrt(noncentrality))

    UNDECLARED = TEXT.replace('components = [{ distribution = "normal", u = 1, per = "reading" }]', "")

    def test_an_estimated_noise_has_the_freedom_that_the_fit_with_the_effect_leaves(self):
        """A t-test of the effect has n - 2 degrees of freedom here; the fit without it leaves one more."""
        x, y = np.arange(4.0), np.array([0.3, 1.2, -0.4, 0.1])
        variance = float(np.var(y, ddof=1))
        allowed = [0.0, 3.0]

        def power(readings):
            rows = np.array([*x, *readings])
            return self.power(4 * np.sum((rows - rows.mean()) ** 2) / variance, len(rows) - 2, 0.05)

        goals = 'detect = "scale"\nsizes = { scale = 2 }\nalpha = 0.05\npower = 0.99'
        answer = self.planned(goals, "x = [0, 3]", text=self.UNDECLARED)
        self.assertEqual(answer["noise"], "estimated")
        goal = answer["goals"][0]
        self.assertAlmostEqual(goal["power_before"], power([]), places=3)
        planned = [float(row["x"]) for row in self.table()]
        self.assertAlmostEqual(goal["power_after"], power(planned), places=3)
        least = next(n for n in range(9)
                     if any(power(more) >= 0.99 for more in itertools.combinations_with_replacement(allowed, n)))
        self.assertEqual((answer["met"], answer["count"]), (True, least))
        self.assertGreater(least, 0)

    def test_a_split_by_an_estimated_noise_has_both_effects_in_the_fit(self):
        variance = float(np.var([0.3, 1.2, -0.4, 0.1], ddof=1))
        answer = self.planned(SPLIT, text=self.UNDECLARED)
        rows = [(x, 1) for x in range(4)] + [(float(r["x"]), float(r["warmth"])) for r in self.table()]
        for goal in answer["goals"]:
            lam = self.noncentrality(rows, goal["of"], 2 if goal["of"] == "scale" else 1) / variance
            self.assertAlmostEqual(goal["power_after"], self.power(lam, len(rows) - 3, 0.05), places=3)

    def test_too_few_readings_have_no_test_of_an_effect(self):
        """Two readings and a constant show a noise; with the effect in the fit none is left of it."""
        goals = 'detect = "scale"\nsizes = { scale = 1000 }\nalpha = 0.05\npower = 0.9'
        answer = self.planned(goals, "x = [0, 3]", text=self.UNDECLARED, data="setup,x,warmth,y\n1,0,1,0\n1,1,1,0.5\n")
        goal = answer["goals"][0]
        self.assertEqual(goal["power_before"], 0.05)
        self.assertGreater(answer["count"], 0)
        self.assertTrue(answer["met"])
        self.assertEqual(self.planned(goals, "x = [0, 3]")["noise"], "declared")

    def test_says_what_cannot_be_split(self):
        hidden = self.planned('detect = "scale"\nsizes = { scale = 1 }', "x = 2", data="setup,x,warmth,y\n1,2,1,0\n")
        self.assertIn("no allowed reading shows scale: what is estimated", hidden["goals"][0]["remark"])
        answer = self.planned(SPLIT, "x = { from = 0, to = 3, step = 1 }\nwarmth = 1")
        self.assertFalse(answer["met"])
        self.assertEqual(answer["count"], 0)
        self.assertIn("no allowed reading separates scale from expansion", answer["goals"][0]["remark"])
        said = self.run_plan().stdout
        self.assertIn("equal at every allowed condition", said)
        self.assertIn("a thousand of each allowed reading meet no goal", said)

    def test_u_of_a_mean_is_the_closed_form(self):
        # Four readings of the constant, u = 1 each: sixteen give 0.25.
        goals = "uncertainties = { a = 0.25 }\nmost = 50"
        answer = self.planned(goals, "x = 0")
        self.assertEqual(answer["count"], 12)
        goal = answer["goals"][0]
        self.assertIn("count as one", answer["notes"][0])  # of equal labels and conditions
        self.assertIn("repeats told apart", self.run_plan().stdout)
        # Filled in and told apart, as the note says, they give the fit that u.
        planned = [line.split(",") for line in (self.folder / "plan.csv").read_text().splitlines()]
        rows = [",".join((*cells[:3], cells[3] or "0", cells[4])) for cells in planned]
        first = [line + ",0" for line in DATA.splitlines()[1:]]
        (self.folder / "d.csv").write_text("\n".join([rows[0], *first, *rows[1:]]) + "\n")
        self.file.write_text(TEXT.split("[stated_effects.scale]")[0].replace('setup = "setup" }', 'setup = "setup", repeat = "repeat" }'))
        fit = gumshoe("estimate", self.file, "--format", "json", "--scenario-out", self.folder / "fit.toml")
        self.assertEqual(fit.returncode, 0, fit.stderr)
        self.assertAlmostEqual(json.loads(fit.stdout)["parameters"]["a"]["standard_uncertainty"], 0.25, places=6)
        self.assertAlmostEqual(goal["u_before"], 0.5, places=6)
        self.assertAlmostEqual(goal["u_after"], 0.25, places=6)

    def test_what_a_thousand_of_each_reading_do_not_reach(self):
        """u falls with the root of their number, and no limit is near: 1 / sqrt(1000) with the four that are there."""
        answer = self.planned("uncertainties = { a = 0.001 }", "x = 0")
        self.assertIn(f"1000 of each allowed reading bring u of a to {1 / math.sqrt(1004):.3g}, which is not enough", answer["goals"][0]["remark"])

    SHARED = TEXT.replace("b = { value = 0 }", 'b = { value = 0, u = 0.5, per = "setup" }') \
                 .replace('"a + b * x"', '"a + b"')

    def test_a_new_set_up_has_a_draw_of_its_own(self):
        # u^2 of the mean: each set-up of n readings knows it by 0.25 + 1 / n. The one there is has four.
        readings = 'x = 0\nsetup = ["1", "2", "3", "4"]'
        answer = self.planned("uncertainties = { a = 0.4 }\nmost = 50", readings, text=self.SHARED)
        self.assertTrue(answer["met"])
        count = {"1": 4}
        for row in self.table():
            count[row["setup"]] = count.get(row["setup"], 0) + 1
        u = 1 / math.sqrt(sum(1 / (0.25 + 1 / n) for n in count.values()))
        self.assertAlmostEqual(answer["goals"][0]["u_after"], u, places=6)
        self.assertLessEqual(u, 0.4)
        # The fewest: by all divisions of the further readings among the set-ups.
        least = next(n for n in range(1, 40) for parts in itertools.product(range(n + 1), repeat=3)
                     if sum(parts) <= n and
                     1 / (0.25 + 1 / (4 + n - sum(parts))) + sum(1 / (0.25 + 1 / k) for k in parts if k) >= 1 / 0.16)
        self.assertEqual(answer["count"], least)
        alone = self.planned("uncertainties = { a = 0.4 }", 'x = 0\nsetup = "1"', text=self.SHARED)
        self.assertIn("no number of allowed readings brings u of a below 0.5", alone["goals"][0]["remark"])

    def test_cost_of_set_ups_changes_the_answer(self):
        readings = 'x = 0\nsetup = ["1", "2", "3", "4"]'
        goals = "uncertainties = { a = 0.45 }\nmost = 60"
        cheap = self.planned(goals, readings, text=self.SHARED)
        dear = self.planned(goals + "\nsetup_costs = { setup = 100 }", readings, text=self.SHARED)
        self.assertTrue(cheap["met"] and dear["met"])
        self.assertEqual(len(dear["opened"]), 1)
        self.assertLess(cheap["count"], dear["count"] + 1)
        self.assertEqual(dear["cost"], 100 + dear["count"])

    def test_cost_of_readings_changes_the_answer(self):
        points = "x,warmth,cost\n3,2,{}\n2,2,1\n0,2,1\n"
        text = TEXT.replace("[plan.readings]\nREADINGS\n", "").replace("GOALS", SPLIT + '\npoints = "points.csv"')
        (self.folder / "points.csv").write_text(points.format(1))
        even = self.planned("", text=text)
        (self.folder / "points.csv").write_text(points.format(50))
        dear = self.planned("", text=text)
        self.assertTrue(even["met"] and dear["met"])
        self.assertIn("x 3", [r["setting"].split(",")[0] for r in even["readings"]])
        self.assertNotIn("x 3", [r["setting"].split(",")[0] for r in dear["readings"]])
        self.assertGreater(dear["count"], even["count"])

    def test_a_d_optimal_line_lies_at_the_ends(self):
        text = TEXT.replace("b = { value = 0 }", "b = { estimated = true, value = 0 }")
        text = text[:text.index("[stated_effects")] + text[text.index("[plan]"):]
        text = text[:text.index("readings = {")] + text[text.index("components"):]  # nothing is read yet
        text = text.replace('name = "expression"', 'name = "expression"\nmethod = "virtual_experiment"')
        text = text.replace("[model.indications]", '[model.measurands]\na_is = "y - b * x"\n[model.indications]')
        answer = self.planned("most = 8", "x = { from = -1, to = 1, step = 0.25 }", text=text)
        self.assertTrue(answer["d_optimal"])
        self.assertEqual({r["setting"]: r["count"] for r in answer["readings"]}, {"x -1": 4, "x 1": 4})
        self.assertEqual([g["u_before"] for g in answer["goals"]], [None, None])
        for goal in answer["goals"]:
            self.assertAlmostEqual(goal["u_after"], 1 / math.sqrt(8), places=6)

    def test_budget_limits_and_says_so(self):
        answer = self.planned(SPLIT + "\nbudget = 1")
        self.assertFalse(answer["met"])
        self.assertEqual(answer["cost"], 1)
        self.assertIn("within the limits not every goal is met", self.run_plan().stdout)

    def test_the_table_has_the_columns_of_the_data(self):
        self.planned(SPLIT)
        rows = self.table()
        self.assertEqual(list(rows[0]), ["setup", "x", "warmth", "y", "repeat"])
        self.assertEqual({r["setup"] for r in rows}, {"1"})
        self.assertEqual({r["y"] for r in rows}, {""})
        run = gumshoe("plan", self.file, "--format", "csv", "--out", self.folder / "plan.csv")
        self.assertEqual(run.stdout, (self.folder / "plan.csv").read_text())
        (self.folder / "plan.csv").write_text("filled in\n")
        run = gumshoe("plan", self.file, "--out", self.folder / "plan.csv")
        self.assertIn("not overwritten", run.stderr)

    def test_the_same_on_any_number_of_threads(self):
        self.write(SPLIT)
        one, two = (self.run_plan("--format", "json", "--threads", n).stdout for n in (1, 2))
        self.assertEqual(one, two)

    def test_trace_finds_it_in_simulated_readings(self):
        strong = SPLIT.replace("alpha = 0.05", "alpha = 0.0001").replace("0.9", "0.99")
        self.write(strong)
        self.assertIn("--verify 200 counts", self.run_plan().stdout)
        run = self.run_plan("--verify", 4, "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertNotIn("--verify 200 counts", run.stdout)
        for row in json.loads(run.stdout)["verified"]:
            self.assertEqual(row["sets"], 4)
            self.assertGreaterEqual(row["found"], 3)

    def test_trace_proposes_the_plan(self):
        """What would split a class is asked of [plan] where there is one."""
        chance = np.random.default_rng(2)
        data = "setup,x,warmth,y\n" + "".join(f"{s},{x},1,{2 * x + chance.normal():.3f}\n"
                                              for s in range(1, 7) for x in range(4))
        text = TEXT.replace('"a + b * x"', '"a"').replace("b = { value = 0 }\n", "")
        text += '\n[trace]\nblocks = "setup"\ndraws = 199\n'
        readings = 'x = { from = 0, to = 3, step = 1 }\nwarmth = WARMTH\nsetup = "6"'
        for warmth in ("[1, 2]", "1"):
            self.write(SPLIT, readings.replace("WARMTH", warmth), text=text, data=data)
            run = gumshoe("trace", self.file, "--out", self.folder / "t.h5", "--format", "json", "--force")
            self.assertEqual(run.returncode, 0, run.stderr)
            finding = json.loads(run.stdout)["findings"][0]
            self.assertEqual(sorted(finding["members"]), ["expansion", "scale"])
            if warmth == "1":  # nothing allowed helps, and what is tried is no plan
                self.assertNotIn("further reading", finding["suggestion"])
            else:
                self.assertIn("take 1 further reading (cost 1)", finding["suggestion"])
                self.assertIn("warmth 2", finding["suggestion"])

    def refused(self, words, goals=SPLIT, readings="x = [0, 3]\nwarmth = [1, 2]", **named):
        self.write(goals, readings, **named)
        run = self.run_plan()
        self.assertEqual(run.returncode, 2, run.stdout)
        self.assertIsNone(complaint(run))
        self.assertIn(words, run.stderr)

    def test_bad_input(self):
        self.refused("plan.split: needs two effects or more", 'split = "scale"')
        self.refused("'scael' is no effect of expression. Did you mean 'scale'?", 'detect = "scael"')
        self.refused("plan.sizes.scale: the size is zero", 'detect = "scale"\nsizes = { scale = 0 }')
        self.refused("[plan]: no typical size of scale is known", 'detect = "scale"')
        self.refused("'c' is not a quantity here", "uncertainties = { c = 1 }")
        self.refused("no reading tells anything of b", "uncertainties = { b = 1 }")
        self.refused("needs a goal or a limit", "power = 0.8")
        self.refused("'xx' is neither a condition nor a label of the readings", readings="xx = [0, 3]")
        self.refused("x differs between the readings and is not listed", readings="warmth = [1, 2]")
        self.refused("plan.readings.x: the value is listed twice", readings="x = [0, 0]")
        self.refused("plan.readings.x: empty", readings="x = []")
        self.refused("does not lead from `from` to `to`", readings="x = { from = 0, to = 1, step = -1 }")
        self.refused("gives more than 2000 values", readings="x = { from = 0, to = 1, step = 1e-6 }")
        self.refused("combinations are allowed", readings="x = { from = 0, to = 1, step = 0.001 }\nwarmth = [1, 2, 3]")
        self.refused("moves no reading", 'detect = "scale"\nsizes = { scale = 1 }', "x = 0",
                     data=DATA.replace("1,1,1,", "1,0,1,").replace("1,2,1,", "1,0,1,").replace("1,3,1,", "1,0,1,"))

    def test_bad_points(self):
        text = TEXT.replace("[plan.readings]\nREADINGS\n", "").replace("GOALS", SPLIT + '\npoints = "points.csv"')
        for words, points in (("is no column of allowed readings", "x,warmth,colour\n1,1,1\n"),
                              ("the cost is not above 0", "x,warmth,cost\n1,1,0\n"),
                              ("0 readings are listed in", "x,warmth\n"), ("differs between the readings", "warmth\n1\n")):
            (self.folder / "points.csv").write_text(points)
            self.refused(words, text=text)
        self.refused("plan.points: must be the name of a CSV file", text=text.replace('"points.csv"', "3"))
        self.refused("readings and points are both given", SPLIT + '\npoints = "points.csv"')
        self.refused("no further readings are allowed", text=TEXT.replace("[plan.readings]\nREADINGS\n", ""))

    def test_unknown_noise(self):
        text = TEXT.replace('components = [{ distribution = "normal", u = 1, per = "reading" }]', "")
        self.refused("the noise of a reading is not known", text=text, data="setup,x,warmth,y\n1,0,1,0\n",
                     readings="x = [0, 3]\nwarmth = [1, 2]")

    def test_effects_of_several_sizes_are_named_by_one(self):
        text = (ROOT / "scenarios/plan_axis.toml").read_text().replace('"data/', f'"{ROOT}/scenarios/data/')
        text = text.replace('"axis_scale_drift"]', '"axis_drift"]').replace("axis_scale_drift =", "axis_drift =") \
                   .replace("um/m/h", "um/h")
        self.refused("axis_drift has several sizes", text=text)

    def test_existing_readings_without_a_value(self):
        text = """schema = 1
[model]
name = "tool_length"
[quantities]
wear_1 = { estimated = true, value = "0 mm" }
offset.by.setup = { 1 = "30 mm", 2 = "4 mm" }
[indications.spindle_z]
readings = { file = "d.csv", column = "z", unit = "mm", labels = { setup = "setup" } }
components = [{ distribution = "normal", u = "1 um", per = "reading" }]
[plan]
most = 2
[plan.readings]
setup = "2"
"""
        # The tool of set-up 1 never meets the beam.
        self.refused("the model cannot be linearised at its readings and those that are allowed", text=text,
                     data="setup,z\n1,100.0\n2,100.1\n")
        self.refused("the model has no value for any of the allowed readings",
                     text=text.replace('setup = "2"', 'setup = "1"'), data="setup,z\n1,100.0\n2,100.1\n")

    def test_a_model_without_simulation(self):
        (self.folder / "s.toml").write_text((ROOT / "scenarios/expression.toml").read_text() +
                                            "\n[plan]\nmost = 3\n[plan.readings]\n")
        run = gumshoe("plan", self.folder / "s.toml", "--out", self.folder / "plan.csv")
        self.assertEqual(run.returncode, 2)
        self.assertIn("[plan]: the model expression cannot simulate its indications", run.stderr)

    def test_no_plan(self):
        run = gumshoe("plan", ROOT / "scenarios/trace_load_cell.toml", "--out", self.folder / "plan.csv")
        self.assertIn("[plan] is missing", run.stderr)

    def test_the_table_says_what_the_data_file_has_no_column_for(self):
        run = gumshoe("plan", ROOT / "scenarios/plan_axis.toml", "--out", self.folder / "plan.csv")
        self.assertEqual(run.returncode, 0, run.stderr)
        with open(self.folder / "plan.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({r["temperature (degC)"] for r in rows}, {"20", "22"})


if __name__ == "__main__":
    unittest.main()
