"""DXF drawings: their curves as splines, each at its place; splines and polylines are replaced where they stand."""

from __future__ import annotations

import io
import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from knotwork.errors import FileError, MissingExtraError
from knotwork.files.cad.dxf.entities import Reader
from knotwork.files.cad.dxf.writing import encode, rewrite
from knotwork.files.cad.shapes import Model, Remarks, Shape, model
from knotwork.spline import Spline

__all__ = ["decode", "encode", "opened"]


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the curves as they stand in the drawing: in the plane, if all of it lies in z = 0."""
    return [shape.spline for shape in _read(data, remark)]


def opened(data: bytes, remark: Callable[[str], None]) -> Model:
    """Return the entities, each in its own coordinates."""
    return model(data, _read(data, remark), partial(rewrite, data))


def _read(data: bytes, remark: Callable[[str], None]) -> list[Shape]:
    remarks = Remarks(remark)
    with _repairs(remark):
        drawing = _drawing(data)
    shapes = Reader(drawing, remarks).shapes()
    remarks.close()
    return shapes


class _Told(logging.Handler):
    """Keeps what ezdxf says about damage that it repairs."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.texts: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.texts.append(record.getMessage())


@contextmanager
def _repairs(remark: Callable[[str], None]) -> Iterator[None]:
    """Remark what is repaired in a damaged drawing."""
    told, logger = _Told(), logging.getLogger("ezdxf")
    logger.addHandler(told)
    try:
        yield
    finally:
        logger.removeHandler(told)
    if told.texts:
        remark(f"{len(told.texts)} fault(s) of this drawing are repaired; the first: {told.texts[0]}")


def _drawing(data: bytes) -> Any:
    """Return what ezdxf makes of the file."""
    try:
        from ezdxf import recover
    except ImportError as exc:
        raise MissingExtraError("DXF drawings need ezdxf to be read: pip install ezdxf") from exc
    if b"SECTION" not in data:
        raise FileError("there is no SECTION in this file; expected a DXF drawing")
    try:
        return recover.read(io.BytesIO(data))[0]
    except Exception as exc:  # ezdxf raises errors of many kinds for a damaged drawing
        raise FileError(f"this drawing cannot be read: {type(exc).__name__}: {exc}") from exc
