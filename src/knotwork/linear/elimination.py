"""Square banded systems with a totally positive matrix: interpolation by splines, rows of an insertion matrix.

Gaussian elimination in the given order is stable for them, without pivoting (de Boor & Pinkus 1977): no entry grows.
So it stays banded, and is exact in exact arithmetic.
"""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.arithmetic.kernel import kernel
from knotwork.linear.banded import Banded


@kernel
def eliminate(first, E, y):
    """Solve A·x = y in place of y; row i of A has the entries E[i] from column first[i] on, and `first` never falls."""
    width = E.shape[1]
    for i in range(len(first)):
        for k in range(first[i], i):
            factor = E[i, k - first[i]] / E[k, k - first[k]]
            for j in range(k + 1, first[k] + width):
                E[i, j - first[i]] = E[i, j - first[i]] - factor * E[k, j - first[k]]
            for c in range(y.shape[1]):
                y[i, c] = y[i, c] - factor * y[k, c]
    for i in range(len(first) - 1, -1, -1):
        for c in range(y.shape[1]):
            total = y[i, c]
            for j in range(i + 1, first[i] + width):
                total = total - E[i, j - first[i]] * y[j, c]
            y[i, c] = total / E[i, i - first[i]]


def solve(A: Banded, y: Array) -> Array:
    """Return the x with A·x = y.

    Parameters
    ----------
    A : Banded, shape (n, n)
        Totally positive, with positive diagonal; its rows start at columns that never fall.
    y : ndarray, shape (n,) or (n, d)
        Real, in the arithmetic of A.
    """
    x = np.array(y, A.entries.dtype)
    eliminate(A.first, A.entries.copy(), x.reshape(len(x), -1))
    return x
