"""Lines, shapes and labels of a picture as SVG; y points upwards, colours are those of the page."""
import math
import re

from markupsafe import escape

INK, QUIET, BLUE, ORANGE, PALE, LINE = (f"var(--{name})" for name in ("ink", "quiet", "blue", "orange", "body", "line"))
CHARACTER = 7.2  # width of a character of a label, as wide as any sans-serif font makes it


class Drawing:
    """Collects elements and the room that they need."""

    def __init__(self):
        self.elements, self.box = [], [math.inf, math.inf, -math.inf, -math.inf]

    def reach(self, *points):
        for x, y in points:
            self.box = [min(self.box[0], x), min(self.box[1], -y), max(self.box[2], x), max(self.box[3], -y)]

    def path(self, points, stroke=INK, fill="none", width=1.2, dash="", closed=False, tip=""):
        """`tip`: an arrow head at the "end" or at "both" ends."""
        self.reach(*points)
        d = "M" + "L".join(f"{x:.1f} {-y:.1f}" for x, y in points) + ("Z" if closed else "")
        self.elements.append(f'<path d="{d}" fill="{fill}" stroke="{stroke}" stroke-width="{width}" '
                             f'stroke-linejoin="round"{f" stroke-dasharray={chr(34)}{dash}{chr(34)}" if dash else ""}/>')
        for at, before in ([(points[-1], points[-2])] if tip else []) + ([(points[0], points[1])] if tip == "both" else []):
            self.head(at, math.atan2(at[1] - before[1], at[0] - before[0]), stroke)

    def head(self, at, angle, colour):
        ends = [(at[0] - 7 * math.cos(angle + s), at[1] - 7 * math.sin(angle + s)) for s in (0.38, -0.38)]
        d = "M" + "L".join(f"{x:.1f} {-y:.1f}" for x, y in (ends[0], at, ends[1])) + "Z"
        self.elements.append(f'<path d="{d}" fill="{colour}"/>')

    def circle(self, x, y, radius, stroke=INK, fill="none", width=1.2):
        self.reach((x - radius, y - radius), (x + radius, y + radius))
        self.elements.append(f'<circle cx="{x:.1f}" cy="{-y:.1f}" r="{radius:.1f}" fill="{fill}" stroke="{stroke}" '
                             f'stroke-width="{width}"/>')

    def arc(self, x, y, rx, ry, first, last, stroke=INK, width=1.2, tip="", dash=""):
        """Part of an ellipse, angles in degrees anticlockwise from the right."""
        steps = [math.radians(first + (last - first) * k / 40) for k in range(41)]
        self.path([(x + rx * math.cos(a), y + ry * math.sin(a)) for a in steps], stroke, width=width, tip=tip, dash=dash)

    def label(self, x, y, text, anchor="start", colour=INK, size=12, bold=False):
        wide = CHARACTER * size / 12 * len(re.sub("\u202f", "", text)) * (1.06 if bold else 1)
        left = {"start": x, "middle": x - wide / 2, "end": x - wide}[anchor]
        self.reach((left, y - 3), (left + wide, y + size))
        weight = ' font-weight="650"' if bold else ""
        self.elements.append(f'<text x="{x:.1f}" y="{-y:.1f}" text-anchor="{anchor}" fill="{colour}" '
                             f'font-size="{size}"{weight}>{escape(text)}</text>')

    def size(self, a, b, text, off=(0, 0), anchor="middle"):
        """A dimension between two points, its label next to the middle."""
        self.path([a, b], QUIET, width=0.9, tip="both")
        self.label((a[0] + b[0]) / 2 + off[0], (a[1] + b[1]) / 2 + off[1], text, anchor)

    def svg(self, title, width=None):
        room = 6
        x, y, right, bottom = self.box
        wide, high = right - x + 2 * room, bottom - y + 2 * room
        return (f'<svg class="picture" role="img" aria-label="{escape(title)}" viewBox="{x - room:.1f} {y - room:.1f} '
                f'{wide:.1f} {high:.1f}" style="max-width:{width or wide:.0f}px">' + "".join(self.elements) + "</svg>")


def magnified(*angles, visible=9.0):
    """By how much to enlarge angles (rad) so that one sees them: 1, 2, 5, 10, ... up to the angle `visible` in degrees."""
    largest = max(map(abs, angles), default=0)
    if largest < 1e-9:
        return 1
    return max([f for f in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if math.degrees(largest) * f <= visible] or [1])


def chord(fraction):
    """Height of a chord over the centre, in radii, that has this share of the disc above it."""
    low, high = -1.0, 1.0
    for _ in range(50):
        middle = (low + high) / 2
        above = (math.acos(middle) - middle * math.sqrt(1 - middle * middle)) / math.pi
        low, high = (middle, high) if above > fraction else (low, middle)
    return low
