"""A log in a folder of its own: `gumshoe new` writes its scenario, and `gumshoe trace` says what it shows."""
import json

from program import gumshoe
from starter import Starter


class TracedLog(Starter):
    def log(self, rows, *words):
        """Writes log.csv, and log.toml by `new` with these options. Returns the scenario."""
        (self.folder / "log.csv").write_text("\n".join(rows) + "\n")
        self.new("--from", "log.csv", "--force", *words)
        return (self.folder / "log.toml").read_text()

    def verdict(self, scenario, *words):
        run = gumshoe("trace", scenario, "--draws", "199", "--format", "json", "--out", "t.h5", "--force", *words, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)
