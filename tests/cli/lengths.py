"""Results of a length by difference from a calibrated reference, for commands that take several results."""
from program import InOneFolder, complaint, gumshoe

K = 1.959963984540054  # of 95 % and a normal distribution: the model is linear, its inputs are normal

SCENARIO = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "{formula}"
[quantities.reading]
value = "{reading} mm"
u = "{u_reading} um"
[quantities.reference]
value = "100 mm"
u = "4 um"
source = "certificate 12"
[run]
samples = {samples}
seed = {seed}
[analysis]
coverage_probability = {p}
validation_digits = 1
"""


class Lengths(InOneFolder):
    COMMAND, SAMPLES = "", 100_000

    @classmethod
    def result(cls, name, formula="reading - reference", reading=10.000, u_reading=3, seed=1, p=0.95, change=str):
        """The result file of the scenario, which `change` may edit."""
        scenario = cls.folder / f"{name}.toml"
        scenario.write_text(change(SCENARIO.format(formula=formula, reading=reading, u_reading=u_reading, seed=seed, p=p,
                                                   samples=cls.SAMPLES)))
        out = cls.folder / f"{name}.h5"
        run = gumshoe("run", scenario, "--out", out)
        assert run.returncode == 0, run.stderr
        return out

    def refused(self, words, *given):
        run = gumshoe(self.COMMAND, *given)
        self.assertIsNone(complaint(run))
        self.assertIn(words, run.stderr)
