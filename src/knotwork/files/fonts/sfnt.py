"""The container of a font: its tables as bytes, taken apart and put together again by fontTools."""

from __future__ import annotations

import contextlib
import io
import logging
from collections.abc import Iterator, Mapping
from typing import Any

from knotwork.errors import FileError, KnotworkError, MissingExtraError

#: tables that say how outlines change along the axes of a variable font, other than gvar
VARIABLE = ("CFF2", "VARC")


def require_fonttools() -> None:
    """Raise unless fontTools is installed."""
    try:
        import fontTools  # noqa: F401
    except ImportError as exc:
        raise MissingExtraError("fonts need fontTools: pip install fonttools") from exc


@contextlib.contextmanager
def reading_font() -> Iterator[None]:
    """Turn whatever fontTools raises for a damaged font into one kind of error; what it logs is for no one."""
    log = logging.getLogger("fontTools")
    level = log.level
    log.setLevel(logging.ERROR)
    try:
        yield
    except (KnotworkError, MemoryError):
        raise
    except Exception as exc:  # of many kinds, and none of its own
        raise FileError(f"this font cannot be read: {type(exc).__name__}: {exc}") from exc
    finally:
        log.setLevel(level)


def font_of(data: bytes) -> Any:
    """Return a font that reads its tables when they are asked for."""
    from fontTools.ttLib import TTFont

    if data[:4] == b"ttcf":
        raise FileError("this is a collection of fonts; expected a single one")
    font = TTFont(io.BytesIO(data), lazy=True, recalcBBoxes=False, recalcTimestamp=False)
    if not any(tag in font for tag in ("glyf", "CFF ", "CFF2")):
        raise FileError("this font has no outlines (no table glyf or CFF): it may hold pictures alone")
    return font


def table(data: bytes, tag: str) -> bytes:
    """Return the bytes of one table."""
    from fontTools.ttLib.sfnt import SFNTReader

    return bytes(SFNTReader(io.BytesIO(data), 0)[tag])


def with_tables(data: bytes, new: Mapping[str, bytes], **packing: str | None) -> bytes:
    """Return a font with some tables replaced; all others stay byte for byte, but for the checksum in head.

    A digital signature, which holds no more, is left out. With ``flavor="woff"`` the font is packed so, with None not;
    by default as it was.
    """
    from fontTools.ttLib.sfnt import SFNTReader, SFNTWriter

    reader = SFNTReader(io.BytesIO(data), 0)
    order = sorted((tag for tag in reader.tables if tag != "DSIG"), key=lambda tag: reader.tables[tag].offset)
    file = io.BytesIO()
    flavor = packing.get("flavor", reader.flavor)
    writer = SFNTWriter(file, len(order), reader.sfntVersion, flavor, reader.flavorData if flavor else None)
    for tag in order:
        writer[tag] = new[tag] if tag in new else reader[tag]
    writer.close()
    return file.getvalue()
