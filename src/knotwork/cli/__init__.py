"""The command `knotwork`: a thin command for each function of the face, over files."""

from knotwork.cli import study  # its commands join the others
from knotwork.cli.commands import main

__all__ = ["main", "study"]
