"""SVG that is damaged, or made to exhaust the machine: a clear error with its line, soon.

Where a pattern could look at a text again and again, the text is so long that these tests would take hours.
"""

import re
from pathlib import Path

import pytest

import knotwork as kw
from knotwork.errors import FileError
from knotwork.files import read
from work import calls_within

LINE = '<path d="M0 0L1 0"/>'


def refused(tmp_path: Path, text: str | bytes, message: str) -> None:
    """Assert that a file is refused with this message, after little work."""
    path = tmp_path / "a.svg"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with calls_within(2_000_000), pytest.raises(FileError, match=rf"a\.svg: {message}"):
        read(path)


def remarked(tmp_path: Path, text: str, message: str) -> list[kw.Spline]:
    """Assert that a file is read with a warning of this message, and return what is drawn."""
    path = tmp_path / "a.svg"
    path.write_text(text)
    with pytest.warns(UserWarning, match=rf"a\.svg: {message}"):
        return read(path)


@pytest.mark.parametrize(
    ("d", "message"),
    [
        ("L1 1", "command L at character 1: the path has not begun"),
        ("1 2", "path data begins with '1 2'; expected M"),
        ("M", "command M at character 1: 0 numbers given; expected 2 for each"),
        ("M1", "command M at character 1: 1 numbers given"),
        ("M0 0L1", "command L at character 5: 1 numbers given; expected 2"),
        ("M0 0C1 1 2 2 3", "command C at character 5: 5 numbers given; expected 6"),
        ("M0 0 h", "command h at character 6: 0 numbers given; expected 1"),
        ("M0 0L1 1x2 2", "command L at character 5: 'x2 2' given; expected numbers"),
        ("M0 0L1 1 garbage", "command L at character 5: 'g' given"),
        ("M0 0LNaN 1", "command L at character 5: 'N' given"),
        ("M0 0L1e999 1", "command L at character 5: a number is beyond float64"),
        ("M0 0L1 1Z5", "command Z at character 9: '5' follows; expected another command"),
        ("M0 0A1 1 0 2 0 5 5", "command A at character 5: '1 1 0 2 0 5 5' given; expected rx ry angle, two flags"),
        ("M0 0A1 1 0 0 0 5", "command A at character 5: .* given; expected rx ry angle"),
        ("M0 0A", "command A at character 5: '' given"),
        ("M0 0A1e999 1 0 0 0 5 5", "command A at character 5: a number is beyond float64"),
    ],
)
def test_path_data_that_is_damaged_is_drawn_up_to_there(tmp_path: Path, d: str, message: str) -> None:
    message = message.replace("command ", "path data breaks off at command ").replace(" at character", ", character")
    drawn = remarked(tmp_path, f'<svg>\n{LINE}\n<path d="{d}"/></svg>', f"line 3, <path>: {message}")
    assert len(drawn) == (2 if re.search(r"L1 1[^,0-9]", d) and "M0 0" in d else 1)


@pytest.mark.parametrize(
    ("d", "message"),
    [
        ("M0 0A1e-300 1 0 0 0 1e300 5", "the arc is beyond float64"),
        ("M0 0l1e308 0l1e308 0", "the outline reaches beyond float64"),
        ("M-1e308 0L1e308 0", "the outline is longer than float64 can say"),
    ],
)
def test_outlines_beyond_float64(tmp_path: Path, d: str, message: str) -> None:
    refused(tmp_path, f'<svg>\n{LINE}\n<path d="{d}"/></svg>', f"line 3, <path>: {message}")


@pytest.mark.parametrize(
    ("element", "message"),
    [
        ('<rect width="-1" height="2"/>', r"<rect>: width: -1\.0 given; expected no negative length"),
        ('<circle r="-1"/>', r"<circle>: r: -1\.0 given"),
        ('<circle r="1lh"/>', r"<circle>: r: length '1lh' given; expected a number, alone or with px"),
        ('<circle r="nan"/>', "<circle>: r: length 'nan' given"),
        ('<circle r="1e999"/>', "<circle>: r: length '1e999' is beyond float64"),
        ('<circle r="1" cx="5%"/>', "<circle>: cx: length '5%' is relative to a size that the file does not give"),
        ('<polyline points="0 0 1"/>', "<polyline>: points: 3 numbers given; expected pairs"),
        ('<polygon points="0 0 1 y"/>', "<polygon>: points: 'y' given; expected numbers"),
        ('<g transform="scale(nan)"/>', "<g>: 'nan' given; expected numbers"),
        ('<g transform="scale(1 2 3)"/>', "<g>: transform scale with 3 numbers given; expected 1 or 2"),
        ('<g transform="rotate()"/>', "<g>: transform rotate with 0 numbers given; expected 1 or 3"),
        ('<g transform="flip(1)"/>', "<g>: transform flip with 1 numbers given; expected one of matrix"),
        ('<g transform="scale(2"/>', r"<g>: transform 'scale\(2' given; expected matrix"),
        ('<g transform="scale(1e200) scale(1e200)"/>', "<g>: transform .* is beyond float64"),
        ('<svg viewBox="0 0 1"/>', "<svg>: viewBox '0 0 1' given; expected x, y"),
        ('<svg viewBox="0 0 -1 1"/>', "<svg>: viewBox"),
        ('<svg viewBox="0 0 1 1"/>', "<svg>: its viewBox is to fit a size that the file does not give"),
        ('<svg width="-1" viewBox="0 0 1 1"/>', "<svg>: '-1' given for a width or height"),
    ],
)
def test_attributes_that_make_no_sense_are_passed_over(tmp_path: Path, element: str, message: str) -> None:
    drawn = remarked(tmp_path, f"<svg>\n{LINE}\n{element}</svg>", f"line 3, {message}")
    assert drawn[0].points.tolist() == [[0, 0], [1, 0]]


@pytest.mark.parametrize(
    ("element", "message"),
    [
        ('<g id="a"><use href="#a"/></g>', "use of '#a' inside itself"),
        ('<defs><use id="a" href="#b"/><use id="b" href="#a"/></defs><use href="#b"/>', "use of '#b' inside itself"),
    ],
)
def test_use_inside_itself(tmp_path: Path, element: str, message: str) -> None:
    refused(tmp_path, f"<svg>\n{LINE}\n{element}</svg>", f"line 3: {message}")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<svg>\n<path", "line 2, column 1: unclosed token"),
        ("<svg>\n<g></svg>", "line 2, column 6: mismatched tag"),
        (f"<svg>{LINE}", "line 1, column 26: no element found"),
        (f"<svg>{LINE}</svg><svg/>", "line 1, column 32: junk after document element"),
        ("<svg><p d='&x;'/></svg>", "line 1, column 6: undefined entity"),
        ("<svg><i:g/></svg>", "line 1, column 6: unbound prefix"),
        ("plain text", "line 1, column 1: syntax error"),
        ("<html/>", "line 1: the root element is 'html'; expected svg"),
        ("<svg xmlns='http://other'/>", "line 1: the root element is 'of another kind'; expected svg"),
        ("<svg/>", "there is no spline in this file"),
        (b"<?xml version='1.0' encoding='klingon'?><svg/>", "line 1"),
        (b"<svg>\xff</svg>", r"line 1, column 6: not well-formed \(invalid token\)"),
        (b"\xfe\xff\x00<", "line 1"),
    ],
)
def test_text_that_is_no_drawing(tmp_path: Path, text: str | bytes, message: str) -> None:
    refused(tmp_path, text, message)


def with_entities(declared: str, body: str = LINE) -> str:
    return f"<!DOCTYPE svg [\n{declared}\n]>\n<svg>{body}</svg>"


def test_entities_that_would_load_or_multiply(tmp_path: Path) -> None:
    laughs = "".join(f'<!ENTITY a{i + 1} "{f"&a{i};" * 10}">' for i in range(9))
    refused(tmp_path, with_entities(f'<!ENTITY a0 "ha">{laughs}', "&a9;"), "line 2: entity 'a1' refers to others")
    many = "&a;" * 100_000
    refused(
        tmp_path,
        with_entities(f'<!ENTITY a "{"x" * 100_000}">', f"<text>{many}</text>"),
        "line 2: entity 'a' could multiply the file by more than 10000000 characters",
    )
    refused(
        tmp_path,
        with_entities('<!ENTITY a SYSTEM "file:///etc/passwd">', "<text>&a;</text>"),
        "line 2: entity 'a' would be loaded from 'file:///etc/passwd'; entities from outside are not read",
    )
    refused(
        tmp_path,
        with_entities('<!ENTITY % a SYSTEM "http://127.0.0.1/x.dtd"> %a;'),
        "line 2: entity 'a' would be loaded from 'http://127",
    )
    refused(tmp_path, with_entities("<!ENTITY % a '<!ENTITY b \"x\">'> %a;"), "line 2: entity 'a' refers to others")


def test_nesting_too_deep(tmp_path: Path) -> None:
    refused(tmp_path, "<svg>" + "<g>\n" * 100_000, "line 200: elements are nested deeper than 200")
    chain = "".join(f'<g id="a{i}"><use href="#a{i + 1}"/></g>' for i in range(1000))
    refused(
        tmp_path,
        f'<svg><defs>{chain}<g id="a1000">{LINE}</g></defs><use href="#a0"/></svg>',
        "line 1: elements and use of them are nested deeper than 200",
    )


def test_use_that_multiplies(tmp_path: Path) -> None:
    """What is read before the error is what its message says."""
    path = tmp_path / "a.svg"
    levels = "".join(f'<g id="a{i + 1}">{f"""<use href="#a{i}"/>""" * 10}</g>' for i in range(9))
    path.write_text(f'<svg><defs><g id="a0">{LINE}</g>{levels}</defs><use href="#a9"/></svg>')
    with pytest.raises(FileError, match=r"a\.svg: line 1: use elements multiply the drawing beyond 100000"):
        read(path)
    long = f'<path id="a" d="M0 0{"L1 1" * 20_000}"/>'
    uses = '<use href="#a"/>' * 1000
    path.write_text(f"<svg>{long}{uses}</svg>")
    with pytest.raises(FileError, match=r"a\.svg: line 1: use elements multiply"):
        read(path)


N = 100_000


@pytest.mark.parametrize(
    "element",
    [
        f'<path d="M0 0A{"1" * N}"/>',
        f'<path d="M0 0A{"1 " * N}"/>',
        f'<path d="M0 0L{"1" * N}x"/>',
        f'<path d="M0 0L{"." * N}"/>',
        f'<path d="M0 0L{"1e" * N}"/>',
        f'<path d="M0 0{" " * N}x"/>',
        f'<g transform="{"a" * N}"/>',
        f'<g transform="a{" " * N}x"/>',
        f'<g transform="{"a(" * N}"/>',
        f'<circle r="1{" " * N}x"/>',
        f'<circle r="{"1" * N}x"/>',
    ],
)
def test_text_that_is_slow_to_refuse_elsewhere(tmp_path: Path, element: str) -> None:
    with calls_within(3_000_000):
        remarked(tmp_path, f"<svg>{LINE}{element}</svg>", "line 1, <")


@pytest.mark.parametrize("part", ["a", "{", "/*", "a{", ".a", ",", "}"])
def test_style_sheets_that_are_slow_to_read_elsewhere(tmp_path: Path, part: str) -> None:
    path = tmp_path / "a.svg"
    path.write_text(f"<svg><style>{part * N}{{display:none}}</style>{LINE}</svg>")
    with calls_within(2_000_000):
        assert len(read(path)) == 1
