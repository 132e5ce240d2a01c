"""Where two polynomial plane curves meet, by Sylvester's resultant and Sturm's sequences over Fractions.

Independent of hulls, of Bézout's matrix, of Bernstein coefficients and of Descartes' rule.

    python tests/sylvester.py NUMBER

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

sys.path.insert(0, str(Path(__file__).parent))

import knotwork as kw
import oracle
import sturm
from sturm import Polynomial

F = Fraction
Interval = tuple[Fraction, Fraction]
Curve = list[Polynomial]  # x and y by powers of the parameter


def determinant(rows: list[list[Fraction]]) -> Fraction:
    """Return a determinant, by Gauss's elimination."""
    rows, total = [row[:] for row in rows], F(1)
    for k in range(len(rows)):
        pivot = next((i for i in range(k, len(rows)) if rows[i][k]), None)
        if pivot is None:
            return F(0)
        if pivot != k:
            rows[k], rows[pivot], total = rows[pivot], rows[k], -total
        total *= rows[k][k]
        for i in range(k + 1, len(rows)):
            factor = rows[i][k] / rows[k][k]
            if factor:
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return total


def resultant(a: Curve, b: Curve) -> Polynomial | None:
    """Return the polynomial in s that is 0 where a(s) is on b: Sylvester's determinant of b_x(t) − x and b_y(t) − y.

    None if a, or b, is a point or stands still in a coordinate; those have no place here.
    """
    if any(len(p) < 2 for p in (*a, *b)):
        return None
    n, (p, q) = max(map(len, a)) - 1, (len(b[0]) - 1, len(b[1]) - 1)
    values = []
    count = n * max(p, q) + 1
    for s in range(count):
        f, g = ([c[0] - sturm.value(d, F(s)), *c[1:]] for c, d in zip(b, a, strict=True))
        rows = [[F(0)] * k + f[::-1] + [F(0)] * (q - 1 - k) for k in range(q)]
        rows += [[F(0)] * k + g[::-1] + [F(0)] * (p - 1 - k) for k in range(p)]
        values.append(determinant(rows))
    result: Polynomial = [F(0)]
    for i, y in enumerate(values):  # Lagrange
        basis = [F(1)]
        for j in range(count):
            if j != i:
                basis = sturm.product(basis, [F(-j, i - j), F(1, i - j)])
        result = [x + y * z for x, z in itertools.zip_longest(result, basis, fillvalue=F(0))]
    return sturm.trimmed(result)


def isolated(p: Polynomial) -> list[Interval]:
    """Return intervals in [0, 1], one for each zero there, low = high where it is at an end."""
    found = [(x, x) for x in (F(0), F(1)) if sturm.value(p, x) == 0]
    work = [(F(0), F(1))]
    while work:
        low, high = work.pop()
        inside = sturm.count(p, low, high) - sum(sturm.value(p, x) == 0 for x in (low, high))
        if inside == 1:
            found.append((low, high))
        elif inside:
            middle = (low + high) / 2
            if sturm.value(p, middle) == 0:
                found.append((middle, middle))
            work += [(low, middle), (middle, high)]
    return sorted(found)


def narrowed(p: Polynomial, ends: Interval, width: Fraction) -> Interval:
    """Return a narrower interval about the only zero inside."""
    low, high = ends
    p = sturm.divided(p, sturm.divisor(p, sturm.differentiated(p)))
    right = sturm.value(p, high) or sturm.value(sturm.differentiated(p), high) * -1
    while high - low > width:
        middle = (low + high) / 2
        y = sturm.value(p, middle)
        if y == 0:
            return middle, middle
        low, high = (low, middle) if (y > 0) == (right > 0) else (middle, high)
    return low, high


def over(p: Polynomial, ends: Interval) -> Interval:
    """Return bounds on a polynomial over an interval in [0, 1], by Horner's scheme over intervals."""
    low, high = F(0), F(0)
    for a in reversed(p):
        ends_of = [x * y for x in (low, high) for y in ends]
        low, high = min(ends_of) + a, max(ends_of) + a
    return low, high


def meetings(a: Curve, b: Curve) -> list[tuple[Interval, Interval]] | None:
    """Return where two curves over [0, 1] meet: intervals of s and t, each with one meeting; None if not told."""
    sides = []
    for one, two in ((a, b), (b, a)):
        p = resultant(one, two)
        if not p:
            return None
        sides.append([(p, ends) for ends in isolated(p)])
    found = []
    for (p, s), (q, t) in itertools.product(*sides):
        width = F(1, 4)
        while width > F(1, 2**64):
            s, t = narrowed(p, s, width), narrowed(q, t, width)
            apart = False
            for f, g in zip(a, b, strict=True):
                (low, high), (least, most) = over(f, s), over(g, t)
                apart = apart or low > most or least > high
            if apart:
                break
            width /= 2**10
        else:
            found.append((s, t))
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
    P = [[F(int(x)) for x in row] for row in spline.coefficients[k * (n + 1) : (k + 1) * (n + 1)].T]
    return [
        sturm.trimmed([
            math.comb(n, i) * sum((-1) ** (i - j) * math.comb(i, j) * c[j] for j in range(i + 1)) for i in range(n + 1)
        ])
        for c in P
    ]  # fmt: skip


def check(rng: np.random.Generator, count: int, degrees: tuple[int, int], size: int) -> tuple[int, int]:
    """Check all pairs of so many pieces; return how many pairs that were, and how many meetings they have."""
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
        pairs += 1
        here = places.get((i, j), [])
        P, Q = boxes[0][i], boxes[1][j]
        if (P.max(axis=0) < Q.min(axis=0)).any() or (Q.max(axis=0) < P.min(axis=0)).any():
            assert not here
            continue
        true = meetings(pieces[0][i], pieces[1][j])
        if true is None:
            continue
        assert (i, j) not in runs
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
def _rows(n: int, count: int) -> list[Any]:
    """Return, for each interval, the coefficients of powers as combinations of control points."""
    space = oracle.Definition(kw.SplineSpace(n, _knots(n, count)))
    return [[space.row(q, lambda p, k=k: p[k]) for k in range(n + 1)] for q in range(n, n + count)]


def check_zeros(rng: np.random.Generator, count: int) -> int:
    """Check the number of zeros of a random function with so many pieces, at most."""
    n = int(rng.integers(1, 6))
    size = int(rng.choice([1, 2, 9, 100]))
    c = rng.integers(-size, size + 1, n + count)
    found = kw.zeros(kw.Spline(kw.SplineSpace(n, _knots(n, count)), c.astype(float)))
    low, high = ([F(x) for x in ends.tolist()] for ends in (found.low, found.high))
    for k, rows in enumerate(_rows(n, count)):
        a, b = F(k), F(k + 1)
        p = sturm.trimmed([sum((x * int(y) for x, y in zip(row, c, strict=True) if x), F(0)) for row in rows])
        if not p:
            assert any(x <= a and b <= y for x, y in found.intervals.tolist())
            continue
        free = not len(found.intervals)
        mine = [(max(x, a), min(y, b)) for x, y in zip(low, high, strict=True) if x <= b and a <= y]
        if free:
            assert sturm.count(p, a, b) == sum(sturm.count(p, x, y) for x, y in mine)
            assert all(sturm.count(p, x, y) <= 1 for x, y in mine)
    return count


def main() -> None:
    """Check as many cases as asked for, and tell what was checked."""
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    rng = np.random.default_rng(int(sys.argv[2]) if len(sys.argv) > 2 else 0)
    start = time.perf_counter()
    done = 0
    while done < number:
        done += check_zeros(rng, 20)
    print(f"zeros: {done:,} pieces checked in {time.perf_counter() - start:.0f} s", flush=True)
    start = time.perf_counter()
    done = met = 0
    while done < number:
        degrees = tuple(rng.integers(1, 4, 2).tolist())
        pairs, more = check(rng, 20, degrees, int(rng.choice([3, 9, 100])))
        done, met = done + pairs, met + more
    print(f"intersect: {done:,} pairs with {met:,} meetings checked in {time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
