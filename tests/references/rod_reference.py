#!/usr/bin/python3
"""Reference heights for the rod-gauging solve, to 1e-12 mm: writes rod_cases.csv.

    rod_reference.py            # needs python3-mpmath; the table is committed, the tests only read it

Method (on purpose not the engine's): the shadow's lower edge e(y) is solved point by point as the
infimal convolution of the shrunk body's lower edge with a disc of the fillet radius, the covered area
is an adaptive tanh-sinh quadrature in y, and the height is its root. Working precision 30 digits.

Geometry (Fang 2022, section 2.4): a rod is the half-infinite cylinder above its bottom plane, shrunk by
the fillet radius R_f and dilated by a ball of R_f, so its shadow is that of the shrunk body plus a disc.
With rho = R_r - R_f and g = yaw - holder_angle - bottom_azimuth, the edge of the shrunk body is
    E(t) = s0 t - A sqrt(1 - t^2/rho^2),  |t| <= rho,
    A = rho |sin(pitch) + cos(pitch) cot(elevation) cos(g)|,  s0 = cos(pitch) cot(elevation) sin(g),
at a height cos(pitch) (Z_d + R_f / sin(elevation)) above the beam's axis on the photodiode plane.
"""

import csv
import math
import pathlib

from mpmath import mp, mpf

mp.dps = 30
COLUMNS = ["rod_radius (mm)", "fillet_radius (mm)", "bottom_elevation (deg)", "bottom_azimuth (deg)",
           "holder_angle (deg)", "beam_yaw (deg)", "beam_pitch (deg)", "beam_radius (mm)",
           "trigger_fraction (1)", "rod_length (mm)"]
AREA_TOLERANCE = mpf(10) ** -18  # mm^2; the narrowest chord of the cases keeps heights below 1e-13 mm
STEP_TOLERANCE = mpf(10) ** -15  # mm, last Newton step of the height


class Edge:
    """Lower edge e(y) of the shadow on the photodiode plane, relative to the shrunk body's centre."""

    def __init__(self, rho, fillet, amplitude, slope):
        self.rho, self.fillet, self.slope = rho, fillet, slope
        self.amplitude = amplitude if amplitude > mpf(10) ** -24 else mpf(0)
        self.known = {}

    def __call__(self, y):
        if y not in self.known:
            self.known[y] = self.height(y)
        return self.known[y]

    def height(self, y):
        rho, fillet, slope, amplitude = self.rho, self.fillet, self.slope, self.amplitude
        if rho == 0:
            return -root(fillet * fillet - y * y)
        if fillet == 0:
            return slope * y - amplitude * root(1 - (y / rho) ** 2)
        if amplitude == 0:  # a straight edge between two arcs
            reach = fillet * slope / mp.sqrt(1 + slope * slope)
            t = max(-rho, min(rho, y - reach))
            return slope * t - root(fillet * fillet - (y - t) ** 2)
        if rho + fillet - abs(y) < mpf(10) ** -24:  # the flank
            return slope * rho * mp.sign(y)
        return self.offset_ellipse(y)

    def offset_ellipse(self, y):
        """Contact with t = rho tanh(s), where the edge has slope p = s0 + (A/rho) sinh(s)."""
        steep = self.amplitude / self.rho
        low, high = self.bracket(float(y))
        s, low, high = mpf((low + high) / 2), mpf(-140), mpf(140)
        for _ in range(200):
            e = mp.exp(s)
            sinh, cosh = (e - 1 / e) / 2, (e + 1 / e) / 2
            p = self.slope + steep * sinh
            q = mp.sqrt(1 + p * p)
            miss = self.rho * sinh / cosh + self.fillet * p / q - y
            step = miss / (self.rho / cosh**2 + self.fillet * steep * cosh / q**3)
            if abs(miss) * (1 + abs(p)) < mpf(10) ** -18:  # its square is what counts, see below
                break
            low, high = (s, high) if miss < 0 else (low, s)
            s = s - step if low < s - step < high else (low + high) / 2
        else:
            raise ArithmeticError(f"no contact at y = {y}")
        # the edge's own slope removes what is left of the miss
        return self.slope * self.rho * sinh / cosh - self.amplitude / cosh - self.fillet / q - p * miss

    def bracket(self, y):
        rho, fillet, slope = float(self.rho), float(self.fillet), float(self.slope)
        steep = float(self.amplitude) / rho
        low, high = -130.0, 130.0
        for _ in range(70):
            s = (low + high) / 2
            p = slope + steep * math.sinh(s)
            if rho * math.tanh(s) + fillet * p / math.hypot(1, p) < y:
                low = s
            else:
                high = s
        return low, high


def root(x):
    return mp.sqrt(x) if x > 0 else mpf(0)


def covered_area(edge, height, beam, reach, corners):
    """Area of the shadow inside the beam's disc, and the width over which its edge lies inside."""

    def gap(y):
        return root(beam * beam - y * y), edge(y) + height

    def depth(y):
        c, z = gap(y)
        return max(mpf(0), min(2 * c, c - z))

    # Kinks of the depth: where the edge meets the circle; tangencies missed here are small and adaptive.
    grid = sorted({reach * mp.sin(mp.pi / 2 * k / 200) for k in range(-200, 201)} | set(corners))
    points = list(grid)
    breaks = {-reach, reach} | set(corners)
    width = mpf(0)
    for a, b in zip(points, points[1:]):
        cuts = [a]
        for sign in (1, -1):
            fa, fb = (sign * c - z for c, z in (gap(a), gap(b)))
            if (fa > 0) != (fb > 0):
                cut = crossing(lambda y: sign * gap(y)[0] - gap(y)[1], a, b, fa)
                cuts.append(cut)
                breaks.add(cut)
        cuts = sorted(cuts) + [b]
        for left, right in zip(cuts, cuts[1:]):
            c, z = gap((left + right) / 2)
            if -c < z < c:
                width += right - left
    breaks = sorted(breaks)
    area = mpf(0)
    for a, b in zip(breaks, breaks[1:]):
        if b - a > mpf(10) ** -26:
            area += integral(depth, a, b, AREA_TOLERANCE)
    return area, width


def crossing(f, a, b, fa):
    """Illinois method."""
    fb, side = f(b), 0
    for _ in range(200):
        if b - a < mpf(10) ** -24 or fa == fb:
            break
        y = (a * fb - b * fa) / (fb - fa)
        if not a < y < b:
            y = (a + b) / 2
        fy = f(y)
        if abs(fy) < mpf(10) ** -24:
            return y
        if (fy > 0) == (fa > 0):
            a, fa, fb, side = y, fy, fb / 2 if side == 1 else fb, 1
        else:
            b, fb, fa, side = y, fy, fa / 2 if side == -1 else fa, -1
    return (a + b) / 2


def integral(f, a, b, tolerance, level=0):
    value, error = mp.quad(f, [a, b], error=True, maxdegree=5)
    if error < tolerance or level == 40:
        if error >= tolerance and b - a > mpf(10) ** -9:
            raise ArithmeticError(f"quadrature stalled on [{a}, {b}]: {error}")
        return value
    middle = (a + b) / 2
    return integral(f, a, middle, tolerance / 2, level + 1) + integral(f, middle, b, tolerance / 2, level + 1)


def sine(degrees):
    return mp.sinpi(degrees / 180)


def cosine(degrees):
    return mp.cospi(degrees / 180)


def strip_share(rod, beam):
    """The largest share that a rod of this radius can cover."""
    k = min(mpf(1), rod / beam)
    return 2 / mp.pi * (k * root(1 - k * k) + mp.asin(k))


def bottom_height(rod_radius, fillet_radius, bottom_elevation, bottom_azimuth, holder_angle, beam_yaw, beam_pitch,
                  beam_radius, trigger_fraction, rod_length=None):
    """(height of the bottom centre above the beam's axis in mm, status); angles deg, lengths mm."""
    rod, fillet, elevation, azimuth, holder, yaw, pitch, beam, fraction = (
        mpf(str(x)) for x in (rod_radius, fillet_radius, bottom_elevation, bottom_azimuth, holder_angle, beam_yaw,
                              beam_pitch, beam_radius, trigger_fraction))
    if fraction >= strip_share(rod, beam):
        return None, "never_covered"
    rho = rod - fillet
    cot = cosine(elevation) / sine(elevation)
    g = yaw - holder - azimuth
    edge = Edge(rho, fillet, rho * abs(sine(pitch) + cosine(pitch) * cot * cosine(g)), cosine(pitch) * cot * sine(g))

    reach = min(rod, beam)
    corners = {y for y in (-rho, rho) if abs(y) < reach}
    target = fraction * mp.pi * beam * beam
    # In double precision first: the midpoint rule and bisection.
    n = 400
    ys = [float(reach) * math.sin(math.pi * ((k + 0.5) / n - 0.5)) for k in range(n)]
    weights = [float(reach) * math.cos(math.pi * ((k + 0.5) / n - 0.5)) * math.pi / n for k in range(n)]
    strips = [(w, math.sqrt(max(0.0, float(beam) ** 2 - y * y)), float(edge(mpf(y)))) for y, w in zip(ys, weights)]
    low, high = -float(beam) - max(e for _, _, e in strips), float(beam) - min(e for _, _, e in strips)
    for _ in range(60):
        height = (low + high) / 2
        area = sum(w * max(0.0, min(2 * c, c - e - height)) for w, c, e in strips)
        low, high = (height, high) if area > target else (low, height)

    height, bracket = mpf(height), [mpf(low) - beam, mpf(high) + beam]
    for _ in range(30):
        area, width = covered_area(edge, height, beam, reach, corners)
        miss = area - target
        bracket[0 if miss > 0 else 1] = height
        step = miss / width if width > 0 else None
        if step is not None and abs(step) < STEP_TOLERANCE:
            break
        if step is None or not bracket[0] < height + step < bracket[1]:
            height = sum(bracket) / 2
        else:
            height += step
    else:
        raise ArithmeticError("height did not converge")
    return (height + step) / cosine(pitch) - fillet / sine(elevation), "ok"


def main():
    from rod_cases import cases

    path = pathlib.Path(__file__).with_name("rod_cases.csv")
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS + ["bottom_height (mm)", "status"])
        for case in cases():
            height, status = bottom_height(*case)
            text = "" if height is None else mp.nstr(height + 0, 40, strip_zeros=False)
            if height is not None:
                text = format_fixed(height, 15)
            table.writerow([*case, text, status])
            file.flush()


def format_fixed(x, decimals):
    scaled = int(mp.nint(abs(x) * mpf(10) ** decimals))
    sign = "-" if x < 0 and scaled else ""
    return f"{sign}{scaled // 10**decimals}.{scaled % 10**decimals:0{decimals}d}"


if __name__ == "__main__":
    main()
