"""Reduce a drawing and a coastline to a tolerance, and show what happened: the files are in demo/."""

import os
from pathlib import Path

import matplotlib

matplotlib.use("agg")
from matplotlib import pyplot as plt

import knotwork as kw
from knotwork import cli
from knotwork.plotting import INK, KNOT, NET, PALE

HERE = Path(__file__).parent
DEMO = HERE.parent / "demo"
#: the magnified part of each picture: the middle and the width
DETAIL = {"rose": (100, 225, 70), "iceland": (-205, 112, 55)}


def command(*words: object) -> None:
    """Run the command `knotwork` as a shell would, and show it."""
    texts = [os.path.relpath(word) if isinstance(word, Path) else str(word) for word in words]
    print("\n$ knotwork", *texts, flush=True)
    cli.main(texts, standalone_mode=False)


def picture(path: Path, before: list[kw.Spline], after: list[kw.Spline], window: tuple[float, float, float]) -> None:
    """Draw the whole, and a window of it with control points and knots."""
    fig, (whole, detail) = plt.subplots(1, 2, figsize=(15, 7.4), width_ratios=[1.1, 1], layout="constrained")
    fig.get_layout_engine().set(w_pad=0.1, h_pad=0.1)
    kw.plot(before, whole, control=False, knots=False, color=PALE, linewidth=2.5)
    kw.plot(after, whole, control=False, knots=False, linewidth=0.8)
    kw.plot(after, detail, before=before)
    small = next(line for line in detail.lines if line.get_color() == NET).get_markersize()
    for line in detail.lines:
        line.set_markersize(5.5 / small * line.get_markersize())
    x, y, width = window
    detail.set(xlim=(x - width / 2, x + width / 2), ylim=(y - width / 2, y + width / 2))
    for ax in (whole, detail):
        ax.set(xticks=[], yticks=[])
        ax.spines[:].set_color(KNOT)
        if path.stem == "rose":
            ax.invert_yaxis()  # in SVG, y points down
    whole.set_frame_on(False)
    whole.add_patch(plt.Rectangle((x - width / 2, y - width / 2), width, width, fill=False, edgecolor=KNOT))
    counts = [sum(s.space.dimension for s in splines) for splines in (before, after)]
    whole.set_title(f"{path.stem}: {counts[0]:,} control points before, {counts[1]:,} after", color=INK)
    detail.set_title("before (pale), after (dark), its control points (rings) and knots (dots)", color=INK)
    fig.savefig(path, dpi=100)


def main() -> None:
    """Run both reductions and draw them."""
    DEMO.mkdir(exist_ok=True)
    coast, drawing = HERE / "iceland.csv", HERE / "rose.svg"
    command("reduce", drawing, "--tolerance", "0.2%", "-o", DEMO / "rose.svg")
    command("reduce", coast, "--form", "bezier", "--tolerance", 2, "-o", DEMO / "iceland.json")
    command("convert", DEMO / "iceland.json", "--flip", "-o", DEMO / "iceland.svg")
    picture(DEMO / "rose.png", kw.read(drawing), kw.read(DEMO / "rose.svg"), DETAIL["rose"])
    picture(DEMO / "iceland.png", kw.read(coast), kw.read(DEMO / "iceland.json"), DETAIL["iceland"])
    print(f"\nIn {DEMO}:")
    for name in DETAIL:
        print(f"  {name}.svg is the result, {name}.png shows before and after")


if __name__ == "__main__":
    main()
