"""Do 95 % prediction intervals of the traced scenario hold the readings that it has not seen? `gumshoe run --predict` says so; for
expressions the same is computed here, apart from the engine: formula, values with u and correlations, stated effects, noise."""
import csv
import json
import math
import subprocess
import tomllib

import numpy as np

from units import size

FUNCTIONS = {n: getattr(np, n) for n in ("sin", "cos", "exp", "sqrt")}


def si(value):
    """A number, or one with its unit."""
    number, _, unit = str(value).partition(" ")
    return float(number) * (size(unit) if unit else 1)


def compiled(formula):
    return compile(formula.replace("^", "**"), formula, "eval")


class Traced:
    """Readings as functions of what the scenario says is known: `names` with `values` and `covariance`, SI."""

    def __init__(self, path):
        self.s = tomllib.loads(path.read_text())
        readings = self.s["indications"]["d"]["readings"]
        recorded = {**readings["conditions"], **self.s["trace"].get("columns", {})}
        rows = list(csv.DictReader((path.parent / readings["file"]).read_text().splitlines()))
        self.labels = {n: np.array([r[c] for r in rows]) for n, c in readings["labels"].items()}
        self.at = {n: np.array([float(r[c["column"]]) for r in rows]) * size(c["unit"]) for n, c in recorded.items()}
        self.readings = len(rows)
        self.formula = compiled(self.s["model"]["indications"]["d"])
        self.entries = dict(self.quantities())
        self.names = list(self.entries)
        self.values = np.array([si(e["value"]) if isinstance(e, dict) else si(e) for e in self.entries.values()])
        self.covariance = self.correlated(np.array([si(e.get("u", 0)) if isinstance(e, dict) else 0.0 for e in self.entries.values()]))

    def quantities(self):
        for name, q in self.s.get("quantities", {}).items():
            by = q.get("by", {}) if isinstance(q, dict) else {}
            for label, levels in by.items():
                yield from ((f"{name}[{label} {level}]", entry) for level, entry in levels.items())
            if not by:
                yield name, q if not isinstance(q, dict) or "value" in q else {**q, "value": 0}
        for name, effect in self.s.get("stated_effects", {}).items():
            if "size" in effect:
                yield f"{name}.size", effect["size"]

    def correlated(self, u):
        out = np.diag(u**2)
        for block in self.s.get("correlations", []):
            at = [self.names.index(n) for n in block["quantities"]]
            out[np.ix_(at, at)] = np.array(block["matrix"]) * np.outer(u[at], u[at])
        return out

    def predicted(self, values):
        given = dict(zip(self.names, values))
        columns = {}
        for name, value in given.items():
            quantity, _, where = name.rstrip("]").partition("[")
            label, _, level = where.partition(" ")
            columns[quantity] = np.where(self.labels[label] == level, value, columns.get(quantity, 0.0)) if where else value
        total = eval(self.formula, FUNCTIONS, {**self.at, **columns}) + np.zeros(self.readings)
        for name, effect in self.s.get("stated_effects", {}).items():
            if "size" in effect:
                total += given[f"{name}.size"] * self.loading(effect)
        return total

    def loading(self, effect):
        if "formula" in effect:
            return eval(compiled(effect["formula"]), FUNCTIONS, self.at)
        table = {n: np.array([si(x) for x in v]) for n, v in effect["table"].items() if n != "margin"}  # all lie on levels
        loading = table.pop("loading")
        if len(table) == 1:
            (name, levels), = table.items()
            order = np.argsort(levels)
            return np.interp(self.at[name], levels[order], loading[order])
        far = sum(np.abs(self.at[n][:, None] - v) / max(np.abs(v).max(), 1e-300) for n, v in table.items())
        return np.where(far.min(axis=1) < 1e-6, loading[far.argmin(axis=1)], np.nan)

    def noise(self):
        """Standard deviation of a reading."""
        d = self.s["indications"]["d"]
        parts = [si(c["u"]) for c in d.get("components", [])] + [si(d.get("resolution", 0)) / math.sqrt(12)]
        return math.hypot(*parts)

    def intervals(self):
        """Predictions and their standard uncertainties, noise included, m."""
        best, step = self.predicted(self.values), 1e-3 * np.sqrt(np.diag(self.covariance))
        moved = [(self.predicted(self.values + s * e) - best) / s if s else 0 * best for s, e in zip(step, np.eye(len(step)))]
        jacobian = np.array(moved).T
        return best, np.sqrt(np.einsum("ij,jk,ik->i", jacobian, self.covariance, jacobian) + self.noise()**2)


def by_program(program, traced):
    """What `gumshoe run --predict` says of each reading."""
    run = subprocess.run([program, "run", traced, "--predict", "--samples", "2000", "--threads", "1", "--out", traced.with_suffix(".run.h5"),
                          "--format", "json"], capture_output=True, text=True, timeout=300)
    if run.returncode:
        raise RuntimeError(f"run --predict: exit code {run.returncode}: {run.stderr.strip()[-200:]}")
    return json.loads(run.stdout)


def covered(program, traced, block, final):
    """[held-out readings in their 95 % interval, of how many]"""
    inside = [o["predicted"]["inside"] for o in by_program(program, traced) if o["labels"][block] in final]
    return [sum(inside), len(inside)]
