"""The server of the editor: one page, one socket per tab, and nobody else (only this computer, only with the token)."""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import secrets
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import HTTPConnection, Request
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect

from knotwork.editor import exchange
from knotwork.editor.messages import Message
from knotwork.editor.rooms import Rooms
from knotwork.editor.store import Store
from knotwork.errors import KnotworkError

LOG = logging.getLogger(__name__)
STATIC = Path(__file__).parent / "static"
#: bytes of one message, at most
MESSAGE = 4_000_000
#: messages per second from one tab, on average, and in a burst
RATE, BURST = 120, 600
#: tabs at once
TABS = 32

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
    "font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Guard:
    """Lets through who speaks to this host by its own name, and adds the headers that keep others out."""

    def __init__(self, app: ASGIApp, hosts: frozenset[str]) -> None:
        self.app = app
        self.hosts = hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check the host and, where there is one, the origin."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        connection = HTTPConnection(scope)
        host, origin = connection.headers.get("host", ""), connection.headers.get("origin")
        if host not in self.hosts or (origin is not None and origin not in {f"http://{h}" for h in self.hosts}):
            await _refused(scope, receive, send)
            return

        async def with_headers(message: Any) -> None:
            if message["type"] == "http.response.start":
                more = [(k.lower().encode(), v.encode()) for k, v in HEADERS.items()]
                message["headers"] = [*message["headers"], *more]
            await send(message)

        await self.app(scope, receive, with_headers)


async def _refused(scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "websocket":
        await WebSocket(scope, receive, send).close(4403)
    else:
        await PlainTextResponse("This is somebody's drawing board.", 403)(scope, receive, send)


def application(store: Store, token: str, hosts: frozenset[str], first: str | None = None) -> Starlette:
    """Return the editor as an ASGI application.

    Parameters
    ----------
    store : Store
        Where the drawings are.
    token : str
        What the address of the page must have, as ``?token=…``.
    hosts : frozenset of str
        The names under which this server is spoken to: ``127.0.0.1:8023``.
    first : str, optional
        The document to open first.
    """
    rooms = Rooms(store)
    tabs = 0

    def known(connection: HTTPConnection) -> bool:
        return secrets.compare_digest(connection.query_params.get("token", "").encode(), token.encode())

    async def page(request: Request) -> Response:
        if not known(request):
            raise HTTPException(403, "The address lacks its token; use the one that `knotwork edit` printed.")
        return FileResponse(STATIC / "index.html")

    async def export(request: Request) -> Response:
        if not known(request):
            raise HTTPException(403)
        kind, document = request.path_params["kind"], request.path_params["document"]
        try:
            data = exchange.taken(rooms.state(document).sketch, kind)
        except KnotworkError as exc:
            return JSONResponse({"error": str(exc)}, 400)
        headers = {"Content-Disposition": f'attachment; filename="drawing.{kind}"'}
        return Response(data, media_type=exchange.EXPORTS[kind], headers=headers)

    async def bring(request: Request) -> Response:
        if not known(request):
            raise HTTPException(403)
        data = bytearray()
        async for part in request.stream():
            data += part
            if len(data) > exchange.UPLOAD:
                return JSONResponse({"error": f"the file is larger than {exchange.UPLOAD:,} bytes"}, 413)
        suffix = Path(request.query_params.get("name", "")).suffix.lower()[:10]
        try:
            curves, remarks = await asyncio.to_thread(exchange.brought, bytes(data), suffix)
            said = await rooms.bring(request.path_params["document"], curves, suffix)
        except KnotworkError as exc:
            return JSONResponse({"error": str(exc)}, 400)
        return JSONResponse({"reason": " ".join([said, *remarks])})

    async def socket(ws: WebSocket) -> None:
        nonlocal tabs
        if not known(ws) or ws.headers.get("origin") is None or tabs >= TABS:
            await ws.close(4403)
            return
        await ws.accept()
        tabs += 1
        try:
            await _conversation(ws, rooms, first)
        finally:
            tabs -= 1

    @contextlib.asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        yield
        store.close()

    app = Starlette(
        routes=[
            Route("/", page),
            Route("/export/{document}/{kind}", export),
            Route("/import/{document}", bring, methods=["POST"]),
            WebSocketRoute("/socket", socket),
            Mount("/static", StaticFiles(directory=STATIC)),
        ],
        lifespan=lifespan,
    )
    app.add_middleware(Guard, hosts=hosts)
    return app


class Budget:
    """How many messages a tab may still send: it fills at a rate, up to a burst."""

    def __init__(self) -> None:
        self._left, self._then = float(BURST), time.monotonic()

    def spend(self) -> bool:
        """Take one, if there is one."""
        now = time.monotonic()
        self._left = min(BURST, self._left + RATE * (now - self._then)) - 1
        self._then = now
        if self._left < 0:
            self._left = 0
            return False
        return True


async def _conversation(ws: WebSocket, rooms: Rooms, first: str | None) -> None:
    """Answer the messages of one tab, one after the other, until it leaves."""
    sending = asyncio.Lock()

    async def say(message: dict[str, Any]) -> None:
        text = json.dumps(message, allow_nan=False, separators=(",", ":"))
        async with sending:
            await ws.send_text(text)

    budget = Budget()
    tab = rooms.enter(say)
    try:
        await say(rooms.welcome(first))
        while True:
            text = await ws.receive_text()
            await _answer(text, budget, say, lambda message: rooms.hear(tab, message))
    except (WebSocketDisconnect, RuntimeError):
        pass  # the tab was closed
    finally:
        rooms.leave(tab)


async def _answer(
    text: str,
    budget: Budget,
    say: Callable[[dict[str, Any]], Awaitable[None]],
    hear: Callable[[Message], Awaitable[dict[str, Any]]],
) -> None:
    """Answer one message; what is wrong with it is said, and the work goes on."""
    number = None
    try:
        if len(text) > MESSAGE:
            raise KnotworkError(f"the message has {len(text):,} letters; at most {MESSAGE:,} are taken")
        if not budget.spend():
            raise KnotworkError("too many messages at once; some were left out")
        try:
            values = json.loads(text, parse_constant=_no_number)
        except (ValueError, RecursionError):
            raise KnotworkError("the message is not JSON") from None
        message = Message(values)
        number = message.values.get("id")
        answer = await hear(message)
    except KnotworkError as exc:
        answer = {"error": str(exc)}
    except Exception:  # a fault of ours: it is written down, and the other messages are answered all the same
        LOG.exception("a message was not answered")
        answer = {"error": "Knotwork itself has failed here; nothing was changed"}
    await say({"id": number if isinstance(number, int) else None, **answer})


def _no_number(name: str) -> None:
    raise ValueError(f"{name} is not a number")
