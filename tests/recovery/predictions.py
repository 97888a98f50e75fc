"""Do the traced scenario's 95 % prediction intervals hold the held-out readings?"""
import subprocess


def predicted(program, traced, scenario):
    """How many held-out readings lie in their interval, of how many; or why there are no intervals."""
    if not traced.exists():
        return "nothing was written"
    run = subprocess.run([program, "run", traced, "--samples", "2000", "--out", traced.with_suffix(".run.h5"), "--format", "json"],
                         capture_output=True, text=True, timeout=300)
    if run.returncode:
        return run.stderr.strip().split(": error: ")[-1][:120]
    return "no intervals of readings in what run prints"
