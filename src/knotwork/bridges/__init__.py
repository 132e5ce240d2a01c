"""Curves from and to other libraries: shapely, matplotlib's paths, SVG path data, scipy's B-splines, PyVista.

Nothing is loaded but what the object given comes from.
"""

from knotwork.bridges.bsplines import from_scipy, to_scipy
from knotwork.bridges.maps import from_shapely, to_shapely
from knotwork.bridges.meshes import from_pyvista, to_pyvista
from knotwork.bridges.paths import from_path, from_path_data, to_path, to_path_data

__all__ = [
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
]
