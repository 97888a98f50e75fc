"""A slow model: blocks of 2,048 samples take a tenth of a second each; a few points are fast."""
SAMPLES = 40_000
SLOW = """schema = 1
[model]
name = "command"
command = ["python3", "slow.py"]
batch = 2048
[model.measurands]
y = "mm"
[quantities]
a = { value = "1 mm", u = "1 um" }
[run]
samples = 40000
"""
SLOW_PROGRAM = """import sys, time
rows = sys.stdin.read().split()[2:]
time.sleep(0.1 if len(rows) > 100 else 0)
print("y (mm)", *rows, sep="\\n")
"""
