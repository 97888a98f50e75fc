"""A measurement as it was planned: who was where, what was commanded, what is declared. Shown units throughout (mm,
deg, mm/min, s), shifts and noise in micrometres."""
import csv
import io
import subprocess
import tempfile
from dataclasses import dataclass, field, replace

import numpy as np


@dataclass(frozen=True)
class Cell:
    """A quantity, or its value at one level of a label."""
    name: str
    unit: str
    value: float
    u: float = 0.0
    label: str = ""
    level: str = ""
    free: bool = False  # estimated, nothing known of it before
    step: float = 0.0   # for differences; u if there is one

    @property
    def title(self):
        return f"{self.name}[{self.label} {self.level}]" if self.label else self.name


@dataclass
class Design:
    system: str
    labels: dict                                    # label -> array of str, one a reading
    conditions: dict                                # name -> (array, unit)
    columns: dict = field(default_factory=dict)     # recorded with the readings: name -> (array, unit)
    cells: list = field(default_factory=list)
    blocks: str = "setup"
    final: tuple = ()
    redone: tuple = ()
    noise: float = 0.5                              # um
    declared: bool = True                           # whether the scenario says so
    stated: bool = True                             # whether it states the system's candidates
    resolution: float = 0.0                         # um, declared
    scatter: float = 0.0                            # um, declared: what an act done anew leaves
    seed: int = 0

    @property
    def readings(self):
        return len(next(iter(self.labels.values())))

    @property
    def time(self):
        return self.conditions["time"][0]

    def block(self):
        return self.labels[self.blocks]

    def training(self):
        return ~np.isin(self.block(), self.final)

    def value(self, condition):
        return {**self.conditions, **self.columns}[condition][0]

    def acts(self):
        """One number for each act done anew, by reading."""
        names = list(zip(*(self.labels[l] for l in self.redone[0])))
        order = sorted(set(names))
        return np.array([order.index(n) for n in names])

    def values(self):
        return np.array([c.value for c in self.cells])

    def steps(self):
        return np.array([c.step or c.u or 1e-3 for c in self.cells])

    def gather(self, values):
        """Quantity -> one value a reading."""
        table = {}
        for cell, value in zip(self.cells, values):
            where = self.labels[cell.label] == cell.level if cell.label else slice(None)
            table.setdefault((cell.name, cell.unit), np.zeros(self.readings))[where] = value
        return table

    def only(self, keep):
        """The same of some readings."""
        cut = lambda d: {k: (v[0][keep], v[1]) if isinstance(v, tuple) else v[keep] for k, v in d.items()}
        return replace(self, labels=cut(self.labels), conditions=cut(self.conditions), columns=cut(self.columns))


def room_temperature(rng, time):
    """degC: the swing of the air conditioning plus a random walk."""
    hours = time / 3600
    return 21 + 0.6 * np.sin(2 * np.pi * hours / 0.83 + rng.uniform(0, 6)) + 0.25 * np.cumsum(rng.standard_normal(len(time))) / 4


def hold_out(rng, blocks):
    """As the program does by default, where there are few blocks; else two of them, not the first."""
    return final_blocks(rng, blocks) or (str(blocks),)


def final_blocks(rng, blocks):
    """Two of them, not the first; none of three."""
    return tuple(sorted(rng.choice([str(b) for b in range(2, blocks + 1)], 2, replace=False))) if blocks > 3 else ()


def evaluate(program, model, columns, outputs, unit="mm"):
    """Indications by `gumshoe evaluate` at the points of a table: {"name (unit)": array} -> (n, len(outputs))."""
    names = list(columns)
    text = ",".join(names) + "\n" + "\n".join(",".join(map(repr, row)) for row in np.column_stack(
        [np.asarray(columns[n], float) for n in names]).tolist()) + "\n"
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
        file.write(text)
        file.flush()
        run = subprocess.run([program, "evaluate", model, "--table", file.name], capture_output=True, text=True)
    if run.returncode:
        raise RuntimeError(f"gumshoe evaluate {model}: {run.stderr[:500]}")
    rows = list(csv.DictReader(io.StringIO(run.stdout)))
    return np.array([[float(row[f"{o} ({unit})"]) for o in outputs] for row in rows])


def by_program(program, d, outputs, vectors, extra=()):
    """um, (number of vectors, readings, outputs). `extra`: {"effect.quantity (unit)": value} for each vector."""
    tables = [d.gather(v) for v in vectors]
    columns = {f"{n} ({u})": np.concatenate([t[n, u] for t in tables]) for n, u in tables[0]}
    for name, (values, unit) in d.conditions.items():
        columns[f"{name} ({unit})"] = np.tile(values, len(vectors))
    for i, beside in enumerate(extra or ()):
        for key, value in beside.items():
            idle = value if "time_constant" in key else 0.0  # a shape has no null
            columns.setdefault(key, np.full(len(vectors) * d.readings, idle))[i * d.readings:(i + 1) * d.readings] = value
    return 1e3 * evaluate(program, d.system, columns, outputs).reshape(len(vectors), d.readings, len(outputs))
