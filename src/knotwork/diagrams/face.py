"""The two faces of all diagrams: the scheme of a procedure by its name, and a figure of the book by its number."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from knotwork.diagrams import insertion_figures, progressive_figures
from knotwork.diagrams.drawing import Diagram
from knotwork.diagrams.insertion import DRAWN, method_diagram
from knotwork.diagrams.progressive import SCHEMES, procedure_diagram
from knotwork.diagrams.progressive_figures import numbered
from knotwork.errors import ParameterError
from knotwork.insertion.methods.catalogue import METHODS

#: the figures by their numbers in the book
FIGURES = {**progressive_figures.FIGURES, **insertion_figures.FIGURES}


def diagram(
    name: str,
    degree: int = 3,
    *,
    knots: Iterable[Any] | None = None,
    arguments: Iterable[Any] | None = None,
    homogeneous: bool = False,
    new: int | None = None,
) -> Diagram:
    """Draw the scheme of a procedure, from the procedure itself: it runs over knots that are names.

    A node shows its blossom arguments. The arrows into a node carry the factors of the two values that it is combined
    from, without their common denominator. What is given is shaded, what the procedure is run for is red.

    Parameters
    ----------
    name : str
        A procedure of one polynomial segment, one of `SCHEMES` (chapters 1 and 2), or a method of
        `knotwork.insertion.METHODS` that makes points from points (chapters 3 and 4). Some algorithms are both:
        "goldman" inserts knots, "goldman-change" changes the basis of a segment.
    degree : int
        At least 1.
    knots : iterable, optional
        Other knots than the usual ones: see `knotwork.diagrams.progressive` and `knotwork.diagrams.insertion`.
    arguments : iterable, optional
        Other blossom arguments; of a procedure.
    homogeneous : bool
        Whether the usual knots are homogeneous; of a procedure.
    new : int, optional
        How many new knots go in; of a method.

    Returns
    -------
    Diagram
        With `svg()`, and `draw(axes)` for matplotlib.

    Raises
    ------
    ParameterError
        If there is no such procedure or method, or it does not take what is given.
    KnotError
        If the knots or arguments do not fit.

    Examples
    --------
    >>> [str(edge.label) for edge in diagram("de casteljau", 1, arguments=["a"]).edges]
    ['1 − a', 'a']
    >>> [edge.label for edge in diagram("boehm", 2, new=1).edges]
    ['t₃ − u₁', 'u₁ − t₁', 't₄ − u₁', 'u₁ − t₂']
    """
    if name in SCHEMES:
        if new is not None:
            raise ParameterError(f"new={new} given; procedure {name!r} takes `arguments`")
        return procedure_diagram(name, degree, knots=knots, arguments=arguments, homogeneous=homogeneous)
    if name not in METHODS:
        raise ParameterError(f"procedure {name!r} given; expected one of {', '.join((*SCHEMES, *DRAWN))}")
    if arguments is not None or homogeneous:
        raise ParameterError(f"arguments or homogeneous knots given; method {name!r} takes `new` or `knots`")
    return method_diagram(name, degree, new=new, knots=knots)


def figure(number: str) -> Diagram:
    """Draw a figure of chapters 1 to 4 of the book, by its number, from the procedure that it shows.

    What is read from the procedures is the schemes; divided differences (3.1, and the upper halves of 3.6 and 3.7) are
    made for the picture.

    Parameters
    ----------
    number : str
        "1.1" … "1.5", "2.1" … "2.4", "2.5a", "2.5b", "2.6" … "2.18", "3.1" … "3.10", "4.1" … "4.15"; `FIGURES` has
        their captions.

    Raises
    ------
    ParameterError
        If there is no such figure.

    Examples
    --------
    >>> figure("2.16").title
    "Fig. 2.16. From monomial to Bézier form: Pascal's triangle, reversed."
    >>> figure("4.1").title
    "Fig. 4.1. Boehm's algorithm: one knot."
    """
    return numbered(FIGURES, number)
