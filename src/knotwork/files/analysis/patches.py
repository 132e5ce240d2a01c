"""What the formats of analysis share: patches of homogeneous control points, weights that are all one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.entry import checked
from knotwork.insertion import clamp
from knotwork.space import SplineSpace
from knotwork.spline import Spline


def patch(where: str, degrees: Sequence[int], knots: Sequence[Array], homogeneous: Array) -> Spline:
    """Return the spline of homogeneous points (points times weights, weights); polynomial if every weight is one.

    Parameters
    ----------
    where : str
        The place in the file, for errors.
    degrees, knots
        One per parameter.
    homogeneous : ndarray, shape (n1, …, nk, d + 1)
    """
    spaces = [
        checked(where, lambda n=n, t=t: SplineSpace(n, t))  # type: ignore[misc]
        for n, t in zip(degrees, knots, strict=True)
    ]
    rational = bool(np.any(homogeneous[..., -1] != 1))
    points = np.ascontiguousarray(homogeneous if rational else homogeneous[..., :-1])
    return checked(where, lambda: Spline(spaces, points, rational))


def patches(splines: Sequence[Spline], name: str, several: bool = True) -> list[Spline]:
    """Return splines that a file of analysis can hold, or say why not: of floats, in 1-D to 3-D, of one kind."""
    if not several and len(splines) > 1:
        raise FileError(f"{len(splines)} splines given; {name} holds one patch")
    for i, spline in enumerate(splines):
        if spline.coefficients.dtype.kind != "f" or spline.scalar or spline.dim > 3 or min(spline.degree) < 1:
            told = f"splines[{i}] is a {str(spline)[1:-1]}"
            raise FileError(f"{told}; expected floats in 1-D to 3-D, of degree 1 or more")
    if len({spline.parameters for spline in splines}) > 1:
        raise FileError(f"curves, surfaces and volumes given together; {name} holds one kind")
    return [clamp(spline) if any(space.periodic for space in spline.spaces) else spline for spline in splines]
