"""One source for each algorithm, run as it stands or compiled.

A function marked `@kernel` is plain Python over arrays, scalars and loops. The same text runs

- *plain*, over anything: `Fraction`, `mpmath`, a counting scalar, or floats when the job is small;
- *compiled* by Numba over float64, float32 and complex128, once the work pays for loading Numba.

Both give equal results bit for bit (no fastmath). Arrays of dtype object always take the plain source.
The environment variable ``KNOTWORK_JIT`` chooses: ``auto`` (default), ``always`` or ``never``.
"""

from __future__ import annotations

import functools
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from types import CodeType, FunctionType
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from knotwork.errors import ParameterError

if TYPE_CHECKING:
    from pathlib import Path

MODES = ("auto", "always", "never")
#: seconds of plain work that pay for importing Numba and fetching the first kernels from the cache
LOADING_PAYS = 0.4
#: seconds of plain work per array element, roughly: what a kernel is expected to cost before it is timed
PER_ELEMENT = 1e-6
#: how much more a search costs per element: it goes over them again and again
SEARCH = 10_000
#: dimensions up to this one are known to the compiler, which unrolls the loops over them
UNROLLED = 5

#: how Numba compiles: kernels called by kernels are inlined, no rule of arithmetic is relaxed, and as kernels allocate
#: nothing, no references are counted
OPTIONS: dict[str, Any] = {
    "nogil": True,
    "error_model": "numpy",
    "forceinline": True,
    "_nrt": False,
    "no_cfunc_wrapper": True,
}

KERNELS: list[Kernel] = []

#: what is put around a function, to count or record its calls
Wrap = Callable[[Callable[..., Any]], Callable[..., Any]]

_ARRAY, _OBJECT = np.ndarray, np.dtype(object)
_wraps: ContextVar[dict[str, Wrap] | None] = ContextVar("wraps", default=None)
_lock = threading.RLock()
_spent = 0.0
#: called with True when compiling begins, and with False when it ends; they may be nested
WATCHERS: list[Callable[[bool], None]] = []


def _mode_from_environment() -> str:
    mode = os.environ.get("KNOTWORK_JIT", "auto")
    if mode not in MODES:
        raise ParameterError(f"KNOTWORK_JIT is {mode!r}; expected one of {', '.join(MODES)}")
    return mode


mode = _mode_from_environment()


class Kernel:
    """An algorithm with one source; calling it runs that source plain or compiled.

    `variant` gives the same text with some of the kernels it calls replaced by others.
    """

    def __init__(self, source: FunctionType, names: dict[str, Kernel] | None = None, inline: bool = True) -> None:
        functools.update_wrapper(self, source)
        self.source = source
        self.options = {**OPTIONS, "forceinline": inline}
        self.names = names or {}
        self._variants: dict[frozenset[tuple[str, Kernel]], Kernel] = {}
        self._compiled: Callable[..., Any] | None = None
        KERNELS.append(self)

    def __repr__(self) -> str:
        return f"<kernel {self.source.__module__}.{self.source.__name__}>"

    def __call__(self, *args: Any) -> Any:
        """Run on `args`: plain if any array holds objects, else as the mode says."""
        compiled = self._compiled if mode != "never" else None
        if compiled is None:
            return self._first_calls(args)
        for a in args:
            if type(a) is _ARRAY and a.dtype is _OBJECT:
                return self._over_objects(*args)
        return compiled(*args)

    @property
    def loaded(self) -> bool:
        """Whether calls over floats run compiled code now."""
        return self._compiled is not None and mode != "never"

    def variant(self, **names: Kernel) -> Kernel:
        """Return the same source with the given names bound to other kernels, in the kernels it calls too."""
        key = frozenset(names.items())
        if key not in self._variants:
            others = ((name, callee) for name, callee in self._callees() if name not in names)
            below = {name: callee.variant(**names) for name, callee in others if callee._calls(names)}
            self._variants[key] = Kernel(self.source, {**self.names, **below, **names}, self.options["forceinline"])
        return self._variants[key]

    def _calls(self, names: dict[str, Kernel]) -> bool:
        """Tell whether the source, or that of a kernel it calls, calls one of these names."""
        return any(name in names or callee._calls(names) for name, callee in self._callees())

    def _first_calls(self, args: tuple[Any, ...]) -> Any:
        """Run plain until the accumulated work pays for compiled code."""
        global _spent
        arrays = [a for a in args if isinstance(a, np.ndarray)]
        if any(a.dtype == _OBJECT for a in arrays):
            return self._over_objects(*args)
        # compiled code is silent about overflow and 0/0, so the plain source is too
        if mode == "never":
            with np.errstate(all="ignore"):
                return self.plain(*args)
        expected = PER_ELEMENT * _elements(args) * (1 if self.options["forceinline"] else SEARCH)
        if mode == "always" or _numba_is_there() or _spent + expected > LOADING_PAYS:
            return self.compiled(*args)
        start = time.perf_counter()
        with np.errstate(all="ignore"):
            result = self.plain(*args)
        _spent += time.perf_counter() - start
        return result

    def _callees(self) -> Iterator[tuple[str, Kernel]]:
        """Yield the kernels that the source calls, by the name it calls them."""
        for name in self.source.__code__.co_names:
            target = self.names.get(name, self.source.__globals__.get(name))
            if isinstance(target, Kernel):
                yield name, target

    def _bound(self, functions: dict[str, Any]) -> FunctionType:
        """Return the source's code in a namespace where the names of kernels mean `functions`."""
        namespace = {**self.source.__globals__, **functions}
        bound = FunctionType(self.source.__code__, namespace, self.source.__name__, self.source.__defaults__)
        bound.__qualname__ = self.source.__qualname__
        bound.__module__ = self.source.__module__
        return bound

    @functools.cached_property
    def plain(self) -> FunctionType:
        """The source as it stands; the kernels it calls are plain too."""
        return self._plain({})

    def _plain(self, wraps: dict[str, Wrap]) -> FunctionType:
        """Return the source as it stands, with something around the calls of some kernels, at any depth."""
        functions: dict[str, Any] = {name: callee._plain(wraps) for name, callee in self._callees()}
        return self._bound({name: wraps[name](f) if name in wraps else f for name, f in functions.items()})

    def _over_objects(self, *args: Any) -> Any:
        wraps = _wraps.get()
        return self._plain(wraps)(*args) if wraps else self.plain(*args)

    @property
    def compiled(self) -> Callable[..., Any]:
        """The source compiled by Numba, with all that it calls; kept on disk where possible."""
        if self._compiled is None:
            from knotwork.arithmetic import compiling

            with _lock:
                if self._compiled is None:
                    if WATCHERS:
                        compiling.watch()
                    directory = cache_directory() / f"{self.source.__name__}-{self.digest}"
                    self._compiled = compiling.whole(self._bound_to_parts(), self.options, directory)
        return self._compiled

    @functools.cached_property
    def part(self) -> Callable[..., Any]:
        """The source for Numba to take into the kernels that call it."""
        from knotwork.arithmetic import compiling

        return compiling.part(self._bound_to_parts(), self.options)

    def _bound_to_parts(self) -> FunctionType:
        bound = self._bound({name: callee.part for name, callee in self._callees()})
        if self.names:  # what came from the cache is linked by name, and a variant shares its own
            bound.__qualname__ += f"_{self.digest}"
        return bound

    @functools.cached_property
    def digest(self) -> str:
        """A hash of the source, of all kernels below it and of the constants they use."""
        import hashlib

        # Numba's cache names the module; its own variable makes every index checked
        how = (self.options, self.source.__module__, os.environ.get("NUMBA_BOUNDSCHECK", ""))
        hasher = hashlib.sha256(repr(how).encode())
        _hash_code(hasher, self.source.__code__)
        if self.names:
            hasher.update(b"variant")  # which is linked by a name of its own
        hasher.update(repr(self.source.__defaults__).encode())
        for name in self.source.__code__.co_names:
            value = self.source.__globals__.get(name)
            if isinstance(value, int | float | str | tuple):
                hasher.update(f"{name}={value!r};".encode())
            elif isinstance(value, type) and hasattr(value, "_fields"):  # a named tuple
                hasher.update(f"{name}={value._fields!r};".encode())
        for name, callee in self._callees():
            hasher.update(f"{name}:{callee.digest};".encode())
        return hasher.hexdigest()[:16]


def _numba_is_there() -> bool:
    """Tell whether Numba is imported; while another thread imports it, work goes on without."""
    spec = getattr(sys.modules.get("numba"), "__spec__", None)
    return spec is not None and not getattr(spec, "_initializing", False)


def _elements(args: tuple[Any, ...]) -> int:
    """Count the elements of arrays, also of those in tuples."""
    return sum(a.size if isinstance(a, np.ndarray) else _elements(a) for a in args if isinstance(a, np.ndarray | tuple))


@overload
def kernel(source: Callable[..., Any]) -> Kernel: ...
@overload
def kernel(*, inline: bool) -> Callable[[Callable[..., Any]], Kernel]: ...
def kernel(source: Callable[..., Any] | None = None, *, inline: bool = True) -> Any:
    """Mark a plain function over arrays, scalars and loops as an algorithm with one source.

    With ``inline=False`` its code is not copied into each kernel that calls it: for what is long and called at many
    places, as in a search, where copies of copies would take minutes to compile.
    """
    if source is None:
        return functools.partial(kernel, inline=inline)
    assert isinstance(source, FunctionType)
    return Kernel(source, inline=inline)


@contextmanager
def wrapped(**wraps: Wrap) -> Iterator[None]:
    """Within, kernels that run over objects call ``wrap(f)`` for a kernel f of that name: to count or record calls."""
    token = _wraps.set({**(_wraps.get() or {}), **wraps})
    try:
        yield
    finally:
        _wraps.reset(token)


def extent(count: int) -> Any:
    """Return something of length `count` for a kernel to loop over: a tuple, known to the compiler, if short."""
    return (0,) * count if count <= UNROLLED else np.empty(count, np.int8)


def _hash_code(hasher: Any, code: CodeType) -> None:
    """Feed everything of a code object that matters, but neither its file nor its lines."""
    hasher.update(code.co_code)
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            _hash_code(hasher, constant)
        else:
            hasher.update(repr(constant).encode())
    hasher.update(repr((code.co_names, code.co_varnames, code.co_argcount)).encode())


def cache_directory() -> Path:
    """Return the directory of compiled kernels: ``$KNOTWORK_CACHE`` or the user's cache directory."""
    from pathlib import Path

    given = os.environ.get("KNOTWORK_CACHE")
    if given:
        return Path(given)
    base = os.environ.get("LOCALAPPDATA" if os.name == "nt" else "XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "knotwork"
