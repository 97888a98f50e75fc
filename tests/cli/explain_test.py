"""`gumshoe check --explain`: what a run would ask, with every default.

usage: explain_test.py path/to/gumshoe [unittest options]
"""
import unittest

from program import InFolder, gumshoe


class Explain(InFolder):
    def test_explain_prints_decision_rules_and_costs(self):
        text = '''schema = 1
[model]
name = "expression"
[model.measurands]
y = "x + 0"
[quantities.x]
value = "10 mm"
u = "3 um"
[[analysis.conformity]]
measurand = "y"
upper = "10.01 mm"
guard_factor = 0.5
process = { value = "10 mm", u = "4 um" }
[[analysis.conformity]]
measurand = "y"
upper = "10.01 mm"
rule = "ilac_g8"
[[analysis.targets]]
measurand = "y"
U = "5 um"
costs = { x = 3 }
'''
        (self.folder / "s.toml").write_text(text)
        run = gumshoe("check", "--explain", self.folder / "s.toml")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("conformity of y, SI limits [none, 0.01001], guard band 0.5 U, process 0.01 m (10 mm) + normal (mean 0 m, u 4e-06 m)",
                      run.stdout)
        self.assertIn("conformity of y, SI limits [none, 0.01001], rule ilac_g8\n", run.stdout)
        self.assertIn("target: U of y at most 5e-06 SI, cost of x 3\n", run.stdout)


if __name__ == "__main__":
    unittest.main()
