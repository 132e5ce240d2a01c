"""What turns one picture into the next: rows taken out and put in, as few as there can be."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from knotwork.editor import views

ROWS = st.lists(st.integers(0, 2), max_size=8)


@given(old=ROWS, new=ROWS, shape=st.sampled_from([(), (2,), (4, 2)]))
def test_a_patch_turns_the_old_rows_into_the_new_ones(old, new, shape):
    a, b = (np.multiply.outer(np.array(rows, float), np.ones(shape)) for rows in (old, new))
    patch = views.patch({"points": a}, {"points": b}).get("points", {"at": 0, "drop": 0, "put": []})
    at, drop, put = patch["at"], patch["drop"], patch["put"]
    assert [*a[:at].tolist(), *put, *a[at + drop :].tolist()] == b.tolist()
    if drop and put:  # neither the first nor the last of them could have stayed
        assert put[0] != a[at].tolist()
        assert put[-1] != a[at + drop - 1].tolist()
