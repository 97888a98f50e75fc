"""An example of a model as a program: the density of a sphere from its mass and diameter, weighed in air.

Reads points as CSV on stdin and writes results as CSV on stdout, row by row, in the units of the headers.
"""
import csv
import math
import sys

points = csv.DictReader(sys.stdin)
results = csv.writer(sys.stdout, lineterminator="\n")
results.writerow(["density (kg/m3)", "volume (cm3)"])
for point in points:
    d = float(point["diameter (mm)"]) / 1000
    m = float(point["mass (g)"]) / 1000
    air = float(point["air_density (kg/m3)"])
    v = math.pi / 6 * d * d * d
    if v > 0:
        results.writerow([repr(m * (1 - air / 8000.0) / v + air), repr(v * 1e6)])
    else:
        results.writerow(["nan", "nan"])  # this sample has no value; the others go on
