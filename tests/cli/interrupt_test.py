"""SIGINT, SIGTERM and SIGHUP end every command within two seconds, whatever runs in it, and the program says what remains.

usage: interrupt_test.py path/to/gumshoe [unittest options]
"""
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from program import GUMSHOE, ROOT, InFolder

CC = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
LIMIT = 2.0
SLACK = 1.0  # a loaded machine

SLEEPER = """schema = 1
[model]
name = "command"
command = ["python3", "model.py"]
time_limit = "60 s"
[model.measurands]
y = "mm"
[quantities]
a = { value = "1 mm", u = "1 um" }
"""
# Answers small tables (the check), sleeps over the others; leaves its process number.
MODEL = """import os, sys, time
rows = sys.stdin.read().splitlines()[1:]
if len(rows) > 100 or os.path.exists("slow"):
    open("pid", "w").write(str(os.getpid()))
    time.sleep(60)
print("y (mm)")
for row in rows: print(row.split(",")[0])
"""
ENDLESS = """#include "gumshoe_plugin.h"
static const gumshoe_variable q[] = {{"a", "mm", "", 1, 0, 0}}, m[] = {{"y", "mm", "", 0, 0, 0}};
static int evaluate(const gumshoe_batch* b) {
  if (b->samples > 100) for (volatile int i = 0;; i = i + 1) {}
  for (size_t i = 0; i < b->samples; ++i) b->measurands[0][i] = b->quantities[0].data[i * b->quantities[0].stride];
  return 0;
}
static const gumshoe_model model = {GUMSHOE_PLUGIN_ABI, 1, "endless", "Endless", 0, 0, q, 1, 0, 0, 0, 0, m, 1, evaluate, 0};
GUMSHOE_EXPORT const gumshoe_model* gumshoe_plugin(void) { return &model; }
"""
STUDY = """schema = 1
[model]
name = "expression"
[model.measurands]
y = "SLOW + b + c ^ 2 * d"
[quantities]
a = { value = "1", u = "0.1" }
b = { value = "1", u = "0.1" }
c = { value = "1", u = "0.1" }
d = { value = "1", u = "0.1" }
[run]
samples = 2000
[analysis]
sensitivity = { STUDY }
"""


# A formula so slow that no study ends before its signal, on any machine.
STUDY = STUDY.replace("SLOW", " + ".join(f"sin({k} * a)" for k in range(1, 201)))


class Interrupt(InFolder):
    def interrupted(self, words, number, ready=lambda: True, pause=0.7, again=None, **options):
        """Seconds from the signal to the end, and what was said."""
        process = subprocess.Popen([GUMSHOE, *map(str, words)], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, **options)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while not ready() and time.monotonic() < deadline and process.poll() is None:
            time.sleep(0.02)
        time.sleep(pause)
        self.assertIsNone(process.poll(), f"ended before the signal: {process.stderr.read() if process.poll() is not None else ''}")
        process.send_signal(number)
        began = time.monotonic()
        if again is not None:
            time.sleep(again)
            process.send_signal(number)
        said = process.communicate(timeout=30)[1]
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("interrupted", said)
        return time.monotonic() - began, said

    def gone(self, number):
        for _ in range(50):
            try:
                if pathlib.Path(f"/proc/{number}/stat").read_text().split()[2] == "Z":
                    return True
            except FileNotFoundError:
                return True
            time.sleep(0.02)
        return False

    def test_a_program_as_model(self):
        (self.folder / "model.py").write_text(MODEL)
        (self.folder / "s.toml").write_text(SLEEPER)
        pid = self.folder / "pid"
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                pid.unlink(missing_ok=True)
                seconds, said = self.interrupted(["run", "s.toml", "--out", "r.h5"], number, pid.exists, 0.2)
                self.assertLess(seconds, LIMIT + SLACK)
                self.assertIn("Repeat the command to resume.", said)
                self.assertTrue(self.gone(int(pid.read_text())), "the program that it started runs on")
        (self.folder / "slow").write_text("")
        pid.unlink(missing_ok=True)
        self.assertLess(self.interrupted(["check", "s.toml"], signal.SIGINT, pid.exists, 0.2)[0], LIMIT + SLACK)

    def test_nohup_goes_on(self):
        (self.folder / "s.toml").write_text(STUDY.replace("STUDY", "sobol = 1048576"))
        process = subprocess.Popen(["nohup", GUMSHOE, "run", "s.toml", "--threads", "1", "--out", "n.h5"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        time.sleep(0.3)
        self.assertIsNone(process.poll(), "ended before the signal")
        process.send_signal(signal.SIGHUP)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)

    @unittest.skipUnless(CC, "no C compiler")
    def test_a_plugin_that_never_returns(self):
        (self.folder / "endless.c").write_text(ENDLESS)
        subprocess.run([CC, "-shared", "-fPIC", "-I", ROOT / "engine/models/plugin", "-o", "endless.so", "endless.c"],
                       cwd=self.folder, check=True)
        (self.folder / "s.toml").write_text('schema = 1\n[model]\nname = "plugin"\nlibrary = "endless.so"\n'
                                            '[quantities]\na = { value = "1 mm", u = "1 um" }\n')
        seconds, _ = self.interrupted(["run", "s.toml", "--out", "r.h5"], signal.SIGTERM)
        self.assertLess(seconds, LIMIT + SLACK)
        seconds, _ = self.interrupted(["run", "s.toml", "--out", "r.h5"], signal.SIGINT, again=0.2)
        self.assertLess(seconds, 0.2 + SLACK)

    def test_studies(self):
        for study in ("sobol = 8_000_000", "shapley = 4_000_000", "morris = 40_000_000", "dgsm = 20_000_000"):
            with self.subTest(study):
                (self.folder / "s.toml").write_text(STUDY.replace("STUDY", study))
                seconds, said = self.interrupted(["run", "s.toml", "--out", "r.h5"], signal.SIGINT,
                                                 (self.folder / "r.h5.gumshoe-lock").exists, 1)
                self.assertLess(seconds, LIMIT + SLACK)
                self.assertIn("Repeat the command to resume.", said)

    def test_choose_and_trace_say_that_they_do_not_resume(self):
        for words in (["choose", ROOT / "scenarios/choose_rod_readouts.toml", "--samples", "5e7"],
                      ["trace", ROOT / "scenarios/trace_sphere.toml", "--draws", "1000000"]):
            with self.subTest(words[0]):
                seconds, said = self.interrupted([*words, "--out", "r.h5"], signal.SIGTERM, pause=2)
                self.assertLess(seconds, LIMIT + SLACK)
                self.assertIn("The same command starts from the beginning.", said)
                self.assertFalse((self.folder / "r.h5").exists())

    def test_report(self):
        (self.folder / "s.toml").write_text(STUDY.replace("sensitivity = { STUDY }", ""))
        subprocess.run([GUMSHOE, "run", "s.toml", "--out", "r.h5"], cwd=self.folder, check=True, capture_output=True)
        (self.folder / "report.py").write_text("import os, time\nopen('pid', 'w').write(str(os.getpid()))\ntime.sleep(60)\n")
        seconds, _ = self.interrupted(["report", "r.h5"], signal.SIGTERM, (self.folder / "pid").exists, 0.2,
                                      env={**os.environ, "GUMSHOE_REPORTS": str(self.folder)})
        self.assertLess(seconds, LIMIT + SLACK)
        self.assertTrue(self.gone(int((self.folder / "pid").read_text())))

    def test_a_history_has_the_readings_only_after_the_report(self):
        scenarios = self.folder / "scenarios"
        (scenarios / "data").mkdir(parents=True)
        for name in ("trace_linear_axis.toml", "data/linear_axis.csv"):
            shutil.copy(ROOT / "scenarios" / name, scenarios / name)
        (self.folder / "report.py").write_text("import os, time\nopen('pid', 'w').write(str(os.getpid()))\ntime.sleep(60)\n")
        pid, history, page = (self.folder / name for name in ("pid", "history.h5", "page.html"))
        words = ["trace", scenarios / "trace_linear_axis.toml", "--draws", "19", "--out", "t.h5", "--append", history, "--report", page]
        hanging = {**os.environ, "GUMSHOE_REPORTS": str(self.folder)}
        _, said = self.interrupted(words, signal.SIGTERM, pid.exists, 0.2, env=hanging)
        self.assertIn("nothing is appended. The same command starts from the beginning.", said)
        self.assertFalse(history.exists())
        pid.unlink()
        process = subprocess.Popen([GUMSHOE, *map(str, words)], cwd=self.folder, stderr=subprocess.DEVNULL, env=hanging)
        while not pid.exists():
            time.sleep(0.02)
        process.kill()
        process.wait()
        self.assertFalse(history.exists())
        for code in (0, 2):  # the same command again, and once more: a campaign counts once
            run = subprocess.run([GUMSHOE, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertTrue(history.exists() and page.exists())
        self.assertIn("holds these readings already", run.stderr)
        self.assertEqual([f.name for f in self.folder.glob("*gumshoe*")], [], "files are left over")

    def test_a_history_is_kept_where_the_report_fails(self):
        (self.folder / "report.py").write_text("raise SystemExit(2)\n")
        run = subprocess.run([GUMSHOE, "trace", ROOT / "scenarios/trace_linear_axis.toml", "--draws", "19", "--out", "t.h5",
                              "--append", "history.h5", "--report", "page.html"], cwd=self.folder, capture_output=True,
                             text=True, env={**os.environ, "GUMSHOE_REPORTS": str(self.folder)})
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("gumshoe report t.h5 --out page.html makes it", run.stderr)
        self.assertTrue((self.folder / "history.h5").exists())


if __name__ == "__main__":
    unittest.main()
