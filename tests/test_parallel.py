"""Threads: large jobs come out the same to the bit however many work on them; small jobs start none."""

from __future__ import annotations

import threading

import numpy as np
import pytest

import knotwork as kw
from knotwork.arithmetic import parallel
from knotwork.errors import KnotError, ParameterError

RNG = np.random.default_rng(0)
CURVE = kw.curve(RNG.standard_normal((90_000, 3)))
CLOSED = kw.curve(RNG.standard_normal((90_000, 3)), periodic=True)
SURFACE = kw.surface(RNG.standard_normal((300, 300, 3)))
U, V = RNG.random((2, 100_000))

JOBS = {
    "many knots into a curve": lambda: kw.insert(CURVE, U),
    "few knots, far apart, into a long curve": lambda: kw.insert(CURVE, [0.1, 0.5, 0.9]),
    "a closed curve": lambda: kw.insert(CLOSED, np.unique(np.floor(90_000 * U) + 0.5) / 90_000),
    "axis 0 of a surface": lambda: kw.insert(SURFACE, U[:300], axis=0),
    "axis 1 of a surface": lambda: kw.insert(SURFACE, U[:300], axis=1),
    "one row of a net": lambda: kw.insert(kw.surface(CURVE.points[None], (0, 3)), [0.1, *U[:9], 0.9], axis=1),
    "points of a curve": lambda: CURVE(U),
    "derivatives of a curve": lambda: CURVE.derivatives(U, 2),
    "points of a surface": lambda: SURFACE(U, V),
    "Bézier nets": lambda: kw.to_bezier(CURVE)[0],
    "Bézier nets of a surface": lambda: kw.to_bezier(SURFACE)[0],
}


@pytest.fixture
def parts(monkeypatch):
    """Count the parts that jobs are cut into."""
    counts = []
    in_parts = parallel.in_parts

    def counted(work, count, size):
        covered = []
        in_parts(lambda lo, hi: (work(lo, hi), covered.append((lo, hi))), count, size)
        starts, stops = zip(*sorted(covered), strict=True)
        assert (*starts, count) == (0, *stops)
        counts.append(len(covered))

    for module in ("evaluation", "insertion.merge"):
        monkeypatch.setattr(f"knotwork.{module}.in_parts", counted)
    return counts


def bits(result):
    if isinstance(result, kw.Spline):
        return [array.tobytes() for array in (result.coefficients, *(space.knots for space in result.spaces))]
    return result.tobytes()


@pytest.mark.parametrize("job", JOBS)
def test_the_number_of_threads_does_not_matter(job, parts, monkeypatch):
    found = []
    for threads in (1, 2, 3):
        parts.clear()
        monkeypatch.setenv("KNOTWORK_THREADS", str(threads))
        found.append(bits(JOBS[job]()))
        assert max(parts) == threads
    assert found[0] == found[1] == found[2]


def test_a_knot_too_often_is_refused_wherever_the_parts_meet(monkeypatch):
    monkeypatch.setenv("KNOTWORK_THREADS", "3")
    refined = kw.insert(CURVE, U).space
    for edge in (refined.dimension // 3, 2 * refined.dimension // 3):
        for x in refined.knots[edge - 2 : edge + 7]:
            with pytest.raises(KnotError, match=f"knot {x} has multiplicity 5; degree 3 allows at most 4"):
                kw.insert(CURVE, np.append(U, [x] * 4))
            full = kw.insert(CURVE, np.append(U, [x] * 3)).space
            assert (full.multiplicity(x), full) == (4, CURVE.space.with_knots(np.append(U, [x] * 3)))


def test_parts_cover_each_row_once(monkeypatch):
    large = parallel.WORTH_A_THREAD * 10
    for threads in (1, 2, 3, 7):
        monkeypatch.setenv("KNOTWORK_THREADS", str(threads))
        for count in (1, 2, 3, 100):
            covered = []
            parallel.in_parts(lambda lo, hi, covered=covered: covered.append((lo, hi)), count, large)
            assert len(covered) == min(threads, count)
            assert sorted(i for lo, hi in covered for i in range(lo, hi)) == list(range(count))


def test_an_error_in_any_part_comes_out(monkeypatch):
    monkeypatch.setenv("KNOTWORK_THREADS", "3")
    for bad in range(3):

        def work(lo, hi, bad=bad):
            if lo == bad:
                raise ArithmeticError(f"part {bad}")

        with pytest.raises(ArithmeticError, match=f"part {bad}"):
            parallel.in_parts(work, 3, parallel.WORTH_A_THREAD * 10)


def test_small_jobs_start_no_threads(monkeypatch, parts):
    monkeypatch.setenv("KNOTWORK_THREADS", "4")

    def refuse(workers):
        raise AssertionError(f"{workers} threads asked for")

    monkeypatch.setattr(parallel, "_pool", refuse)
    before = threading.active_count()
    curve, surface = kw.curve(RNG.standard_normal((1000, 3))), kw.surface(RNG.standard_normal((30, 30, 3)))
    kw.insert(curve, U[:1000])
    kw.insert(surface, U[:30], axis=1)
    curve(U[:1000])
    surface(U[:1000], V[:1000])
    kw.to_bezier(curve)
    assert set(parts) == {1}
    assert threading.active_count() == before


@pytest.mark.parametrize(("given", "count"), [("1", 1), ("5", 5), ("0", 1), ("-3", 1)])
def test_the_environment_says_how_many(given, count, monkeypatch):
    monkeypatch.setenv("KNOTWORK_THREADS", given)
    assert parallel.processors() == count
    monkeypatch.delenv("KNOTWORK_THREADS")
    assert parallel.processors() >= 1


def test_an_unknown_number_of_threads_is_an_error(monkeypatch):
    monkeypatch.setenv("KNOTWORK_THREADS", "many")
    with pytest.raises(ParameterError, match="KNOTWORK_THREADS is 'many'; expected a whole number"):
        parallel.processors()
