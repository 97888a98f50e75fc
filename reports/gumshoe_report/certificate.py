"""The result as a certificate states it: Y = (y ± U) unit, k, coverage probability (GUM 7.2.3)."""
import math

from .rounding import decimals, fixed, probability, unit_text
from .tables import point, spread


def typeset(text):
    """The line of the result file, with the signs that people write."""
    for plain, sign in (("+-", "±"), (" um,", " µm,"), (") um", ") µm"), ("degC", "°C"), ("degF", "°F"), (" deg,", "°,"), (") deg", ")°")):
        text = text.replace(plain, sign)
    return "".join("−" if c == "-" and (k == 0 or text[k - 1] in "( [=") else c for k, c in enumerate(text))


def line(o, b, v, p):
    """Of one output; "" where it has none. Files that hold no such line get it from the budget that was validated."""
    if getattr(o, "certificate", ""):
        return typeset(o.certificate)
    if b is None or v is None or not b.applicable or v.verdict != "validated" or not b.expanded_uncertainty > 0:
        return ""
    U = spread(b, b.expanded_uncertainty)
    places, unit = decimals(U), unit_text(b.display_units)
    pair = f"{fixed(point(b, b.estimate), places)} ± {fixed(U, places)}"
    dof = b.effective_degrees_of_freedom
    tail = f" ({dof:.0f} effective degree{'' if round(dof) == 1 else 's'} of freedom)" if math.isfinite(dof) and dof > 0 else ""
    return (f"{o.name} = " + (f"({pair})\u202f{unit}" if unit else pair) + f", k = {fixed(b.coverage_factor, 2)}{tail}, "
            f"{probability(p)}")
