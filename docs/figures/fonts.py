"""Make the picture of glyphs in formats.md: python docs/figures/fonts.py, with the fonts of three Debian packages.

They are fonts-lato, fonts-dejavu-core and fonts-inter.
"""

from pathlib import Path

import numpy as np
from common import GREY, PLUM, plt, save
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

import knotwork as kw
from knotwork.files.fonts.lighter import lighter_font, runs_of
from knotwork.plotting import INK

FONTS = Path("/usr/share/fonts")
#: fonts, glyphs and tolerances in units of the font
SHOWN = (
    ("truetype/lato/Lato-Regular.ttf", "ag", 3.0),
    ("truetype/dejavu/DejaVuSans.ttf", "&S", 4.0),
    ("opentype/inter/Inter-Regular.otf", "@3", 4.0),
)


def glyph(ax, document, shift):
    """Draw the contours of a glyph with the points that the font stores."""
    vertices, codes, move = [], [], np.array([shift, 0.0])
    count = 0
    for i, spline in enumerate(document.splines):
        line = spline(np.linspace(*spline.space.domain, 40 * len(spline.space.breaks))) + move
        vertices += line.tolist()
        codes += [Outline.MOVETO, *[Outline.LINETO] * (len(line) - 2), Outline.CLOSEPOLY]
        runs = runs_of(document, i)
        ends = np.array([run[0] for run in runs]) + move
        handles = np.concatenate([run[1:-1] for run in runs]) + move
        ax.plot(*ends.T, "s", ms=3.4, color=INK, zorder=3)
        ax.plot(*handles.T, "o", ms=3.2, mfc="white", mec=PLUM, mew=0.9, zorder=2)
        count += sum(len(run) - 1 for run in runs)
    ax.add_patch(PathPatch(Outline(vertices, codes), facecolor="#e3e6ec", edgecolor=GREY, lw=0.8))
    return count


def main():
    """Draw glyphs before and after."""
    figure, axes = plt.subplots(2, 3, figsize=(11, 6.6), layout="constrained")
    for column, (name, characters, tolerance) in zip(axes.T, SHOWN, strict=True):
        shift, counts = 0.0, [0, 0]
        for character in characters:
            before = kw.open(FONTS / name, glyph=character)
            found = lighter_font(before, tolerance)
            for k, document in enumerate((before, found.document)):
                counts[k] += glyph(column[k], document, shift)
            shift += 1.12 * np.ptp([s.bounds[:, 0] for s in before.splines])
            print(f"{name} {character}: {found.points[0]} to {found.points[1]} points, bound {found.bound:.3g}")
        for k, ax in enumerate(column):
            ax.set_aspect("equal")
            ax.set_axis_off()
            said = (
                f"{Path(name).stem}, {counts[0]} points"
                if k == 0
                else f"within {tolerance:g} units, {counts[1]} points"
            )
            ax.set_title(said, fontsize=10)
    save(figure, "fonts.png", dpi=110)


if __name__ == "__main__":
    main()
