"""Binary STL: each triangle with its own corners and its normal, in float32."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from knotwork.errors import FileError
from knotwork.geometry.meshing import Mesh

#: one triangle in a file
FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
#: triangles that a file can count
MOST = 2**32 - 1


def encode_meshes(meshes: Sequence[Mesh]) -> tuple[bytes, float]:
    """Return a file of the triangles of all meshes, and how far rounding to float32 moves a corner at most.

    Corners that are one stay one, so a watertight mesh stays so.
    """
    parts, bound = [], 0.0
    for mesh in meshes:
        with np.errstate(over="ignore"):
            rounded = mesh.points.astype(np.float32)
        if not np.isfinite(rounded).all():
            raise FileError(f"coordinates up to {abs(mesh.points).max():.3g} given; STL holds float32, up to 3.4e38")
        size = float(abs(mesh.points).max(initial=0.0)) or 1.0
        moved = np.linalg.norm((mesh.points - rounded) / size, axis=1).max(initial=0.0)
        bound = max(bound, float(moved) * size)
        facets = np.zeros(len(mesh.triangles), FACET)
        facets["corners"] = rounded[mesh.triangles]
        a, b, c = np.moveaxis(mesh.points[mesh.triangles] / size, 1, 0)
        across = np.cross(b - a, c - a)
        length = np.linalg.norm(across, axis=1, keepdims=True)
        facets["normal"] = across / np.where(length > 0, length, 1)
        parts.append(facets)
    count = sum(map(len, parts))
    if count > MOST:
        raise FileError(f"{count} triangles given; an STL file counts up to {MOST}")
    head = b"triangles of splines, by Knotwork".ljust(80) + np.array(count, "<u4").tobytes()
    return head + b"".join(p.tobytes() for p in parts), bound
