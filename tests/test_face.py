"""The face: what there is, what type checkers know of it, and what is said of a wrong name."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import get_args

import pytest

import knotwork as kw
from knotwork.insertion.names import MethodName

SOURCE = Path(kw.__file__).parent.parent

#: a user's file: what a checker should know, and lines it must refuse
USER = """
    from typing import assert_type
    import numpy as np
    from numpy.typing import NDArray
    from typing import Any
    import knotwork as kw

    c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    assert_type(c, kw.Spline)
    assert_type(c(0.5), NDArray[Any])
    assert_type(kw.convert(c, c.space).spline, kw.Spline)
    assert_type(kw.convert(c, "bezier").spline, kw.PolynomialPieces)
    assert_type(kw.lower(c).spline, kw.Spline)
    assert_type(kw.reduce(c, 0.1).spline, kw.Spline)
    assert_type(kw.insert(c, {0: [0.5]}, method="oslo").points, NDArray[Any])
    A = kw.insertion_matrix(c.space, c.space.with_knots(0.5))
    (A.T @ A).toarray()
    assert_type(A @ c.points, NDArray[Any])
    try:
        c.space.without_knots(0.5)
    except kw.KnotError:
        pass
    assert_type(kw.insertion.METHODS["oslo"].run(c, 0.5), kw.Spline)
    net = kw.surface(np.zeros((4, 5, 3)))
    assert_type(kw.volume(np.zeros((4, 4, 4, 3))), kw.Spline)
    assert_type(kw.elevate(net, {0: 1, 1: 2}), kw.Spline)
    assert_type(kw.elevate(net, (1, None)), kw.Spline)
    assert_type(kw.trim(net, {0: (0.25, 0.5)}), kw.Spline)
    assert_type(kw.convert(net, {0: c.space}).spline, kw.Spline)
    assert_type(kw.convert(net, [None, c.space]).bound, Any)
    assert_type(net.isocurve(0.5, axis=1).with_domain(0, 2), kw.Spline)
    assert_type(kw.join(c, c, tolerance=1e-9).spline, kw.Spline)
    assert_type(kw.join([c, c]).exact, bool)
    assert_type(kw.close(c, tolerance=10).spline.with_seam(0.25), kw.Spline)
    assert_type(kw.unify([c, c], merge=1e-9).splines, tuple[kw.Spline, ...])
    assert_type(kw.interpolate([[0, 0], [1, 1]], "centripetal", 1, periodic=False), kw.Spline)
    assert_type(kw.extraction(c.space), kw.Extraction)
    assert_type(kw.extraction(net), tuple[kw.Extraction, ...])
    assert_type(kw.extraction(c.space).operators, NDArray[Any])
    B = c.space.basis([0, 0.5], derivative=1)
    assert_type(B @ c.points, NDArray[Any])
    assert_type(B.T.shape, tuple[int, int])
    assert_type(c * c + 2 * c - 1, kw.Spline)
    assert_type(-c / 2, kw.Spline)
    assert_type(c.derivative(order=2), kw.Spline)
    assert_type(kw.SplineSpace.from_breaks(2, [0, 1, 2], [3, 1, 3]), kw.SplineSpace)
    assert_type(kw.SplineSpace.from_opennurbs(3, [0, 0, 0, 1, 1, 1]), kw.SplineSpace)
    kw.split(c, 0.5)[2]  # refused
    kw.unify(c, near=1)  # refused
    kw.interpolate(c.points, periodc=True)  # refused
    c.isocurves(0.5)  # refused
    kw.nosuch  # refused
    kw.insert(c, 0.5, method="bohm")  # refused
    kw.convert(c, c.space, how="magic")  # refused
    kw.lower(c, ends="stay")  # refused
"""


def test_dir_is_what_a_user_needs_and_nothing_else():
    assert dir(kw) == sorted([*kw.__all__, "__version__"])
    assert {"KnotError", "errors", "insertion", "insert", "volume", "curve"} <= set(dir(kw))
    assert not {"Any", "importlib", "TYPE_CHECKING"} & set(vars(kw))
    for name in dir(kw):
        getattr(kw, name)


def test_a_wrong_name_suggests_the_nearest():
    with pytest.raises(AttributeError, match="no attribute 'inserts'") as refused:
        _ = kw.inserts
    assert refused.value.name == "inserts"
    assert refused.value.obj is kw
    c = kw.curve([0, 1, 2, 3])
    for wrong, right in [("bohm", "boehm"), ("oslo-improve", "oslo-improved")]:
        with pytest.raises(kw.ParameterError, match=rf"method '{wrong}' given; did you mean '{right}'\?") as told:
            kw.insert(c, 0.5, method=wrong)
        assert len(str(told.value)) < 120
    with pytest.raises(kw.ParameterError, match="method 7 given; expected 'auto' or one of"):
        kw.insert(c, 0.5, method=7)


def test_the_names_that_type_checkers_know_are_those_of_the_catalogue():
    assert get_args(MethodName) == ("auto", *kw.insertion.METHODS)


@pytest.mark.parametrize("checker", [["mypy", "--strict"], ["pyright"]], ids=lambda command: command[0])
def test_a_type_checker_over_a_users_file(checker, tmp_path):
    pytest.importorskip(checker[0])
    user = tmp_path / "user.py"
    user.write_text(textwrap.dedent(USER))
    (tmp_path / "pyrightconfig.json").write_text('{"reportUnusedExpression": false, "reportUnusedImport": false}')
    done = subprocess.run(
        [sys.executable, "-m", *checker, user.name],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(SOURCE), "MYPYPATH": str(SOURCE)},
        capture_output=True,
        text=True,
    )
    told = [line for line in done.stdout.splitlines() if "error" in line and user.name in line]
    refused = [k for k, line in enumerate(user.read_text().splitlines(), 1) if line.endswith("# refused")]
    assert sorted({int(line.split(":")[1]) for line in told}) == refused, done.stdout + done.stderr


def test_the_face_loads_nothing_before_it_is_used():
    code = (
        "import sys, knotwork; print(sorted({m.split('.')[0] for m in sys.modules} & {'knotwork', 'numpy', 'numba'}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": str(SOURCE)}, capture_output=True, text=True
    )
    assert done.stdout.strip() == "['knotwork']", done.stderr
