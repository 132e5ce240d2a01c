"""The steps of the search for smooth curves, in one compiled whole each: what the steps share is compiled once."""

from __future__ import annotations

from knotwork.arithmetic.kernel import kernel
from knotwork.removal.shapes.frame import descended_frame
from knotwork.removal.shapes.knots import mended, relaxed, thinned
from knotwork.removal.shapes.loops import mended_around, thinned_around
from knotwork.removal.shapes.residuals import FAIR
from knotwork.removal.shapes.search import certified

#: sweeps of least squares to begin with
SWEEPS = 3
#: the steps: all control points are fitted; knots are put in where the curve is too far from its samples; they are
#: taken out; room is made for that; what is left is proven
FIT, MEND, THIN, RELAX, PROVE = range(5)

#: the certificate with knots put in where it fails, and with a loop fitted anew
certified_smooth = certified.variant(repaired=mended)
certified_around = certified.variant(repaired=mended_around)


@kernel(inline=False)
def step(what, task, kind, space, end, last, count, effort):
    """Take a step with a curve of so many pieces; return what `certified` does, with 0 nodes if nothing is proven."""
    G, S, room = space.G, space.samples, space.room
    if what == FIT:
        fitted_between(G, S, last, count, room)
    elif what == MEND:
        count = mended(G, S, last, count, task.most, space.places, room, effort)
    elif what == THIN:
        count = thinned(G, S, last, count, room, effort)
    elif what == RELAX:
        relaxed(G, S, last, count, room, effort)
    else:
        return certified_smooth(task, kind, space, end, last, count, effort)
    return count, 0, last, end


@kernel(inline=False)
def step_around(what, task, kind, space, end, last, count, effort):
    """Take a step with a loop: see `step`."""
    G, S, room = space.G, space.samples, space.room
    if what == MEND:
        count = mended_around(G, S, last, count, task.most, space.places, room, effort)
    elif what == THIN:
        count = thinned_around(G, S, last, count, room, effort)
    else:
        return certified_around(task, kind, space, end, last, count, effort)
    return count, 0, last, end


@kernel(inline=False)
def fitted_between(G, S, last, count, room):
    """Fit the control points between knots that stay, by least squares."""
    k0, ja = 0, 0
    for k in range(1, count + 1):
        if room.frame.fixed[k]:
            jb = ja + 1
            while jb < last and S.hard[jb] != 1:
                jb += 1
            descended_frame(G, k0, k - 1, S, ja, jb, room, 1, 1, SWEEPS, FAIR, 0)
            k0, ja = k, jb
