"""What is flat and within a tolerance of a curve or a surface: the face of polylines and meshes."""

from __future__ import annotations

from knotwork.errors import ParameterError
from knotwork.geometry.chords import Polyline, polyline
from knotwork.geometry.meshing import Mesh, mesh
from knotwork.spline import Spline


def flatten(spline: Spline, tolerance: float) -> Polyline | Mesh:
    """Return a polyline within a tolerance of a curve, with few vertices, or triangles within one of a surface.

    Parameters
    ----------
    spline : Spline
        Real: a curve in any dimension, or a surface in space.
    tolerance : float
        Above 0, in the units of the points.

    Returns
    -------
    Polyline
        Of a curve: ``points`` on it (a rounding off), their ``parameters``, and ``bound``, at most the tolerance: the
        Hausdorff distance, of each chord and its part of the curve, is no larger. Ends and jumps are vertices.
    Mesh
        Of a surface: ``points`` on it, ``triangles`` between them, unit ``normals``, ``parameters``, and ``bound``, at
        most the tolerance: how far a triangle is from the surface at equal parameters. There are no cracks: what is one
        edge in the parameters is one in the mesh. Edges of the surface that meet within a 64th of the tolerance, as at
        the seam of a closed one, are joined, and an edge shorter than that, a pole, is one point; so a sphere or torus
        is watertight.

    Raises
    ------
    ParameterError
        If the tolerance is not above 0, or so small that rounding is larger; if it is no curve or surface.
    SizeError
        If the result would have more than some millions of vertices.

    Notes
    -----
    Of curves, each chord goes as far as it may. Of surfaces, patches are parted into boxes of the parameters, across
    that which needs it more, until second derivatives prove the tolerance (after Filip, Magedson and Markot, 1986).

    Examples
    --------
    >>> import knotwork as kw
    >>> c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    >>> few = kw.flatten(c, 0.01)
    >>> len(few.points), few.uniform, few.bound <= 0.01
    (14, 14, True)
    >>> vault = kw.surface([[[0, 0, 0], [0, 4, 0]], [[1, 0, 2], [1, 4, 2]], [[2, 0, 0], [2, 4, 0]]], degree=(2, 1))
    >>> net = kw.flatten(vault, 0.1)
    >>> len(net.points), net.triangles.shape, net.bound <= 0.1
    (10, (8, 3), True)
    """
    if isinstance(spline, Spline) and len(spline.spaces) == 1:
        return polyline(spline, tolerance)
    if isinstance(spline, Spline) and len(spline.spaces) == 2:
        return mesh(spline, tolerance)
    raise ParameterError(f"{spline!r} given; expected a curve or a surface")
