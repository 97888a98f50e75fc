"""Numbers as people write them: the uncertainty to two digits, the estimate to the same place (GUM 7.2.6)."""
import math
import re

# One unit down, for deviations that would otherwise be 0.0004 mm.
FINER = {"m": ("mm", 1e3), "mm": ("um", 1e3), "deg": ("arcsec", 3600.0), "rad": ("urad", 1e6), "s": ("ms", 1e3),
         "mrad": ("urad", 1e3)}
# Units to show where a column has only its SI unit.
COMMON = {"m": ("mm", 1e3), "rad": ("deg", 180 / math.pi), "m/s": ("mm/min", 6e4), "rad/s": ("rpm", 30 / math.pi)}
SYMBOLS = {"um": "µm", "deg": "°", "arcsec": "″", "degC": "°C", "degF": "°F", "urad": "µrad"}
DOUBLE = 15  # decimal digits that every double has
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def unit_text(unit):
    if unit == "1":
        return ""
    text = re.sub(r"[A-Za-z]+", lambda part: SYMBOLS.get(part[0], part[0]), unit)
    return re.sub(r"(?<=[^\W\d])-?\d+", lambda power: power[0].translate(RAISED), text)


def after(unit):
    """What follows a number: its unit with a narrow space, degrees and arc seconds without (SI Brochure 5.4.3)."""
    text = unit_text(unit)
    return text if text in ("", "°", "″") else f"\u202f{text}"


def finer(unit, size):
    """Unit and factor in which a deviation of this size has digits before the point."""
    factor = 1.0
    while unit in FINER and 0 < size * factor < 0.1:
        unit, step = FINER[unit]
        factor *= step
    return unit, factor


def decimals(u, digits=2):
    """Decimal places that show `digits` significant digits of u; None if u gives no place."""
    if not math.isfinite(u) or u <= 0:
        return None
    places = digits - 1 - math.floor(math.log10(u))
    # 0.0996 rounds to 0.100: one digit more than asked for.
    return places - 1 if round(u, places) >= 10 ** (digits - places) else places


def far_from_the_point(value, places):
    """A value at a place so far from the decimal point that an exponent is shorter, unless the value itself is near it."""
    power = math.floor(math.log10(abs(value))) if value else 0
    digits = places + power  # after the first
    if not value or digits < 0:
        return "0"
    if digits >= DOUBLE:
        return f"{value:.{DOUBLE}g}"
    if places > 0 and -4 <= power < 5:
        return f"{value:.{places}f}"
    mantissa, exponent = f"{value:.{digits}e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def fixed(value, places):
    """A value at a decimal place; `places` None shows six significant digits."""
    if not math.isfinite(value):
        return "–"
    if places is None:
        text = f"{value:.6g}"
    elif places > 9 or places < -15:
        text = far_from_the_point(value, places)
    else:
        text = f"{round(value, places):.{max(places, 0)}f}"
    if float(text) == 0:
        text = text.lstrip("-")
    return text.replace("-", "−")


def significant(value, digits=2):
    """So many significant digits, plain from 0.001 to 99999, else with an exponent."""
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0:
        return "0"
    if not 1e-4 <= abs(value) < 1e5:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{mantissa}e{int(exponent)}".replace("-", "−")
    return fixed(value, decimals(abs(value), digits))


def percent(share):
    if share is None or not math.isfinite(share):
        return "–"
    if 0 < abs(share) < 0.0005:
        return "<\u202f0.1\u202f%"
    return fixed(100 * share, 1) + "\u202f%"


def of_all(share):
    """A share of a whole in whole percent; what would round to nothing or to all is a bound."""
    if abs(share) < 0.005:
        return "< 1\u202f%"
    return "> 99\u202f%" if abs(share - 1) < 0.005 else fixed(100 * share, 0) + "\u202f%"


def probability(p):
    """A stated probability with the digits that it has, never 0 or 100 %, as coverage_text() of the engine writes it."""
    least = 1e-12
    if not math.isfinite(p):
        return "–"
    rest = min(p, 1 - p)
    if rest < least:
        return "<\u202f0.0000000001\u202f%" if p < 0.5 else ">\u202f99.9999999999\u202f%"
    text = f"{100 * p:.{max(2, -math.floor(math.log10(rest)))}f}"
    return text.rstrip("0").rstrip(".") + "\u202f%"


def resolved(p, least):
    """A probability from samples that resolve `least` and no less, as probability_text() of the engine writes it: with as
    many digits as the smaller of both sides needs, and a bound in place of 0 and 100 %."""
    if not math.isfinite(p):
        return "–"
    if p < least or 1 - p < least:
        scale = 10.0 ** math.floor(math.log10(least))
        bound = math.ceil(least / scale * (1 - 1e-9)) * scale  # one digit, to the side on which it holds
        text = fixed(100 * (bound if p < least else 1 - bound), max(0, -math.floor(math.log10(100 * bound) + 1e-9)))
        return f"{'<' if p < least else '>'}\u202f{text}\u202f%"
    rest = 100 * min(p, 1 - p)
    return fixed(100 * p, max(0, min(9, 2 - math.floor(math.log10(rest))))) + "\u202f%"


def degrees_of_freedom(n):
    text = f"{n:.4g}" if math.isfinite(n) else "–"
    return f"{text} degree{'' if text == '1' else 's'} of freedom"


def thousands(n):
    return f"{int(n):,}".replace(",", "\u202f")
