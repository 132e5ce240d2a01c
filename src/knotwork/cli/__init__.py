"""The command `knotwork`: a thin command for each function of the face, over files."""

from knotwork.cli import changing, editing, insertion_methods, telling, writing  # their commands join the program
from knotwork.cli.program import main

__all__ = ["changing", "editing", "insertion_methods", "main", "telling", "writing"]
