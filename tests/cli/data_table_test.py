"""[data]: one table for all indications, columns of words and clock times, several files as one, blocks as stretches.

usage: data_table_test.py path/to/gumshoe [unittest options]
"""
import json
import re
import unittest

import h5py

from program import InFolder, complaint, gumshoe

RUN = """date;clock;pos_mm;dir;x_um;y_um;sd_um
DAY.02.2026;10:00:00;0;fwd;0,4;1,4;0,2
DAY.02.2026;10:00:30;250;fwd;2,1;3,1;0,2
DAY.02.2026;10:01:00;500;bwd;3,9;4,9;0,4
"""
SCENARIO = """schema = 1
[model]
name = "expression"
[model.indications]
x = "gain * position + backlash * direction"
y = "gain * position + backlash * direction + offset"
[data]
file = "run_{run}.csv"
decimal = ","
labels = { run = "run" }
units = { pos_mm = "mm", x_um = "um", y_um = "um" }
[data.conditions]
position = "pos_mm"
direction = { column = "dir", map = { fwd = 1, bwd = -1 } }
time = { column = ["date", "clock"], clock = "%d.%m.%Y %H:%M:%S" }
[quantities]
gain = { value = "0 um/m", estimated = true }
backlash = { value = "0 um", estimated = true }
offset = { value = "0 um", estimated = true }
[indications.x]
readings = "x_um"
u = { column = "sd_um", unit = "um" }
[indications.y]
readings = { column = "y_um" }
u = "0.3 um"
"""


class DataTable(InFolder):
    def setUp(self):
        super().setUp()
        for day in (3, 4, 10):
            (self.folder / f"run_{day}.csv").write_text(RUN.replace("DAY", f"{day:02}"))
        self.file = self.folder / "s.toml"

    def explained(self, text=SCENARIO):
        self.file.write_text(text)
        run = gumshoe("check", self.file, "--explain")
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def refused(self, change, *words, scenario=SCENARIO):
        old, new = change
        self.assertIn(old, scenario)
        self.file.write_text(scenario.replace(old, new))
        run = gumshoe("check", self.file)
        self.assertEqual(run.returncode, 2, run.stdout)
        self.assertIsNone(complaint(run), run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)
        return run.stderr

    def readings(self, text):
        return re.findall(r"^  \d+ \[(.*?)\]: position (\S+) m .*?; direction (\S+); time (\S+) s; x (\S+) m .*?; y (\S+) m",
                          text, re.M)

    def test_words_clock_times_and_files_as_one(self):
        found = self.readings(self.explained())
        self.assertEqual(len(found), 9)
        self.assertEqual(found[1], ("run = 3", "0.25", "1", "30", "2.1e-06", "3.1e-06"))
        self.assertEqual(found[8], ("run = 10", "0.5", "-1", f"{7 * 86400 + 60}", "3.9e-06", "4.9e-06"))
        self.assertEqual([f[0] for f in found[::3]], ["run = 3", "run = 4", "run = 10"])  # numbers in their order

    def test_of_a_misspelt_column_no_unit_is_asked_for(self):
        said = self.refused(('readings = "x_um"', 'readings = "x_mu"'), "has no column 'x_mu'. Did you mean 'x_um'?")
        self.assertNotIn("unit", said)

    def test_seconds_count_from_the_time_stated(self):
        """An hour before the first reading; of other readings, too."""
        at = lambda text: [float(f[3]) for f in self.readings(self.explained(text))]
        form = 'clock = "%d.%m.%Y %H:%M:%S"'
        stated = SCENARIO.replace(form, form + ', since = "03.02.2026 09:00:00"')
        self.assertEqual(at(stated), [t + 3600 for t in at(SCENARIO)])
        kept = (self.folder / "run_3.csv").read_text()
        (self.folder / "run_3.csv").unlink()
        self.assertEqual(at(stated)[0], 86400 + 3600)
        (self.folder / "run_3.csv").write_text(kept)
        for said, why in (('"3 February"', "since: '3 February' is not a clock time (it is read as"),
                          ('"03.02.2026 09:00:00", unit = "s"', "given together with clock")):
            self.refused((form, f"{form}, since = {said}"), why)
        self.refused((', ' + form, ', since = "03.02.2026"'), "since: given without clock")
        (self.folder / "z.csv").write_text("at,x_um\n2026-02-03T10:00:00Z,1\n2026-02-03T11:00:00Z,2\n")
        zoned = SCENARIO[:SCENARIO.index("[data]")].replace("gain * position + backlash * direction", "gain * time") + """[data]
file = "z.csv"
[data.conditions]
time = { column = "at", clock = "iso", since = "2026-02-03T09:00:00" }
[quantities]
gain = { value = "0 um/s", estimated = true }
offset = { value = "0 um", estimated = true }
[indications.x]
readings = { column = "x_um", unit = "um" }
[indications.y]
readings = { column = "x_um", unit = "um" }
"""
        self.refused(("", ""), "since: '2026-02-03T09:00:00' has no zone, and the column one", scenario=zoned)

    def test_one_table_says_what_each_indication_could(self):
        text = SCENARIO.replace("run_{run}.csv", "run_3.csv").replace('labels = { run = "run" }\n', "")
        shared = self.explained(text)
        data = text[text.index("[data]"):text.index("[quantities]")]
        own = ('file = "run_3.csv", decimal = ",", conditions = { position = { column = "pos_mm", unit = "mm" }, '
               'direction = { column = "dir", map = { fwd = 1, bwd = -1 } }, '
               'time = { column = ["date", "clock"], clock = "%d.%m.%Y %H:%M:%S" } }')
        apart = text.replace(data, "").replace('readings = "x_um"', f'readings = {{ column = "x_um", unit = "um", {own} }}')
        apart = apart.replace('column = "y_um" }', f'column = "y_um", unit = "um", {own} }}')
        self.assertEqual(self.explained(apart).split("\n", 1)[1], shared.split("\n", 1)[1])

    def test_files_that_no_label_tells_apart_are_said_to_be_repeats(self):
        x = SCENARIO[:SCENARIO.index("[indications.x]")].replace("y = \"gain * position + backlash * direction + offset\"\n", "").replace("offset = { value", "zero = { value")
        x = x.replace("\ntime = ", "\n# ").replace("backlash * direction", "backlash * direction + zero") + '[indications.x]\nreadings = "x_um"\n'
        said = 'are means over several files: labels = { run = "run" } tells them apart'
        self.assertNotIn(said, self.explained(x))
        apart = x.replace('labels = { run = "run" }\n', "")
        self.assertIn("3 readings of run_{run}.csv " + said, self.explained(apart))
        self.assertIn('{run} in place of *, and labels = { run = "run" }', self.explained(apart.replace("{run}.csv", "*.csv")))
        self.assertNotIn(said, self.explained(apart.replace("{run}", "3")))

    def test_noise_of_every_reading(self):
        found = re.findall(r"noise of (\w)(?: \[(.*?)\])? = \S+ m .*\n +u: normal \(mean 0 m, u (\S+) m\)", self.explained())
        self.assertEqual([u for name, _, u in found if name == "x"], ["2e-07", "2e-07", "4e-07"] * 3)
        self.assertEqual([u for name, _, u in found if name == "y"], ["3e-07"])  # all alike
        self.assertIn("reading = 9", found[8][1])
        # Repeats: u of the mean of (0.2, 0.4) um is sqrt(0.2^2 + 0.4^2) / 2 um.
        (self.folder / "run_3.csv").write_text("pos_mm;x_um;sd_um\n0;1;0,2\n0;2;0,4\n")
        (self.folder / "s.toml").write_text("""schema = 1
[model]
name = "expression"
[model.measurands]
z = "x * 2"
[data]
file = "run_3.csv"
decimal = ","
[indications.x]
readings = { column = "x_um", unit = "um" }
u = { column = "sd_um", unit = "um" }
""")
        run = gumshoe("run", self.file, "--samples", "1e5", "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        z = next(iter(json.loads(run.stdout)))["gum"]
        self.assertAlmostEqual(z["combined_standard_uncertainty"], 2 * (0.2**2 + 0.4**2)**0.5 / 2, 9)

    def test_an_estimate_weighs_readings_by_their_noise(self):
        (self.folder / "run_3.csv").write_text("pos_mm;x_um;sd_um\n0;1;0,1\n1;2;0,2\n")
        self.file.write_text("""schema = 1
[model]
name = "expression"
[model.indications]
x = "c"
[data]
file = "run_3.csv"
decimal = ","
labels = { at = "pos_mm" }
[indications.x]
readings = { column = "x_um", unit = "um" }
u = { column = "sd_um", unit = "um" }
[quantities]
c = { value = "0 um", estimated = true }
""")
        run = gumshoe("estimate", self.file, "--format", "json", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        c = json.loads(run.stdout)["parameters"]["c"]
        self.assertAlmostEqual(c["value"], (1 * 100 + 2 * 25) / 125, 6)  # weights 1/u^2

    def test_blocks_are_stretches(self):
        for blocks, expected in (('{ every = "12 h", of = "time" }', "111222333"), ("{ count = 4 }", "111223344"),
                                 ('{ every = "300 mm", of = "position" }', "112112112")):
            found = self.readings(self.explained(SCENARIO + f"[trace]\nblocks = {blocks}\n"))
            self.assertEqual("".join(f[0][-1] for f in found), expected)
        text = SCENARIO + '[trace]\nblocks = { every = "12 h" }\norder = "moment"\n[trace.columns]\n' \
            'moment = { column = ["date", "clock"], clock = "%d.%m.%Y %H:%M:%S" }\n'
        explained = self.explained(text)
        self.assertEqual("".join(f[0][-1] for f in self.readings(explained)), "111222333")
        self.assertIn("column moment: 0 s to 604860 s", explained)
        run = gumshoe("trace", self.file, "--draws", "99", "--out", "s.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        with h5py.File(self.folder / "s.h5") as file:
            self.assertEqual(b"".join(file["data/labels/block"].asstr()[:].astype("S")).decode(), "111222333")
        self.assertEqual(gumshoe("check", "s.traced.toml", cwd=self.folder).returncode, 0)

    def test_times_without_a_date_go_on_after_midnight(self):
        (self.folder / "run_3.csv").write_text("clock,x\n23:59:30,1\n00:00:00,2\n00:00:30,3\n")
        self.file.write_text("""schema = 1
[model]
name = "expression"
[model.indications]
x = "c * t"
[data]
file = "run_3.csv"
conditions = { t = { column = "clock", clock = "%H:%M:%S" } }
[indications.x]
readings = { column = "x", unit = "um" }
[quantities]
c = { value = "0 um/s", estimated = true }
""")
        run = gumshoe("check", self.file, "--explain")
        self.assertEqual(re.findall(r": t (\S+) s;", run.stdout), ["0", "30", "60"], run.stderr)
        # A zone, where there is one, counts; without one the time between two rows is unknown.
        (self.folder / "run_3.csv").write_text("clock,x\n2026-02-03T10:00:00Z,1\n2026-02-03T12:01:00+02:00,2\n")
        text = self.file.read_text().replace('"%H:%M:%S"', '"iso"')
        self.assertEqual(re.findall(r": t (\S+) s;", self.explained(text)), ["0", "60"])
        (self.folder / "run_3.csv").write_text("clock,x\n2026-02-03T10:00:00Z,1\n2026-02-03T12:01:00,2\n")
        self.refused(("", ""), "clock times with and without a zone stand in one column", scenario=text)

    def test_another_file_stands_for_the_data(self):
        (self.folder / "new.csv").write_text(RUN.replace("date;", "run;date;").replace("DAY", "7;07"))
        self.file.write_text(SCENARIO)
        run = gumshoe("trace", self.file, "--data", "new.csv", "--draws", "99", "--out", "out/s.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 2, run.stderr)  # no such folder
        (self.folder / "out").mkdir()
        run = gumshoe("trace", self.file, "--data", "new.csv", "--draws", "99", "--out", "out/s.h5", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        written = self.folder / "out/s.traced.toml"
        if written.exists():
            self.assertIn('file = "../new.csv"', written.read_text())

    def test_clock_times_and_words_that_are_read_as_numbers_get_the_key_they_need(self):
        (self.folder / "log.csv").write_text("when,dir,pos_mm,x_um,y_um\n2026-02-03T10:00:00,up,0,0.4,0.5\n2026-02-03T10:00:30,down,5,0.6,0.7\n")
        plain = re.sub(r"\nu = .*", "", SCENARIO).replace('"run_{run}.csv"', '"log.csv"').replace('decimal = ","\n', "").replace('labels = { run = "run" }\n', "")
        plain = plain.replace('column = "dir", map = { fwd = 1, bwd = -1 }', 'column = "dir"')
        plain = plain.replace('column = ["date", "clock"], clock = "%d.%m.%Y %H:%M:%S"', 'column = "when"')
        self.refused(("", ""), "log.csv:2:1: error: '2026-02-03T10:00:00' is a clock time, and data.conditions.time is read as numbers. "
                     "Try: clock = \"iso\" in data.conditions.time: seconds since the first",
                     "log.csv:2:21: error: 'up' is a word, and data.conditions.direction is read as numbers. "
                     "Try: map = { \"down\" = -1, \"up\" = 1 } in data.conditions.direction", scenario=plain)
        mended = plain.replace('column = "when"', 'column = "when", clock = "iso"').replace('column = "dir"', 'column = "dir", map = { "down" = -1, "up" = 1 }')
        self.explained(mended)

    def test_trace_says_what_means_of_recorded_readings_hide(self):
        """A sensor is exchanged within a day of twenty readings: the days' means are five, and say little."""
        values = [100 + 0.01 * ((7 * k) % 13 - 6) + (0.5 if k > 61 else 0) for k in range(120)]
        rows = [f"{1 + k // 20},{600 * k},{y:.3f}" for k, y in enumerate(values)]
        (self.folder / "log.csv").write_text("day,t,y\n" + "\n".join(rows) + "\n")
        text = """schema = 1
[model]
name = "expression"
indications = { y = "level" }
[quantities]
level = { estimated = true, value = "100 um" }
[indications.y]
readings = { file = "log.csv", column = "y", unit = "um", labels = { day = "day" } }
[trace]
blocks = "day"
columns.t = { column = "t", unit = "s" }
"""
        said = "120 readings of equal labels and conditions are judged as 6, their means, whatever t did meanwhile; repeats = \"apart\" in readings keeps them apart"
        self.file.write_text(text)
        self.assertIn(said, gumshoe("trace", self.file, cwd=self.folder).stdout)
        self.file.write_text(text.replace('"um", labels', '"um", repeats = "apart", labels'))
        run = gumshoe("trace", self.file, "--force", cwd=self.folder)
        self.assertNotIn(said, run.stdout)
        self.assertIn("Something changed after reading 62", run.stdout)

    def test_mistakes_are_named_at_their_place(self):
        bad = self.folder / "run_4.csv"
        for change, said in ((("fwd", "forward"), "run_4.csv:2:23: error: 'forward' has no number in data.conditions.direction.map "
                              "(column 'dir': it has bwd, fwd). Add the word to the map."),
                             (("10:00:30", "10:99:30"), "is not a clock time of data.conditions.time (column 'date': it is read as "
                              "\"%d.%m.%Y %H:%M:%S\", such as 03.02.2026 10:00:00)"),
                             (("250", "2x"), "run_4.csv:3:21: error: '2x' is not a number (column 'pos_mm'"),
                             (("pos_mm", "pos"), "run_4.csv:1:1: error: there is no column 'pos_mm'"),
                             (("sd_um", "sd"), "there is no column 'sd_um'"),
                             ((";0,4\n", ";0\n"), "'0' is no standard uncertainty (column 'sd_um': indications.x.u must be above 0)")):
            bad.write_text(RUN.replace("DAY", "04").replace(*change))
            self.refused(("", ""), said)
        bad.write_text(RUN.replace("DAY", "04"))
        for change, said in (
                (('units = { pos_mm', 'units = { pos'), "s.toml:11:11: error: data.units: "),
                (('pos_mm = "mm"', 'pos_mm = "?"'), "data.units.pos_mm: the unit of the column 'pos_mm' is still to be told "
                 "(the file does not say it). Write it instead of the question mark"),
                (('pos_mm = "mm"', 'pos_mm = "sprockets"'), "data.units.pos_mm: 'sprockets' is not a unit"),
                (('pos_mm = "mm"', 'pos_mm = "s"'), "a time"),
                (('x_um = "um", ', ""), "indications.x.readings.unit is missing"),
                (('"run_{run}.csv"', '"walk_{run}.csv"'), "no file has such a name. Write a name such as \"axis_{run}.csv\""),
                (('"run_{run}.csv"', '"run_{run.csv"'), "a brace is not closed, or holds no name"),
                (('"run_{run}.csv"', '"{run}_{run}.csv"'), "'{run}' stands there twice"),
                (('"run_{run}.csv"', '"*/run_3.csv"'), "the folder's name is a pattern"),
                (('"run_{run}.csv"', '"run_{dir}.csv"'), "the file has a column 'dir' itself"),
                (('column = "dir"', 'column = "dirs"'), "data.conditions.direction.column: "),
                (('column = "dir"', 'column = ["dir", "date"]'), "one column is expected"),
                (("map = { fwd = 1, bwd = -1 }", "map = {}"), "no word is named"),
                (('clock = "%d.%m.%Y %H:%M:%S"', 'clock = "%m.%Y"'), "it has neither hours nor a day"),
                (('clock = "%d', 'unit = "s", clock = "%d'), "given together with clock"),
                (('decimal = ","', 'decimal = ","\ndelimiter = "|"'), "data.delimiter: '|' is unknown"),
                (('readings = "x_um"', 'readings = "x"'), "indications.x.readings.column: "),
                (('readings = "x_um"', 'readings = { column = "x_um", decimal = "," }'), "means nothing together with the others"),
                (('u = "0.3 um"', 'u = "0.3 deg"'), "indications.y.u"),
                (('u = "0.3 um"', 'u = "0.3 um"\ncomponents = [ { name = "u", u = "1 um", per = "reading" } ]'), "the name 'u' is already used")):
            with self.subTest(change):
                self.refused(change, said)
        listed = SCENARIO[:SCENARIO.index("[data]")] + SCENARIO[SCENARIO.index("[quantities]"):]
        listed = listed.replace('"x_um"', '["1 um"]').replace('{ column = "y_um" }', '["1 um"]')
        listed = listed.replace("* position", "").replace("* direction", "")
        self.refused(("", ""), "the readings are not in a data file", scenario=listed.replace("gain = { value = \"0 um/m\"", "gain = { value = \"0 um\""))
        self.refused(('[indications.y]\nreadings = { column = "y_um" }', '[indications.y]\nreadings = ["1 um"]'),
                     "data: no indication reads a column of it",
                     scenario=SCENARIO.replace('readings = "x_um"\nu = { column = "sd_um", unit = "um" }', 'readings = ["1 um"]'))

    def test_a_mistake_of_an_indication_is_told_and_not_that_the_data_are_unread(self):
        only_x = SCENARIO.replace('{ column = "y_um" }', '["1 um"]')
        for change, said in ((('readings = "x_um"', 'redings = "x_um"'), "Did you mean 'readings'?"),
                             (('readings = "x_um"', "readings = true"), "indications.x.readings")):
            self.assertNotIn("no indication reads a column", self.refused(change, said, scenario=only_x))

    def test_mistakes_of_stretches(self):
        for blocks, said in (("{ count = 10 }", "there are only 9 rows"), ("{}", "either every or count is expected"),
                             ('{ every = "1 h", count = 2 }', "either every or count is expected"),
                             ('{ every = "1 h" }', "nothing tells how far the readings are apart"),
                             ('{ every = "1 h", of = "tyme" }', "'tyme' is neither a condition nor a column of the data. Did you mean 'time'?"),
                             ('{ every = "1 mm", of = "time" }', "is not a time")):
            self.refused(("[quantities]", f"[trace]\nblocks = {blocks}\n[quantities]"), said)
        self.refused(("[quantities]", "[trace]\nblocks = { count = 2 }\n[quantities]"), "the label 'block' is already used",
                     scenario=SCENARIO.replace('{ run = "run" }', '{ block = "run" }'))

    def test_cells_without_a_number_are_told_once_with_the_remedy(self):
        """And the remedy works."""
        for text in ("NA", "-"):
            for k, more in ((1, ""), (2, "; so has line 6"), (9, "; so have lines 6, 7, 8 and 5 more")):
                (self.folder / "run_4.csv").write_text(RUN.replace("DAY", "04") + f"04.02.2026;10:02:00;{text};fwd;1;1;1\n" * k)
                said = self.refused(("", ""), f"'{text}' is not a number (column 'pos_mm'{more}). "
                                    f'Leave such rows out: where = {{ "pos_mm" = {{ not = "{text}" }} }}.')
                self.assertEqual(said.count("is not a number"), 1, said)

    def test_many_mistakes_of_one_kind_are_cut_short(self):
        (self.folder / "run_4.csv").write_text(RUN.replace("DAY", "04") + "04.02.2026;10:02:00;1.5;fwd;1;1;1\n" * 30)
        self.assertIn("10 more problems of the data are not listed", self.refused(("", ""), "'1.5' is not a number"))


if __name__ == "__main__":
    unittest.main()
