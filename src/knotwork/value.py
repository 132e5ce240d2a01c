"""What is frozen: values, whose attributes are set once."""

from __future__ import annotations

from dataclasses import FrozenInstanceError
from typing import Any

import numpy as np


class Frozen:
    """A value: its attributes are set once, when it is made."""

    __slots__ = ()

    def __setattr__(self, name: str, value: Any) -> None:
        raise FrozenInstanceError(f"cannot assign to {name!r}: a {type(self).__name__} is a value")

    def __delattr__(self, name: str) -> None:
        raise FrozenInstanceError(f"cannot delete {name!r}: a {type(self).__name__} is a value")

    def __setstate__(self, state: tuple[Any, dict[str, Any]]) -> None:
        """Fill in what was pickled or copied; arrays are read-only again."""
        for name, value in state[1].items():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
            object.__setattr__(self, name, value)
