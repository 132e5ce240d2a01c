"""How Numba compiles kernels: a whole, called from Python and kept on disk, or a part, called by other kernels.

Numba optimises a function together with all that it calls, and so each function once more for each level above it.
A part is left as it was translated: only the whole that calls it is linked, optimised and turned into machine code.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path
from types import FunctionType
from typing import Any

import numba
from llvmlite.binding import Linkage
from numba.core import codegen, compiler, event


class WholeLibrary(codegen.JITCodeLibrary):  # type: ignore[misc]
    """Code that is optimised together with all parts below it."""

    #: whether it is short, and copied into what calls it: that comes out better if each function is optimised before
    inline = False

    def _optimize_functions(self, ll_module: Any) -> None:
        """Optimise each function by itself if it is short; to leave that out takes half as long."""
        if self.inline:
            super()._optimize_functions(ll_module)
        else:
            ll_module.data_layout = self._codegen._data_layout

    def finalize(self) -> None:
        """Link the parts, and those that they call."""
        libraries = self._linking_libraries
        for library in libraries:  # while it grows
            if isinstance(library, PartLibrary):
                libraries.extend(below for below in library._linking_libraries if below not in libraries)
        super().finalize()

    def _optimize_final_module(self) -> None:
        """Optimise; nobody else calls the parts, so that arguments they do not need go."""
        for function in self._final_module.functions:
            if function.linkage == Linkage.linkonce_odr and not function.is_declaration:
                function.linkage = "internal"
        super()._optimize_final_module()


class PartLibrary(WholeLibrary):
    """Code that others take in: neither linked nor optimised nor turned into machine code by itself."""

    def finalize(self) -> None:
        """Be ready to be taken in."""
        self._raise_if_finalized()
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return 0: there is no machine code."""
        self._ensure_finalized()
        return 0

    @property
    def codegen(self) -> PartLibrary:
        """What Numba gives the environment of a function to."""
        return self

    def set_env(self, name: str, environment: object) -> None:
        """Forget the environment: kernels use none."""


class WholeCompiler(compiler.CompilerBase):  # type: ignore[misc]
    """Numba's compiler, but for where the code goes."""

    code = WholeLibrary

    def define_pipelines(self) -> list[Any]:
        """Return the usual steps."""
        library = self.code(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        library.inline = self.state.flags.forceinline
        library.enable_object_caching()
        self.state["library"] = library
        return [compiler.DefaultPassBuilder.define_nopython_pipeline(self.state)]


class PartCompiler(WholeCompiler):
    """The compiler of parts."""

    code = PartLibrary


def _dispatcher(bound: FunctionType, options: dict[str, Any]) -> Any:
    """Have Numba compile a function when it is called."""
    result: Any = numba.njit(**options)(bound)
    choose = result.get_call_template
    # a literal among the arguments is a number like others; Numba would compile the kernel anew for each
    result.get_call_template = lambda args, kws: choose(tuple(map(numba.types.unliteral, args)), kws)
    return result


def part(bound: FunctionType, options: dict[str, Any]) -> Callable[..., Any]:
    """Return what compiled kernels call; Python can not call it."""
    return _dispatcher(bound, {**options, "no_cpython_wrapper": True, "pipeline_class": PartCompiler})  # type: ignore[no-any-return]


def whole(bound: FunctionType, options: dict[str, Any], directory: Path) -> Callable[..., Any]:
    """Return what Python calls, kept on disk in a directory of this very source; without one if it is not writable."""
    options = {**options, "pipeline_class": WholeCompiler}
    cached, previous = _dispatcher(bound, options), numba.config.CACHE_DIR
    try:
        numba.config.CACHE_DIR = str(directory)
        cached.enable_caching()
    except (RuntimeError, OSError):  # no writable place
        return _dispatcher(bound, options)  # type: ignore[no-any-return]
    finally:
        numba.config.CACHE_DIR = previous
    cache = cached._cache
    if not str(cache.cache_path).startswith(str(directory)):
        return _dispatcher(bound, options)  # type: ignore[no-any-return]  # Numba's other places are not keyed by the digest
    save = cache.save_overload

    def save_if_possible(*args: Any) -> None:
        try:
            save(*args)
        except OSError:  # the disk is full, or the directory was made read-only since
            cache.disable()

    cache.save_overload = save_if_possible
    return cached  # type: ignore[no-any-return]


@functools.cache
def watch() -> None:
    """Have Numba tell the watchers when it begins and ends to compile."""
    from knotwork.arithmetic.kernel import WATCHERS

    class Watch(event.Listener):  # type: ignore[misc]
        def on_start(self, _: Any) -> None:
            for watcher in WATCHERS:
                watcher(True)

        def on_end(self, _: Any) -> None:
            for watcher in WATCHERS:
                watcher(False)

    event.register("numba:compile", Watch())
