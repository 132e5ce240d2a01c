"""Kernels: one source, plain and compiled alike bit for bit; when it is compiled; the cache never lies."""

from __future__ import annotations

import ast
import collections
import copy
import functools
import importlib
import importlib.machinery
import inspect
import os
import pkgutil
import stat
import subprocess
import sys
import textwrap
import types
from pathlib import Path

import numpy as np
import pytest

import knotwork as kw
from knotwork import insertion, progressive
from knotwork.arithmetic import kernel as kernels
from knotwork.arithmetic.kernel import Kernel
from knotwork.conversion.oslo import conversion_matrix, converted
from knotwork.insertion.methods import forms, perspectives
from knotwork.removal.outlines import outlined
from knotwork.removal.shapes.bezier import reduce_bezier
from knotwork.removal.shapes.lower import fewest_pieces
from knotwork.removal.shapes.polyline import reduce_polyline
from knotwork.removal.shapes.smooth import reduce_smooth

SOURCE = Path(kw.__file__).parent.parent
#: one process compiles all kernels, while others do the rest
compiling = pytest.mark.xdist_group("kernels")


def run(code, tmp_path=None, **environment):
    """Run Python code in a fresh process and return what it printed."""
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, filter(None, [tmp_path, SOURCE]))), **environment}
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", textwrap.dedent(code)],
        env=env,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


# ---- plain and compiled -------------------------------------------------------------------------------------------


def same(a, b):
    """Tell whether two results have the same bits."""
    if isinstance(a, tuple):
        return len(a) == len(b) and all(map(same, a, b))
    return np.asarray(a).tobytes() == np.asarray(b).tobytes()


def write_back(given, x):
    """Give what a call has written to an array, or to arrays in a tuple, to the caller."""
    if isinstance(given, tuple):
        for a, b in zip(given, x, strict=True):
            write_back(a, b)
    elif isinstance(given, np.ndarray) and given.flags.writeable:
        given[...] = x


@pytest.fixture
def both(monkeypatch):
    """Let every call of a kernel run plain and compiled on copies of its arguments; return the kernels called."""
    called = set()

    def call(self, *args):
        if any(isinstance(a, np.ndarray) and a.dtype == object for a in args):
            return self.plain(*args)
        plain, compiled = copy.deepcopy(args), copy.deepcopy(args)
        with np.errstate(all="ignore"):
            result = self.plain(*plain)
        other = self.compiled(*compiled)
        assert (result is None and other is None) or same(result, other), f"{self} returns {result} and {other}"
        for i, (given, x, y) in enumerate(zip(args, plain, compiled, strict=True)):
            assert not isinstance(given, np.ndarray | tuple) or same(x, y), f"{self}: argument {i} differs:\n{x}\n{y}"
            write_back(given, x)
        called.add(self)
        return result

    monkeypatch.setattr(Kernel, "__call__", call)
    return called


#: which kernels each battery called that has run: the last test asks for all of them, and none needs to run twice
TRIED: dict[tuple[object, ...], set[Kernel]] = {}


def battery(test):
    """Mark a test that runs kernels plain and compiled; called again, it only tells which kernels it called."""
    signature = inspect.signature(test)

    @functools.wraps(test)
    def run(*args, **kwargs):
        given = signature.bind(*args, **kwargs).arguments
        both, key = given["both"], (test.__name__, *(x for name, x in given.items() if name != "both"))
        if key not in TRIED:
            before = set(both)
            both.clear()
            test(**given)
            TRIED[key] = set(both)
            both |= before
        both |= TRIED[key]

    return pytest.mark.slow(compiling(run))


def points(rng, dtype, *shape):
    """Return numbers that need all their bits, so that each rounding shows."""
    P = rng.standard_normal(shape)
    return (P + 1j * rng.standard_normal(shape) if dtype is np.complex128 else P).astype(dtype)


def curves(dtype):
    """Yield curves of many kinds. Each degree and number of coordinates is compiled anew, so there are few."""
    rng = np.random.default_rng(0)
    for degree in (0, 3, 5) if dtype is np.float64 else (3,):  # 5: too many basis functions to unroll
        inner = np.sort(rng.random(9))
        if degree:
            inner[3:5] = inner[3]
        knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
        yield kw.curve(points(rng, dtype, degree + 10, 2), degree, knots)
        around = np.concatenate([[0.0], inner, [1.0]])
        yield kw.curve(points(rng, dtype, 10, 2), degree, around, periodic=True)
        unclamped = np.sort(rng.random(2 * degree + 8)) * 3
        if dtype is np.complex128:
            yield kw.curve(points(rng, dtype, degree + 7, 2), degree, unclamped)
        else:
            yield kw.curve(points(rng, dtype, degree + 7, 1), degree, unclamped, weights=1 + rng.random(degree + 7))
    if dtype is np.float64:
        yield kw.curve(points(rng, dtype, 9, 6), 5)  # more coordinates than are unrolled


def work_on(spline, axis=0):
    """Do to a spline all that the library does."""
    space = spline.spaces[axis]
    a, b = (float(x) for x in space.domain)
    inside = a + (b - a) * np.random.default_rng(1).random(12)
    middle = float(inside[0])
    kw.insert(spline, middle, axis=axis)
    for new in (inside[:2], np.repeat(inside[:2], space.order), inside):
        kw.insert(spline, new, axis=axis)
    kw.insertion_matrix(space, space.with_knots(inside))
    kw.split(spline, middle, axis=axis)
    kw.elevate(spline, 2, axis=axis)
    refined = space.with_knots(inside)
    conversion_matrix(refined, space)
    converted(space, refined, spline.coefficients, axis)
    kw.to_bezier(spline)
    u = [inside] * len(spline.spaces)
    spline(*u)
    spline(*u, grid=True)
    spline.derivatives(*u, 2)
    if not spline.rational:
        spline.derivative(axis=axis)
        spline.antiderivative(axis=axis)


@pytest.mark.parametrize("dtype", [np.float64, np.float32, np.complex128])
@battery
def test_plain_and_compiled_agree_on_curves(both, dtype):
    for curve in curves(dtype):
        work_on(curve)


@battery
def test_plain_and_compiled_agree_on_lowering(both):
    rng = np.random.default_rng(7)
    for periodic in (False, True):
        kw.lower(kw.curve(rng.standard_normal((9, 2)), periodic=periodic))


@battery
def test_plain_and_compiled_agree_on_surfaces(both):
    rng = np.random.default_rng(3)
    for shape, closed in (((6, 7, 2), (False, False)), ((6, 5, 2), (True, False))):
        surface = kw.surface(rng.standard_normal(shape), degree=(5, 3), periodic=closed)
        for axis in (0, 1):
            work_on(surface, axis)


@pytest.mark.parametrize("dtype", [np.float64, np.complex128])
@battery
def test_plain_and_compiled_agree_on_removal(both, dtype):
    """Points of float32 are fitted in float64."""
    rng = np.random.default_rng(4)
    for curve in curves(dtype):
        new = np.linspace(*map(float, curve.space.domain), 7)[1:-1]
        twice = np.repeat(new, min(2, curve.space.order))
        assert len(kw.remove(kw.insert(curve, twice), twice, tolerance=1e-9).removed) == len(twice)
        kw.remove(curve, curve.space.breaks[1:-1], tolerance=0.3)
    for degree in (1, 3):
        line = kw.curve(points(rng, dtype, 40, 2).cumsum(axis=0), degree)
        assert len(kw.reduce(line, 0.5, method="lyche-morken").removed)
        for closed in (False, True):
            few = kw.curve(points(rng, dtype, 12, 2).cumsum(axis=0), degree, periodic=closed)
            assert len(kw.reduce(few, 0.5, effort="fast").removed)
    kw.reduce(kw.curve(points(rng, dtype, 20, 2).cumsum(axis=0)), 2.0, effort="best")  # which squeezes knots out
    net = kw.surface(points(rng, dtype, 9, 4, 2))
    kw.remove(net, net.spaces[0].breaks[1:-1], tolerance=1.0)
    kw.reduce(net, 0.5, effort="best")


@battery
def test_plain_and_compiled_agree_on_elimination(both):
    space = kw.SplineSpace.clamped(3, 7)
    kw.stability.condition(space, space.with_knots([0.1, 0.5, 0.7]))


@pytest.mark.parametrize(
    ("knots", "dtype"),
    [(np.float64, np.float64), (np.float64, np.float32), (np.float64, np.complex128), (np.complex128, np.complex128)],
)
@battery
def test_plain_and_compiled_agree_on_progressive_curves(both, knots, dtype):
    """Complex knots have variants of their own: complex quotients."""
    rng = np.random.default_rng(5)
    for degree in (3, 0, 22):  # always four numbers to loop over, so that all is compiled once
        t, u = (points(rng, knots, 2 * degree) for _ in range(2))
        t[degree // 2 : degree] = t[degree // 2 : degree][:1]  # knots repeated
        c = progressive.Curve(t, points(rng, dtype, degree + 1, 4))
        x = points(rng, knots, 4)
        for work in (c, c.derivatives, c.basis, c.dual):
            work(x)
        c.blossom(*[progressive.DELTA, *x, *x, *u][:degree])
        c.derivative()
        c.integrate(x[0], x[1])
        c.dual_functional(degree // 2, points(rng, dtype, degree + 1, 4), x[2])
        for method in progressive.METHODS:
            progressive.change_basis(c, u, method)
        for times in range(1, min(degree, 3) + 1):
            progressive.insert(c, u[0], times)
        progressive.evenly_spaced(c, x[0], x[1], 5)
    mixed = [progressive.DELTA, (x[0], x[1]), x[2], x[3], (x[1], x[0]), (x[3], 2)]
    c = progressive.Curve(mixed, points(rng, dtype, 4, 4))
    for work in (c, c.derivatives, c.basis, functools.partial(c.basis, way="up"), c.dual):
        work(x)
    progressive.divided_differences(np.repeat(x, 2), points(rng, dtype, 8, 4))
    progressive.newton_dual_by_differences(np.repeat(x, 2), x)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@battery
def test_plain_and_compiled_agree_on_methods_of_insertion(both, dtype):
    """Every method compiles a kernel, which takes about a second, so each has one degree and one number of coordinates.

    Old and new knots repeat. One interval gets more than a group of 3n + 1 knots, some evenly spaced, the next one.
    """
    rng = np.random.default_rng(6)
    evenly = (2 + np.arange(8)) / 16
    new = np.concatenate([rng.random(3) / 16, evenly, np.repeat(0.6 + rng.random(2) / 4, 2), [1.0, 1.5, 2.75]])
    curve = kw.curve(points(rng, dtype, 9, 2), 3, [-1.5, -1, -0.75, 0, 1, 1, 2, 2.25, 3, 3, 3, 3.5, 4])
    few = ["boehm-multiple-rewritten", "goldman-sablonniere-recursive-factored", "factored-equal", "goldman-column",
           "factored-reduced", "boehm-column", "morken", "merge"]  # fmt: skip
    for name in insertion.METHODS if dtype is np.float64 else few:
        kw.insert(curve, new, method=name)
    start = insertion.Startup(curve)
    start.blossom(rng.random(3))
    start.vertices(rng.random(4))


def test_plain_and_compiled_agree_on_shapes(both):
    rng = np.random.default_rng(7)
    line = points(rng, np.float64, 30, 2).cumsum(axis=0)
    line[-1] = line[0]
    for closed in (True, False):
        reduce_polyline(line, 1.0, closed=closed)
        reduce_polyline(line, 1.0, closed=closed, strict=1 + rng.random(29))
    fewest_pieces(line, 1.0, 1)
    a = kw.curve(line[:7], 3)
    for b in (kw.insert(a, [0.3]), kw.curve(line[:7] + 0.01, 1), kw.curve(line[:7], 3, weights=1 + rng.random(7))):
        kw.distance_bound(a, b)
    kw.distance_bound(a, kw.curve(line[:7] + 0.1, 2), [0.5, 0.5])
    edges = np.stack([line[:-1], line[1:]], axis=1)
    for effort, closed in (("normal", True), ("best", False)):
        reduce_bezier(edges, [0, 12, 29], [0.3, 0.2], closed=closed, angle=170.0, keep=[5], lines=True, effort=effort)
    reduce_bezier(edges, [0, 12, 29], 0.3, degree=2, effort="best")
    wild = np.cumsum(np.random.default_rng(2).standard_normal((12, 2)) * 6, axis=0)
    reduce_bezier(np.stack([wild[:-1], wild[1:]], axis=1), [0, 11], 2.0)  # one that needs repair
    around = {"closed": True, "periodic": True, "angle": None, "lines": False, "keep": (), "rational": False}
    for tolerance in (0.5, 4.0):  # a loop of few points, and one of fewer
        reduce_smooth(edges, tolerance, effort="fast", crossings="none-new", **around)
    opened = {**around, "closed": False, "periodic": False}
    reduce_smooth(edges[:6], 0.5, effort="best", crossings="none-new", **opened)  # which relaxes
    bent = np.array([[0, 0], [0, 55], [45, 100], [100, 100], [155, 100], [200, 55], [200, 0], [190, -160], [10, -170]])
    ring = [bent[[0, 1, 2, 3]], bent[[3, 4, 5, 6]], bent[[6, 7, 8, 0]]]
    for into in (True, False):
        outlined([each.astype(float) for each in ring], 0.75, cubic=True, into=into)


@battery
def test_plain_and_compiled_agree_on_geometry(both):
    rng = np.random.default_rng(8)
    for degree, closed in ((3, False), (2, True)):
        f = kw.curve(rng.standard_normal(40), degree, periodic=closed)
        kw.zeros(f)
        kw.zeros(f, 1)
    kw.zeros(kw.curve([1.0, -1, 0, -1, 1], 2, [0, 0, 0, 1, 1, 2, 2, 2]))
    kw.frame(kw.curve(rng.standard_normal((5, 3))), [0.0, 0.5])
    kw.flatten(kw.curve(rng.standard_normal((5, 3))), 0.1)
    kw.flatten(kw.surface(rng.standard_normal((5, 5, 3))), 0.5)
    kw.closest(kw.curve(rng.standard_normal((12, 3))), rng.standard_normal((20, 3)))
    kw.closest(kw.surface(rng.standard_normal((4, 5, 3)), (2, 3)), rng.standard_normal((4, 3)))
    loop = kw.curve([[0, 0], [3, 2], [-2, 2], [1, 0]])
    kw.intersect(loop)
    kw.intersect(loop, kw.curve([[0, 0.5], [1, 0.7]], 1))
    hills = kw.surface(np.stack([*np.meshgrid(range(4), range(3), indexing="ij"), rng.random((4, 3))], axis=-1), (2, 1))
    kw.intersect(kw.curve([[0.5, 0.5, 0], [1, 1, 1], [2, 1.5, 0]], 2), hills)
    kw.intersect(kw.curve([[0, 1], [1, -1], [2, 1]], 2), kw.curve([[0, 0], [2, 0]], 1))


#: what stands for kernels that are bound by name, and texts that call them: these run as variants alone
TEMPLATES = {
    *(getattr(perspectives, name) for name in ("step", "vertex", "segment")),
    *(getattr(perspectives, name) for name in ("by_intervals", "by_vertices", "by_segments")),
    forms.insert_right_knots,
}


def import_all():
    """Import every module, so that every kernel is among those known."""
    for module in pkgutil.walk_packages(kw.__path__, "knotwork."):
        if module.name.rpartition(".")[2] != "__main__":
            importlib.import_module(module.name)


@pytest.mark.slow
@compiling
def test_every_kernel_is_tried(both):
    """A new kernel that nothing here reaches fails: let `work_on` do what needs it."""
    import_all()
    test_plain_and_compiled_agree_on_curves(both, np.float64)
    test_plain_and_compiled_agree_on_surfaces(both)
    test_plain_and_compiled_agree_on_removal(both, np.float64)
    test_plain_and_compiled_agree_on_progressive_curves(both, np.float64, np.float64)
    test_plain_and_compiled_agree_on_progressive_curves(both, np.complex128, np.complex128)
    test_plain_and_compiled_agree_on_elimination(both)
    test_plain_and_compiled_agree_on_lowering(both)
    test_plain_and_compiled_agree_on_shapes(both)
    test_plain_and_compiled_agree_on_geometry(both)
    test_plain_and_compiled_agree_on_methods_of_insertion(both, np.float64)
    reached = set(both) | TEMPLATES
    while below := {callee for caller in reached for _, callee in caller._callees()} - reached:
        reached |= below
    missing = [k for k in kernels.KERNELS if k not in reached and (k.source.__module__ or "").startswith("knotwork.")]
    assert not missing


# ---- when it is compiled ------------------------------------------------------------------------------------------

SMALL = """
    import sys
    import knotwork as kw
    c = kw.curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    kw.insert(kw.insert(c, [0.25, 0.75]), 0.5)(0.3)
    print("numba" in sys.modules)
"""


def test_import_loads_nothing_heavy():
    heavy = ["numba", "scipy", "matplotlib", "svgelements", "llvmlite", "click"]
    assert run(f"import sys, knotwork; print([m for m in {heavy} if m in sys.modules])") == "[]"


@pytest.mark.parametrize(("mode", "loaded"), [("auto", "False"), ("never", "False"), ("always", "True")])
def test_small_work_stays_plain(mode, loaded):
    assert run(SMALL, KNOTWORK_JIT=mode) == loaded


@pytest.mark.parametrize(("mode", "loaded"), [("auto", "True"), ("never", "False")])
def test_large_work_is_compiled(mode, loaded):
    code = """
        import sys
        import numpy as np, knotwork as kw
        n = 200_000 if sys.argv[-1] != "never" else 1000
        kw.insert(kw.curve(np.zeros((n, 3))), [0.2, 0.3])
        print("numba" in sys.modules)
    """
    assert run(code.replace("sys.argv[-1]", repr(mode)), KNOTWORK_JIT=mode) == loaded


def test_an_unknown_mode_is_an_error():
    code = """
        import knotwork as kw
        import knotwork.errors
        try:
            kw.curve([0, 1, 2, 3])(0.5)
        except kw.errors.ParameterError as error:
            print(error)
    """
    message = run(code, KNOTWORK_JIT="sometimes")
    assert "KNOTWORK_JIT" in message
    assert "'sometimes'" in message
    assert "auto, always, never" in message


def test_modes_give_the_same_bits():
    code = """
        import hashlib
        import numpy as np, knotwork as kw
        rng = np.random.default_rng(0)
        c = kw.insert(kw.curve(rng.standard_normal((30, 3))), rng.random(40))
        print(hashlib.sha256(c.coefficients.tobytes() + c(rng.random(50)).tobytes()).hexdigest())
    """
    assert run(code, KNOTWORK_JIT="never") == run(code, KNOTWORK_JIT="always")


def test_overflow_is_as_silent_plain_as_compiled():
    code = """
        import knotwork as kw
        c = kw.curve([1e300, -1e300, 1e300, -1e300])
        print(c(1e10, extrapolate=True))
    """
    assert run(code, KNOTWORK_JIT="never") == run(code, KNOTWORK_JIT="auto") == run(code, KNOTWORK_JIT="always")


# ---- the cache ----------------------------------------------------------------------------------------------------

ABOVE = """
    from knotwork.arithmetic.kernel import kernel
    from edited.below import term
    FACTOR = {factor}

    @kernel
    def total(x):
        s = 0.0
        for i in range(len(x)):
            s = s + FACTOR * term(x[i])
        return s
"""
BELOW = """
    from knotwork.arithmetic.kernel import kernel

    @kernel
    def term(x):
        return x {operation}
"""


def write_package(tmp_path, operation="+ 1", factor=1):
    """Write a package of two kernels in two files, one calling the other."""
    package = tmp_path / "edited"
    package.mkdir(exist_ok=True)
    (package / "__init__.py").touch()
    (package / "above.py").write_text(textwrap.dedent(ABOVE.format(factor=factor)))
    (package / "below.py").write_text(textwrap.dedent(BELOW.format(operation=operation)))
    for path in package.glob("*.py"):  # not even the time of the file tells
        os.utime(path, (1, 1))


def call_package(tmp_path, cache):
    """Call the kernel compiled in a fresh process; return its digest, its result and how often the cache was hit."""
    code = """
        import numpy as np
        from edited.above import total
        print(total.digest, total(np.array([1.0, 2.0])), sum(total.compiled.stats.cache_hits.values()))
    """
    out = run(code, tmp_path, KNOTWORK_JIT="always", KNOTWORK_CACHE=str(cache), PYTHONDONTWRITEBYTECODE="1")
    digest, value, hits = out.split()
    return digest, float(value), int(hits)


def test_editing_what_a_kernel_calls_or_uses_is_seen(tmp_path):
    digests = []
    for operation, factor, expected in (("+ 1", 1, 5.0), ("* 10", 1, 30.0), ("* 10", 3, 90.0), ("+ 1", 1, 5.0)):
        write_package(tmp_path, operation, factor)
        digest, value, hits = call_package(tmp_path, tmp_path / "cache")
        assert value == expected
        assert hits == digests.count(digest)  # what was compiled before is found again
        digests.append(digest)
    assert len(set(digests)) == 3


@pytest.mark.parametrize("kind", ["a file", "read-only", "below a file"])
def test_without_a_writable_cache_it_compiles_all_the_same(tmp_path, kind):
    place = tmp_path / "cache"
    if kind == "read-only":
        place.mkdir()
        place.chmod(stat.S_IRUSR | stat.S_IXUSR)
    else:
        place.write_text("not a directory")
    write_package(tmp_path)
    _, value, hits = call_package(tmp_path, place / "deeper" if kind == "below a file" else place)
    assert (value, hits) == (5.0, 0)
    assert not list((tmp_path / "edited").rglob("*.nb?"))  # nor beside the source
    assert kind == "read-only" or place.read_text() == "not a directory"


def test_a_variant_binds_names_anew(monkeypatch):
    monkeypatch.setattr(kernels, "KERNELS", [])
    up, down = kernels.kernel(lambda x: x + 1), kernels.kernel(lambda x: x - 1)
    monkeypatch.setitem(globals(), "step", up)
    twice = kernels.kernel(lambda x: step(step(x)))  # noqa: F821
    assert twice.plain(3) == 5
    variant = twice.variant(step=down)
    assert variant.plain(3) == 1
    assert variant.digest != twice.digest
    known = len(kernels.KERNELS)
    monkeypatch.setitem(globals(), "again", twice)
    both = kernels.kernel(lambda x: again(x) + step(x))  # noqa: F821
    assert both.variant(step=down, again=up).plain(3) == 6
    assert len(kernels.KERNELS) == known + 2  # what is replaced is not made anew


def test_a_kernel_that_moves_to_another_module_is_another(monkeypatch):
    """The cache on disk names the module: what was compiled elsewhere would not load."""
    monkeypatch.setattr(kernels, "KERNELS", [])
    digests = set()
    for module in ("here", "there"):
        names = {"__name__": module}
        exec("def same(x):\n    return x + 1", names)
        digests.add(kernels.kernel(names["same"]).digest)
    assert len(digests) == 2


#: kernels of searches that still take more
LONG = {"follow", "fitted", "weights_of_row", "squeeze_out"}
LONG |= {"descended", "fitted_window", "tried", "longest", "measured", "measured_bound", "measured_frame", "closed_up"}


def test_a_kernel_takes_at_most_eight_arguments():
    """Working space is a named tuple."""
    import_all()
    own = [k.source for k in kernels.KERNELS if (k.source.__module__ or "").startswith("knotwork.")]
    assert {f.__name__ for f in own if f.__code__.co_argcount > 8} <= LONG


def test_a_named_tuple_with_other_fields_makes_another_kernel(monkeypatch):
    """A kernel may make one: what was compiled for fields in another order must not be loaded."""
    monkeypatch.setattr(kernels, "KERNELS", [])
    digests = set()
    for fields in ("x y", "y x"):
        names = {"Pair": collections.namedtuple("Pair", fields), "__name__": "here"}
        exec("def make(x):\n    return Pair(x, x + 1).y", names)
        digests.add(kernels.kernel(names["make"]).digest)
    assert len(digests) == 2


def test_only_kernels_go_without_types():
    untyped = []
    for path in sorted((SOURCE / "knotwork").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.returns is None:
                marks = {ast.unparse(mark).partition("(")[0] for mark in node.decorator_list}
                if "kernel" not in marks and node.name not in ("__init__", "__init_subclass__"):
                    untyped.append(f"{path.name}:{node.lineno} {node.name}")
    assert untyped == []


def test_compiled_code_that_checks_indices_is_kept_apart():
    """NUMBA_BOUNDSCHECK changes what is compiled, so it changes the name under which it is kept; then errors show."""

    def said(program: str, checked: str) -> str:
        environment = {**os.environ, "NUMBA_BOUNDSCHECK": checked}
        command = [sys.executable, "-c", f"import numpy as np\nfrom knotwork.knots import last_at_most\n{program}"]
        run = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
        return run.stdout + run.stderr

    assert said("print(last_at_most.digest)", "0") != said("print(last_at_most.digest)", "1")
    assert "IndexError" in said("last_at_most.compiled(np.zeros(3), 0, 50, 1.0)", "1")


def test_what_only_kernels_call_is_no_machine_code_of_its_own(tmp_path):
    """Numba would optimise each kernel again in each that calls it: only what Python calls is optimised and kept."""
    write_package(tmp_path)
    code = """
        import numpy as np
        from numba.core import codegen
        from edited.above import total
        from edited.below import term
        optimised = []
        optimise = codegen.CPUCodeLibrary._optimize_final_module
        codegen.CPUCodeLibrary._optimize_final_module = lambda self: (optimised.append(self.name), optimise(self))
        assert total(np.array([1.0, 2.0])) == 5.0
        assert [name for name in optimised if name == "term"] == [], optimised
        assert [name for name in optimised if name == "total"] == ["total"], optimised
        assert term(2.0) == 3.0 and "term" in optimised  # called from Python it is a whole
    """
    run(code, tmp_path, KNOTWORK_JIT="always", KNOTWORK_CACHE=str(tmp_path / "cache"), PYTHONDONTWRITEBYTECODE="1")
    kept = {path.parent.parent.name.partition("-")[0] for path in (tmp_path / "cache").rglob("*.nbc")}
    assert kept == {"total", "term"}


def test_work_goes_on_plain_while_another_thread_imports_numba(monkeypatch):
    numba = types.ModuleType("numba")
    numba.__spec__ = importlib.machinery.ModuleSpec("numba", None)
    monkeypatch.setitem(sys.modules, "numba", numba)
    assert kernels._numba_is_there()
    numba.__spec__._initializing = True
    assert not kernels._numba_is_there()
    monkeypatch.delitem(sys.modules, "numba")
    assert not kernels._numba_is_there()
