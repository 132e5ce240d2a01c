"""The words of a text file, one after the other; what is wrong with one is told with its line."""

from __future__ import annotations

import re

import numpy as np

from knotwork.arithmetic.arrays import Array
from knotwork.errors import FileError

_WORD = re.compile(r"\S+")


class Words:
    """The words of a file, from the first to the last.

    Parameters
    ----------
    data : bytes
    comment : str
        What begins a comment that ends with its line; none if ''.
    """

    def __init__(self, data: bytes, comment: str = "") -> None:
        self.text = data.decode("latin-1")
        # blanks instead, so that places stay
        plain = re.sub(f"{comment}[^\n]*", lambda m: " " * len(m[0]), self.text) if comment else self.text
        self.words = [(m.start(), m[0]) for m in _WORD.finditer(plain)]
        self.at = 0

    @property
    def over(self) -> bool:
        """Whether there is no word left."""
        return self.at >= len(self.words)

    @property
    def next(self) -> str:
        """The next word, which is not taken; "the end of the file" if there is none."""
        return "the end of the file" if self.over else self.words[self.at][1]

    def where(self) -> str:
        """Return where the next word is."""
        place = self.words[min(self.at, len(self.words) - 1)][0] if self.words else 0
        return f"line {self.text.count(chr(10), 0, place) + 1}"

    def taken(self, *expected: str) -> str:
        """Take the next word, which is one of these, and return it."""
        word = self.next
        if word not in expected:
            raise FileError(f"{self.where()}: {word[:20]!r} given; expected {' or '.join(expected)}")
        self.at += 1
        return word

    def skip(self, word: str) -> bool:
        """Take the next word if it is this one."""
        found = self.next == word
        self.at += found
        return found

    def whole(self, least: int) -> int:
        """Return the next number, which is whole."""
        word = self.next
        if not re.fullmatch(r"\d{1,9}", word) or int(word) < least:
            raise FileError(f"{self.where()}: {word[:20]!r} given; expected a whole number of {least} or more")
        self.at += 1
        return int(word)

    def floats(self, count: int) -> Array:
        """Return the next numbers."""
        words = self.words[self.at : self.at + count]
        if len(words) < count:
            raise FileError(f"{self.where()}: {count} numbers are needed; the file has {len(words)} more")
        for _, word in words:
            try:
                float(word)
            except ValueError:
                raise FileError(f"{self.where()}: {word[:20]!r} given; expected a number") from None
            self.at += 1
        return np.array([word for _, word in words], np.float64)
