"""Which names a mill's readings cannot refuse, by the exact model: where readings jump with a size, no signature stands for it.

A tilt raises the inserts as one cosine over them, so that with run-out and one lower insert any other insert may be the one: four
inserts differ by three heights. Sizes are sought at random from far to near; the least squares found are those that a rival leaves
at most, so that a name is excused only where sizes were found that explain the truth."""
import numpy as np

TILT = ("tool_runout.tilt_x (mrad)", "tool_runout.tilt_y (mrad)")
SIZES = {"tool_runout": TILT, **{f"declared:wear_{k}": (f"wear_{k} (mm)",) for k in (1, 2, 3, 4)}}
RADIUS = 10.0    # mm, of the tool: the inserts are 10 um higher by 1 mrad
FIRST, TRIES, BATCHES, CHAINS = 100, 24, 12, 2
SHORT = 3.84     # chi-square's 95 % point of one degree of freedom


def heights(name, sizes):
    """mm by which each insert is lower than its neighbours' mean, of these sizes."""
    if name == "tool_runout":
        return 1e-3 * RADIUS * (np.array([[0, -1], [1, 0], [0, 1], [-1, 0]]) @ sizes)
    return np.eye(4)[int(name[-1]) - 1] * sizes[0]


class Exact:
    def __init__(self, system, program, d, q, base, oracle, total):
        self.system, self.program, self.d, self.q, self.base, self.oracle = system, program, d, q, base[:, 0], oracle
        self.training = d.training()
        self.trained = d.only(self.training)
        self.target = total - base
        self.reach = 2e-3 * float(np.abs(self.target - np.median(self.target)).max())  # mm

    def read(self, keys, sizes):
        """um: readings (n, readings) of n rows of sizes; those held out stay as they are."""
        at = {c.name: i for i, c in enumerate(self.d.cells) if not c.label}
        vectors, extra = [], []
        for row in sizes:
            q, more = self.q.copy(), {}
            for key, x in zip(keys, row):
                name = key.split(" ")[0]
                if name in at:
                    q[at[name]] += x
                else:
                    more[key] = x
            vectors.append(q)
            extra.append(more)
        out = np.tile(self.base, (len(sizes), 1))
        out[:, self.training] = self.system.simulate(self.program, self.trained, vectors, extra)[:, :, 0]
        return out

    def left(self, keys, sizes):
        """Squares, in units of the noise, that these sizes leave of the truth."""
        moved = self.read(keys, sizes) - self.base
        return (self.oracle.projected((self.target[:, :1] - moved.T))**2).sum(axis=0)

    def least(self, names, starts, rng):
        """The least squares that these effects together leave, at their best sizes."""
        keys = [k for n in names for k in SIZES[n]]
        if not keys:
            return float((self.oracle.projected(self.target)**2).sum())
        scale = np.array([self.reach * (1e3 / RADIUS if "mrad" in k else 1) for k in keys])
        tried = np.vstack([*starts, scale * rng.uniform(-1, 1, (FIRST * len(keys), len(keys)))])
        left = self.left(keys, tried)
        chains = np.argsort(left)[:CHAINS]
        best, least, share = tried[chains], left[chains], np.full(len(chains), 0.1)
        for _ in range(BATCHES):  # all chains in one call of the program
            near = best[:, None] + share[:, None, None] * scale * rng.standard_normal((len(chains), TRIES, len(keys)))
            of = self.left(keys, near.reshape(-1, len(keys))).reshape(len(chains), TRIES)
            for c, k in enumerate(of.argmin(axis=1)):
                if of[c, k] < least[c] * (1 - 1e-6):
                    best[c], least[c] = near[c, k], of[c, k]
                else:
                    share[c] *= 0.5
        return float(least.min())

    def alike(self, names, sizes):
        """Sizes of these effects that give the inserts the heights of the truth, as far as they can."""
        true = sum((heights(n, x) for n, x in sizes), np.zeros(4))
        columns = [heights(n, e) for n in names for e in np.eye(len(SIZES[n]))] + [np.ones(4)]
        return np.linalg.lstsq(np.array(columns).T, true, rcond=1e-9)[0][None, :-1]


def sizes_of(system, truth):
    """Of a truth that is among these, in their units."""
    if truth["name"] == "tool_runout":
        return np.array([truth["sizes"]["tilt_x"], truth["sizes"]["tilt_y"]])
    return np.array([getattr(system, "TOWARDS", {}).get(truth["quantity"], 1) * truth["size"]])


def judge(exact, truths, rng):
    """By effect: `beside`, the root of the squares that all others leave without it, and `unsplit_exact`, the names that, with
    all others at their best sizes, fall short of the truth by less than chance."""
    if not all(t["name"] in SIZES for t in truths):
        return [{} for _ in truths]
    out = []
    true = [(t["name"], sizes_of(exact.system, t)) for t in truths]
    for i, t in enumerate(truths):
        others = [u["name"] for j, u in enumerate(truths) if j != i]
        left = lambda names: exact.least(names, [exact.alike(names, true)] if names else [], rng)
        rivals = {n: left([*others, n]) for n in SIZES if n not in others and n != t["name"]}
        out.append(dict(beside=left(others)**0.5, exact_rivals={n: round(x, 1) for n, x in rivals.items()},
                        unsplit_exact=[n for n, x in rivals.items() if x < SHORT]))
    return out
