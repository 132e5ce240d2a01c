"""What a removal changed, worked out anew in exact arithmetic."""

from __future__ import annotations

from typing import Any

import numpy as np

import knotwork as kw
import oracle


def largest_coefficients(original: Any, result: Any, axis: int = 0) -> np.ndarray:
    """Return the largest coefficient of the difference in each (homogeneous) component, over the original knots."""
    exact, reduced = original.in_exact_arithmetic(), result.spline.in_exact_arithmetic()
    back = kw.insert(reduced, result.removed, axis=axis)
    assert back.spaces == exact.spaces
    change = back.coefficients - exact.coefficients
    return abs(change).reshape(-1, 1 if original.scalar else change.shape[-1]).max(axis=0)


def largest_lengths(original: Any, result: Any, axis: int = 0) -> Any:
    """Return the largest Euclidean length of a coefficient of the difference over the original knots, squared."""
    exact, reduced = original.in_exact_arithmetic(), result.spline.in_exact_arithmetic()
    back = kw.insert(reduced, result.removed, axis=axis)
    assert back.spaces == exact.spaces
    change = (back.coefficients - exact.coefficients).reshape(-1, original.width)
    return (change**2).sum(axis=1).max()


def true_distances(original: Any, reduced: Any, *u: Any) -> Any:
    """Return the largest Euclidean distance of the values, squared, exactly, from the definition of the B-spline."""
    distances = []
    for x in zip(*u, strict=True):
        p, q = (oracle.spline_value(s, *x) for s in (original, reduced))
        if original.rational:
            p, q = p[:-1] / p[-1], q[:-1] / q[-1]
        distances.append((np.atleast_1d(p - q) ** 2).sum())
    return max(distances)


def true_errors(original: Any, reduced: Any, *u: Any) -> np.ndarray:
    """Return the largest difference of the values in each component, exactly, from the definition of the B-spline."""
    differences = []
    for x in zip(*u, strict=True):
        p, q = (oracle.spline_value(s, *x) for s in (original, reduced))
        if original.rational:
            p, q = p[:-1] / p[-1], q[:-1] / q[-1]
        differences.append(np.atleast_1d(abs(p - q)))
    return np.max(differences, axis=0)
