"""A font in place: each contour of each glyph once, and glyphs that change put back where they stood."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError
from knotwork.files.fonts import cff, truetype
from knotwork.files.fonts.along import Along, with_contours
from knotwork.files.fonts.contours import rounded, spline_of
from knotwork.files.fonts.reading import named
from knotwork.files.fonts.sfnt import VARIABLE, font_of, reading_font, require_fonttools, with_tables
from knotwork.files.fonts.truetype import Glyph, listed
from knotwork.files.fonts.variations import rewritten_gvar, varied
from knotwork.files.places import Place
from knotwork.spline import Spline

#: why a contour of a font that varies is not replaced by itself
VARIES = "the font varies, and masters have to change with it: knotwork reduce does that, map and replace do not"


class Contour(NamedTuple):
    """Which contour a spline is."""

    glyph: int
    number: int


@dataclass(frozen=True)
class Font:
    """The bytes of a font and the contours in it."""

    data: bytes
    cubic: bool
    #: units per em
    units: int
    glyphs: tuple[Glyph, ...]
    contours: tuple[Contour, ...]
    splines: tuple[Spline, ...]
    places: tuple[Place, ...]
    #: why nothing can be replaced, '' if all can
    stays: str
    #: whether outlines change along axes: then contours are replaced by those of `along` alone, which have masters
    varies: bool = False
    along: Mapping[int, Along] = field(default_factory=dict)

    def runs(self, i: int) -> list[Array]:
        """Return the runs of a contour as the font holds them."""
        glyph, number = self.contours[i]
        return self.glyphs[glyph].contours[number]

    def rewritten(
        self, changed: Mapping[int, Spline], accuracy: Mapping[int, float], *, even_if_longer: bool = False
    ) -> tuple[bytes, float]:
        """Return the bytes with some contours replaced, and how far rounding moved a point at most, in font units."""
        if self.varies:
            return self._along_axes(changed)
        new: dict[str, dict[int, Any]] = {}
        worst = 0.0
        for i, spline in sorted(changed.items()):
            at = self.contours[i]
            glyph = self.glyphs[at.glyph]
            if self.stays or glyph.stays:
                raise FileError(f"glyph {glyph.name!r} cannot be replaced: {self.stays or glyph.stays}")
            found = rounded(spline, self.cubic, f"contour {at.number + 1} of glyph {glyph.name!r}")
            new.setdefault(glyph.name, {})[at.number] = found.runs if self.cubic else listed(found.runs)
            worst = max(worst, found.bound)
        if not new:
            return self.data, 0.0
        with reading_font():
            data = cff.rewritten(self.data, new) if self.cubic else truetype.rewritten(self.data, new)
        return data, worst

    def _along_axes(self, changed: Mapping[int, Spline]) -> tuple[bytes, float]:
        """Return the bytes with contours replaced that have masters, whose rounding counts already."""
        new: dict[str, dict[int, Along]] = {}
        for i, spline in sorted(changed.items()):
            at, found = self.contours[i], self.along.get(i)
            name = self.glyphs[at.glyph].name
            if found is None or found.spline is not spline:
                raise FileError(f"glyph {name!r} cannot be replaced: {VARIES}")
            new.setdefault(name, {})[at.number] = found
        if not new:
            return self.data, 0.0
        with reading_font():
            font = font_of(self.data)
            tuples = {}
            for name, contours in new.items():
                glyph = varied(font, name)
                assert glyph is not None
                tuples[name] = with_contours(font["glyf"][name], glyph, contours)
            gvar = rewritten_gvar(self.data, font, {name: each for name, each in tuples.items() if each})
            points = {name: {n: each.points for n, each in contours.items()} for name, contours in new.items()}
            return truetype.rewritten(self.data, points, {"gvar": gvar}), 0.0

    def packed(self, data: bytes, path: Path) -> bytes:
        """Return the bytes of the font for a file of another suffix: packed if that is .woff.

        Raises
        ------
        FileError
            If the suffix says that there are outlines of the other kind.
        """
        suffix = path.suffix.lower()
        if suffix == (".ttf" if self.cubic else ".otf"):
            kind, way = ("cubic", "quadratic") if self.cubic else ("quadratic", "cubic")
            raise FileError(f"{path}: the font has {kind} outlines; knotwork convert --{way} makes the others of them")
        return with_tables(data, {}, flavor="woff" if suffix == ".woff" else None)


def opened(data: bytes, remark: Callable[[str], None], *, glyph: str | Sequence[str] | None = None) -> Font:
    """Return the contours of a font, each once: what composite glyphs are made of is read where it stands.

    Parameters
    ----------
    data : bytes
    remark : callable
        Is told what is left out.
    glyph : str or sequence of str, optional
        As in `decode`; parts of composite glyphs instead of these.

    Raises
    ------
    FileError, ParameterError, MissingExtraError
        As in `decode`.
    """
    require_fonttools()
    with reading_font():
        font = font_of(data)
        cubic = "glyf" not in font
        names = named(font, glyph)
        variable = [tag for tag in VARIABLE if tag in font]
        units = int(font["head"].unitsPerEm)
        if "CFF2" in font:
            raise FileError("outlines that vary (CFF2) are read, not replaced: use read, or an instance of the font")
        if not cubic:
            names = _parts(font, names, remark, told=glyph is not None)
        glyphs = (cff if cubic else truetype).glyphs_of(font, names)
    stays = f"the font varies by {variable[0]}" if variable else ""
    varies = "gvar" in font
    contours = [Contour(g, n) for g, each in enumerate(glyphs) for n, runs in enumerate(each.contours) if runs]
    splines = tuple(spline_of(glyphs[g].contours[n], cubic) for g, n in contours)
    places = tuple(
        Place(
            name=glyphs[g].name,
            closed=True,
            filled=True,
            stroked=False,
            units="font units",
            where=f"glyph {glyphs[g].name}, contour {n + 1}",
            fixed=bool(stays or varies or glyphs[g].stays),
        )
        for g, n in contours
    )
    if stays:
        remark(f"its outlines cannot be replaced: {stays}")
    return Font(data, cubic, units, tuple(glyphs), tuple(contours), splines, places, stays, varies)


def _parts(font: object, names: list[str], remark: Callable[[str], None], *, told: bool) -> list[str]:
    """Return glyphs, instead of composite ones what they are made of."""
    found: dict[str, None] = {}
    left = names[::-1]
    seen: set[str] = set()
    while left:
        name = left.pop()
        if name in seen:
            continue
        seen.add(name)
        parts = truetype.parts_of(font, name)
        if parts and told:
            remark(f"glyph {name!r} is made of {', '.join(parts)}: these are taken where they stand")
        if parts:
            left += parts[::-1]
        else:
            found[name] = None
    return list(found)
