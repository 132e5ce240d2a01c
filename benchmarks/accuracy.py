"""Measure the error of every method of knot insertion against exact results: float64 in, Fractions beside them.

    python benchmarks/accuracy.py [--quick]      prints a table; the numbers go to benchmarks/accuracy.json

The error of a new point is taken relative to the largest of the n + 1 old points that it depends on, in units of 2^-53;
of a problem, the largest counts. Old points are random in [-1, 1]. Typical is the median over the problems of one kind.
"""

import argparse
import math
import statistics
import time
from fractions import Fraction

import numpy as np

import knotwork as kw
from knotwork.arithmetic import kernel
from knotwork.insertion import METHODS
from knotwork.insertion.methods.problem import Problem
from methods import keep, short

DEGREES = range(1, 8)
INTERVALS = 8


def even(rng):
    """Return spacings that are equal."""
    return np.ones(INTERVALS)


def random(rng):
    """Return spacings of one size."""
    return rng.uniform(0.1, 1, INTERVALS)


def ratios(rng):
    """Return spacings from 1 to 1e-8, all sizes alike."""
    return 10 ** rng.uniform(-8, 0, INTERVALS)


def clusters(rng):
    """Return spacings that are either 1 or 1e-6."""
    return np.where(rng.random(INTERVALS) < 0.6, 1e-6 * rng.uniform(0.5, 1, INTERVALS), 1)


def near_multiple(rng):
    """Return spacings of 1 and of a few units in the last place."""
    return np.where(rng.random(INTERVALS) < 0.5, 2.0**-48 * rng.integers(1, 9, INTERVALS), 1)


SPACINGS = {f.__name__.replace("_", " "): f for f in (even, random, ratios, clusters, near_multiple)}


def problem(rng, n, spacing):
    """Return the arguments of a `Problem`: clamped old knots, up to 40 new ones over all intervals or in one."""
    breaks = np.unique(np.concatenate([[0], np.cumsum(spacing(rng))]))
    t = np.concatenate([[breaks[0]] * n, breaks, [breaks[-1]] * n])
    new = np.zeros(0)
    while not len(new):
        m = int(rng.integers(4, 41))
        lo = rng.integers(0, len(breaks) - 1, 1 if rng.random() < 0.5 else m)  # one interval, or as many in any
        new = np.setdiff1d(breaks[lo] + (breaks[lo + 1] - breaks[lo]) * rng.random(m), t)
    return t, new, rng.uniform(-1, 1, (len(t) - n - 1, 1)), n


def errors(t, new, P, n):
    """Return the error of every method in units of 2^-53."""
    curve = kw.Spline(kw.SplineSpace(n, t), P)
    exactly = kw.Spline(curve.space.in_exact_arithmetic(), P.astype(object))
    true = kw.insert(exactly, new.astype(object)).coefficients[:, 0].tolist()
    problem = Problem(t, new, P, n)
    sizes = [abs(P[max(j - n, 0) : j + 1]).max() for j in problem.columns.tolist()]
    found = {}
    for name, method in METHODS.items():
        points = method.points(problem)[:, 0].tolist()
        off = [abs(float(Fraction(x) - y)) if math.isfinite(x) else math.inf for x, y in zip(points, true, strict=True)]
        found[name] = 2.0**53 * max(x / size for x, size in zip(off, sizes, strict=True))
    return found


def study(problems):
    """Yield spacing, degree, and by method the errors of so many problems."""
    for spacing, spaced in SPACINGS.items():
        for n in DEGREES:
            rng = np.random.default_rng(n)
            every = [errors(*problem(rng, n, spaced)) for _ in range(problems)]
            yield spacing, n, {name: [found[name] for found in every] for name in METHODS}


def main():
    """Run, print and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer problems")
    problems = 4 if parser.parse_args().quick else 100
    kernel.mode = "always"
    start, told = time.perf_counter(), []
    for spacing, n, found in study(problems):
        line = {name: [short(statistics.median(x)), short(max(x))] for name, x in found.items()}
        told.append({"spacing": spacing, "degree": n, "errors": line})
        groups = {"stable": [], "factored": []}
        for name, (_, worst) in line.items():
            groups["factored" if METHODS[name].form == "factored" else "stable"].append((worst, name))
        ends = "; ".join(
            f"{group}: {' … '.join(f'{worst:.3g} ({name})' for worst, name in (min(x), max(x)))}"
            for group, x in groups.items()
        )
        print(f"{spacing}, degree {n}: worst errors in 2^-53: {ends}", flush=True)
    keep("accuracy.json", told)
    print(f"{len(told) * problems} problems, {time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
