"""Tables of compensation: read back by the rule of the control that reads them, they give the errors; applied to a held-out
cycle, they leave what the trace says.

usage: compensate_test.py path/to/gumshoe [unittest options]
"""
import csv
import io
import json
import math
import pathlib
import random
import re
import tempfile
import unittest

from program import gumshoe

AXIS = """schema = 1
[model]
name = "linear_axis"
[data]
file = "axis.csv"
labels = { cycle = "cycle" }
[data.units]
x_mm = "mm"
t_s = "s"
d_um = "um"
[data.conditions]
position = "x_mm"
direction = "way"
time = "t_s"
[quantities]
offset = { estimated = true, value = "0 um" }
gain = { estimated = true, value = "0 um/m" }
[indications.deviation]
readings = "d_um"
components = [ { distribution = "normal", u = "0.5 um", per = "reading" } ]
[trace]
blocks = "cycle"
final = ["3", "6"]
order = "time"
draws = 199
"""
TWO = """schema = 1
[model]
name = "expression"
[model.indications]
a = "start"
b = "start"
[conditions]
x = "5 mm"
[quantities]
start = "0 mm"
[indications.a]
rows = [ { values = ["0 mm"] } ]
[indications.b]
rows = [ { values = ["0 mm"] } ]
[stated_effects.bend]
indication = "a"
formula = "x"
unit = "um/m"
size = "2 um/m"
"""
STEPS = [50.0 * i for i in range(9)]


def error(x, way, reversal):
    """um: a screw that bends, and play that grows with the position"""
    return 6 * math.sin(x / 60) + 2 + 0.01 * x + reversal * way * (2 + x / 200)


def read_back(text, form):
    """[(position, error upwards, error downwards)] in mm and um, by the control's own rule."""
    if form == "csv":
        at = {}
        for row in csv.DictReader(line for line in io.StringIO(text) if not line.startswith("#")):
            assert float(row["error_um"]) == -float(row["correction_um"])
            for way in ("1", "-1") if row["direction"] == "0" else (row["direction"],):
                at.setdefault(float(row["position_mm"]), {})[way] = float(row["error_um"])
        return [(x, e["1"], e["-1"]) for x, e in sorted(at.items())]
    if form.startswith("linuxcnc"):  # three numbers a line, ascending; type 0: nominal - actual is the trim added to the command
        rows = [tuple(map(float, line.split())) for line in text.splitlines()]
        assert all(len(r) == 3 for r in rows) and sorted(rows) == rows and len(rows) <= 256
        trims = rows if form.endswith("trim") else [(x, x - up, x - down) for x, up, down in rows]
        return [(x, -1e3 * up, -1e3 * down) for x, up, down in trims]
    if form == "sinumerik-eec":  # the value is added to the actual position: a positive one moves the axis backwards
        values = {int(i): float(v) for i, v in re.findall(r"^\$AA_ENC_COMP\[0,(\d+),X1\]=(.+)$", text, re.M)}
        one = lambda name: float(re.search(rf"^\$AA_ENC_COMP_{name}\[0,X1\]=(.+)$", text, re.M)[1])
        assert text.startswith("%_N_X1_EEC_INI\nCHANDATA(1)\n") and text.endswith("M17\n")
        assert one("MAX") == one("MIN") + one("STEP") * (len(values) - 1) and values[0] == 0
        return [(one("MIN") + i * one("STEP"), 1e3 * v, 1e3 * v) for i, v in sorted(values.items())]
    if form == "sinumerik-cec":
        tables = {}
        for t in re.findall(r"^\$AN_CEC_DIRECTION\[(\d)\]", text, re.M):
            one = lambda name: re.search(rf"^\$AN_CEC_{name}\[{t}\]=(.+)$", text, re.M)[1]
            assert one("INPUT_AXIS") == one("OUTPUT_AXIS") == "(X1)"
            tables[int(one("DIRECTION"))] = (float(one("MIN")), float(one("STEP")), [float(v) for v in re.findall(rf"^\$AN_CEC\[{t},\d+\]=(.+)$", text, re.M)])
        low, step, up = tables[1]
        return [(low + i * step, 1e3 * u, 1e3 * d) for i, (u, d) in enumerate(zip(up, tables[-1][2], strict=True))]
    lines = [line for line in text.splitlines() if not line.startswith("//")]
    assert lines[0] == ("X\tEXX" if form == "isg" else "[EXX]"), lines[0]
    rows = [tuple(map(float, line.split())) for line in (lines[1:] if form == "isg" else lines[2:-1])]
    return [(x, 1e3 * e, 1e3 * e) for x, e in rows]


def at(table, x, way):
    """Linear between rows, the end values beyond."""
    one = 1 if way > 0 else 2
    if x <= table[0][0]:
        return table[0][one]
    for a, b in zip(table, table[1:]):
        if x <= b[0]:
            return a[one] + (x - a[0]) / (b[0] - a[0]) * (b[one] - a[one])
    return table[-1][one]


class Compensation(unittest.TestCase):
    reversal, noise = 1, 0.5

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        chance, rows, t = random.Random(11), ["cycle,x_mm,way,t_s,d_um"], 0
        cls.readings = []
        for cycle in range(1, 7):
            for way in (1, -1):
                for x in STEPS[::way]:
                    d = error(x, way, cls.reversal) + chance.gauss(0, cls.noise)
                    rows.append(f"{cycle},{x},{way},{t},{d:.6f}")
                    cls.readings.append((cycle, x, way, float(f"{d:.6f}")))
                    t += 20
        (cls.folder / "axis.csv").write_text("\n".join(rows) + "\n")
        (cls.folder / "s.toml").write_text(AXIS)
        run = gumshoe("trace", "s.toml", "--loop", "5", "--format", "json", "--out", "o.h5", cwd=cls.folder)
        assert run.returncode == 0, run.stderr
        cls.rounds = json.loads(run.stdout)["rounds"]

    def test_a_wave_that_is_shorter_than_the_table_is_told(self):
        """Of 10 mm at every 13.7 mm, or at every 10 mm, where all readings are alike: straight lines between them are wrong.
        A bow is another thing. With the step that the warning names, the table is the formula to a tenth of the wave."""
        text = """schema = 1
[model]
name = "expression"
[model.indications]
deviation = "offset"
[data]
file = "m.csv"
units = { x = "mm", d = "um" }
[data.conditions]
position = "x"
[quantities]
offset = { estimated = true, value = "0 um" }
[indications.deviation]
readings = "d"
[stated_effects.wave]
indication = "deviation"
formula = "%s"
unit = "%s"
size = { value = "%s", u = "%s" }
"""
        screw = ("sin(0.6283185307179586 * position / one)", "um", "1.2 um", "0.05 um")
        bow = ("position * position", "um/mm2", "1e-4 um/mm2", "1e-5 um/mm2")
        for form, distance, warned in ((screw, 13.7, True), (screw, 10, True), (bow, 13.7, False)):
            shift = 2.5 if distance == 10 else 0
            rows = "".join(f"{shift + distance * i:.1f},0\n" for i in range(12))
            (self.folder / "m.csv").write_text("x,d\n" + rows)
            (self.folder / "w.toml").write_text(text % form + ('[conditions]\none = "1 mm"\n' if form is screw else ""))
            run = gumshoe("compensate", "w.toml", cwd=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            said = re.search(r'straight lines miss (\S+) um of it: .* and --step "(\S+ mm)"', run.stderr)
            self.assertEqual(said is not None, warned, run.stderr)
            if not warned:
                continue
            if distance == 10:  # the lines are level at the crest: the mean of (1 - sin)^2 is 1.5, in three digits
                self.assertAlmostEqual(float(said[1]), 1.2 * math.sqrt(1.5), delta=0.006)
            fine = gumshoe("compensate", "w.toml", "--format", "linuxcnc", "--step", said[2], "--resolution", "1 nm", cwd=self.folder)
            self.assertNotIn("straight lines", fine.stderr)
            table = read_back(fine.stdout, "linuxcnc")
            wave = lambda x: 1.2 * math.sin(2 * math.pi * x / 10)
            for x, up, down in table[:-1]:
                self.assertAlmostEqual(up, wave(x), delta=2e-3)  # rounding of a position, and of a value
            rest = [at(table, 0.01 * i, 1) - wave(0.01 * i) for i in range(250, int(100 * table[-2][0]))]
            self.assertLess(math.sqrt(sum(r * r for r in rest) / len(rest)), 0.1 * 1.2 / math.sqrt(2))

    def compensate(self, *words):
        return gumshoe("compensate", "s.traced.toml", *words, cwd=self.folder)

    def table(self, form, *words):
        run = self.compensate("--format", form, *self.axis(form), *words)
        self.assertEqual(run.returncode, 0, run.stderr)
        return read_back(run.stdout, form)

    def axis(self, form):
        return () if form == "csv" or form.startswith("linuxcnc") else ("--axis", "X1" if form.startswith("sinumerik") else "X")

    def left(self, table, cycles=(3, 6)):
        """Root mean square of readings less the table, um; by default of those held out."""
        rest = [d - at(table, x, way) for cycle, x, way, d in self.readings if cycle in cycles]
        return math.sqrt(sum(r * r for r in rest) / len(rest))


class BothDirections(Compensation):
    def test_a_held_out_cycle_keeps_what_the_trace_says(self):
        """Entries are rounded to 1 nm: so much may the root mean square differ."""
        said = self.rounds[-1]["holdout_after"] * 1e6
        self.assertGreater(self.rounds[0]["holdout_before"] * 1e6, 3)
        for form in ("csv", "linuxcnc", "linuxcnc-trim"):
            fine = () if form == "csv" else ("--resolution", "1 nm")
            table = self.table(form, "--with", "gain", "--with", "offset", *fine)
            self.assertAlmostEqual(self.left(table), said, delta=2e-3, msg=form)

    def test_what_the_table_leaves_is_said(self):
        """Of all readings and of those held out, to the three digits that are written."""
        run = self.compensate("--with", "gain", "--with", "offset", "--format", "linuxcnc", "--resolution", "1 nm")
        table = read_back(run.stdout, "linuxcnc")
        for which, cycles in (("these readings", range(1, 7)), (r"held-out readings \(cycle 3, 6\)", (3, 6))):
            before, after = map(float, re.search(rf"root mean square of {which}: (\S+) um, with the table (\S+) um\n", run.stderr).groups())
            self.assertAlmostEqual(after, self.left(table, cycles), delta=6e-3)  # and 1 nm of an entry
            self.assertAlmostEqual(before, self.left([(0, 0, 0)], cycles), delta=6e-3)
        self.assertAlmostEqual(after, self.rounds[-1]["holdout_after"] * 1e6, delta=6e-3)
        # Without the quantities of the set-up the table has less to hold, and they are no error of the axis that is left.
        less = re.search(r"these readings, less [a-z_ ]+: (\S+) um, with the table (\S+) um\n", self.compensate().stderr).groups()
        self.assertLess(float(less[0]), 0.9 * before)

    def test_every_format_has_the_same_errors(self):
        """To half a step of rounding, 0.05 um; encoder and volumetric tables hold the mean, zero at the first position."""
        known = self.table("csv")
        mean = lambda rows: [(x, (up + down) / 2, (up + down) / 2) for x, up, down in rows]
        zeroed = lambda rows, by: [(x, up - by, down - by) for x, up, down in rows]
        first = mean(known)[0][1]
        for form, expected in (("linuxcnc", known), ("linuxcnc-trim", known), ("isg", mean(known)), ("etalon", mean(known)),
                               ("sinumerik-eec", zeroed(mean(known), first)), ("sinumerik-cec", zeroed(known, first))):
            for row, right in zip(self.table(form), expected, strict=True):
                for a, b in zip(row, right):
                    self.assertAlmostEqual(a, b, delta=0.0501, msg=(form, row, right))

    def test_u_covers_what_was_made(self):
        """Less what a straight line takes, which is the set-up's; 18 entries within 3.5 u."""
        run = self.compensate("--with", "gain", "--with", "offset")
        rows = list(csv.DictReader(line for line in io.StringIO(run.stdout) if not line.startswith("#")))
        self.assertEqual(len(rows), 18)
        for r in rows:
            u = float(r["u_um"])
            self.assertGreater(u, 0.5 / math.sqrt(8) / 2)  # four training cycles, and what gain and offset share
            self.assertAlmostEqual(float(r["error_um"]), error(float(r["position_mm"]), int(r["direction"]), 1), delta=3.5 * u)

    def test_steps_are_linear_between_positions(self):
        known, fine = self.table("csv"), self.table("linuxcnc", "--step", "25 mm")
        self.assertEqual(len(fine), 17)
        for x, up, down in fine:
            self.assertAlmostEqual(up, at(known, x, 1), delta=0.0501)
            self.assertAlmostEqual(down, at(known, x, -1), delta=0.0501)

    def test_what_is_asked_for_wrongly_is_said(self):
        for words, said in ((("--position", "place"), "'place' is not a condition"),
                            (("--indication", "z"), "'z' is not an indication"),
                            (("--with", "slope"), "'slope' is not a quantity of the model"),
                            (("--format", "linuxcnc", "--step", "1 mm"), "LinuxCNC reads 256). Use a longer --step"),
                            (("--format", "linuxcnc", "--step", "900 mm"), "longer than the travel"),
                            (("--step", "5 kg", "--format", "isg"), "kg"),
                            (("--format", "linuxcnc", "--axis", "X"), "--axis says nothing to the format linuxcnc (it knows --step, --resolution)"),
                            (("--format", "sinumerik-eec", "--negate"), "--negate says nothing to the format sinumerik-eec"),
                            (("--format", "isg", "--reference", "0 mm"), "--reference says nothing to the format isg"),
                            (("--step", "25 mm"), "--step says nothing to the format csv (its table is written as measured)")):
            run = self.compensate(*words)
            self.assertEqual(run.returncode, 2, (words, run.stdout))
            self.assertIn(said, run.stderr)
        (self.folder / "t.csv").write_text("something else\n")
        run = self.compensate("--out", "t.csv")
        self.assertEqual((run.returncode, "not overwritten" in run.stderr), (2, True), run.stderr)
        self.assertEqual(self.compensate("--out", "t.csv", "--force").returncode, 0)

    def test_what_the_readings_do_not_hold_is_said(self):
        """Positions at unequal distances, one position, one direction at some; several indications, no position at all."""
        text = (self.folder / "s.traced.toml").read_text()
        whole = (self.folder / "axis.csv").read_text().splitlines()
        def of(rows, form):
            (self.folder / "part.csv").write_text("\n".join(whole[:1] + rows) + "\n")
            (self.folder / "part.toml").write_text(text.replace("axis.csv", "part.csv"))
            return gumshoe("compensate", "part.toml", "--format", form, cwd=self.folder).stderr
        cells = [line.split(",") for line in whole[1:]]
        self.assertIn("the positions are not equidistant", of([",".join(c) for c in cells if c[1] != "100.0"], "sinumerik-eec"))
        self.assertIn("nothing was measured downwards", of([",".join(c) for c in cells if (c[1], c[2]) != ("100.0", "-1")], "linuxcnc"))
        self.assertIn("several values", of([",".join(c) for c in cells if c[1] == "100.0"], "isg"))
        (self.folder / "two.toml").write_text(TWO)
        self.assertIn("there are several indications", gumshoe("compensate", "two.toml", cwd=self.folder).stderr)
        one = gumshoe("compensate", "two.toml", "--indication", "a", "--position", "x", "--format", "isg", cwd=self.folder).stderr
        self.assertIn("a single position", one)

    def test_nothing_found_is_nothing_to_compensate(self):
        run = gumshoe("compensate", "s.toml", cwd=self.folder)
        self.assertEqual(run.returncode, 2)
        self.assertIn("nothing to compensate", run.stderr)

    def test_unconfirmed_effects_are_left_out_unless_asked_for(self):
        text = (self.folder / "s.traced.toml").read_text()
        names = sorted(set(re.findall(r"^\[stated_effects\.(\w+)\]", text, re.M)) | set(re.findall(r"^\[effects\.(\w+)\]", text, re.M)))
        (self.folder / "u.toml").write_text(text.replace("[trace]\n", "[trace]\nunconfirmed = " + json.dumps(names) + "\n"))
        run = gumshoe("compensate", "u.toml", cwd=self.folder)
        self.assertEqual(run.returncode, 2)
        self.assertIn("could neither be confirmed nor rejected", run.stderr)
        (self.folder / "x.toml").write_text(text.replace("[trace]\n", '[trace]\nunconfirmed = ["shape_9"]\n'))
        self.assertIn("'shape_9' is no effect with a size", gumshoe("check", "x.toml", cwd=self.folder).stderr)
        run = gumshoe("compensate", "u.toml", "--unconfirmed", cwd=self.folder)
        self.assertEqual(run.stdout, self.compensate().stdout, run.stderr)

    def test_the_sign_is_to_be_proved(self):
        self.assertIn("prove the sign on the machine", self.compensate("--format", "isg").stderr)
        plain, negated = self.table("isg"), self.table("isg", "--negate")
        for a, b in zip(plain, negated, strict=True):
            self.assertEqual(a[1], -b[1])
        said = self.compensate("--format", "isg", "--negate").stderr
        self.assertIn("must move 0.010 in the positive direction there; else leave out --negate", said)

    def test_an_effect_is_left_out_by_the_name_that_is_told(self):
        holds = re.search(r"^holds: (.*)$", self.compensate().stderr, re.M)[1]
        names = [one.split(" (")[0] for one in holds.split(", ")]
        for name in names:
            run = self.compensate("--without", name)
            self.assertNotIn(name, re.findall(r"^holds: (.*)$", run.stderr, re.M), run.stderr)
            self.assertNotEqual(run.stdout, self.compensate().stdout)
        run = self.compensate("--without", "nothing_of_the_kind")
        self.assertEqual(run.returncode, 2)
        self.assertIn(f"'nothing_of_the_kind' is not an effect that is compensated. Use one of {', '.join(sorted(names))}", run.stderr)


class OneTable(Compensation):
    """Without play one row serves both directions."""
    reversal = 0

    def test_the_directions_are_one(self):
        run = self.compensate()
        rows = list(csv.DictReader(line for line in io.StringIO(run.stdout) if not line.startswith("#")))
        self.assertEqual([r["direction"] for r in rows], ["0"] * 9)

    def test_the_encoder_table_leaves_what_the_trace_says(self):
        """It is zero at the reference: the constant is the set-up's."""
        table = self.table("sinumerik-eec", "--with", "gain", "--with", "offset", "--resolution", "1 nm")
        whole = self.table("csv", "--with", "gain", "--with", "offset")
        shifted = [(x, up + whole[0][1], down + whole[0][1]) for x, up, down in table]
        self.assertAlmostEqual(self.left(shifted), self.rounds[-1]["holdout_after"] * 1e6, delta=2e-3)


if __name__ == "__main__":
    unittest.main()
