"""What knot insertion tells of a curve or a surface: boxes, zeros, lengths; all certified by control points."""

from knotwork.geometry.along import by_length
from knotwork.geometry.chords import Polyline
from knotwork.geometry.closest_points import closest
from knotwork.geometry.crossings import intersect
from knotwork.geometry.flattening import flatten
from knotwork.geometry.gathering import Crossings
from knotwork.geometry.lines import Line, Plane
from knotwork.geometry.local_shape import curvature, frame, normals
from knotwork.geometry.measures import Measured, area, centroid, length
from knotwork.geometry.meshing import Mesh
from knotwork.geometry.nearest import Closest
from knotwork.geometry.offsetting import Offset, offset
from knotwork.geometry.roots import Zeros, zeros
from knotwork.geometry.turning import corners, extrema, inflections

__all__ = [
    "Closest",
    "Crossings",
    "Line",
    "Measured",
    "Mesh",
    "Offset",
    "Plane",
    "Polyline",
    "Zeros",
    "area",
    "by_length",
    "centroid",
    "closest",
    "corners",
    "curvature",
    "extrema",
    "flatten",
    "frame",
    "inflections",
    "intersect",
    "length",
    "normals",
    "offset",
    "zeros",
]
