"""Reduction within a distance between shapes, not of parameters.

`matching` bounds the distance along a path, `rematching` makes a path finer, `certificate` scales and rounds outward:
together the proof, which no search can spoil; where the tolerance varies, `portions` have one each. `nets`, `alignment`
and `between` prove the distance of any two splines; `brackets` bounds it from below too; `links` and `polyline` find
polylines with few vertices; `lower` says how few could do.
"""

from knotwork.removal.shapes.between import Distance, Matching, distance_bound
from knotwork.removal.shapes.brackets import Distances, distance

__all__ = ["Distance", "Distances", "Matching", "distance", "distance_bound"]
