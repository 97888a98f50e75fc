"""The trigger as Fang 2022, section 3.4.2, finds it: cutting edge and beam as polygons, time in steps. Shares no line
with the engine. A polygon of many vertices with a short step comes to the exact trigger; few and long to the printed one.

The flank is left out: the engine's heights do not change without it (tools.py says by how much)."""

import numpy as np


def cutting_edge(radius, tool_radius, radial_angle, axial_angle, vertices):
    """Polygon on the rake circle in the tool's frame, eqs 3.1 and 3.3."""
    a = 2 * np.pi * np.arange(vertices) / vertices
    x, z = radius * (np.cos(a) - 1), radius * (1 - np.sin(a))
    y, z = np.sin(axial_angle) * z, np.cos(axial_angle) * z
    c, s = np.cos(radial_angle), np.sin(radial_angle)
    return c * x + s * y + tool_radius, c * y - s * x, z


def clipped(polygon, p, q):
    """The part of a polygon to the left of the line from p to q."""
    side = (q[0] - p[0]) * (polygon[:, 1] - p[1]) - (q[1] - p[1]) * (polygon[:, 0] - p[0])
    after = np.roll(side, -1)
    kept, crossed = side >= 0, (side >= 0) != (after >= 0)
    share = np.where(crossed, side / np.where(crossed, side - after, 1), 0)
    crossing = polygon + share[:, None] * (np.roll(polygon, -1, axis=0) - polygon)
    return np.stack([polygon, crossing], axis=1)[np.column_stack([kept, crossed])]


def area(polygon):
    """Eq. 3.37."""
    y, z = polygon.T
    return 0.5 * np.sum(y * np.roll(z, -1) - z * np.roll(y, -1))


def covered(edge, angle, offset, height, beam, beam_radius):
    x, y, z = edge
    shadow = np.column_stack([np.sin(angle) * x + np.cos(angle) * y - offset, z + height])
    if area(shadow) < 0:
        shadow = shadow[::-1]
    b = beam_radius
    for p, q in (((-b, -b), (b, -b)), ((b, -b), (b, b)), ((b, b), (-b, b)), ((-b, b), (-b, -b))):
        shadow = clipped(shadow, p, q)
        if len(shadow) < 3:
            return 0.0
    common = beam
    for p, q in zip(shadow, np.roll(shadow, -1, axis=0)):
        if np.hypot(*(q - p)) > 1e-12:
            common = clipped(common, p, q)
        if len(common) < 3:
            return 0.0
    return area(common)


def trigger_height(tool, start_angle, vertices, step, beam_vertices=1000):
    """Height of the tool's centre, mm, at the first step that finds half of the beam covered; step in s, angle in deg."""
    t = {name.split(" ")[0]: value for name, value in tool.items()}
    n, b = t["inserts"], t["beam_radius"]
    edge = cutting_edge(t["insert_radius"], t["tool_radius"], np.radians(t["insert_radial_angle"]),
                        np.radians(t["insert_axial_angle"]), vertices)
    turn = 2 * np.pi * np.arange(beam_vertices) / beam_vertices
    beam = b * np.column_stack([np.cos(turn), np.sin(turn)])
    i = 0
    while True:
        height = t["start_height"] - t["feed"] / 60 * step * i
        turned = np.radians(start_angle + t["holder_angle"]) + 2 * np.pi * t["spindle_speed"] / 60 * step * i
        for k in range(n):
            angle = turned + 2 * np.pi * k / n
            # Within 32 deg of square to the beam; elsewhere these inserts miss it or are far above it.
            if np.sin(angle) > 0.85 and covered(edge, angle, t["offset"], height + t[f"wear_{k + 1}"], beam, b) \
                    > 0.5 * np.pi * b**2:
                return height
        i += 1
