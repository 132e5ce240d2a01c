"""Diagrams: what they say is true, by the definition of the blossom; and it can be read."""

from __future__ import annotations

import itertools
import math
import re
from collections import Counter, defaultdict
from fractions import Fraction
from xml.etree import ElementTree

import numpy as np
import pytest

import oracle
from knotwork.arithmetic.counting import Counting, counting
from knotwork.diagrams import SCHEMES, diagram, figure
from knotwork.diagrams.drawing import Box
from knotwork.diagrams.layout import Layout
from knotwork.diagrams.lettering import parts, width
from knotwork.diagrams.progressive_figures import FIGURES
from knotwork.diagrams.recording import combined, given
from knotwork.diagrams.symbols import Expression, knot, knots
from knotwork.errors import KnotError, ParameterError
from knotwork.progressive import DELTA, METHODS, Curve, change_basis

UPWARD = [name for name, scheme in SCHEMES.items() if not scheme.downward]
SVG = "{http://www.w3.org/2000/svg}"
NAME = r"[a-z](?:[₀-₉]+|_\{[^}]*\})?"


def value_of(name):
    """A number for each name, as far from any pattern as can be."""
    return Fraction(sum(ord(c) ** (i + 2) for i, c in enumerate(name)) % 9973, 7 + ord(name[0]) % 13)


def read_factor(text, value_of=value_of):
    """The number that an edge's label stands for: a sum of products of names and whole numbers."""
    total = Fraction(0)
    for sign, number, product in re.findall(rf"([+−]?)\s*(\d*)((?:{NAME})*)", text):
        if number or product:
            names = map(value_of, re.findall(NAME, product))
            total += (-1 if sign == "−" else 1) * int(number or 1) * math.prod(names)
    return total


def read_knot(text):
    """The pair that an argument stands for."""
    if text == "δ":
        return Fraction(1), Fraction(0)
    if "\u0302" in text:
        name = text.replace("\u0302", "")
        return value_of(name), value_of({"t": "w", "u": "v"}[name[0]] + name[1:])
    return (Fraction(text) if text.isdigit() else value_of(text)), Fraction(1)


def blossom(polynomial, knots):
    """The multilinear blossom by symmetric sums: tᵏ becomes the mean of all products of k of the t, n - k of the w."""
    n = len(knots)
    sums = [Fraction(1)] + [Fraction(0)] * n
    for t, w in knots:
        sums = [w * sums[k] + (t * sums[k - 1] if k else 0) for k in range(n + 1)]
    return sum(a * s / math.comb(n, k) for k, (a, s) in enumerate(zip(polynomial, sums, strict=True)))


def incoming(scheme):
    """The edges into each node that has any, from left to right."""
    found = defaultdict(list)
    for edge in scheme.edges:
        found[edge.end].append(edge)
    return {k: sorted(edges, key=lambda edge: scheme.nodes[edge.start].x) for k, edges in found.items()}


def require_true(scheme, degree):
    """Each combination that the picture shows holds for the blossom of a polynomial."""
    polynomial = [Fraction(3 * k * k - 7 * k + 2, k + 2) for k in range(degree + 1)]
    arguments = [[read_knot(x) for x in node.text.split()] for node in scheme.nodes]
    for k, edges in incoming(scheme).items():
        P, Q = (arguments[edge.start] for edge in edges)
        (a,) = (Counter(P) - Counter(Q)).elements() if P != Q else [P[0]]
        (b,) = (Counter(Q) - Counter(P)).elements()
        common = Counter(P) & Counter(Q)
        assert common <= Counter(arguments[k])
        assert len(arguments[k]) == degree
        p, q = (read_factor(edge.label) for edge in edges)
        made = p * blossom(polynomial, P) + q * blossom(polynomial, Q)
        denominator = b[0] * a[1] - a[0] * b[1]
        assert made == (1 if denominator == -1 else denominator) * blossom(polynomial, arguments[k])
        assert p * a[1] + q * b[1] != 0 or p * a[0] + q * b[0] != 0


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
@pytest.mark.parametrize("procedure", UPWARD)
def test_each_combination_holds_for_the_blossom(procedure, degree):
    for homogeneous in (False, True):
        require_true(diagram(procedure, degree, homogeneous=homogeneous), degree)


@pytest.mark.parametrize("number", [number for number in FIGURES if number not in ("1.2", "1.4", "2.5a", "2.7")])
def test_each_combination_of_a_figure_holds(number):
    if number not in ("2.2", "2.12"):
        require_true(figure(number), 3)


def test_any_knots_and_arguments():
    scheme = diagram("knot", 4, knots=[0, 0, "x", 1, 2, "y", 3, "δ"], arguments=["c", "δ", 5])
    require_true(scheme, 4)
    assert {"2 − c", "c", "−1", "−3", "4"} <= {edge.label for edge in scheme.edges}  # -3 = 2 - 5 and 4 = 5 - 1
    assert diagram("de boor", 1, knots=[(1, 2), ("x", "y")]).edges[0].label == "x − ty"


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_two_edges_for_each_combination(degree):
    t = [Fraction(x) for x in range(2 * degree)]
    u = [x + Fraction(1, 3) for x in t]
    curve = Curve(t, Counting.array(range(degree + 1)))
    for method in METHODS:
        with counting() as counts:
            change_basis(curve, u, method)
        assert len(diagram(f"{method}-change", degree).edges) == 2 * counts.combinations
    with counting() as counts:
        curve(Fraction(1, 2))
    assert len(diagram("de boor", degree).edges) == len(diagram("basis", degree).edges) == 2 * counts.combinations
    with counting() as counts:
        Curve(t, Counting.array(range(degree + 1))).blossom(*([DELTA] * degree))
    assert len(diagram("boehm-derivative", degree).edges) == 4 * counts.combinations


def test_neighbours_share_all_but_the_edges():
    for n in (1, 2, 3, 4):
        scheme = diagram("matching", n)
        assert len(scheme.nodes) == (n + 1) * (n + 2) // 2 + n + 1
        apexes = [node for node in scheme.nodes if node.kind == "result"]
        assert [node.text for node in apexes] == [" ".join("t" * n)] * 2


@pytest.mark.parametrize("procedure", ["de boor", "blossom", "power", "newton-dual", "monomial"])
def test_a_label_that_enters_a_node_leaves_it_in_the_same_direction(procedure):
    """The in-out property (§2.2.1); with the same argument at each level."""
    scheme = diagram(procedure, 4, arguments=["t"] * 4)
    entering = incoming(scheme)
    leaving = defaultdict(dict)
    for edge in scheme.edges:
        leaving[edge.start][scheme.nodes[edge.end].x > scheme.nodes[edge.start].x] = edge.label
    checked = 0
    for k, (left, right) in entering.items():
        for edge, rightwards in ((left, True), (right, False)):
            if rightwards in leaving[k]:
                assert leaving[k][rightwards] == edge.label
                checked += 1
    assert checked == 12


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
@pytest.mark.parametrize("procedure", UPWARD)
def test_a_value_stands_above_the_middle_of_its_parents(procedure, degree):
    scheme = diagram(procedure, degree)
    assert len({(node.x, node.y) for node in scheme.nodes}) == len(scheme.nodes)
    for k, (left, right) in incoming(scheme).items():
        node, P, Q = (scheme.nodes[i] for i in (k, left.start, right.start))
        assert node.x == pytest.approx((P.x + Q.x) / 2)
        assert node.y > P.y == Q.y


def test_a_procedure_may_run_from_right_to_left():
    t = knots(["a", "b", "c", "d", "e", "f"])
    P = given(t, 3)[:, 0].tolist()
    u = knot("u")
    row = [combined(P[q], P[q + 1], tuple(t[q]), tuple(t[q + 3]), u, [*map(tuple, t), u]) for q in range(3)]
    backwards = Layout(P, row[::-1], descending=True)
    assert backwards.values == Layout(P, row).values
    assert backwards.panels == 1


# ---- downward ------------------------------------------------------------------------------------------------------


def function_of(node):
    """k and m of the basis function b_k^m that a node shows."""
    if node.text == "1":
        return 0, 0
    return tuple(map(int, re.fullmatch(r"b_\{(\d+)\}\^\{(\d+)\}", node.text).groups()))


def downward_values(scheme, nodes, n, knot, t):
    """The functions at t, as sums over all paths; the factors leave b_k^m over the denominator of Eq. (2.2)."""
    values = {}
    for i in sorted(nodes, key=lambda i: -scheme.nodes[i].y):
        into = [edge for edge in scheme.edges if edge.end == i]
        if not into:
            values[i] = Fraction(1)
            continue
        values[i] = Fraction(0)
        for edge in into:
            k, m = function_of(scheme.nodes[edge.start])
            a, c = knot(n - m + k), knot(n + k + 1)
            below = 1 if None in (a, c) else c - a
            factor = read_factor(edge.label, lambda name: t if name == "t" else knot(subscript(name)))
            values[i] += factor / below * values[edge.start]
    return values


def subscript(name):
    """The number below a letter."""
    return int(name[1:].translate(str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")))


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_the_paths_from_the_apex_are_the_basis_functions(n):
    knots = [Fraction(i * i + 3 * i, 2) for i in range(2 * n + 2)]  # t_0 … t_{2n+1}
    scheme = diagram("basis", n)
    t = (knots[n] + 2 * knots[n + 1]) / 3
    padded = [*knots, *[None] * 20]
    values = downward_values(scheme, range(len(scheme.nodes)), n, padded.__getitem__, t)
    for i, node in enumerate(scheme.nodes):
        k, m = function_of(node)
        if node.kind == "result":
            assert m == n
            assert values[i] == oracle.value(oracle.piece(tuple(knots), k, n, n), t)


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_the_integrals_are_integrals(degree):
    """F(y) - F(x) = ∓ n / (t_{k+n+1} - t_{k+1}) ∫ b_k, where the knot before or after those of b_k is δ (§2.3.5)."""
    n = degree + 1
    knots = [Fraction(i * i + 3 * i, 2) for i in range(2 * n + 2)]
    scheme = diagram("integration", degree)
    ends = [i for i, node in enumerate(scheme.nodes) if node.kind == "result"]
    for end, before in zip(ends, (True, False), strict=True):
        panel, grown = {end}, True
        while grown:
            above = {edge.start for edge in scheme.edges if edge.end in panel}
            grown = not above <= panel
            panel |= above
        k = function_of(scheme.nodes[end])[0] - (not before)
        padded = [*knots, *[None] * 20]
        padded[k if before else k + n + 2] = None
        x, y = knots[n], knots[n] + (knots[n + 1] - knots[n]) / 3
        first, last = (downward_values(scheme, panel, n, padded.__getitem__, t)[end] for t in (x, y))
        area = oracle.integral(oracle.piece(tuple(knots), k + 1, degree, n), x, y)
        assert area != 0
        assert last - first == (-1 if before else 1) * n / (knots[k + n + 1] - knots[k + 1]) * area
        ones = [edge for edge in scheme.edges if edge.end in panel and edge.label == "1"]
        assert ones


# ---- what the book prints -----------------------------------------------------------------------------------------


def seen(number):
    drawn = figure(number)
    return {node.text for node in drawn.nodes}, [edge.label for edge in drawn.edges]


def test_the_de_casteljau_algorithm():
    nodes, labels = seen("1.1")
    assert nodes == {"0 0 0", "0 0 1", "0 1 1", "1 1 1", "0 0 a", "0 a 1", "a 1 1", "0 a a", "a a 1", "a a a"}
    assert Counter(labels) == {"1 − a": 6, "a": 6}
    results = {node.text for node in figure("1.1").nodes if node.kind == "result"}
    assert results == {"0 0 0", "0 0 a", "0 a a", "a a a", "a a 1", "a 1 1", "1 1 1"}  # both pieces
    assert Counter(seen("2.13")[1]) == {"1 − t": 6, "t": 6}


def test_the_de_boor_algorithm():
    nodes, labels = seen("1.3")
    assert {"t_{q−2} t_{q−1} t_{q}", "t_{q−1} t_{q} a", "a a a"} <= nodes
    assert {"t_{q+1} − a", "a − t_{q−2}"} <= set(labels)
    assert Counter(seen("2.1")[1]) == {
        "t₄ − t": 3,
        "t₅ − t": 2,
        "t₆ − t": 1,
        "t − t₁": 1,
        "t − t₂": 2,
        "t − t₃": 3,
    }
    assert Counter(seen("2.2")[1]) == Counter(seen("2.1")[1])
    assert {"t₄ − u₃", "u₃ − t₃", "u₁ − t₁", "t₆ − u₁"} <= set(seen("2.3")[1])


def test_homogeneous_knots():
    assert {"t₄w − tw₄", "tw₁ − t₁w"} <= set(seen("2.6")[1])
    assert {"t₄v₁ − u₁w₄", "u₃w₃ − t₃v₃"} <= set(seen("2.8")[1])
    assert "û₁ û₂ û₃".replace("û", "u\u0302") in seen("2.8")[0]


def test_derivatives():
    assert Counter(seen("1.5")[1])["−1"] == Counter(seen("1.5")[1])["1"] == 3
    assert "δ a a" in seen("1.5")[0]
    assert {"−w₄", "−w₅", "−w₆", "w₁", "w₂", "w₃", "t₄ − tw₄", "tw₃ − t₃"} == {*seen("2.9")[1]} - {
        "t₅ − tw₅",
        "tw₂ − t₂",
    }
    nodes, labels = seen("2.10")
    assert {"δ δ δ", "a δ δ", "a a δ", "a a a"} <= nodes
    assert Counter(labels)["1"] == 6
    assert {"aw₁ − t₁", "aw₂ − t₂", "aw₃ − t₃"} <= set(labels)


def test_named_bases():
    assert Counter(seen("2.15")[1]) == {"1": 6, "t": 6}
    assert Counter(seen("2.16")[1]) == {"1": 12}
    assert Counter(seen("2.17")[1]) == {"1": 6, "−1": 6}
    assert Counter(seen("2.18")[1]) == {"1": 6, "t − t₁": 1, "t − t₂": 2, "t − t₃": 3}
    assert {"t₀ − t", "t − t₃", "t₂ − t"} <= set(seen("2.14")[1])
    assert "t₁ t₂ t₃" in seen("2.14")[0]


def test_change_of_basis():
    assert len(figure("2.4").edges) == 2 * 3 * 4
    assert len(figure("2.5b").edges) == len(figure("2.5a").edges) == 2 * 16
    results = {node.text for node in figure("2.5b").nodes if node.kind == "result"}
    assert results == {"u₁ u₂ u₃", "u₂ u₃ u₄", "u₃ u₄ u₅", "u₄ u₅ u₆"}
    assert {node.text for node in figure("2.4").nodes if node.kind == "result"} == results
    assert {node.text for node in figure("2.5a").nodes} == {"", *(f"{x}_{{{k}}}" for x in "PQ" for k in range(4))}


@pytest.mark.parametrize(
    ("number", "knots", "q", "a"),
    [("1.2", (0, 0, 0, 0, 1, 1, 1, 1), 3, "3/5"), ("1.4", (0, 0, 0, 0, 2, 4, 6, 8, 10, 12), 5, "5")],
)
def test_the_points_of_a_construction_are_where_the_blossom_is(number, knots, q, a):
    drawn = figure(number)
    t = tuple(map(Fraction, knots))
    given = [node for node in drawn.nodes if node.kind == "given"]
    made = [node for node in drawn.nodes if node.kind != "given"]
    assert len(made) == 6
    for node in made:
        u = tuple(Fraction(x.replace("a", a)) for x in node.text.split())
        weights = [oracle.blossom(oracle.piece(t, k, 3, q), u) for k in range(len(given))]
        assert node.x == pytest.approx(float(sum(w * Fraction(p.x) for w, p in zip(weights, given, strict=True))))
        assert node.y == pytest.approx(float(sum(w * Fraction(p.y) for w, p in zip(weights, given, strict=True))))
    curve = next(path for path in drawn.paths if path.kind == "curve").points
    apex = next(node for node in drawn.nodes if node.kind == "result")
    assert min(math.hypot(x - apex.x, y - apex.y) for x, y in curve) < 0.4


# ---- the picture --------------------------------------------------------------------------------------------------

PICTURES = [(name, degree, homogeneous) for name in SCHEMES for degree in (1, 3, 5) for homogeneous in (False, True)]


def pictures():
    yield from map(figure, FIGURES)
    yield from (diagram(name, degree, homogeneous=homogeneous) for name, degree, homogeneous in PICTURES)


def test_nothing_overlaps_and_all_is_inside():
    for drawn in pictures():
        labels = list(drawn.labels())
        frame = drawn.box
        for (text, box), (other, another) in itertools.combinations(labels, 2):
            assert not box.meets(another), (drawn.title, text, other)
        for text, box in labels:
            assert frame.left < box.left < box.right < frame.right, text
            assert frame.bottom < box.bottom < box.top < frame.top, text


def test_labels_are_no_wider_than_they_are_taken_for():
    """Measured in DejaVu Serif, which is wider than what most screens show."""
    pytest.importorskip("matplotlib")
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    def measured(part):
        face = FontProperties(family="DejaVu Serif", style="italic" if part.italic else "normal")
        box = TextPath((0, 0), part.text.replace("\u0302", ""), size=100, prop=face).get_extents()
        return box.x1 / 100 * (0.7 if part.lowered else 1)

    labels = {text for number in FIGURES for text, _ in figure(number).labels()}
    assert len(labels) > 100
    for text in labels:
        pieces = [part for part in parts(text) if not part.text.isspace()]
        assert sum(map(measured, pieces)) <= width(text), text


@pytest.mark.parametrize("number", FIGURES)
def test_the_svg_is_well_formed_and_whole(number):
    drawn = figure(number)
    root = ElementTree.fromstring(drawn.svg())
    assert root.tag == f"{SVG}svg"
    assert root.find(f"{SVG}title").text == drawn.title == f"Fig. {number}. {FIGURES[number].caption}"
    assert root.find(f"{SVG}rect").attrib["fill"] == "#ffffff"
    texts = ["".join(text.itertext()) for text in root.iter(f"{SVG}text")]
    written = ["".join(part.text for part in parts(text) if not part.text.isspace()) for text, _ in drawn.labels()]
    assert Counter(texts) == Counter(written)
    assert not re.search("[₀-₉⁰-⁹_^{}]", "".join(texts))  # subscripts are set as subscripts
    wide, high = (float(root.attrib[side]) for side in ("width", "height"))
    for text in root.iter(f"{SVG}text"):
        assert 0 < float(text.attrib["x"]) < wide
        assert 0 < float(text.attrib["y"]) < high
    assert drawn._repr_svg_() == drawn.svg()


def test_subscripts_and_superscripts():
    assert [(part.text, part.italic, part.lowered > 0, part.lowered < 0) for part in parts("t₁₂ − b_{q−1}^{n}")] == [
        ("t", True, False, False),
        ("12", False, True, False),
        (" ", False, False, False),
        ("−", False, False, False),
        (" ", False, False, False),
        ("b", True, False, False),
        ("q", True, True, False),
        ("−", False, True, False),
        ("1", False, True, False),
        ("n", True, False, True),
    ]


@pytest.mark.parametrize("number", ["1.2", "2.5b", "2.8", "2.10", "2.12"])
def test_in_matplotlib_nothing_overlaps_either(number):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from matplotlib import pyplot as plt

    fig, axes = plt.subplots(figsize=(12, 9))
    drawn = figure(number)
    assert drawn.draw(axes) is axes
    renderer = fig.canvas.get_renderer()
    boxes = [text.get_window_extent(renderer) for text in axes.texts]
    room = axes.get_window_extent()
    assert len(boxes) == len(list(drawn.labels()))
    for a, b in itertools.combinations([Box(*box.extents) for box in boxes], 2):
        assert not a.meets(b)
    assert all(room.x0 < box.x0 < box.x1 < room.x1 and room.y0 < box.y0 < box.y1 < room.y1 for box in boxes)
    plt.close(fig)


# ---- knots that are names -----------------------------------------------------------------------------------------


def test_expressions():
    t, u, w = map(Expression, ("t₄", "u", "w₄"))
    assert str(t - u * w) == "t₄ − uw₄"
    assert str(-w) == "−w₄"
    assert str(1 - u) == "1 − u"
    assert str(u - u) == "0"
    assert str(2 * u + Fraction(1, 2) * t) == "2u + (1/2)t₄"
    assert (t - u) * (t + u) == t * t - u * u
    assert hash(t * w) == hash(w * t)
    assert (t - u * w).at(**{"t₄": 7, "u": 2, "w₄": 3}) == 1
    assert t != u
    assert t - t == 0


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: diagram("neville"), ParameterError, "'neville' given; expected one of de casteljau"),
        (lambda: diagram("de boor", 0), ParameterError, "degree 0 given"),
        (lambda: diagram("de boor", 2, knots="abc"), KnotError, "3 knots given; expected 4"),
        (lambda: diagram("blossom", 2, arguments=["u"]), KnotError, "1 arguments given; expected 2"),
        (lambda: diagram("knot", 2, arguments=["u"] * 3), KnotError, "expected 1 … 2"),
        (lambda: diagram("de boor", 2, knots=[0, 1, 0, 2]), KnotError, "0 and 0 cannot give way to t"),
        (lambda: diagram("de boor", 1, knots=[(1, 2), (2, 4)]), KnotError, "expected knots that differ"),
        (lambda: diagram("de boor", 1, knots=[0, (0, 0)]), KnotError, "neither a number nor a vector"),
        (lambda: diagram("de boor", 1, knots=[0, 1j]), KnotError, "expected a name, a real number"),
        (lambda: diagram("de boor", 1, knots=[0, np.nan]), KnotError, "expected a name, a real number"),
        (lambda: diagram("de boor", 1, knots=["t + u", 0]), KnotError, "'t + u' given; expected a letter"),
        (lambda: diagram("de boor", 1, knots=["", 0]), KnotError, "'' given; expected a letter"),
        (lambda: diagram("goldman-change", 1, knots=[0, 1], arguments=[2, 0]), KnotError, "method 'goldman'"),
        (lambda: figure("3.11"), ParameterError, "'3.11' given; expected one of 1.1"),
    ],
)
def test_bad_input(call, error, words):
    with pytest.raises(error, match=re.escape(words)):
        call()
