"""How well held-out readings can be predicted by somebody who knows what is missing, but not how large: its shape, the noise and
everything declared. Generalised least squares at the truth, apart from the engine."""
from dataclasses import replace

import numpy as np

from noise import BAD
from oracle import Oracle, basis, scatter_columns, whitened


def held_out(system, program, d, kind, q, y, base, shifts):
    """Root mean square, um, of the held-out readings less their prediction; offsets that only they have are projected out, as the
    program does. NaN where nothing is held out.
    @param base: readings at the true values q without effects; @param shifts: what each missing effect adds"""
    if d.training().all():
        return float("nan")
    at = Oracle(system, program, replace(d, cells=[replace(c, value=v) for c, v in zip(d.cells, q)]), kind)
    known, channels = sorted(at.by_cell), y.shape[1]
    columns = np.array([at.by_cell[i].ravel() for i in known] + [s.ravel() for s in shifts]).T
    train, r = at.keep.copy(), (y - base).ravel()
    if kind == "one_bad":  # who knows the noise leaves it out
        train &= np.abs(r - sum(s.ravel() for s in shifts)) < 0.5 * BAD * d.noise
    scatter = scatter_columns(system, d, channels)
    columns = np.hstack([columns, scatter])
    # Declared values are readings of their quantities, too: the truth lies q - value off.
    u = [d.cells[i].u for i in known] + [0] * len(shifts) + [1] * scatter.shape[1]
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
