"""Contenders of the benchmark: each does the task on plain arrays, as a Python user pays for it, or not at all.

A contender is a module-level class whose static methods have the names of the tasks in `peers.py`; a task that it lacks
is not run. Peers that are not installed are left out.
"""

import importlib.util

import numpy as np

import knotwork as kw


class Knotwork:
    """This library."""

    @staticmethod
    def insert(t, n, P, new):
        spline = kw.insert(kw.curve(P, n, t), new)
        return spline.space.knots, spline.points

    @staticmethod
    def insert_value(spline, new):
        """The operation alone, on a spline that is there."""
        return kw.insert(spline, new)

    @staticmethod
    def evaluate(t, n, P, u):
        return kw.curve(P, n, t)(u)

    @staticmethod
    def derivatives(t, n, P, u):
        return kw.curve(P, n, t).derivatives(u, 3)

    @staticmethod
    def bezier(t, n, P):
        return kw.to_bezier(kw.curve(P, n, t))

    @staticmethod
    def elevate(t, n, P):
        return kw.elevate(kw.curve(P, n, t)).points

    @staticmethod
    def split(t, n, P, u):
        return [part.points for part in kw.split(kw.curve(P, n, t), u)]

    @staticmethod
    def surface(t, n, P, new):
        surface = kw.surface(P, (n, n), (t, t))
        return kw.insert(kw.insert(surface, new, 0), new, 1).points

    @staticmethod
    def remove(t, n, P, knots):
        return kw.remove(kw.curve(P, n, t), knots, tolerance=1e-9).spline.points

    @staticmethod
    def reduce(t, n, P, tolerance):
        return kw.reduce(kw.curve(P, n, t), tolerance).spline.points

    @staticmethod
    def zeros(t, n, c):
        return kw.zeros(kw.curve(c, n, t)).values

    @staticmethod
    def intersect(a, b):
        return kw.intersect(kw.curve(*a), kw.curve(*b)).points

    @staticmethod
    def closest(t, n, P, points):
        return kw.closest(kw.curve(P, n, t), points).parameters

    @staticmethod
    def flatten(t, n, P, tolerance):
        return kw.flatten(kw.curve(P, n, t), tolerance).points

    @staticmethod
    def distance(a, b):
        return kw.distance(kw.curve(*a), kw.curve(*b)).hausdorff


class Scipy:
    """scipy.interpolate."""

    @staticmethod
    def insert(t, n, P, new):
        from scipy.interpolate import BSpline, make_interp_spline

        spline = BSpline(t, P, n)
        if np.ndim(new) == 0:
            spline = spline.insert_knot(new)
            return spline.t, spline.c
        T = np.sort(np.concatenate([t, new]))
        nodes = sum(T[j : len(T) - n - 1 + j] for j in range(1, n + 1)) / n
        return T, make_interp_spline(nodes, spline(nodes), n, t=T).c

    @staticmethod
    def evaluate(t, n, P, u):
        from scipy.interpolate import BSpline

        return BSpline(t, P, n)(u)

    @staticmethod
    def derivatives(t, n, P, u):
        from scipy.interpolate import BSpline

        spline = BSpline(t, P, n)
        return [spline(u, nu) for nu in range(4)]

    @staticmethod
    def bezier(t, n, P):
        from scipy.interpolate import BSpline, PPoly

        return [PPoly.from_spline(BSpline(t, np.ascontiguousarray(x), n)).c for x in P.T]

    @staticmethod
    def zeros(t, n, c):
        from scipy.interpolate import PPoly

        return PPoly.from_spline((t, c, n)).roots(extrapolate=False)


class Bezier:
    """bezier: single Bézier curves."""

    @staticmethod
    def intersect(a, b):
        if len(a[0]) != a[1] + 1 or len(b[0]) != b[1] + 1:
            return None
        from bezier import Curve

        one, two = (Curve(np.asfortranarray(P.T), n) for P, n, _ in (a, b))
        return one.intersect(two)


class Shapely:
    """shapely: of polylines of 16 points an interval, as one would give it curves; nothing is said of the curves."""

    @staticmethod
    def _line(P, n, t):
        from shapely import LineString

        breaks = np.unique(t)
        u = (breaks[:-1, None] + np.arange(16) / 16 * np.diff(breaks)[:, None]).ravel()
        return LineString(kw.curve(P, n, t)(np.append(u, breaks[-1])))

    @staticmethod
    def intersect(a, b):
        return Shapely._line(*a).intersection(Shapely._line(*b))

    @staticmethod
    def closest(t, n, P, points):
        import shapely

        return shapely.line_locate_point(Shapely._line(P, n, t), shapely.points(points))

    @staticmethod
    def distance(a, b):
        return Shapely._line(*a).hausdorff_distance(Shapely._line(*b))


class Pantr:
    """pantr: Numba kernels too."""

    @staticmethod
    def _curve(t, n, P):
        from pantr.bspline import Bspline, BsplineSpace, BsplineSpace1D

        return Bspline(BsplineSpace([BsplineSpace1D(t, n, snap_knots=False)]), P)

    @staticmethod
    def insert(t, n, P, new):
        return Pantr._curve(t, n, P).insert_knots(np.atleast_1d(new)).control_points

    @staticmethod
    def insert_value(spline, new):
        return spline.insert_knots(np.atleast_1d(new))

    @staticmethod
    def evaluate(t, n, P, u):
        return Pantr._curve(t, n, P).evaluate(u)

    @staticmethod
    def bezier(t, n, P):
        return Pantr._curve(t, n, P).to_beziers() if len(P) <= 1000 else None

    @staticmethod
    def elevate(t, n, P):
        return Pantr._curve(t, n, P).elevate_degree(1).control_points

    @staticmethod
    def split(t, n, P, u):
        return [part.control_points for part in Pantr._curve(t, n, P).split(0, u)]

    @staticmethod
    def surface(t, n, P, new):
        from pantr.bspline import Bspline, BsplineSpace, BsplineSpace1D

        space = BsplineSpace1D(t, n, snap_knots=False)
        return Bspline(BsplineSpace([space, space]), P).insert_knots([new, new]).control_points

    @staticmethod
    def remove(t, n, P, knots):
        return Pantr._curve(t, n, P).remove_knots(knots, tol=1e-9).control_points


class Splipy:
    """splipy."""

    @staticmethod
    def insert(t, n, P, new):
        if len(P) + np.size(new) > 1001:  # quadratic
            return None
        from splipy import BSplineBasis, Curve

        curve = Curve(BSplineBasis(n + 1, t), P)
        curve.insert_knot(np.atleast_1d(new))
        return curve.controlpoints

    @staticmethod
    def evaluate(t, n, P, u):
        if len(P) > 1000:
            return None
        from splipy import BSplineBasis, Curve

        return Curve(BSplineBasis(n + 1, t), P)(u)


class Geomdl:
    """geomdl (NURBS-Python)."""

    @staticmethod
    def insert(t, n, P, new):
        if np.ndim(new) or len(P) > 1000:
            return None
        from geomdl import BSpline, operations

        curve = BSpline.Curve()
        curve.degree = n
        curve.ctrlpts = P.tolist()
        curve.knotvector = t.tolist()
        return operations.insert_knot(curve, [float(new)], [1]).ctrlpts


PEERS = {
    "scipy": Scipy,
    "pantr": Pantr,
    "splipy": Splipy,
    "geomdl": Geomdl,
    "bezier": Bezier,
    "shapely": Shapely,
}


def installed() -> dict[str, type]:
    """Return Knotwork and the peers that can be imported, by name."""
    return {"knotwork": Knotwork} | {k: v for k, v in PEERS.items() if importlib.util.find_spec(k)}
