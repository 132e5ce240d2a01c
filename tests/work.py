"""Work measured without a clock, so that a busy machine changes nothing."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def calls_within(limit: int) -> Iterator[None]:
    """Assert that what runs inside calls no more than so many functions, those of Python and of C together."""
    count = 0

    def called(frame: Any, event: str, argument: Any) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(called)
    try:
        yield
    finally:
        sys.setprofile(None)
    assert count <= limit, f"{count} calls"
