"""What systems share whose model is an expression: their scenario's head, a seat that scatters, and candidates that are
stated as formulas, with shapes written anew here."""
import numpy as np

from shapes import along


def header(title, d, formula, conditions):
    terms = formula + "".join(f" + {more}" for name, more in (("seat", "seat"), ("fading", "fading * exp(-time / fade)"))
                              if name == "seat" and d.scatter or any(c.name == name for c in d.cells))
    text = "".join(f'{name} = {value}\n' for name, value in conditions.items())
    return f'schema = 1\ntitle  = "{title}"\n\n[model]\nname = "expression"\n\n[model.indications]\nd = "{terms}"\n\n[conditions]\n{text}'


def scatter_toml(d):
    """Declares what each act done anew leaves, a term of the formula."""
    return f'[quantities.seat]\nvalue = "0 um"\ncomponents = [ {{ distribution = "normal", u = "{d.scatter:g} um", per = "{d.redone[0][0]}" }} ]\n'


def added(candidates):
    """Entries of ADDED: (shape, quantity, unit, what it depends on). A candidate: (formula, unit, um of one unit, depends)."""
    entry = lambda of, unit, depends: (along(1.0)(lambda d, rng: of(d)), "size", unit, depends)
    return {f"stated:{name}": entry(of, unit, depends) for name, (_, unit, of, depends) in candidates.items()}


def own_catalogue(candidates, d):
    """What the oracle knows: (name, um of one unit)."""
    return [(name, of(d)[:, None]) for name, (_, _, of, _) in candidates.items()] if d.stated else []


def without(known, shape):
    """A shape in which nothing that has a name has a part, so that a name for it is wrong."""
    known = np.array(known, float).T
    return shape - known @ np.linalg.lstsq(known, shape, rcond=None)[0]


def stated_toml(candidates, d):
    blocks = [f'[stated_effects.{name}]\nformula = "{formula}"\nunit = "{unit}"\n' for name, (formula, unit, _, _) in candidates.items()]
    return "\n".join(blocks) if d.stated else ""
