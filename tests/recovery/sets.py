"""Sets of readings with something in them that their scenario does not declare, or with nothing. Each is a folder
`scenario.toml`, `readings.csv`; what is true stands in a folder of its own."""
import json
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np

import jumping_rivals
import levers
import mills
import positioning
import proving_rings
import rods
import sockets
import spheres
from held_out import by_level, held_out
from noise import deviations, noise
from oracle import Oracle, power
from scenario_text import readings_csv, scenario_toml

SYSTEMS = {m.MODEL: m for m in (rods, mills, spheres, sockets)}
EXPRESSIONS = {m.MODEL: m.SYSTEM for m in (positioning, proving_rings, levers)}
NULLS = ("white", "ar03", "ar06", "t3", "outliers", "quantised", "clamp_declared", "clamp_undeclared")
STRENGTHS = (3, 5, 8, 15)
# Development seeds are below, judgement seeds from here on; no number is both.
JUDGEMENT = 1_000_000


def stream(seed, *words):
    return np.random.default_rng([seed, zlib.crc32("/".join(map(str, words)).encode())])


def kinds(system):
    """Everything there is but the nulls: (kind, what, strengths)."""
    yield from (("single", name) for name in system.SINGLES)
    yield from (("pair", pair) for pair in system.PAIRS)
    yield from (("alias", i) for i in range(len(system.ALIASES)))
    yield from (("outside", name) for name in system.OUTSIDE)
    yield ("scatter", "clamp")


def title(kind, what, strength, seed, noise_kind):
    """Of a set's folder; says nothing of what is in it but to who made it."""
    return f"{zlib.crc32(f'{kind}/{what}/{strength}/{noise_kind}'.encode()):08x}-{seed}"


def make(program, system, kind, what, strength, seed, noise_kind="white", floor=False, exact=False, **more):
    """One set: (design, readings um, truth).
    @param what: of kind `several`: ((name, strength), ...)
    @param floor: whether the truth says how well held-out readings can be predicted
    @param exact: whether it says which names the exact model cannot refuse, of sizes with which readings jump
    @param more: of the design"""
    rng = stream(seed, system.MODEL, kind, what, strength, noise_kind)
    alias = system.ALIASES[what] if kind == "alias" else None
    more = {**(alias[0] if alias else {}), **more}
    if noise_kind == "quantised":
        more.update(noise=0.3, resolution=1.0)  # um: mostly rounding
    if noise_kind == "clamp_declared":
        more.update(scatter=getattr(system, "CLAMP", 1.0))
    d = system.design(rng, **more)
    if noise_kind == "coarse":
        d = replace(d, resolution=2 * d.noise)
    q = np.array([c.value + (rng.uniform(-0.03, 0.03) * (c.step / 0.01) if c.free else c.u * rng.standard_normal()) for c in d.cells])
    if hasattr(system, "truth"):
        q = system.truth(d, q, rng)
    names = {"single": lambda: [what], "outside": lambda: [what], "pair": lambda: list(what), "several": lambda: [n for n, _ in what], "alias": lambda: [alias[1]],
             "null": list, "scatter": list}[kind]()
    d0 = Oracle(system, program, d, noise_kind) if names else None
    base = system.simulate(program, d, [q])[0]
    total, effects, moves = base.copy(), [], []
    for i, name in enumerate(names):
        # Of a pair the second is the weaker, half hidden by the first.
        wanted = what[i][1] if kind == "several" else strength if i == 0 else max(0.6 * strength, 4)
        one, truth = effect(program, system, d, d0, name, rng)
        size, shift = scaled(one, base, q, d0, wanted, alias)
        sign = rng.choice([-1, 1]) if truth["sign"] == "either" else 1
        if sign < 0:
            size, shift = -size, one(-size, q, base)
        total = total + shift
        moves.append(one.moves(size) if hasattr(one, "moves") else None)
        shift = size * one.smooth if hasattr(one, "smooth") else shift
        truth.update(sizes={n: size * part for n, part in getattr(one, "parts", {}).items()} or {truth["quantity"]: size})
        truth.update(size=size, strength=d0.strength(shift), depends_on=list(truth["depends_on"]), outside=name in system.OUTSIDE)
        effects.append((truth, shift))
    if len(moves) > 1 and all(moves):  # which insert triggers depends on all of them: changes by each alone do not add up
        steps, more = zip(*moves)
        total = system.simulate(program, d, [q + sum(steps)], [{k: v for one in more for k, v in one.items()}])[0]
    missing = total
    e = noise(noise_kind, rng, d.time, base.shape[1], deviations(noise_kind, d))
    if noise_kind.startswith("clamp") or kind == "scatter":
        sd = d.scatter or (strength / 8 if kind == "scatter" else 1) * 2 * d.noise
        total = total + system.leave(program, d, q, sd * rng.standard_normal(d.readings)[d.acts()]) - base
    y = total + e
    if d.resolution:
        y = d.resolution * np.round(y / d.resolution)
    truth = dict(system=system.MODEL, kind=kind, noise=noise_kind, seed=seed, nominal_strength=strength, readings=int(d.readings),
                 blocks=d.blocks, final=list(d.final), expected=expected(kind, alias, noise_kind), scatter=list(d.redone[0]), noise_um=float(d.noise))
    truth["effects"] = [judged(d0, t, shift, rng) for t, shift in effects]
    if exact and effects:
        at = jumping_rivals.Exact(system, program, d, q, base, d0, missing)
        for t, more in zip(truth["effects"], jumping_rivals.judge(at, [t for t, _ in effects], stream(seed, "rivals"))):
            t.update(more)
    if floor:
        truth["held_out_um"] = held_out(system, program, d, noise_kind, q, y, base, total, [
            by_level(d, t, shift) if name in system.OUTSIDE else shift.reshape(-1, 1) for name, (t, shift) in zip(names, effects)])
    return d, y, truth


def expected(kind, alias, noise_kind):
    if noise_kind == "clamp_undeclared":
        return "scatter"
    if kind == "null" or (alias and not alias[2]):
        return "nothing_found"
    return {"single": "named", "pair": "named", "several": "named", "alias": "class", "outside": "not_in_catalogue", "scatter": "scatter"}[kind]


def effect(program, system, d, oracle, name, rng):
    """(size, quantities, base) -> shift in um; and what is true of it."""
    if name.startswith("declared:"):
        title = name.removeprefix("declared:")
        if "*" in title:
            seen = {c.title: oracle.strength(oracle.by_cell[i]) for i, c in enumerate(d.cells)
                    if c.name == title.split("[")[0]}
            title = str(rng.choice([t for t, s in seen.items() if s > 0.3 * max(seen.values())]))
        at = [i for i, c in enumerate(d.cells) if c.title == title or (c.name == title and c.label)]
        cell = d.cells[at[0]]
        towards = getattr(system, "TOWARDS", {}).get(cell.name)

        def one(size, q, base):
            moved = q.copy()
            moved[at] += (towards or 1) * size
            truth.update(absolute=float(moved[at[0]]), off=float(moved[at[0]] - cell.value))
            return system.simulate(program, d, [moved])[0] - base

        def moves(size):
            return (towards or 1) * size * np.isin(np.arange(len(d.cells)), at), {}
        one.moves = moves
        truth = dict(name="declared:" + title, quantity=cell.name, unit=cell.unit, sign="+" if towards else "either",
                     depends_on=[cell.label] if cell.label else [])
        return one, truth
    make_shape, quantity, unit, depends = system.ADDED[name][:4]
    shape = make_shape(d, rng)
    if callable(shape):  # through the geometry: size -> quantities or readings anew
        one = lambda size, q, base: shape(program, size, q) - base
        if hasattr(shape, "smooth"):
            one.smooth = shape.smooth
        one.parts = getattr(shape, "parts", {})
        if hasattr(shape, "tilt"):
            one.moves = lambda size: (0.0, shape.tilt(size))
    else:
        one = lambda size, q, base: size * shape
    return one, dict(name=name.split(":")[0] if not name.startswith("stated:") else name.removeprefix("stated:"), quantity=quantity, unit=unit,
                     sign=system.ADDED[name][4] if len(system.ADDED[name]) > 4 else "either", depends_on=depends)


def scaled(one, base, q, oracle, strength, alias):
    """The size at which the effect has this strength; where nothing of it can be seen, one that would be plain to see."""
    if alias and not alias[2]:
        size = 6 * oracle.d.noise / np.abs(one(1.0, q, base)).max()
        return size, one(size, q, base)
    if hasattr(one, "smooth"):
        size = strength / oracle.strength(one.smooth)
        return size, one(size, q, base)
    size = 1e-3
    for _ in range(6):
        shift = one(size, q, base)
        seen = oracle.strength(shift)
        if abs(seen - strength) < 0.01 * strength:
            break
        size *= min(max(strength / seen, 1e-4), 1e4)
    return size, one(size, q, base)


def judged(oracle, truth, shift, rng):
    """What an oracle could say: its power alone and among the catalogue, and the rivals it could not refuse."""
    seen = truth["strength"]
    if seen < 1e-3:
        return {**truth, "strength": 0.0, "size": float(truth["size"]), "power_known": 0.05, "power_catalogue": 0.05, "twins": [],
                "unsplit": [], "rivals": {}}
    if truth["quantity"] and not truth["name"].startswith("declared:") and oracle.nearest(truth["name"], shift) is not None:
        # The truth is not quite of the catalogue's shape: its size there is that of the nearest.
        truth = {**truth, "made_with": float(truth["size"]), "size": oracle.nearest(truth["name"], shift)}
    rivals = oracle.rivals(shift)
    limit = oracle.threshold(rng)
    # A rival is refused when twice its log likelihood falls short by chi-square's 95 % point of one degree of freedom; where
    # nobody knows the truth's shape, when what it leaves would be found by itself.
    short = limit**2 if truth["outside"] else 3.84
    unsplit = [n for n, c in rivals.items() if n != truth["name"] and seen**2 * (1 - c * c) < short]
    return {**truth, "size": float(truth["size"]), "power_known": power(seen, 1.96), "power_catalogue": power(seen, limit),
            "threshold": limit, "twins": [n for n, c in rivals.items() if c > 0.98 and n != truth["name"]], "unsplit": unsplit,
            "rivals": {n: round(c, 4) for n, c in list(rivals.items())[:8]}}


def write(folder, sealed, name, d, y, truth, system):
    folder, sealed = Path(folder) / name, Path(sealed)
    folder.mkdir(parents=True, exist_ok=True)
    sealed.mkdir(parents=True, exist_ok=True)
    (folder / "readings.csv").write_text(readings_csv(d, y, system.OUTPUTS))
    (folder / "scenario.toml").write_text(scenario_toml(d, system))
    (sealed / f"{name}.json").write_text(json.dumps({"name": name, **truth}, indent=1) + "\n")
    return folder / "scenario.toml"
