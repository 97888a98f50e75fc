"""How well held-out readings can be predicted by somebody who knows what is missing, but not how large: its shape, the noise and
everything declared. Generalised least squares at the truth, apart from the engine."""
from dataclasses import replace

import numpy as np

from noise import BAD
from oracle import Oracle, covariance_of_noise, covariance_of_scatter


def held_out(system, program, d, kind, q, y, base, shifts):
    """Root mean square, um, of the held-out readings less their prediction; offsets that only they have are projected out, as the
    program does. NaN where nothing is held out.
    @param base: readings at the true values q without effects; @param shifts: what each missing effect adds"""
    if d.training().all():
        return float("nan")
    at = Oracle(system, program, replace(d, cells=[replace(c, value=v) for c, v in zip(d.cells, q)]), kind)
    known = sorted(at.by_cell)
    columns = np.array([at.by_cell[i].ravel() for i in known] + [s.ravel() for s in shifts]).T
    train, r = at.keep.copy(), (y - base).ravel()
    v = covariance_of_noise(kind, d, y.shape[1]) + covariance_of_scatter(system, d, y.shape[1])
    if kind == "one_bad":  # who knows the noise leaves it out
        train &= np.abs(r - sum(s.ravel() for s in shifts)) < 0.5 * BAD * d.noise
    lower = np.linalg.cholesky(v[np.ix_(train, train)])
    seen = np.linalg.norm(columns[train], axis=0) > 1e-12
    # Declared values are readings of their quantities, too: the truth lies q - value off.
    priors = [(k, d.cells[i]) for k, i in enumerate(known) if d.cells[i].u > 0]
    rows, aims = np.zeros((len(priors), columns.shape[1])), np.zeros(len(priors))
    for row, (k, cell) in enumerate(priors):
        rows[row, k], aims[row] = 1 / cell.u, (cell.value - q[known[k]]) / cell.u
    a = np.vstack([np.linalg.solve(lower, columns[train]), rows])[:, seen]
    size = np.linalg.norm(a, axis=0)
    x = np.linalg.lstsq(a / size, np.concatenate([np.linalg.solve(lower, r[train]), aims]), rcond=1e-10)[0] / size
    rest = r[~at.keep] - columns[~at.keep][:, seen] @ x
    own, s, _ = np.linalg.svd(columns[~at.keep][:, ~seen], full_matrices=False)
    own = own[:, s > 1e-9 * max(s.max(initial=0), 1e-300)]
    rest = rest - own @ (own.T @ rest)
    return float(np.sqrt(rest @ rest / max(len(rest) - own.shape[1], 1)))
