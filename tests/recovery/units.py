"""Factors between the few units in which sizes are told."""
import math

SIZES = {"m": 1, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "s": 1, "ms": 1e-3, "us": 1e-6, "min": 60, "h": 3600, "1": 1, "%": 1e-2, "K": 1, "kN": 1e3, "kN2": 1e6,
         "rad": 1, "mrad": 1e-3, "urad": 1e-6, "deg": math.pi / 180, "arcsec": math.pi / 180 / 3600, "degC": 1, "m2": 1, "mm2": 1e-6, "s2": 1}


def size(unit):
    out, divide = 1.0, False
    for product in unit.split("/"):
        for factor_ in product.split("*"):
            factor_ = factor_.strip().replace("^2", "2")
            out = out / SIZES[factor_] if divide else out * SIZES[factor_]
        divide = True
    return out


def factor(given, wanted):
    """A size in `given` times this is the size in `wanted`."""
    return size(given) / size(wanted)
