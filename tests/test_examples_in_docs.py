"""The examples in docstrings, in the README and in the pages of docs/ run and give what they say."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
import re
import shutil
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import knotwork as kw

ROOT = Path(__file__).parent.parent
MODULES = ["knotwork", *(m.name for m in pkgutil.walk_packages(kw.__path__, "knotwork.") if "__main__" not in m.name)]
OPTIONS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


def blocks(page):
    """Return the Python blocks of a page."""
    return re.findall(r"^```python\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE)


PAGES = [page for page in sorted((ROOT / "docs").rglob("*.md")) if blocks(page)]


def examples(name):
    """Return the doctests of a module that have examples."""
    module = importlib.import_module(name)
    return [test for test in doctest.DocTestFinder(exclude_empty=True).find(module, name) if test.examples]


@pytest.mark.parametrize("test", [test for name in MODULES for test in examples(name)], ids=lambda test: test.name)
def test_the_examples_of_a_docstring(test, tmp_path, monkeypatch):
    if any("plot" in example.source for example in test.examples):
        pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    told = []
    runner = doctest.DocTestRunner(optionflags=OPTIONS)
    assert runner.run(test, out=told.append).failed == 0, "".join(told)


def test_the_main_names_have_examples():
    found = {test.name.rpartition(".")[2] for name in MODULES for test in examples(name)}
    assert found >= {"SplineSpace", "Spline", "curve", "insert", "remove", "reduce", "to_bezier", "elevate"}


def run(block, name, names):
    """Run a block of a page, and check what it shows if it is a session with `>>>`; names defined are kept."""
    if not block.startswith(">>>"):
        exec(compile(block, name, "exec"), names)
        return
    told = []
    test = doctest.DocTestParser().get_doctest(block, names, name, name, 0)
    runner = doctest.DocTestRunner(optionflags=OPTIONS)
    assert runner.run(test, out=told.append, clear_globs=False).failed == 0, "".join(told)
    names.update(test.globs)


def test_the_python_of_the_readme(tmp_path, monkeypatch):
    """All blocks one after another, as a reader would paste them."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    names = {}
    for k, block in enumerate(blocks(ROOT / "README.md")):
        run(block, f"README.md, block {k}", names)
        if k == 0:
            check_the_first_block(names, tmp_path)
    check_the_last_block(names)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT / "docs").as_posix())
def test_the_python_of_a_page(page, tmp_path, monkeypatch):
    """All blocks one after another; a page says what is true by `assert` and by sessions."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    whole = "\n".join(blocks(page))
    assert "assert" in whole or ">>>" in whole
    names = {}
    for k, block in enumerate(blocks(page)):
        run(block, f"{page.name}, block {k}", names)


def test_the_pictures_of_the_pages_are_there():
    """Each link to a file of the house leads to one."""
    for page in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")]:
        for link in re.findall(r"\]\(([^)#]+)[^)]*\)", re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)):
            if "://" not in link:
                assert (page.parent / link).exists(), f"{page.relative_to(ROOT)} links to {link}"


def check_the_first_block(names, place):
    """What the comments beside the lines say."""
    c, finer, small = names["c"], names["finer"], names["small"]
    u = np.linspace(0, 1, 50)
    np.testing.assert_allclose(finer(u), c(u), atol=1e-14)
    assert finer.space.multiplicity(0.5) == 2
    assert kw.remove(finer, [0.25, 0.5, 0.5], tolerance=1e-12).bound <= 1e-13
    assert [names[part].space.domain for part in ("left", "right")] == [(0, 0.3), (0.3, 1)]
    assert names["nets"].shape == (3, 4, 2)
    assert small.bound <= 2
    assert small.spline.degree == (3,)
    written = kw.read(place / "coast.svg")
    assert len(written) == 1
    assert written[0].space.periodic


def check_the_last_block(names):
    """What the comments beside the lines say, of a curve with the points (0, 0), (1, 2), (3, 0)."""
    p = names["p"]
    assert p.blossom(Fraction(1, 3), kw.progressive.DELTA).tolist() == [Fraction(4, 3), Fraction(2, 3)]
    assert kw.progressive.change_basis(p, kw.progressive.monomial(2)).control.tolist() == [[0, 0], [1, 2], [1, -4]]
