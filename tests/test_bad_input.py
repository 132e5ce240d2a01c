"""Bad input: a clear error that names what was given and what was expected, before any work, and nothing changed."""

from __future__ import annotations

import decimal
import math
import tracemalloc
from fractions import Fraction

import numpy as np
import pytest

import knotwork as kw
from knotwork import Spline, SplineSpace
from knotwork.errors import KnotError, KnotworkError, ParameterError, PointError, SizeError
from work import calls_within

F = Fraction
NAN, INF = math.nan, math.inf
P = np.arange(8.0).reshape(4, 2)
CURVE = kw.curve(P)
EXACT = kw.curve(np.array([[F(1), F(2)]] * 4, dtype=object))
CLOSED = kw.curve(np.arange(10.0).reshape(5, 2), periodic=True)
SURFACE = kw.surface(np.zeros((4, 5, 3)))
HUGE = 10**400
MASKED = np.ma.array([0.0, 0.0, 1.0, 1.0], mask=[0, 0, 1, 0])


@pytest.fixture(autouse=True)
def nothing_changes():
    kinds = (CURVE, EXACT, CLOSED, SURFACE)
    before = [(s.coefficients.tolist(), [x.knots.tolist() for x in s.spaces]) for s in kinds]
    yield
    assert before == [(s.coefficients.tolist(), [x.knots.tolist() for x in s.spaces]) for s in kinds]


def refused(error, says):
    return pytest.raises(error, match=says)


# ---- knots --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("knots", "says"),
    [
        ([0, 0, NAN, 1], r"knots\[2\] is nan"),
        ([0, 0, 1, INF], r"knots\[3\] is inf"),
        ([-INF, 0, 1, 1], r"knots\[0\] is -inf"),
        ([F(0), 0, NAN, 1], "nan"),
        ([0, 0, 2, 1], r"knots\[2\] = 2.0 is above knots\[3\] = 1.0"),
        ([F(0), 0, F(1, 2), F(1, 3)], "1/2 is above .* 1/3"),
        ([0, 1, 1], "3 knots given; .* at least 4"),
        ([], "0 knots given"),
        ([0, 0, 0, 1], r"knot 0.0 has multiplicity 3; degree 1 allows at most 2"),
        ([0, 1, 1, 2], "domain"),
        ([[0, 0], [1, 1]], r"shape \(2, 2\)"),
        ([0, [0, 1], 1], "lengths"),
        ("0011", "expected"),
        (["0", "0", "1", "1"], "expected numbers"),
        (None, "None given"),
        (3.0, "shape"),
        ([0, 0, 1j, 1], "complex"),
        (np.array([0, 0, 1j, 1], dtype=object), "complex|real"),
        ([F(0), None, F(1), F(1)], "None given"),
        (MASKED, "masked"),
        (np.array([0, 0, 1, 1], "M8[s]"), "datetime64"),
        ([-1.7e308, 0, 1, 1.7e308], "overflow"),
        ([0.0, 0, 1, HUGE], "float64|large|overflow|finite"),
    ],
)
def test_knots(knots, says):
    with refused(KnotError, says):
        SplineSpace(1, knots)


@pytest.mark.parametrize("degree", [-1, 1.0, 2.5, True, "3", None, NAN, [3], np.float64(2), 1j])
@pytest.mark.parametrize(
    "make",
    [
        lambda n: SplineSpace(n, [0, 1, 2, 3]),
        lambda n: SplineSpace(n, [0, 1], periodic=True),
        lambda n: SplineSpace.clamped(n, 5),
        lambda n: SplineSpace.uniform(n, 5),
        lambda n: SplineSpace.uniform(n, 5, periodic=True),
        lambda n: SplineSpace.bezier(n, [0, 1, 2]),
        lambda n: kw.curve(P, n),
        lambda n: kw.surface(np.zeros((4, 4)), (3, n)),
    ],
)
def test_degrees(make, degree):
    with refused(KnotError, "degree"):
        make(degree)


@pytest.mark.parametrize(
    ("knots", "says"),
    [
        ([0], "1 knots given"),
        ([1, 1], "empty"),
        ([0, 1, 2, 2], r"end 2.0 .* 2 times; expected once"),
        ([0, 0, 0, 1], "multiplicity 3"),
        ([0, NAN], "nan"),
        ([1, 0], "above"),
    ],
)
def test_knots_of_a_period(knots, says):
    with refused(KnotError, says):
        SplineSpace(1, knots, periodic=True)


@pytest.mark.parametrize("n", [3, 0, -1, 4.0, "5", None, True])
def test_dimensions(n):
    for make in (SplineSpace.clamped, SplineSpace.uniform):
        with refused(ParameterError, "dimension .* at least 4"):
            make(3, n)


@pytest.mark.parametrize("breaks", [[0], [], [0, 0], [0, 1, 1], [1, 0], [0, NAN], "01"])
def test_breaks(breaks):
    with refused(KnotError, "breaks"):
        SplineSpace.bezier(2, breaks)


# ---- points and weights -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("points", "says"),
    [
        ([[0, 0], [1, NAN], [2, 2], [3, 3]], r"\[1, 1\] is nan"),
        ([[0, 0], [1, 1], [INF, 2], [3, 3]], r"\[2, 0\] is inf"),
        ([0, 1, complex(0, INF), 3], "finite"),
        (np.array([F(0), NAN, 2, 3], dtype=object), "nan"),
        ([[0, 0], [1], [2, 2], [3, 3]], "lengths"),
        ([], "0 points given; degree 3 needs at least 4"),
        (P[:3], "3 points given; degree 3 needs at least 4"),
        (np.zeros((4, 0)), "no coordinates"),
        (np.zeros((4, 2, 2)), r"shape \(4, 2, 2\)"),
        (5.0, "shape"),
        (None, "None given"),
        ("abcd", "expected"),
        ([["a", "b"]] * 4, "expected numbers"),
        ([[0, None]] * 4, "None given"),
        (np.ma.array(P, mask=P > 6), "masked"),
        ([np.ma.array([1.0, 2.0], mask=[False, True])] * 4, "masked"),
        (P.astype("M8[s]"), "datetime64"),
        ({1, 2, 3, 4}, "expected numbers"),
        ((x for x in P), "expected numbers"),
        (np.array([[decimal.Decimal("nan"), 1]] * 4, dtype=object), "NaN"),
        ([[0.0, HUGE]] * 4, "float64|large|overflow|finite"),
    ],
)
def test_points(points, says):
    with refused(PointError, says):
        kw.curve(points)


@pytest.mark.parametrize(
    ("weights", "says"),
    [
        ([1, 1, 0, 1], r"weights\[2\] is 0.0; expected positive"),
        ([1, -2, 1, 1], r"weights\[1\] is -2.0"),
        ([1, 1, NAN, 1], r"weights\[2\] is nan"),
        ([1, 1, 1, INF], r"weights\[3\] is inf"),
        ([1, 1, 1], r"shape \(3,\) given"),
        (1.0, r"shape \(\) given"),
        (P, "shape"),
        ([1, 1, 1, 1j], "complex"),
        (["1"] * 4, "expected numbers"),
        ([1, 1, [1], 1], "lengths"),
        (MASKED, "masked"),
    ],
)
def test_weights(weights, says):
    with refused(PointError, says):
        kw.curve(P, weights=weights)


def test_products_that_overflow():
    with refused(PointError, "inf"):
        kw.curve(np.full((4, 2), 1e200), weights=[1e200] * 4)
    with refused(PointError, "inf"):
        kw.curve(np.full((4, 2), 1e300)).transform(1e300)


@pytest.mark.parametrize("count", [7, 9])
def test_the_count_that_fits_is_said(count):
    with refused(KnotError, f"{count} knots given; 4 points of degree 3 take 8"):
        kw.curve(P, knots=np.linspace(0, 1, count))
    with refused(KnotError, "6 knots given; 4 points of degree 3 take 5"):
        kw.curve(P, knots=np.linspace(0, 1, 6), periodic=True)


@pytest.mark.parametrize(
    ("spaces", "coefficients", "error", "says"),
    [
        (SplineSpace.clamped(2, 4), P[:3], PointError, r"shape \(3, 2\) given; .* \(4,\) or \(4, d\)"),
        ([SplineSpace.clamped(2, 4)] * 2, np.zeros((4, 3)), PointError, r"\(4, 4\) or \(4, 4, d\)"),
        ([], P, KnotError, "spaces"),
        (None, P, KnotError, "spaces"),
        (3, P, KnotError, "spaces"),
        ([3, 4], P, KnotError, "spaces"),
    ],
)
def test_spaces_and_coefficients(spaces, coefficients, error, says):
    with refused(error, says):
        Spline(spaces, coefficients)


@pytest.mark.parametrize("last", [0, -1, NAN, INF])
def test_homogeneous_coordinates(last):
    with refused(PointError, "weight|finite"):
        Spline(SplineSpace.clamped(1, 2), [[0, 1], [0, last]], rational=True)


def test_homogeneous_coordinates_need_a_point():
    with refused(PointError, "coordinates"):
        Spline(SplineSpace.clamped(1, 2), [[1], [1]], rational=True)
    with refused(PointError, "homogeneous"):
        Spline(SplineSpace.clamped(1, 2), [1, 1], rational=True)
    with refused(PointError, "real"):
        Spline(SplineSpace.clamped(1, 2), [[1j, 1], [0, 1]], rational=True)


def test_surfaces():
    with refused(PointError, "3 points along axis 1 given; degree 3 needs at least 4"):
        kw.surface(np.zeros((4, 3, 3)))
    with refused(KnotError, "7 knots given; 4 points along axis 0 of degree 3 take 8"):
        kw.surface(np.zeros((4, 4, 3)), knots=([0] * 7, None))
    with refused(PointError, "shape"):
        kw.surface(np.zeros(4))
    for name, value in (
        ("degree", (3,)),
        ("degree", "33"),
        ("degree", 2.5),
        ("knots", [0, 1, 2]),
        ("periodic", (1, 0, 1)),
    ):
        with refused(ParameterError, name):
            kw.surface(np.zeros((4, 4)), **{name: value})
    with refused(PointError, r"weights of shape \(4,\)"):
        kw.surface(np.zeros((4, 4, 3)), weights=np.ones(4))
    with refused(PointError, r"weights\[1, 2\]"):
        kw.surface(np.zeros((4, 4, 3)), weights=np.where(np.arange(16).reshape(4, 4) == 6, 0, 1))


# ---- insertion ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("knots", "says"),
    [
        (NAN, "nan"),
        ([0.5, NAN], "nan"),
        (INF, "inf"),
        (-0.1, r"knot -0.1 is outside the domain \[0.0, 1.0\]"),
        ([0.5, 1.5], r"knot 1.5 is outside"),
        (0.0, "knot 0.0 has multiplicity 5; degree 3 allows at most 4"),
        (1.0, "knot 1.0 has multiplicity 5; degree 3 allows at most 4"),
        ([0.5] * 5, "knot 0.5 has multiplicity 5"),
        ([0.25, 0.5, 0.5, 0.75, 0.5, 0.5, 0.5], "knot 0.5 has multiplicity 5"),
        ([[0.5]], "shape"),
        ([0.5, [0.6]], "lengths"),
        ("0.5", "expected numbers"),
        (None, "None given"),
        (0.5j, "complex"),
        (np.array([0.5j], dtype=object), "complex|real"),
        (np.ma.array([0.5], mask=[True]), "masked"),
        (F(HUGE), "outside|overflow|large|float64"),
    ],
)
def test_new_knots(knots, says):
    for spline in (CURVE, SURFACE):
        with refused(KnotError, says):
            kw.insert(spline, knots)
    with refused(KnotError, says):
        CURVE.space.with_knots(knots)
    with refused(KnotError, "knot"):
        kw.insert(EXACT, knots)


def test_new_knots_in_a_period():
    for knots in (-0.1, 1.1, [0.2] * 4, [0, 1, 0, 1], NAN):
        with refused(KnotError, r"outside|multiplicity|nan"):
            kw.insert(CLOSED, knots)


def test_a_full_knot_takes_no_more():
    full = kw.insert(CURVE, [0.5] * 4)
    for knots in (0.5, [0.5], np.float64(0.5)):
        with refused(KnotError, "knot 0.5 has multiplicity 5; degree 3 allows at most 4"):
            kw.insert(full, knots)


def test_matrices():
    S = CURVE.space
    for T in (
        SplineSpace.clamped(2, 4),
        SplineSpace(3, [0] * 4 + [2] * 4),
        CLOSED.space,
        SplineSpace(3, [-1, 0, 0, 0, 1, 1, 1, 1]),
    ):
        with refused(KnotError, "does not refine|outside"):
            kw.insertion_matrix(S, T)
    with refused(KnotError, "does not refine"):
        kw.insertion_matrix(S.with_knots(0.5), S)
    matrix = kw.insertion_matrix(S, S.with_knots(0.5))
    for other in (np.zeros(3), np.zeros((5, 4)), 1.0, "abcd", [[1], [1, 2]], None, np.ma.array(P, mask=P > 2)):
        with refused(PointError, "right operand"):
            matrix @ other


@pytest.mark.parametrize("knots", [0.25, [0.5, 0.5], NAN, [[0.5]], [[0.5, 0.6]], 0.5j, "0.5", None, [0.5 + 1j], 7])
def test_knots_to_take_out(knots):
    space = CURVE.space.with_knots([0.5, 0.6])
    with refused(KnotError, "knot"):
        space.without_knots(knots)


def test_knots_that_hold_the_domain():
    space = SplineSpace(2, [-2, -1, 0, 1, 2, 3, 4])
    for x in (-2, 0, 2, 4):
        with refused(KnotError, "domain|knots given"):
            space.without_knots(x)


# ---- evaluation ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("u", "says"),
    [
        (NAN, "nan"),
        ([0.5, INF], "inf"),
        (-1e-9, r"parameter -1e-09 is outside the domain \[0.0, 1.0\]"),
        ([0.5, 1.5], "parameter 1.5 is outside"),
        (0.5j, "complex"),
        (np.array([0.5j], dtype=object), "complex|real"),
        ("0.5", "expected numbers"),
        (None, "None given"),
        ([[0.1], [0.1, 0.2]], "lengths"),
        (np.ma.array([0.5], mask=[True]), "masked"),
        (F(HUGE), "outside|overflow|large|float64"),
    ],
)
def test_parameters(u, says):
    for call in (CURVE, lambda u: CURVE.derivatives(u, 1)):
        with refused(ParameterError, says):
            call(u)


def test_parameters_in_number_and_shape():
    for u in ((), (0.5, 0.5)):
        with refused(ParameterError, "parameters given; this spline has 1"):
            CURVE(*u)
    with refused(ParameterError, "broadcast"):
        SURFACE([0.1, 0.2], [0.1, 0.2, 0.3])
    with refused(ParameterError, "flat"):
        SURFACE([[0.1]], [0.1], grid=True)


@pytest.mark.parametrize("order", [-1, 1.0, True, "1", None, NAN])
def test_orders(order):
    for act in (lambda: CURVE.derivatives(0.5, order), lambda: CURVE.derivative(order=order)):
        with refused(ParameterError, "order"):
            act()


def test_no_order_at_all():
    with refused(ParameterError, "order|parameters"):
        CURVE.derivatives()


@pytest.mark.parametrize("axis", [1, -2, 0.0, True, None, "0"])
def test_axes(axis):
    for act in (
        lambda: CURVE.derivative(axis=axis),
        lambda: CURVE.antiderivative(axis=axis),
        lambda: CURVE.reverse(axis),
        lambda: kw.insert(CURVE, 0.5, axis=axis),
        lambda: kw.insert(CURVE, [0.5], axis=axis),
        lambda: kw.elevate(CURVE, 1, axis=axis),
        lambda: kw.split(CURVE, 0.5, axis=axis),
    ):
        with refused(ParameterError, "axis"):
            act()


@pytest.mark.parametrize(
    ("matrix", "shift", "says"),
    [
        (np.eye(3), 0, "shape"),
        (np.eye(2), [1, 2, 3], "shape"),
        (np.zeros((0, 2)), 0, "coordinates|shape"),
        ([[1, NAN], [0, 1]], 0, "nan"),
        (np.eye(2), INF, "inf"),
        ("ab", 0, "expected numbers"),
        ([[1, 0], [1]], 0, "lengths"),
    ],
)
def test_transforms(matrix, shift, says):
    with refused(PointError, says):
        CURVE.transform(matrix, shift)


def test_a_rational_curve_stays_real():
    circle = kw.curve([[1, 0], [1, 1], [0, 1]], 2, weights=[1, 1, 2])
    with refused(PointError, "complex|real"):
        circle.transform(1j)


def test_a_reversal_that_would_join_knots():
    with refused(KnotError, "coincide"):
        kw.curve([0.0, 1.0, 2.0], 1, [0, 0, 1e-300, 1, 1]).reverse()


# ---- size ---------------------------------------------------------------------------------------------------------

MANY = np.linspace(0, 1, 10**6)


@pytest.mark.parametrize(
    "ask",
    [
        lambda: SplineSpace.clamped(3, 10**15),
        lambda: SplineSpace.clamped(3, HUGE),
        lambda: SplineSpace.uniform(3, 10**15),
        lambda: SplineSpace.uniform(3, 10**15, periodic=True),
        lambda: SplineSpace.bezier(10**12, [0, 1, 2]),
        lambda: SURFACE(MANY, MANY, grid=True),
        lambda: SURFACE(MANY[:, None], MANY),
        lambda: SURFACE.derivatives(MANY[:, None], MANY, 1),
        lambda: CURVE.derivatives(0.5, 10**12),
        lambda: kw.elevate(CURVE, 10**12),
    ],
)
def test_what_cannot_fit_in_memory_is_refused_at_once(ask):
    tracemalloc.start()
    try:
        with calls_within(10_000), refused(SizeError, "GB"):
            ask()
        assert tracemalloc.get_traced_memory()[1] < 300e6
    finally:
        tracemalloc.stop()


def test_errors_have_one_root_and_are_value_errors():
    for error in (KnotError, PointError, ParameterError, SizeError):
        assert issubclass(error, KnotworkError)
        assert issubclass(error, ValueError)
    assert issubclass(SizeError, MemoryError)
