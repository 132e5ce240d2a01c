"""The command `knotwork`: a thin command for each function of the face, over files."""

from knotwork.cli import (  # their commands join the program
    bulk,
    changing,
    crossing,
    editing,
    fitting,
    insertion_methods,
    measuring,
    reducing,
    shaping,
    telling,
    writing,
)
from knotwork.cli.program import main

__all__ = [
    "bulk",
    "changing",
    "crossing",
    "editing",
    "fitting",
    "insertion_methods",
    "main",
    "measuring",
    "reducing",
    "shaping",
    "telling",
    "writing",
]
