#!/usr/bin/env python3
"""The peers' side of scripts/bench: peers.py openturns|numpy additive|gauge|ishigami|sobol SAMPLES

Draws, evaluates and summarises (mean, standard deviation, coverage interval); sobol: first-order and total indices of the
g function of ten inputs. Prints the seconds from sampling to the end, imports not counted. Exit code 3: not installed.

The problems are JCGM 101:2008, 9.2.3 and 9.5, Ishigami's function, and Sobol's g function; a curvilinear trapezoid is two
rectangular quantities (6.4.3.4). The files next to this one state the same for gumshoe.
"""
import math
import sys
import time

PI, ROOT3 = math.pi, math.sqrt(3.0)
RECTANGULAR = ("R", 0.0, 1.0)
TRAPEZOID = "({low} - {d} + 2 * {d} * {r} + (2 * {d} - 2 * {low} - 4 * {d} * {r}) * {s})"  # over +-|low|, ends known to d
A = [0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0, 99.0, 99.0]
DALPHA = TRAPEZOID.format(low="(-1e-6)", d="1e-7", r="r1", s="r2")
DTHETA = TRAPEZOID.format(low="(-0.05)", d="0.025", r="r3", s="r4")
PROBLEMS = {  # inputs, formula, coverage probability
    "additive": ({f"x{i}": ("R", -ROOT3, ROOT3) for i in range(1, 5)}, "x1 + x2 + x3 + x4", 0.95),
    "gauge": ({"ls": ("T", 50000623.0, 25.0, 18), "d0": ("T", 215.0, 6.0, 24), "d1": ("T", 0.0, 4.0, 5),
               "d2": ("T", 0.0, 7.0, 8), "als": ("R", 9.5e-6, 13.5e-6), "th0": ("N", -0.1, 0.2), "dl": ("U", -0.5, 0.5),
               "r1": RECTANGULAR, "r2": RECTANGULAR, "r3": RECTANGULAR, "r4": RECTANGULAR},
              f"ls + d0 + d1 + d2 - ls * ({DALPHA} * (th0 + dl) + als * {DTHETA}) - 50000000", 0.99),
    "ishigami": ({f"x{i}": ("R", -PI, PI) for i in range(1, 4)}, "sin(x1) + 7 * sin(x2)^2 + 0.1 * x3^4 * sin(x1)", 0.95),
    "sobol": ({f"x{i}": RECTANGULAR for i in range(10)},
              " * ".join(f"((abs(4 * x{i} - 2) + {a}) / (1 + {a}))" for i, a in enumerate(A)), 0.95),
}


def openturns(problem, n):
    import openturns as ot
    laws = {"R": ot.Uniform, "N": ot.Normal, "U": ot.Arcsine, "T": lambda mean, s, nu: ot.Student(float(nu), mean, s)}
    inputs, formula, p = PROBLEMS[problem]
    joint = ot.ComposedDistribution([laws[kind](*rest) for kind, *rest in inputs.values()])
    function = ot.SymbolicFunction(list(inputs), [formula])
    began = time.perf_counter()
    if problem == "sobol":
        x = ot.SobolIndicesExperiment(joint, n, False).generate()
        indices = ot.SaltelliSensitivityAlgorithm(x, function(x), n)
        indices.getFirstOrderIndices(), indices.getTotalOrderIndices()
    else:
        y = function(joint.getSample(n))
        y.computeMean(), y.computeStandardDeviation()
        y.computeQuantilePerComponent([(1 - p) / 2, (1 + p) / 2])
    return time.perf_counter() - began


def numpy(problem, n):
    import numpy as np
    generator = np.random.default_rng(1)
    laws = {"R": generator.uniform, "N": generator.normal,
            "T": lambda mean, s, nu, size: mean + s * generator.standard_t(nu, size),
            "U": lambda a, b, size: 0.5 * (a + b) + 0.5 * (b - a) * np.sin(2 * PI * generator.random(size))}
    inputs, formula, p = PROBLEMS[problem]
    code = compile(formula.replace("^", "**").replace("x3**4", "(x3 * x3) * (x3 * x3)"), problem, "eval")
    names = {"sin": np.sin, "abs": np.abs}

    def draw():
        return {name: laws[kind](*rest, size=n) for name, (kind, *rest) in inputs.items()}

    def evaluate(x):
        return eval(code, names, x)
    began = time.perf_counter()
    if problem == "sobol":
        a, b = draw(), draw()
        at_a, at_b = evaluate(a), evaluate(b)
        mean, variance = 0.5 * (at_a.mean() + at_b.mean()), np.concatenate([at_a, at_b]).var()
        for name in inputs:
            at_c = evaluate({**a, name: b[name]})
            np.mean((at_b - mean) * (at_c - at_a)) / variance, 0.5 * np.mean((at_a - at_c) ** 2) / variance
    else:
        y = evaluate(draw())
        y.mean(), y.std(ddof=1), np.quantile(y, [(1 - p) / 2, (1 + p) / 2])
    return time.perf_counter() - began


try:
    print({"openturns": openturns, "numpy": numpy}[sys.argv[1]](sys.argv[2], int(float(sys.argv[3]))))
except ModuleNotFoundError as missing:
    sys.exit(3 if missing.name == sys.argv[1] else str(missing))
