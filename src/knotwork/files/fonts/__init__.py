"""Fonts: the contours of glyphs as splines, and put back in place of those that were there.

Reading: `reading` gives all contours as they are drawn, `contours` makes splines of them. In place: `inplace` says
which contour of which glyph a spline is; `truetype` and `cff` write the glyphs that change, `sfnt` the tables around.
"""

from knotwork.files.fonts.inplace import opened
from knotwork.files.fonts.reading import decode

__all__ = ["decode", "opened"]
