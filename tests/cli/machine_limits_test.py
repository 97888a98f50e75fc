"""Where a machine gives no more, a program says so and leaves what it had: a full disk or standard output, limits on the size of files and
on threads.

usage: machine_limits_test.py path/to/gumshoe [unittest options]
"""
import os
import pathlib
import resource
import shutil
import subprocess
import unittest

from program import GUMSHOE, Refusals, gumshoe


class MachineLimits(Refusals):
    def test_full_standard_output(self):
        commands = {
            "check": ["check", self.good, "--explain"],
            "run": ["run", self.good, "--samples", 1000, "--out", self.folder / "full.h5"],
            "evaluate": ["evaluate", "rod_gauging", "--table", self.table],
            "replay": ["replay", self.result, "--sample", 1],
            "report": ["report", self.result, "--out", self.folder / "full.html"],
            "models": ["models"],
            "effects": ["effects", "z_scale", "--format", "json"],
            "schema": ["schema"],
            "man": ["man"],
            "completion": ["completion"],
            "version": ["--version"],
            "help": ["--help"],
            "help of a command": ["run", "--help"],
        }
        for name, command in commands.items():
            with self.subTest(name), open("/dev/full", "w") as full:
                self.refused(gumshoe(*command, stdout=full))

    def test_limit_on_file_sizes(self):  # like a full disk, without being root
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (65536, 65536))

        long = self.write("long.csv", "rod_radius (mm)\n" + "5\n" * 10000)
        out, older = self.folder / "limited.h5", self.result.read_bytes()
        self.refused(gumshoe("run", self.good, "--samples", 20000, "--out", out, preexec_fn=limit), [str(out)])
        self.assertFalse(out.exists())
        self.refused(gumshoe("run", self.good, "--samples", 20000, "--out", self.result, preexec_fn=limit), [str(self.result)])
        self.assertEqual(self.result.read_bytes(), older)
        table = self.folder / "limited.csv"
        self.refused(gumshoe("evaluate", "rod_gauging", "--table", long, "--out", table, preexec_fn=limit), [str(table)])

    @unittest.skipUnless(os.geteuid() == 0, "only root can become another user, whose processes are limited")
    def test_limit_on_threads(self):
        def limit(most):
            nobody = 65534
            resource.setrlimit(resource.RLIMIT_NPROC, (most, most))
            os.setgroups([])
            os.setgid(nobody)
            os.setuid(nobody)

        self.folder.chmod(0o777)
        program = pathlib.Path(shutil.copy(GUMSHOE, self.folder / "gumshoe"))  # nobody may not enter every folder
        program.chmod(0o755)
        self.good.chmod(0o644)
        for most, threads in ((1, 8), (2, 8), (3, 8), (5, 8), (1, 1)):
            out = self.folder / f"threads{most}-{threads}.h5"
            with self.subTest(limit=most, threads=threads):
                run = gumshoe("run", self.good, "--samples", 100_000, "--threads", threads, "--out", out,
                              executable=program, preexec_fn=lambda: limit(most))
                if threads == 1:
                    self.assertEqual(run.returncode, 0, run.stderr)
                else:
                    self.refused(run, ["no further thread can be started", "--threads 1"])

    @unittest.skipUnless(os.geteuid() == 0, "only root can mount a small disk")
    def test_full_disk(self):
        disk = self.folder / "disk"
        disk.mkdir(exist_ok=True)
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(disk)], capture_output=True).returncode:
            self.skipTest("mounting is not allowed here")
        try:
            out = disk / "x.h5"
            self.refused(gumshoe("run", self.good, "--samples", 1000000, "--out", out), [str(out)])
            with self.assertRaises(OSError), open(disk / "ballast", "wb", buffering=0) as ballast:
                while ballast.write(bytes(4096)):
                    pass
            self.refused(gumshoe("report", self.result, "--out", disk / "x.html"), [str(disk)])
            long = self.write("long.csv", "rod_radius (mm)\n" + "5\n" * 10000)
            self.refused(gumshoe("evaluate", "rod_gauging", "--table", long, "--out", disk / "x.csv"), [str(disk)])
            self.assertFalse(out.exists())
        finally:
            subprocess.run(["umount", str(disk)], check=True)


if __name__ == "__main__":
    unittest.main()
