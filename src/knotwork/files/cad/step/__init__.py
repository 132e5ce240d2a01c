"""STEP: curves, edges and faces' surfaces as splines; B-splines are replaced where they stand."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from knotwork.errors import FileError
from knotwork.files.cad.shapes import Model, Remarks, Shape, model
from knotwork.files.cad.step.assembly import Reader
from knotwork.files.cad.step.syntax import Text
from knotwork.files.cad.step.writing import encode, rewrite
from knotwork.spline import Spline

__all__ = ["decode", "encode", "opened"]


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the curves and surfaces as they stand in the model."""
    return [shape.spline for shape in _read(data, remark)[1]]


def opened(data: bytes, remark: Callable[[str], None]) -> Model:
    """Return the entities, each in its own coordinates."""
    text, shapes = _read(data, remark)
    return model(data, shapes, partial(rewrite, text))


def _read(data: bytes, remark: Callable[[str], None]) -> tuple[Text, list[Shape]]:
    text = Text(data)
    remarks = Remarks(remark)
    if text.broken:
        remark(text.broken)
    try:
        shapes = list(Reader(text, remarks).shapes())
    except (TypeError, IndexError, KeyError, AttributeError) as exc:
        raise FileError(f"its representations make no sense: {exc!r}") from exc
    remarks.close()
    return text, shapes
