"""Small files and splines that the tests of CAD formats share."""

from typing import Any

import numpy as np
from hypothesis import strategies as st

import knotwork as kw
from strategies import spaces

NUMBERS = st.floats(-1e9, 1e9).filter(lambda x: not 0 < abs(x) < 1e-9)


def tensor(draw: Any, parameters: int) -> kw.Spline:
    """Draw a curve or surface in space: polynomial, or with weights that are powers of 2, so that nothing rounds."""
    if draw is None:
        return kw.surface(np.arange(12.0).reshape(2, 2, 3), degree=1)
    chosen = [draw(spaces(degrees=st.integers(1, 3), periodic=False)) for _ in range(parameters)]
    shape = tuple(space.dimension for space in chosen)
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    points = np.round(rng.normal(size=(*shape, 3)) * 1e3, draw(st.integers(0, 12)))
    if draw(st.booleans()):
        return kw.Spline(chosen, points)
    weights = 2.0 ** rng.integers(-3, 4, shape)
    weights.flat[0], weights.flat[-1] = 1, 2
    return kw.Spline(chosen, np.concatenate([points * weights[..., None], weights[..., None]], -1), rational=True)


def planar(n: int) -> kw.Spline:
    """Return a wavy cubic of n points in the plane."""
    x = np.linspace(0, 10, n)
    return kw.curve(np.column_stack([x, np.sin(x)]))


def iges_file(entities: list[tuple[int, str, dict[str, Any]]]) -> bytes:
    """Return an IGES file of entities, each a kind, its parameters and what the directory says."""
    directory, body = [], []
    for i, (kind, text, told) in enumerate(entities):
        text = f"{kind},{text};"
        rows = [text[k : k + 64] for k in range(0, len(text), 64)]
        fields = [kind, len(body) + 1, 0, 0, told.get("level", 0), 0, told.get("matrix", 0), 0]
        directory.append("".join(f"{x:8d}" for x in fields) + told.get("status", "00000000"))
        directory.append(f"{kind:8d}{0:8d}{0:8d}{len(rows):8d}{0:8d}" + " " * 32)
        body += [f"{row:<64} {2 * i + 1:7d}" for row in rows]
    head = ["1H,,1H;,4Htest,8Htest.igs,1Ha,1Hb,32,38,6,308,15,4Htest,1.,2,2HMM,1,1.,13H130524.131856,1E-8,10.,1Hc,1Hd,"]
    head = [head[0][:72], head[0][72:] + "11,0;"]
    lines = [
        f"{t:<72}{s}{i:7d}"
        for s, rows in (("S", [""]), ("G", head), ("D", directory), ("P", body))
        for i, t in enumerate(rows, 1)
    ]
    tail = f"S{1:7d}G{2:7d}D{len(directory):7d}P{len(body):7d}"
    return "\n".join([*lines, f"{tail:<72}T{1:7d}", ""]).encode()
