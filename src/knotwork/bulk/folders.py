"""Curves in files: a folder, a pattern, a list of paths; each file becomes one in the folder of results."""

from __future__ import annotations

import csv
import glob
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from knotwork.bulk.curves import TASKS, Outcome, told
from knotwork.bulk.parts import BOOKS, Bites, Unit
from knotwork.errors import FileError
from knotwork.files.document import Document, document_of
from knotwork.files.formats import SUFFIXES, decoded, encoded, fetched, format_of
from knotwork.files.lighter import lighter
from knotwork.files.storage import replace
from knotwork.geometry.boxes import extent
from knotwork.removal.tolerance import Relative
from knotwork.spline import Spline

#: bytes of files in a part, and files, at most
BYTES, FILES = 1 << 24, 1000
#: formats that are written in place with few segments
IN_PLACE = ("svg", "geojson", "gpx")
#: columns of a table that hold paths
PATHS = ("path", "file", "filename")


@dataclass(frozen=True)
class Files:
    """Files to work on."""

    task: str
    options: dict[str, Any]
    #: each with the name of its result
    files: tuple[tuple[Path, Path], ...]
    #: the numbers of the first file of each part and of the one behind its last
    parts: tuple[tuple[int, int], ...]

    def count(self, part: Any) -> int:
        """Return how many files a part has."""
        return int(part[1] - part[0])

    def described(self) -> list[Any]:
        """Return names, sizes and times of the files."""
        return [[str(p), str(q), p.stat().st_size, p.stat().st_mtime_ns] for p, q in self.files]

    def work(
        self, part: Any, lo: int, hi: int, skip: Mapping[int, str], output: Path | None, bites: Bites
    ) -> Iterator[Unit]:
        """Do some files of a part."""
        for i in (i for bite in bites(lo, hi) for i in range(*bite)):
            path, name = self.files[part[0] + i]
            yield _failed(path, skip[i]) if i in skip else self._one(path, output / name if output else None, name)

    def _one(self, path: Path, target: Path | None, name: Path) -> Unit:
        """Do one file; what cannot be written because of the disk passes as an error."""
        try:
            with warnings.catch_warnings(record=True) as remarks:
                warnings.simplefilter("always")
                outcomes, data = self._worked(path, name)
        except Exception as exc:  # of any kind: a bad file must not cost the others
            return _failed(path, told(exc))
        if target is not None and data:
            target.parent.mkdir(parents=True, exist_ok=True)
            replace(target, data)
        return Unit(str(path), outcomes, [str(each.message) for each in remarks if each.category is UserWarning])

    def _worked(self, path: Path, name: Path) -> tuple[list[Outcome], bytes]:
        """Return what became of the curves of a file, and the bytes to be written."""
        data = fetched(path, None)
        kind, options = format_of(path, None, data), dict(self.options)
        stays = kind is format_of(name, None, data) and hasattr(kind.codec, "opened")
        document = document_of(data, path, None, {}) if stays else None
        splines: Sequence[Spline] = document.splines if document else decoded(data, path, None, {})
        if isinstance(options.get("tolerance"), Relative):
            size = document.extent() if document else float(extent(list(splines)))
            options["tolerance"] = options["tolerance"].fraction * size
        if self.task == "reduce":
            plain = not {"distance", "form"} & options.keys()
            if document and kind.module in IN_PLACE and plain and "keep" not in options:
                found = lighter(document, **options)
                new, rounded = found.document.packed(name)
                return [Outcome(s, found.bound + rounded) for s in found.document.splines], new
            options.setdefault("distance", "geometric" if kind.shapes or "form" in options else "parametric")
        free = [i for i in range(len(splines)) if not (document and document.places[i].fixed)]
        done = dict(zip(free, TASKS[self.task]([splines[i] for i in free], **options), strict=True))
        outcomes = [done.get(i, Outcome(spline)) for i, spline in enumerate(splines)]
        return outcomes, _written(document, outcomes, name)


def _written(document: Document | None, outcomes: list[Outcome], name: Path) -> bytes:
    """Return the bytes of a file: as it was but for the new curves, or the curves that did not fail."""
    if document:
        new = {i: o.spline for i, o in enumerate(outcomes) if o.spline not in (None, document.splines[i])}
        if document.holds(new):
            return document.with_splines(new).packed(name)[0]
    some = [o.spline for o in outcomes if o.spline is not None]
    return encoded(some, name)[0] if some else b""


def _failed(path: Path, error: str) -> Unit:
    return Unit(str(path), [Outcome(None, error=error)], [])


def source(task: str, options: dict[str, Any], given: str, output: Path, to: str | None) -> Files:
    """Return the files of a folder, a pattern, a table of paths, or one file.

    Raises
    ------
    FileError
        If there are none, one has a suffix that is not known or not written, or two would become the same file.
    """
    pairs = list(_found(given, output))
    names: dict[Path, Path] = {}
    chosen: list[tuple[Path, Path]] = []
    for path, name in pairs:
        name = name.with_suffix(f".{to.lstrip('.')}") if to else name
        kind = SUFFIXES.get(name.suffix.lower())
        if kind is None or not kind.writes:
            known = ", ".join(s for s, each in SUFFIXES.items() if each.writes)
            raise FileError(f"{path}: {name.suffix!r} is not written; expected `to` to name one of {known}")
        if name in names:
            raise FileError(f"{path} and {names[name]} would both become {output / name}")
        names[name] = path
        chosen.append((path, name))
    if not chosen:
        raise FileError(f"{given}: there is no file of curves here")
    return Files(task, options, tuple(chosen), tuple(_parts([p for p, _ in chosen])))


def _found(given: str, output: Path) -> Iterator[tuple[Path, Path]]:
    """Return files and the names of their results, in order of their names."""
    place = Path(given)
    if place.is_dir():
        inside = sorted(p for p in place.rglob("*") if p.suffix.lower() in SUFFIXES and p.is_file())
        inside = [p for p in inside if BOOKS not in p.parts]  # what was written about another job
        own = output.resolve()
        yield from ((p, p.relative_to(place)) for p in inside if not p.resolve().is_relative_to(own))
    elif place.is_file():
        listed = _listed(place)
        yield from [(place, Path(place.name))] if listed is None else listed
    elif glob.has_magic(given):
        found = sorted(Path(p) for p in glob.glob(given, recursive=True) if Path(p).is_file())
        start = Path(*_before_magic(Path(given)))
        yield from ((p, p.relative_to(start)) for p in found if p.suffix.lower() in SUFFIXES)
    else:
        raise FileError(f"{given}: there is no such file, folder or pattern")


def _before_magic(path: Path) -> list[str]:
    found: list[str] = []
    for part in path.parts[:-1]:
        if glob.has_magic(part):
            break
        found.append(part)
    return found


def _listed(path: Path) -> list[tuple[Path, Path]] | None:
    """Return the files that a table of paths lists; None if it is no such table."""
    if path.suffix.lower() not in (".csv", ".tsv", ".txt"):
        return None
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            head = file.readline().strip()
            columns = head.lower().split("\t" if path.suffix.lower() == ".tsv" else ",")
            column = next((columns.index(name) for name in PATHS if name in columns), None)
            if column is None:
                return None
            rows = list(csv.reader(file, delimiter="\t" if path.suffix.lower() == ".tsv" else ","))
    except (UnicodeDecodeError, OSError):
        return None
    found = []
    for row in rows:
        if len(row) > column and row[column].strip():
            each = path.parent / row[column].strip()
            inside = each.is_relative_to(path.parent) and ".." not in each.parts
            found.append((each, each.relative_to(path.parent) if inside else Path(each.name)))
    return found


def _parts(files: list[Path]) -> Iterator[tuple[int, int]]:
    """Return runs of files that are not too many and not too large."""
    lo, size = 0, 0
    for i, path in enumerate(files):
        try:
            own = path.stat().st_size
        except OSError as exc:
            raise FileError(f"{path}: {exc.strerror}") from exc
        if i > lo and (size + own > BYTES or i - lo >= FILES):
            yield lo, i
            lo, size = i, 0
        size += own
    yield lo, len(files)
