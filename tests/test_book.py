"""The map of the book is whole, leads to what is there, and every figure and table of it is made by the code."""

import ast
import importlib
import re
import tomllib
from pathlib import Path

import pytest

from knotwork.cli import main

pytest.importorskip("matplotlib.pyplot", reason="matplotlib is not installed")
ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"

#: what the book has: the last number of each series of sections, equations, figures and tables
SECTIONS = {"1": 6, "2": 5, "2.2": 6, "2.3": 5, "2.4": 6, "3": 7, "3.6": 9, "4": 20, "5": 7, "6": 5, "7": 8}
SECTIONS |= {"7.3": 2, "7.5": 2}
EQUATIONS = {"2": 14, "3": 1, "4": 8, "5": 44, "6": 44}
FIGURES = {"1": 5, "2": 18, "3": 10, "4": 15, "6": 10, "7": 22}
TABLES = {"2": 1, "4": 6, "6": 1}


def all_of(series):
    return {f"{number}.{k}" for number, last in series.items() for k in range(1, last + 1)}


@pytest.fixture(scope="module")
def book():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(DOCS / "book")
        yield importlib.import_module("book")


MAP = tomllib.loads((DOCS / "book" / "map.toml").read_text(encoding="utf-8"))


def test_nothing_of_the_book_is_missing(book):
    assert set(MAP["sections"]) == all_of(SECTIONS)
    equations = [number for numbers in MAP["equations"] for number in numbers.split()]
    assert len(equations) == len(set(equations))
    assert set(equations) == all_of(EQUATIONS)
    assert set(book.drawn()) == all_of(FIGURES)
    assert set(MAP["tables"]) == all_of(TABLES)
    assert (len(book.drawn()), len(MAP["tables"])) == (80, 8)
    assert {question["section"] for question in MAP["questions"]} == {"2.5", "3.7", "4.12", "4.20", "5.6", "7.8"}


def test_what_the_code_cites_is_in_the_map():
    source = "\n".join(path.read_text() for path in (ROOT / "src").rglob("*.py"))
    assert set(re.findall(r"§([1-7]\.\d+(?:\.\d+)?)", source)) <= set(MAP["sections"])
    for kind in ("Theorem", "Lemma", "Proposition", "Corollary"):
        assert set(re.findall(rf"{kind} \d\.\d\.\d", source)) <= set(MAP["theorems"])


NAMES = {name for key in ("sections", "equations") for entry in MAP[key].values() for name in entry.get("code", [])}


@pytest.mark.parametrize("name", sorted(NAMES))
def test_a_name_of_the_map_is_in_the_code(book, name):
    assert book.find(name) is not None


def test_pages_and_tests_of_the_map_are_there():
    entries = [*MAP["sections"].values(), *MAP["questions"]]
    assert not [e["page"] for e in entries if "page" in e and not (DOCS / e["page"]).exists()]
    for name, entry in MAP["theorems"].items():
        path, _, test = entry["test"].partition("::")
        tree = ast.parse((ROOT / "tests" / path).read_text())
        assert test in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}, name


def test_the_commands_that_measure_again_are_there():
    targets = set(re.findall(r"^([a-z-]+):.*##", (ROOT / "Makefile").read_text(), re.MULTILINE))
    for question in MAP["questions"]:
        command = question.get("again", "")
        for path in re.findall(r"\b(?:tests|docs)/\S+\.py", command):
            assert (ROOT / path).exists(), command
        assert set(re.findall(r"^make (\S+)", command)) <= targets
    assert "count" in main.commands


def test_the_page_is_written_from_the_map(book):
    assert (DOCS / "book" / "README.md").read_text(encoding="utf-8") == book.page()


def test_every_figure_is_drawn_and_has_a_caption(book):
    """Those of chapter 7 check, in addition, that their strokes are read as what the figure shows."""
    for parts in book.drawn().values():
        for part in parts:
            assert book.caption(part).endswith(".")
            assert (DOCS / book.file_of(part)).exists()
            assert book.picture(part).startswith(("<svg", "<img"))
    assert set(MAP["figures"]) <= set(book.drawn())


def test_every_table_is_made_and_agrees_with_what_is_printed(book):
    for number in MAP["tables"]:
        head, *rows = book.table(number)
        assert rows
        assert {len(row) for row in rows} == {len(head)}
    printed = "1.3247180 3.6494359 1.1237328 5.7730165 1.0663016 7.8313696 1.0415233 9.8656714"
    assert printed == " ".join(cell for row in book.table("6.1")[1:5] for cell in row[1:])
    bases = {row[0]: row[1:] for row in book.table("2.1")}
    assert bases["monomial"] == ["1 1 1 δ δ δ", "1 -3/2 3/4 -1/8", "(1 − t)(1 − t)(1 − t), (1 − t)(1 − t), (1 − t), 1"]
    boehm = next(row for row in book.table("4.2") if row[0] == "boehm")
    assert boehm[2:] == [str(16 * 3 * 6), str(16 * 3 * 6), str(16 * 3), str(16 * 3)]  # nm (3 + d), 2dnm, nm
