"""What all formats share: finding the format, errors that name the file, and writing whole or not at all."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import knotwork as kw
from knotwork.errors import FileError, ParameterError
from knotwork.files import SUFFIXES, Written, read, write

#: what curves are written as: not meshes, and not fonts, which are written in place alone
WRITTEN = [suffix for suffix, each in SUFFIXES.items() if each.writes and each.reads and each.module != "fonts"]

CURVE = kw.curve([[0, 0], [1, 2], [3, 1]], degree=1)
GARBAGE = bytes(range(256)) * 40


@pytest.mark.parametrize("suffix", WRITTEN)
def test_every_format_gives_back_what_was_written(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"curve{suffix}"
    assert write(path, CURVE) == Written(path, 1, 0.0)
    (found,) = read(str(path))
    np.testing.assert_array_equal(found.points[:, :2], CURVE.points)
    assert not found.points[:, 2:].any()  # formats of solids know space alone
    if suffix != ".petiga":  # holds one patch
        assert write(path, [CURVE, CURVE]).count == 2
        assert len(read(path)) == 2


def test_a_suffix_in_capitals_is_the_same(tmp_path: Path) -> None:
    write(tmp_path / "CURVE.JSON", CURVE)
    assert read(tmp_path / "CURVE.JSON") == [CURVE]


def test_an_unknown_suffix_names_the_known_ones(tmp_path: Path) -> None:
    for action in (lambda: read(tmp_path / "x.pdf"), lambda: write(tmp_path / "x.pdf", CURVE)):
        with pytest.raises(FileError, match=r"x\.pdf: unknown suffix '\.pdf'; expected one of \.json, .*: pdftocairo"):
            action()


@pytest.mark.parametrize("suffix", WRITTEN)
def test_files_that_cannot_be_read(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    with pytest.raises(FileError, match=rf"a\{suffix}: there is no such file"):
        read(path)
    path.mkdir()
    with pytest.raises(FileError, match=rf"a\{suffix}: this is a directory"):
        read(path)
    with pytest.raises(FileError, match=rf"a\{suffix}: this is a directory"):
        write(path, CURVE)
    path.rmdir()
    os.mkfifo(path)
    with pytest.raises(FileError, match=rf"a\{suffix}: this is not a regular file"):
        read(path)
    path.unlink()
    path.write_bytes(b"")
    with pytest.raises(FileError, match=rf"a\{suffix}: the file is empty"):
        read(path)
    for data in (GARBAGE, b"\xff\xfe\xfd", b"\x00" * 100, b" \n \n"):
        path.write_bytes(data)
        with pytest.raises(FileError, match=rf"a\{suffix}: "):
            read(path)


@pytest.mark.parametrize("suffix", WRITTEN)
def test_damage_anywhere_is_an_error_or_a_spline(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    ring = kw.curve([[0, 0], [1, 2], [3, 1]], degree=1, periodic=True)
    write(path, [CURVE, ring] if suffix != ".petiga" else ring)
    sound = path.read_bytes()
    rng = np.random.default_rng(1)
    refused = 0
    for _ in range(300):
        damaged = bytearray(sound)
        if rng.random() < 0.3:
            del damaged[rng.integers(len(sound)) :]
        else:
            for place in rng.integers(0, len(damaged), rng.integers(1, 4)):
                damaged[place] = rng.integers(256)
        path.write_bytes(damaged)
        message = ""
        try:
            found = read(path)
        except FileError as exc:
            message = str(exc)
            refused += 1
        except UserWarning as exc:  # points that became equal
            message = str(exc)
        if message:
            assert message.startswith(str(path))
        else:
            assert all(np.isfinite(spline.coefficients).all() for spline in found)
    assert refused > 50


def test_what_is_not_a_spline_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    with pytest.raises(ParameterError, match="no splines given"):
        write(path, [])
    with pytest.raises(ParameterError, match=r"splines\[1\] is a list; expected a Spline"):
        write(path, [CURVE, [1, 2]])  # type: ignore[list-item]
    for accuracy in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(ParameterError, match="accuracy"):
            write(path, CURVE, accuracy=accuracy)
    assert not list(tmp_path.iterdir())


def test_an_error_leaves_the_old_file_and_nothing_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.csv"
    write(path, CURVE)
    old = path.read_bytes()
    with pytest.raises(FileError, match="holds polylines"):
        write(path, [CURVE, kw.elevate(CURVE)])

    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(FileError, match=r"a\.csv: cannot be written: No space left on device"):
            write(path, [CURVE, CURVE])
    assert path.read_bytes() == old
    assert [p.name for p in tmp_path.iterdir()] == ["a.csv"]
    with pytest.raises(FileError, match="there is no directory"):
        write(tmp_path / "no" / "a.csv", CURVE)


def test_a_new_file_keeps_the_mode_and_the_link_of_the_old(tmp_path: Path) -> None:
    target, link = tmp_path / "a.csv", tmp_path / "b.csv"
    write(target, CURVE)
    umask = os.umask(0)
    os.umask(umask)
    assert stat.S_IMODE(target.stat().st_mode) == 0o666 & ~umask
    target.chmod(0o640)
    link.symlink_to(target)
    write(link, [CURVE, CURVE])
    assert link.is_symlink()
    assert len(read(target)) == 2
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_importing_the_face_loads_no_format() -> None:
    code = (
        "import sys, knotwork.files; "
        "print([m for m in ('json', 'zipfile', 'scipy', 'xml.parsers.expat', 'numba') if m in sys.modules])"
    )
    plain = "import sys, numpy; print([m for m in ('json', 'zipfile') if m in sys.modules])"
    run = [subprocess.run([sys.executable, "-c", c], capture_output=True, text=True, check=True) for c in (code, plain)]
    assert set(eval(run[0].stdout)) <= set(eval(run[1].stdout))
