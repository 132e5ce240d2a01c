"""Matrix methods (§4.11, §4.17): the knot insertion matrix by rows, by columns, and by Mørken's identity.

Row i holds the discrete B-splines α_j(i) of the columns j = q - n … q; q is the interval that vertex i is found in.
"""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.insertion.methods.perspectives import by_intervals
from knotwork.schemes import combine, copy, copy_points, handed_down


@kernel
def row(E, a, b, x, n, one):
    """E[r] = α_{q-n+r}(i): the weights of an Oslo triangle of x_1 … x_n (Oslo I, Eq. 4.1).

    A weight is handed down in two parts, and each new one is a sum of two: §4.17 counts so, also where one is a zero.
    """
    zero = one - one
    E[0] = one
    for k in range(1, n + 1):
        handed_down(E, a, b, n - k, k, x[k - 1], zero)
        E[k] = E[k] + zero - zero


@kernel
def rows(E, U, T, old, where, n, one):
    """Find every row by itself; the row of an old vertex has a one alone."""
    for i in range(len(E)):
        q = where[i]
        for r in range(n + 1):
            E[i, r] = one - one
        if old[i] >= 0:
            E[i, old[i] - q + n] = one
        else:
            row(E[i], U[q - n + 1 :], U[q + 1 :], T[i + 1 :], n, one)


@kernel
def columns(E, U, W, interval, at, where, s, c):
    """Find every column by Boehm's algorithm for the control points δ_ij, without the combinations of zeros (§4.17).

    New knot w lies in old interval[w]; column j begins at row at[j]. Knots in the first interval of B-spline j go in in
    decreasing order, those in the others in increasing order: that meets the most zeros.

    s is room for knots, c for a column: points of one coordinate. Behind these c holds a 1, and a 0 that stands for the
    points before the first and after the last.
    """
    n, one, beside, D = E.shape[1] - 1, c[len(c) - 2, 0], len(c) - 1, c[0]
    for i in range(len(E)):
        for r in range(n + 1):
            E[i, r] = one - one
    lo = mid = hi = 0
    for j in range(len(at)):
        while lo < len(W) and interval[lo] < j:
            lo += 1
        while mid < len(W) and interval[mid] <= j:
            mid += 1
        while hi < len(W) and interval[hi] <= j + n:
            hi += 1
        for k in range(n + 2):
            s[k] = U[j + k]
        c[0, 0] = one
        for k in range(hi - lo):
            w = mid - 1 - k if k < mid - lo else lo + k
            q = 0 if k < mid - lo else interval[w] - j + k
            for i in range(k + 1, q, -1):
                c[i, 0] = c[i - 1, 0]
            for i in range(min(k + 1, q), max(q - n, -1), -1):
                combine(c[i], c[i - 1 if i > 0 else beside], c[i if i <= k else beside], s[i], s[i + n], W[w], D)
            for i in range(n + 1 + k, q, -1):
                s[i + 1] = s[i]
            s[q + 1] = W[w]
        for i in range(hi - lo + 1):
            E[at[j] + i, j - where[at[j] + i] + n] = c[i, 0]


@kernel
def morken(E, U, T, old, where, n, one):
    """Fill the rows from the top, each from the left, by an identity of neighbouring entries (Eq. 4.8).

    With a = T_{i+n}, b = T_i: (t_{j+n+1} - b) α_j(i) = (t_{j+n+1} - a) α_j(i-1)
    + (t_{j+n+1} - t_j) / (t_{j+n} - t_{j-1}) [(a - t_{j-1}) α_{j-1}(i-1) - (b - t_{j-1}) α_{j-1}(i)].
    Rows of old vertices are known; the first row, and one that the domain does not see, is found by itself.
    """
    zero = one - one
    first, last = U[n], U[len(U) - n - 1]
    for i in range(len(E)):
        q = where[i]
        seen = first < T[i + n + 1] and T[i] < last
        for r in range(n + 1):
            E[i, r] = zero
        if old[i] >= 0:
            E[i, old[i] - q + n] = one
        elif i == 0 or not seen:
            row(E[i], U[q - n + 1 :], U[q + 1 :], T[i + 1 :], n, one)
        else:
            a, b, shift = T[i + n], T[i], q - where[i - 1]
            for r in range(n + 1):
                j = q - n + r
                above = E[i - 1, r + shift] if r + shift <= n else zero
                corner = E[i - 1, r + shift - 1] if 1 <= r + shift <= n + 1 else zero
                beside = E[i, r - 1] if r > 0 else zero
                t = U[j + n + 1]
                E[i, r] = (t - a) * above
                if j > 0:
                    e = U[j - 1]
                    ratio = (t - U[j]) / (U[j + n] - e)
                    E[i, r] = E[i, r] + ratio * ((a - e) * corner - (b - e) * beside)
                E[i, r] = E[i, r] / (t - b)


@kernel
def product(S, X, F, lo, hi, D):
    """S = Σ X_j F_j for lo <= j <= hi."""
    for c in range(len(D)):
        S[c] = X[lo] * F[lo, c]
    for j in range(lo + 1, hi + 1):
        for c in range(len(D)):
            S[c] = S[c] + X[j] * F[j, c]


@kernel
def apply(out, E, P, old, where, n, D):
    """out = E P, where old vertices are copied."""
    for i in range(len(out)):
        if old[i] >= 0:
            copy(out[i], P[old[i]], D)
        else:
            product(out[i], E[i], P[where[i] - n :], 0, n, D)


# ---- Goldman's two triangles as matrices, which make the points of a group at once (§4.17) --------------------------


@kernel
def weights(G, a, b, x, e, count, levels):
    """G[r, j] = weight of the right parent of point j of level r + 1, in a triangle over count + 1 points.

    The arguments go in upwards from x_1 for e > 0, downwards to x_2 for e < 0.
    """
    for r in range(levels):
        u = x[r] if e > 0 else x[levels - r]
        for j in range(count - r):
            G[r, j] = (u - a[j + r]) / (b[j] - a[j + r])


@kernel
def set_to(X, I, count):
    """X = I, the unit matrix."""
    for i in range(count):
        for j in range(count):
            X[i, j] = I[i, j]


@kernel
def next_columns(X, G, m, r):
    """X[j] = coefficients of point j of level r + 1 in the points of the base, from those of level r, for j < m."""
    for j in range(m):
        w = G[r, j]
        v = 1 - w
        for k in range(j, j + r + 2):
            X[j, k] = v * X[j, k] + w * X[j + 1, k]


@kernel
def given_shares(e, a, b, u):
    """Return what P and Q get of the weight e of S = (1 - w) P + w Q, where w is given as a."""
    right = a * e
    return e - right, right


handed_by_weights = handed_down.variant(shares=given_shares)


@kernel
def from_apex(E, G, k, j, one):
    """E[i] = coefficient of base point j + i in point j of level k: as in `row`, from the weights G."""
    zero = one - one
    E[0] = one
    for i in range(1, k + 1):
        handed_by_weights(E, G[k - i], G[k - i], j, i, one, zero)
        E[i] = E[i] + zero - zero


@kernel
def triangles_by_columns(Z, t, b, m, room):
    """Both triangles for every unit vector at once; the weights are shared."""
    n, F, D = room.n, room.A[0], room.D
    G, X, unit = room.weights[0], room.weights[1], room.weights[2]
    k = 0
    while k < m:
        g = min(n + 1, m - k)
        top, rest = min(g, n), n - g + 1
        copy_points(F, Z[k:], n + 1, D)
        weights(G, t[k:], b, t[k + n :], 1, n, top)
        set_to(X, unit, n + 1)
        for r in range(top):
            product(Z[k + r], X[0], F, 0, r, D)
            next_columns(X, G, n - r, r)
        for j in range(n - top + 1):
            product(Z[k + top + j], X[j], F, j, j + top, D)
        weights(G, t[k + rest :], b[rest:], t[k + n :], -1, g - 1, g - 1)
        set_to(X, unit, g)
        for r in range(g - 1):
            next_columns(X, G, g - 1 - r, r)
        for j in range(g):
            product(Z[k + n + 1 + j], X[j], F[rest:], j, g - 1, D)
        k += g


@kernel
def triangles_by_rows(Z, t, b, m, room):
    """One triangle, top down, for every new vertex; those of one group are parts of two, which share the weights."""
    n, F, D = room.n, room.A[0], room.D
    G, E, one = room.weights[0], room.weights[1, 0], room.weights[2, 0, 0]
    k = 0
    while k < m:
        g = min(n + 1, m - k)
        top, rest = min(g, n), n - g + 1
        copy_points(F, Z[k:], n + 1, D)
        weights(G, t[k:], b, t[k + n :], 1, n, top)
        for i in range(n + 1):
            height, j = min(i, top), max(i - top, 0)
            from_apex(E, G, height, j, one)
            product(Z[k + i], E, F[j:], 0, height, D)
        weights(G, t[k + rest :], b[rest:], t[k + n :], -1, g - 1, g - 1)
        for j in range(g):
            from_apex(E, G, g - 1 - j, j, one)
            product(Z[k + n + 1 + j], E, F[rest + j :], 0, g - 1 - j, D)
        k += g


goldman_columns = by_intervals.variant(step=triangles_by_columns)
goldman_rows = by_intervals.variant(step=triangles_by_rows)
