"""What the page of a volume is filled with: slices, the largest error, where, and what causes it."""
import math
import types

import markupsafe
import numpy as np

from . import volume_figures
from .rounding import after, decimals, finer, fixed, percent, significant, unit_text
from .tables import commands, spread

LISTED = 20


class Grid:
    """The points of the map as arrays over its axes, in a unit that suits the largest error."""

    def __init__(self, v):
        self.axes = v.axes
        self.shape = tuple(int(a.points) for a in v.axes)
        self.commands = [np.array(commands(a)) for a in v.axes]
        largest = max((p.length for p in v.points), default=0.0)
        self.units, factor = finer("mm", 1e3 * largest)
        self.unit, self.factor = unit_text(self.units), 1e3 * factor
        column = lambda name: self.factor * np.array([getattr(p, name) for p in v.points]).reshape(self.shape)
        self.length, self.u_length = column("length"), column("u_length")
        self.error = {c: column(f"error_{c.lower()}") for c in "XYZ"}
        # Slices lie across the axis with the fewest points; of two axes there is one plane.
        self.cut = int(np.argmin(self.shape)) if len(self.shape) == 3 else None
        self.plane = [k for k in range(len(self.shape)) if k != self.cut]

    def at(self, values, k):
        return values if k is None else np.take(values, k, axis=self.cut)

    def arrows(self):
        """Components of the error in the plane, where the axes of the plane are slides."""
        names = [self.axes[k].name[:1] for k in self.plane]
        return [self.error[n] for n in names] if all(n in self.error for n in names) else None

    def text(self, metres, u=None):
        """A length to the place that its u, or itself, asks for."""
        places = decimals(self.factor * (u or abs(metres)))
        return fixed(self.factor * metres, places) if places is not None else "0"

    def place(self, point):
        index = np.unravel_index(point, self.shape)
        return ", ".join(f"{a.name} {c[i]:g}{after(a.display_units)}" for a, c, i in zip(self.axes, self.commands, index))


def number(row, value, u):
    """A quantity to the place of its standard uncertainty, or with four digits if it has none."""
    places = decimals(spread(row, u))
    return f"{spread(row, value):.4g}".replace("-", "−") if places is None else fixed(spread(row, value), places)


def contents(r):
    v = r.volume
    grid = Grid(v)
    worst, unsure = v.points[int(v.largest)], v.points[int(v.largest_u)]
    causes = [types.SimpleNamespace(name=s.name, unit=unit_text(s.display_units), value=number(s, s.value, s.standard_uncertainty), u=significant(spread(s, s.standard_uncertainty)),
                                    error=grid.text(s.error, worst.u_length if worst.u_length > 0 else None), share=percent(s.share))
              for s in v.shares[:LISTED]]
    return dict(
        kicker="Errors over the working volume", title=r.title or r.model, v=v, unit=grid.unit, causes=causes,
        more=len(v.shares) - len(causes), statement=v.statement, place=grid.place(int(v.largest)), unsure_place=grid.place(int(v.largest_u)),
        worst=types.SimpleNamespace(length=grid.text(worst.length, worst.u_length), u=grid.text(worst.u_length),
                                    parts=[(c, grid.text(getattr(worst, f"error_{c.lower()}"), getattr(worst, f"u_{c.lower()}")),
                                            grid.text(getattr(worst, f"u_{c.lower()}"))) for c in "XYZ"]),
        unsure=grid.text(unsure.u_length),
        mean=grid.text(math.fsum(p.length for p in v.points) / len(v.points), worst.u_length),
        figures=[(markupsafe.Markup(figure), caption) for figure, caption in volume_figures.maps(grid)])
