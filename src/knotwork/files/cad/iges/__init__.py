"""IGES: curves and surfaces as splines, each entity at its place; B-splines are replaced where they stand."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from knotwork.files.cad.iges.entities import Reader
from knotwork.files.cad.iges.records import Records
from knotwork.files.cad.iges.writing import encode, rewrite
from knotwork.files.cad.shapes import Model, Remarks, Shape, model
from knotwork.spline import Spline

__all__ = ["decode", "encode", "opened"]


def decode(data: bytes, remark: Callable[[str], None]) -> list[Spline]:
    """Return the curves and surfaces as they stand in the model."""
    return [shape.spline for shape in _read(data, remark)[1]]


def opened(data: bytes, remark: Callable[[str], None]) -> Model:
    """Return the entities, each in its own coordinates."""
    records, shapes = _read(data, remark)
    return model(data, shapes, partial(rewrite, records))


def _read(data: bytes, remark: Callable[[str], None]) -> tuple[Records, list[Shape]]:
    records = Records(data)
    remarks = Remarks(remark)
    shapes = list(Reader(records, remarks).shapes())
    remarks.close()
    return records, shapes
