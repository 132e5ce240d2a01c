"""The store of drawings: nothing that was acknowledged is lost, nothing damaged is overwritten."""

import json
import signal
import subprocess
import sys

import numpy as np
import pytest

import knotwork as kw
from knotwork.editor.store import ConflictError, Store
from knotwork.errors import FileError, KnotworkError
from knotwork.sketch import Sketch, append_vertex, stroke

ARCH = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
ACTION = {"case": "put", "reason": "A vertex was put at the end.", "key": None}


@pytest.fixture
def store(tmp_path):
    made = Store(tmp_path / "deep" / "drawings.sqlite3")
    yield made
    made.close()


def put(store, document, point, key=None):
    before = store.state(document)
    return store.commit(document, before, append_vertex(before.sketch, 0, point), {**ACTION, "key": key})


def test_a_drawing_comes_back_to_the_last_bit(store):
    space = kw.SplineSpace(2, [0, 0.1, 0.3, 1 / 3, 1], periodic=True)
    closed = kw.Spline(space, np.random.default_rng(1).random((4, 2)))
    sketch = Sketch((ARCH, closed), degree=5, spacing="chord", begun=frozenset({0}))
    document = store.create("two", sketch)
    again = Store(store.path)
    assert again.state(document).sketch == sketch
    again.close()


def test_a_pending_region_comes_back(store):
    flat = kw.curve([[0, 0], [2, 0], [4, 0], [5, 3], [6, 0], [10, 0]])
    pending = stroke(Sketch((flat,)), [[2.5, 1], [4.5, -1]]).sketch
    assert pending.pending is not None
    document = store.create("pending", pending)
    kept = store.state(document).sketch.pending
    assert kept.chain.tolist() == pending.pending.chain.tolist()
    assert kept.curve == pending.pending.curve


def test_a_commit_keeps_the_rows_of_curves_that_stay(store):
    document = store.create("two", Sketch((ARCH, ARCH.transform([[2, 0], [0, 2]]))))
    before = store.state(document)
    after = put(store, document, [9, 9])
    assert (after.number, after.undo, after.redo) == (1, True, False)
    assert after.rows[1] == before.rows[1]
    assert after.rows[0] != before.rows[0]
    assert store.state(document).action["reason"] == ACTION["reason"]


def test_undo_and_redo_go_along_the_tree_of_revisions(store):
    document = store.create("a", Sketch((ARCH,)))
    for x in (5, 6, 7):
        put(store, document, [x, 0])
    for count in (6, 5, 4):
        state = store.undo(document, store.state(document))
        assert len(state.sketch.curves[0].points) == count
    assert (state.undo, state.redo) == (False, True)
    with pytest.raises(KnotworkError, match="nothing to undo"):
        store.undo(document, state)
    assert len(store.redo(document, state).sketch.curves[0].points) == 5
    put(store, document, [50, 0])  # a new branch: redo follows the younger one from here on
    store.undo(document, store.state(document))
    redone = store.redo(document, store.state(document))
    assert redone.sketch.curves[0].points[-1].tolist() == [50, 0]
    with pytest.raises(KnotworkError, match="nothing to redo"):
        store.redo(document, redone)


def test_who_comes_second_is_told(store):
    document = store.create("a", Sketch((ARCH,)))
    old = store.state(document)
    put(store, document, [5, 0])
    for late in (lambda: store.commit(document, old, old.sketch, ACTION), lambda: store.redo(document, old)):
        with pytest.raises(ConflictError, match="changed elsewhere"):
            late()
    assert len(store.state(document).sketch.curves[0].points) == 5


def test_a_message_is_known_again_by_its_key(store):
    document = store.create("a", Sketch((ARCH,)))
    put(store, document, [5, 0], key="page-1")
    put(store, document, [6, 0], key="page-2")
    assert store.has(document, "page-1")
    assert not store.has(document, "page-3")


def test_documents_are_listed_renamed_duplicated_deleted_and_restored(store):
    first, second = store.create("first", Sketch((ARCH,))), store.create("second")
    put(store, first, [5, 0])
    copy = store.duplicate(first, "copy")
    store.rename(second, "other")
    assert {(d.name, d.curves) for d in store.documents()} == {("first", 1), ("other", 0), ("copy", 1)}
    put(store, first, [6, 0])
    assert len(store.state(copy).sketch.curves[0].points) == 5
    store.delete(first)
    assert {d.id for d in store.documents()} == {second, copy}
    assert [d.id for d in store.documents(deleted=True)] == [first]
    store.delete(first, False)
    assert len(store.state(first).sketch.curves[0].points) == 6
    assert store.undo(first, store.state(first)).number == 1
    for missing in (lambda: store.rename("nobody", "x"), lambda: store.delete("nobody"), lambda: store.state("nobody")):
        with pytest.raises(KnotworkError, match="no such document"):
            missing()


WRITER = """
import sys
from pathlib import Path
import knotwork as kw
from knotwork.editor.store import Store
from knotwork.sketch import Sketch, append_vertex
store = Store(Path(sys.argv[1]))
document = store.create("killed", Sketch((kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]]),), begun=frozenset({0})))
print(document, flush=True)
state = store.state(document)
while True:
    sketch = append_vertex(state.sketch, 0, [5 + state.number, 0])
    state = store.commit(document, state, sketch, {"case": "put", "reason": ""})
    print(state.number, flush=True)
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no kill -9 here")
def test_what_was_acknowledged_survives_kill_9(tmp_path):
    path = tmp_path / "drawings.sqlite3"
    with subprocess.Popen([sys.executable, "-c", WRITER, str(path)], stdout=subprocess.PIPE, text=True) as child:
        try:
            document = child.stdout.readline().strip()
            told = [int(child.stdout.readline()) for _ in range(25)]
        finally:
            child.kill()
        told += [int(line) for line in child.stdout.read().split("\n")[:-1]]
    assert child.returncode == -signal.SIGKILL
    store = Store(path)
    assert store.damaged is None
    state = store.state(document)
    assert state.number >= told[-1] >= 25
    while True:  # every one of them, back to the first
        points = state.sketch.curves[0].points
        assert len(points) == 4 + state.number
        assert points[4:].tolist() == [[5 + i, 0] for i in range(state.number)]
        if not state.undo:
            break
        state = store.undo(document, state)
    store.close()


def test_a_damaged_file_is_kept_aside_and_a_new_one_begun(tmp_path):
    path = tmp_path / "drawings.sqlite3"
    path.write_bytes(b"not a database at all " * 500)
    store = Store(path)
    assert store.damaged is not None
    assert store.damaged.read_bytes().startswith(b"not a database")
    assert store.documents() == []
    document = store.create("new", Sketch((ARCH,)))
    store.close()
    again = Store(path)
    assert again.damaged is None
    assert again.state(document).sketch.curves == (ARCH,)
    again.close()


def test_a_file_damaged_in_the_middle_is_noticed(tmp_path):
    path = tmp_path / "drawings.sqlite3"
    store = Store(path)
    document = store.create("a", Sketch((ARCH,), begun=frozenset({0})))
    for x in range(60):
        put(store, document, [5 + x, 0])
    store.close()
    data = bytearray(path.read_bytes())
    assert len(data) > 3 * 4096
    data[4096 : 2 * 4096] = b"\xa5" * 4096
    path.write_bytes(data)
    store = Store(path)
    assert store.damaged is not None
    assert store.damaged.read_bytes() == bytes(data)
    store.close()


def test_a_path_that_cannot_be_opened_is_said_and_left_where_it_is(tmp_path):
    folder = tmp_path / "drawings.sqlite3"
    folder.mkdir()
    (folder / "mine.txt").write_text("keep")
    with pytest.raises(FileError, match=r"drawings\.sqlite3"):
        Store(folder)
    assert (folder / "mine.txt").read_text() == "keep"


def test_settings_are_data_that_json_can_tell(store):
    document = store.create("a", Sketch((ARCH,), degree=4))
    state = store.state(document)
    assert json.loads(json.dumps(state.action)) == {"case": "begun", "reason": ""}
    assert state.sketch.degree == 4
