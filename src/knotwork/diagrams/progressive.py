"""The procedures of progressive curves as schemes to draw: each is run as it is, over knots that are names."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from knotwork.arithmetic.arrays import Array, whole
from knotwork.diagrams.drawing import Diagram
from knotwork.diagrams.layout import Layout, Spot
from knotwork.diagrams.picture import picture
from knotwork.diagrams.recording import Value, given, recording
from knotwork.diagrams.symbols import knot, names
from knotwork.diagrams.symbols import knots as knots_of
from knotwork.errors import KnotError, ParameterError
from knotwork.progressive import procedures
from knotwork.progressive.homogeneous import DELTA
from knotwork.progressive.procedures import left_edge, right_edge, triangle

#: knots or arguments as one writes them: names, numbers, δ and pairs
Written = list[Any]


def apex(P: Array, t: Array, u: Array) -> Array:
    """Run a whole triangle, for its apex."""
    top: Array = triangle(P, t, u)[-1, :1]
    return top


def edges(P: Array, t: Array, u: Array) -> Array:
    """Insert knots in the middle, for the left edge and the right edge of the triangle."""
    T = triangle(P, t, u)
    return np.concatenate([left_edge(T), right_edge(T)])


def basis(P: Array, t: Array, u: Array) -> Array:
    """Run a whole triangle; read from its apex down to its base, it makes the basis functions (§2.2.1)."""
    triangle(P, t, u)
    return P


def integral(P: Array, t: Array, u: Array) -> Array:
    """Set the knot before those of basis function k to δ, or the knot after them: two integrals of it (§2.3.5)."""
    n = len(u)
    k = n // 2
    after = min(k, n - 2)
    found = []
    for place, function in ((k, k), (after + n + 2, after + 1)):
        s = t.copy()
        s[place - 1] = knot(DELTA)
        found.append(basis(given(s, n), s, u)[function])
    return np.array(found)


def boehm_derivative(P: Array, t: Array, u: Array) -> Array:
    """Insert δ n times, and then the other knots between the left half and δⁿ (§2.3.3)."""
    n = len(u)
    delta = knots_of([DELTA] * n)
    return right_edge(triangle(left_edge(triangle(P, t, delta)), np.concatenate([t[:n], delta]), u))


def neighbours(P: Array, t: Array, u: Array) -> Array:
    """Run the triangle of the first n + 1 points, and that of the last n + 1 (§2.3.4)."""
    n = len(u)
    return np.concatenate([apex(P[k : k + n + 1], t[k : k + 2 * n], u) for k in range(2)])


@dataclass(frozen=True)
class Scheme:
    """A procedure, and what it is drawn for unless other knots are given.

    Attributes
    ----------
    title : str
    run : function
        From control points, knots and blossom arguments to the points that the procedure is run for.
    knots, arguments : function
        The usual ones for degree n.
    partial : bool
        Whether fewer arguments than n will do.
    raised : int
        How much higher the degree n of the triangles is than that of what they are drawn for.
    shared : bool
        Whether what is computed twice is drawn once.
    face : bool
        Whether the lateral face of the tetrahedron, values with none of the arguments u_1 … u_n, is drawn as a whole.
    downward : bool
        Whether it is read from the apex down, for those basis functions that `run` returns.
    """

    title: str
    run: Callable[[Array, Array, Array], Array]
    knots: Callable[[int], Written]
    arguments: Callable[[int], Written]
    partial: bool = False
    raised: int = 0
    shared: bool = False
    face: bool = False
    downward: bool = False


def _named(letter: str) -> Callable[[int], Written]:
    return lambda n: names(letter, 1, 2 * n)


def _each(*ends: Any) -> Callable[[int], Written]:
    return lambda n: [end for end in ends for _ in range(n)]


def _newton(n: int) -> Written:
    return [*names("t", 1, n), *["δ"] * n]


def _nodes(n: int) -> Written:
    return [*names("t", 1, n), *names("t", 0, n - 1)]


_T, _U, _AT_T = _named("t"), _named("u"), _each("t")
_CHANGE = "Change of basis from t to u"

SCHEMES = {
    "de casteljau": Scheme("The de Casteljau algorithm", edges, _each(0, 1), _AT_T),
    "de boor": Scheme("The de Boor algorithm", apex, _T, _AT_T),
    "blossom": Scheme("The blossom at any arguments", apex, _T, lambda n: names("u", 1, n)),
    "basis": Scheme("The basis functions, from the top down", basis, _T, _AT_T, downward=True),
    "knot": Scheme("Boehm's knot insertion", edges, _T, lambda n: ["u"], partial=True),
    "boehm-change": Scheme(f"{_CHANGE}, one knot at a time: Boehm", procedures.boehm, _T, _U),
    "goldman-change": Scheme(f"{_CHANGE}: Goldman's version of the Oslo algorithm", procedures.goldman, _T, _U),
    "oslo-change": Scheme(f"{_CHANGE}: the Oslo algorithm", procedures.oslo, _T, _U),
    "sablonniere-change": Scheme(f"{_CHANGE}: Sablonnière's tetrahedron", procedures.sablonniere, _T, _U, face=True),
    "sablonniere-recursive-change": Scheme(
        f"{_CHANGE}: what is needed of Sablonnière's tetrahedron", procedures.sablonniere_recursive, _T, _U
    ),
    "derivative": Scheme("The first derivative", apex, _T, lambda n: ["δ", *["t"] * (n - 1)]),
    "boehm-derivative": Scheme("All derivatives at a: Boehm's algorithm", boehm_derivative, _T, _each("a")),
    "matching": Scheme("Two neighbours", neighbours, lambda n: names("t", 1, 2 * n + 1), _AT_T, shared=True),
    "integration": Scheme("Two integrals of a basis function", integral, _T, _AT_T, raised=1, downward=True),
    "monomial": Scheme("The de Boor algorithm in monomial form", edges, _each(0, "δ"), _AT_T),
    "power": Scheme("The de Boor algorithm in power basis form", apex, _nodes, _AT_T),
    "newton-dual": Scheme("The de Boor algorithm in Newton dual form", edges, _newton, _AT_T),
    "pascal": Scheme("From monomial to Bézier form: Pascal's triangle", edges, _each(0, "δ"), _each(1)),
    "differencing": Scheme("From Bézier to monomial form: differencing", edges, _each(0, 1), _each("δ")),
}


def procedure_diagram(
    procedure: str,
    degree: int = 3,
    *,
    knots: Iterable[Any] | None = None,
    arguments: Iterable[Any] | None = None,
    homogeneous: bool = False,
) -> Diagram:
    """Draw the scheme of a procedure, from the procedure itself: it runs over knots that are names.

    A node shows its blossom arguments. The arrows into a node carry the factors of the two values that it is combined
    from, without their common denominator, b × a. Control points are shaded, what the procedure is run for is red.

    Parameters
    ----------
    procedure : str
        "de casteljau", "de boor", "blossom", "knot" (Boehm's insertion of one), "derivative", "boehm-derivative",
        "matching"; the changes of basis, "boehm-change", "goldman-change", "oslo-change", "sablonniere-change",
        "sablonniere-recursive-change"; top down "basis" and "integration"; by basis "monomial", "power",
        "newton-dual", "pascal", "differencing".
    degree : int
        At least 1.
    knots, arguments : iterable of names, numbers, "δ" and pairs of these, optional
        Other knots and blossom arguments than those usual for the procedure: 2n knots, and 2n + 1 for "matching";
        n arguments; for "knot" up to n, and for a change of basis 2n, which are the new knots. For "integration" n is
        the degree of the integral.
    homogeneous : bool
        Whether the usual knots are homogeneous: t₁ is (t₁, w₁), written t̂₁, and u₁ is (u₁, v₁).

    Returns
    -------
    Diagram
        With `svg()`, and `draw(axes)` for matplotlib.

    Raises
    ------
    KnotError
        If the number of knots or arguments is wrong, or the knots are not progressive.

    Examples
    --------
    >>> [str(edge.label) for edge in procedure_diagram("de casteljau", 1, arguments=["a"]).edges]
    ['1 − a', 'a']
    >>> [edge.label for edge in procedure_diagram("de boor", 1, knots=["a", "δ"]).edges]
    ['1', 't − a']
    """
    scheme = SCHEMES[procedure]
    n = whole(degree, "degree", 1, ParameterError) + scheme.raised
    t = _taken(knots, scheme.knots(n), "knots", procedure, homogeneous)
    u = _taken(arguments, scheme.arguments(n), "arguments", procedure, homogeneous, n if scheme.partial else 0)
    P = given(t, n)
    with recording([*t[:n], *u, DELTA, *t[n:]], scheme.shared) as values:
        results = {*scheme.run(P, t, u)[:, 0].tolist()}
    if scheme.face:
        base = {knot(x) for x in u[:n]}
        values.sort(key=lambda value: not base.isdisjoint(value.arguments))
    layout = Layout(P[:, 0].tolist(), values)
    if scheme.downward:
        return picture(
            layout,
            scheme.title,
            results=results,
            text=lambda value, spot: _function((spot.x - spot.y) // 2, n - spot.y),
            keep=_leading_to(results, layout),
            downward=True,
        )
    named = dict(zip(P[:, 0], names("P", 0, len(P) - 1), strict=True))
    return picture(layout, scheme.title, names=named, results=results)


def _taken(
    values: Iterable[Any] | None, usual: Written, what: str, procedure: str, homogeneous: bool, up_to: int = 0
) -> Array:
    """Return the knots that are given, or the usual ones; as many as those, or 1 … `up_to`."""
    if values is None:
        return knots_of(homogenised(x) if homogeneous else x for x in usual)
    t = knots_of(values)
    if len(t) not in (range(1, up_to + 1) if up_to else (len(usual),)):
        count = f"1 … {up_to}" if up_to else len(usual)
        raise KnotError(f"{len(t)} {what} given; expected {count} for procedure {procedure!r}")
    return t


def homogenised(knot: Any) -> Any:
    """Return (t₁, w₁) for t₁ and (u₁, v₁) for u₁; numbers and other knots as they are."""
    weight = {"t": "w", "u": "v"}.get(knot[0]) if isinstance(knot, str) else None
    return (knot, weight + knot[1:]) if weight else knot


def _function(k: int, m: int) -> str:
    """Return the name of basis function k of degree m, which for degree 0 is 1."""
    return f"b_{{{k}}}^{{{m}}}" if m else "1"


def _leading_to(results: Collection[Value], layout: Layout) -> set[Spot]:
    """Return the spots of what is made of any of the results, and of these: downward, what leads to them."""
    leading = set(results)
    for value in layout.values.values():  # in the order in which they were made
        if not leading.isdisjoint(value.parents):
            leading.add(value)
    return {spot for spot, value in layout.values.items() if value in leading}
