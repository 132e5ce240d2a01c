"""Where drawings are kept: one SQLite file in which nothing is ever overwritten.

Each state of a document is a revision: the order of its curves, and settings. Curves are rows of their own that later
revisions share, so a stroke writes one curve and a line. Undo goes to the parent of a revision, redo to its youngest
child. A revision is committed (write-ahead log, synchronised to disk) before anybody hears that it is saved.
"""

from __future__ import annotations

import contextlib
import json
import secrets
import sqlite3
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from knotwork.errors import FileError, KnotworkError
from knotwork.sketch import Sketch
from knotwork.sketch.regions import Pending
from knotwork.space import SplineSpace
from knotwork.spline import Spline

SCHEMA = """
CREATE TABLE IF NOT EXISTS curves(
  id INTEGER PRIMARY KEY, degree INTEGER NOT NULL, periodic INTEGER NOT NULL,
  knots BLOB NOT NULL, points BLOB NOT NULL);
CREATE TABLE IF NOT EXISTS documents(
  id TEXT PRIMARY KEY, name TEXT NOT NULL, made REAL NOT NULL, changed REAL NOT NULL, head INTEGER NOT NULL,
  deleted INTEGER NOT NULL DEFAULT 0);
CREATE TABLE IF NOT EXISTS revisions(
  document TEXT NOT NULL, number INTEGER NOT NULL, parent INTEGER, curves TEXT NOT NULL, settings TEXT NOT NULL,
  action TEXT NOT NULL, made REAL NOT NULL, PRIMARY KEY(document, number));
PRAGMA user_version = 1;
"""


#: revisions in which a message that is said again is looked for: more than a page holds back while the line is down
REMEMBERED = 200


class Document(NamedTuple):
    """A line of the list of documents."""

    #: a name nobody can guess
    id: str
    #: what the person calls it
    name: str
    #: seconds since 1970
    changed: float
    #: how many curves it holds
    curves: int


class State(NamedTuple):
    """A document at one revision."""

    #: the revision; it grows with every change, undo included
    number: int
    sketch: Sketch
    #: the rows of its curves
    rows: tuple[int, ...]
    #: what made this revision: the rule or command, and its sentence
    action: dict[str, Any]
    #: whether there is something to undo, and to redo
    undo: bool
    redo: bool


class ConflictError(KnotworkError):
    """Somebody else changed the document in the meantime."""


class Store:
    """The documents in one file. Not for use by several threads at once.

    Parameters
    ----------
    path : Path
        The file; it is made if it is not there. One that is damaged is kept beside it under another name, and `damaged`
        tells where.

    Raises
    ------
    FileError
        If the file cannot be made or opened.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.damaged: Path | None = None
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            self._db = _opened(path)
        except sqlite3.OperationalError as exc:  # in use, not to be read, a full disk: the file may be sound
            raise FileError(f"{path}: {exc}") from exc
        except sqlite3.DatabaseError:
            self.damaged = _set_aside(path)
            self._db = _opened(path)

    def close(self) -> None:
        """Close the file."""
        self._db.close()

    # ---- documents ----------------------------------------------------------------------------------------------

    def documents(self, *, deleted: bool = False) -> list[Document]:
        """Return the documents, the one changed last first."""
        rows = self._db.execute(
            "SELECT d.id, d.name, d.changed, r.curves FROM documents d JOIN revisions r "
            "ON r.document = d.id AND r.number = d.head WHERE d.deleted = ? ORDER BY d.changed DESC",
            (int(deleted),),
        )
        return [Document(id, name, changed, len(json.loads(curves))) for id, name, changed, curves in rows]

    def create(self, name: str, sketch: Sketch | None = None) -> str:
        """Begin a document, and return its id."""
        document, now = secrets.token_urlsafe(9), time.time()
        with self._transaction():
            rows = [self._keep(curve) for curve in (sketch or Sketch()).curves]
            self._db.execute("INSERT INTO documents VALUES(?, ?, ?, ?, 0, 0)", (document, name, now, now))
            self._insert(document, 0, None, rows, sketch or Sketch(), {"case": "begun", "reason": ""})
        return document

    def rename(self, document: str, name: str) -> None:
        """Give a document another name."""
        with self._transaction():
            self._update(document, "name = ?", name)

    def delete(self, document: str, deleted: bool = True) -> None:
        """Take a document off the list, or put it back; nothing of it is lost."""
        with self._transaction():
            self._update(document, "deleted = ?", int(deleted))

    def duplicate(self, document: str, name: str) -> str:
        """Begin a document that holds the same curves, and return its id."""
        return self.create(name, self.state(document).sketch)

    # ---- revisions ----------------------------------------------------------------------------------------------

    def state(self, document: str) -> State:
        """Return a document as it is now."""
        found = self._db.execute("SELECT head FROM documents WHERE id = ?", (document,)).fetchone()
        if found is None:
            raise KnotworkError("there is no such document")
        return self._state(document, found[0])

    def commit(self, document: str, before: State, sketch: Sketch, action: dict[str, Any]) -> State:
        """Add a revision after `before`, and return it; on disk when this returns.

        Raises
        ------
        ConflictError
            If the document has moved on from `before`.
        FileError
            If it cannot be written: a full disk, say. The document then stays as it was.
        """
        old = {id(curve): row for curve, row in zip(before.sketch.curves, before.rows, strict=True)}
        with self._transaction():
            self._require_head(document, before.number)
            number = self._next(document)
            rows = [old[id(c)] if id(c) in old else self._keep(c) for c in sketch.curves]
            self._insert(document, number, before.number, rows, sketch, action)
            self._db.execute("UPDATE documents SET head = ?, changed = ? WHERE id = ?", (number, time.time(), document))
        return State(number, sketch, tuple(rows), action, True, False)

    def has(self, document: str, key: str) -> bool:
        """Tell whether one of the last revisions was made by the message of this key."""
        found = self._db.execute(
            "SELECT 1 FROM revisions WHERE document = ?1 AND number > "
            "(SELECT MAX(number) FROM revisions WHERE document = ?1) - ?2 AND json_extract(action, '$.key') = ?3",
            (document, REMEMBERED, key),
        )
        return found.fetchone() is not None

    def undo(self, document: str, before: State) -> State:
        """Go back to the revision that this one was made from."""
        parent = self._db.execute(
            "SELECT parent FROM revisions WHERE document = ? AND number = ?", (document, before.number)
        ).fetchone()[0]
        if parent is None:
            raise KnotworkError("there is nothing to undo")
        return self._move(document, before, parent)

    def redo(self, document: str, before: State) -> State:
        """Go on to the revision that was made from this one last."""
        child = self._child(document, before.number)
        if child is None:
            raise KnotworkError("there is nothing to redo")
        return self._move(document, before, child)

    # ---- inside -------------------------------------------------------------------------------------------------

    @contextlib.contextmanager
    def _transaction(self) -> Iterator[None]:
        """All of it, or nothing: the write lock is taken at once."""
        try:
            self._db.execute("BEGIN IMMEDIATE")
            yield
            self._db.execute("COMMIT")
        except BaseException as exc:
            if self._db.in_transaction:  # a commit that fails may leave it open
                self._db.execute("ROLLBACK")
            if isinstance(exc, sqlite3.Error):
                raise FileError(f"the change could not be saved: {exc}") from exc
            raise

    def _update(self, document: str, change: str, value: Any) -> None:
        done = self._db.execute(f"UPDATE documents SET {change} WHERE id = ?", (value, document))
        if not done.rowcount:
            raise KnotworkError("there is no such document")

    def _require_head(self, document: str, number: int) -> None:
        head = self._db.execute("SELECT head FROM documents WHERE id = ?", (document,)).fetchone()
        if head is None:
            raise KnotworkError("there is no such document")
        if head[0] != number:
            raise ConflictError("the drawing was changed elsewhere in the meantime")

    def _next(self, document: str) -> int:
        last: int = self._db.execute("SELECT MAX(number) FROM revisions WHERE document = ?", (document,)).fetchone()[0]
        return last + 1

    def _child(self, document: str, number: int) -> int | None:
        found: int | None = self._db.execute(
            "SELECT MAX(number) FROM revisions WHERE document = ? AND parent = ?", (document, number)
        ).fetchone()[0]
        return found

    def _move(self, document: str, before: State, number: int) -> State:
        with self._transaction():
            self._require_head(document, before.number)
            self._db.execute("UPDATE documents SET head = ?, changed = ? WHERE id = ?", (number, time.time(), document))
        return self._state(document, number)

    def _keep(self, curve: Spline) -> int:
        space = curve.space
        row = (space.degree, int(space.periodic), _bytes(space.knots), _bytes(curve.points))
        done = self._db.execute("INSERT INTO curves(degree, periodic, knots, points) VALUES(?, ?, ?, ?)", row)
        assert done.lastrowid is not None
        return done.lastrowid

    def _insert(
        self,
        document: str,
        number: int,
        parent: int | None,
        rows: Sequence[int],
        sketch: Sketch,
        action: dict[str, Any],
    ) -> None:
        settings = {
            "degree": sketch.degree,
            "spacing": sketch.spacing,
            "begun": sorted(sketch.begun),
            "pending": None if sketch.pending is None else _pending_as_data(sketch.pending),
        }
        values = (
            document,
            number,
            parent,
            json.dumps(list(rows)),
            json.dumps(settings),
            json.dumps(action),
            time.time(),
        )
        self._db.execute("INSERT INTO revisions VALUES(?, ?, ?, ?, ?, ?, ?)", values)

    def _state(self, document: str, number: int) -> State:
        parent, curves, settings, action = self._db.execute(
            "SELECT parent, curves, settings, action FROM revisions WHERE document = ? AND number = ?",
            (document, number),
        ).fetchone()
        rows = tuple(json.loads(curves))
        told = json.loads(settings)
        pending = None if told["pending"] is None else _pending_from_data(told["pending"])
        drawn = tuple(self._curve(row) for row in rows)
        sketch = Sketch(drawn, told["degree"], told["spacing"], frozenset(told["begun"]), pending)
        redo = self._child(document, number) is not None
        return State(number, sketch, rows, json.loads(action), parent is not None, redo)

    def _curve(self, row: int) -> Spline:
        degree, periodic, knots, points = self._db.execute(
            "SELECT degree, periodic, knots, points FROM curves WHERE id = ?", (row,)
        ).fetchone()
        space = SplineSpace(degree, np.frombuffer(knots), periodic=bool(periodic))
        return Spline(space, np.frombuffer(points).reshape(-1, 2))


def _opened(path: Path) -> sqlite3.Connection:
    """Return a connection to a sound file, made if need be."""
    db = sqlite3.connect(path, isolation_level=None, timeout=10, check_same_thread=False)
    try:
        (verdict,) = db.execute("PRAGMA quick_check(1)").fetchone()
        if verdict != "ok":
            raise sqlite3.DatabaseError(verdict)
        db.execute("PRAGMA journal_mode = WAL")
        db.execute("PRAGMA synchronous = FULL")
        db.executescript(SCHEMA)
    except BaseException:
        db.close()
        raise
    return db


def _set_aside(path: Path) -> Path:
    """Rename a damaged file and what belongs to it, and return its new name."""
    aside = path.with_name(f"{path.name}.damaged-{time.strftime('%Y%m%d-%H%M%S')}-{secrets.token_hex(2)}")
    for suffix in ("", "-wal", "-shm"):
        part = path.with_name(path.name + suffix)
        if part.exists():
            part.rename(aside.with_name(aside.name + suffix))
    return aside


def _bytes(values: Any) -> bytes:
    return np.ascontiguousarray(values, np.float64).tobytes()


def _pending_as_data(pending: Pending) -> list[Any]:
    return [x.tolist() if isinstance(x, np.ndarray) else x for x in pending]


def _pending_from_data(values: list[Any]) -> Pending:
    named = Pending(*values)
    return named._replace(chain=np.array(named.chain, np.float64))
