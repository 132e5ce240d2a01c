"""Where two polynomial plane curves meet, by Sylvester's resultant over whole numbers, whose zeros FLINT isolates.

Independent of hulls, of Bézout's matrix, of Bernstein coefficients and of Descartes' rule.

    python tests/sylvester.py NUMBER [SEED]

checks `kw.intersect` and `kw.zeros` on so many random cases with whole numbers each: none missed, none invented.
"""

from __future__ import annotations

import functools
import itertools
import math
import sys
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from flint import arb, arb_poly, ctx, fmpq, fmpq_mat, fmpq_poly, fmpz_mat, fmpz_poly

sys.path.insert(0, str(Path(__file__).parent))

import knotwork as kw
import oracle

#: bits of the enclosures of zeros; numbers that agree in so many are taken for equal
ctx.prec = 200

F = Fraction
Interval = tuple[Fraction, Fraction]
Curve = list[fmpz_poly]  # x and y by powers of the parameter


def resultant(a: Curve, b: Curve) -> fmpz_poly | None:
    """Return a multiple of the polynomial in s that is 0 where a(s) is on b: the determinant of b_x(t) − x, b_y(t) − y.

    None if a, or b, is a point or stands still in a coordinate; those have no place here.
    """
    if any(p.degree() < 1 for p in (*a, *b)):
        return None
    n, (p, q) = max(c.degree() for c in a), (c.degree() for c in b)
    values = []
    for s in range(n * max(p, q) + 1):
        f, g = ([c[k] - (d(s) if k == 0 else 0) for k in reversed(range(len(c)))] for c, d in zip(b, a, strict=True))
        rows = [[0] * k + f + [0] * (q - 1 - k) for k in range(q)]
        rows += [[0] * k + g + [0] * (p - 1 - k) for k in range(p)]
        values.append([fmpq(fmpz_mat(rows).det())])
    powers = _from_samples(len(values)) * fmpq_mat(values)
    return fmpq_poly(powers.entries()).numer()


@functools.cache
def _from_samples(count: int) -> fmpq_mat:
    """Return the matrix that takes values at 0, 1, 2, … to powers."""
    return fmpq_mat([[fmpq(s) ** k for k in range(count)] for s in range(count)]).inv()


def roots(p: fmpz_poly) -> list[arb]:
    """Return enclosures of the real zeros of a polynomial that is not 0, each once."""
    return [z.real for z, _ in p.complex_roots() if z.imag == 0] if p.degree() > 0 else []


def fraction(x: arb) -> Fraction:
    """Return an exact float of FLINT's."""
    mantissa, exponent = x.man_exp()
    return F(int(mantissa)) * F(2) ** int(exponent)


def between(p: fmpz_poly, root: arb, low: Fraction, high: Fraction) -> bool:
    """Tell whether an enclosed zero of a polynomial is in [low, high]: at an end, if the polynomial is 0 there."""
    least, most = fraction(root.lower()), fraction(root.upper())

    def after(x: Fraction) -> bool:
        return least > x or (most >= x and is_zero(p, x))

    def before(x: Fraction) -> bool:
        return most < x or (least <= x and is_zero(p, x))

    return after(low) and before(high)


def is_zero(p: fmpz_poly, x: Fraction) -> bool:
    return bool(p(fmpq(x.numerator, x.denominator)) == 0)


def meetings(a: Curve, b: Curve) -> list[tuple[Interval, Interval]] | None:
    """Return where two curves over [0, 1] meet: intervals of s and t, each with one meeting; None if not told."""
    sides = []
    for one, two in ((a, b), (b, a)):
        p = resultant(one, two)
        if not p:
            return None
        sides.append([x for x in roots(p) if between(p, x, F(0), F(1))])
    found = []
    points = [[[arb_poly(c)(x) for c in curve] for x in side] for curve, side in zip((a, b), sides, strict=True)]
    for (s, P), (t, Q) in itertools.product(*(zip(*each, strict=True) for each in zip(sides, points, strict=True))):
        if all(x.overlaps(y) for x, y in zip(P, Q, strict=True)):
            found.append(tuple((fraction(x.lower()), fraction(x.upper())) for x in (s, t)))
    return found


def random_pieces(rng: np.random.Generator, count: int, degree: int, size: int, away: int) -> kw.Spline:
    """Return a curve whose pieces over [2k, 2k + 1] are random, with whole coordinates; others are far away."""
    n = degree
    P = rng.integers(-size, size + 1, (count, 2, n + 1, 2)).astype(float)
    P[:, 1] = away * size * (10 + np.arange(count)[:, None, None])
    knots = np.repeat(np.arange(2 * count + 1.0), n + 1)
    return kw.Spline(kw.SplineSpace(n, knots), P.reshape(-1, 2))


def in_powers(spline: kw.Spline, k: int) -> Curve:
    """Return piece k over [0, 1] by powers."""
    n = spline.space.degree
    P = [[int(x) for x in row] for row in spline.coefficients[k * (n + 1) : (k + 1) * (n + 1)].T]
    return [
        fmpz_poly([
            math.comb(n, i) * sum((-1) ** (i - j) * math.comb(i, j) * c[j] for j in range(i + 1)) for i in range(n + 1)
        ])
        for c in P
    ]  # fmt: skip


def check(rng: np.random.Generator, count: int, degrees: tuple[int, int], size: int) -> tuple[int, int]:
    """Check all pairs of so many pieces; return how many of them have boxes that meet, and how many meetings."""
    a, b = (random_pieces(rng, count, n, size, away) for n, away in zip(degrees, (1, -1), strict=True))
    found = kw.intersect(a, b)
    places: dict[tuple[int, int], list[Any]] = {}
    for (s, u), (t, v), m in zip(found.a.tolist(), found.b.tolist(), found.multiplicity.tolist(), strict=True):
        i, j = math.floor(s) // 2, math.floor(t) // 2
        places.setdefault((i, j), []).append((F(s) - 2 * i, F(u) - 2 * i, F(t) - 2 * j, F(v) - 2 * j, m))
    met = 0
    pairs = 0
    runs = {(math.floor(x[0, 0]) // 2, math.floor(x[1].min()) // 2) for x in found.stretches}
    pieces = [[in_powers(x, 2 * k) for k in range(count)] for x in (a, b)]
    boxes = [x.coefficients.reshape(count, 2, -1, 2)[:, 0] for x in (a, b)]
    for i, j in itertools.product(range(count), repeat=2):
        here = places.get((i, j), [])
        P, Q = boxes[0][i], boxes[1][j]
        if (P.max(axis=0) < Q.min(axis=0)).any() or (Q.max(axis=0) < P.min(axis=0)).any():
            assert not here
            continue
        true = meetings(pieces[0][i], pieces[1][j])
        if true is None:
            continue
        assert (i, j) not in runs
        pairs += 1
        met += len(true)
        for s, t in true:
            assert any(x <= s[1] and s[0] <= y and z <= t[1] and t[0] <= w for x, y, z, w, _ in here), (P, Q, s, t)
        for x, y, z, w, m in here:
            inside = sum(x <= s[1] and s[0] <= y and z <= t[1] and t[0] <= w for s, t in true)
            assert inside >= 1 if m > 1 else inside == 1 if m else True, (P, Q, x, y, z, w, m)
    return pairs, met


def _knots(n: int, count: int) -> Any:
    return np.concatenate([np.zeros(n), np.arange(count + 1.0), np.full(n, float(count))])


@functools.cache
def _rows(n: int, count: int) -> list[fmpq_mat]:
    """Return, for each interval, the coefficients of powers as combinations of its control points."""
    space = oracle.Definition(kw.SplineSpace(n, _knots(n, count)))
    rows = [[space.row(q, lambda p, k=k: p[k])[q - n : q + 1] for k in range(n + 1)] for q in range(n, n + count)]
    return [fmpq_mat([[fmpq(x.numerator, x.denominator) for x in row] for row in each]) for each in rows]


def check_zeros(rng: np.random.Generator, count: int) -> tuple[int, int]:
    """Check the zeros of a random function with so many pieces; return how many pieces, and how many zeros."""
    n = int(rng.integers(1, 6))
    size = int(rng.choice([1, 2, 9, 100]))
    c = rng.integers(-size, size + 1, n + count)
    found = kw.zeros(kw.Spline(kw.SplineSpace(n, _knots(n, count)), c.astype(float)))
    ends = [(F(x), F(y)) for x, y in zip(found.low.tolist(), found.high.tolist(), strict=True)]
    total = 0
    for k, rows in enumerate(_rows(n, count)):
        a, b = F(k), F(k + 1)
        p = fmpq_poly((rows * fmpq_mat([[int(x)] for x in c[k : k + n + 1]])).entries()).numer()
        if not p:
            assert any(x <= a and b <= y for x, y in found.intervals.tolist())
            continue
        true = [x for x in roots(p) if between(p, x, a, b)]
        total += len(true)
        if not len(found.intervals):
            mine = [(max(x, a), min(y, b)) for x, y in ends if x <= b and a <= y]
            inside = [[between(p, x, *each) for each in mine] for x in true]
            assert all(sum(row) >= 1 for row in inside)
            assert all(sum(column) <= 1 for column in zip(*inside, strict=True))
    return count, total


def main() -> None:
    """Check as many cases as asked for, and tell what was checked."""
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    for name, cases, each in (
        ("zeros", "pieces", lambda rng: check_zeros(rng, 20)),
        ("intersect", "pairs whose boxes meet", _check_some),
    ):
        rng, start, done, met = np.random.default_rng(seed), time.process_time(), 0, 0
        while done < number:
            some, more = each(rng)
            done, met = done + some, met + more
        took = time.process_time() - start
        print(f"{name}: {done:,} {cases}, {met:,} places, none missed or invented; {took:.0f} s", flush=True)


def _check_some(rng: np.random.Generator) -> tuple[int, int]:
    first, second = rng.integers(1, 4, 2).tolist()
    return check(rng, 20, (first, second), int(rng.choice([3, 9, 100])))


if __name__ == "__main__":
    main()
