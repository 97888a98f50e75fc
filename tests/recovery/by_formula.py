"""What systems share whose model is an expression: their scenario's head, a seat that scatters, and candidates that are
stated as formulas, with shapes written anew here."""
import numpy as np

from shapes import along


class System:
    """What `sets` asks of a system. `added`: name to (shape, what it depends on) of what no candidate states."""
    OUTPUTS = ("d",)
    ALIASES = ()
    CATALOGUE = []

    def __init__(self, model, design, simulate, title, formula, conditions, candidates, added, pair, declared=()):
        """@param candidates: name to (formula, unit, um of one unit, depends)"""
        self.MODEL, self.design, self.simulate = model, design, simulate
        self.title, self.formula, self.conditions, self.candidates = title, formula, conditions, candidates
        entry = lambda of, unit, depends: (along(1.0)(lambda d, rng: of(d)), "size", unit, depends)
        stated = {f"stated:{name}": entry(of, unit, depends) for name, (_, unit, of, depends) in candidates.items()}
        self.ADDED = stated | {name: (along(1.0)(shape), None, None, depends) for name, (shape, depends) in added.items()}
        self.SINGLES = (*stated, *(f"declared:{name}" for name in declared))
        self.PAIRS = (tuple(f"stated:{name}" for name in pair),)
        self.OUTSIDE = tuple(added)

    def header(self, d):
        more = (("seat", "seat"), ("fading", "fading * exp(-time / fade)"))
        terms = self.formula + "".join(f" + {term}" for name, term in more
                                       if name == "seat" and d.scatter or any(c.name == name for c in d.cells))
        text = "".join(f"{name} = {value}\n" for name, value in self.conditions.items())
        return (f'schema = 1\ntitle  = "{self.title}"\n\n[model]\nname = "expression"\n\n[model.indications]\n'
                f'd = "{terms}"\n\n[conditions]\n{text}')

    def scatter_toml(self, d):
        """Declares what each act done anew leaves, a term of the formula."""
        return f'[quantities.seat]\nvalue = "0 um"\ncomponents = [ {{ distribution = "normal", u = "{d.scatter:g} um", per = "{d.redone[0][0]}" }} ]\n'

    def own_catalogue(self, d):
        """What the oracle knows: (name, um of one unit)."""
        return [(name, of(d)[:, None]) for name, (_, _, of, _) in self.candidates.items()] if d.stated else []

    def stated(self, d):
        blocks = [f'[stated_effects.{name}]\nformula = "{formula}"\nunit = "{unit}"\n' for name, (formula, unit, _, _) in self.candidates.items()]
        return "\n".join(blocks) if d.stated else ""

    def leave(self, program, d, q, left):
        """Readings with what each act done anew left (um, by reading)."""
        return self.simulate(program, d, [q])[0] + left[:, None]


def without(known, shape):
    """A shape in which nothing that has a name has a part, so that a name for it is wrong."""
    known = np.array(known, float).T
    return shape - known @ np.linalg.lstsq(known, shape, rcond=None)[0]
