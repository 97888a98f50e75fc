"""Noise with a given standard deviation, honest and ugly, in the order of measurement."""
import numpy as np

CORRELATION = {"ar03": 0.3, "ar06": 0.6, "ar08": 0.8}
BAD = 25  # standard deviations, of one reading


def noise(kind, rng, order, channels, sd):
    """(n, channels), um. `order`: times; correlated noise runs along them, each channel for itself. `sd`: of all readings, or (n,)"""
    n = len(order)
    sd = np.broadcast_to(sd, n)[:, None]
    white = rng.standard_normal((n, channels))
    if kind in CORRELATION:
        a = CORRELATION[kind]
        run = np.empty_like(white)
        run[0] = white[0]
        for i in range(1, n):
            run[i] = a * run[i - 1] + np.sqrt(1 - a * a) * white[i]
        out = np.empty_like(run)
        out[np.argsort(order, kind="stable")] = run
        return sd * out
    if kind == "t3":
        return sd * rng.standard_t(3, (n, channels)) / np.sqrt(3)
    if kind == "outliers":
        hit = rng.random((n, channels)) < 0.02
        return sd * np.where(hit, 8 * rng.choice([-1.0, 1.0], (n, channels)), white)
    if kind == "one_bad":
        white[rng.integers(n), rng.integers(channels)] = BAD * rng.choice([-1, 1])
    return sd * white


def deviations(kind, d):
    """Standard deviation of each reading, um: unequal noise grows along the first condition, its mean square as declared."""
    if kind != "unequal":
        return np.full(d.readings, d.noise)
    x = next(iter(d.conditions.values()))[0]
    grows = 0.4 + 1.2 * (x - x.min()) / np.ptp(x)
    return d.noise * grows / np.sqrt(np.mean(grows**2))
