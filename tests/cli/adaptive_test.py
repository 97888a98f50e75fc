"""Adaptive runs from outside: the same stop for any thread count, killed or not; what is refused."""
import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

import h5py
import numpy as np

from program import GUMSHOE, ROOT, InFolder

os.environ["SOURCE_DATE_EPOCH"] = "0"  # the same run, the same bytes
SCENARIOS = ROOT / "scenarios"
TEXT = (SCENARIOS / "rod_gauging.toml").read_text()


def adaptive(folder, table, name="adaptive.toml"):
    text = re.sub(r"(?m)^samples.*$", f"adaptive = {table}", TEXT, count=1)
    text = text.replace('"data/', f'"{SCENARIOS}/data/')
    path = pathlib.Path(folder) / name
    path.write_text(text)
    return path


def run(scenario, out, *options):
    return subprocess.run([GUMSHOE, "run", str(scenario), "--out", str(out), *options], capture_output=True, text=True)


class Adaptive(InFolder):
    def samples(self, file):
        with h5py.File(file) as f:
            return int(f.attrs["samples"]), f["outputs/laser_z"][...], int(f["samples_done"][0])

    def test_same_stop_for_any_thread_count(self):
        for rule in ("stein", "jcgm_101"):
            scenario = adaptive(self.folder, f'{{ rule = "{rule}", digits = 2 }}')
            found = []
            for threads in ("1", "2", "5"):
                done = run(scenario, self.folder / "a.h5", "--threads", threads)
                self.assertEqual(done.returncode, 0, done.stderr)
                found.append(self.samples(self.folder / "a.h5"))
            n, values, marker = found[0]
            self.assertEqual(n % 10000, 0)
            self.assertEqual(values.shape, (1, n))
            self.assertEqual(marker, n)
            for other in found[1:]:
                self.assertEqual(other[0], n)
                np.testing.assert_array_equal(other[1], values)

    def test_validation_is_decided_or_says_how_many_trials_are_needed(self):
        # A normal quantity by itself: the framework is right. u = 8.7 to one digit: delta = 0.5, 6 % of u.
        text = ('schema = 1\n[model]\nname = "expression"\n[model.measurands]\ny = "x + 1"\n'
                '[quantities.x]\nvalue = 0\nu = 8.7\n[run]\nstore_samples = false\nadaptive = { digits = 1%s }\n'
                '[analysis]\nvalidation_digits = 1\n')
        verdicts = {}
        for wanted in ("", ", validation = true"):
            scenario = self.folder / "x.toml"
            scenario.write_text(text % wanted)
            done = run(scenario, self.folder / f"x{len(wanted)}.h5")
            self.assertEqual(done.returncode, 0, done.stderr)
            with h5py.File(self.folder / f"x{len(wanted)}.h5") as f:
                verdicts[wanted] = [f[f"validation/{name}"].asstr()[0] for name in ("verdict", "reason")]
        self.assertEqual(verdicts[", validation = true"][0], "validated")
        if verdicts[""][0] != "validated":
            self.assertRegex(verdicts[""][1], r"about \S+ trials are needed")

    def test_a_validation_that_goes_on_beyond_its_rule_says_so(self):
        """By chance its first stage asks for fewer trials than satisfy clause 7.9 in the end."""
        scenario = self.folder / "on.toml"
        scenario.write_text('schema = 1\n[model]\nname = "expression"\n[model.measurands]\ny = "a + b"\n[quantities]\n'
                            'a = { value = 0, u = 8.7 }\nb = { value = 0, distribution = "rectangular", half_width = 2.175 }\n'
                            '[run]\nstore_samples = false\nadaptive = { digits = 1, validation = true }\n'
                            '[analysis]\nvalidation_digits = 1\n')
        done = run(scenario, self.folder / "on.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(self.folder / "on.h5") as f:
            found = f["stopping"].attrs
            self.assertGreater(found["trials"], found["stein_trials"])
            self.assertRegex(str(found["statement"]), f"{found['trials']} trials by the two-stage .Stein. rule, and on until all of them satisfy "
                             f"JCGM 101 7.9, as a validation asks; .* asks for {found['stein_trials']}")

    def test_trials_are_those_of_a_run_of_that_length(self):
        scenario = adaptive(self.folder, '{ rule = "stein" }')
        run(scenario, self.folder / "a.h5")
        n, values, _ = self.samples(self.folder / "a.h5")
        done = run(scenario, self.folder / "b.h5", "--samples", str(n))
        self.assertEqual(done.returncode, 0, done.stderr)
        np.testing.assert_array_equal(self.samples(self.folder / "b.h5")[1], values)

    def test_killed_runs_resume_to_the_same_bits(self):
        scenario = adaptive(self.folder, '{ rule = "stein", digits = 3, max_samples = 4e6 }')
        whole = run(scenario, self.folder / "whole.h5")
        self.assertIn(whole.returncode, (0, 3), whole.stderr)
        part = self.folder / "part.h5"
        for k in range(8):  # kill it ever later, then let it through
            process = subprocess.Popen([GUMSHOE, "run", str(scenario), "--out", str(part)], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(0.15 + 0.1 * k)
            if process.poll() is None:
                process.send_signal(signal.SIGKILL)
            process.wait()
        last = run(scenario, part)
        self.assertEqual(last.returncode, whole.returncode, last.stderr)
        self.assertEqual(self.samples(part)[0], self.samples(self.folder / "whole.h5")[0])
        np.testing.assert_array_equal(self.samples(part)[1], self.samples(self.folder / "whole.h5")[1])

    def test_a_result_cut_short_is_said_and_made_anew(self):
        scenario = adaptive(self.folder, '{ rule = "stein", digits = 2 }')
        whole, part = self.folder / "whole.h5", self.folder / "part.h5"
        run(scenario, whole)
        content = whole.read_bytes()
        for share in (0.2, 0.5, 0.9, 0.999):
            with self.subTest(share):
                part.write_bytes(content[:int(share * len(content))])
                again = run(scenario, part)
                self.assertEqual(again.returncode, 0, again.stderr)
                self.assertRegex(again.stderr, r"cannot be read .*truncated.*from the beginning\n$")
                self.assertEqual(part.read_bytes(), content)

    def test_giving_up_is_said(self):
        scenario = adaptive(self.folder, '{ rule = "stein", digits = 4, max_samples = 2e5 }')
        done = run(scenario, self.folder / "a.h5")
        self.assertEqual(done.returncode, 3)
        self.assertIn("not satisfied at max_samples = 200000", done.stderr)
        self.assertEqual(self.samples(self.folder / "a.h5")[0], 200000)

    def test_what_is_refused(self):
        for table, message in (('{ rule = "steyn" }', "stein"), ('{ digits = 9 }', "digits"),
                               ('{ max_samples = 10 }', "max_samples"), ('{ rul = "stein" }', "Did you mean 'rule'?")):
            done = run(adaptive(self.folder, table), self.folder / "x.h5")
            self.assertEqual(done.returncode, 2, table)
            self.assertIn(message, done.stderr)
        scenario = self.folder / "both.toml"
        scenario.write_text(re.sub(r"(?m)^(samples.*)$", r"\1" + '\nadaptive = { rule = "stein" }', TEXT, count=1))
        done = run(scenario, self.folder / "x.h5")
        self.assertIn("samples is given together with adaptive", done.stderr)


if __name__ == "__main__":
    unittest.main()
