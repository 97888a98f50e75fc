"""How well held-out readings can be predicted by somebody who knows the noise, everything declared and what is missing: an effect's
signature without its size; of what is in no catalogue, only the conditions on which it depends, where these repeat.
Generalised least squares at the truth, apart from the engine."""
from dataclasses import replace

import numpy as np

from noise import BAD
from oracle import Oracle, basis, scatter_columns, whitened


def by_level(d, truth, shift):
    """Any value at each combination of the conditions on which a shape depends; the shape itself where these do not repeat."""
    values = [d.conditions[n][0] for n in truth["depends_on"] if n in d.conditions and n != "time"]
    level = np.unique(np.array(values), axis=1, return_inverse=True)[1].ravel() if len(values) == len(truth["depends_on"]) else []
    if not len(level) or 2 * (level.max() + 1) > d.readings:
        return shift.reshape(-1, 1)
    return np.kron(np.eye(level.max() + 1)[level], np.eye(shift.shape[1]))


def held_out(system, program, d, kind, q, y, base, total, missing):
    """Root mean square, um, of the held-out readings less their prediction; offsets that only they have are projected out, as the
    program does. NaN where nothing is held out.
    @param base: readings at the true values q without effects; @param total: with them;
    @param missing: columns of what is missing, of each effect those that are fitted"""
    if d.training().all():
        return float("nan")
    at = Oracle(system, program, replace(d, cells=[replace(c, value=v) for c, v in zip(d.cells, q)]), kind)
    known, channels = sorted(at.by_cell), y.shape[1]
    scatter = scatter_columns(system, d, channels)
    columns = np.hstack([np.array([at.by_cell[i].ravel() for i in known]).T, *missing, scatter])
    train, r = at.keep.copy(), (y - base).ravel()
    if kind == "one_bad":  # who knows the noise leaves it out
        train &= np.abs((y - total).ravel()) < 0.5 * BAD * d.noise
    # Declared values are readings of their quantities, too: the truth lies q - value off.
    u = [d.cells[i].u for i in known] + [0] * (columns.shape[1] - len(known) - scatter.shape[1]) + [1] * scatter.shape[1]
    off = [d.cells[i].value - q[i] for i in known] + [0] * (len(u) - len(known))
    priors = [k for k in range(len(u)) if u[k]]
    rows, aims = np.zeros((len(priors), len(u))), [off[k] / u[k] for k in priors]
    rows[range(len(priors)), priors] = [1 / u[k] for k in priors]
    white = lambda c: whitened(kind, d, channels, train, c)
    seen = (np.linalg.norm(columns[train], axis=0) > 1e-12) | (np.array(u) > 0)
    a = np.vstack([white(columns), rows])[:, seen]
    size = np.linalg.norm(a, axis=0)
    x = np.linalg.lstsq(a / size, np.concatenate([white(r[:, None])[:, 0], aims]), rcond=1e-10)[0] / size
    rest = r[~at.keep] - columns[~at.keep][:, seen] @ x
    own = basis(columns[~at.keep][:, ~seen])
    rest = rest - own @ (own.T @ rest)
    return float(np.sqrt(rest @ rest / max(len(rest) - own.shape[1], 1)))
