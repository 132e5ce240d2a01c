"""The command that opens the editor."""

from __future__ import annotations

from pathlib import Path

import click

from knotwork.cli.program import FILE, main


@main.command(short_help="Sketch curves in the browser.")
@click.argument("file", type=FILE, required=False)
@click.option("--store", type=FILE, help="Where drawings are kept.  [default: the user's directory for data]")
@click.option("--port", type=click.IntRange(0, 65535), default=0, help="Port.  [default: that of the last time]")
@click.option("--browser/--no-browser", default=True, help="Open the browser.  [default: yes]")
def edit(file: Path | None, store: Path | None, port: int, browser: bool) -> None:
    """Open the sketching editor in the browser, with the curves of FILE if one is given; FILE is not changed.

    Drawings are kept from stroke to stroke. The address works on this computer only, and only with its token.

    \b
    Examples:
      knotwork edit
      knotwork edit drawing.svg
    """
    from knotwork.editor.launch import edit as start

    start(file, store=store, port=port, browse=browser, warm=True, announce=click.echo)
