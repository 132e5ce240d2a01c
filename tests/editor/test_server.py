"""The server: it lets nobody else in, says what is wrong with a message, and goes on."""

import json
import os
import urllib.error
import urllib.request
from contextlib import ExitStack

import numpy as np
import pytest

import knotwork as kw

pytest.importorskip("starlette", reason="the editor is not installed")
pytest.importorskip("uvicorn", reason="the editor is not installed")
pytest.importorskip("websockets", reason="the editor is not installed")

from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from editor.serving import editor
from knotwork.editor import exchange
from knotwork.editor.server import MESSAGE

ARCH = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    with editor(tmp_path_factory.mktemp("store") / "drawings.sqlite3") as running:
        yield running


class Page:
    """A tab of a browser, without the browser."""

    def __init__(self, served, document=None):
        url, origin = f"ws://127.0.0.1:{served.port}/socket?token={served.token}", f"http://127.0.0.1:{served.port}"
        self.line = ExitStack()
        self.socket = self.line.enter_context(connect(url, origin=origin, max_size=None))
        self.number = 0
        self.hello = self.hear()
        self.document = document or self.ask(documents="new", name="test")["made"]
        self.opened = self.ask(open=self.document)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.line.close()

    def hear(self):
        return json.loads(self.socket.recv(timeout=30))

    def raw(self, text):
        self.socket.send(text)
        return self.hear()

    def ask(self, **message):
        """Say something, and return the answer; what the server says on its own is passed over."""
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, **message}))
        while (heard := self.hear()).get("id") != self.number:
            pass
        return heard


def fetched(served, path, *, data=None, headers=None):
    """Return the status, the headers and the body of a request."""
    request = urllib.request.Request(f"http://127.0.0.1:{served.port}{path}", data, headers or {})
    try:
        with urllib.request.urlopen(request, timeout=30) as answer:
            return answer.status, answer.headers, answer.read()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.headers, error.read()


def brought(served, document, name, data):
    status, _, body = fetched(served, f"/import/{document}?token={served.token}&name={name}", data=data)
    return status, json.loads(body)


def as_json(tmp_path, *curves):
    kw.write(tmp_path / "curves.json", list(curves))
    return (tmp_path / "curves.json").read_bytes()


# ---- who gets in ---------------------------------------------------------------------------------------------------


def test_the_page_comes_with_its_token_and_a_strict_policy(served):
    status, headers, body = fetched(served, f"/?token={served.token}")
    assert status == 200
    assert b"<title>Knotwork</title>" in body
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "no-referrer"


@pytest.mark.parametrize("path", ["/", "/?token=wrong", "/export/x/svg?token=wrong", "/export/x/svg"])
def test_without_the_token_nobody_gets_in(served, path):
    assert fetched(served, path)[0] == 403


@pytest.mark.parametrize("headers", [{"Host": "evil.example"}, {"Origin": "http://evil.example"}, {"Origin": "null"}])
def test_another_host_or_origin_is_refused_even_with_the_token(served, headers):
    assert fetched(served, f"/?token={served.token}", headers=headers)[0] == 403
    assert fetched(served, "/static/main.js", headers=headers)[0] == 403


@pytest.mark.parametrize(
    ("token", "origin"),
    [
        ("wrong", "http://127.0.0.1:{port}"),
        (None, "http://evil.example"),
        (None, None),
        (None, "https://127.0.0.1:{port}"),
    ],
)
def test_a_socket_needs_the_token_and_the_origin_of_the_page(served, token, origin):
    url = f"ws://127.0.0.1:{served.port}/socket?token={token or served.token}"
    with (
        pytest.raises(InvalidStatus, match="403"),
        connect(url, origin=origin and origin.format(port=served.port)),
    ):
        pass


def test_no_path_leads_out_of_the_static_files(served):
    for path in ("/static/../server.py", "/static/%2e%2e/server.py", "/static/..%2fserver.py", "/static//etc/passwd"):
        assert fetched(served, path)[0] == 404


# ---- messages ------------------------------------------------------------------------------------------------------

BAD = [
    ("{", "not JSON"),
    ("[" * 100_000, "not JSON"),
    ('{"do": NaN}', "not JSON"),
    ("[1, 2]", "must be an object"),
    ('"do"', "must be an object"),
    ("{}", "do must be one of"),
    ('{"do": "format the disk"}', "do must be one of"),
    ('{"do": ["stroke"]}', "do must be one of"),
    ('{"do": {"a": 1}}', "do must be one of"),
    ('{"do": "stroke"}', "path must be"),
    ('{"do": "stroke", "path": [[0, 0], [1]]}', "path must be"),
    ('{"do": "stroke", "path": [[0, 0], [1, "2"]]}', "path must be"),
    ('{"do": "stroke", "path": [[0, 0], [1, 1e999]]}', "path must be"),
    ('{"do": "stroke", "path": [[0, 0], [1, 1]], "reach": -1}', "reach"),
    ('{"do": "stroke", "path": [[0, 0], [1, 1]], "pressure": [1]}', "one number per point"),
    ('{"do": "drag", "curve": 7, "vertices": [0], "by": [1, 1]}', "curve must be a whole number from 0 to 0"),
    ('{"do": "drag", "curve": 0, "vertices": [true], "by": [1, 1]}', "vertices must be whole numbers"),
    ('{"do": "drag", "curve": 0, "vertices": [99], "by": [1, 1]}', "vertices must be whole numbers"),
    ('{"do": "drag", "curve": 0, "vertices": [0], "by": [1]}', "by must be two finite numbers"),
    ('{"do": "degree", "curve": 0, "degree": 1000000}', "degree must be a whole number from 1 to 9"),
    ('{"do": "insert knot", "curve": 0, "u": 5}', ""),
    ('{"do": "trim", "curve": 0, "region": [1]}', "region must be two finite numbers"),
    ('{"do": "balance", "curve": 0, "region": [1, 2, 3]}', "region must be two finite numbers"),
    ('{"do": "reduce", "curve": 0, "tolerance": -1}', "tolerance"),
    ('{"do": "reduce", "curve": 0, "tolerance": 0.1, "region": [0]}', "region must be two finite numbers"),
    ('{"ask": "everything", "curve": 0}', "ask must be one of"),
    ('{"ask": "triangle", "curve": 0}', ""),
    ('{"open": "nobody"}', "no such document"),
    ('{"open": 7}', "open must be a text"),
    ('{"documents": "burn"}', "documents must be one of"),
    ('{"documents": "rename", "document": "nobody", "name": "x"}', "no such document"),
]


@pytest.mark.parametrize(("text", "error"), BAD)
def test_a_bad_message_gets_an_error_and_the_work_goes_on(served, text, error):
    with Page(served) as page:
        page.ask(do="put", curve=0, point=[0, 0])
        page.ask(do="put", curve=0, point=[1, 2])
        said = page.raw(text)
        assert error in said["error"]
        assert "Knotwork itself" not in said["error"]
        assert page.ask(do="put", curve=0, point=[3, 2])["revision"] == 3


def test_a_message_that_is_too_large_gets_an_error(served):
    with Page(served) as page:
        said = page.raw(json.dumps({"do": "x" * MESSAGE}))
        assert "at most 4,000,000" in said["error"]
        assert page.ask(do="put", curve=0, point=[0, 0])["revision"] == 1


def test_too_many_messages_at_once_are_left_out_and_the_work_goes_on(served):
    with Page(served) as page:
        for _ in range(2000):
            page.socket.send('{"id": 1, "documents": "list"}')
        heard = [page.hear() for _ in range(2000)]
        assert any("too many messages" in said.get("error", "") for said in heard)
        assert sum("documents" in said for said in heard) >= 500


# ---- drawings ------------------------------------------------------------------------------------------------------


def test_two_tabs_stay_equal(served):
    with Page(served) as one, Page(served, one.document) as two:
        one.ask(do="stroke", path=[[0, 0], [100, 0]])
        heard = two.hear()
        assert (heard["revision"], heard["count"]) == (1, 1)
        two.ask(do="put", curve=0, point=[150, 50])
        assert one.hear()["revision"] == 2
        late = one.ask(do="drag", curve=0, vertices=[0], by=[1, 1], **{"based on": 1})
        assert "changed elsewhere" in late["error"]
        two.ask(do="undo")
        assert one.hear()["revision"] == 1
        again = one.ask(open=one.document)
        assert again["curves"] == two.ask(open=one.document)["curves"]


def test_a_message_said_again_is_done_once(served):
    with Page(served) as page:
        first = page.ask(do="put", curve=0, point=[0, 0], key="page-1")
        assert first["revision"] == 1
        assert page.ask(do="put", curve=0, point=[0, 0], key="page-1")["revision"] == 1
        with Page(served, page.document) as other:
            assert other.ask(do="put", curve=0, point=[0, 0], key="page-1")["revision"] == 1
        assert page.ask(do="put", curve=0, point=[0, 1], key="page-2")["revision"] == 2


def test_undo_and_redo_that_are_said_again_are_done_once(served):
    with Page(served) as page:
        for i in range(3):
            page.ask(do="put", curve=0, point=[i, 0])
        undo = {"do": "undo", "based on": 3}
        assert page.ask(**undo)["revision"] == 2
        assert "changed elsewhere" in page.ask(**undo)["error"]
        assert page.ask(open=page.document)["revision"] == 2
        assert page.ask(do="redo", **{"based on": 2})["revision"] == 3


def test_the_address_is_that_of_the_last_time_and_only_its_owner_reads_it(tmp_path):
    store = tmp_path / "drawings.sqlite3"
    with editor(store) as first:
        pass
    with editor(store) as second:
        assert second.url == first.url
        with editor(store) as beside:
            assert beside.port != second.port
    kept = store.with_name("drawings.sqlite3.address")
    if os.name == "posix":
        assert kept.stat().st_mode & 0o777 == 0o600
    kept.write_text("[1, ")
    with editor(store) as third:
        assert third.token != first.token


def test_what_was_acknowledged_is_there_after_kill_9(tmp_path):
    store = tmp_path / "drawings.sqlite3"
    with editor(store) as first, Page(first) as page:
        for x in range(20):
            told = page.ask(do="put", curve=0, point=[x, x * x])
        first.kill()
    with editor(store, first.port) as second, Page(second, page.document) as again:
        assert second.port == first.port
        assert again.opened["revision"] == told["revision"] == 20
        assert again.ask(do="undo")["revision"] == 19


def test_a_drawing_goes_out_and_comes_back(served, tmp_path):
    with Page(served) as page:
        status, told = brought(served, page.document, "arch.json", as_json(tmp_path, ARCH))
        assert (status, told["reason"]) == (200, "1 curve came from the JSON file.")
        assert page.hear()["count"] == 1
        for kind in exchange.EXPORTS:
            status, headers, body = fetched(served, f"/export/{page.document}/{kind}?token={served.token}")
            assert status == 200
            assert headers["Content-Disposition"] == f'attachment; filename="drawing.{kind}"'
            if kind == "py":
                continue
            (tmp_path / f"back.{kind}").write_bytes(body)
            (back,) = kw.read(tmp_path / f"back.{kind}")
            if kind in ("json", "npz"):
                assert back == ARCH
            if kind == "svg":
                assert np.allclose(back.points * [1, -1], ARCH.points, rtol=0, atol=1e-12)


def test_the_python_code_rebuilds_the_curve(served, tmp_path):
    with Page(served) as page:
        brought(served, page.document, "arch.json", as_json(tmp_path, ARCH))
        _, _, code = fetched(served, f"/export/{page.document}/py?token={served.token}")
    names = {}
    exec(compile(code, "drawing.py", "exec"), names)
    found = [v for value in names.values() for v in (value if isinstance(value, list | tuple) else [value])]
    assert ARCH in [v for v in found if isinstance(v, kw.Spline)]


@pytest.mark.parametrize(
    ("name", "data", "error"),
    [
        ("..%2F..%2Fetc%2Fpasswd", b"x", "are not taken"),
        ("%2Fetc%2Fpasswd.json%00.exe", b"x", "are not taken"),
        ("curve.json", b"{", ""),
        ("curve.json", b"[" * 200_000, ""),
        ("curve.npz", b"PK\x03\x04 no archive", ""),
        ("curve.svg", b"<svg><path d='M 0", ""),
        ("curve.csv", b"\xff\xfe\x00", ""),
        ("empty.json", b"", ""),
    ],
)
def test_a_file_that_cannot_be_taken_is_named_without_any_path(served, name, data, error):
    with Page(served) as page:
        status, told = brought(served, page.document, name, data)
        assert status == 400
        assert error in told["error"]
        assert "/" not in told["error"].replace(" / ", "")
        assert page.ask(do="put", curve=0, point=[0, 0])["revision"] == 1


def test_names_that_climb_are_only_a_suffix(served, tmp_path):
    with Page(served) as page:
        status, _ = brought(served, page.document, "..%2F..%2F..%2Ftmp%2Fover.json", as_json(tmp_path, ARCH))
        assert status == 200


def test_a_file_that_is_too_large_is_refused(served):
    with Page(served) as page:
        status, told = brought(served, page.document, "big.csv", b"1,2\n" * (exchange.UPLOAD // 4 + 1))
        assert status == 413
        assert "larger than 20,000,000" in told["error"]
