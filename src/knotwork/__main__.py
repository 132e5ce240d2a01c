"""`python -m knotwork` is the command `knotwork`."""

from knotwork.cli import main

main(prog_name="knotwork")
