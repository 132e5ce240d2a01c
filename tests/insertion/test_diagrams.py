"""Schemes of knot insertion: what they show is true by the definition of the blossom, is all there, and can be read."""

from __future__ import annotations

import itertools
import math
import re
from collections import Counter, defaultdict
from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree

import pytest

import knotwork as kw
import oracle
from knotwork.diagrams import diagram, figure
from knotwork.diagrams.insertion import DRAWN
from knotwork.diagrams.insertion_figures import FIGURES
from knotwork.errors import KnotError, ParameterError
from knotwork.insertion import METHODS, count

IMAGES = Path(__file__).parents[2] / "docs" / "images" / "insertion"
NAME = r"[a-z](?:[₀-₉]+|_\{[^}]*\})?"
CUBIC = (Fraction(3, 2), Fraction(-7), Fraction(5, 3), Fraction(11, 4))


def value_of(name):
    """A number for each name, as far from any pattern as can be."""
    return Fraction(sum(ord(c) ** (i + 2) for i, c in enumerate(name)) % 9973, 7 + ord(name[0]) % 13)


def linear(text):
    """The number that a sum of names and multiples of names stands for."""
    total = Fraction(0)
    for sign, number, name, power in re.findall(rf"([+−]?)\s*(\d*)({NAME})?([²³]?)", text):
        if number or name:
            factor = value_of(name) ** {"": 1, "²": 2, "³": 3}[power] if name else 1
            total += (-1 if sign == "−" else 1) * int(number or 1) * factor
    return total


def factor(label):
    """The number that an arrow carries."""
    above, _, below = label.partition("/")
    return linear(above) / (linear(below) if below else 1)


def blossom(polynomial, text):
    """The multilinear blossom at arguments as a node shows them, by symmetric sums."""
    arguments = text.split()
    n = len(arguments)
    sums = [Fraction(1)] + [Fraction(0)] * n
    for x in arguments:
        t, w = (1, 0) if x == "δ" else (linear(x), 1)
        sums = [w * sums[k] + (t * sums[k - 1] if k else 0) for k in range(n + 1)]
    return sum(a * s / math.comb(n, k) for k, (a, s) in enumerate(zip(polynomial, sums, strict=True)))


def divided_difference(polynomial, text):
    """The divided difference that a node shows: of t^k it is the sum of all products of k - m of the nodes."""
    x = [linear(node) for node in text.removeprefix("G[").removesuffix("]").split()]
    return sum(
        a * sum(map(math.prod, itertools.combinations_with_replacement(x, k - len(x) + 1)))
        for k, a in enumerate(polynomial)
        if k >= len(x) - 1
    )


def point(text):
    """What a node shows of the cubic."""
    if text.startswith("G"):
        return divided_difference(CUBIC, text)
    multiple, _, inner = text.rstrip(")").rpartition(" (")
    return blossom(CUBIC, inner) * (linear(multiple) if multiple else 1)


def incoming(scheme):
    """The edges into each node that has any, from left to right."""
    found = defaultdict(list)
    for edge in scheme.edges:
        found[edge.end].append(edge)
    return {k: sorted(edges, key=lambda edge: scheme.nodes[edge.start].x) for k, edges in found.items()}


def require_true(scheme, degree):
    """Each combination that is shown holds for the blossom of a polynomial."""
    polynomial = [Fraction(3 * k * k - 7 * k + 2, k + 2) for k in range(degree + 1)]
    plain = [re.sub(r"^\((.*)\)_\{[LR]\}$", r"\1", node.text) for node in scheme.nodes]
    for k, edges in incoming(scheme).items():
        texts = [plain[edge.start] for edge in edges]
        made = sum(factor(edge.label) * blossom(polynomial, text) for edge, text in zip(edges, texts, strict=True))
        assert len(plain[k].split()) == degree
        exact = "δ" in texts[1].split() or "/" in edges[0].label
        if not exact:
            P, Q = (Counter(text.split()) for text in texts)
            (a,), (b,) = (P - Q).elements(), (Q - P).elements()
            made /= linear(b) - linear(a)
        assert made == blossom(polynomial, plain[k]), (scheme.title, plain[k])


SPREAD = ["t₁", "t₂", "t₃", "t₄", "t₄", "u₁", "u₂", "t₅", "u₃", "t₆", "t₆", "u₄", "t₇", "t₈", "t₉"]


@pytest.mark.parametrize("method", DRAWN)
def test_each_combination_holds_for_the_blossom(method):
    for degree in (1, 2, 3):
        require_true(diagram(method, degree), degree)
    require_true(diagram(method, 3, knots=SPREAD), 3)
    require_true(diagram(method, 2, new=7), 2)


def windows(knots, n):
    return {" ".join(knots[i : i + n]) for i in range(len(knots) - n + 1)}


@pytest.mark.parametrize("method", DRAWN)
def test_the_new_vertices_are_set_off(method):
    """All of them, and nothing that is no vertex over the refined knots."""
    new, old = windows(SPREAD, 3), windows([x for x in SPREAD if x[0] == "t"], 3)
    results = {node.text for node in diagram(method, knots=SPREAD).nodes if node.kind == "result"}
    assert new - old <= results <= new


@pytest.mark.parametrize("method", DRAWN)
@pytest.mark.parametrize(("n", "m"), [(2, 3), (3, 4), (3, 10), (4, 5)])
def test_a_scheme_has_as_many_combinations_as_are_counted(method, n, m):
    spline = kw.Spline([kw.SplineSpace(n, range(2 * n + 2))], range(n + 1))
    counted = count(method, spline, [Fraction(n * (m + 1) + k, m + 1) for k in range(1, m + 1)])
    edges = diagram(method, n, new=m).edges
    assert len([edge for edge in edges if "/" not in edge.label]) == 2 * counted.combinations
    if METHODS[method].form != "factored":
        assert len(edges) == 2 * counted.combinations


def test_all_orders_of_factored_knot_insertion_make_the_same_combinations():
    def combinations(method):
        scheme = diagram(method, 4, new=6)
        return {(scheme.nodes[e.start].text, scheme.nodes[e.end].text, e.label) for e in scheme.edges}

    assert combinations("factored") == combinations("factored-nested") == combinations("boehm-factored")


# ---- the figures ----------------------------------------------------------------------------------------------------

SPECIAL = ("3.1", "3.2", "3.3", "3.6", "3.7", "3.10", "4.8", "4.15")


@pytest.mark.parametrize("number", [number for number in FIGURES if number not in SPECIAL])
def test_each_combination_of_a_figure_holds(number):
    require_true(figure(number), 3)


@pytest.mark.parametrize("number", ["3.1", "3.6", "3.7", "3.10"])
def test_differences_and_multiples_add_up(number):
    scheme = figure(number)
    found = incoming(scheme)
    for k, edges in found.items():
        made = sum(factor(edge.label) * point(scheme.nodes[edge.start].text) for edge in edges)
        assert made == point(scheme.nodes[k].text), scheme.nodes[k].text
    assert len(found) == {"3.1": 6 + 8, "3.6": 8, "3.7": 8, "3.10": 18}[number]


def test_evenly_spaced_knots_take_additions_alone():
    labels = [edge.label for edge in figure("3.10").edges]
    assert {*labels[:18]} > {"1", "2h − t₃", "h"}
    assert {*labels[18:]} == {"1"}
    assert {node.text for node in figure("3.10").nodes} >= {"3h (h 2h δ)", "6h² (2h δ δ)", "6h³ (δ δ δ)"}


@pytest.mark.parametrize("number", ["3.6", "3.7"])
def test_a_round_turned_round_is_evaluation(number):
    """The rows of insertion are at 0 and 1, of evaluation at 4 and 3: row 1 is dual to row 4, and row 0 to row 3."""
    scheme = figure(number)
    column = sorted({node.x for node in scheme.nodes}).index
    insertion, evaluation = set(), set()
    for edge in scheme.edges:
        a, b = scheme.nodes[edge.start], scheme.nodes[edge.end]
        ways = (column(a.x), column(b.x)) if b.y < 10 else (column(b.x), column(a.x))
        weight = factor(edge.label)
        (insertion if b.y < 10 else evaluation).add((*ways, weight if ways[0] == ways[1] or b.y < 10 else -weight))
    assert insertion == evaluation
    assert len(insertion) == 7


def test_names_of_factored_knot_insertion():
    def read(text):
        return text[0], *map(int, re.findall(r"\d+", text))

    for number in ("3.2", "3.3"):
        scheme = figure(number)
        assert {edge.label for edge in scheme.edges} == {""}
        for k, (left, right) in incoming(scheme).items():
            (letter, j, i), *parents = (read(scheme.nodes[m].text) for m in (k, left.start, right.start))
            if letter == "V":
                assert parents == [("V", j - 1, i - 1), ("V", j, i - 1)]
            elif number == "3.2":
                assert parents == [("P", j, i - 1), ("P", j + 1, i - 1 if j < 2 else 0)]
            else:  # in round i the points before the min(i, 3)rd are new
                earlier, new = i - 1 if j < i - 1 else 0, i if j + 1 < min(i, 3) else 0
                assert parents == [("P", j, earlier), ("P", j + 1, new)]
        results = [node.text for node in scheme.nodes if node.kind == "result"]
        assert results == [f"P_{{0}}^{{{i}}}" for i in range(1, 5)]


def results_of(number):
    return [node.text for node in figure(number).nodes if node.kind == "result"]


def test_what_the_algorithms_are_run_for():
    assert results_of("4.1") == ["t₂ t₃ u₁", "t₃ u₁ t₄", "u₁ t₄ t₅"]
    assert results_of("4.2") == results_of("4.11")[-1:] == ["u₁ u₂ u₃"]
    segment = {"u₁ u₂ u₃", "u₂ u₃ u₄", "u₃ u₄ u₅", "u₄ u₅ u₆"}
    assert {*results_of("4.3")} == segment <= {*results_of("4.7")}
    assert {*results_of("4.5")} == windows(["t₂", "t₃", "u₁", "u₂", "u₃", "u₄", "t₄", "t₅"], 3)
    assert {*results_of("4.6")} == windows(["t₂", "t₃", "u₁", "u₂", "t₄", "t₅"], 3)
    assert results_of("4.13") == ["t₂ t₃ u₁", "t₃ u₁ u₂", "u₁ u₂ u₃", "u₂ u₃ u₄", "u₃ u₄ t₄", "u₄ t₄ t₅"]
    for number, edges in {"4.1": 3, "4.2": 6, "4.3": 16, "4.5": 12, "4.6": 6, "4.7": 12, "4.8": 72, "4.10": 9}.items():
        assert len(figure(number).edges) == 2 * edges


def test_the_waste_of_the_oslo_algorithm():
    """A product with 0, and factors that are the denominator."""
    scheme = figure("4.4")
    assert results_of("4.4") == ["t₄ t₅ u₁"]
    labels = [edge.label for edge in scheme.edges]
    assert "0" in labels
    assert "t₄ − t₂" in labels


def test_neighbouring_division_triangles_share_all_but_one_side():
    texts = [node.text for node in figure("4.10").nodes]
    sides = {side: [text for text in texts if text.endswith(f"_{{{side}}}")] for side in "LR"}
    assert sides["L"] == ["(t₁ t₂ t₃)_{L}", "(t₂ t₃ δ)_{L}", "(t₃ δ δ)_{L}", "(δ δ δ)_{L}"]
    assert sides["R"] == ["(t₅ t₆ t₇)_{R}", "(t₅ t₆ δ)_{R}", "(t₅ δ δ)_{R}", "(δ δ δ)_{R}"]
    assert len(texts) == 14
    assert len(results_of("4.10")) == 4  # three divisions and a point


def test_the_recursive_algorithm_puts_seven_knots_into_each_vertex():
    """Up a panel of dots, the numbers below its base and beside its rows are those of one vertex."""
    scheme = figure("4.8")
    panel = list(range(len(scheme.nodes)))
    for _ in range(8):
        for edge in scheme.edges:
            panel[edge.start] = panel[edge.end] = min(panel[edge.start], panel[edge.end])
    vertices = defaultdict(list)
    for k, node in zip(panel, scheme.nodes, strict=True):
        vertices[k] += map(int, node.text.split())
    assert sorted(map(sorted, vertices.values())) == [[*range(k, k + 7)] for k in range(1, 9)]
    assert len(results_of("4.8")) == 8


def test_a_row_of_the_insertion_matrix():
    """Of the two numbers that leave a node, each over their sum is its share."""
    scheme = figure("4.15")
    t = tuple(Fraction(k * k + 3 * k, 2) for k in range(8))
    u = tuple(t[3] + (t[4] - t[3]) * Fraction(k, 5) for k in (1, 2, 4))
    given = {f"{x}{'₀₁₂₃₄₅₆₇'[k]}": v for x, row in (("t", t), ("u", (Fraction(0), *u))) for k, v in enumerate(row)}

    def share(label):
        a, b = label.split(" − ")
        return given[a] - given[b]

    values = dict.fromkeys(range(len(scheme.nodes)), Fraction(0))
    order = sorted(values, key=lambda k: -scheme.nodes[k].y)
    values[order[0]] = Fraction(1)
    for k in order:
        out = [edge for edge in scheme.edges if edge.start == k]
        for edge in out:
            values[edge.end] += values[k] * share(edge.label) / sum(share(e.label) for e in out)
    row = [values[k] for k in order[-4:]]
    assert [scheme.nodes[k].text for k in order[-4:]] == ["α_{q−3,3}", "α_{q−2,3}", "α_{q−1,3}", "α_{q,3}"]
    assert row == [oracle.blossom(oracle.piece(t, j, 3, 3), u) for j in range(4)]


# ---- the picture ----------------------------------------------------------------------------------------------------


def pictures():
    yield from map(figure, FIGURES)
    yield from (diagram(method, degree) for method in DRAWN for degree in (1, 3) if "rewritten" not in method)


def test_nothing_overlaps_and_all_is_inside():
    for drawn in pictures():
        labels = sorted(drawn.labels(), key=lambda each: each[1].left)
        frame = drawn.box
        for k, (text, box) in enumerate(labels):
            for other, another in labels[k + 1 :]:
                if another.left >= box.right:
                    break
                assert not box.meets(another), (drawn.title, text, other)
            assert frame.left < box.left < box.right < frame.right, text
            assert frame.bottom < box.bottom < box.top < frame.top, text


@pytest.mark.parametrize("number", FIGURES)
def test_the_pictures_of_the_pages_are_what_is_drawn(number):
    drawn = figure(number)
    svg = drawn.svg()
    assert ElementTree.fromstring(svg)[0].text == f"Fig. {number}. {FIGURES[number].caption}"
    assert (IMAGES / f"figure-{number}.svg").read_text(encoding="utf-8") == svg


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: diagram("bohm"), ParameterError, "procedure 'bohm' given; expected one of de casteljau"),
        (lambda: diagram("boehm", arguments=["u"]), ParameterError, "takes `new` or `knots`"),
        (lambda: diagram("de boor", new=2), ParameterError, "takes `arguments`"),
        (lambda: diagram("morken"), ParameterError, "method 'morken' given, which has no scheme of its own"),
        (lambda: diagram("boehm", 0), ParameterError, "degree 0 given"),
        (lambda: diagram("boehm", new=0), ParameterError, "new 0 given"),
        (lambda: diagram("boehm", 1, new=1, knots=["t₁", "u", "t₂"]), ParameterError, "expected one of the two"),
        (lambda: diagram("boehm", 1, knots=["t₁", "t₂"]), KnotError, "expected new ones among them, named u"),
        (lambda: diagram("boehm", 2, knots=["t₁", "u", "t₂", "t₃"]), KnotError, "1 knots before the new ones"),
        (lambda: diagram("boehm", 1, knots=["t₁", "u", 2]), KnotError, "knot 2 given; expected a name"),
        (lambda: diagram("boehm", 1, knots=["t + 1", "u", "t"]), KnotError, "'t + 1' given; expected a letter"),
        (lambda: diagram("boehm", 1, knots=["a", "u", "b", "a"]), KnotError, "knot a is there again after b"),
        (lambda: figure("2.5"), ParameterError, "'2.5' given; expected one of 1.1"),
    ],
)
def test_bad_input(call, error, words):
    with pytest.raises(error, match=re.escape(words)):
        call()
