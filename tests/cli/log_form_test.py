"""Logs of controls that are no tables, read by the shipped descriptions; the samples are made up.

usage: log_form_test.py path/to/gumshoe [unittest options]
"""
import re
import unittest

from program import ROOT, InFolder, complaint, gumshoe

FORMS = ROOT / "scenarios" / "forms"
SAMPLES = {
    "siemens_protocol": ("RNo;Set;Act;UL;LL;Diff\n1;25.000;25.012;0.020;-0.020;0.012\n2;40.000; 40.031#;0.020;-0.020;0.031#\n",
                         "actual", {"at": "number", "set": "set"}, [(1, 25, 25.012), (2, 40, 40.031)]),
    "heidenhain_q": ("; made up\nDate: 03-02-2026\nType of dimension (0 = MM / 1 = INCH): 0\n"
                     "Q115 = 10.0012 Q116 = -3.0000 Q117 = +1.5 Q153 = 25.0042\r\nQ115 = 10.0013   Q116 = -3.0000 Q117 = 1.5 Q153 = 25.0040\n",
                     "diameter", {"at": "x", "set": "y"}, [(10.0012, -3, 25.0042), (10.0013, -3, 25.004)]),
    "fanuc_dprnt": ("%\r\nX  10.0012 Y  -3. Z  .4187\r\nX  10.0008 Y -3.0000 Z-.4185\r\n%\r\n", "z", {"at": "x", "set": "y"},
                    [(10.0012, -3, 0.4187), (10.0008, -3, -0.4185)]),
    "renishaw_printout": ("-----------------\nCOMPONENT NO 1 FEATURE NO 2\nSIZE D25.0000  ACTUAL 25.0031  TOL 0.0100  DEV 0.0031\n"
                          "POSN X10.0000  ACTUAL 9.9984  DEV -0.0016\nCOMPONENT NO 1 FEATURE NO 3\n"
                          "SIZE D40.0000  ACTUAL 40.0150  TOL 0.0100  DEV 0.0150\n+++++OUT OF TOL+++++ ERROR 0.0050\n",
                          "deviation", {"at": "feature", "set": "actual"}, [(2, 25.0031, 0.0031), (3, 40.015, 0.015)]),
    "fusion_inspection": ("START\nTIMESTAMP 260203 100000\nG800 N1 X10.0 Y0. Z-2. I0. J0. K1. O0. U0.02 L0.02\nG801 N1 X10.0 Y0. Z1.0012 R3.0\n"
                          "G802 N1 DEVIATION 0.0012\nG800 N2 X20.0 Y0. Z-2. I0. J0. K1. O0. U0.02 L0.02\nG801 N2 X20.0 Y.5 Z1.0008 R3.0\nEND\n",
                          "z", {"at": "point", "set": "nominal_x"}, [(1, 10, 1.0012), (2, 20, 1.0008)]),
    "linuxcnc_probe": ("10.001250 -3.000000 -1.998750 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000\n"
                       "10.000625 -3.000000 -1.998750 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000\n",
                       "z", {"at": "x", "set": "y"}, [(10.00125, -3, -1.99875), (10.000625, -3, -1.99875)]),
    "ecmc_table": ("# raw error\n1000 0\n2000 -12\n3000\t-7\n", "value", {"at": "index", "set": "index"},
                   [(1000, 1000, 0), (2000, 2000, -12), (3000, 3000, -7)]),
}
SCENARIO = """schema = 1
[model]
name = "expression"
[model.indications]
v = "g * at + h * set"
[data]
file = "log.txt"
form = "FORM"
conditions = { at = "AT", set = "SET" }
[quantities]
g = { value = 1, estimated = true }
h = { value = 1, estimated = true }
[indications.v]
readings = "COLUMN"
"""


class LogForm(InFolder):
    def check(self, form, log, column, at, explain=True):
        (self.folder / "log.txt").write_bytes(log.encode())
        text = SCENARIO.replace("FORM", str(form)).replace("COLUMN", column).replace("AT", at["at"]).replace("SET", at["set"])
        (self.folder / "s.toml").write_text(text)
        return gumshoe("check", self.folder / "s.toml", *(["--explain"] if explain else []))

    def test_every_shipped_description_reads_its_sample(self):
        self.assertEqual({f.stem for f in FORMS.glob("*.toml")}, set(SAMPLES))
        for name, (log, column, at, rows) in SAMPLES.items():
            with self.subTest(name):
                run = self.check(FORMS / f"{name}.toml", log, column, at)
                self.assertEqual(run.returncode, 0, run.stderr)
                found = re.findall(r": at (\S+); set (\S+); v (\S+);", run.stdout)
                self.assertEqual([tuple(map(float, f)) for f in found], [tuple(map(float, r)) for r in rows])

    def test_a_description_may_know_more_than_a_log_holds(self):
        """Cycles that measure a circle and contacts are tables of the same description, one at a time."""
        form, at = FORMS / "heidenhain_q.toml", {"at": "centre_1", "set": "centre_2"}
        run = self.check(form, "Time: 10:00:00\nQ151 = 50.0001 Q152 = -30.2 Q153 = 25.0042\nQ151 = 50.0003 Q152 = -30.1 Q153 = 25.004\n", "diameter", at)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stdout.count("v 25.004"), 2)
        run = self.check(form, "Q151 = 1 Q152 = 2 Q153 = 3\nQ115 = 4 Q116 = 5 Q117 = 6\n", "diameter", at)
        self.assertIn("log.txt:1:1: error: the row has no 'x'", run.stderr)

    def test_a_description_counts_for_the_hash(self):
        form = self.folder / "own.toml"
        hashes = set()
        for mark in ("", 'marks = "#"\n'):
            form.write_text(mark + '[[lines]]\npattern = "{a} {b}"\nrow = true\n')
            run = self.check("own.toml", "1 2\n", "b", {"at": "a", "set": "a"})
            hashes.add(re.search(r"hash (\w+)", run.stdout)[1])
        self.assertEqual(len(hashes), 2)

    def test_mistakes(self):
        form = self.folder / "own.toml"
        for text, log, said in (
                ('[[lines]]\npattern = "{a} {b"\nrow = true\n', "", "own.toml:2:11: error: lines[1].pattern: '{a} {b' is no pattern of a line (a brace is not closed)"),
                ('[[lines]]\npattern = "{a}{b}"\nrow = true\n', "", "nothing stands between two cells"),
                ('[[lines]]\npattern = "{a} {b}"\n', "", "no line makes a row"),
                ('[[lines]]\nrow = true\n', "", "lines[1].pattern is missing"),
                ('[[lines]]\npattern = "A {a}"\n[[lines]]\npattern = "B {b}"\nrow = true\n', "B 1\nA 2\nB 3\n", "log.txt:1:1: error: the row has no 'a'"),
                ('[[lines]]\npattern = "A {a} {b}"\nrow = true\n', "B 1\n", "no line of the log makes a row"),
                ('[[lines]]\npattern = "A {a} {b}"\nrow = true\n', "A 1 x\n", "log.txt:1:5: error: 'x' is not a number")):
            form.write_text(text)
            run = self.check("own.toml", log, "b", {"at": "a", "set": "a"})
            self.assertEqual(run.returncode, 2, run.stdout)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertIn(said, run.stderr)
        run = self.check("none.toml", "1 2\n", "b", {"at": "a", "set": "a"})
        self.assertIn("data.form: '", run.stderr)
        form.write_text('[[lines]]\npattern = "{a} {b}"\nrow = true\n')
        run = self.check('own.toml"\ndelimiter = ";', "1 2\n", "b", {"at": "a", "set": "a"})
        self.assertIn("data.delimiter: given together with form", run.stderr)


if __name__ == "__main__":
    unittest.main()
