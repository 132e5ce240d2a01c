"""Where the commands read and write: files, folders, patterns, and the standard streams, which are named "-"."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from knotwork.cli.terminal import Failure

if TYPE_CHECKING:
    from knotwork.files import Document, Format
    from knotwork.spline import Spline

#: the name of the standard streams
STREAM = Path("-")


class Reading(NamedTuple):
    """How files are to be read."""

    format: str | None
    options: dict[str, Any]

    def splines(self, path: Path) -> list[Spline]:
        """Return the splines in a file, or in what comes from standard input."""
        from knotwork.files.formats import decoded, fetched

        data = self._stream() if path == STREAM else fetched(path, self.format)
        return decoded(data, path, self.format, self.options)

    def document(self, path: Path) -> Document:
        """Return a file, or what comes from standard input, as a document."""
        from knotwork.files.document import document_of
        from knotwork.files.formats import fetched

        data = self._stream() if path == STREAM else fetched(path, self.format)
        return document_of(data, path, self.format, self.options)

    def kind(self, path: Path) -> Format:
        """Return the format of a file."""
        from knotwork.files.formats import SUFFIXES, fetched, format_of

        if path == STREAM or self.format is not None or path.suffix.lower() in SUFFIXES:
            if path == STREAM and self.format is None:
                raise Failure("-: expected --format, which tells what comes on standard input")
            return format_of(path, self.format)
        return format_of(path, None, fetched(path, None))

    def _stream(self) -> bytes:
        data = sys.stdin.buffer.read()
        if not data:
            raise Failure("-: there is nothing on standard input")
        return data


_OPTIONS = (
    click.option("--format", "format_", metavar="SUFFIX", help="Format of FILE and of what goes to -, such as csv."),
    click.option("--columns", help="Columns of a table that are the coordinates, as in x,y or 1,2."),
    click.option("--skip", type=click.IntRange(0), help="Lines at the start of a table to pass over."),
    click.option("--split-at", metavar="NAME=VALUE", help="Rows that end a polyline of a table, as in pressure=0."),
    click.option("--open/--closed", "open_", default=None, help="Whether polylines are closed.  [as they end]"),
    click.option("--extras", type=click.Choice(["interpolate", "drop"]), help="Elevation and time of new points."),
    click.option("--glyph", "--glyphs", help="Glyphs of a font to take: names, characters or codes, as in a,b,U+0041."),
    click.option("--id", "name", metavar="NAME", help="Id of the one element of a drawing to take."),
)


def reading(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options of how to read files, which it gets as one `reading`."""

    @functools.wraps(command)
    def wrapper(
        *args: Any,
        format_: str | None,
        columns: str | None,
        skip: int | None,
        split_at: str | None,
        open_: bool | None,
        name: str | None,
        extras: str | None,
        glyph: str | None,
        **rest: Any,
    ) -> Any:
        asked = {
            "columns": columns.split(",") if columns else None,
            "skip": skip,
            "split_at": split_at,
            "closed": None if open_ is None else not open_,
            "name": name,
            "extras": extras,
            "glyph": glyph.split(",") if glyph and len(glyph) > 1 else glyph,
        }
        options = {key: value for key, value in asked.items() if value is not None}
        return command(*args, reading=Reading(format_, options), **rest)

    for option in reversed(_OPTIONS):
        wrapper = option(wrapper)
    return wrapper


def expanded(paths: Sequence[Path]) -> list[Path]:
    """Return the files that arguments name: all of a folder whose suffix is known, all that fit a pattern."""
    from knotwork.files import SUFFIXES

    found: list[Path] = []
    for path in paths:
        if path != STREAM and path.is_dir():
            known = {suffix for suffix, each in SUFFIXES.items() if each.reads}
            inside = sorted(each for each in path.iterdir() if each.suffix.lower() in known and each.is_file())
            if not inside:
                raise Failure(f"{path}: no file in this folder has a known suffix")
            found += inside
        elif any(c in str(path) for c in "*?[") and not path.exists():
            base = Path(path.anchor) if path.anchor else Path()
            inside = sorted(base.glob(str(path.relative_to(path.anchor) if path.anchor else path)))
            if not inside:
                raise Failure(f"{path}: no file fits this pattern")
            found += inside
        else:
            found.append(path)
    return found


def paired(paths: Sequence[Path], output: Path | None, in_place: bool) -> list[tuple[Path, Path | None]]:
    """Return each file with the one to write, after checking that all of them can be written."""
    if in_place and output:
        raise click.UsageError("expected either --output or --in-place")
    files = expanded(paths)
    several = len(files) > 1 or (len(paths) == 1 and paths[0] != STREAM and paths[0].is_dir())
    pairs: list[tuple[Path, Path | None]] = []
    if output and several and output != STREAM:
        if output.suffix and not output.is_dir():
            raise Failure(f"{output}: {len(files)} files given; expected a folder for as many")
        output.mkdir(parents=True, exist_ok=True)
    for file in files:
        target = file if in_place else output / file.name if output and several and output != STREAM else output
        if target == STREAM and several:
            raise Failure("-: several files given; expected a folder for as many")
        if target and not in_place and _same(target, file):
            raise Failure(f"{target}: this is the file that is read; to replace it, give --in-place, not --output")
        pairs.append((file, target))
    return pairs


def _same(target: Path, file: Path) -> bool:
    return STREAM not in (target, file) and target.exists() and file.exists() and target.samefile(file)


def save(path: Path, data: bytes) -> None:
    """Write bytes to a file, whole or not at all, or to standard output."""
    if path == STREAM:
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
        return
    from knotwork.files.storage import replace

    replace(path, data)


def format_for(output: Path, file: Path, reading: Reading) -> str | None:
    """Return the format of what is written to standard output: the one asked for, or that of the file."""
    if output != STREAM:
        return None
    if reading.format is None and not file.suffix:
        raise Failure("-: expected --format, which tells what is written to standard output")
    return reading.format or file.suffix
