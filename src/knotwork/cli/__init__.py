"""The command `knotwork`: a thin command for each function of the face, over files."""

from knotwork.cli import changing, insertion_methods, telling, writing  # their commands join the program
from knotwork.cli.program import main

__all__ = ["changing", "insertion_methods", "main", "telling", "writing"]
