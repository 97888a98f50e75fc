"""A program as a model that writes down each time it is started, and a scenario with every study of it."""
COUNTED_PROGRAM = """import math, sys
header, *rows = sys.stdin.read().split("\\n")[:-1]
open("starts", "a").write(f"{len(rows)}\\n")
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
samples = 3000
max_failed_share = 0.1
[analysis]
sensitivity = { sobol = 500, second_order = true, morris = 21, dgsm = 150, shapley = 130 }
[[analysis.one_at_a_time]]
title = "one step each"
steps = ["0.1 mm"]
"""
CORRELATED = STUDIES.replace("sobol = 500, second_order = true, morris = 21, ", "") + """
[[correlations]]
quantities = ["a", "b"]
kind = "pearson"
coefficient = 0.5
"""


def starts(folder):
    """Points of each start so far."""
    file = folder / "starts"
    return [int(line) for line in file.read_text().split()] if file.exists() else []
