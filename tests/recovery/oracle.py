"""Who knows the truth's shape, the noise and the catalogue: generalised least squares in numpy, with nothing of the
engine's search. A verdict is judged by its strength, its power and the rivals that cannot be distinguished."""
import math

import numpy as np

from noise import CORRELATION, deviations


def whitened(kind, d, channels, keep, columns):
    """Rows `keep` of the columns, in units of the true noise; channels run fastest. Of one bad reading nothing is known here."""
    sd = np.repeat(np.sqrt(deviations(kind, d)**2 + d.resolution**2 / 12), channels)
    out, a = (columns / sd[:, None])[keep], CORRELATION.get(kind, 0.0)
    if not a:
        return out
    # AR(1) has no memory beyond the reading before: of what lies g readings back, a^g is expected.
    place = np.repeat(np.argsort(np.argsort(d.time, kind="stable")), channels)[keep]
    for channel in range(channels):
        rows = np.flatnonzero(np.tile(np.arange(channels), d.readings)[keep] == channel)
        rows = rows[np.argsort(place[rows])]
        share = a ** np.diff(place[rows])[:, None]
        out[rows[1:]] = (out[rows[1:]] - share * out[rows[:-1]]) / np.sqrt(1 - share**2)
    return out


def scatter_columns(system, d, channels):
    """What each act done anew moves by one standard deviation, um; no columns where none is declared."""
    if not d.scatter:
        return np.zeros((d.readings * channels, 0))
    each = np.diag(np.sqrt(system.SCATTER)) if hasattr(system, "SCATTER") else np.eye(channels)
    return d.scatter * np.kron(np.eye(d.acts().max() + 1)[d.acts()], each)


def basis(columns):
    """Orthonormal columns that span these."""
    u, s, _ = np.linalg.svd(columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300), full_matrices=False)
    return u[:, s > 1e-9 * max(s.max(initial=0), 1e-300)]


class Oracle:
    """What is declared is fitted like what is free, its declared value being one more reading of it: generalised least
    squares without a covariance matrix."""

    def __init__(self, system, program, d, kind="white"):
        self.system, self.program, self.d, self.kind = system, program, d, kind
        values, steps = d.values(), d.steps()
        known = [i for i, c in enumerate(d.cells) if c.u > 0 or c.free]
        y = system.simulate(program, d, [values] + [values + steps[i] * np.eye(len(values))[i] for i in known])
        self.base = y[0]
        self.by_cell = {i: (yi - y[0]) / steps[i] for i, yi in zip(known, y[1:])}  # um per shown unit
        self.channels = y.shape[2]
        self.keep = np.repeat(d.training(), self.channels)
        columns = lambda cells: np.array([self.by_cell[i].ravel() * (d.cells[i].u or 1) for i in cells]).T.reshape(self.keep.size, -1)
        declared = np.hstack([columns([i for i, c in enumerate(d.cells) if c.u > 0]), scatter_columns(system, d, self.channels)])
        self.declared = declared.shape[1]
        random = self._white(declared)
        random[self.keep.sum():] = np.eye(self.declared)
        self.random = basis(random)
        self.span = basis(np.hstack([random, self._white(columns([i for i, c in enumerate(d.cells) if c.free]))]))

    def _white(self, columns):
        """Whitened training rows, and zeros for the declared values."""
        rows = whitened(self.kind, self.d, self.channels, self.keep, np.asarray(columns, float).reshape(self.keep.size, -1))
        return np.vstack([rows, np.zeros((self.declared, rows.shape[1]))])

    def projected(self, shift):
        """Whitened training rows of a shift, minus the part that the free and declared quantities explain."""
        w = self._white(shift)
        return w - self.span @ (self.span.T @ w)

    def strength(self, shift):
        return float(np.linalg.norm(self.projected(shift)))

    def catalogue(self):
        """(name, projected signature of length 1) of effects and declared quantities that are not absorbed. The first
        signature of an effect is of one shown unit of its quantity."""
        if hasattr(self, "_catalogue"):
            return self._catalogue
        d, raw = self.d, []
        effects = self.system.CATALOGUE
        y = self.system.simulate(self.program, d, [d.values()] * len(effects),
                                 [{key: step, **shape} for _, key, step, shape in effects]) if effects else []
        raw += [(e[0], (yi - self.base) / e[2]) for e, yi in zip(effects, y)]
        raw += getattr(self.system, "own_catalogue", lambda d: [])(d)
        raw += [("declared:" + c.title, self.by_cell[i]) for i, c in enumerate(d.cells) if c.u > 0]
        for name in sorted({c.name for c in d.cells if c.u > 0 and c.label}):
            raw.append(("declared:" + name, sum(self.by_cell[i] for i, c in enumerate(d.cells) if c.name == name)))
        self._catalogue, self.per_unit = [], {}
        for name, shift in raw:
            w, full = self.projected(shift), self._white(shift)
            full -= self.random @ (self.random.T @ full)
            if np.linalg.norm(w) > 0.03 * np.linalg.norm(full) > 0:
                self._catalogue.append((name, w[:, 0] / np.linalg.norm(w)))
                self.per_unit.setdefault(name, w[:, 0])
        return self._catalogue

    def nearest(self, name, shift):
        """Size of the catalogue's effect, by the first of its quantities, that comes nearest to this shift."""
        self.catalogue()
        g = self.per_unit.get(name)
        return None if g is None else float(g @ self.projected(shift)[:, 0] / (g @ g))

    def rivals(self, shift):
        """Correlation of the truth's projected signature with the closest member of each name."""
        w = self.projected(shift)[:, 0]
        w /= np.linalg.norm(w)
        best = {}
        for name, g in self.catalogue():
            best[name] = max(best.get(name, 0.0), abs(float(w @ g)))
        # Effects of several quantities: what their span explains.
        for name in {n for n, _ in self.catalogue()}:
            g = np.array([v for n, v in self.catalogue() if n == name]).T
            if g.shape[1] > 1:
                u, s, _ = np.linalg.svd(g, full_matrices=False)
                best[name] = float(np.linalg.norm(u[:, s > 1e-6 * s[0]].T @ w))
        return dict(sorted(best.items(), key=lambda item: -item[1]))

    def threshold(self, rng, alpha=0.05, draws=2000):
        """Of the largest statistic over the catalogue, nothing there."""
        g = np.array([v for _, v in self.catalogue()])
        z = np.abs(g @ rng.standard_normal((g.shape[1], draws))).max(axis=0)
        return float(np.quantile(z, 1 - alpha))


def power(strength, threshold):
    """Chance that a normal deviate of this mean is beyond the threshold on either side."""
    phi = lambda x: 0.5 * math.erfc(-x / math.sqrt(2))
    return phi(strength - threshold) + phi(-strength - threshold)
