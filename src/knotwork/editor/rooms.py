"""Who looks at which document, and when each tab is told of a change.

Who made it gets its picture at once, as not yet saved; then it is committed; then it is acknowledged, and told to every
other tab. If it cannot be committed, the picture is taken back.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections import defaultdict
from collections.abc import Awaitable, Callable, Iterator
from typing import Any

from knotwork.editor import actions, lens, views
from knotwork.editor.messages import Message
from knotwork.editor.store import ConflictError, State, Store
from knotwork.errors import KnotworkError
from knotwork.sketch import Sketch
from knotwork.spline import Spline

Say = Callable[[dict[str, Any]], Awaitable[None]]


class Tab:
    """A page that is open: how to speak to it, and what it has."""

    def __init__(self, say: Say) -> None:
        self.say = say
        self.document: str | None = None
        #: the views that it draws now
        self.views: list[dict[str, Any]] = []
        #: the curves that the views are of
        self.curves: tuple[Spline, ...] = ()


class Rooms:
    """The documents that are open, and the tabs that look at them."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._tabs: set[Tab] = set()
        self._states: dict[str, State] = {}
        #: per document: its changes come one after the other, each told to all before the next
        self._turns: defaultdict[str, asyncio.Lock] = defaultdict(asyncio.Lock)

    def enter(self, say: Say) -> Tab:
        """Let a tab in."""
        tab = Tab(say)
        self._tabs.add(tab)
        return tab

    def leave(self, tab: Tab) -> None:
        """Let a tab go; what nobody looks at is dropped from memory."""
        self._tabs.discard(tab)
        if tab.document is not None and not any(other.document == tab.document for other in self._tabs):
            self._states.pop(tab.document, None)

    def state(self, document: str) -> State:
        """Return a document as it is now."""
        if document not in self._states:
            self._states[document] = self._store.state(document)
        return self._states[document]

    def welcome(self, first: str | None) -> dict[str, Any]:
        """Return what a tab is told first."""
        aside = self._store.damaged
        warning = f"The file of drawings was damaged. It is kept as {aside}; this is a new one." if aside else None
        return {"hello": 1, "documents": self._list(), "first": first, "warning": warning}

    async def hear(self, tab: Tab, message: Message) -> dict[str, Any]:
        """Do what a tab asks, and return the answer."""
        if "open" in message:
            return self._open(tab, message.text("open"))
        if "documents" in message:
            return await self._document(tab, message)
        if tab.document is None:
            raise KnotworkError("no document is open")
        state = self.state(tab.document)
        if "ask" in message:
            if not state.sketch.curves:
                raise KnotworkError("the drawing has no curve yet")
            return {"answer": lens.look(state.sketch, message)}
        return await self._change(tab, tab.document, message)

    async def bring(self, document: str, curves: list[Spline], suffix: str) -> str:
        """Add curves from a file to a document, and return what is to be said."""
        async with self._turns[document]:
            state = self.state(document)
            done = actions.add(state.sketch, curves, f"the {suffix[1:].upper()} file")
            self._commit(document, state, done.sketch, actions.as_action(done))
            await self._tell(document, None)
            return done.reason

    # ---- documents ----------------------------------------------------------------------------------------------

    def _list(self) -> list[dict[str, Any]]:
        return [{"id": d.id, "name": d.name, "changed": d.changed, "curves": d.curves} for d in self._store.documents()]

    def _open(self, tab: Tab, document: str) -> dict[str, Any]:
        state = self.state(document)
        tab.document, tab.views, tab.curves = document, [], ()
        return self._news(tab, state)

    async def _document(self, tab: Tab, message: Message) -> dict[str, Any]:
        what = message.choice("documents", ("list", "new", "rename", "duplicate", "delete", "restore"))
        store, made = self._store, None
        if what == "new":
            made = store.create(message.text("name"))
        elif what == "rename":
            store.rename(message.text("document"), message.text("name"))
        elif what == "duplicate":
            made = store.duplicate(message.text("document"), message.text("name"))
        elif what in ("delete", "restore"):
            store.delete(message.text("document"), what == "delete")
        listed = {"documents": self._list()}
        if what != "list":
            for other in [t for t in self._tabs if t is not tab]:
                await other.say(listed)
        return {**listed, "made": made}

    # ---- changes ------------------------------------------------------------------------------------------------

    async def _change(self, tab: Tab, document: str, message: Message) -> dict[str, Any]:
        async with self._turns[document]:
            state = self.state(document)
            stale = "based on" in message and message.whole("based on", 0, 2**53) != state.number
            key = message.text("key", 64) if "key" in message else None
            if key and self._store.has(document, key):  # said again after the line broke
                return self._news(tab, state)
            if stale:  # so an undo that is said again is not done twice either
                raise ConflictError("the drawing was changed elsewhere in the meantime; here it is")
            if message.choice("do", ("undo", "redo", *actions.ACTIONS)) in ("undo", "redo"):
                self._move(document, state, message.values["do"])
            else:
                done = actions.perform(state.sketch, message)
                if done.case == "ignored":
                    return {**self._news(tab, state), "case": done.case, "reason": done.reason}
                await self._draw(tab, document, state, done, message)
            await self._tell(document, tab)
            return self._news(tab, self._states[document])

    async def _draw(self, tab: Tab, document: str, state: State, done: actions.Done, message: Message) -> None:
        """Show a change to who made it, and commit it; if that fails, show again what is on disk."""
        action = {**actions.as_action(done), "key": message.values.get("key")}
        shown = State(state.number, done.sketch, (), action, undo=True, redo=False)
        await tab.say({**self._news(tab, shown), "picture": message.values.get("id")})
        try:
            self._commit(document, state, done.sketch, action)
        except Exception:
            await tab.say({**self._news(tab, self.state(document)), "reason": ""})
            raise

    def _commit(self, document: str, state: State, sketch: Sketch, action: dict[str, Any]) -> None:
        with self._forgetting(document):
            self._states[document] = self._store.commit(document, state, sketch, action)

    def _move(self, document: str, state: State, way: str) -> None:
        with self._forgetting(document):
            move = self._store.undo if way == "undo" else self._store.redo
            self._states[document] = move(document, state)

    @contextlib.contextmanager
    def _forgetting(self, document: str) -> Iterator[None]:
        """Read a document anew if another process has changed it."""
        try:
            yield
        except ConflictError:
            self._states.pop(document)
            raise

    async def _tell(self, document: str, but: Tab | None) -> None:
        state = self.state(document)
        for other in [t for t in self._tabs if t.document == document and t is not but]:
            await other.say(self._news(other, state))

    def _news(self, tab: Tab, state: State) -> dict[str, Any]:
        """Return what changed since the tab was told last, and take note that it is told now."""
        known = {id(curve): (curve, drawn) for curve, drawn in zip(tab.curves, tab.views, strict=True)}
        drawn = views.views(state.sketch, known)
        changes = _changes(tab.views, drawn)
        tab.views, tab.curves = drawn, state.sketch.curves
        return {
            "revision": state.number,
            "count": len(drawn),
            "curves": changes,
            "pending": views.pending(state.sketch),
            "degree": state.sketch.degree,
            "spacing": state.sketch.spacing,
            "undo": state.undo,
            "redo": state.redo,
            "case": state.action["case"],
            "reason": state.action["reason"],
            "bound": state.action.get("bound"),
            "curve": state.action.get("curve", -1),
        }


def _changes(old: list[dict[str, Any]], new: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return per curve that changed its index and its patch; curves that moved up because one went are sent whole."""
    changes = []
    for i, drawn in enumerate(new):
        before = old[i] if i < len(old) else None
        if before is not drawn:
            changes.append({"at": i, "whole": before is None, **views.patch(before, drawn)})
    return changes
