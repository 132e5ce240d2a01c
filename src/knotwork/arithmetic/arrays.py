"""Arrays of numbers: what is accepted, and in which arithmetic it is kept.

float64, float32 and complex128 are kept as given; integers become float64. An array of dtype object keeps its
elements (Fraction, mpmath, …), but its integers become Fractions, so that division stays exact.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knotwork.errors import KnotworkError, SizeError

Array = NDArray[Any]

# glibc takes an array larger than any that was freed so far from the system, and gives it back at once: each page is a
# fault again, which takes longer than most work here. Once one of nearly 32 MiB was freed, none of whose pages need be
# touched, it keeps up to twice as much for those to come. Elsewhere this does nothing.
np.empty((1 << 25) - (1 << 13), np.uint8)

_FLOATS = {np.dtype(t) for t in (np.float64, np.float32, np.complex128)}
_KEPT = {*_FLOATS, np.dtype(object)}


def numbers(values: Any, what: str, error: type[KnotworkError], copy: bool = False) -> Array:
    """Return `values` as a C-ordered array in one of the kept arithmetics; `error` says what is wrong with `what`.

    With `copy`, the array shares no memory with `values`.
    """
    if type(values) is np.ndarray and values.dtype in _FLOATS and values.flags.c_contiguous:  # as most are
        return values.copy() if copy else values
    if isinstance(values, np.ma.MaskedArray) or (
        isinstance(values, list | tuple) and any(isinstance(v, np.ma.MaskedArray) for v in values)
    ):
        raise error(f"{what}: a masked array was given; expected plain numbers")
    try:
        array = np.asarray(values, order="C")
        if copy and not isinstance(values, list | tuple):
            array = array.copy()
    except ValueError as exc:
        raise error(f"{what}: the rows have different lengths; expected a rectangular array") from exc
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    if array.dtype == object:
        if not isinstance(values, np.ndarray) and all(isinstance(x, int | float) for x in array.reshape(-1).tolist()):
            raise error(f"{what}: an integer too large for float64 was given; expected finite numbers")
        return exact(array, what, error)
    if array.dtype in _KEPT:
        return array
    if array.dtype.kind in "biu" or array.dtype == np.float16:
        return array.astype(np.float64)
    if array.dtype == np.complex64:
        return array.astype(np.complex128)
    raise error(f"{what}: {array.dtype} given; expected numbers (float64, float32, complex128 or exact objects)")


def whole(value: Any, what: str, least: int, error: type[KnotworkError]) -> int:
    """Return a whole number of at least `least` as an int, or raise."""
    if type(value) is int and value >= least:
        return value
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
        raise error(f"{what} {value!r} given; expected an integer of at least {least}")
    return int(value)


def real_numbers(values: Any, what: str, error: type[KnotworkError]) -> Array:
    """Return finite real `values` as a float64 or exact array."""
    x = real_array(values, what, error)
    require_finite(x, what, error)
    return x


def real_array(values: Any, what: str, error: type[KnotworkError], copy: bool = False) -> Array:
    """Return real `values`, perhaps not finite, as a float64 or exact array."""
    x = numbers(values, what, error, copy)
    kind = x.dtype.kind
    if kind == "c" or (kind == "O" and any(isinstance(v, complex) for v in x.reshape(-1).tolist())):
        raise error(f"{what}: complex numbers given; expected real ones")
    return x.astype(np.float64) if x.dtype.char == "f" else x


def in_arithmetic_of(like: Array, x: Array, what: str, error: type[KnotworkError]) -> Array:
    """Return real numbers exact where `like` is exact, float64 otherwise."""
    if like.dtype == object:
        return x if x.dtype == object else exact(x, what, error)
    return in_floats(x, what, error)


def in_floats(x: Array, what: str, error: type[KnotworkError]) -> Array:
    """Return exact real numbers rounded to float64, others as they are."""
    if x.dtype != object:
        return x
    try:
        return x.astype(np.float64)
    except (OverflowError, TypeError):
        raise error(f"{what}: a number that float64 cannot hold; expected real ones up to 1.8e308 in size") from None


def exact(array: Array, what: str, error: type[KnotworkError]) -> Array:
    """Return an object array in which integers and floats are Fractions of the same value."""
    result = np.empty(array.shape, dtype=object)
    flat = result.reshape(-1)
    for i, x in enumerate(array.reshape(-1).tolist()):
        flat[i] = exact_number(x, what, error)
    return result


def exact_number(x: Any, what: str, error: type[KnotworkError]) -> Any:
    """Return an int, float or Decimal as the Fraction of the same value, any other number as it is."""
    if isinstance(x, int | float | Decimal | np.integer | np.floating):
        try:
            return Fraction(x if isinstance(x, int | float | Decimal) else x.item())
        except (ValueError, OverflowError):
            raise error(f"{what}: {x} given; expected finite numbers") from None
    if isinstance(x, str | bytes) or not hasattr(x, "__mul__") or not hasattr(x, "__add__") or hasattr(x, "__len__"):
        raise error(f"{what}: {x!r} given; expected numbers")
    return x


def all_finite(array: Array) -> bool:
    """Tell whether no element is NaN or infinite; exact numbers are finite unless they say otherwise."""
    if array.dtype.hasobject:
        return all(x == x and abs(x) != float("inf") for x in array.reshape(-1).tolist())
    return bool(np.count_nonzero(np.isfinite(array)) == array.size)


def require_finite(array: Array, what: str, error: type[KnotworkError]) -> None:
    """Raise `error`, naming the first place, unless all elements are finite."""
    if not all_finite(array):
        place, x = next((i, x) for i, x in np.ndenumerate(array) if not all_finite(np.asarray(x)))
        raise error(f"{what}{list(place) if place else ''} is {x}; expected finite numbers")


def in_a_row(parts: Sequence[Array]) -> tuple[Array, Array]:
    """Return arrays one behind the other, and where each begins."""
    return np.concatenate(parts), np.concatenate([[0], np.cumsum([len(p) for p in parts])])


def empty(shape: tuple[int, ...], dtype: Any) -> Array:
    """Allocate an array, or say how large it would have been."""
    require_room(shape, dtype)
    return np.empty(shape, dtype)


def require_room(shape: tuple[int, ...], dtype: Any) -> None:
    """Raise `SizeError` if an array would not fit in memory."""
    size = np.dtype(dtype).itemsize * math.prod(map(int, shape))
    if size > 1 << 30 and size > _physical_memory():
        wanted = f"{size / 1e9:.3g} GB" if size < 1 << 80 else "more than any machine has"
        raise SizeError(
            f"the result would be {' × '.join(f'{n:.3g}' if n < 1 << 80 else 'too many' for n in shape)} numbers "
            f"({wanted}); this machine has {_physical_memory() / 1e9:.3g} GB"
        )


def _physical_memory() -> int:
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):  # not known on this system: only the address space limits
        return 1 << 46
