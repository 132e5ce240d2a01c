"""Which method `auto` picks: the merge, or where it is measured to win, Boehm's algorithm."""

import numpy as np
import pytest

import knotwork as kw
from knotwork.insertion import METHODS, auto
from knotwork.insertion.auto import fastest

DENSE = np.linspace(0.1, 0.9, 20_000)


@pytest.fixture
def table(monkeypatch):
    """Crossovers that do not change when they are measured anew."""
    monkeypatch.setattr(auto, "CROSSOVERS", {5: ((0.5, 5000), (0.9, 1000))})
    monkeypatch.setattr(auto, "FEW", 1000)
    monkeypatch.setattr(auto, "HIGHEST", 5)


@pytest.mark.parametrize(
    ("degree", "spans", "new", "coordinates", "name"),
    [
        (5, 1, 999, 3, "merge"),  # few
        (5, 1, 1000, 3, "boehm"),
        (8, 1, 1000, 3, "boehm"),  # as the highest degree there is
        (4, 1, 20_000, 3, "merge"),  # a degree where it never wins
        (5, 1, 20_000, 5, "merge"),  # many coordinates
        (5, 200, 1000, 3, "merge"),  # 200 × 0.8 old knots between 1000 new ones: 86 %
        (5, 200, 5000, 3, "boehm"),
        (5, 7000, 5000, 3, "merge"),
    ],
)
def test_the_rule(table, degree, spans, new, coordinates, name):
    space = kw.SplineSpace.clamped(degree, degree + spans)
    assert fastest(space, np.linspace(0.1, 0.9, new), coordinates) == name


def test_old_knots_beyond_the_new_ones_do_not_count(table):
    space = kw.SplineSpace.clamped(5, 20_000)
    assert fastest(space, np.linspace(0.5001, 0.5002, 1000), 1) == "boehm"


def test_exact_numbers_take_the_merge(table):
    assert fastest(kw.SplineSpace.clamped(5, 6).in_exact_arithmetic(), DENSE, 1) == "merge"


def test_what_is_measured():
    """The table has degrees, shares and numbers of knots; more of each is never slower."""
    assert all(0 < share <= 1 and least >= 100 for rows in auto.CROSSOVERS.values() for share, least in rows)
    for rows in auto.CROSSOVERS.values():
        assert list(rows) == sorted(rows, key=lambda row: (row[0], -row[1]))
    for degree in (1, 2, 3):
        assert fastest(kw.SplineSpace.clamped(degree, 10), DENSE[:500], 3) == "merge"


@pytest.mark.parametrize("degree", [3, 9])
def test_it_names_a_method(degree):
    assert fastest(kw.SplineSpace.clamped(degree, 12), DENSE, 2) in METHODS
