"""The examples in docstrings and in the README run and give what they say."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

import knotwork as kw

ROOT = Path(__file__).parent.parent
MODULES = ["knotwork", *(m.name for m in pkgutil.walk_packages(kw.__path__, "knotwork.") if "__main__" not in m.name)]
BLOCKS = re.findall(r"^```python\n(.*?)^```", (ROOT / "README.md").read_text(), re.DOTALL | re.MULTILINE)


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
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    assert runner.run(test, out=told.append).failed == 0, "".join(told)


def test_the_main_names_have_examples():
    found = {test.name.rpartition(".")[2] for name in MODULES for test in examples(name)}
    assert found >= {"SplineSpace", "Spline", "curve", "insert", "remove", "reduce", "to_bezier", "elevate"}


def test_the_python_of_the_readme(tmp_path, monkeypatch):
    """All blocks one after another, as a reader would paste them."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    assert len(BLOCKS) >= 2
    names = {}
    for k, block in enumerate(BLOCKS):
        exec(compile(block, f"README.md, block {k}", "exec"), names)
        if k == 0:
            check_the_first_block(names, tmp_path)


def check_the_first_block(names, place):
    """What the comments beside the lines say."""
    c, finer, small = names["c"], names["finer"], names["small"]
    u = np.linspace(0, 1, 50)
    np.testing.assert_allclose(finer(u), c(u), atol=1e-14)
    assert finer.space.multiplicity(0.5) == 2
    assert kw.remove(finer, [0.25, 0.5, 0.5], tolerance=1e-12).bound <= 1e-14
    assert [names[part].space.domain for part in ("left", "right")] == [(0, 0.3), (0.3, 1)]
    assert names["nets"].shape == (3, 4, 2)
    assert small.bound <= 2
    assert small.spline.degree == (3,)
    written = kw.read(place / "coast.svg")
    assert len(written) == 1
    assert written[0].space.periodic
