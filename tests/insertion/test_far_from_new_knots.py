"""Far from new knots points are copied as arrays: no bit changes, in any place, nor what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import KnotError
from knotwork.insertion import merge, refinement

N = 150


def long_curve(degree, rng):
    """Return a curve of N points whose knots inside, and maybe at the ends, have all multiplicities."""
    inner = np.sort(rng.integers(0, N // 2, N - degree - 1)).astype(float)
    ends = -1.0 - (rng.random() < 0.5) * np.arange(degree, -1, -1), N + (rng.random() < 0.5) * np.arange(degree + 1.0)
    t = np.concatenate([ends[0], inner, ends[1]])
    for i in range(degree + 1, len(t)):  # none more often than the order
        if t[i] == t[i - degree - 1]:
            t[i:] = np.maximum(t[i:], t[i] + 0.25)
    return kw.curve(rng.standard_normal((N, 2)), degree, t)


def outcome(curve, knots):
    """Return what an insertion gives: knots and points, or what it says."""
    try:
        found = kw.insert(curve, knots)
    except KnotError as error:
        return str(error)
    return found.space.knots.tolist(), found.points.tolist()


@pytest.mark.parametrize("seed", range(40))
def test_copies_change_no_bit(seed, monkeypatch):
    rng = np.random.default_rng(seed)
    curve = long_curve(int(rng.integers(0, 5)), rng)
    t, (a, b) = curve.space.knots, curve.space.domain
    near = np.unique(t[(t >= a) & (t <= b)])
    place = int(rng.integers(len(near)))
    few = [a, b, near[place], *rng.uniform(a, b, 2), *near[place : place + 3], near[0], near[-1]]
    jobs = [*few, *([u] * m for u in few for m in (2, 3, 6)), few[3:6], [a, b], near[place : place + 2].repeat(2)]
    found = {}
    for longest in (0, 10**9):
        monkeypatch.setattr(refinement, "LONG", (longest, longest))
        monkeypatch.setattr(merge, "LONG", (longest, longest))
        found[longest] = [outcome(curve, u) for u in jobs]
        found[longest] += [[part.points.tolist() for part in kw.split(curve, u)] for u in few if a < u < b]
    assert found[0] == found[10**9]
    assert any(isinstance(each, str) for each in found[0])


@pytest.mark.parametrize("periodic", [False, True])
def test_halves_are_the_curve_and_no_part_of_each_other(periodic):
    curve = kw.curve(np.random.default_rng(1).standard_normal((N, 2)), 3, periodic=periodic)
    exact = curve.in_exact_arithmetic()
    for part, whole in zip(kw.split(curve, 0.3), kw.split(exact, 0.3), strict=True):
        assert abs(part.points - whole.points.astype(float)).max() < 1e-14
        assert part.points.flags.owndata or part.points.base.size == part.points.size
    left, right = kw.split(curve, 0.3)
    assert not np.shares_memory(left.points, right.points)
    assert (left.space.domain, right.space.domain) == ((0, 0.3), (0.3, 1))


def test_equal_short_knots_are_one_space():
    """Whoever asks for knots that were checked gets the same space; what they gave stays theirs."""
    knots = np.array([0, 0, 0, 1, 2, 2, 2.0])
    first = kw.curve([0, 1, 2, 3], 2, knots)
    knots[3] = 0.5
    other = kw.curve([0, 1, 2, 3], 2, knots)
    assert first.space.knots[3] == 1
    assert other.space.knots[3] == 0.5
    assert kw.curve([4, 1, 2, 3], 2, knots).space is other.space
    for _ in range(2):
        with pytest.raises(KnotError, match="above"):
            kw.curve([0, 1, 2, 3], 2, knots[::-1])
