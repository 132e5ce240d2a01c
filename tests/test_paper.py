"""The paper cites what its list of references has, and counts what is there."""

import re
import tomllib
from pathlib import Path

from knotwork.insertion import METHODS

PAPER = Path(__file__).parents[1] / "docs" / "paper"
TEXT = (PAPER / "paper.md").read_text(encoding="utf-8")


def test_every_reference_is_cited_and_every_citation_is_a_reference():
    references = re.findall(r"^@\w+\{(\w+),", (PAPER / "paper.bib").read_text(encoding="utf-8"), re.MULTILINE)
    assert len(references) == len(set(references))
    assert set(re.findall(r"@(\w+)", TEXT.split("bibliography:")[1])) == set(references)


def test_the_numbers_are_those_of_the_map_and_of_the_catalogue():
    book = tomllib.loads((PAPER.parent / "book" / "map.toml").read_text(encoding="utf-8"))
    equations = sum(len(numbers.split()) for numbers in book["equations"])
    assert f"{len(book['sections'])} sections and {equations} equations" in " ".join(TEXT.split())
    assert len(METHODS) == 50
    assert "fifty in all" in TEXT
