"""Start the editor: a port of this computer, a token, a browser."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import socket
import subprocess
import sys
import threading
import webbrowser
from collections.abc import Callable
from pathlib import Path

import numpy as np

from knotwork.errors import MissingExtraError, ParameterError


def data_directory() -> Path:
    """Return where drawings are kept: ``$KNOTWORK_DATA`` or the user's directory for data."""
    given = os.environ.get("KNOTWORK_DATA")
    if given:
        return Path(given)
    if sys.platform == "win32":
        return Path(os.environ.get("APPDATA", Path.home())) / "knotwork"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "knotwork"
    return Path(os.environ.get("XDG_DATA_HOME", Path.home() / ".local" / "share")) / "knotwork"


def edit(
    file: Path | None = None,
    *,
    store: Path | None = None,
    port: int = 0,
    browse: bool = True,
    warm: bool = False,
    announce: Callable[[str], None] = print,
) -> None:
    """Serve the editor on 127.0.0.1 until it is stopped.

    Parameters
    ----------
    file : Path, optional
        A drawing to open first; the file itself is not changed.
    store : Path, optional
        The SQLite file of the drawings; by default in the user's directory for data.
    port : int
        0 takes the one of the last time, or else a free one.
    browse : bool
        Whether to open a browser.
    warm : bool
        Whether to compile beside what the first curve drawn by hand needs, if it has never been compiled.
    announce : callable
        Is told the address.

    Raises
    ------
    MissingExtraError
        If Starlette, uvicorn or websockets is not there.
    FileError
        If the file cannot be read.
    """
    try:
        import uvicorn
        import websockets  # noqa: F401
        from starlette.applications import Starlette  # noqa: F401
    except ImportError as exc:
        raise MissingExtraError(
            f"the editor needs {exc.name}; install it: pip install starlette uvicorn websockets"
        ) from None
    from knotwork.editor import exchange
    from knotwork.editor.server import MESSAGE, application
    from knotwork.editor.store import Store
    from knotwork.files.storage import fetch
    from knotwork.sketch import Sketch

    if not 0 <= port <= 65535:
        raise ParameterError(f"port {port} given; expected 0 to 65535")
    store = store or data_directory() / "drawings.sqlite3"
    drawings = Store(store)
    first = None
    if file is not None:
        curves, _ = exchange.brought(fetch(file), file.suffix.lower())
        first = drawings.create(file.stem, Sketch(tuple(curves)))
    kept, token = _last_address(store)
    with _listening(port or kept, otherwise=port) as listener:
        number = listener.getsockname()[1]
        _keep_address(store, number, token)
        hosts = frozenset({f"127.0.0.1:{number}", f"localhost:{number}"})
        address = f"http://127.0.0.1:{number}/?token={token}"
        announce(address)
        if browse:
            webbrowser.open(address)
        if warm:
            threading.Thread(target=_warm, daemon=True).start()
        app = application(drawings, token, hosts, first)
        config = uvicorn.Config(app, log_level="warning", ws_max_size=MESSAGE + 1000, server_header=False)
        uvicorn.Server(config).run(sockets=[listener])


def _warm() -> None:
    """Have what a stroke runs compiled by another process that leaves the processor to this one; then load it here.

    Kernels run as plain Python until much of it is done: the first hundred strokes would take ten times as long.
    """
    command = [sys.executable, "-c", "from knotwork.editor.launch import compile_apart; compile_apart()"]
    silent = subprocess.DEVNULL
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=silent, stderr=silent) as compiler:
        compiler.wait()
    first_curve()


def compile_apart() -> None:
    """Compile in a process of its own, which ends with the one that began it: then its standard input does."""

    def watch() -> None:
        sys.stdin.buffer.read()
        os._exit(0)

    threading.Thread(target=watch, daemon=True).start()
    getattr(os, "nice", int)(15)
    first_curve()


def first_curve() -> None:
    """Draw an arc of 400 points by hand, across it a straight stroke, and forget them: all of it compiled."""
    import numba  # noqa: F401  # from now on kernels run compiled

    from knotwork.editor.views import view
    from knotwork.sketch import Sketch, stroke

    turn = np.linspace(0, np.pi, 400)
    drawn = stroke(Sketch(), np.stack([np.cos(turn), np.sin(turn)], axis=1)).sketch
    view(stroke(drawn, np.stack([np.linspace(-0.5, 0.5, 20), np.full(20, 0.9)], axis=1)).sketch.curves[0])


def _last_address(store: Path) -> tuple[int, str]:
    """Return the port and the token of the last time, for pages that are still open; or else 0 and a new token.

    They lie in a file beside the drawings that only its owner can read.
    """
    try:
        port, token = json.loads(_address_file(store).read_text())
    except (OSError, ValueError):
        return 0, secrets.token_urlsafe(24)
    known = isinstance(port, int) and 0 < port <= 65535 and isinstance(token, str) and len(token) >= 32
    return (port, token) if known else (0, secrets.token_urlsafe(24))


def _keep_address(store: Path, port: int, token: str) -> None:
    target = _address_file(store)
    part = target.with_name(f"{target.name}.{os.getpid()}")
    with open(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w") as file:
        json.dump([port, token], file)
    os.replace(part, target)


def _address_file(store: Path) -> Path:
    return store.with_name(store.name + ".address")


def _listening(port: int, otherwise: int) -> socket.socket:
    """Return a socket of this computer that listens on a port; if that is taken, on another."""
    with contextlib.ExitStack() as undo:
        listener = undo.enter_context(socket.socket())
        if os.name == "posix":  # elsewhere it would share the port with a stranger
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind(("127.0.0.1", port))
            listener.listen(100)  # who follows the address at once waits, and is not turned away
        except OSError as exc:
            if otherwise == port:
                raise ParameterError(f"port {port} cannot be used: {exc.strerror}") from None
            return _listening(otherwise, otherwise)
        undo.pop_all()
        return listener
