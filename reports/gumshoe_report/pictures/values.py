"""The scenario's values for a picture: SI numbers to draw with, and their text."""
import math

from ..conditions import scale
from ..rounding import after, decimals, fixed
from ..tables import point, spread


class Values:
    def __init__(self, r):
        self.rows = {}
        for row in r.inputs:
            self.rows.setdefault(row.name, row)  # of several labels the first
        self.conditions = vars(r.readings[0]) if r.readings else {}
        self.scale = lambda name: scale(r, name)
        self.readings = [vars(reading) for reading in r.readings or []]
        self.outputs = {o.measurand: o for o in reversed(r.outputs)}
        self.axes = r.axes
        self.of_labels = list(dict.fromkeys(row.labels for row in self.rows.values() if row.labels))

    def __call__(self, name, otherwise=0.0):
        """SI."""
        row = self.rows.get(name)
        if row is not None and math.isfinite(row.value):
            return row.value
        value = self.conditions.get(name, otherwise)
        return value if isinstance(value, (int, float)) and math.isfinite(value) else otherwise

    def text(self, name, called=None):
        """Name and value in the unit of the scenario."""
        called = called or name.replace("_", " ")
        if name in self.rows:
            row = self.rows[name]
            value, unit = fixed(point(row, row.value), decimals(spread(row, row.standard_uncertainty))), row.display_units
        elif name in self.outputs:
            row = self.outputs[name]
            value, unit = fixed(point(row, row.estimate), decimals(spread(row, row.standard_uncertainty))), row.display_units
        elif name in self.conditions:
            return f"{called} {self.scale(name).text(self(name))}"
        else:
            return called
        return f"{called} {value}{after(unit)}"

    def caption(self):
        return f" Values of {', '.join(self.of_labels)}." if self.of_labels else ""
