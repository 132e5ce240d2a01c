"""Every figure of chapter 7 is drawn, and its strokes are read as what the figure shows."""

import importlib
from pathlib import Path

import pytest

plt = pytest.importorskip("matplotlib.pyplot", reason="matplotlib is not installed")
FOLDER = Path(__file__).parents[2] / "docs" / "figures"


@pytest.fixture
def figures(monkeypatch):
    monkeypatch.syspath_prepend(FOLDER)
    return importlib.import_module("sketching")


def test_no_figure_of_the_chapter_is_missing(figures):
    drawn = {name.rstrip("abc") for names in figures.PICTURES.values() for name in names}
    assert drawn == {f"7.{i}" for i in range(1, 23)}
    assert {name for names in figures.PICTURES.values() for name in names} == set(figures.FIGURES)


@pytest.mark.parametrize("name", ["envelope", "shadow", "one-stroke", "crossings", "region", "degrees", "session"])
def test_the_strokes_of_a_figure_are_read_as_what_it_shows(figures, name):
    plt.close(figures.picture(figures.PICTURES[name]))
