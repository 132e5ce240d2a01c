"""SVG: paths and shapes as curves, and curves as paths.

Reading: `document` holds the XML and says what is drawn where, `shapes` and `pathdata` give the outline of an element,
`outlines` makes curves of it. Writing: `drawing`, with `geometry.cubics` for curves that SVG has no segments for.
"""

from knotwork.files.svg.document import decode
from knotwork.files.svg.drawing import encode
from knotwork.files.svg.inplace import opened

__all__ = ["decode", "encode", "opened"]
