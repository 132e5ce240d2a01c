"""Knotwork: insert, delete and convert the knots of B-spline curves and surfaces, exactly or with a proven bound.

`import knotwork` is quick: each part loads when one of its names is first used.
"""

import importlib as _importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from knotwork import arithmetic, diagrams, errors, insertion, progressive, stability
    from knotwork.bridges import (
        from_path,
        from_path_data,
        from_pyvista,
        from_scipy,
        from_shapely,
        to_path,
        to_path_data,
        to_pyvista,
        to_scipy,
        to_shapely,
    )
    from knotwork.building import curve, surface, volume
    from knotwork.bulk import Summary, batch
    from knotwork.conversion import (
        Conversion,
        PolynomialPieces,
        Unified,
        close,
        convert,
        elevate,
        from_pieces,
        interpolate,
        join,
        lower,
        unify,
    )
    from knotwork.errors import (
        FileError,
        KnotError,
        KnotworkError,
        MissingExtraError,
        ParameterError,
        PointError,
        RoundingWarning,
        SizeError,
    )
    from knotwork.files import Document, Written, open, read, write
    from knotwork.geometry import (
        Closest,
        Crossings,
        Line,
        Measured,
        Mesh,
        Offset,
        Plane,
        Polyline,
        Zeros,
        area,
        by_length,
        centroid,
        closest,
        corners,
        curvature,
        extrema,
        flatten,
        frame,
        inflections,
        intersect,
        length,
        normals,
        offset,
        zeros,
    )
    from knotwork.insertion import (
        Extraction,
        clamp,
        extraction,
        from_bezier,
        insert,
        insertion_matrix,
        split,
        to_bezier,
        trim,
    )
    from knotwork.plotting import plot
    from knotwork.progressive import blossom, segment
    from knotwork.removal import (
        Distance,
        Distances,
        Matching,
        Reduction,
        distance,
        distance_bound,
        fit,
        reduce,
        relative,
        removable,
        remove,
    )
    from knotwork.space import SplineSpace
    from knotwork.spline import Spline

__version__ = "0.1.0"

__all__ = [
    "Closest",
    "Conversion",
    "Crossings",
    "Distance",
    "Distances",
    "Document",
    "Extraction",
    "FileError",
    "KnotError",
    "KnotworkError",
    "Line",
    "Matching",
    "Measured",
    "Mesh",
    "MissingExtraError",
    "Offset",
    "ParameterError",
    "Plane",
    "PointError",
    "Polyline",
    "PolynomialPieces",
    "Reduction",
    "RoundingWarning",
    "SizeError",
    "Spline",
    "SplineSpace",
    "Summary",
    "Unified",
    "Written",
    "Zeros",
    "area",
    "arithmetic",
    "batch",
    "blossom",
    "by_length",
    "centroid",
    "clamp",
    "close",
    "closest",
    "convert",
    "corners",
    "curvature",
    "curve",
    "diagrams",
    "distance",
    "distance_bound",
    "elevate",
    "errors",
    "extraction",
    "extrema",
    "fit",
    "flatten",
    "frame",
    "from_bezier",
    "from_path",
    "from_path_data",
    "from_pieces",
    "from_pyvista",
    "from_scipy",
    "from_shapely",
    "inflections",
    "insert",
    "insertion",
    "insertion_matrix",
    "interpolate",
    "intersect",
    "join",
    "length",
    "lower",
    "normals",
    "offset",
    "open",
    "plot",
    "progressive",
    "read",
    "reduce",
    "relative",
    "removable",
    "remove",
    "segment",
    "split",
    "stability",
    "surface",
    "to_bezier",
    "to_path",
    "to_path_data",
    "to_pyvista",
    "to_scipy",
    "to_shapely",
    "trim",
    "unify",
    "volume",
    "write",
    "zeros",
]

_PARTS = {
    "arithmetic": (),
    "bridges": (
        "from_path",
        "from_path_data",
        "from_pyvista",
        "from_scipy",
        "from_shapely",
        "to_path",
        "to_path_data",
        "to_pyvista",
        "to_scipy",
        "to_shapely",
    ),
    "bulk": ("Summary", "batch"),
    "building": ("curve", "surface", "volume"),
    "conversion": (
        "Conversion",
        "PolynomialPieces",
        "Unified",
        "close",
        "convert",
        "elevate",
        "from_pieces",
        "interpolate",
        "join",
        "lower",
        "unify",
    ),
    "diagrams": (),
    "errors": (
        "FileError",
        "KnotError",
        "KnotworkError",
        "MissingExtraError",
        "ParameterError",
        "PointError",
        "RoundingWarning",
        "SizeError",
    ),
    "files": ("Document", "Written", "open", "read", "write"),
    "geometry": (
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
    ),
    "insertion": (
        "Extraction",
        "clamp",
        "extraction",
        "from_bezier",
        "insert",
        "insertion_matrix",
        "split",
        "to_bezier",
        "trim",
    ),
    "plotting": ("plot",),
    "progressive": ("blossom", "segment"),
    "removal": (
        "Distance",
        "Distances",
        "Matching",
        "Reduction",
        "distance",
        "distance_bound",
        "fit",
        "reduce",
        "relative",
        "removable",
        "remove",
    ),
    "space": ("SplineSpace",),
    "spline": ("Spline",),
    "stability": (),
}

if not TYPE_CHECKING:  # a type checker knows all names, and refuses others

    def __getattr__(name: str) -> object:
        """Load the part that a name lives in, once."""
        for part, names in _PARTS.items():
            if name == part or name in names:
                module = _importlib.import_module(f"knotwork.{part}")
                globals()[part] = module
                return globals().setdefault(name, module if name == part else getattr(module, name))
        raise AttributeError(
            f"module 'knotwork' has no attribute {name!r}", name=name, obj=_importlib.import_module("knotwork")
        )


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


del TYPE_CHECKING
