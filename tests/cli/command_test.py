"""A program as a model: what it is given and gives back, every way it can fail, and that nothing is lost then.

usage: command_test.py path/to/gumshoe [unittest options]
"""
import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

os.environ["HDF5_USE_FILE_LOCKING"] = "FALSE"  # to look at a file while it is written
import h5py
import numpy as np

from program import GUMSHOE, InFolder, complaint, gumshoe, places

SCENARIO = """schema = 1
[model]
name = "command"
command = ["python3", "model.py"]
batch = {batch}
time_limit = "{limit}"
[model.measurands]
area = "mm2"
[quantities.width]
value = "20 mm"
u = "0.01 mm"
[quantities.height]
value = "3 cm"
u = "0.02 mm"
[quantities.angle]
distribution = "rectangular"
low = "89 deg"
high = "91 deg"
[run]
samples = {samples}
seed = 7
"""
COMMAND_PLACE = (4, 11)

# What every model here begins with; `rows` are the points, `answer` writes.
BEGIN = """import csv, math, os, sys, time
rows = list(csv.DictReader(sys.stdin))
def area(row):
    return float(row["width (mm)"]) * float(row["height (cm)"]) * 10 * math.sin(math.radians(float(row["angle (deg)"])))
def answer(values, header="area (mm2)"):
    print(header)
    for v in values: print(v)
"""
GOOD = "answer(repr(area(r)) for r in rows)\n"


class Command(InFolder):
    def scenario(self, body=GOOD, batch=10000, limit="30 s", samples=5000, change=lambda text: text):
        (self.folder / "model.py").write_text(BEGIN + body)
        path = self.folder / "s.toml"
        path.write_text(change(SCENARIO.format(batch=batch, limit=limit, samples=samples)))
        return path

    def run_it(self, scenario, name="r.h5", *more):
        return gumshoe("run", scenario, "--out", self.folder / name, *more)

    def values(self, name="r.h5"):
        with h5py.File(self.folder / name) as file:
            return file["outputs/area"][0], file["outputs/status"][()]

    # what it computes

    def test_numbers(self):
        run = self.run_it(self.scenario(samples=100_000))
        self.assertEqual(run.returncode, 0, run.stderr)
        values, status = self.values()
        self.assertFalse(status.any())
        # width, height independent; sin is 1 - x^2 / 2 here: E = 1 - (1 deg)^2 / 6
        expected = 600e-6 * (1 - np.radians(1) ** 2 / 6)
        u = np.hypot(30 * 0.01, 20 * 0.02) * 1e-6
        self.assertLess(abs(values.mean() - expected), 4 * u / np.sqrt(1e5))
        self.assertLess(abs(values.std() / u - 1), 4 / np.sqrt(2e5))
        with h5py.File(self.folder / "r.h5") as file:
            self.assertEqual(file.attrs["model"], "command")
        self.assertIn("are differences over a standard uncertainty", run.stdout)
        # U = k u_c: the law of propagation by differences; dA/dangle is 0 at 90 deg
        self.assertRegex(run.stdout, r"area = \(\S+ \+- 0\.98\) mm2, k = 1\.9[56], 95 %")

    def test_batches_and_threads(self):
        bits = []
        for i, (batch, threads) in enumerate([(10000, 1), (10000, 2), (700, 2), (2048, 3), (5000, 1)]):
            run = self.run_it(self.scenario(batch=batch, samples=12_345), f"{i}.h5", "--threads", threads)
            self.assertEqual(run.returncode, 0, run.stderr)
            bits.append(self.values(f"{i}.h5")[0].tobytes())
        self.assertEqual(len(set(bits)), 1)

    def test_batch_is_a_limit(self):
        body = "with open('sizes.txt', 'a') as f: f.write(f'{len(rows)}\\n')\n" + GOOD
        for batch, samples in ((10000, 20000), (100, 2000)):
            (self.folder / "sizes.txt").unlink(missing_ok=True)
            run = self.run_it(self.scenario(body, batch=batch, samples=samples), "r.h5", "--threads", 2)  # more share a block
            self.assertEqual(run.returncode, 0, run.stderr)
            sizes = [int(n) for n in (self.folder / "sizes.txt").read_text().split()]
            self.assertLessEqual(max(sizes), batch)
            # two for the check, two for the budget, and the run in as few calls as blocks of 2048 allow
            per_call = batch // 2048 * 2048 or batch
            self.assertLessEqual(len(sizes), 4 + samples / per_call + samples / 2048 + 2)

    def test_units_order_and_other_columns(self):
        body = """print("comment,area (cm2),width")
for r in rows: print(f'"x",{area(r) / 100!r},"1"')
"""
        self.assertEqual(self.run_it(self.scenario(), "a.h5").returncode, 0)
        self.assertEqual(self.run_it(self.scenario(body), "b.h5").returncode, 0)
        np.testing.assert_allclose(self.values("b.h5")[0], self.values("a.h5")[0], rtol=4e-16)

    def test_more_than_a_pipe_holds_both_ways(self):
        # Writes before it has read everything, and much on stderr: neither side may wait for the other.
        body = GOOD
        streaming = """import sys, math
head = sys.stdin.readline()
print("area (mm2)", flush=True)
for line in sys.stdin:
    w, h, a = map(float, line.split(","))
    sys.stderr.write("e" * 100 + "\\n")
    print(repr(w * h * 10 * math.sin(math.radians(a))), flush=True)
"""
        self.assertEqual(self.run_it(self.scenario(body, samples=30000, batch=30000), "a.h5").returncode, 0)
        scenario = self.scenario(body, samples=30000, batch=30000)
        (self.folder / "model.py").write_text(streaming)
        run = self.run_it(scenario, "b.h5")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(self.values("a.h5")[0].tobytes(), self.values("b.h5")[0].tobytes())

    def test_replay_check_report(self):
        scenario = self.scenario()
        check = gumshoe("check", scenario, "--explain")
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn("model command", check.stdout)
        self.assertEqual(self.run_it(scenario).returncode, 0)
        replay = gumshoe("replay", self.folder / "r.h5", "--sample", 4321)
        self.assertEqual(replay.returncode, 0, replay.stderr)
        shown = re.search(r"outputs\n  area +(\S+) mm2", replay.stdout)
        self.assertAlmostEqual(float(shown[1]) * 1e-6, self.values()[0][4321], delta=1e-19)
        report = gumshoe("report", self.folder / "r.h5", "--out", self.folder / "report.html")
        self.assertEqual(report.returncode, 0, report.stderr)

    def test_the_script_is_part_of_the_identity(self):
        scenario = self.scenario()
        self.assertEqual(self.run_it(scenario).returncode, 0)
        (self.folder / "model.py").write_text(BEGIN + GOOD + "# changed\n")
        replay = gumshoe("replay", self.folder / "r.h5", "--sample", 1)
        self.assertIsNone(complaint(replay), replay.stderr)
        self.assertIn("has changed since this result", replay.stderr)

    # failed samples

    def test_cells_without_a_number(self):
        for cell in ("", "nan", "abc", "inf", '""', "1e999"):
            with self.subTest(cell):
                body = f"answer({cell!r} if float(r['angle (deg)']) > 90.9 else repr(area(r)) for r in rows)\n"
                run = self.run_it(self.scenario(body), "r.h5")
                self.assertEqual(run.returncode, 3, run.stderr)  # more than 1 % failed
                values, status = self.values()
                self.assertEqual(set(status), {0, 6})
                self.assertTrue(np.isnan(values[status == 6]).all())
                self.assertFalse(np.isnan(values[status == 0]).any())
                share = (status == 6).mean()
                self.assertLess(abs(share - 0.05), 4 * np.sqrt(0.05 * 0.95 / 5000))
                self.assertIn("model_failed", run.stdout)

    # what goes wrong

    def refused(self, run, *words, place=COMMAND_PLACE):
        self.assertIsNone(complaint(run), run.stderr)
        self.assertEqual(places(run, self.folder / "s.toml"), [place], run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)

    def test_check_finds_a_broken_command(self):
        cases = {
            "sys.exit(3)\n": ["exit status 3"],
            "sys.stderr.write('no licence\\n'); sys.exit(1)\n": ["exit status 1", "stderr: no licence"],
            "1 / 0\n": ["exit status 1", "ZeroDivisionError"],
            "import signal\nos.kill(os.getpid(), signal.SIGKILL)\n": ["signal 9"],
            "os.abort()\n": ["signal 6"],
            "": ["wrote nothing"],
            "print('hello')\n": ["no column 'area'", "'hello'"],
            "answer([])\n": ["0 rows for 1 points"],
            "answer([1, 2])\n": ["it wrote 2 rows for 1 points"],
            "answer([1], 'volume (mm3)')\n": ["no column 'area'"],
            "answer([1], 'area (mm3)')\n": ["its column area", "mm3"],
            "answer(['1,2'], 'area (mm2),area (mm2)')\n": ["its output has two columns 'area'", "'area (mm2),area (mm2)'"],
            "answer([1], 'area (foo)')\n": ["'foo' is not a unit"],
            "answer(['1,2'])\n": ["line 2 of its output has 2 cells, but the header has 1"],
            "sys.stdout.buffer.write(bytes(range(256)) * 10)\n": ["no column 'area'"],
            "while True: print('area' * 10000)\n": ["its output did not end"],
        }
        for body, words in cases.items():
            with self.subTest(body):
                self.refused(gumshoe("check", self.scenario(body)), "'python3 model.py'", *words)

    def test_hangs(self):
        for body in ("time.sleep(100)\n", "sys.stdout.close(); os.close(1); os.close(2); time.sleep(100)\n",
                     "import subprocess; subprocess.Popen(['sleep', '100'])\n" + GOOD):
            with self.subTest(body):
                start = time.monotonic()
                run = gumshoe("check", self.scenario(body, limit="1 s"))
                self.assertLess(time.monotonic() - start, 10)
                self.refused(run, "longer than 1 s", "model.time_limit")

    def test_what_is_not_ones_own_starts_nothing_unasked(self):
        scenario = self.scenario("open('ran', 'w')\n" + GOOD)
        run = gumshoe("check", scenario)
        self.assertIn("names code of its own, which this check ran with your rights: model.command python3", run.stdout)
        (self.folder / "ran").unlink()
        if os.geteuid() != 0:
            self.skipTest("only root can give a file away")
        os.chown(scenario, 12345, 12345)
        run = gumshoe("check", scenario)
        self.assertIsNone(complaint(run), run.stderr)
        self.assertIn("is not started (the scenario belongs to another user). Use --allow-external", run.stderr)
        self.assertFalse((self.folder / "ran").exists())
        self.assertEqual(gumshoe("check", scenario, "--allow-external").returncode, 0)
        self.assertEqual(gumshoe("check", scenario, env={**os.environ, "GUMSHOE_TRUSTED": f"/x:{self.folder}"}).returncode, 0)

    def test_a_result_starts_only_the_code_it_was_made_with(self):
        self.assertEqual(self.run_it(self.scenario()).returncode, 0)
        (self.folder / "model.py").write_text("open('ran', 'w')\n" + BEGIN + GOOD)
        for words in (["replay", self.folder / "r.h5", "--sample", 1], ["analyse", self.folder / "r.h5"]):
            run = gumshoe(*words)
            self.assertIsNone(complaint(run), run.stderr)
            self.assertIn("has changed since this result was made", run.stderr)
            self.assertFalse((self.folder / "ran").exists())

    def test_it_inherits_nothing(self):
        body = "names = os.listdir('/proc/self/fd')\nopen('open.txt', 'w').write(' '.join(names))\n" + GOOD
        with open(self.folder / "held", "w") as held:
            os.set_inheritable(held.fileno(), True)
            run = gumshoe("run", self.scenario(body), "--out", self.folder / "r.h5", pass_fds=(held.fileno(),))
        self.assertEqual(run.returncode, 0, run.stderr)
        found = {int(name) for name in (self.folder / "open.txt").read_text().split()}
        self.assertLessEqual(found, {0, 1, 2, 3})  # 3: the list itself

    def test_it_ends_with_its_parent(self):
        body = ("import subprocess\nchild = subprocess.Popen(['sleep', '1000'])\n"
                "open('pids', 'w').write(f'{os.getpid()} {child.pid}\\n')\ntime.sleep(1000)\n")
        process = subprocess.Popen([GUMSHOE, "run", self.scenario(body), "--out", self.folder / "r.h5"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(lambda: (process.kill(), process.wait()))
        started, until = self.folder / "pids", time.monotonic() + 30
        while not (started.exists() and started.read_text().endswith("\n")):
            self.assertLess(time.monotonic(), until)
            time.sleep(0.02)
        process.kill()
        process.wait()

        def alive(pid):
            try:
                return pathlib.Path(f"/proc/{pid}/stat").read_text().split(") ")[1][0] != "Z"
            except FileNotFoundError:
                return False

        until = time.monotonic() + 10
        while any(map(alive, started.read_text().split())):
            self.assertLess(time.monotonic(), until, "an orphan lives on")
            time.sleep(0.02)

    def test_no_such_program(self):
        run = gumshoe("check", self.scenario(change=lambda t: t.replace('"python3"', '"no-such-program"')))
        self.refused(run, "cannot be started", "No such file")

    def test_a_program_that_reads_nothing(self):
        body = "answer(repr(area(r)) for r in rows)\n"
        scenario = self.scenario(body, samples=20000, batch=20000)
        (self.folder / "model.py").write_text("print('area (mm2)')\n")  # its input is far more than a pipe holds
        self.refused(gumshoe("run", scenario, "--out", self.folder / "r.h5"), "0 rows for 1 points")

    def test_mistakes_in_the_scenario(self):
        cases = [
            (lambda t: t.replace('command = ["python3", "model.py"]\n', ""), "command", (2, 1)),
            (lambda t: t.replace('["python3", "model.py"]', "[]"), "no program", COMMAND_PLACE),
            (lambda t: t.replace('["python3", "model.py"]', '"python3 model.py"'), "model.command", COMMAND_PLACE),
            (lambda t: t.replace("batch = 10000", "batch = 0"), "model.batch", (5, 9)),
            (lambda t: t.replace('"30 s"', '"-1 s"'), "model.time_limit", (6, 14)),
            (lambda t: t.replace('"30 s"', '"30 mm"'), "model.time_limit", (6, 14)),
            (lambda t: t.replace('area = "mm2"', 'area = "foo"'), "'foo' is not a unit", (8, 8)),
            (lambda t: t.replace('area = "mm2"\n', ""), "model.measurands: no measurand is named", (7, 1)),
            (lambda t: t.replace("batch =", "bacth ="), "unknown key 'bacth'", (5, 1)),
            (lambda t: t.replace('[model.measurands]\narea = "mm2"\n', ""), "measurands", (2, 1)),
            (lambda t: t.replace('name = "command"', 'name = "command"\nmethod = "virtual_experiment"'), "does not simulate the readings", (2, 1)),
        ]
        for change, word, place in cases:
            with self.subTest(word):
                self.refused(gumshoe("check", self.scenario(change=change)), word, place=place)

    def test_random_numbers_of_its_own(self):
        # Noise anew in every call; noise of a fixed seed, so that only the rows of one call differ; and a row that counts.
        for body in ("import random\n" + GOOD.replace("area(r)", "area(r) + 1e-6 * random.random()"),
                     "import random\nrandom.seed(1)\n" + GOOD.replace("area(r)", "area(r) + 1e-6 * random.random()"),
                     "rows = [r | {'width (mm)': float(r['width (mm)']) * (1 + 1e-9 * i)} for i, r in enumerate(rows)]\n" + GOOD):
            for batch in (10000, 1):
                if batch == 1 and "seed" in body or batch == 1 and "enumerate" in body: continue
                with self.subTest(body, batch=batch):
                    scenario = self.scenario(body, batch=batch)
                    for command in ("check", "run"):
                        self.refused(gumshoe(command, scenario), "the same point gives different results", "area is ")

    # nothing lost

    def test_fails_late_and_resumes(self):
        # Fails from the third full batch on while the file `broken` is there: not part of the model's identity.
        body = """if os.path.exists("broken") and len(rows) > 100:
    with open("calls.txt", "a") as f: f.write("x")
    if len(open("calls.txt").read()) > 3: sys.exit("the licence server is away")
""" + GOOD
        scenario = self.scenario(body, batch=2048, samples=20_000)
        self.assertEqual(self.run_it(scenario, "whole.h5", "--threads", 1).returncode, 0)
        for threads in (1, 2):
            with self.subTest(threads=threads):
                name = f"broken{threads}.h5"
                (self.folder / "broken").touch()
                (self.folder / "calls.txt").unlink(missing_ok=True)
                run = self.run_it(scenario, name, "--threads", threads)
                self.refused(run, "the licence server is away", "samples are kept", "Repeat the command to resume")
                with h5py.File(self.folder / name) as file:
                    done = int(np.ravel(file["samples_done"][()])[0])
                    self.assertFalse(file.attrs["complete"])
                self.assertEqual(done % 2048, 0)
                if threads == 1:
                    self.assertEqual(done, 3 * 2048)
                    self.assertIn(f"at samples {done} to {done + 2047}", run.stderr)
                self.assertIn(f" {done} of 20000 samples are kept", run.stderr)
                whole = self.values("whole.h5")[0]
                self.assertEqual(self.values(name)[0][:done].tobytes(), whole[:done].tobytes())
                (self.folder / "broken").unlink()
                again = self.run_it(scenario, name, "--threads", threads)
                self.assertEqual(again.returncode, 0, again.stderr)
                if done: self.assertIn(f"resuming after {done} samples", again.stderr)
                self.assertEqual(self.values(name)[0].tobytes(), whole.tobytes())

    def wait_for_samples(self, name):
        for _ in range(300):
            time.sleep(0.1)
            try:
                with h5py.File(self.folder / name) as file:
                    if int(np.ravel(file["samples_done"][()])[0]) > 0: return
            except (OSError, KeyError):
                continue
        self.fail("no samples within 30 s")

    def test_killed_and_resumed(self):
        body = "if os.path.exists('slow') and len(rows) > 100: time.sleep(0.15)\n" + GOOD
        scenario = self.scenario(body, batch=2048, samples=60_000)
        self.assertEqual(self.run_it(scenario, "whole.h5").returncode, 0)
        for how, code in ((signal.SIGKILL, -9), (signal.SIGINT, 130)):
            with self.subTest(how):
                (self.folder / "slow").touch()
                name = f"{how.name}.h5"
                process = subprocess.Popen([GUMSHOE, "run", str(scenario), "--out", str(self.folder / name), "--threads", "2"],
                                           stderr=subprocess.PIPE)
                self.wait_for_samples(name)
                process.send_signal(how)
                process.communicate(timeout=30)
                self.assertEqual(process.returncode, code)
                (self.folder / "slow").unlink()
                again = self.run_it(scenario, name)
                self.assertEqual(again.returncode, 0, again.stderr)
                self.assertIn("resuming after", again.stderr)
                self.assertEqual(self.values(name)[0].tobytes(), self.values("whole.h5")[0].tobytes())


if __name__ == "__main__":
    unittest.main()
