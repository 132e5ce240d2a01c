"""The editor in a real browser: what a hand, a pen, a finger and the keys do, and that nothing is lost."""

import shutil
import time
from contextlib import contextmanager

import numpy as np
import pytest

import knotwork as kw
from editor.serving import editor

for name in ("starlette", "uvicorn", "websockets"):
    pytest.importorskip(name, reason="the editor is not installed")
playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = [
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium"),
    pytest.mark.xdist_group("browser"),
]

KNOTS = [0, 0, 0, 0, 0.3, 0.5, 0.65, 0.7, 0.75, 0.8, 0.9, 1, 1, 1, 1]
POINTS = [[0, 0], [1, 2], [3, 3], [5, 2.5], [7, 1], [9, 1], [10.5, 3], [12, 4], [14, 3.5], [15, 2], [16, 0]]


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as driver:
        started = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    with editor(tmp_path_factory.mktemp("store") / "drawings.sqlite3", warm=True) as running:
        yield running


class Sheet:
    """The page, as a person meets it; and what it holds, to compare."""

    def __init__(self, page, url):
        self.page = page
        self.errors = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.set_default_timeout(12_000)
        page.goto(url)
        self.ready()

    def ready(self):
        self.until("window.app && app.drawing.revision >= 0")

    def until(self, expression, arg=None, seconds=8):
        """Wait until something is true of the page. Its policy forbids Playwright's own way, which is to evaluate."""
        end = time.monotonic() + seconds
        while not self.page.evaluate(expression, arg):
            assert time.monotonic() < end, f"{expression} does not come true: {self.page.inner_text('#said')}"
            self.page.wait_for_timeout(15)

    def begin(self):
        """A new drawing."""
        before = self.page.evaluate("app.documents.current")
        self.page.keyboard.press("Control+o")
        self.page.click("#new")
        self.until("before => app.documents.current !== before && app.drawing.revision === 0", arg=before)
        if self.page.evaluate("document.querySelector('#drawings').open"):
            self.page.keyboard.press("Escape")

    @contextmanager
    def change(self, seconds=60):
        """Wait for the next revision: kernels may be loaded or compiled meanwhile."""
        before = self.revision
        yield
        self.until("before => app.drawing.revision !== before", arg=before, seconds=seconds)

    @property
    def revision(self):
        return self.page.evaluate("app.drawing.revision")

    @property
    def curves(self):
        return self.page.evaluate("app.drawing.curves.map(c => ({degree: c.degree, knots: c.knots, points: c.points}))")

    def draw(self, a, b, steps=8):
        """Draw a straight stroke with the mouse, in pixels of the sheet."""
        self.page.mouse.move(*a)
        self.page.mouse.down()
        for i in range(1, steps + 1):
            self.page.mouse.move(*(np.array(a) + (np.array(b) - a) * i / steps).tolist())
        self.page.mouse.up()

    def at(self, point):
        """Where a point of the plane is on the screen."""
        return self.page.evaluate(
            """p => { const box = app.sheet.getBoundingClientRect(), [x, y] = app.camera.toScreen(p);
            return [x + box.left, y + box.top]; }""",
            point,
        )

    def draw_between(self, *plane):
        with self.change():
            self.draw(*map(self.at, plane))

    def bring(self, curve, folder):
        """Open a file with one curve by the page's own field for files."""
        kw.write(folder / "curve.json", [curve])
        with self.change():
            self.page.set_input_files("#file", folder / "curve.json")
        self.until("app.drawing.curves.length === 1")
        self.page.click("#zoom")


@pytest.fixture
def sheet(browser, served):
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    opened = Sheet(context.new_page(), served.url)
    opened.begin()
    yield opened
    context.close()
    assert opened.errors == []


def test_an_empty_sheet_says_what_to_do_and_a_stroke_is_a_curve(sheet):
    assert sheet.page.is_visible("#hint")
    with sheet.change():
        sheet.draw((300, 500), (450, 300))
    (curve,) = sheet.curves
    assert curve["degree"] == 1
    with sheet.change():
        sheet.draw((405, 330), (620, 280))
    assert [c["degree"] for c in sheet.curves] == [2]
    assert sheet.page.inner_text("#rule") == "Extend"
    assert not sheet.page.is_visible("#hint")


def test_the_session_of_the_book_through_the_page(sheet, tmp_path):
    """§7.6: a vertex brings the knot .675; a corner cut off brings .66667 and .683333 for it."""
    sheet.bring(kw.curve(POINTS, 3, KNOTS), tmp_path)
    sheet.draw_between([7.8, 1.4], [8, 0])
    assert sheet.page.inner_text("#rule") == "Insert"
    assert np.allclose(sheet.curves[0]["knots"][6:9], [0.65, 0.675, 0.7], atol=1e-12)
    sheet.draw_between([7.2, 0.6], [8.8, 0.6])
    assert sheet.page.inner_text("#rule") == "Cut"
    knots = sheet.curves[0]["knots"]
    assert np.allclose(knots[6:10], [0.65, 0.66667, 0.683333, 0.7], atol=5e-6)
    assert [*knots[:7], *knots[9:]] == KNOTS
    shown = sheet.page.eval_on_selector_all("#knotline .knot title", "marks => marks.map(m => m.textContent)")
    assert {"0.666667", "0.683333"} <= set(shown)


def test_undo_redo_and_reload(sheet):
    for a, b in (((300, 500), (450, 300)), ((405, 330), (620, 280)), ((600, 260), (700, 480))):
        with sheet.change():
            sheet.draw(a, b)
    drawn = sheet.curves
    with sheet.change():
        sheet.page.keyboard.press("Control+z")
    assert len(sheet.curves[0]["points"]) == 3
    with sheet.change():
        sheet.page.keyboard.press("Control+Shift+Z")
    assert sheet.curves == drawn
    sheet.page.reload()
    sheet.ready()
    assert sheet.curves == drawn
    for left in (3, 2):
        with sheet.change():
            sheet.page.click("#undo")
        assert len(sheet.curves[0]["points"]) == left


def test_a_drawing_by_keys_alone(sheet):
    press = sheet.page.keyboard.press
    sheet.page.focus("#sheet")
    for _ in range(5):
        with sheet.change():
            press("a")
    before = sheet.curves[0]["points"]
    assert len(before) == 5
    press("Tab")
    press("Tab")
    with sheet.change():
        press("Shift+ArrowUp")
    after = sheet.curves[0]["points"]
    assert after[1][1] > before[1][1]
    assert [after[i] for i in (0, 2, 3, 4)] == [before[i] for i in (0, 2, 3, 4)]
    with sheet.change():
        press("4")
    assert sheet.curves[0]["degree"] == 4
    with sheet.change():
        press("Delete")
    with sheet.change():
        press("c")
    with sheet.change():
        press("Control+z")
    press("?")
    assert sheet.page.is_visible("#keys")
    press("Escape")
    assert not sheet.page.is_visible("#keys")


def test_a_crowded_region_gets_as_many_parameters_as_its_length_asks_for(sheet, tmp_path):
    curve = kw.curve(POINTS, 3, KNOTS)
    sheet.bring(curve, tmp_path)
    sheet.page.evaluate("app.vertices = new Set([4, 7]), app.panel.fill()")  # knots about: .5, .9
    if not sheet.page.is_visible("#balance"):
        sheet.page.click("#panel-toggle")
    with sheet.change():
        sheet.page.click("#balance")
    knots = sheet.curves[0]["knots"]
    sides, nodes = np.hypot(*np.diff(curve.points, axis=0).T), curve.space.nodes
    middle = (nodes[:-1] + nodes[1:]) / 2
    inside = (middle > 0.5) & (middle < 0.9)
    end = 0.6 * sides.sum() / sides[~inside].sum()  # the rest keeps 0.6 parameters
    assert np.isclose(knots[-1], end, rtol=1e-8)
    assert np.allclose(np.diff(knots[5:11]), np.diff(KNOTS[5:11]) * (end - 0.6) / 0.4, rtol=1e-6)
    assert np.allclose(knots[:6], KNOTS[:6], rtol=0, atol=1e-9)


def test_two_fingers_move_the_sheet_and_draw_nothing(browser, served):
    context = browser.new_context(viewport={"width": 820, "height": 1180}, has_touch=True)
    sheet = Sheet(context.new_page(), served.url)
    sheet.begin()
    scale = sheet.page.evaluate("app.camera.scale")
    touch = context.new_cdp_session(sheet.page)
    for kind, spread in (("Start", 50), ("Move", 70), ("Move", 100), ("End", None)):
        fingers = (
            [] if spread is None else [{"x": 400 - spread, "y": 500, "id": 0}, {"x": 400 + spread, "y": 500, "id": 1}]
        )
        touch.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": fingers})
    assert sheet.page.evaluate("app.camera.scale") > 1.5 * scale
    assert sheet.curves == []
    assert sheet.errors == []
    context.close()


@pytest.mark.parametrize("kind", ["JSON", "NPZ", "SVG", "DXF"])
def test_what_is_taken_away_is_read_again(sheet, tmp_path, kind):
    curve = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    sheet.bring(curve, tmp_path)
    if not sheet.page.is_visible("#exports"):
        sheet.page.click("#panel-toggle")
    with sheet.page.expect_download() as taken:
        sheet.page.get_by_role("button", name=kind, exact=True).click()
    target = tmp_path / f"taken.{kind.lower()}"
    taken.value.save_as(target)
    (back,) = kw.read(target)
    flip = [1, -1] if kind == "SVG" else [1, 1]
    assert np.allclose(back.points * flip, curve.points, rtol=0, atol=1e-12)


@pytest.mark.parametrize("vertices", [200, 5_000, pytest.param(100_000, marks=pytest.mark.slow)])
def test_a_long_curve_opens_pans_and_takes_strokes(sheet, tmp_path, record_property, vertices):
    """How long a stroke and a frame take is told at the end of the run."""
    x = np.linspace(0, 1000, vertices)
    points = np.stack([x, 20 * np.sin(x / 40)], axis=1)
    kw.write(tmp_path / "curve.json", [kw.curve(points, 3)])
    with sheet.change(seconds=60):
        sheet.page.set_input_files("#file", tmp_path / "curve.json")
    sheet.until("n => app.drawing.curves[0].points.length === n", arg=vertices)
    frames = sheet.page.evaluate(
        """async () => {
            const times = [];
            for (let k = 0; k < 20; k++) {
                const start = performance.now();
                app.pan(3, 0);
                await new Promise(requestAnimationFrame);
                times.push(performance.now() - start);
            }
            return times;
        }"""
    )
    # strokes of a pen over ten vertices, seen from near
    a, b = points[vertices // 2], points[vertices // 2 + 10]
    sheet.page.evaluate(
        "([x, y, width]) => { [app.camera.x, app.camera.y, app.camera.scale] = [x, y, 400 / width]; app.show(); }",
        [*(a + b) / 2, float(b[0] - a[0])],
    )
    sheet.page.evaluate("app.times.length = 0")
    for k in range(8):
        above = np.array([0, (30 + 5 * k) * (b[0] - a[0]) / 400])
        with sheet.change():
            sheet.draw(sheet.at((a + above).tolist()), sheet.at(b.tolist()))
    sheet.until("app.times.length === 8")
    assert abs(len(sheet.curves[0]["points"]) - vertices) < 100
    strokes = sheet.page.evaluate("app.times")
    record_property(
        f"editor, {vertices:,} vertices",
        f"stroke to picture {np.median(strokes):.0f} ms, a frame while panning {np.median(frames):.0f} ms",
    )


def test_two_tabs_show_the_same(sheet, served):
    document = sheet.page.evaluate("app.documents.current")
    other = Sheet(sheet.page.context.new_page(), served.url)
    other.page.evaluate("document => app.documents.open(document)", document)
    other.until("document => app.documents.current === document", arg=document)
    with other.change(), sheet.change():
        sheet.draw((300, 500), (450, 300))
    assert other.curves == sheet.curves
    other.page.close()


@pytest.mark.slow
def test_a_curve_drawn_by_hand_has_few_points_and_can_be_read_as_a_line(sheet):
    turn = np.linspace(0, np.pi, 120)
    with sheet.change(seconds=400):  # what fits it may have to be compiled first
        sheet.page.mouse.move(300, 400)
        sheet.page.mouse.down()
        for a in turn[1:]:
            sheet.page.mouse.move(float(450 - 150 * np.cos(a)), float(400 - 150 * np.sin(a)))
        sheet.page.mouse.up()
    assert sheet.page.inner_text("#rule") == "Freehand"
    (curve,) = sheet.curves
    assert len(curve["points"]) < 12
    scale = sheet.page.evaluate("app.camera.scale")
    drawn = kw.Spline(kw.SplineSpace(curve["degree"], curve["knots"]), curve["points"])
    middle = sheet.page.evaluate("app.camera.toPlane(450 - app.sheet.getBoundingClientRect().left, 400)")
    away = np.hypot(*(drawn(np.linspace(*drawn.space.domain, 60)) - middle).T) * scale
    assert np.abs(away - 150).max() < 5
    sheet.page.click("#reading [data-reading=straight]")  # undone, and drawn again
    sheet.until("app.drawing.curves.length === 1 && app.drawing.curves[0].points.length === 2")


def test_the_pressure_of_a_pen_weighs_a_stroke_and_a_palm_beside_it_draws_nothing(browser, served, tmp_path):
    """A stroke of half the pressure beside the polygon pulls its vertices half of the way (§7.3.2)."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, has_touch=True)
    sheet = Sheet(context.new_page(), served.url)
    sheet.begin()
    sheet.bring(kw.curve([[0, 0], [2, 0], [4, 0], [5, 3], [6, 0], [10, 0]], 3), tmp_path)
    scale = sheet.page.evaluate("app.camera.scale")
    above = 10 / scale
    tool = context.new_cdp_session(sheet.page)

    def pen(kind, point, force):
        x, y = sheet.at(point)
        tool.send(
            "Input.dispatchMouseEvent",
            {
                "type": kind,
                "x": x,
                "y": y,
                "pointerType": "pen",
                "force": force,
                "button": "left",
                "buttons": 1,
                "clickCount": 1,
            },
        )

    with sheet.change():
        pen("mousePressed", [0.9, above], 0.5)
        for x in np.linspace(1, 3, 9):
            pen("mouseMoved", [x, above], 0.5)
        x, y = sheet.at([3, 0])
        palm = [{"x": x, "y": y + 200, "id": 7}]
        for kind, fingers in (("Start", palm), ("End", [])):
            tool.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": fingers})
        pen("mouseReleased", [3, above], 0.5)
    assert sheet.page.inner_text("#rule") == "Near"
    (curve,) = sheet.curves
    heights = np.array(curve["points"])[:, 1]
    assert np.isclose(heights[heights > 0].min(), above / 2, rtol=0.05)
    assert sheet.errors == []
    context.close()


def test_the_page_goes_on_when_the_editor_was_killed_and_started_again(browser, tmp_path):
    store = tmp_path / "drawings.sqlite3"
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    with editor(store) as first:
        sheet = Sheet(context.new_page(), first.url)
        sheet.begin()
        with sheet.change():
            sheet.draw((300, 500), (450, 300))
        drawn = sheet.curves
        first.kill()
    sheet.until("document.querySelector('#line').textContent !== ''")
    sheet.draw((405, 330), (620, 280))  # drawn while nobody listens: said again when the line is back
    with editor(store) as second:
        assert second.url == first.url
        sheet.until("app.drawing.curves[0].points.length === 3", seconds=20)
        assert sheet.curves[0]["points"][0] == drawn[0]["points"][0]
        sheet.page.reload()
        sheet.ready()
        assert len(sheet.curves[0]["points"]) == 3
    assert sheet.errors == []
    context.close()


BEFORE_THE_COMMIT = """
import contextlib, sqlite3, threading
from knotwork.editor.store import Store
transaction, times = Store._transaction, []
@contextlib.contextmanager
def watched(self):
    with transaction(self):
        yield
        if self._db.execute("SELECT MAX(number) FROM revisions").fetchone()[0] == 2:
            times.append(threading.Event().wait({seconds}))
            if len(times) == 1:
                raise sqlite3.OperationalError("disk I/O error")
Store._transaction = watched
"""
MARKED = "document.querySelector('#unsaved').classList.contains('shown')"


def test_a_stroke_that_cannot_be_saved_is_drawn_marked_and_taken_back(browser, tmp_path):
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    with editor(tmp_path / "drawings.sqlite3", before=BEFORE_THE_COMMIT.format(seconds=1.5)) as served:
        sheet = Sheet(context.new_page(), served.url)
        sheet.begin()
        with sheet.change():
            sheet.draw((300, 500), (450, 300))
        drawn = sheet.curves
        assert not sheet.page.evaluate(MARKED)
        sheet.draw((405, 330), (620, 280))
        sheet.until(f"{MARKED} && app.drawing.curves[0].points.length === 3")
        assert sheet.revision == 1
        sheet.until("document.querySelector('#rule').textContent === 'Not done'")
        assert sheet.page.inner_text("#reason") == "the change could not be saved: disk I/O error"
        assert sheet.curves == drawn
        assert not sheet.page.evaluate(MARKED)
        sheet.draw((405, 330), (620, 280))
        sheet.until(MARKED)
        sheet.page.keyboard.press("Tab")
        sheet.page.keyboard.press("Shift+ArrowUp")  # a vertex of what is not saved yet: this waits
        sheet.until(f"!{MARKED} && app.drawing.revision === 3")
        assert len(sheet.curves[0]["points"]) == 3
        assert sheet.curves[0]["points"][0][1] > drawn[0]["points"][0][1]
    assert sheet.errors == []
    context.close()


def test_a_stroke_that_was_drawn_but_not_saved_when_the_editor_died_is_said_again(browser, tmp_path):
    store = tmp_path / "drawings.sqlite3"
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    with editor(store, before=BEFORE_THE_COMMIT.format(seconds=60)) as first:
        sheet = Sheet(context.new_page(), first.url)
        sheet.begin()
        with sheet.change():
            sheet.draw((300, 500), (450, 300))
        sheet.draw((405, 330), (620, 280))
        sheet.until(f"{MARKED} && app.drawing.curves[0].points.length === 3")
        first.kill()
    sheet.until("document.querySelector('#line').textContent !== ''")
    assert sheet.page.evaluate(MARKED)
    with editor(store):
        sheet.until(f"!{MARKED} && app.drawing.revision === 2", seconds=20)
        assert len(sheet.curves[0]["points"]) == 3
    assert sheet.errors == []
    context.close()
