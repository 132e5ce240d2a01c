"""Make the pictures of the documentation: python docs/figures/general.py."""

import re
import sys
import tempfile
from pathlib import Path

import numpy as np
from common import EXAMPLES, IMAGES, plt, save

import knotwork as kw
from knotwork import cli
from knotwork.plotting import INK, KNOT

HUES = [INK, KNOT, "#3c8d6e", "#b58a1b", "#7a4f9a"]


def periodic() -> None:
    """Draw a periodic space of degree 2, seam doubled: its basis functions over the knots, and a curve of it."""
    space = kw.SplineSpace(2, [0, 0, 1, 2, 3, 4], periodic=True)
    n, N = space.degree, space.dimension
    (a, b), t = space.domain, np.arange(-1, N + n + 2)
    knots = space.knots[t % N] + (t // N) * (b - a)
    fig, (line, plane) = plt.subplots(1, 2, figsize=(11, 4.2), width_ratios=[1.5, 1], layout="constrained")

    # each basis function where it starts, and again one period later: pale beyond the period
    u = np.linspace(a, b, 801)
    for i in range(N):
        B = kw.Spline(space, np.eye(N)[i])
        start, end = knots[1 + i], knots[1 + i + n + 1]
        x = np.linspace(start, end, 400)[1:-1]
        inside = x < b
        line.plot(x[inside], B(x[inside]), color=HUES[i], linewidth=1.8)
        line.plot(x[~inside], B(x[~inside]), color=HUES[i], linewidth=1.8, alpha=0.3)
        wrapped = u[(u >= a) & (u < end - (b - a))]
        line.plot(wrapped, B(wrapped), color=HUES[i], linewidth=1.8, linestyle=(0, (2, 2)))
        top = x[np.argmax(B(x))]
        line.annotate(f"$B_{i}$", (top, B(top)), (0, 4), textcoords="offset points", color=HUES[i], ha="center")
    for i, x in enumerate(space.knots):
        lift = 0.075 * sum(space.knots[:i] == x)
        line.plot(x, -0.08 - lift, "o" if i < N else "|", color=KNOT, markersize=6 if i < N else 11, markeredgewidth=2)
        name = f"$t_{i}$" if i < N else f"$t_{N}$ = end"
        line.annotate(name, (x, -0.08 - lift), (8, 0), textcoords="offset points", va="center", color=KNOT)
    line.axvspan(a, b, color=INK, alpha=0.05, linewidth=0)
    line.annotate("one period", ((a + b) / 2, 1.13), ha="center", color=INK)
    line.set(xlim=(-0.35, 5.4), ylim=(-0.3, 1.22), xticks=range(6), yticks=[0, 1])
    line.spines[["top", "right", "left"]].set_visible(False)

    points = np.array([[2.4, 2.4], [0.2, 3.1], [0.1, 0.2], [4.4, 0.0], [4.5, 3.2]])
    points = np.roll(points, -1, axis=0)  # P₄ is the blossom at the seam: the corner
    curve = kw.Spline(space, points)
    kw.plot(curve, plane, knots=True)
    middle = points.mean(axis=0)
    for i, p in enumerate(points):
        away = (p - middle) / np.linalg.norm(p - middle)
        plane.annotate(f"$P_{i}$", p, 12 * away, textcoords="offset points", ha="center", va="center", color="#70757a")
    for i, x in enumerate(space.knots[:N]):
        p = curve(x)
        toward = (middle - p) / np.linalg.norm(middle - p)
        offset = 14 * toward if i else 32 * toward
        name = "" if i == 0 else f"$t_{i}$" if i > 1 else "$t_0=t_1$"
        plane.annotate(name, p, offset, textcoords="offset points", ha="center", va="center", color=KNOT)
    plane.margins(0.14)
    plane.set_axis_off()
    save(fig, "periodic.png")


def drawing() -> None:
    """Draw the rose as it is and as `knotwork reduce` leaves it, with the ends of all segments marked."""
    before = EXAMPLES / "rose.svg"
    with tempfile.TemporaryDirectory() as folder:
        after = Path(folder) / "rose.svg"
        cli.main(["reduce", str(before), "--tolerance", "0.2%", "-o", str(after)], standalone_mode=False)
        parts = [_with_nodes(path, x) for x, path in enumerate((before, after))]
    head = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 800 366" font-family="sans-serif" font-size="15">'
    (IMAGES / "rose.svg").write_text("\n".join([head, *parts, "</svg>\n"]))


def _with_nodes(path: Path, column: int) -> str:
    """Return a drawing in its column of the picture, with dots where its segments meet, and its size below."""
    text = path.read_text()
    x = 16 + 400 * column
    inner = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL)
    inner = inner.replace("<svg", f'<svg x="{x}"', 1)
    curves = kw.read(path)
    breaks = [c(c.space.breaks) for c in curves]
    dots = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.4"/>' for x, y in np.concatenate(breaks))
    segments = sum(len(points) - 1 for points in breaks)
    caption = f"{segments} segments, {path.stat().st_size / 1000:.1f} kB"
    return (
        f'{inner}<g transform="translate({x})"><g fill="{KNOT}" stroke="#fff" stroke-width=".4">{dots}</g>'
        f'<text x="184" y="350" text-anchor="middle" fill="{INK}">{caption}</text></g>'
    )


def reduction() -> None:
    """Draw the coast of Iceland in cubics that are at most 2 km off, as the demo does."""
    sys.path.append(str(EXAMPLES))
    from demo import DETAIL, picture

    before = kw.read(EXAMPLES / "iceland.csv")
    after = [kw.reduce(line, 2.0, distance="geometric", form="bezier").spline for line in before]
    picture(IMAGES / "iceland.png", before, after, DETAIL["iceland"])


if __name__ == "__main__":
    periodic()
    drawing()
    reduction()
