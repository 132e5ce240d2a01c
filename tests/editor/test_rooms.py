"""What is drawn before it is on disk: it is not called saved, nobody else gets it, and it is taken back if it fails."""

import asyncio
import contextlib
import json
import signal
import sqlite3

import pytest

import knotwork as kw
from editor.serving import editor
from knotwork.editor.messages import Message
from knotwork.editor.rooms import Rooms
from knotwork.editor.store import ConflictError, Store
from knotwork.errors import FileError
from knotwork.sketch import Sketch, append_vertex

ARCH = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
ACTION = {"case": "put", "reason": "", "key": None}


class Tab:
    """A tab, what it was told, and the points that it draws of the first curve."""

    def __init__(self, rooms):
        self.rooms, self.said, self.points = rooms, [], []
        self.tab = rooms.enter(self.say)

    async def say(self, message):
        await asyncio.sleep(0)  # as a line that others may use meanwhile
        self.take(json.loads(json.dumps(message)))

    def take(self, message):
        self.said.append(message)
        for change in message.get("curves", []):
            if "points" in change:
                at, drop, put = (change["points"][name] for name in ("at", "drop", "put"))
                end = len(self.points) if drop is None else at + drop
                self.points = self.points[:at] + put + self.points[end:]

    async def hear(self, **message):
        answer = await self.rooms.hear(self.tab, Message(message))
        self.take(json.loads(json.dumps(answer)))
        return answer

    def put(self, x, **more):
        return self.hear(do="put", curve=0, point=[x, 0], **more)


@pytest.fixture
def store(tmp_path):
    with contextlib.closing(Store(tmp_path / "drawings.sqlite3")) as made:
        yield made


@pytest.fixture
def document(store):
    return store.create("arch", Sketch((ARCH,), begun=frozenset({0})))


def conversation(talk, *arguments):
    asyncio.run(talk(*arguments))


def failing(store, monkeypatch, *, at, error):
    """Have one statement of the next transaction fail, before SQLite sees it."""
    real = store._db

    class Line:
        def execute(self, statement, *values):
            if statement.startswith(at):
                store._db = real
                raise error
            return real.execute(statement, *values)

        def __getattr__(self, name):
            return getattr(real, name)

    store._db = Line()


def test_the_picture_comes_first_then_the_commit_then_the_acknowledgement_then_the_others(store, document, monkeypatch):
    async def talk():
        rooms = Rooms(store)
        one, two = Tab(rooms), Tab(rooms)
        for tab in (one, two):
            await tab.hear(open=document)
        at_commit, real = [], store.commit

        def commit(*arguments):
            at_commit.append((len(one.said), len(two.said), store.state(document).number))
            return real(*arguments)

        monkeypatch.setattr(store, "commit", commit)
        answer = await one.put(5, id=7)
        assert at_commit == [(2, 1, 0)]  # one has the picture, two nothing, the disk nothing
        picture = one.said[1]
        assert (picture["picture"], picture["revision"]) == (7, 0)
        assert (answer["revision"], answer["curves"], "picture" in answer) == (1, [], False)
        assert [said["revision"] for said in two.said] == [0, 1]
        assert one.points == two.points == [*ARCH.points.tolist(), [5, 0]]
        assert not any("picture" in said for said in two.said)

    conversation(talk)


@pytest.mark.parametrize("at", ["BEGIN", "INSERT INTO curves", "INSERT INTO revisions", "UPDATE", "COMMIT"])
def test_what_cannot_be_committed_is_taken_back_and_the_work_goes_on(store, document, monkeypatch, at):
    async def talk():
        rooms = Rooms(store)
        one, two = Tab(rooms), Tab(rooms)
        for tab in (one, two):
            await tab.hear(open=document)
        await one.put(5)
        before = one.points
        failing(store, monkeypatch, at=at, error=sqlite3.OperationalError("disk I/O error"))
        with pytest.raises(FileError, match="could not be saved: disk I/O error"):
            await one.put(6)
        picture, back = one.said[-2:]
        assert "picture" in picture
        assert "picture" not in back
        assert back["revision"] == 1
        assert one.points == two.points == before
        assert [said["revision"] for said in two.said] == [0, 1]
        await one.put(7)
        assert one.points == two.points == [*before, [7, 0]]
        assert store.state(document).sketch.curves[0].points.tolist() == one.points

    conversation(talk)


def test_a_full_disk_is_said_and_nothing_of_the_stroke_is_kept(store, document):
    async def talk():
        tab = Tab(Rooms(store))
        await tab.hear(open=document)
        pages = store._db.execute("PRAGMA page_count").fetchone()[0]
        store._db.execute(f"PRAGMA max_page_count = {pages}")
        before, said = tab.points, None
        for x in range(5, 1000):
            try:
                await tab.put(x)
            except FileError as error:  # the last page is full
                said = str(error)
                break
            before = tab.points
        assert said == "the change could not be saved: database or disk is full"
        assert tab.points == before == store.state(document).sketch.curves[0].points.tolist()
        store._db.execute("PRAGMA max_page_count = 1000000")
        await tab.put(x)
        assert len(tab.points) == x

    conversation(talk)


def test_a_picture_that_another_process_has_overtaken_gives_way_to_what_is_on_disk(store, document):
    async def talk():
        tab = Tab(Rooms(store))
        await tab.hear(open=document)
        with contextlib.closing(Store(store.path)) as other:
            state = other.state(document)
            other.commit(document, state, append_vertex(state.sketch, 0, [9, 9]), ACTION)
        with pytest.raises(ConflictError, match="changed elsewhere"):
            await tab.put(5)
        assert "picture" in tab.said[-2]
        assert tab.said[-1]["revision"] == 1
        assert tab.points[-1] == [9, 9]
        await tab.put(5)
        assert tab.points[-2:] == [[9, 9], [5, 0]]

    conversation(talk)


def test_strokes_of_two_tabs_at_once_come_one_after_the_other(store, document):
    async def talk():
        rooms = Rooms(store)
        one, two = Tab(rooms), Tab(rooms)
        for tab in (one, two):
            await tab.hear(open=document)
        await asyncio.gather(*(tab.put(5 + i) for i, tab in enumerate([one, two, one, two])))
        assert one.points == two.points == store.state(document).sketch.curves[0].points.tolist()
        assert sorted(one.points[4:]) == [[5 + i, 0] for i in range(4)]
        for tab in (one, two):
            assert [said["revision"] for said in tab.said if "picture" not in said] == [0, 1, 2, 3, 4]

    conversation(talk)


HANGING = """
import contextlib, threading
from knotwork.editor.store import Store
transaction = Store._transaction
@contextlib.contextmanager
def hanging(self):
    with transaction(self):
        yield
        if self._db.execute("SELECT MAX(number) FROM revisions").fetchone()[0] == 3:
            threading.Event().wait()
Store._transaction = hanging
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no kill -9 here")
def test_kill_9_between_picture_and_acknowledgement_leaves_what_was_acknowledged(tmp_path):
    pytest.importorskip("uvicorn", reason="the editor is not installed")
    pytest.importorskip("websockets", reason="the editor is not installed")
    from editor.test_server import Page

    path = tmp_path / "drawings.sqlite3"
    with editor(path, before=HANGING) as first, Page(first) as page:
        for x in range(2):
            assert page.ask(do="put", curve=0, point=[x, 0])["revision"] == x + 1
        page.socket.send(json.dumps({"id": 99, "do": "put", "curve": 0, "point": [2, 0], "key": "third"}))
        picture = page.hear()
        assert (picture["picture"], picture["revision"]) == (99, 2)  # the server writes the third, and waits
        first.kill()
    with editor(path, first.port) as second, Page(second, page.document) as again:
        assert again.opened["revision"] == 2
        assert again.opened["curves"][0]["points"]["put"] == [[0, 0], [1, 0]]
        assert again.ask(do="put", curve=0, point=[2, 0], key="third")["revision"] == 3
