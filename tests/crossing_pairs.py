"""The edges of polylines that cross, by solving for every pair in fractions."""

from fractions import Fraction


def crossing_pairs(lines):
    """Return rows of line, edge, line, edge: pairs that meet in a point that is not a vertex of both."""
    edges = [
        (i, k, *(tuple(map(float, p)) for p in line[k : k + 2]))
        for i, line in enumerate(lines)
        for k in range(len(line) - 1)
    ]
    return [
        [i, k, j, m]
        for n, (i, k, a, b) in enumerate(edges)
        for j, m, c, d in edges[n + 1 :]
        if a != b and c != d and {a, b} != {c, d} and not apart(a, b, c, d) and meet(a, b, c, d)
    ]


def apart(a, b, c, d):
    """Tell whether all of one edge is left of or below all of the other."""
    return any(max(a[x], b[x]) < min(c[x], d[x]) or max(c[x], d[x]) < min(a[x], b[x]) for x in (0, 1))


def meet(a, b, c, d):
    """Solve a + s (b - a) = c + t (d - c)."""
    a, b, c, d = (tuple(map(Fraction, p)) for p in (a, b, c, d))
    (dx, dy), (gx, gy), (wx, wy) = ((q[0] - p[0], q[1] - p[1]) for p, q in ((a, b), (c, d), (a, c)))
    det = dx * gy - dy * gx
    if det:
        s, t = (wx * gy - wy * gx) / det, (wx * dy - wy * dx) / det
        return 0 <= s <= 1 and 0 <= t <= 1 and not (s in (0, 1) and t in (0, 1))
    if wx * dy - wy * dx:
        return False
    first, last = sorted(((q[0] - a[0]) * dx + (q[1] - a[1]) * dy) / (dx * dx + dy * dy) for q in (c, d))
    return max(first, 0) < min(last, 1)
