"""`mpirun -n 4 gumshoe run`: the ranks of MPI make the samples of one run, whose file is that of the single run.

usage: ranks_test.py path/to/gumshoe [unittest options]
"""
import os
import pathlib
import re
import shutil
import subprocess
import time
import unittest

from choose_test import TEXT as CHOICE
from counted_model import COUNTED_PROGRAM, CORRELATED, STUDIES, starters
from program import FORMULA, GUMSHOE, HUNG, MESSAGE, SCENARIO, InFolder, gumshoe, ill_formed
from sealed import samples_done
from slow_model import SAMPLES, SLOW, SLOW_PROGRAM

MPIRUN = shutil.which("mpirun")
MODULE = pathlib.Path(GUMSHOE).parent / "gumshoe_mpi.so"
ENVIRONMENT = {**os.environ, "SOURCE_DATE_EPOCH": "0", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
# Each rank writes down its process and becomes the program, as an exec of the launcher would.
NOTED = 'echo $$ > rank$OMPI_COMM_WORLD_RANK; exec "$0" "$@"'


def complaints(run):
    """The error messages on stderr, among what the launcher says."""
    lines = [line for line in run.stderr.splitlines() if re.match(MESSAGE, line)]
    for line in lines:
        assert (fault := ill_formed(line)) is None, f"{fault}: {line!r}"
    return lines


@unittest.skipUnless(MPIRUN, "mpirun is not installed")
@unittest.skipUnless(MODULE.exists(), "the program was built without MPI")
class Ranks(InFolder):
    def setUp(self):
        super().setUp()
        (self.folder / "slow.py").write_text(SLOW_PROGRAM)
        (self.folder / "s.toml").write_text(SLOW)

    def start(self, ranks, *words):
        command = [MPIRUN, "--oversubscribe", "-n", ranks, *words]
        return subprocess.Popen([str(word) for word in command], cwd=self.folder, env=ENVIRONMENT, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def ended(self, process):
        try:
            out, err = process.communicate(timeout=HUNG)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)

    def mpirun(self, ranks, *words):
        return self.ended(self.start(ranks, *words))

    def wait_for_samples(self, process):
        file = self.folder / "ranks.h5"
        while (not file.exists() or not samples_done(file)) and process.poll() is None:
            time.sleep(0.02)

    def single(self, *words, command="run"):
        run = gumshoe(command, *words, "--out", "single.h5", "--force", cwd=self.folder, env=ENVIRONMENT)
        self.assertIn(run.returncode, (0, 3), run.stderr)
        return run, (self.folder / "single.h5").read_bytes()

    def test_the_result_is_that_of_the_single_run(self):
        cases = {"an external model": (SLOW, ["--samples", "20001"], []),
                 "latin hypercube": (SCENARIO + '[run]\nsamples = 20_000\ndesign = "latin_hypercube"\n', [],
                                     ["--threads", "1"]),
                 "samples not stored": (SCENARIO + "[run]\nsamples = 20_000\nstore_samples = false\n", ["--seed", "7"], []),
                 "failed samples": (FORMULA, [], []),
                 "adaptive": (SCENARIO + '[run]\nadaptive = { rule = "stein", digits = 1 }\n', [], ["--threads", "2"])}
        for name, (text, options, threads) in cases.items():
            (self.folder / "s.toml").write_text(text)
            single, expected = self.single("s.toml", *options)
            for ranks in (1, 2, 4):
                with self.subTest(name, ranks=ranks):
                    run = self.mpirun(ranks, GUMSHOE, "run", "s.toml", *options, *threads, "--out", "ranks.h5", "--force")
                    self.assertEqual(run.returncode, single.returncode, run.stderr)
                    self.assertEqual(run.stdout.replace("ranks.h5", "single.h5"), single.stdout)  # one rank prints
                    self.assertEqual((self.folder / "ranks.h5").read_bytes(), expected)

    def test_studies_and_choices_are_shared(self):
        (self.folder / "counted.py").write_text(COUNTED_PROGRAM)
        for name, command, text in (("studies", "run", STUDIES), ("of correlated inputs", "run", CORRELATED),
                                    ("a choice", "choose", CHOICE)):
            (self.folder / "s.toml").write_text(text)
            single, expected = self.single("s.toml", command=command)
            for ranks in (1, 2, 4):
                with self.subTest(name, ranks=ranks):
                    (self.folder / "starts").write_text("")
                    run = self.mpirun(ranks, GUMSHOE, command, "s.toml", "--threads", "1", "--out", "ranks.h5", "--force")
                    self.assertEqual(run.returncode, single.returncode, run.stderr)
                    self.assertEqual(run.stdout.replace("ranks.h5", "single.h5"), single.stdout)
                    self.assertEqual((self.folder / "ranks.h5").read_bytes(), expected)
                    if command == "run":
                        self.assertEqual(len(starters(self.folder)), ranks)

    def test_a_model_that_fails_in_a_study_on_another_rank(self):
        (self.folder / "counted.py").write_text(COUNTED_PROGRAM + "if os.path.exists('dead'): sys.exit('no licence')\n")
        (self.folder / "s.toml").write_text(STUDIES)
        process = self.start(3, GUMSHOE, "run", "s.toml", "--threads", "1", "--out", "ranks.h5")
        while process.poll() is None and not (self.folder / "starts").exists():
            time.sleep(0.01)
        while process.poll() is None and len((self.folder / "starts").read_text().splitlines()) < 3 * 2 + 10 + 10:
            time.sleep(0.01)
        (self.folder / "dead").touch()
        run = self.ended(process)
        self.assertEqual(run.returncode, 2, run.stderr)
        said = complaints(run)
        self.assertEqual(len(said), 1, run.stderr)
        self.assertIn("no licence", said[0])

    def test_a_rank_is_killed_and_the_run_goes_on(self):
        words = [GUMSHOE, "run", "s.toml", "--threads", "1", "--out", "ranks.h5"]
        said = []
        while not (said and re.search(rf"interrupted after \d+ of {SAMPLES} samples. Repeat the command to resume.", said[-1])):
            self.assertLess(len(said), 3, said)  # of 25 jobs on a loaded machine the launcher ends one before rank 0 can say it
            for left in self.folder.glob("rank*"):
                left.unlink()
            process = self.start(3, "sh", "-c", NOTED, *words)
            self.wait_for_samples(process)
            os.kill(int((self.folder / "rank1").read_text()), 9)
            run = self.ended(process)
            self.assertNotEqual(run.returncode, 0)
            self.assertIn("exited on signal 9", run.stderr)  # the launcher
            said.append(run.stderr)
        again = self.mpirun(2, *words)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("resuming after", again.stderr)
        _, expected = self.single("s.toml")
        self.assertEqual((self.folder / "ranks.h5").read_bytes(), expected)

    def test_a_model_that_fails_on_another_rank(self):
        """It dies in all, and one speaks: as in a single run, of the first block that failed."""
        dying = SLOW_PROGRAM + "import os\nif os.path.exists('dead'): sys.exit('no licence')\n"
        (self.folder / "slow.py").write_text(dying)
        words = ["run", "s.toml", "--threads", "1", "--out", "ranks.h5"]
        process = self.start(3, GUMSHOE, *words)
        self.wait_for_samples(process)
        (self.folder / "dead").touch()
        run = self.ended(process)
        self.assertEqual(run.returncode, 2, run.stderr)
        said = complaints(run)
        self.assertEqual(len(said), 1, run.stderr)
        self.assertIn("no licence", said[0])
        self.assertRegex(said[0], rf"\d+ of {SAMPLES} samples are kept in ranks.h5. Repeat the command to resume.")
        (self.folder / "dead").unlink()
        self.assertEqual(self.mpirun(3, GUMSHOE, *words).returncode, 0)
        _, expected = self.single("s.toml")
        self.assertEqual((self.folder / "ranks.h5").read_bytes(), expected)

    def test_ranks_with_other_files(self):
        (self.folder / "t.toml").write_text(SLOW + "# other\n")
        run = self.mpirun(1, GUMSHOE, "run", "s.toml", ":", "-n", 1, GUMSHOE, "run", "t.toml")
        self.assertEqual(run.returncode, 2)
        self.assertIn("error: the ranks have different runs (one has scenario ", complaints(run)[0])
        self.assertFalse((self.folder / "results/s.h5").exists())

    def test_only_the_first_rank_complains(self):
        for words, said in ((["check", "s.toml"], "gumshoe check is the work of one process"),
                            (["run", "none.toml"], "none.toml: error: the file does not exist"),
                            (["run", "s.toml", "--sed"], "unknown option '--sed'")):
            run = self.mpirun(3, GUMSHOE, *words)
            self.assertEqual(run.returncode, 2)
            self.assertEqual(len(complaints(run)), 1, run.stderr)
            self.assertIn(said, complaints(run)[0])
        self.assertEqual(len(self.mpirun(3, GUMSHOE, "--version").stdout.splitlines()), 1)

    def test_shards_share_nothing(self):
        """A launcher may start shards, one in each rank; and programs that a rank starts are no ranks."""
        (self.folder / "slow.py").write_text(SLOW_PROGRAM + "import os\nassert 'OMPI_COMM_WORLD_RANK' not in os.environ\n")
        self.assertEqual(self.mpirun(2, GUMSHOE, "run", "s.toml", "--samples", "5000").returncode, 0)
        (self.folder / "slow.py").write_text(SLOW_PROGRAM)
        shard = 'k=$((OMPI_COMM_WORLD_RANK + 1)); exec "$0" run s.toml --samples 5000 --shard $k/2 --out $k.h5'
        run = self.mpirun(2, "sh", "-c", shard, GUMSHOE)
        self.assertEqual(run.returncode, 0, run.stderr)
        merged = gumshoe("merge", "1.h5", "2.h5", "--out", "merged.h5", cwd=self.folder, env=ENVIRONMENT)
        self.assertEqual(merged.returncode, 0, merged.stderr)
        _, expected = self.single("s.toml", "--samples", "5000")
        self.assertEqual((self.folder / "merged.h5").read_bytes(), expected)

    def test_a_launcher_of_another_mpi(self):
        run = gumshoe("run", "s.toml", cwd=self.folder, env={**ENVIRONMENT, "PMI_RANK": "0", "PMI_SIZE": "4"})
        self.assertEqual(run.returncode, 2)
        self.assertIn("the launcher started 4 processes, which do not find each other", run.stderr)


class WithoutMpi(InFolder):
    def test_the_program_is_not_linked_with_mpi(self):
        self.assertNotIn("libmpi", subprocess.run(["ldd", GUMSHOE], capture_output=True, text=True, check=True).stdout)

    def test_a_program_without_the_module(self):
        (self.folder / "s.toml").write_text(SCENARIO)
        shutil.copy(GUMSHOE, self.folder / "gumshoe")
        environment = {**ENVIRONMENT, "OMPI_COMM_WORLD_RANK": "0", "OMPI_COMM_WORLD_SIZE": "2", "PMIX_RANK": "0"}
        command = [self.folder / "gumshoe", "run", "s.toml"]
        run = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True)
        self.assertEqual(run.returncode, 2)
        self.assertIn("error: this program has no MPI, and a launcher of MPI started several of it", complaints(run)[0])
        environment["OMPI_COMM_WORLD_SIZE"] = "1"
        alone = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True)
        self.assertEqual(alone.returncode, 0)  # of one rank there is nothing to share


if __name__ == "__main__":
    unittest.main()
