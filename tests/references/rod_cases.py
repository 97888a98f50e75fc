"""The cases of rod_cases.csv: every corner of the rod-gauging solve, then random mixtures.

A case is the text of its numbers (so that they are exact decimals), in the order of rod_reference.COLUMNS.
"""

import random


def case(rod="5", fillet="0.03", elevation="90", azimuth="0", holder="0", yaw="0", pitch="0", beam="0.2",
         fraction="0.5", length="160"):
    return (rod, fillet, elevation, azimuth, holder, yaw, pitch, beam, fraction, length)


def cases():
    yield from thesis()
    yield from corners()
    yield from mixtures()
    yield from extremes()


def thesis():
    """Fang 2022, rods of Table 2.1 at the alignments of Tables 2.2 to 2.7, and with the angles exchanged."""
    rods = [("0", "90", "0", "133.702"), ("0.03", "90", "0", "133.702"), ("0.03", "89.922", "127.710", "160.591"),
            ("0.03", "88.041", "144.086", "179.822")]
    alignments = [("0", "0"), ("0.6241", "0.2836"), ("0.6240", "0.5729"), ("0.9424", "0.0911"), ("0.5729", "0.6240")]
    for yaw, pitch in alignments:
        for fillet, elevation, azimuth, length in rods:
            yield case(fillet=fillet, elevation=elevation, azimuth=azimuth, yaw=yaw, pitch=pitch, length=length)


def corners():
    tilted = dict(elevation="88.041", azimuth="144.086", yaw="0.6241", pitch="0.2836")
    yield case(holder="37.5", **tilted)  # the holder turns the bottom, the beam's yaw turns it back
    yield case(holder="-37.5", **tilted)
    yield case(elevation="88.041", azimuth="181.586", yaw="0.6241", pitch="0.2836")
    for pitch in ("0.0001", "-0.0001", "0.01", "-0.2836", "1e-9"):  # the kink at pitch 0
        yield case(fillet="0", pitch=pitch)
        yield case(pitch=pitch)
    for azimuth in ("0", "90", "180", "270", "359.999"):
        yield case(elevation="89", azimuth=azimuth, pitch="0.5")
    yield case(elevation="89", azimuth="180", pitch="1")  # the two tilts add up to a flat shadow
    yield case(elevation="89", azimuth="0", pitch="1")
    yield case(elevation="89", azimuth="180", pitch="-1")
    for elevation in ("90.5", "91", "100", "75", "60", "45", "30", "20"):
        yield case(elevation=elevation, azimuth="30", yaw="2", pitch="1")
        yield case(elevation=elevation, azimuth="95", yaw="-3", pitch="-2", fillet="0")
    for pitch in ("60", "-60", "30", "-30", "45"):
        yield case(pitch=pitch, elevation="85", azimuth="200", yaw="170")
        yield case(pitch=pitch, fillet="0")
    for fraction in ("0.001", "0.01", "0.1", "0.25", "0.75", "0.9", "0.99", "0.999"):
        yield case(fraction=fraction, **tilted)
    yield case(fraction="0.001", fillet="0")
    yield case(fraction="0.999", fillet="0")
    # tiny fillets, and fillets close to the rod's radius
    for fillet in ("1e-6", "1e-4", "1e-9", "4.9", "4.999", "4.999999", "5"):
        yield case(fillet=fillet, **tilted)
    yield case(fillet="1e-6", rod="0.15", **tilted)
    yield case(fillet="1e-6", rod="1", beam="2", **tilted)
    # ball ends
    for rod in ("0.25", "0.5", "3"):
        yield case(rod=rod, fillet=rod)
        yield case(rod=rod, fillet=rod, elevation="70", azimuth="10", yaw="5", pitch="-12", fraction="0.3")
    yield case(rod="0.19", fillet="0.19", fraction="0.6")
    yield case(rod="0.2", fillet="0.2", fraction="0.7", pitch="3")  # as wide as the beam
    yield case(rod="0.2", fillet="0", fraction="0.999", pitch="3")
    # thin pins: a strip of half-width k R_l covers at most (2/pi)(k sqrt(1 - k^2) + asin k) of the disc
    yield case(rod="0.05", fillet="0")  # 0.3150: never
    yield case(rod="0.05", fillet="0", fraction="0.316")
    yield case(rod="0.05", fillet="0.05", fraction="0.314")
    yield case(rod="0.05", fillet="0", fraction="0.314")
    yield case(rod="0.05", fillet="0.01", fraction="0.1", pitch="5", elevation="80", azimuth="60")
    yield case(rod="0.08", fillet="0.01")  # 0.4944: never
    yield case(rod="0.081", fillet="0.01")  # 0.5002
    yield case(rod="0.1", fillet="0")
    yield case(rod="0.1", fillet="0.1", pitch="1")
    yield case(rod="0.1", fillet="0.03", elevation="60", azimuth="100", yaw="10")
    yield case(rod="0.1", fillet="0.03", fraction="0.65")  # 0.6090: never
    yield case(rod="0.15", fillet="0.15", fraction="0.79")
    yield case(rod="0.15", fillet="0.02", pitch="-20", elevation="50", azimuth="170")
    yield case(rod="0.19", fillet="0.03", fraction="0.98")
    yield case(rod="0.19", fillet="0.03", fraction="0.99")
    # a beam wider than the rod
    yield case(rod="1", fillet="0.03", beam="2")
    yield case(rod="1", fillet="1", beam="2", pitch="10")
    yield case(rod="1", fillet="0.5", beam="2", elevation="70", azimuth="45", pitch="-10", fraction="0.6")
    yield case(rod="1", fillet="0.5", beam="2", fraction="0.7")  # 0.6090: never
    yield case(rod="1", fillet="0", beam="2", elevation="20", azimuth="91", fraction="0.2")
    yield case(rod="5", fillet="2.5", beam="6", elevation="40", azimuth="250", yaw="15", pitch="40", fraction="0.8")
    yield case(rod="5", fillet="0.03", beam="5", elevation="88", azimuth="3", pitch="0.1", fraction="0.9")


def mixtures():
    draw = random.Random(20220224)
    for _ in range(60):
        rod = round(draw.choice([draw.uniform(0.05, 0.6), draw.uniform(0.6, 8)]), 4)
        beam = round(draw.choice([0.2, draw.uniform(0.02, 0.5), draw.uniform(0.5, 3)]), 4)
        fillet = round(rod * draw.choice([0, 0.006, draw.random(), draw.random() ** 4]), 6)
        tilt = draw.choice([0.1, 2, 70])
        yield tuple(str(x) for x in (
            rod, fillet, round(90 - tilt * draw.uniform(-0.007, 1), 4), round(draw.uniform(-180, 360), 3),
            round(draw.uniform(-180, 180), 2), round(draw.uniform(-180, 180), 4),
            round(draw.choice([0.5, 5, 60]) * draw.uniform(-1, 1), 4), beam,
            round(draw.choice([0.5, draw.uniform(0.001, 0.999)]), 4), round(draw.uniform(50, 250), 3)))


def extremes():
    """Sizes and angles over many decades: near-flat and near-vertical bottoms, hair-thin beams, shares near 0 and 1."""
    draw = random.Random(20261121)
    for _ in range(50):
        rod = float(f"{10 ** draw.uniform(-2, 1.3):.5g}")
        fillet = rod * draw.choice([0, 1, 10 ** draw.uniform(-9, -1), 1 - 10 ** draw.uniform(-9, -1), draw.random()])
        elevation = draw.choice([90, 90 + draw.choice([-1, 1]) * 10 ** draw.uniform(-9, 0), draw.uniform(1, 179)])
        pitch = draw.choice([0, 10 ** draw.uniform(-9, 1), draw.uniform(-85, 85)])
        fraction = draw.choice([0.5, 10 ** draw.uniform(-6, -1), 1 - 10 ** draw.uniform(-6, -1), draw.uniform(0.01, 0.99)])
        yield tuple(str(x) for x in (
            rod, f"{min(fillet, rod):.12g}", f"{elevation:.12g}", round(draw.uniform(-180, 180), 3), 0,
            round(draw.uniform(-180, 180), 3), f"{pitch:.12g}", float(f"{10 ** draw.uniform(-2, 1):.5g}"),
            f"{fraction:.9g}", 150))
