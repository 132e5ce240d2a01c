"""Where a closed curve is best opened, and which of its joints are corners."""

from __future__ import annotations

import math

from knotwork.arithmetic.kernel import kernel

#: a joint of a curve is a corner where its tangent turns by more than this, in degrees
CORNER = 10.0
#: a straight run of that many units is a line
LONG = 4.0
#: part of the first piece by which the others may be off its line, for the rounding of their points
LEVEL = 1e-9
#: tolerances over which the direction of a polyline is seen
REACH = 4.0
#: pieces looked at on each side of a joint, at most
LOOK = 64


@kernel
def turned(a, b):
    """Return the cosine of the angle between two vectors; 1 if one of them is zero."""
    along, one, other = 0.0, 0.0, 0.0
    for c in range(len(a)):
        along += a[c] * b[c]
        one += a[c] * a[c]
        other += b[c] * b[c]
    size = math.sqrt(one * other)
    return along / size if size > 0 else 1.0


@kernel(inline=False)
def tangent(net, at_end, per, out):
    """Write the direction of a net at its start or end: to the nearest control point that is another one."""
    n = len(net) - 1
    for m in range(1, n + 1):
        size = 0.0
        for c in range(len(out)):
            step = net[n, c] - net[n - m, c] if at_end else net[m, c] - net[0, c]
            out[c] = step * per[c]
            size += out[c] * out[c]
        if size > 0:
            break


@kernel(inline=False)
def corners(F, at, per, cosine, hard, a, b):
    """Mark joints of curves where the tangent turns by more than an angle of that cosine."""
    for curve in range(len(at) - 1):
        lo, hi = at[curve], at[curve + 1]
        for i in range(lo + 1, hi):
            tangent(F[i - 1], True, per, a)
            tangent(F[i], False, per, b)
            if turned(a, b) < cosine:
                hard[i + curve] = 1


@kernel(inline=False)
def toward(F, lo, hi, i, step, reach, per, out):
    """Write the vector from joint i of a closed curve to a place about `reach` along it, onward or back (step -1)."""
    D, n = len(out), hi - lo
    left, j = reach, i
    for c in range(D):
        out[c] = 0
    for _ in range(min(n, LOOK)):
        k = j if step > 0 else (j - 1 if j > lo else hi - 1)
        size = 0.0
        for c in range(D):
            side = (F[k, F.shape[1] - 1, c] - F[k, 0, c]) * per[c]
            size += side * side
        size = math.sqrt(size)
        part = 1.0 if size <= left else left / size
        for c in range(D):
            out[c] += step * part * (F[k, F.shape[1] - 1, c] - F[k, 0, c]) * per[c]
        left -= size
        if left <= 0:
            return
        j = (j + 1 if j + 1 < hi else lo) if step > 0 else k


@kernel(inline=False)
def sharpest(F, at, per, closed, reach, starts, a, b):
    """Write for each closed curve the joint where it turns most, seen at `reach` units from it; 0 for open ones."""
    for curve in range(len(at) - 1):
        starts[curve] = 0
        if closed[curve]:
            lo, hi = at[curve], at[curve + 1]
            least = 2.0
            for i in range(lo, hi):
                toward(F, lo, hi, i, -1, reach, per, a)
                toward(F, lo, hi, i, 1, reach, per, b)
                cosine = -turned(a, b)
                if cosine < least:
                    least = cosine
                    starts[curve] = i - lo


@kernel(inline=False)
def directions(F, at, per, closed, cosine, out, both):
    """Write the direction of curves at their joints, midway between those on both sides; NaN at corners, 0 at ends.

    At a vertex of a closed polyline it is seen at REACH units.
    """
    a, b = both
    for curve in range(len(at) - 1):
        lo, hi = at[curve], at[curve + 1]
        for i in range(lo, hi + 1):
            end = i in (lo, hi)
            if end and not closed[curve]:
                continue
            tangent(F[i - 1 if i > lo else hi - 1], True, per, a)
            tangent(F[i if i < hi else lo], False, per, b)
            corner = turned(a, b) < cosine
            if F.shape[1] == 2 and closed[curve] and not corner and end:
                toward(F, lo, hi, lo, -1, REACH, per, a)
                toward(F, lo, hi, lo, 1, REACH, per, b)
                for c in range(len(a)):
                    a[c] = -a[c]
            one, other = 0.0, 0.0
            for c in range(len(a)):
                one += a[c] * a[c]
                other += b[c] * b[c]
            one, other = math.sqrt(one), math.sqrt(other)
            for c in range(len(a)):
                if corner:
                    out[i + curve, c] = math.nan
                elif one > 0 and other > 0:
                    out[i + curve, c] = a[c] / one + b[c] / other


@kernel(inline=False)
def bent(net, far, per, start, along):
    """Return how far the control points of a net are off the line from `start`, in the direction `along`, by length.

    Infinity if they do not run onward. far is how far along the line the net begins; returned too is where it ends.
    """
    size = 0.0
    for c in range(len(along)):
        size += along[c] * along[c]
    off = 0.0
    for i in range(len(net)):
        way = 0.0
        for c in range(len(along)):
            way += (net[i, c] - start[c]) * per[c] * along[c]
        way = way / size
        away = 0.0
        for c in range(len(along)):
            side = (net[i, c] - start[c]) * per[c] - way * along[c]
            away += side * side
        off = max(off, away / size)
        if way < far - LEVEL:
            return math.inf, way
        far = max(way, far)
    return math.sqrt(off), far


@kernel(inline=False)
def lines(F, strict, at, per, hard, a, b):
    """Mark the ends of straight runs that are longer than LONG units, as they count."""
    for curve in range(len(at) - 1):
        i, hi = at[curve], at[curve + 1]
        while i < hi:
            size = 0.0
            for c in range(len(a)):
                a[c] = F[i, 0, c]
                b[c] = (F[i, F.shape[1] - 1, c] - a[c]) * per[c]
                size += b[c] * b[c]
            far, j, most = 0.0, i, 0.0
            while j < hi and size > 0:
                off, end = bent(F[j], far, per, a, b)
                if off > LEVEL:
                    break
                far, j, most = end, j + 1, max(most, strict[j])
            if j > i and far * math.sqrt(size) * most > LONG:
                hard[i + curve] = hard[j + curve] = 1
            i = max(j, i + 1)
