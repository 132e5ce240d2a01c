"""Periods whose knots lie close together: refused when made, or right against exact arithmetic on the same floats.

As a program it runs a campaign, with every kernel's indices checked if Numba is told so:

    NUMBA_BOUNDSCHECK=1 python tests/test_periodic.py 300000 [first block]

Blocks of a thousand cases, each with its own seed, are shared among all cores. Rational numbers are gmpy2's where it is
installed, which takes half the time.
"""

from __future__ import annotations

import fractions
import importlib
import importlib.util
import math
import multiprocessing
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import knotwork as kw
import oracle
from knotwork import Spline, SplineSpace
from knotwork.errors import KnotError
from knotwork.unrolled import reach

RATIONAL: type[Any] = importlib.import_module("gmpy2").mpq if importlib.util.find_spec("gmpy2") else fractions.Fraction
EPS = np.finfo(float).eps
B = -1.4682183816953924
C = math.nextafter(B, -9)

#: (degree, knots) that floats cannot continue around the seam
TOO_CLOSE = [
    (3, [-2.0, -1.9999999999999998, -1.9999999999999998, -1.9999999999999996]),
    (5, [-2.0] * 5 + [-1.9999999999999998]),
    (4, [-1, -0.998046875] + [524287.001953125] * 5 + [524287.0019533634]),
    (1, [-5, -5, -4.036425150074862, -3.2141400349250335, -3.2141400349250335, -3.214140034925033]),
    (3, [-4] * 4 + [-2.9, -2.0000000000000004, -2.0000000000000004, -2]),
    (5, [-2] * 6 + [-1.9] + [C] * 6 + [B]),
]


@pytest.mark.parametrize(("degree", "knots"), TOO_CLOSE)
def test_knots_too_close_for_a_seam_are_refused_with_what_would_do(degree, knots):
    with pytest.raises(KnotError, match=r"around the seam.* at least \d.* between them, or exact") as refused:
        SplineSpace(degree, knots, periodic=True)
    least = float(str(refused.value).split("at least ")[1].split()[0])
    values, copies = np.unique(knots, return_counts=True)
    wider = values[0] + np.append(0, np.cumsum(np.maximum(np.diff(values), 1.01 * least)))
    SplineSpace(degree, np.repeat(wider, copies), periodic=True)


@pytest.mark.parametrize(("degree", "knots"), TOO_CLOSE)
def test_exact_knots_go_on_at_any_distance(degree, knots):
    check(SplineSpace(degree, oracle.fractions(knots), periodic=True), np.random.default_rng(1))


def test_a_new_knot_too_close_is_refused():
    c = kw.curve(np.arange(8.0).reshape(4, 2) ** 2, 3, [0, 1, 2, 3, 4], periodic=True)
    near = math.nextafter(1, 2)
    for work in (
        lambda: kw.insert(c, near),
        lambda: kw.insert(c, [2.5, near]),
        lambda: kw.insert(c, [2.5, math.nextafter(2.5, 3)]),
        lambda: kw.insert(c, near, method="boehm"),
        lambda: c.space.with_knots([near]),
        lambda: c.space | c.space.with_knots(1.5) | SplineSpace(3, [0, 1, near, 2, 3, 4], periodic=True),
    ):
        with pytest.raises(KnotError, match="around the seam"):
            work()
    left, right = kw.split(c, near)  # what is cut open has no seam
    assert left.space.domain == (0, near)
    assert right.space.domain == (near, 4)


def test_a_reduced_period_can_be_made_again():
    """With fewer knots the period reaches farther around the seam, and knots may then be too close for floats."""
    knots = [1, 1, 1.00146484375, 1.00146484375, 1.0014649033546448, 1.001464907079935, 1.001464907079935]
    space = SplineSpace(1, [*knots, 1.017089907079935, *[1.017150942236185] * 2, 5.017150942236185], periodic=True)
    for c in ([-1, 0, 5, 9, -9, -7, 6, 9, -5, -4], [8, 4, 4, 6, -5, -3, -6, -9, -1, 1]):
        left = kw.reduce(Spline(space, np.array(c)[:, None] / 8), 0.5).spline.space
        assert SplineSpace(1, left.knots, periodic=True) == left


def rationals(values: np.ndarray) -> np.ndarray:
    """Return the array with each number as a rational of the same value: gmpy2's or a Fraction."""
    result = np.empty(values.shape, object)
    result.reshape(-1)[:] = [
        x if isinstance(x, RATIONAL) else RATIONAL(*x.as_integer_ratio()) for x in values.reshape(-1).tolist()
    ]
    return result


# ---- random periods -------------------------------------------------------------------------------------------------


def spaces(rng: np.random.Generator) -> Iterator[SplineSpace]:
    """Yield spaces of a period whose distances between knots reach over all orders of size, down to few roundings."""
    while True:
        n = int(rng.integers(0, 6))
        count = int(rng.integers(1, 7))
        start = float(rng.choice([0, -1, -2, 1, 1e6, -1e6, rng.standard_normal()]))
        gaps = 2.0 ** rng.integers(-53, 3, count) * rng.integers(1, 5, count)
        if rng.random() < 0.6:
            gaps = np.maximum(gaps, 2.0 ** -int(rng.integers(4, 30)))
        x = start + np.append(0, np.cumsum(gaps * max(1, abs(start))))
        if (x[1:] == x[:-1]).any():
            continue
        copies = np.append(rng.integers(1, n + 2, count) if rng.random() < 0.5 else np.ones(count, int), 1)
        try:
            yield SplineSpace(n, np.repeat(x, copies), periodic=True)
        except KnotError as error:
            assert "around the seam" in str(error)  # noqa: PT017 - the only reason there is


def check(space: SplineSpace, rng: np.random.Generator) -> None:
    """Assert that insertion, Bézier pieces, values and the integral are right, and that nothing else fails."""
    f = Spline(space, rng.integers(-9, 10, (space.dimension, 1)) / 2.0**3)
    exact_space = SplineSpace.trusted(space.degree, rationals(space.knots), periodic=True)
    exact = Spline(exact_space, rationals(f.coefficients))
    a, b = space.domain
    x = space.breaks.tolist()
    places = [x[i] + (x[i + 1] - x[i]) * int(rng.integers(0, 9)) / 8 for i in rng.integers(0, len(x) - 1, 3)]
    new = [u for u in dict.fromkeys(places) if u < b and space.multiplicity(u) <= space.degree]
    try:
        finer = space.with_knots(new)
    except KnotError as error:
        assert "around the seam" in str(error)  # noqa: PT017
        finer, new = space, []
    bound = allowed(finer)
    refined = kw.insert(f, new)
    near(refined.coefficients, kw.insert(exact, new).coefficients, bound)
    near(kw.insertion_matrix(space, finer) @ f.coefficients, refined.coefficients, bound)
    near(kw.to_bezier(f)[0], kw.to_bezier(exact)[0], bound)
    near(f(places), exact(places), bound)
    near(kw.clamp(f).coefficients, kw.clamp(exact).coefficients, bound)
    near(f.antiderivative().coefficients, exact.antiderivative().coefficients, 8 * bound)
    near(kw.elevate(f).coefficients, kw.elevate(exact).coefficients, bound)
    for u in places:
        if a < u < b:
            for part, other in zip(kw.split(f, u), kw.split(exact, u), strict=True):
                near(part.coefficients, other.coefficients, bound)
    back = kw.remove(refined, new)
    near(back.bound, 0, 9 * bound)
    if not space.exact:
        kw.reduce(f, 0.5)


def allowed(space: SplineSpace) -> float:
    """Return the error allowed for coefficients up to 1: that of arithmetic, and what the seam's rounding adds.

    A continued knot is off by 2⁻⁵² of the reach, a distance by twice that, a weight by twice as much of the least
    distance; and each of the degree many levels adds that of a difference up to 2.
    """
    n = space.degree
    if space.exact:
        return 0
    gaps = np.diff(space.breaks)
    return float(8 * (n + 2) * EPS + 4 * max(n, 1) * 2.0**-51 * reach(space.knots, n) / gaps.min())


def near(found: Any, right: Any, bound: float) -> None:
    """Assert that numbers agree up to a part of the largest of them; exactly where they are exact."""
    assert np.shape(found) == np.shape(right)
    found, right = (rationals(np.ravel(values)).tolist() for values in (found, right))
    size = max([1, *map(abs, right)])
    most = 2 * size * rationals(np.array([bound])).item()
    assert all(abs(x - y) <= most for x, y in zip(found, right, strict=True))


@pytest.mark.parametrize("seed", range(4))
def test_random_periods(seed):
    rng = np.random.default_rng(seed)
    for _, space in zip(range(25), spaces(rng), strict=False):
        check(space, rng)


def block(seed: int, count: int = 1000) -> None:
    """Check the cases of a seed; an error says which was wrong."""
    rng = np.random.default_rng(seed)
    for i, space in zip(range(count), spaces(rng), strict=False):
        try:
            check(space, rng)
        except BaseException as error:
            raise AssertionError(f"case {i} of seed {seed}: {space!r}") from error


def main(count: int, first: int = 0) -> None:
    """Check as many cases as asked for, rounded up to whole blocks, and tell what was checked."""
    seeds = range(first, first + -(-count // 1000))
    with multiprocessing.Pool() as pool:
        for done, _ in enumerate(pool.imap(block, seeds), 1):
            print(f"{1000 * done:,} cases are right", flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
