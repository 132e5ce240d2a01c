"""Outlines of fonts beside fontTools' converters: points, and distances that one certificate proves for both.

Usage: ``python benchmarks/fonts.py [Font.otf …] [-t 1]``; by default fonts of the Debian packages fonts-urw-base35,
fonts-cantarell and fonts-dejavu-core, those that are there. Cubic fonts are converted to quadratic ones beside cu2qu,
quadratic ones to cubic ones beside qu2cu. Both write whole font units, as fonts do.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np
from fontTools.pens.cu2quPen import Cu2QuPen
from fontTools.pens.qu2cuPen import Qu2CuPen
from fontTools.pens.recordingPen import DecomposingRecordingPen, RecordingPen
from fontTools.ttLib import TTFont

import knotwork as kw
from knotwork.errors import KnotworkError
from knotwork.files.fonts.contours import spline_of
from knotwork.files.fonts.conversion import of_other_kind
from knotwork.files.fonts.reading import drawn
from knotwork.removal.outlines import cost
from knotwork.removal.outlines.runs import together

FONTS = (
    "/usr/share/fonts/opentype/urw-base35/NimbusSans-Regular.otf",
    "/usr/share/fonts/opentype/urw-base35/Z003-MediumItalic.otf",
    "/usr/share/fonts/opentype/cantarell/Cantarell-Regular.otf",
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
)


def whole(runs):
    """Return runs with points as a font stores them; joints that are implied need not be whole."""
    return [np.floor(run + 0.5) for run in runs]


def theirs(commands, tolerance, cubic):
    """Return what fontTools makes of the contours that a pen drew."""
    out = RecordingPen()
    pen = Qu2CuPen(out, tolerance, all_cubic=True) if cubic else Cu2QuPen(out, tolerance)
    for what, points in commands:
        getattr(pen, what)(*points)
    found = [whole(runs) for runs in drawn(out.value)]
    return found if cubic else [together(runs) for runs in found]


def compared(path, tolerance, most):
    """Print the row of one font."""
    font = TTFont(path)
    cubic = "glyf" in font  # what it is converted to
    glyphs = font.getGlyphSet()
    points, seconds, worst, over, given, count = [0, 0], [0.0, 0.0], 0.0, 0, 0, 0
    for name in font.getGlyphOrder()[:most]:
        pen = DecomposingRecordingPen(glyphs)
        glyphs[name].draw(pen)
        before = drawn(pen.value)
        start = time.perf_counter()
        peer = theirs(pen.value, tolerance, cubic)
        seconds[1] += time.perf_counter() - start
        for runs, other in zip(before, peer, strict=True):
            if not runs:
                continue
            start = time.perf_counter()
            ours = of_other_kind(runs, tolerance, cubic=cubic)
            seconds[0] += time.perf_counter() - start
            if ours is None:
                print(f"  {name}: no outline within the tolerance", file=sys.stderr)
                continue
            count, given = count + 1, given + cost(runs, not cubic)
            points[0], points[1] = points[0] + cost(ours.runs, cubic), points[1] + cost(other, cubic)
            worst = max(worst, ours.bound)
            try:
                found = kw.distance_bound(spline_of(runs, not cubic), spline_of(other, cubic), tolerance)
                over += not found.proven
            except KnotworkError:
                over += 1
    peer_name = "qu2cu" if cubic else "cu2qu"
    print(
        f"{Path(path).name:26} {count:6} {given:7} {points[0]:7} {points[1]:7} {points[0] / points[1]:6.3f}"
        f" {worst:7.3f} {over:16} {seconds[0]:7.1f} {seconds[1]:7.1f}  {peer_name}"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("fonts", nargs="*")
    parser.add_argument("-t", "--tolerance", type=float, default=1.0, help="in font units")
    parser.add_argument("--glyphs", type=int, default=400, help="of each font, at most")
    asked = parser.parse_args()
    print("font                     contours  given    ours  peer's  ratio   bound  peer's unproven     s   peer's")
    for path in asked.fonts or [each for each in FONTS if Path(each).exists()]:
        compared(path, asked.tolerance, asked.glyphs)


if __name__ == "__main__":
    main()
