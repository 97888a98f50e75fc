"""Tables, numbers and filled paragraphs of sphere_calibration.md."""

import textwrap

from sphere_study import UNIT

DECIMALS = {"mm": 4, "deg": 5}


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
    return lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows] + [""]


def plain(text):
    """Without the sign of a zero."""
    return text[1:] if text.startswith("-") and not text.strip("-0.") else text


def wrapped(lines):
    """Paragraphs and bullets filled to 118 columns; tables, headings, pictures and anchors as they are."""
    out, block = [], []
    for line in [*lines, ""]:
        if block and (not line or line[0] in "|#!<" or line.startswith("- ")):
            indent = "  " if block[0].startswith("- ") else ""
            out += textwrap.wrap(" ".join(block), 118, subsequent_indent=indent, break_long_words=False,
                                 break_on_hyphens=False)
            block = []
        if not line or line[0] in "|#!<":
            out.append(line)
        else:
            block.append(line)
    return out


def show(name, value, more=0):
    return plain(f"{value:.{DECIMALS[UNIT[name]] + more}f}")


def um(x, decimals=1):
    return plain(f"{x:.{decimals}f}")
