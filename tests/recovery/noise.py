"""Noise with a given standard deviation, honest and ugly, in the order of measurement."""
import numpy as np

def noise(kind, rng, order, channels, sd):
    """(n, channels), um. `order`: times; correlated noise runs along them, each channel for itself."""
    n = len(order)
    white = rng.standard_normal((n, channels))
    if kind in ("ar03", "ar06"):
        a = {"ar03": 0.3, "ar06": 0.6}[kind]
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
    return sd * white
