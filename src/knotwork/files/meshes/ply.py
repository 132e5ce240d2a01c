"""Binary PLY: vertices with their normals and parameters in float64, triangles by their numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from knotwork.errors import FileError
from knotwork.geometry.meshing import Mesh

#: what is told of a vertex
VERTEX = ("x", "y", "z", "nx", "ny", "nz", "u", "v")
FACE = np.dtype([("count", "u1"), ("vertices", "<i4", 3)])


def encode_meshes(meshes: Sequence[Mesh]) -> tuple[bytes, float]:
    """Return a file of all meshes, one after another; it holds every float as it is."""
    vertices = np.concatenate([np.concatenate([m.points, m.normals, m.parameters], axis=1) for m in meshes])
    if len(vertices) > np.iinfo(np.int32).max:
        raise FileError(f"{len(vertices)} vertices given; a PLY file numbers up to {np.iinfo(np.int32).max}")
    faces = np.zeros(sum(len(m.triangles) for m in meshes), FACE)
    faces["count"] = 3
    before = np.cumsum([0, *(len(m.points) for m in meshes)])
    faces["vertices"] = np.concatenate([m.triangles + k for m, k in zip(meshes, before[:-1], strict=True)])
    head = [
        "ply",
        "format binary_little_endian 1.0",
        "comment triangles of splines, by Knotwork",
        f"element vertex {len(vertices)}",
        *(f"property double {name}" for name in VERTEX),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    return "\n".join([*head, ""]).encode() + vertices.astype("<f8").tobytes() + faces.tobytes(), 0.0
