"""The schemes of chapters 2 to 4, each one text: all of them are made of one step, in one of four forms.

The step makes the blossom value S = B(…, u) of P = B(…, a) and Q = B(…, b), which share all other arguments:

    standard      (1 - w) P + w Q,  w = (u - a) / (b - a)           `combine`: what a scheme is written over
    rewritten     P + w (Q - P)
    factored      P + (u - a) Q,  where b is δ: there is no division
    homogeneous   (b × u P + u × a Q) / b × a,  where knots are pairs (t, w) and x × y = x_t y_w - y_t x_w

`triangle.variant(combine=homogeneous)` is the same triangle over homogeneous knots, and so with all others.
Run top down, from a weight 1 at the apex to weights E of the points at the base, the step hands the weight of S on to
P and Q: `shares`, in the same forms.

Letters: a and b are the knots at the left and at the right of n + 1 points F, F[j] = B(a_{j+1} … a_n, b_1 … b_j);
x are the arguments that go in, or u if it is one; S is what is made. Counted from 0, a_1 is a[0].
"""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel


@kernel
def combine(S, P, Q, a, b, u, D):
    """S = B(…, u) from P = B(…, a) and Q = B(…, b): (1 - w) P + w Q, the standard form (§4.10)."""
    w = (u - a) / (b - a)
    v = 1 - w
    for c in range(len(D)):
        S[c] = v * P[c] + w * Q[c]


@kernel
def rewritten(S, P, Q, a, b, u, D):
    """S = B(…, u) from P = B(…, a) and Q = B(…, b): P + w (Q - P), the rewritten form (§4.10)."""
    w = (u - a) / (b - a)
    for c in range(len(D)):
        S[c] = P[c] + w * (Q[c] - P[c])


@kernel
def factored(S, P, Q, a, b, u, D):
    """S = B(…, u) from P = B(…, a) and Q = B(…, δ): P + (u - a) Q, the factored form (§3.2); b is not used."""
    w = u - a
    for c in range(len(D)):
        S[c] = P[c] + w * Q[c]


@kernel
def quotient(x, y):
    """x / y."""
    return x / y


@kernel
def complex_quotient(x, y):
    """x / y by divisions of real numbers, on which plain and compiled code agree to the last bit; y is scaled first."""
    s = 1 / max(abs(y.real), abs(y.imag))
    c = y * s
    return x * c.conjugate() * (s / (c.real * c.real + c.imag * c.imag))


@kernel
def homogeneous(S, P, Q, a, b, u, D):
    """S = B(…, u) from P = B(…, a) and Q = B(…, b) over pairs: (b × u P + u × a Q) / b × a (§2.3.2)."""
    d = b[0] * a[1] - a[0] * b[1]
    p = quotient(b[0] * u[1] - u[0] * b[1], d)
    q = quotient(u[0] * a[1] - a[0] * u[1], d)
    for c in range(len(D)):
        S[c] = p * P[c] + q * Q[c]


@kernel
def copy(S, P, D):
    """S = P."""
    for c in range(len(D)):
        S[c] = P[c]


@kernel
def copy_points(S, F, m, D):
    """S[j] = F[j] for j < m."""
    for j in range(m):
        copy(S[j], F[j], D)


@kernel
def level(S, F, a, b, m, u, D):
    """S[j] combines F[j] and F[j + 1], where the knots a[j] and b[j] give way to u, for j < m. S may be F."""
    for j in range(m):
        combine(S[j], F[j], F[j + 1], a[j], b[j], u, D)


@kernel
def triangle(S, F, a, b, x, n, D):
    """S = B(x_1 … x_n), the apex of n levels over F, which is overwritten (§2.2.2; an Oslo triangle, Fig. 4.2)."""
    for r in range(n):
        level(F, F, a[r:], b, n - r, x[r], D)
    copy(S, F[0], D)


@kernel
def shares(e, a, b, u):
    """Return what P and Q get of the weight e of S = (1 - w) P + w Q: e - w e, and w e."""
    right = (u - a) / (b - a) * e
    return e - right, right


@kernel
def homogeneous_shares(e, a, b, u):
    """Return what P and Q get of the weight e of S over pairs, as in `homogeneous`."""
    d = b[0] * a[1] - a[0] * b[1]
    p = quotient(b[0] * u[1] - u[0] * b[1], d)
    q = quotient(u[0] * a[1] - a[0] * u[1], d)
    return p * e, q * e


@kernel
def handed_down(E, a, b, r, m, u, zero):
    """E = weights of the m + 1 points of a level, from those of the m that `level` makes of them over a[r:] and b."""
    carried = zero
    for j in range(m):
        left, right = shares(E[j], a[r + j], b[j], u)
        E[j] = carried + left
        carried = right
    E[m] = carried


@kernel
def weights(E, a, b, x, n, zero):
    """E[j] = weight of F[j] in B(x_1 … x_n): the triangle run top down (§2.2.1; Oslo I, Eq. 4.1)."""
    E[0] = zero + 1
    for k in range(1, n + 1):
        handed_down(E, a, b, n - k, k, x[k - 1], zero)


@kernel
def between(F, a, b, n, u, D):
    """F[0 … n + 1] over a, u, b from F[0 … n] over a, b: Boehm's algorithm for one knot (§2.2.3, §4.5)."""
    copy(F[n + 1], F[n], D)
    for j in range(n, 0, -1):
        combine(F[j], F[j - 1], F[j], a[j - 1], b[j - 1], u, D)


@kernel
def tetrahedron(S, R, a, b, x, p, n, D):
    """S[s] = B(x_{s+1} … x_{s+n}) for 0 <= s <= p from R[0], the points that have the arguments x_{p+1} … x_n already.

    Up the veer face with x_{n+1}, …, x_{n+p}; at each height s parallel to the base with x_p, …, x_{s+1} (§2.2.5, §4.7,
    Fig. 4.3). R[0] has p + 1 points over a_1 … a_p, b and is overwritten, R[1] is room for as many.
    """
    for s in range(p + 1):
        copy_points(R[1], R[0], p - s + 1, D)
        for r in range(p - s):
            level(R[1], R[1], a[s + r :], b, p - s - r, x[p - 1 - r], D)
        copy(S[s], R[1, 0], D)
        if s < p:
            level(R[0], R[0], a[s:], b, p - s, x[n + s], D)


@kernel
def halves(S, R, a, b, x, k, stack, D):
    """S[s] = B(x_{s+1} … x_{s+n}) for s < k from the row R[0] of n + 1 points: what a tetrahedron needs (Fig. 4.8).

    The arguments x_k … x_n that all of them have go in first. Then the row serves both halves of them: in addition,
    the first gets x_{k-1}, x_{k-2}, …, the second x_{n+1}, …; and so on with halves of halves (§2.2.5, §4.9). R has a
    row, and the stack a pair, for each halving and two more.
    """
    n = R.shape[1] - 1
    for r in range(n - k + 1):
        level(R[0], R[0], a[r:], b, n - r, x[k - 1 + r], D)
    stack[0, 0], stack[0, 1] = 0, k - 1
    top = 0
    while top >= 0:  # R[top] is the row of the points stack[top], which are still to be made
        lo, hi = stack[top, 0], stack[top, 1]
        if lo == hi:
            copy(S[lo], R[top, 0], D)
            top -= 1
        else:
            mid, m = (lo + hi) // 2, hi - lo
            copy_points(R[top + 1], R[top], m + 1, D)
            for r in range(mid - lo + 1):
                level(R[top], R[top], a[n - m + r :], b, m - r, x[n + lo + r], D)
            for r in range(hi - mid):
                level(R[top + 1], R[top + 1], a[n - m + r :], b, m - r, x[hi - 1 - r], D)
            stack[top, 0], stack[top, 1] = mid + 1, hi
            stack[top + 1, 0], stack[top + 1, 1] = lo, mid
            top += 1
