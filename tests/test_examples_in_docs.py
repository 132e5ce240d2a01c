"""The examples in docstrings, in the README and in the pages of docs/ run and give what they say."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pkgutil
import re
import shutil
from pathlib import Path

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


PARTS = ("arithmetic", "diagrams", "insertion", "progressive", "stability")
#: values, not functions or classes
NUMBERS = {"__version__", "DELTA", "METHODS", "ANIMATIONS", "FIGURES", "SCHEMES"}
#: what other rooms of the house call
INNER = [
    "axis",
    "by_axis",
    "cached",
    "inside",
    "new_knots",
    "of",
    "refined_by",
    "refinement",
    "rounded_inside",
    "trusted",
    "with_axis",
]


def public(module):
    """Return the names that a module offers, but for those of modules and of values."""
    return [name for name in dir(module) if name not in {*PARTS, "errors", *NUMBERS}]


def shows(thing, name):
    """Tell whether the help of a thing has an example that uses it."""
    lines = [line for line in inspect.getdoc(thing).splitlines() if line.startswith((">>>", "..."))]
    return any(name in line for line in lines)


@pytest.mark.parametrize("name", public(kw))
def test_every_name_of_the_face_has_an_example_that_can_be_pasted(name):
    help_of = inspect.getdoc(getattr(kw, name))
    assert ">>> import knotwork as kw" in help_of or "numpy as np, knotwork as kw" in help_of
    assert shows(getattr(kw, name), "kw.")


@pytest.mark.parametrize("part", PARTS)
def test_every_name_of_a_part_has_an_example(part):
    module = getattr(kw, part)
    without = [
        name for name in public(module) if name in module.__all__ and ">>>" not in inspect.getdoc(getattr(module, name))
    ]
    assert not without


@pytest.mark.parametrize("kind", [kw.Spline, kw.SplineSpace])
def test_every_method_has_an_example(kind):
    methods = [name for name, _ in inspect.getmembers(kind, inspect.isroutine) if not name.startswith("_")]
    assert not [name for name in methods if name not in INNER and not shows(getattr(kind, name), name)]


def test_the_page_of_names_has_them_all():
    """Those of the face, and the methods and attributes of splines and spaces; and no other."""
    page = (ROOT / "docs" / "reference.md").read_text()
    listed = re.findall(r"^- `kw\.([\w.]+)", page, re.MULTILINE)
    of_kinds = [f"{kind.__name__}.{name}" for kind in (kw.Spline, kw.SplineSpace) for name in dir(kind)]
    of_parts = [f"{part}.{name}" for part in ("insertion", "stability") for name in getattr(kw, part).__all__]
    names = [name for name in [*dir(kw), *of_kinds, *of_parts] if not name.rpartition(".")[2].startswith("_")]
    known = {name for name in names if name.rpartition(".")[2] not in INNER}
    assert len(listed) == len(set(listed))
    lacking = {name for name in known if name not in listed and not name.startswith("insertion.")}
    assert not lacking, f"docs/reference.md lacks {sorted(lacking)}"
    assert not set(listed) - known, "docs/reference.md lists what is not there"


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


def test_the_site_has_all_pages():
    """Those that docs/conf.py makes are in its list as well."""
    listed = re.findall(r"(?:file|root): (\S+)", (ROOT / "docs" / "toc.yml").read_text())
    pages = {page.relative_to(ROOT / "docs").with_suffix("").as_posix() for page in (ROOT / "docs").rglob("*.md")}
    made = {"made/names", "made/commands"}
    assert len(listed) == len(set(listed))
    assert set(listed) == {page for page in pages if not page.startswith("paper/")} | made
