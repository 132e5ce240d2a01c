"""The straight edges of a STEP file: most edges are, and the ends of all are found at once."""

from __future__ import annotations

import numpy as np

from knotwork.files.cad.step.index import Rows
from knotwork.files.cad.step.syntax import Text
from knotwork.geometry.bezier import over_breaks
from knotwork.spline import Spline

#: curves of space that also tell their pictures on surfaces
ON_SURFACES = ("SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE")
#: the parameters of all lines between two points
UNIT = (over_breaks(1, (0.0, 1.0)),)
#: how an edge ends: along its curve, or against it
_ALONG, _AGAINST = (np.frombuffer(word, np.uint8) for word in (b",.T.)", b",.F.)"))


class StraightEdges:
    """The edges from one plain point to another along a line; any other is read by itself."""

    def __init__(self, text: Text) -> None:
        rows = text.rows_named("EDGE_CURVE")
        points, places = text.all_points
        vertices = np.stack([text.rows(text.reference(rows, k)) for k in (0, 1)], axis=1)
        ends = places.many(text.reference(vertices, -1))
        curves = text.rows(text.reference(rows, 2))
        told = text.are(curves, *ON_SURFACES)
        curves[told] = text.rows(text.reference(curves[told], 0))
        words = text.endings(rows, len(_ALONG))
        along, against = ((words == word).all(axis=1) for word in (_ALONG, _AGAINST))
        plain = text.are(vertices, "VERTEX_POINT").all(axis=1) & (ends >= 0).all(axis=1) & text.are(curves, "LINE")
        plain &= text.rows(text.index.keys[rows]) == rows  # said once, or last
        plain &= (text.reference(rows, 3) < 0) & (along | against)
        ends[against] = ends[against, ::-1]
        self._nets = points[ends[plain]]
        self._rows = Rows(text.index.keys[rows[plain]])

    def __contains__(self, key: int) -> bool:
        return self._rows.one(key) >= 0

    def of(self, key: int) -> Spline | None:
        """Return an edge, or None if it is not one of those."""
        row = self._rows.one(key)
        return Spline.trusted(UNIT, self._nets[row]) if row >= 0 else None
