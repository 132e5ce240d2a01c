"""A document: what surrounds the splines of a file. What is not replaced is written back byte for byte."""

from __future__ import annotations

import builtins
import os
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol

from knotwork.errors import FileError, KnotworkError, ParameterError
from knotwork.files.formats import Format, Written, fetched, format_of, require_options, write
from knotwork.files.places import Place
from knotwork.files.storage import packed, unpacked
from knotwork.files.storage import replace as replace_file
from knotwork.geometry.boxes import extent
from knotwork.spline import Spline


class Content(Protocol):
    """What a format keeps of a file, to write it again."""

    splines: tuple[Spline, ...]
    places: tuple[Place, ...]

    def rewritten(
        self, changed: Mapping[int, Spline], accuracy: Mapping[int, float], *, even_if_longer: bool
    ) -> tuple[bytes, float]:
        """Return the bytes with some splines replaced, and how far rounding moved a point at most."""
        ...


@dataclass(frozen=True)
class Document:
    """The splines of a file in what surrounds them. A value: `map` and `replace` give new ones.

    Attributes
    ----------
    path : Path
        The file that it was read from.
    splines : tuple of Spline
        Each in the coordinates in which the file holds it.
    places : tuple of Place
        For each spline its name, layer, whether it is closed, filled and stroked, its units, where in the file it
        stands and at which scale it is drawn.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import knotwork as kw
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "hill.svg"
    >>> _ = path.write_text('<svg><!-- by hand --><path d="M 0 0 C 1 2 3 2 4 0" stroke="#321"/></svg>')
    >>> drawing = kw.open(path)
    >>> wider = drawing.map(lambda c: c.transform([[2, 0], [0, 1]]))
    >>> wider.bytes()[0].decode()
    '<svg><!-- by hand --><path d="M0 0C2 2 6 2 8 0" stroke="#321"/></svg>'
    """

    path: Path
    splines: tuple[Spline, ...]
    places: tuple[Place, ...]
    #: what kind of file it is
    format: Format = field(repr=False)
    _content: Any = field(repr=False)
    #: the bytes of the file
    _given: builtins.bytes = field(repr=False)
    #: how far rounding may move the points of a spline that is written, in its own coordinates
    _accuracy: dict[int, float] = field(default_factory=dict, repr=False)
    #: whether what was there stays where a new text would be longer
    _shorter: bool = field(default=False, repr=False)

    def _repr_html_(self) -> str:
        """Return what a notebook shows of a document: its curves, and what the file is."""
        from knotwork.geometry.notebooks import card, overview  # loaded when it is asked for

        downward = ".svg" in self.format.suffixes
        told = {"file": self.path.name, "format": self.format.name, "splines": len(self.splines)}
        return card(overview(self.splines, downward), told)

    def map(self, f: Callable[[Spline], Spline]) -> Document:
        """Return the document with splines replaced by what a function makes of them.

        Those that are `fixed` in their places stay as they are: circles and rectangles of a drawing, say.
        """
        free = [i for i, place in enumerate(self.places) if not place.fixed]
        return self.with_splines({i: f(self.splines[i]) for i in free})

    def replace(self, index: int, spline: Spline) -> Document:
        """Return the document with one spline replaced."""
        if not 0 <= index < len(self.splines):
            raise ParameterError(f"spline {index} given; the document holds {len(self.splines)}")
        return self.with_splines({index: spline})

    def rounding(self, accuracy: Mapping[int, float]) -> Document:
        """Return the document with numbers that may be rounded when it is written.

        Parameters
        ----------
        accuracy : mapping from int to float
            How far rounding may move the points of a spline, in its own coordinates.
        """
        return replace(self, _accuracy={**self._accuracy, **accuracy})

    def where_shorter(self) -> Document:
        """Return the document that leaves what was there where a new text would be longer."""
        return replace(self, _shorter=True)

    def with_splines(self, changed: Mapping[int, Spline]) -> Document:
        """Return the document with some splines replaced, given by their numbers."""
        for i, spline in changed.items():
            if not isinstance(spline, Spline):
                raise ParameterError(f"{type(spline).__name__} given for spline {i}; expected a Spline")
        return replace(self, splines=tuple(changed.get(i, spline) for i, spline in enumerate(self.splines)))

    @property
    def content(self) -> Any:
        """What the format keeps of the file, to write it again."""
        return self._content

    @property
    def size(self) -> int:
        """How many bytes the file has."""
        return len(self._given)

    def extent(self) -> float:
        """Return the longest side of the box around all splines, as the file shows them."""
        shown = getattr(self._content, "extent", None)
        return float(shown() if shown else extent(list(self.splines)))

    def holds(self, changed: Mapping[int, Spline]) -> bool:
        """Tell whether the file has a place for splines that replace others: for all that its rows say, say."""
        return bool(getattr(self._content, "holds", lambda _: True)(changed))

    def bytes(self, *, even_if_longer: bool | None = None) -> tuple[builtins.bytes, float]:
        """Return the bytes of the document, and how far rounding moved a point at most, as it is drawn."""
        before = self._content.splines
        changed = {i: s for i, s in enumerate(self.splines) if s is not before[i]}
        longer = not self._shorter if even_if_longer is None else even_if_longer
        data, bound = self._content.rewritten(changed, self._accuracy, even_if_longer=longer)
        return data, bound

    def write(self, path: str | os.PathLike[str], *, even_if_longer: bool | None = None) -> Written:
        """Write the document, whole or not at all.

        Parameters
        ----------
        path : path-like
            Of the suffix that the document was read with: its bytes, with the splines that were replaced in their
            places. Of another one: the splines, in that format.
        even_if_longer : bool, optional
            Whether a spline that was replaced is written even where its text is longer than what was there. By default
            it is, unless the document is one that was to become lighter.

        Returns
        -------
        Written
            With the bound of the error of what is written.

        Raises
        ------
        FileError
            If the format cannot hold a spline, or the file cannot be written.
        """
        path = Path(path)
        if path.suffix.lower() != self.path.suffix.lower() and format_of(path) is not self.format:
            return write(path, list(self.splines))
        data, bound = self.packed(path, even_if_longer=even_if_longer)
        replace_file(path, data)
        return Written(path, len(self.splines), bound)

    def packed(self, path: Path, *, even_if_longer: bool | None = None) -> tuple[builtins.bytes, float]:
        """Return what `write` would write to a file of the same format, packed if its suffix says so."""
        try:
            data, bound = self.bytes(even_if_longer=even_if_longer)
        except KnotworkError as exc:
            raise FileError(f"{path}: {exc}") from exc
        if path.suffix.lower() == self.path.suffix.lower():
            return self._given if data == unpacked(self._given) else packed(data, path), bound
        if hasattr(self._content, "packed"):  # what a suffix says is for the format to see to
            data = self._content.packed(data, path)
        return packed(data, path), bound


@dataclass(frozen=True)
class Whole:
    """The content of a format that has nothing but splines: written anew when one of them changes."""

    data: bytes
    codec: Any
    splines: tuple[Spline, ...]
    places: tuple[Place, ...]

    def rewritten(
        self, changed: Mapping[int, Spline], accuracy: Mapping[int, float], *, even_if_longer: bool = False
    ) -> tuple[bytes, float]:
        """Return the bytes as they were, or those of all splines."""
        if not changed:
            return self.data, 0.0
        data, bound = self.codec.encode([changed.get(i, s) for i, s in enumerate(self.splines)], None)
        return data, bound


def open_document(path: str | os.PathLike[str], *, format: str | None = None, **options: Any) -> Document:
    """Open a file as a document, which is written back as it was but for the splines that are replaced.

    Parameters
    ----------
    path : path-like
        The suffix tells the format; ``knotwork formats`` lists them.
    format : str, optional
        A suffix that tells the format instead.
    **options
        What the format can be asked for, as for `read`.

    Raises
    ------
    FileError
        As for `read`; a document may hold no spline.

    Warns
    -----
    UserWarning
        If something in the file is damaged and had to be left out; the message tells the place.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import knotwork as kw
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "roof.svg"
    >>> _ = path.write_text('<svg><g id="house"><path id="roof" fill="red" d="M 0 1 L 2 0 L 4 1 Z"/></g></svg>')
    >>> drawing = kw.open(path)
    >>> drawing.places[0].name, drawing.places[0].layer, drawing.places[0].closed
    ('roof', 'house', True)
    >>> drawing.bytes()[0] == path.read_bytes()
    True
    """
    path = Path(path)
    return document_of(fetched(path, format), path, format, options)


def document_of(data: bytes, path: Path, format: str | None, options: Mapping[str, Any]) -> Document:
    """Return the document in the bytes of a file."""
    found = format_of(path, format, data)
    require_options(found, path, options)
    codec = found.codec
    remarks: list[str] = []
    try:
        inside = unpacked(data)
        if hasattr(codec, "opened"):
            content = codec.opened(inside, remarks.append, **options)
        else:
            splines = tuple(codec.decode(inside, remarks.append, **options))
            places = tuple(_place(spline, i) for i, spline in enumerate(splines))
            content = Whole(inside, codec, splines, places)
    except KnotworkError as exc:
        asked = options and isinstance(exc, ParameterError)
        raise (ParameterError if asked else FileError)(f"{path}: {exc}") from exc
    for remark in remarks:
        warnings.warn(f"{path}: {remark}", UserWarning, stacklevel=3)
    return Document(path, content.splines, content.places, found, content, data)


def _place(spline: Spline, index: int) -> Place:
    return Place(closed=all(space.periodic for space in spline.spaces), where=f"spline {index}")
