"""JSON: each fault is named by its place."""

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import FileError
from knotwork.files import read, write
from knotwork.files.json import encode


def test_other_exact_numbers_are_refused() -> None:
    c = kw.curve(np.array([mpmath.mpf(1), mpmath.mpf(2)], object), degree=1)
    with pytest.raises(FileError, match=r"splines\[0\] holds mpf numbers; JSON keeps floats and Fractions"):
        encode([c], None)


def sound() -> dict[str, Any]:
    c = kw.curve([[0, 0], [1, 2], [3, 1], [4, 4]], degree=2)
    return json.loads(encode([c, c], None)[0])


def altered(*path: Any, value: Any) -> dict[str, Any]:
    """Return a sound file with one value replaced."""
    root = sound()
    entry: Any = root
    for key in path[:-1]:
        entry = entry[key]
    if value is ...:
        del entry[path[-1]]
    else:
        entry[path[-1]] = value
    return root


NAN = float("nan")


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("format",), "other", "format 'other' given; expected 'knotwork'"),
        (("format",), ..., "the file has no 'format'"),
        (("version",), 2, "version 2 given; this program reads version 1"),
        (("version",), "1", 'version is "1"; expected a whole number'),
        (("splines",), {}, "splines is an object; expected a list"),
        (("splines",), [], "no spline in this file"),
        (("splines", 1), 7, r"splines\[1\] is 7; expected an object"),
        (("splines", 1, "knots"), ..., r"splines\[1\] has no 'knots'"),
        (("splines", 1, "degree"), [2, 2], "2 degrees, 1 knot vectors and 1 periodic flags"),
        (("splines", 1, "degree", 0), 2.5, r"splines\[1\]\.degree\[0\] is 2\.5; expected a whole number"),
        (("splines", 1, "degree", 0), -1, r"splines\[1\]\.knots\[0\]: degree -1 given"),
        (("splines", 1, "degree", 0), 10**9, r"splines\[1\]\.knots\[0\]: 7 knots given; degree 1000000000 needs"),
        (("splines", 1, "degree", 0), True, r"degree\[0\] is true; expected a whole number"),
        (("splines", 1, "periodic", 0), 1, r"periodic\[0\] is 1; expected true or false"),
        (("splines", 1, "rational"), None, r"rational is null; expected true or false"),
        (("splines", 1, "numbers"), "float16", r"numbers is \"float16\"; expected one of float64, float32"),
        (("splines", 1, "knots", 0, 3), NAN, r"splines\[1\]\.knots\[0\]: knots\[3\] is nan; expected finite"),
        (("splines", 1, "knots", 0, 3), 9, r"splines\[1\]\.knots\[0\]: knots\[3\] = 9\.0 is above knots\[4\] = 1\.0"),
        (("splines", 1, "knots", 0, 3), "a", r"splines\[1\]\.knots\[0\]\[3\] is \"a\"; expected a number"),
        (("splines", 1, "knots", 0, 3), True, r"splines\[1\]\.knots\[0\]\[3\] is true; expected a number"),
        (("splines", 1, "knots", 0, 3), 10**400, r"splines\[1\]\.knots\[0\] has a number beyond float64"),
        (("splines", 1, "knots", 0, 3), [1], r"splines\[1\]\.knots\[0\]\[3\] is a list; expected a number"),
        (("splines", 1, "knots", 0), 1.5, r"splines\[1\]\.knots\[0\]: .*expected a flat list"),
        (("splines", 1, "coefficients", 2), [1], r"coefficients\[2\] has length 1, the ones before 2"),
        (("splines", 1, "coefficients", 2, 1), None, r"coefficients\[2\]\[1\] is null; expected a number"),
        (("splines", 1, "coefficients", 2, 1), -NAN, r"splines\[1\]\.coefficients: coefficients\[2, 1\] is nan"),
        (("splines", 1, "coefficients", 2, 1), float("inf"), r"coefficients\[2, 1\] is inf"),
        (("splines", 1, "coefficients"), [[0, 0]], r"coefficients of shape \(1, 2\) given"),
        (("splines", 1, "coefficients"), [], r"splines\[1\]\.coefficients: coefficients of shape \(0,\) given"),
        (("splines", 1, "rational"), True, r"splines\[1\]\.coefficients: weights\[0\] is 0\.0; expected positive"),
        (("splines", 1, "numbers"), "exact", r"knots\[0\]\[0\] is 0\.0; expected a fraction as text"),
    ],
)
def test_each_fault_is_named_by_its_place(tmp_path: Path, path: Any, value: Any, message: str) -> None:
    file = tmp_path / "a.json"
    file.write_text(json.dumps(altered(*path, value=value)))
    with pytest.raises(FileError, match=rf"a\.json: .*{message}"):
        read(file)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"format": "knotwork",\n "version" 1}', "line 2, column 12: Expecting ':' delimiter"),
        ('{"format": "knotwork", "version": 1, "splines": [', "line 1, column 50: Expecting value"),
        ("[" * 100_000, "nested too deeply"),
        ('{"a":' * 100_000, "nested too deeply"),
        ('{"format": ' + "9" * 10_000 + "}", "a number in the file cannot be read"),
        ('{"format": "knotwork", "format": "x"}', "the name 'format' is given twice"),
        ("3", "the file is 3; expected an object"),
        ("null", "the file is null; expected an object"),
        ('"' + "x" * 100 + '"', "the file is .*…; expected an object"),
    ],
)
def test_text_that_is_no_such_json(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "a.json"
    file.write_text(text)
    with pytest.raises(FileError, match=rf"a\.json: .*{message}"):
        read(file)


@pytest.mark.parametrize("text", ["1/0", "1/00", "1.5", "x", "", "1/-2", "٣", "9" * 5000, "1e9999999"])
def test_fractions_that_are_none(tmp_path: Path, text: str) -> None:
    c = kw.curve(np.array([Fraction(1), Fraction(2, 3)], object), degree=1)
    file = tmp_path / "a.json"
    root = json.loads(encode([c], None)[0])
    root["splines"][0]["coefficients"][1] = text
    file.write_text(json.dumps(root))
    with pytest.raises(FileError, match=r"splines\[0\]\.coefficients\[1\] is .*; expected a fraction like"):
        read(file)


def test_float32_out_of_its_range_is_refused(tmp_path: Path) -> None:
    c = kw.curve(np.array([0, 1], np.float32), degree=1)
    file = tmp_path / "a.json"
    root = json.loads(encode([c], None)[0])
    root["splines"][0]["coefficients"][1] = 1e300
    file.write_text(json.dumps(root))
    with pytest.raises(FileError, match=r"coefficients\[1\] is inf"):
        read(file)


def test_a_fault_of_encoding_is_named_by_its_line(tmp_path: Path) -> None:
    file = tmp_path / "a.json"
    write(file, kw.curve([0.0, 1.0], degree=1))
    file.write_bytes(file.read_bytes().replace(b"degree", b"d\xe9gree"))
    with pytest.raises(FileError, match=r"a\.json: line 2: byte 0xe9 is not UTF-8 text"):
        read(file)
