"""SVG drawings as curves: against hand-worked outlines, and against svgelements where it follows the standard."""

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import knotwork as kw
from knotwork.errors import FileError
from knotwork.files import read
from knotwork.files.svg.document import decode
from knotwork.files.svg.pathdata import arc, subpaths

#: how far an arc may be from its ellipse, as a part of the larger radius
ARC = 1.04e-9


def drawn(body: str, attributes: str = "") -> list[kw.Spline]:
    """Return the curves of a document, which must cause no remark."""
    remarks: list[str] = []
    names = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    found = decode(f"<svg {names} {attributes}>{body}</svg>".encode(), remarks.append)
    assert not remarks
    return found


def one(body: str, attributes: str = "") -> kw.Spline:
    (curve,) = drawn(body, attributes)
    return curve


def path(d: str) -> kw.Spline:
    return one(f'<path d="{d}"/>')


def bezier(points: Any, s: np.ndarray) -> np.ndarray:
    """Return Σ C(n, i) (1 - s)^(n - i) s^i P_i: the definition of a Bézier piece."""
    n = len(points) - 1
    weights = np.array([math.comb(n, i) * (1 - s) ** (n - i) * s**i for i in range(n + 1)])
    return weights.T @ np.asarray(points, float)


S = np.linspace(0, 1, 9)


def assert_pieces(curve: kw.Spline, pieces: list[Any], closed: bool = False) -> None:
    """Assert that the curve runs through these Bézier pieces, one per interval, joined with multiplicity = degree."""
    n = curve.space.degree
    t = curve.space.breaks
    assert curve.space.periodic == closed
    assert n == max(map(len, pieces)) - 1
    assert len(t) == len(pieces) + 1
    assert [curve.space.multiplicity(x) for x in t[1:-1]] == [n] * (len(t) - 2)
    assert curve.space.multiplicity(t[0]) == (n if closed else n + 1)
    scale = np.abs(np.concatenate([np.reshape(piece, (-1, 2)) for piece in pieces])).max()
    for a, b, piece in zip(t, t[1:], pieces, strict=False):
        found = curve(a + (b - a) * S[:-1])  # the end of a piece is the start of the next
        np.testing.assert_allclose(found, bezier(piece, S[:-1]), rtol=0, atol=1e-14 * scale)
    np.testing.assert_allclose(curve(t[-1]), pieces[0][0] if closed else pieces[-1][-1], rtol=0, atol=1e-14 * scale)


# ---- path data ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("d", "pieces"),
    [
        ("M0 0 3 4", [[(0, 0), (3, 4)]]),
        ("M1,2 L4,6 4,16", [[(1, 2), (4, 6)], [(4, 6), (4, 16)]]),
        ("m1 2 3 4h5v-3", [[(1, 2), (4, 6)], [(4, 6), (9, 6)], [(9, 6), (9, 3)]]),
        ("M9 3H0 1V1 2", [[(9, 3), (0, 3)], [(0, 3), (1, 3)], [(1, 3), (1, 1)], [(1, 1), (1, 2)]]),
        ("M.5.5-1e1+.5", [[(0.5, 0.5), (-10, 0.5)]]),
        ("M0 0Q1 2 3 0t4 0", [[(0, 0), (1, 2), (3, 0)], [(3, 0), (5, -2), (7, 0)]]),
        ("M0 0q1 2 3 0T7 0T8 0", [[(0, 0), (1, 2), (3, 0)], [(3, 0), (5, -2), (7, 0)], [(7, 0), (9, 2), (8, 0)]]),
        ("M0 0C1 1 2 1 3 0s2-1 3 0", [[(0, 0), (1, 1), (2, 1), (3, 0)], [(3, 0), (4, -1), (5, -1), (6, 0)]]),
        ("M1 1c0 1 2 1 2 0S5 2 5 1", [[(1, 1), (1, 2), (3, 2), (3, 1)], [(3, 1), (3, 0), (5, 2), (5, 1)]]),
        # S continues only a cubic, T only a quadratic
        ("M0 0Q1 2 3 0S5 1 6 0", [[(0, 0), (1, 2), (3, 0)], [(3, 0), (3, 0), (5, 1), (6, 0)]]),
        ("M0 0C1 1 2 1 3 0T6 0", [[(0, 0), (1, 1), (2, 1), (3, 0)], [(3, 0), (3, 0), (6, 0)]]),
        ("M0 0L3 0T6 0L6 1", [[(0, 0), (3, 0)], [(3, 0), (3, 0), (6, 0)], [(6, 0), (6, 1)]]),
        # pieces of length zero say nothing of the path
        ("M0 0L0 0L1 0C1 0 1 0 1 0L2 0", [[(0, 0), (1, 0)], [(1, 0), (2, 0)]]),
        # one that comes back is not of length zero
        ("M0 0Q1 1 0 0", [[(0, 0), (1, 1), (0, 0)]]),
    ],
)
def test_path_data(d: str, pieces: list[Any]) -> None:
    assert_pieces(path(d), pieces)


@pytest.mark.parametrize(
    ("d", "pieces"),
    [
        ("M0 0H4V3Z", [[(0, 0), (4, 0)], [(4, 0), (4, 3)], [(4, 3), (0, 0)]]),
        ("M0 0H4V3L0 0z", [[(0, 0), (4, 0)], [(4, 0), (4, 3)], [(4, 3), (0, 0)]]),
        ("M0 0L1 1Z", [[(0, 0), (1, 1)], [(1, 1), (0, 0)]]),
        ("M0 0Q2 3 4 0Z", [[(0, 0), (2, 3), (4, 0)], [(4, 0), (0, 0)]]),
        ("M1 0C9 3-9 3 1 0Z", [[(1, 0), (9, 3), (-9, 3), (1, 0)]]),
        (
            "M1 0C2 2 3 2 4 0L4-4Q2-5 1-4Z",
            [[(1, 0), (2, 2), (3, 2), (4, 0)], [(4, 0), (4, -4)], [(4, -4), (2, -5), (1, -4)], [(1, -4), (1, 0)]],
        ),
    ],
)
def test_closed_subpaths_are_periodic(d: str, pieces: list[Any]) -> None:
    assert_pieces(path(d), pieces, closed=True)


def test_subpaths_are_curves_of_their_own() -> None:
    a, b, c, e = drawn('<path d="M0 0H1V1ZL5 5M7 7Q8 9 9 7m1 1 1 0m3 3M9 9"/>')
    assert_pieces(a, [[(0, 0), (1, 0)], [(1, 0), (1, 1)], [(1, 1), (0, 0)]], closed=True)
    assert_pieces(b, [[(0, 0), (5, 5)]])  # after Z, from where it closed
    assert_pieces(c, [[(7, 7), (8, 9), (9, 7)]])
    assert_pieces(e, [[(10, 8), (11, 8)]])


@pytest.mark.parametrize("d", ["", "none", "M3 4", "M3 4Z", "M3 4L3 4Z", "M0 0m1 1 0 0"])
def test_paths_that_go_nowhere_are_no_curves(d: str) -> None:
    assert drawn(f'<path d="{d}"/><path/>') == []


def test_intervals_follow_the_lengths() -> None:
    c = path("M0 0L3 4 3 5C3 5 3 8 3 8")
    np.testing.assert_allclose(np.diff(c.space.breaks), [5, 1, 3], rtol=1e-15)
    c = path("M0 0Q1 1 2 0")  # chord 2, polygon 2√2
    np.testing.assert_allclose(c.space.domain, [0, 1 + math.sqrt(2)], rtol=1e-15)


NUMBERS = st.integers(-50, 50).map(lambda k: k / 4)
COUNTS = {"L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "Z": 0}


@st.composite
def commands(draw: Any) -> tuple[str, list[float]]:
    """Draw a command of path data and its numbers."""
    name = draw(st.sampled_from("LHVCSQTlhvcsqtZ"))
    count = COUNTS[name.upper()]
    return name, draw(st.lists(NUMBERS, min_size=count, max_size=count))


@given(st.lists(commands(), min_size=1, max_size=8))
def test_path_data_agrees_with_svgelements(drawn_by: list[tuple[str, list[float]]]) -> None:
    elements = pytest.importorskip("svgelements")
    kinds = ["M", *(c.upper() for c, _ in drawn_by)]
    for before, here in itertools.pairwise(kinds):  # there svgelements reflects a handle of the other degree
        if (here == "S" and before in "QT") or (here == "T" and before in "CS"):
            return
    d = "M1 2" + "".join(c + " ".join(map(str, values)) for c, values in drawn_by)
    expected, current = [], []
    for segment in elements.Path(d):
        if isinstance(segment, elements.Move) or (current and isinstance(current[-1], elements.Close)):
            current = []
            expected.append(current)
        if (not isinstance(segment, elements.Move) and segment.length() > 0) or isinstance(segment, elements.Close):
            current.append(segment)
    expected = [[s for s in pieces if s.length() > 0] for pieces in expected]
    found = drawn(f'<path d="{d}"/>')
    expected = [pieces for pieces in expected if pieces]
    assert len(found) == len(expected)
    for curve, pieces in zip(found, expected, strict=True):
        t = curve.space.breaks
        assert len(t) == len(pieces) + 1
        for a, b, segment in zip(t, t[1:], pieces, strict=False):
            wanted = [(p.x, p.y) for p in map(segment.point, S[:-1])]
            np.testing.assert_allclose(curve(a + (b - a) * S[:-1]), wanted, rtol=0, atol=1e-11)


# ---- arcs and shapes ----------------------------------------------------------------------------------------------


def assert_on_ellipse(curve: kw.Spline, centre: Any, rx: float, ry: float, turned: float = 0.0) -> None:
    """Assert that the curve stays within the stated bound of an ellipse; the bound is met to a few per cent."""
    a, b = curve.space.domain
    x, y = (curve(np.linspace(a, b, 4001)) - np.asarray(centre)).T
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    off = np.abs(np.hypot((c * x + s * y) / rx, (c * y - s * x) / ry) - 1)
    assert 0.9 * ARC < off.max() < ARC


def test_circle() -> None:
    c = one('<circle cx="3" cy="-1" r="2"/>')
    assert c.space.periodic
    assert c(0).tolist() == [5, -1]
    assert_on_ellipse(c, (3, -1), 2, 2)
    quarter = c.space.domain[1] / 4
    np.testing.assert_allclose(c([quarter, 2 * quarter, 3 * quarter]), [[3, 1], [1, -1], [3, -3]], atol=1e-12)


@pytest.mark.parametrize("radii", ['rx="5" ry="5"', 'rx="5"', 'rx="auto" ry="5"', 'ry="5"'])
def test_one_radius_stands_for_both(radii: str) -> None:
    assert one(f"<ellipse {radii}/>") == one('<circle r="5"/>')


def test_ellipse_under_any_map_of_the_plane() -> None:
    assert_on_ellipse(one('<ellipse cx="1" cy="2" rx="4" ry="3"/>'), (1, 2), 4, 3)
    turned = one('<ellipse rx="4" ry="3" transform="translate(1,2) rotate(30)"/>')
    assert_on_ellipse(turned, (1, 2), 4, 3, 30)
    skewed = one('<circle r="1" transform="skewX(45)"/>')  # x + y, y
    a, b = skewed.space.domain
    x, y = skewed(np.linspace(a, b, 1001)).T
    np.testing.assert_allclose(np.hypot(x - y, y), 1, atol=2 * ARC)
    mirrored = one('<circle r="1" transform="scale(1,-1)"/>')
    assert mirrored(mirrored.space.domain[1] / 4).tolist() == pytest.approx([0, -1])


@pytest.mark.parametrize(("large", "sweep"), [(0, 0), (0, 1), (1, 0), (1, 1)])
@pytest.mark.parametrize("turned", [0, 30, -200])
def test_the_four_arcs_between_two_points(large: int, sweep: int, turned: float) -> None:
    end = (3.0, 2.0)
    c = path(f"M0 0A4 2.5 {turned} {large} {sweep} 3 2")
    assert c(0).tolist() == [0, 0]
    assert c(c.space.domain[1]).tolist() == list(end)
    # find the centre from three points of the arc, on the plane where the ellipse is a circle
    u = np.linspace(*c.space.domain, 2001)
    p = c(u)
    co, si = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    q = np.stack([(co * p[:, 0] + si * p[:, 1]) / 4, (co * p[:, 1] - si * p[:, 0]) / 2.5], axis=1)
    (ax, ay), (bx, by), (cx, cy) = q[0], q[len(q) // 2], q[-1]
    m = 2 * np.array([[bx - ax, by - ay], [cx - ax, cy - ay]])
    centre = np.linalg.solve(m, [bx**2 - ax**2 + by**2 - ay**2, cx**2 - ax**2 + cy**2 - ay**2])
    np.testing.assert_allclose(np.hypot(*(q - centre).T), 1, atol=2 * ARC)
    angles = np.unwrap(np.arctan2(*(q - centre).T[::-1]))
    assert (angles[-1] > angles[0]) == bool(sweep)  # positive angles go from x towards y
    assert (abs(angles[-1] - angles[0]) > math.pi) == bool(large)


def test_arcs_of_other_forms() -> None:
    assert_pieces(path("M0 0A0 5 0 0 1 10 0"), [[(0, 0), (10, 0)]])  # no radius: a line
    assert drawn('<path d="M1 1A5 5 0 0 1 1 1"/>') == []  # ends where it begins: left out
    small = path("M0 0A1 1 0 0 1 10 0")  # too small a radius grows to 5
    assert_on_ellipse(small, (5, 0), 5, 5)
    assert small(small.space.domain[1] / 2).tolist() == pytest.approx([5, -5])
    assert path("M0 0a-5-5 0 0110 0") == path("M0 0A5 5 0 0 1 10 0")  # flags need no space, signs do not count
    two = path("M0 0a5 5 0 0 1 10 0 5 5 0 0 1-10 0")
    np.testing.assert_allclose(two(two.space.domain[1]), [0, 0], atol=1e-15)


@pytest.mark.parametrize("angle", [math.pi / 16, 0.1, 0.01])
def test_the_error_of_one_cubic_is_as_the_formula_says(angle: float) -> None:
    end = (math.cos(angle), math.sin(angle))
    (piece,) = arc((1.0, 0.0), 1, 1, 0, False, True, end)
    radius = np.hypot(*bezier([(1.0, 0.0), *piece], np.linspace(0, 1, 1001)).T)
    formula = 2 / 27 * math.sin(angle / 4) ** 6 / math.cos(angle / 4) ** 2
    assert radius.max() - 1 == pytest.approx(formula, rel=1e-3, abs=2e-15)
    assert formula < ARC


def test_rectangles() -> None:
    c = one('<rect x="1" y="2" width="4" height="3"/>')
    corners = [(1, 2), (5, 2), (5, 5), (1, 5)]
    assert_pieces(c, list(zip(corners, [*corners[1:], corners[0]], strict=True)), closed=True)
    rounded = one('<rect width="10" height="8" rx="2" ry="1"/>')
    assert rounded(0).tolist() == [2, 0]
    t = rounded.space.breaks
    assert len(t) == 1 + 4 + 4 * 8
    ends = rounded(t[:-1]).tolist()
    for corner in [(8, 0), (10, 1), (10, 7), (8, 8), (2, 8), (0, 7), (0, 1)]:
        assert list(corner) in ends
    middle = rounded((t[1] + t[9]) / 2) - np.array([8, 1])  # halfway round the first corner
    assert np.hypot(middle[0] / 2, middle[1]) == pytest.approx(1, abs=1e-8)
    assert one('<rect width="4" height="2" rx="9"/>')(0).tolist() == [2, 0]  # at most half the side
    assert one('<rect width="4" height="2" rx="1" ry="0"/>') == one('<rect width="4" height="2"/>')


def test_lines_and_polygons() -> None:
    assert_pieces(one('<line x1="1" y1="2" x2="3" y2="5"/>'), [[(1, 2), (3, 5)]])
    assert_pieces(one('<polyline points="0,0 1-1 2,0"/>'), [[(0, 0), (1, -1)], [(1, -1), (2, 0)]])
    triangle = [[(0, 0), (1, 1)], [(1, 1), (2, 0)], [(2, 0), (0, 0)]]
    assert_pieces(one('<polygon points=" 0 0, 1 1, 2 0 "/>'), triangle, closed=True)


@pytest.mark.parametrize(
    "body",
    [
        '<rect width="0" height="3"/>',
        '<rect height="3"/>',
        "<circle/>",
        '<ellipse rx="3" ry="0"/>',
        "<line/>",
        "<polyline/>",
        '<polygon points="1,1"/>',
        '<g transform="scale(0)"><rect width="2" height="3"/></g>',
    ],
)
def test_shapes_without_extent_are_no_curves(body: str) -> None:
    assert drawn(body) == []


@pytest.mark.parametrize(
    ("x", "expected"),
    [
        ("7", 7),
        ("7px", 7),
        (" 3pt ", 4),
        ("1pc", 16),
        ("1in", 96),
        ("2.54cm", 96),
        ("25.4mm", 96),
        ("101.6Q", 96),
        ("50%", 100),
        ("1e1%", 20),
    ],
)
def test_lengths(x: str, expected: float) -> None:
    assert one(f'<line x2="{x}"/>', 'viewBox="-5 -5 200 100"').space.domain[1] == pytest.approx(expected, rel=1e-15)


def test_percentages_of_radius_and_height() -> None:
    assert one('<circle r="10%"/>', 'width="30" height="40"')(0)[0] == pytest.approx(math.sqrt(1250) / 10)
    assert one('<line y2="10%"/>', 'width="30" height="40"').space.domain[1] == pytest.approx(4)


# ---- transforms, groups, use --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("transform", "image"),  # of (1, 0) and (0, 1), from that of (0, 0)
    [
        ("", [(0, 0), (1, 0), (0, 1)]),
        ("none", [(0, 0), (1, 0), (0, 1)]),
        ("translate(3)", [(3, 0), (4, 0), (3, 1)]),
        ("translate(3 -4)", [(3, -4), (4, -4), (3, -3)]),
        ("scale(2)", [(0, 0), (2, 0), (0, 2)]),
        ("scale(2,.5)", [(0, 0), (2, 0), (0, 0.5)]),
        ("rotate(90)", [(0, 0), (0, 1), (-1, 0)]),
        ("rotate(90, 2, 0)", [(2, -2), (2, -1), (1, -2)]),
        ("skewX(45)", [(0, 0), (1, 0), (1, 1)]),
        ("skewY(45)", [(0, 0), (1, 1), (0, 1)]),
        ("matrix(1 2 3 4 5 6)", [(5, 6), (6, 8), (8, 10)]),
        (" translate(3),scale ( 2 )  ", [(3, 0), (5, 0), (3, 2)]),
        ("scale(2)translate(3)", [(6, 0), (8, 0), (6, 2)]),
    ],
)
def test_transforms(transform: str, image: list[tuple[float, float]]) -> None:
    c = one(f'<path d="M1 0L0 0 0 1" transform="{transform}"/>')
    np.testing.assert_allclose(c.points[[1, 0, 2]], image, rtol=0, atol=1e-15)


def test_transforms_of_groups_are_applied_inside_out() -> None:
    inner = '<a><g transform="rotate(90)"><path d="M1 2L3 4" transform="scale(2)"/></g></a>'
    body = f'<g transform="translate(10)">{inner}</g>'
    np.testing.assert_allclose(one(body).points, [[10 - 4, 2], [10 - 8, 6]], atol=1e-14)


def test_the_view_box_of_the_document_changes_no_coordinate() -> None:
    c = one('<path d="M1 2L3 4"/>', 'viewBox="0 0 10 10" width="100mm" height="20mm" preserveAspectRatio="none"')
    assert c.points.tolist() == [[1, 2], [3, 4]]


USED = '<defs><g id="a" transform="scale(2)"><path id="b" d="M1 1L2 1"/></g></defs>'


@pytest.mark.parametrize(
    ("body", "points"),
    [
        (USED, None),
        (USED + '<use href="#b" x="5" y="6"/>', [[6, 7], [7, 7]]),
        (USED + '<use xlink:href="#a" x="5" transform="scale(10)"/>', [[70, 20], [90, 20]]),
        ('<use href="#b" y="1"/>' + USED, [[1, 2], [2, 2]]),
        (USED + '<use href="#b" xlink:href="#a"/>', [[1, 1], [2, 1]]),
        (USED + '<g id="c"><use href="#a"/></g>', [[2, 2], [4, 2]]),
        (USED + '<defs><use id="c" x="1" href="#b"/></defs><use href="#c" x="1"/>', [[3, 1], [4, 1]]),
        ('<symbol id="s"><path d="M1 1L2 1"/></symbol>', None),
        ('<symbol id="s"><path d="M1 1L2 1"/></symbol><use href="#s" x="5"/>', [[6, 1], [7, 1]]),
        (
            '<symbol id="s" viewBox="0 0 2 2"><path d="M1 1L2 1"/></symbol><use href="#s" width="20" height="60"/>',
            [[10, 30], [20, 30]],  # ten times as large, in the middle of the height
        ),
        (
            '<symbol id="s" viewBox="0 0 2 2" width="4" height="8" preserveAspectRatio="none"><path d="M1 1L2 1"/>'
            '</symbol><use href="#s" x="1"/>',
            [[3, 4], [5, 4]],
        ),
        ('<svg x="10" y="20"><path d="M1 1L2 1"/></svg>', [[11, 21], [12, 21]]),
        ('<svg x="10" width="4" height="8" viewBox="1 1 2 2"><path d="M1 1L2 1"/></svg>', [[10, 2], [12, 2]]),
        (
            '<svg width="4" height="8" viewBox="1 1 2 2" preserveAspectRatio="xMaxYMax slice">'
            '<path d="M1 1L2 1"/></svg>',
            [[-4, 0], [0, 0]],
        ),
        (
            '<svg width="4" height="8" viewBox="1 1 2 2" preserveAspectRatio="xMinYMax"><path d="M1 1L2 1"/></svg>',
            [[0, 4], [2, 4]],
        ),
    ],
)
def test_what_is_used_is_drawn_there(body: str, points: list[list[float]] | None) -> None:
    found = drawn(body)
    if points is None:
        assert found == []
    else:
        (c,) = found
        assert c.points.tolist() == points


LINE = '<path d="M0 0L1 0"/>'


@pytest.mark.parametrize(
    "body",
    [
        *(
            f"<{tag}>{LINE}</{tag}>"
            for tag in ("defs", "clipPath", "mask", "marker", "pattern", "symbol", "metadata", "text", "foreignObject")
        ),
        f'<g display="none">{LINE}</g>',
        f'<g style="fill:red; display : none !important">{LINE}</g>',
        f'<g visibility="hidden">{LINE}</g>',
        f"<style>.a{{fill:red}} .b, .st0 {{display:none}}</style><g class='a st0'>{LINE}</g>",
        f"<style><![CDATA[ /* off */ g#x{{ display:none }} ]]></style><g id='x'>{LINE}</g>",
        f"<style>path{{visibility:hidden}}</style>{LINE}",
        f'<o:g xmlns:o="http://other">{LINE}</o:g>',
        f'<defs><g id="a" display="none">{LINE}</g></defs><use href="#a"/>',
        f'<switch><g systemLanguage="xx">{LINE}</g></switch>',
        "<text>M0 0L1 0</text><image width='5' height='5'/>",
    ],
)
def test_what_is_not_drawn_does_not_appear(body: str) -> None:
    assert drawn(body) == []


@pytest.mark.parametrize(
    "body",
    [
        f'<g visibility="hidden"><g visibility="visible">{LINE}</g></g>',
        f'<g display="none" style="display:inline">{LINE}</g>',
        f"<style>.a{{display:none}} #x{{display:inline}} g{{display:none}}</style><g id='x' class='a'>{LINE}</g>",
        f"<style>.b .a{{display:none}} /* .a{{display:none}} </style><g class='a'>{LINE}</g>",
        f'<switch><foreignObject requiredExtensions="x"/>{LINE}{LINE}</switch>',
    ],
)
def test_what_is_drawn_after_all(body: str) -> None:
    assert_pieces(one(body), [[(0, 0), (1, 0)]])


def test_a_document_without_a_name_space_or_with_a_prefix() -> None:
    plain = decode(f"<svg>{LINE}</svg>".encode(), pytest.fail)
    prefixed = decode(
        b'<?xml version="1.0"?><s:svg xmlns:s="http://www.w3.org/2000/svg"><s:path d="M0 0L1 0"/></s:svg>', pytest.fail
    )
    wide = decode(f'<?xml version="1.0" encoding="UTF-16"?><svg>{LINE}</svg>'.encode("utf-16"), pytest.fail)
    assert plain == prefixed == wide == [path("M0 0L1 0")]


def test_short_entities_of_drawing_programs_are_expanded() -> None:
    text = """<?xml version="1.0" encoding="utf-8"?>
        <!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd" [
        <!ENTITY ns_svg "http://www.w3.org/2000/svg"> <!ENTITY d "M0 0L1 0">]>
        <svg xmlns="&ns_svg;"><path d="&d;"/></svg>"""
    assert decode(text.encode(), pytest.fail) == [path("M0 0L1 0")]


def test_use_of_what_is_not_there_is_left_out_with_a_warning(tmp_path: Path) -> None:
    file = tmp_path / "a.svg"
    file.write_text(f"<svg>\n<use href='#x'/>{LINE}</svg>")
    with pytest.warns(UserWarning, match=r"a\.svg: line 2: use of '#x', which is not in this file, is left out"):
        assert len(read(file)) == 1


def test_coordinates_of_any_size() -> None:
    for scale in (1e150, 1e-150):
        c = one(f'<path d="M0 0L3 0 3 4Z" transform="scale({scale})"/>')
        np.testing.assert_allclose(c.space.breaks, np.array([0, 3, 7, 12]) * scale, rtol=1e-15)
    with pytest.raises(FileError, match="line 1, <path>: the outline reaches beyond float64"):
        one('<path d="M1e200 0L3 0" transform="scale(1e200)"/>')


@given(st.lists(st.tuples(st.integers(-999, 999), st.integers(-999, 999)), min_size=2, max_size=40))
def test_a_path_of_relative_moves_that_comes_back_has_no_segment_more(moves):
    """Tenths add as tenths: 0.1 + 0.2 - 0.3 is 0, and no sliver closes the path."""
    back = [-sum(x) for x in zip(*moves, strict=True)]
    text = "".join(f"l{x / 10} {y / 10}" for x, y in [*moves, back])
    (path,) = subpaths(f"m{moves[0][0] / 10} {moves[0][1] / 10}{text}z", pytest.fail)
    assert len(path.segments) == len(moves) + 1
    assert path.end == path.start
