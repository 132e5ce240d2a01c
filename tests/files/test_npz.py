"""NPZ: named members, and no more memory than the file is long."""

import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import FileError
from knotwork.files import read, write
from knotwork.files.npz import encode

CURVE = kw.curve([[0, 0], [1, 2], [3, 1]], degree=1)


def test_exact_numbers_go_to_json() -> None:
    with pytest.raises(FileError, match=r"splines\[0\] holds exact numbers, which \.npz cannot; \.json keeps"):
        encode([CURVE.in_exact_arithmetic()], None)


def members() -> dict[str, Any]:
    return dict(np.load(io.BytesIO(encode([CURVE], None)[0])))


def packed(**changes: Any) -> bytes:
    data = io.BytesIO()
    np.savez(data, **{key.replace("__", "/"): v for key, v in (members() | changes).items() if v is not None})
    return data.getvalue()


def test_numpy_reads_the_members_by_the_documented_names() -> None:
    found = members()
    assert sorted(found) == ["0/coefficients", "0/degree", "0/knots/0", "0/periodic", "0/rational", "knotwork"]
    assert found["0/coefficients"].tolist() == CURVE.points.tolist()
    assert found["0/knots/0"].tolist() == CURVE.space.knots.tolist()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"knotwork": None}, "knotwork.npy is missing: these are not splines"),
        ({"knotwork": np.array([7, 1])}, "version 7 given"),
        ({"knotwork": np.zeros(0, int)}, "version None given"),
        ({"knotwork": np.array([1])}, "expected the version and the number of splines"),
        ({"knotwork": np.array([1, 2])}, r"1/degree\.npy is missing"),
        ({"knotwork": np.array([1, 10**9])}, r"1/degree\.npy is missing"),
        ({"0/rational": None}, r"0/rational\.npy is missing"),
        ({"0/knots/0": np.array([0, 1, 0, 1.0])}, r"0/knots/0\.npy: knots\[1\] = 1\.0 is above"),
        ({"0/knots/0": np.array([0, np.nan, 0, 1.0])}, r"0/knots/0\.npy: knots\[1\] is nan"),
        ({"0/knots/0": np.array(["0", "1"])}, r"0/knots/0\.npy is no array of numbers"),
        ({"0/knots/0": np.zeros((2, 2))}, r"0/knots/0\.npy has shape \(2, 2\); expected 1 dimension"),
        ({"0/degree": np.array([1.5])}, r"0/degree\.npy holds float64; expected a kind among i, u"),
        ({"0/periodic": np.array([True, False])}, r"0/periodic\.npy has 2 flags; expected one per parameter, 1"),
        ({"0/coefficients": np.full((3, 2), np.inf)}, r"0/coefficients\.npy: coefficients\[0, 0\] is inf"),
        ({"0/coefficients": np.zeros((4, 2))}, r"0/coefficients\.npy: coefficients of shape \(4, 2\) given"),
        ({"0/coefficients": np.zeros((3, 2), np.float16)}, None),
        ({"0/coefficients": np.asfortranarray([[0, 0], [1, 2], [3, 1.0]], ">f8")}, None),
    ],
)
def test_members_that_do_not_fit(tmp_path: Path, changes: dict[str, Any], message: str | None) -> None:
    path = tmp_path / "a.npz"
    path.write_bytes(packed(**changes))
    if message:
        with pytest.raises(FileError, match=rf"a\.npz: .*{message}"):
            read(path)
    else:
        assert read(path)[0].points.tolist() == changes["0/coefficients"].tolist()


def with_member(name: str, data: bytes, compression: int = zipfile.ZIP_STORED) -> bytes:
    out = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(encode([CURVE], None)[0])) as old,
        zipfile.ZipFile(out, "w", compression) as new,
    ):
        for info in old.infolist():
            new.writestr(info.filename, data if info.filename == name else old.read(info), compression)
    return out.getvalue()


def header(text: str) -> bytes:
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode()


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (header("{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000, 2), }\n"), "announces shape"),
        (header("{'descr': '<f8', 'fortran_order': False, 'shape': (" + "9" * 150 + ",), }\n"), "announces shape"),
        (header("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }\n") + b"\x80\x04.", "no array of numbers"),
        (header("{'descr': '<f3', 'fortran_order': False, 'shape': (1,), }\n") + b"abc", "no kind of number"),
        (header("{'descr': " + "(" * 5000 + "}\n"), "no array of numbers"),
        (header("{'descr': " + "-" * 5000 + "1}\n"), "no array of numbers"),
        (b"\x93NUMPY\x02\x00", "no array of numbers"),
        (b"", "no array of numbers"),
    ],
)
def test_arrays_that_announce_what_is_not_there(tmp_path: Path, data: bytes, message: str) -> None:
    path = tmp_path / "a.npz"
    path.write_bytes(with_member("0/coefficients.npy", data))
    with pytest.raises(FileError, match=rf"a\.npz: 0/coefficients\.npy .*{message}"):
        read(path)


def test_a_compressed_bomb_is_not_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    path.write_bytes(with_member("0/coefficients.npy", bytes(10**7), zipfile.ZIP_DEFLATED))
    assert path.stat().st_size < 50_000
    with pytest.raises(FileError, match=r"a\.npz: .* is compressed; expected it stored"):
        read(path)


def test_a_directory_that_announces_more_than_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    write(path, CURVE)
    data = bytearray(path.read_bytes())
    place = data.index(b"PK\x01\x02")  # the first entry of the directory; its sizes are at 20 and 24
    data[place + 20 : place + 28] = (2**31).to_bytes(4, "little") * 2
    path.write_bytes(data)
    with pytest.raises(FileError, match=r"a\.npz: the members announce 214\d+ bytes; the whole file has"):
        read(path)


def test_a_file_cut_short_at_any_place(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    whole = encode([CURVE], None)[0]
    for stop in range(1, len(whole), 7):
        path.write_bytes(whole[:stop])
        with pytest.raises(FileError, match=r"a\.npz: this is no sound zip archive"):
            read(path)
