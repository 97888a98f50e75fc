"""The shipped JSON Schema is the program's; it accepts the shipped scenarios, refuses what the program refuses, and has
the keys that the program reads.

usage: schema_test.py [path of gumshoe] [unittest options]
"""
import copy
import json
import pathlib
import subprocess
import tempfile
import tomllib
import unittest

import jsonschema

from every_key import EVERY_KEY
from program import GUMSHOE, ROOT

FOLDER = ROOT / "scenarios"


def load(path):
    with open(path, "rb") as file:
        return plain(tomllib.load(file))


def plain(document):
    return json.loads(json.dumps(document, default=str))


def shipped():
    return sorted([*FOLDER.glob("*.toml"), *FOLDER.glob("plugin/*.toml"), *FOLDER.glob("command/*.toml"),
                   *FOLDER.glob("gauge/*.toml")])


def stated_keys(schema, place="#"):
    """(place, key) of every key that the schema lists."""
    for key, value in schema.get("properties", {}).items():
        yield place, key
        yield from stated_keys(value, f"{place}/{key}")
    for word in ("items", "additionalProperties"):
        if isinstance(schema.get(word), dict):
            yield from stated_keys(schema[word], f"{place}/{word}")
    for number, value in enumerate(schema.get("anyOf", [])):
        yield from stated_keys(value, f"{place}/{number}")


def used_keys(root, schema, value, place="#"):
    """The same, of those that stand in a document."""
    if "$ref" in schema:
        name = schema["$ref"].rsplit("/", 1)[1]
        yield from used_keys(root, root["definitions"][name], value, f"#/definitions/{name}")
    for part in schema.get("allOf", []):
        yield from used_keys(root, part, value, place)
    for number, part in enumerate(schema.get("anyOf", [])):
        if jsonschema.Draft7Validator(part | {"definitions": root["definitions"]}).is_valid(value):
            yield from used_keys(root, part, value, f"{place}/{number}")
    for item in value if isinstance(value, list) and "items" in schema else []:
        yield from used_keys(root, schema["items"], item, f"{place}/items")
    for key, item in value.items() if isinstance(value, dict) else []:
        if key in schema.get("properties", {}):
            yield place, key
            yield from used_keys(root, schema["properties"][key], item, f"{place}/{key}")
        elif isinstance(schema.get("additionalProperties"), dict):
            yield from used_keys(root, schema["additionalProperties"], item, f"{place}/additionalProperties")


class Schema(unittest.TestCase):
    def setUp(self):
        self.schema = json.loads((FOLDER / "scenario.schema.json").read_text())
        jsonschema.Draft7Validator.check_schema(self.schema)
        self.validator = jsonschema.Draft7Validator(self.schema)

    def test_shipped_scenarios_are_accepted(self):
        files = shipped()
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

    def test_the_bounds_are_those_of_the_program(self):
        """Of what is refused by the number alone, and of the bound itself."""
        normal, gamma = {"value": 1, "u": 1}, {"distribution": "gamma", "shape": 2, "scale": 1}
        cases = [(normal | {"degrees_of_freedom": n}, fine) for n, fine in ((0.25, True), (0.2, False), (0, False), (1e12, True))]
        cases += [(normal | {"distribution": "t", "degrees_of_freedom": n}, fine) for n, fine in ((0.25, True), (0.2, False))]
        cases += [(gamma | {"shape": n}, fine) for n, fine in ((1e9, True), (1.1e9, False), (1e-3, True), (0, False))]
        cases += [(gamma | {"scale": n}, fine) for n, fine in ((1e-3, True), (0, False), (-1, False))]
        cases += [({"distribution": "exponential", "mean": n}, fine) for n, fine in ((1e-3, True), (0, False), (-1, False))]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "s.toml"
            for quantity, fine in cases:
                with self.subTest(quantity):
                    document = {"schema": 1, "model": {"name": "expression", "measurands": {"y": "x"}}, "quantities": {"x": quantity}}
                    self.assertEqual(self.validator.is_valid(document), fine)
                    if GUMSHOE:
                        file.write_text('schema = 1\n[model]\nname = "expression"\nmeasurands = { y = "x" }\n[quantities.x]\n' +
                                        "".join(f"{key} = {json.dumps(value)}\n" for key, value in quantity.items()))
                        self.assertEqual(self.program("check", file).returncode, 0 if fine else 2)

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

    def test_names_of_a_described_machine_are_accepted(self):
        # A machine of one's own renames quantities and conditions: an editor must not flag them.
        own = {"workpiece_side": ["A", "C"], "tool_side": ["X", "Y", "Z"]}
        for model in ("laser_scan", "laser_ball_bar"):
            renamed = {"schema": 1, "model": {"name": model}, "conditions": {"A": "5 deg"}, "quantities": {"E_Y0A": "5 um"}}
            with self.subTest(model):
                self.assertTrue(self.validator.is_valid(renamed | {"machine": own}))
                self.assertFalse(self.validator.is_valid(renamed))
                self.assertFalse(self.validator.is_valid(renamed | {"machine": own, "effects": {"rod_expansion": {}}}))
                self.assertFalse(self.validator.is_valid(renamed | {"machine": own, "model": {"name": model, "evaluation": "none"}}))

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
    def test_shipped_schema_is_the_programs(self):
        self.assertEqual(self.program("schema").stdout, (FOLDER / "scenario.schema.json").read_text(),
                         "stale: scripts/update-generated")

    @unittest.skipUnless(GUMSHOE, "needs the program")
    def test_names_are_those_of_the_cards(self):
        properties = self.schema["properties"]
        effects = {e["name"]: {q["name"] for q in e["quantities"]}
                   for e in json.loads(self.program("effects", "--format", "json").stdout)}
        self.assertEqual({name: set(e["properties"]) for name, e in properties["effects"]["properties"].items()}, effects)
        for model in json.loads(self.program("models", "--format", "json").stdout):
            for section in ("conditions", "indications", "quantities"):
                names = {card["name"] for card in model[section]}
                self.assertLessEqual(names, set(properties[section]["properties"]), model["name"])
                for name, fine in ((min(names), True), (min(names) + "_x", False)):
                    value = {} if section == "indications" else "1 mm"
                    document = {"schema": 1, "model": {"name": model["name"]}, section: {name: value}}
                    self.assertEqual(self.validator.is_valid(document), fine, document)

    @unittest.skipUnless(GUMSHOE, "needs the program")
    def test_program_reads_every_key(self):
        """Each key of the schema stands in a scenario that the program accepts."""
        seen = set()
        for file in shipped():
            seen.update(used_keys(self.schema, self.schema, load(file)))
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "log.txt").write_text("P 1 V 2\nP 2 V 4\n")
            (pathlib.Path(folder) / "form.toml").write_text('[[lines]]\npattern = "P {p} V {v}"\nrow = true\n')
            (pathlib.Path(folder) / "values.csv").write_text("r,w,c,v\n5,a,10:00,1\n6,b,10:01,2\n9,a,10:02,3\n")
            (pathlib.Path(folder) / "points.csv").write_text("x,cost\n0,1\n1,2\n")
            (pathlib.Path(folder) / "model.py").write_text(
                "import sys\nprint('y')\nfor row in sys.stdin.read().splitlines()[1:]: print(row)\n")
            (pathlib.Path(folder) / "earlier.toml").write_text(
                'schema = 1\n[model]\nname = "expression"\nmeasurands = { y = "x" }\n[quantities]\n'
                'x = { value = "1 um", u = "1 um" }\n')
            self.assertEqual(self.program("run", pathlib.Path(folder) / "earlier.toml", "--samples", 100, "--out",
                                          pathlib.Path(folder) / "earlier.h5").returncode, 0)
            for name, text in EVERY_KEY.items():
                with self.subTest(name):
                    document = plain(tomllib.loads(text))
                    self.assertEqual([e.message for e in self.validator.iter_errors(document)], [])
                    seen.update(used_keys(self.schema, self.schema, document))
                    file = pathlib.Path(folder) / f"{name}.toml"
                    file.write_text(text)
                    run = self.program("check", file)
                    self.assertEqual(run.returncode, 0, run.stderr)
        by_cards = ("#/effects", "#/quantities", "#/conditions", "#/indications")
        lacking = {(place, key) for place, key in self.stated() if not place.startswith(by_cards)} - seen
        self.assertEqual(sorted(lacking), [])

    def stated(self):
        yield from stated_keys(self.schema)
        for name, schema in self.schema["definitions"].items():
            yield from stated_keys(schema, f"#/definitions/{name}")

    def program(self, *words):
        return subprocess.run([GUMSHOE, *map(str, words)], capture_output=True, text=True)

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

    @unittest.skipUnless(GUMSHOE, "needs the program")
    def test_program_says_where_a_key_belongs(self):
        head = 'schema = 1\n[model]\nname = "expression"\n[model.measurands]\ny = "a"\n[quantities]\na = { value = "1 mm", u = "1 um" }\n'
        for text, said in (
                ("[[conformity]]\nmeasurand = \"y\"\n", "unknown key 'conformity' (it belongs to [analysis]). Write [[analysis.conformity]]."),
                ("[conformity]\nmeasurand = \"y\"\n", "unknown key 'conformity' (it belongs to [analysis]). Write [analysis.conformity]."),
                ("[quantity.b]\nvalue = \"1 mm\"\n", "unknown key 'quantity'. Did you mean 'quantities'?"),
                ("[analysis.conformity]\nmeasurand = \"y\"\n", "expected an array, found a table. Write [[analysis.conformity]] in place of [analysis.conformity], or conformity = [ { ... } ].")):
            with self.subTest(text), tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder) / "s.toml"
                file.write_text(head + text)
                run = subprocess.run([GUMSHOE, "check", str(file)], capture_output=True, text=True)
                self.assertEqual(run.returncode, 2)
                self.assertIn(said, run.stderr)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "s.toml"
            file.write_text("samples = 100\n" + head)
            run = subprocess.run([GUMSHOE, "check", str(file)], capture_output=True, text=True)
            self.assertIn("it belongs to [run]", run.stderr)


if __name__ == "__main__":
    unittest.main()
