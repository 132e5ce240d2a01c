"""How the commands talk: errors and notes of one line, progress on a terminal, tolerances and lists as arguments."""

from __future__ import annotations

import math
import sys
import time
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from knotwork.errors import KnotworkError, MissingExtraError

if TYPE_CHECKING:
    from knotwork.spline import Spline


#: what can be asked to stay
FEATURES = ("corners", "lines", "extrema")


class Failure(click.ClickException):
    """What went wrong, in one line on stderr; the exit code is 1."""

    def show(self, file: Any = None) -> None:
        """Write the line."""
        click.echo(f"knotwork: {' '.join(self.message.split())}", err=True)


class Commands(click.Group):
    """Commands whose errors become one line, and whose warnings become notes."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command."""
        try:
            with notes():
                return super().invoke(ctx)
        except BrokenPipeError:
            raise
        except (KnotworkError, MissingExtraError, MemoryError, OSError) as exc:
            raise Failure(str(exc) or type(exc).__name__) from exc


@contextmanager
def notes() -> Iterator[None]:
    """Show warnings as lines on stderr."""

    def show(message: Warning | str, *_: Any, **__: Any) -> None:
        click.echo(f"knotwork: note: {' '.join(str(message).split())}", err=True)

    with warnings.catch_warnings():
        warnings.simplefilter("default")
        warnings.showwarning = show
        yield


class Progress:
    """A percentage on stderr, if that is a terminal and the work takes longer than half a second."""

    def __init__(self, what: str, total: float) -> None:
        self.what, self.total, self.done = what, max(total, 1), 0.0
        self.start, self.shown = time.monotonic(), -1
        self.visible = sys.stderr.isatty()

    def update(self, part: float) -> None:
        """Show that beyond the finished work `part` of the total is done."""
        percent = int(100 * min((self.done + part) / self.total, 1))
        if self.visible and percent != self.shown and time.monotonic() - self.start > 0.5:
            self.shown = percent
            click.echo(f"\r{self.what} … {percent:3d}%", err=True, nl=False)

    def finish(self, part: float) -> None:
        """Count `part` of the total as finished."""
        self.done += part
        self.update(0)

    def close(self) -> None:
        """Clear the line."""
        if self.shown >= 0:
            click.echo("\r\033[K", err=True, nl=False)


class Compiling:
    """Says on a terminal that kernels are compiled, which happens once, and counts the time that it takes."""

    def __init__(self) -> None:
        self.depth, self.spent, self.begun, self.told = 0, 0.0, 0.0, False

    def __call__(self, begins: bool) -> None:
        """Take note that compiling begins or ends."""
        self.depth += 1 if begins else -1
        if begins and self.depth == 1:
            self.begun = time.perf_counter()
            if not self.told and sys.stderr.isatty():
                click.echo("knotwork: compiling, once; the next call finds it done", err=True)
            self.told = True
        elif self.depth == 0:
            self.spent += time.perf_counter() - self.begun

    def seconds(self) -> float:
        """Return the time spent so far."""
        return self.spent

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Watch Numba."""
        from knotwork.arithmetic.kernel import WATCHERS

        WATCHERS.append(self)
        try:
            yield
        finally:
            WATCHERS.remove(self)


compiling = Compiling()


class Size(click.FloatRange):
    """A number in a range; NaN, which compares as false with both ends, is not in it."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number."""
        number = float(super().convert(value, param, ctx))
        if math.isnan(number):
            self.fail(f"{value} is not in the range {self.min} to {self.max}", param, ctx)
        return number


@dataclass(frozen=True)
class Tolerance:
    """A length in the units of the points, or a part of their extent."""

    value: float
    relative: bool
    #: whether it is in metres on the ground instead
    ground: bool = False

    def of(self, splines: Sequence[Spline]) -> float:
        """Return the length, if need be as a part of the extent of all splines together."""
        if not self.relative:
            return self.value
        from knotwork.geometry.boxes import extent

        try:
            return self.value * float(extent(splines))
        except OverflowError:
            raise Failure("the extent is beyond float64, so is a percentage of it; expected a length") from None


def tolerance(text: str) -> Tolerance:
    """Return the tolerance that a text means: a number of at least 0, or a percentage such as 0.1%."""
    number = _number(text.removesuffix("%"))
    if not 0 <= number < math.inf:
        raise click.BadParameter(f"{text!r}; expected a length of at least 0 such as 0.5, or a percentage such as 0.1%")
    relative = text.endswith("%")
    return Tolerance(number / 100 if relative else number, relative)


def tolerance_or_metres(text: str) -> Tolerance:
    """Return a tolerance, which may also be a length on the ground: 100m, 2km."""
    for unit, metres in (("km", 1000.0), ("m", 1.0)):
        if text.endswith(unit):
            found = tolerance(text.removesuffix(unit))
            if found.relative:
                raise click.BadParameter(f"{text!r}; expected a length on the ground such as 100m or 2km")
            return Tolerance(found.value * metres, False, ground=True)
    return tolerance(text)


def knots(text: str) -> list[float]:
    """Return the numbers of a list separated by commas."""
    found = [_number(part) for part in text.split(",")]
    if not all(map(math.isfinite, found)):
        raise click.BadParameter(f"{text!r}; expected finite numbers separated by commas, such as 0.25,0.5,0.5")
    return found


def _number(text: str) -> float:
    """Return a text as a number, NaN if it is none."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def features(text: str) -> list[str]:
    """Return the names of features of a curve, separated by commas."""
    found = text.split(",")
    for name in found:
        if name not in FEATURES:
            raise click.BadParameter(f"{name!r}; expected {', '.join(FEATURES)}, separated by commas")
    return found


def axes(text: str) -> list[int]:
    """Return the numbers of two or three coordinates, from 1."""
    parts = text.split(",")
    if not all(part.strip().isdigit() and int(part) > 0 for part in parts) or not 2 <= len(parts) <= 3:
        raise click.BadParameter(f"{text!r}; expected two or three numbers of coordinates, such as 1,3")
    return [int(part) for part in parts]


def box(text: str) -> list[float]:
    """Return a box: x and y of two corners."""
    found = [_number(part) for part in text.split(",")]
    if len(found) != 4 or not all(map(math.isfinite, found)) or not (found[0] < found[2] and found[1] < found[3]):
        raise click.BadParameter(f"{text!r}; expected x0,y0,x1,y1 with x0 below x1 and y0 below y1")
    return found
