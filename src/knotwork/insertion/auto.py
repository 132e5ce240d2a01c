"""Which method is fastest: the rule behind `method="auto"`, by crossovers that `make crossovers` prints."""

from __future__ import annotations

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.space import SplineSpace
from knotwork.spline import Spline

#: where Boehm's algorithm takes less than 0.87 of the time of the merge, in 1-D and 3-D, by degree:
#: (share of new knots from the first to the last new one, least number of new knots), …
CROSSOVERS: dict[int, tuple[tuple[float, int], ...]] = {
    4: ((0.99, 1000),),
    5: ((0.75, 3000), (0.99, 1000)),
    6: ((0.75, 1000),),
    7: ((0.75, 1000),),
    8: ((0.75, 1000),),
    9: ((0.5, 1000), (0.99, 300)),
}
#: fewer new knots than any crossover has
FEW = min((least for rows in CROSSOVERS.values() for _, least in rows), default=1)
#: from this degree on, that of the highest one measured holds
HIGHEST = max(CROSSOVERS, default=0)
#: for more of them the points cost more than the weights, and of points the merge combines fewer
COORDINATES = 4


def takes_boehm(spline: Spline, axis: int, new: Array) -> bool:
    """Tell whether Boehm's algorithm is the fastest for several knots.

    Not so for float32, which it would round at every knot.
    """
    P, space = spline.coefficients, spline.spaces[axis]
    return len(new) >= FEW and P.dtype != np.float32 and fastest(space, new, P.size // space.dimension) == "boehm"


def fastest(space: SplineSpace, new: Array, coordinates: int) -> str:
    """Return the name of the fastest method to insert sorted knots, among those that only average.

    A row of the merge has v (v + 1) / 2 weights if v of its arguments are new, Boehm's algorithm has `degree` weights a
    knot, but more to prepare. So it is faster for many new knots of high degree with few old ones between them.

    Parameters
    ----------
    space : SplineSpace
    new : ndarray
        Several knots in the domain, sorted.
    coordinates : int
        How many numbers there are for each coefficient of the space.

    Examples
    --------
    >>> import numpy as np
    >>> fastest(SplineSpace.bezier(3, [0, 1]), np.linspace(0.1, 0.9, 20), 3)
    'merge'
    """
    if len(new) < FEW or coordinates > COORDINATES or space.exact:
        return "merge"
    t = space.knots
    between = int(t.searchsorted(new[-1]) - t.searchsorted(new[0]))
    share = len(new) / (len(new) + between)
    rows = CROSSOVERS.get(min(space.degree, HIGHEST), ())
    return "boehm" if any(share >= dense and len(new) >= least for dense, least in rows) else "merge"
