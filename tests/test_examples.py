"""The inputs that are shipped are what their page says."""

from pathlib import Path

import numpy as np
import pytest

from knotwork.files import read

EXAMPLES = Path(__file__).parent.parent / "examples"


def area(ring):
    x, y = ring.T
    return abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def test_the_coast_of_iceland_encloses_iceland():
    rings = read(EXAMPLES / "iceland.csv")
    assert [len(r.points) for r in rings] == [3058, 16, 14, 13, 7]
    assert all(r.space.periodic and r.degree == (1,) for r in rings)
    assert area(rings[0].points) == pytest.approx(102_000, rel=0.01)  # km², and the projection keeps areas
    longest = np.ptp(rings[0].points, axis=0)
    assert longest == pytest.approx([512, 352], abs=1)


def test_the_rose_is_closed_cubic_outlines_dedicated_to_the_public():
    pytest.importorskip("svgelements")
    outlines = read(EXAMPLES / "rose.svg")
    assert len(outlines) == 34
    assert all(s.space.periodic and s.degree == (3,) for s in outlines)
    assert sum(len(s.space.breaks) - 1 for s in outlines) == 988
    assert 'license rdf:resource="http://web.resource.org/cc/PublicDomain"' in (EXAMPLES / "rose.svg").read_text()
