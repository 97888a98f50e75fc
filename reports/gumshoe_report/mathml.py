"""Equations of the result file (the language of formulas, with `=`) as MathML."""
import re

from markupsafe import Markup, escape

GREEK = dict(zip("alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau phi chi psi omega".split(),
                 "αβγδεζηθικλμνξπρστφχψω"))
TOKEN = re.compile(r"\s*(?:(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|([A-Za-z_]\w*)|(.))")
SUM, PRODUCT, SIGN, POWER, ATOM = range(5)  # how strongly a part binds


class NotAFormula(Exception):
    pass


def row(*parts):
    return f"<mrow>{''.join(parts)}</mrow>"


def operator(sign):
    return f"<mo>{sign}</mo>"


def fenced(inside, left="(", right=")"):
    tall = "true" if "<mfrac" in inside else "false"
    return row(f'<mo stretchy="{tall}">{left}</mo>', inside, f'<mo stretchy="{tall}">{right}</mo>')


def word(text):
    """A name's part: one letter is a symbol, several are a word."""
    text = GREEK.get(text, text)
    return f"<mi>{escape(text)}</mi>" if len(text) == 1 else f'<mi mathvariant="normal">{escape(text)}</mi>'


def name(text):
    """`rod_length` as words, `E_X0B`, `x_1`, `laser_z` and `tip_i` with a subscript."""
    parts = text.strip("_").split("_")
    head = len(parts)
    while head > 1 and (len(parts[head - 1]) <= 2 or len(GREEK.get(parts[0], parts[0])) == 1):
        head -= 1
    base = word("\u00a0".join(parts[:head]))
    below = "<mo>,</mo>".join(map(word, parts[head:]))
    return f"<msub>{base}{row(below)}</msub>" if below else base


def number(text):
    mantissa, _, exponent = text.lower().partition("e")
    if not exponent:
        return f"<mn>{mantissa}</mn>"
    power = f"<msup><mn>10</mn><mn>{exponent.lstrip('+').replace('-', '−')}</mn></msup>"
    return power if float(mantissa) == 1 else row(f"<mn>{mantissa}</mn>", operator("·"), power)


def call(function, arguments):
    inside = operator(",").join(a for a, _ in arguments)
    shown = {"sqrt": f"<msqrt>{inside}</msqrt>", "abs": fenced(inside, "|", "|"), "norm": fenced(inside, "‖", "‖"),
             "exp": f"<msup><mi>e</mi>{row(inside)}</msup>"}
    if function in shown:
        return shown[function]
    if function == "sum":
        return row('<mo largeop="true">∑</mo>', inside if arguments[0][1] > SUM else fenced(inside))
    return row(name(function), operator("&#x2061;"), fenced(inside))


class Parser:
    """Each rule gives MathML and how strongly its outermost operation binds (engine/formula/README.md: the grammar)."""

    def __init__(self, text):
        self.tokens = [m.group(m.lastindex) for m in TOKEN.finditer(text) if m.lastindex]
        self.at = 0

    def next(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def take(self, *wanted):
        if self.next() in wanted and self.next():
            self.at += 1
            return self.tokens[self.at - 1]
        return ""

    def expect(self, sign):
        if not self.take(sign):
            raise NotAFormula(f"{sign} is missing")

    def sum(self):
        shown, strength = self.product()
        while sign := self.take("+", "-"):
            right, binds = self.product()
            right = fenced(right) if sign == "-" and binds == SUM else right
            shown, strength = row(shown, operator(sign.replace("-", "−")), right), SUM
        return shown, strength

    def product(self):
        shown, strength = self.signed()
        while sign := self.take("*", "/"):
            right, binds = self.signed()
            if sign == "/":
                shown, strength = f"<mfrac>{row(shown)}{row(right)}</mfrac>", PRODUCT
            else:
                left = fenced(shown) if strength == SUM else shown
                shown, strength = row(left, operator("·"), fenced(right) if binds in (SUM, SIGN) else right), PRODUCT
        return shown, strength

    def signed(self):
        if sign := self.take("-", "+"):
            shown, binds = self.signed()
            return row(operator(sign.replace("-", "−")), fenced(shown) if binds == SUM else shown), SIGN
        return self.power()

    def power(self):
        base, binds = self.primary()
        if not self.take("^"):
            return base, binds
        exponent, _ = self.signed()
        return f"<msup>{base if binds == ATOM else fenced(base)}{row(exponent)}</msup>", POWER

    def primary(self):
        if self.take("("):
            shown, binds = self.sum()
            self.expect(")")
            return shown, binds  # parentheses are put back where they are needed
        text = self.next()
        if not re.match(r"[\w.]", text):
            raise NotAFormula(f"a name or number is missing before '{text}'")
        self.at += 1
        if text[0].isdigit() or text[0] == ".":
            return number(text), ATOM if "e" not in text.lower() else PRODUCT
        if not self.take("("):
            return name(text), ATOM
        arguments = [self.sum()]
        while self.take(","):
            arguments.append(self.sum())
        self.expect(")")
        return call(text, arguments), PRODUCT if text == "sum" else ATOM

    def equation(self):
        sides = [self.sum()[0]]
        while self.take("="):
            sides.append(self.sum()[0])
        if self.next():
            raise NotAFormula(f"'{self.next()}' is left over")
        return sides


def equation(text):
    """One equation as a <math> element; what cannot be read stays as it is written."""
    try:
        sides = Parser(text).equation()
    except NotAFormula:
        return Markup("<code>") + escape(text) + Markup("</code>")
    return Markup(f'<math display="block">{row(operator("=").join(sides))}</math>')
