"""Where a spline stands in a file, and what the file says about it."""

from __future__ import annotations

from typing import NamedTuple


class Place(NamedTuple):
    """What surrounds one spline of a document."""

    #: its id or name, if it has one
    name: str | None = None
    #: the layer or group that it is in, if that has a name
    layer: str | None = None
    #: whether it goes back to its start
    closed: bool = False
    #: whether it is filled, and stroked
    filled: bool = False
    stroked: bool = True
    #: the units of its coordinates, if the file tells
    units: str | None = None
    #: where in the file, for a person
    where: str = ""
    #: the largest factor by which it is drawn larger than its coordinates say
    scale: float = 1.0
    #: whether it must stay as it is: a circle of SVG, say
    fixed: bool = False
    #: whether only straight lines can stand there
    straight: bool = False
