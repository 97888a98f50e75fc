"""Shards of a run, their merged result and that of the single run, in a folder of their own."""
import os
import pathlib

from program import InFolder, complaint, gumshoe

SAME_DATE = {**os.environ, "SOURCE_DATE_EPOCH": "0"}  # no host and no duration: equal runs give equal bytes


class Shards(InFolder):
    def setUp(self):
        super().setUp()
        self.shards = self.folder / "shards"
        self.shards.mkdir()

    def gumshoe(self, *words):
        return gumshoe(*words, cwd=self.folder, env=SAME_DATE)

    def done(self, *words):
        run = self.gumshoe(*words)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run

    def scenario(self, text, name="s.toml"):
        (self.folder / name).write_text(text)
        return name

    def make(self, scenario, of, *options, numbers=None, command="run"):
        """The files of shards, by number."""
        files = {k: self.shards / f"{pathlib.Path(scenario).stem}.{k}-of-{of}.h5" for k in range(1, of + 1)}
        said = {k: self.done(command, scenario, *options, "--shard", f"{k}/{of}", "--out", files[k]).stdout
                for k in numbers or files}
        return files, said

    def merged(self, files, *options):
        self.done("merge", *files, "--out", "whole.h5", *options)
        return (self.folder / "whole.h5").read_bytes()

    def single(self, scenario, *options, command="run"):
        self.done(command, scenario, *options, "--out", "single.h5")
        return (self.folder / "single.h5").read_bytes()

    def refused(self, words, *command):
        run = self.gumshoe(*command)
        self.assertIsNone(complaint(run))
        self.assertIn(words, run.stderr)
        return run
