"""The scripts for a Slurm array and for GNU parallel that are shipped; both programs are replaced by loops.

usage: shard_scripts_test.py path/to/gumshoe [unittest options]
"""
import os
import re
import shutil
import subprocess
import unittest

from choose_test import TEXT as CHOICE
from program import FORMULA, GUMSHOE, ROOT
from shards import SAME_DATE, Shards


class Scripts(Shards):
    def tools(self):
        """The environment with the program, and a loop in place of GNU parallel."""
        tools = self.folder / "tools"
        tools.mkdir()
        os.symlink(GUMSHOE, tools / "gumshoe")
        (tools / "parallel").write_text('#!/bin/bash\nall=$*\ncommand=${all%%:::*}\nfor k in ${all##*:::}; do name=$(basename "${k%.*}")\n'
                                        'one=${command//\\{\\}/$k}; eval "${one//\\{\\/.\\}/$name}" || exit; done\n')
        (tools / "parallel").chmod(0o755)
        return {**SAME_DATE, "PATH": f"{tools}:{os.environ['PATH']}", "SLURM_CPUS_PER_TASK": "2"}

    def bash(self, line, environment):
        subprocess.run(["bash", "-c", line], cwd=self.folder, check=True, capture_output=True, env=environment)

    def array(self, script, tasks, *words, **environment):
        """A Slurm array, replaced by a loop."""
        for k in range(1, tasks + 1):
            subprocess.run([ROOT / "scenarios" / script, *words], cwd=self.folder, check=True, capture_output=True,
                           env={**environment, "SLURM_ARRAY_TASK_ID": str(k)})

    def test_the_scripts_that_are_shipped(self):
        scenario = self.scenario(FORMULA)
        single = self.single(scenario)
        environment = self.tools()
        self.array("shards.sbatch", 16, scenario, **environment)
        self.assertEqual(self.merged(self.shards.iterdir()), single)
        line = re.search(r"^parallel gumshoe run.*\n", (ROOT / "scenarios/README.md").read_text(), re.M)[0]
        shutil.rmtree(self.shards)
        self.shards.mkdir()
        self.bash(line.replace("scenarios/rod_gauging.toml", scenario), environment)
        (self.folder / "whole.h5").unlink()
        self.assertEqual(self.merged(self.shards.iterdir()), single)

    def test_the_script_on_a_choice(self):
        scenario = self.scenario(CHOICE)
        self.array("shards.sbatch", 4, scenario, **self.tools(), COMMAND="choose", SHARDS="4")
        self.assertEqual(self.merged(self.shards.iterdir()), self.single(scenario, command="choose"))

    def test_traces_are_dealt_out_by_their_data(self):
        environment = self.tools()
        shutil.copytree(ROOT / "scenarios/data", self.folder / "scenarios/data")
        shutil.copy(ROOT / "scenarios/trace_rods.toml", self.folder / "scenarios")
        (self.folder / "data").mkdir()
        rows = (self.folder / "scenarios/data/rods.csv").read_text().splitlines(keepends=True)
        for name, some in (("all", rows), ("fewer", rows[:-4])):
            (self.folder / f"data/{name}.csv").write_text("".join(some))
        line = re.search(r"^parallel '.*gumshoe trace.*\n", (ROOT / "scenarios/README.md").read_text(), re.M)[0]
        self.bash(line, environment)
        by_line = {name: (self.folder / f"traces/{name}/traced.h5").read_bytes() for name in ("all", "fewer")}
        self.assertNotEqual(by_line["all"], by_line["fewer"])
        shutil.rmtree(self.folder / "traces")
        self.array("traces.sbatch", 3, "scenarios/trace_rods.toml", "data/all.csv", "data/fewer.csv", **environment)
        for name, content in by_line.items():
            self.assertEqual((self.folder / f"traces/{name}/traced.h5").read_bytes(), content)
            self.assertTrue((self.folder / f"traces/{name}/verdict.json").exists())


if __name__ == "__main__":
    unittest.main()
