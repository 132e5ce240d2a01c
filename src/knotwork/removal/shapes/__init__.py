"""Reduction within a distance between shapes, not of parameters.

`matching` bounds the distance along a path, `rematching` makes a path finer, `certificate` scales and rounds outward:
together the proof, which no search can spoil. `nets`, `alignment` and `between` prove the distance of any two splines;
`links` and `polyline` find polylines with few vertices; `lower` says how few could do.
"""

from knotwork.removal.shapes.between import Distance, Matching, distance_bound

__all__ = ["Distance", "Matching", "distance_bound"]
