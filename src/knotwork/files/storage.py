"""Bytes from and to the disk: clear errors, and no file half written."""

from __future__ import annotations

import contextlib
import gzip
import os
import secrets
import stat
import zlib
from pathlib import Path

import numpy as np

from knotwork.arithmetic.arrays import require_room
from knotwork.errors import FileError, SizeError


def fetch(path: Path) -> bytes:
    """Return what a regular file holds."""
    try:
        found = os.stat(path)
        _require_regular(path, found.st_mode)
        require_room((found.st_size,), np.uint8)
        data = path.read_bytes()
    except FileNotFoundError:
        raise FileError(f"{path}: there is no such file") from None
    except SizeError as exc:
        raise FileError(f"{path}: {found.st_size} bytes do not fit in memory") from exc
    except OSError as exc:
        raise FileError(f"{path}: cannot be read: {exc.strerror or exc}") from exc
    if not data:
        raise FileError(f"{path}: the file is empty")
    return data


def replace(path: Path, data: bytes) -> None:
    """Put `data` in the place of the file: a new file beside it takes its name when it is complete."""
    target = Path(os.path.realpath(path))  # a symbolic link stays one
    beside = target.with_name(f".{target.name[:100]}.{secrets.token_hex(8)}.part")
    try:
        if target.exists():
            _require_regular(path, target.stat().st_mode)
            if not os.access(target, os.W_OK):
                raise FileError(f"{path}: cannot be written: the file is write-protected")
        with open(beside, "xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            os.chmod(beside, stat.S_IMODE(target.stat().st_mode))
        os.replace(beside, target)
    except FileNotFoundError:
        raise FileError(f"{path}: there is no directory {target.parent}") from None
    except OSError as exc:
        raise FileError(f"{path}: cannot be written: {exc.strerror or exc}") from exc
    finally:
        with contextlib.suppress(OSError):  # gone, unless something failed above, which is what counts
            os.unlink(beside)


#: what a packed file may unpack to, at most
UNPACKED = 1 << 28


def unpacked(data: bytes) -> bytes:
    """Return the bytes in a gzip file, and others as they are."""
    if not data.startswith(b"\x1f\x8b"):
        return data
    reader = zlib.decompressobj(31)
    try:
        found = reader.decompress(data, UNPACKED)
    except zlib.error as exc:
        raise FileError(f"the packed file is damaged: {exc}") from None
    if reader.unconsumed_tail:
        raise FileError(f"the packed file holds more than {UNPACKED} bytes")
    if not reader.eof:
        raise FileError("the packed file breaks off")
    return found


def packed(data: bytes, path: Path) -> bytes:
    """Return the bytes to be written: packed if the suffix says so."""
    return gzip.compress(data, mtime=0) if path.suffix.lower() == ".svgz" else data


def text(data: bytes) -> str:
    """Return UTF-8 text, or say where it is none."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as exc:
        line = data.count(b"\n", 0, exc.start) + 1
        raise FileError(f"line {line}: byte {data[exc.start]:#04x} is not UTF-8 text") from None


def _require_regular(path: Path, mode: int) -> None:
    if stat.S_ISDIR(mode):
        raise FileError(f"{path}: this is a directory; expected a file")
    if not stat.S_ISREG(mode):
        raise FileError(f"{path}: this is not a regular file")
