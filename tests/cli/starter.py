"""`gumshoe new` in a folder of its own."""
from program import InFolder, gumshoe


class Starter(InFolder):
    def new(self, *words, code=0):
        run = gumshoe("new", *words, cwd=self.folder)
        self.assertEqual(run.returncode, code, run.stderr)
        return run.stdout if code == 0 else run.stderr
