"""The book reproduced: `python docs/book/book.py` writes the map beside it and one page of all figures and tables.

map.toml is the one list; README.md is written from it, and so is build/book.html, which holds every picture itself.
"""

from __future__ import annotations

import base64
import importlib
import io
import re
import sys
import tomllib
from fractions import Fraction
from html import escape
from pathlib import Path
from typing import Any

import knotwork as kw
from knotwork import progressive
from knotwork.diagrams import FIGURES, figure
from knotwork.insertion.counts.tables import tables

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
CHAPTERS = {
    1: "Blossoming",
    2: "Progressive curves",
    3: "Factored knot insertion",
    4: "Knot insertion algorithms",
    5: "Conversion between spline spaces",
    6: "How much one knot can shrink the coefficients",
    7: "Sketching",
}
MAP: dict[str, Any] = tomllib.loads((HERE / "map.toml").read_text(encoding="utf-8"))
#: the scripts of docs/figures that draw the figures of a chapter
SCRIPTS = {"6": "stability", "7": "sketching"}


def script(name: str) -> Any:
    """Return a script of docs/figures, imported."""
    folder = str(HERE.with_name("figures"))
    if folder not in sys.path:
        sys.path.insert(0, folder)
    return importlib.import_module(name)


def find(name: str) -> Any:
    """Return what a name of the map stands for: a module, or something in one."""
    parts = ["knotwork", *name.split(".")]
    for k in range(len(parts), 0, -1):
        try:
            thing = importlib.import_module(".".join(parts[:k]))
        except ModuleNotFoundError:
            continue
        for part in parts[k:]:
            thing = getattr(thing, part)
        return thing
    raise ModuleNotFoundError(name)


# ---- figures --------------------------------------------------------------------------------------------------------


def drawn() -> dict[str, list[str]]:
    """Return the parts that are drawn of each figure: "2.5" has "2.5a" and "2.5b"."""
    parts = [*FIGURES, *(number for name in SCRIPTS.values() for number in script(name).FIGURES)]
    found: dict[str, list[str]] = {}
    for part in sorted(parts, key=lambda part: [int(x) for x in part.rstrip("abc").split(".")]):
        found.setdefault(part.rstrip("abc"), []).append(part)
    return found


def caption(part: str) -> str:
    """Return what a figure shows, in our words."""
    return FIGURES[part].caption if part in FIGURES else str(MAP["figures"][part.rstrip("abc")]["caption"])


def ours(part: str) -> str:
    """Return what of a figure's data is ours, since the text does not print it; or nothing."""
    return str(MAP["figures"].get(part.rstrip("abc"), {}).get("ours", ""))


def picture(part: str) -> str:
    """Return a figure as an element of HTML, made anew."""
    if part in FIGURES:
        return figure(part).svg()
    name = SCRIPTS[part.partition(".")[0]]
    stream = io.BytesIO()
    fig = script(name).alone(part)
    fig.savefig(stream, format="png", dpi=130)
    script("common").plt.close(fig)
    return f'<img alt="" src="data:image/png;base64,{base64.b64encode(stream.getvalue()).decode()}">'


def file_of(part: str) -> str:
    """Return the picture under docs/ that shows a figure."""
    chapter = part.partition(".")[0]
    if part in FIGURES:
        return f"images/{'progressive' if chapter < '3' else 'insertion'}/figure-{part}.svg"
    name = SCRIPTS[chapter]
    return next(f"images/{name}/{file}.png" for file, parts in script(name).PICTURES.items() if part in parts)


# ---- tables: a heading, and rows of text ----------------------------------------------------------------------------


def named_bases() -> list[list[str]]:
    """Return Table 2.1 for cubics over knots that are numbers: all columns are computed from the sequences."""
    F = Fraction
    bases = {
        "B-spline segment": progressive.bspline_segment([F(k) for k in range(-2, 4)]),
        "Bernstein": progressive.bernstein(3, F(0), F(2)),
        "power": progressive.power([F(k) for k in (0, 1, 3, 4)]),
        "monomial": progressive.monomial(3, F(1)),
        "Newton dual": progressive.newton_dual([F(k) for k in (1, 3, 4)]),
        "Hermite's primal": progressive.Sequence([F(3, 2), F(0), F(0), F(1), F(1), F(-1, 2)]),
    }
    rows = [["basis", "knots", "values at ½", "dual functions"]]
    for name, sequence in bases.items():
        knots = list(sequence)
        texts = ["δ" if not w else str(t) for t, w in knots]
        duals = [
            "".join(f"({t} − t)" if t else "(−t)" for t, w in knots[k : k + 3] if w) or "1"  # δ is a factor 1
            for k in range(4)
        ]
        values = " ".join(map(str, sequence.basis(F(1, 2))))
        rows.append([name, " ".join(texts), values, ", ".join(duals)])
    return rows


def counted(number: str) -> list[list[str]]:
    """Return one of Tables 4.1 to 4.6: of degree 4 in the plane with 20 knots, or of cubics in space with 16."""
    place = int(number[-1]) - 1
    table = tables(*((3, 3, 16) if place % 2 else (4, 2, 20)))[place // 2]
    kinds = ["additions", "multiplications", "divisions", "combinations"]
    rows = [["method", "", *kinds]]
    for line in table.lines:
        pairs = [(getattr(line.predicted, kind), getattr(line.measured, kind)) for kind in kinds]
        told = [f"{p:.6g}" if p == q else f"{'≤ ' if line.bound else ''}{float(p):.6g}, counted {q}" for p, q in pairs]
        rows.append([line.method, line.how, *told])
    return rows


def worst_knots() -> list[list[str]]:
    """Return Table 6.1."""
    worst = {k: kw.stability.worst(k) for k in range(4, 17, 2)}
    return [["order k", "x", "δ"], *([f"{k}", f"{found.x:.7f}", f"{found:.7f}"] for k, found in worst.items())]


def table(number: str) -> list[list[str]]:
    """Return a table of the book, made anew."""
    return named_bases() if number == "2.1" else worst_knots() if number == "6.1" else counted(number)


# ---- the map --------------------------------------------------------------------------------------------------------


def _code(entry: dict[str, Any]) -> str:
    return " ".join(f"`{name}`" for name in entry.get("code", []))


def _link(entry: dict[str, Any]) -> str:
    page = entry.get("page", "")
    return f"[{page.removesuffix('.md').removesuffix('/README')}](../{page})" if page else ""


def _table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _of(chapter: int, key: str) -> dict[str, Any]:
    """Return the part of a list that is of one chapter; names end with their number."""
    return {name: entry for name, entry in MAP[key].items() if re.search(rf"(^|\s){chapter}\.", name)}


def page() -> str:
    """Return the map as a page."""
    figures = drawn()
    text = [
        "# The book, and where it is in the code",
        MAP["intro"].strip().format(sections=len(MAP["sections"]), figures=len(figures), tables=len(MAP["tables"])),
        "## What it leaves open, and our answers",
    ]
    for q in MAP["questions"]:
        where = f" ({_link(q)}; again by `{q['again']}`)" if "again" in q else ""
        text.append(f"**§{q['section']}: {q['asks']}** {q['answer']}{where}")
    for chapter, title in CHAPTERS.items():
        text.append(f"## Chapter {chapter}: {title}")
        sections = [[f"§{n}", e["about"], _code(e), _link(e)] for n, e in _of(chapter, "sections").items()]
        text.append(_table(["section", "about", "code", "page"], sections))
        if equations := _of(chapter, "equations"):
            rows = [["".join(f"({x}) " for x in n.split()).strip(), e["says"], _code(e)] for n, e in equations.items()]
            text.append(_table(["equation", "says", "code"], rows))
        if theorems := _of(chapter, "theorems"):
            rows = [[n, e["says"], f"`{e['test'].partition('::')[2]}`"] for n, e in theorems.items()]
            text.append(_table(["", "says", "test"], rows))
        rows = [
            [f"[Fig. {part}](../{file_of(part)})", caption(part), ours(part)]
            for number, parts in figures.items()
            if number.startswith(f"{chapter}.")
            for part in parts
        ]
        if rows:
            text.append(_table(["figure", "shows", "ours is"], rows))
        if made := _of(chapter, "tables"):
            text.append(_table(["table", "shows"], [[f"Table {n}", says] for n, says in made.items()]))
    return "\n\n".join(text) + "\n"


# ---- all of it on one page ------------------------------------------------------------------------------------------

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #22303f; max-width: 1200px; margin: 0 auto; padding: 1rem; }
nav a { margin-right: 1rem; } h1, h2 { font-weight: 600; } h2 { margin-top: 3rem; }
.all { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 34rem), 1fr)); gap: 2rem; }
figure { margin: 0; } figure svg, figure img { display: block; max-width: 100%; height: auto; margin: auto; }
figure img { max-width: min(100%, 27rem); }
figcaption { color: #55606b; font-size: 0.9rem; margin-top: 0.4rem; } .wide { overflow-x: auto; margin: 2rem 0; }
table { border-collapse: collapse; font-size: 0.85rem; }
caption { text-align: left; min-width: 20rem; margin-bottom: 0.4rem; }
td, th { border-bottom: 1px solid #dde2e7; padding: 0.2rem 0.7rem 0.2rem 0; text-align: left; white-space: nowrap; }
"""


def whole() -> str:
    """Return a page with all figures and tables, which needs no other file."""
    figures = drawn()
    chapters = [c for c in CHAPTERS if c != 5]  # which has neither
    body = [
        "<h1>Knot insertion and deletion: all figures and tables</h1>",
        "<p>After R. N. Goldman and T. Lyche (eds.), <i>Knot Insertion and Deletion Algorithms for B-Spline Curves and "
        "Surfaces</i>, SIAM 1993; each made by the algorithms that it shows.</p>",
        "<nav>" + "".join(f'<a href="#c{c}">{c}. {CHAPTERS[c]}</a>' for c in chapters) + "</nav>",
    ]
    for chapter in chapters:
        body.append(f'<h2 id="c{chapter}">{chapter}. {CHAPTERS[chapter]}</h2><div class="all">')
        for number, parts in figures.items():
            if number.startswith(f"{chapter}."):
                for part in parts:
                    note = f" Ours: {ours(part)}." if ours(part) else ""
                    told = f"<b>Fig. {part}.</b> {escape(caption(part) + note)}"
                    body.append(f"<figure>{picture(part)}<figcaption>{told}</figcaption></figure>")
        body.append("</div>")
        for number, says in _of(chapter, "tables").items():
            head, *rows = [[escape(cell) for cell in row] for row in table(number)]
            body.append(
                f'<div class="wide"><table><caption><b>Table {number}.</b> {escape(says)}</caption><tr>'
                + "".join(f"<th>{cell}</th>" for cell in head)
                + "</tr>"
                + "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
                + "</table></div>"
            )
    head = '<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
    title = "<title>All figures and tables</title>"
    return f'<!doctype html><html lang="en"><head>{head}{title}<style>{STYLE}</style></head><body>\n' + "\n".join(body)


if __name__ == "__main__":
    (HERE / "README.md").write_text(page(), encoding="utf-8")
    target = ROOT / "build" / "book.html"
    target.parent.mkdir(exist_ok=True)
    target.write_text(whole() + "\n</body></html>\n", encoding="utf-8")
    print(f"{target.relative_to(ROOT)}: {len(drawn())} figures, {len(MAP['tables'])} tables")
