"""A program as a model that writes down each of its starts, with the process that started it, and scenarios with every
study of it."""
COUNTED_PROGRAM = """import math, os, sys
header, *rows = sys.stdin.read().split("\\n")[:-1]
open("starts", "a").write(f"{len(rows)} {os.getppid()}\\n")
print("y (mm),t (degC)")
for row in rows:
    a, b, c = map(float, row.split(","))
    print(repr(a * b + math.sin(c) + a**3) + "," + repr(20 + b + c * c) if a > 0.7 else ",")
"""
STUDIES = """schema = 1
[model]
name = "command"
command = ["python3", "counted.py"]
batch = 64
[model.measurands]
y = "mm"
t = "degC"
[quantities]
a = { value = "1 mm", u = "0.1 mm" }
b = { value = "2", u = "0.2" }
c = { value = "0.5", u = "0.3" }
[run]
samples = 640
max_failed_share = 0.1
[analysis]
sensitivity = { sobol = 256, second_order = true, morris = 21, dgsm = 100, shapley = 128 }
[[analysis.one_at_a_time]]
title = "one step each"
steps = ["0.1 mm"]
"""
CORRELATED = STUDIES.replace("sobol = 256, second_order = true, morris = 21, ", "") + """
[[correlations]]
quantities = ["a", "b"]
kind = "pearson"
coefficient = 0.5
"""


def starts(folder):
    """Points of each start so far."""
    file = folder / "starts"
    return [int(line.split()[0]) for line in file.read_text().splitlines()] if file.exists() else []


def starters(folder):
    """The processes that started it."""
    return {line.split()[1] for line in (folder / "starts").read_text().splitlines()}
