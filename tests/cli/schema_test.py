"""The shipped JSON Schema accepts the shipped scenarios and refuses what the program refuses.

usage: schema_test.py [path of gumshoe] [unittest options]
"""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

import jsonschema

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "scenarios"
GUMSHOE = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else None


def load(path):
    with open(path, "rb") as file:
        return json.loads(json.dumps(tomllib.load(file), default=str))


class Schema(unittest.TestCase):
    def setUp(self):
        schema = json.loads((FOLDER / "scenario.schema.json").read_text())
        jsonschema.Draft7Validator.check_schema(schema)
        self.validator = jsonschema.Draft7Validator(schema)

    def test_shipped_scenarios_are_accepted(self):
        files = sorted([*FOLDER.glob("*.toml"), *FOLDER.glob("plugin/*.toml"), *FOLDER.glob("command/*.toml"),
                        *FOLDER.glob("gauge/*.toml")])
        self.assertGreaterEqual(len(files), 2)
        for file in files:
            with self.subTest(file.name):
                errors = [f"{list(e.path)}: {e.message}" for e in self.validator.iter_errors(load(file))]
                self.assertEqual(errors, [])
                self.assertTrue(file.read_text().startswith("# Question:"))

    def test_mistakes_are_refused(self):
        good = load(FOLDER / "rod_gauging.toml")

        def broken(change):
            document = copy.deepcopy(good)
            change(document)
            return document

        mistakes = {
            "misspelt key": lambda d: d["quantities"]["rod_radius"].update(valeu="5 mm"),
            "misspelt section": lambda d: d.update(quantites={}),
            "wrong schema": lambda d: d.update(schema=2),
            "no model": lambda d: d.pop("model"),
            "unknown method": lambda d: d["model"].update(method="guess"),
            "unknown distribution": lambda d: d["quantities"]["beam_radius"].update(distribution="rectangle"),
            "U without k": lambda d: d["quantities"]["rod_length"].pop("k"),
            "negative u": lambda d: d["quantities"]["rod_radius"].update(u="-1 um"),
            "text for a number": lambda d: d["run"].update(samples="many"),
            "value without a number": lambda d: d["quantities"].update(rod_radius="five mm"),
            "coverage of 1": lambda d: d["analysis"].update(coverage_probability=1),
            "label that is no text": lambda d: d["indications"]["spindle_z"]["readings"].update(where={"setup": 1}),
            "quantity unknown to an effect": lambda d: d["effects"]["reclamp"].update(shfit="1 um"),
            "correlation without a kind": lambda d: d.update(
                correlations=[{"quantities": ["rod_radius", "rod_length"], "coefficient": 0.5}]
            ),
        }
        for name, change in mistakes.items():
            with self.subTest(name):
                self.assertFalse(self.validator.is_valid(broken(change)))

    def test_mistakes_of_a_machine_are_refused(self):
        good = load(FOLDER / "machine_five_axis.toml")
        own = {"workpiece_side": ["X", {"axis": "B", "point": ["0 mm", "0 mm", "-400 mm"]}], "tool_side": ["Z", "Y"]}
        for machine, fine in (
                (own, True), (own | {"name": "own"}, True), (own | {"errors": {"E_A0B": "0.01 deg"}}, True), ({}, False),
                ({"tool_side": ["X"]}, False), (own | {"tool_side": ["Q"]}, False), (own | {"tool_sied": []}, False),
                (own | {"errors": {"A0B": "0.01 deg"}}, False), (own | {"tool_side": [{"kind": "linear"}]}, False),
                (own | {"tool_side": [{"axis": "X", "sense": 0}]}, False),
                (own | {"tool_side": [{"axis": "X", "point": ["1 mm"]}]}, False)):
            with self.subTest(machine):
                self.assertEqual(self.validator.is_valid(good | {"machine": machine}), fine)

    def test_mistakes_of_tracing_are_refused(self):
        good = load(FOLDER / "rod_gauging.toml")
        film = {"formula": "1 / feed", "unit": "um*mm/min"}
        for trace, effect, fine in (
                ({"blocks": "setup", "final": ["1"], "redone": [["rod", "setup"]], "columns": {"T": {"column": "T"}}}, film, True),
                ({"redone": []}, film, True), ({"redone": [[]]}, film, False),
                ({}, film | {"size": {"value": "1 um*mm/min", "u": "1 um*mm/min"}}, True), ({"final": ["1"]}, film, False),
                ({"draws": 98}, film, False), ({"alpha": 1}, film, False), ({"blocks": "setup", "final": [7]}, film, False),
                ({"columns": {"T": {"unit": "degC"}}}, film, False), ({"colums": {}}, film, False),
                ({}, {"formula": "1"}, False), ({}, film | {"amount": "1 um"}, False)):
            with self.subTest((trace, effect)):
                self.assertEqual(self.validator.is_valid(good | {"trace": trace, "stated_effects": {"film": effect}}), fine)

    @unittest.skipUnless(GUMSHOE, "needs the program")
    def test_program_accepts_the_shipped_scenarios(self):
        for file in sorted(FOLDER.glob("*.toml")):
            with self.subTest(file.name):
                run = subprocess.run([GUMSHOE, "check", str(file)], capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, run.stderr)

    @unittest.skipUnless(GUMSHOE, "needs the program")
    def test_program_refuses_a_misspelt_key_with_its_place(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "s.toml"
            file.write_text('schema = 1\n[model]\nname = "rod_gauging"\nmehtod = "propagation"\n')
            run = subprocess.run([GUMSHOE, "check", str(file)], capture_output=True, text=True)
            self.assertEqual(run.returncode, 2)
            self.assertIn(f"{file}:4:1: error: model: unknown key 'mehtod'. Did you mean 'method'?", run.stderr)


if __name__ == "__main__":
    unittest.main()
