"""Drawings made lighter: of thousands, that each opens, is as it was outside its outlines, and looks the same.

Usage: ``python benchmarks/drawings.py [--sample 300] [--peers 40] [--only NAME] [--cache build/drawings]``

The drawings are Open Clip Art (Debian's package openclipart-svg) and icons of five npm packages; they are fetched
into the cache, as are resvg and svgo. Each drawing is reduced at 0.2 % of its extent. Then

- all bytes outside `d` and `points` must be equal, and there may be no more bytes than before;
- resvg draws it before and after, 1,000 pixels wide: no edge may be farther off than the tolerance and a pixel; what
  looks different there is drawn by Chromium too, as resvg spans gradients over the boxes of control points;
- Chromium must open some of them;
- some are compared with svgo, and with Inkscape's simplify and svgo at the distance that is measured between what
  Inkscape wrote and what it read.

The pace is that of one core: read, reduced, proven and written, without writing the file.
"""

from __future__ import annotations

import argparse
import random
import re
import shutil
import sys
import time
import warnings
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.ndimage import distance_transform_edt, maximum_filter, minimum_filter
from scipy.spatial import cKDTree

import knotwork as kw
from drawing_tools import Chromium, Node, fetched, simplified
from knotwork.errors import KnotworkError
from knotwork.files.lighter import lighter
from knotwork.geometry.sampling import even_steps

PART = 0.002
#: levels of 255 between neighbouring pixels that make an edge; antialiasing may spread it, to a quarter of that
SHADES = 64
#: samples on a curve for a distance that is measured
SAMPLES = 400
DATA = re.compile(rb"""\b(?:d|points)\s*=\s*(?:"[^"]*"|'[^']*')""")


class Lighter(NamedTuple):
    """A drawing made lighter."""

    path: Path
    before: bytes
    after: bytes
    segments: tuple[int, int]
    #: in px of the drawing
    tolerance: float


def made_lighter(path: Path, tolerance: float | None = None) -> Lighter | None:
    """Return a drawing made lighter; None if it has no outlines."""
    drawing = kw.open(path)
    allowed = PART * drawing.extent() if tolerance is None else tolerance
    if not drawing.splines or allowed == 0:
        return None
    found = lighter(drawing, allowed)
    data, rounded = found.document.bytes()
    assert found.bound + rounded <= allowed
    return Lighter(path, path.read_bytes(), data, found.segments, allowed)


def view_scale(data: bytes, width: float, height: float) -> float:
    """Return how many px a unit of the outermost svg element is, at most."""
    box = re.search(rb"<svg\b[^>]*\bviewBox\s*=\s*[\"']([^\"']*)", data)
    sizes = [float(x) for x in re.split(rb"[\s,]+", box[1].strip())[2:]] if box else []
    return max(width / sizes[0], height / sizes[1]) if len(sizes) == 2 and min(sizes) > 0 else 1.0


def farther(before: np.ndarray, after: np.ndarray, radius: float) -> int:
    """Return how many pixels at edges of one image are farther than that from all edges of the other."""
    if before.shape != after.shape:
        return before.size
    if np.array_equal(before, after):
        return 0
    steep = [(maximum_filter(x, (3, 3, 1)) - minimum_filter(x, (3, 3, 1))).max(axis=2) for x in (before, after)]
    rim = int(radius) + 1  # of what is nearer to the rim, a part is not seen
    inside = np.s_[rim:-rim, rim:-rim]
    wrong = 0
    for one, other in (steep, steep[::-1]):
        far = distance_transform_edt(other <= SHADES / 4) > radius
        wrong += int((far & (one > SHADES))[inside].sum())
    return wrong


def measured(one: Path, other: Path) -> float:
    """Return the distance between the outlines that two drawings draw, by samples: Hausdorff, in user units."""
    clouds = [np.concatenate([c(even_steps(c, SAMPLES)) for c in kw.read(path)]) for path in (one, other)]
    trees = [cKDTree(points) for points in clouds]
    return float(max(trees[0].query(clouds[1])[0].max(), trees[1].query(clouds[0])[0].max()))


def checked(name: str, files: list[Path], node: Node, chromium: int) -> list[Lighter]:
    """Print what became of a package; return its drawings."""
    made, refused, seconds = [], [], []
    for path in files:
        start = time.process_time()
        try:
            found = made_lighter(path)
        except KnotworkError as exc:
            refused.append(f"{path.name}: {exc}")
            continue
        seconds.append(time.process_time() - start)
        if found:
            made.append(found)
    smaller = sum(len(each.after) < len(each.before) for each in made)
    larger = sum(len(each.after) > len(each.before) for each in made)
    outside = [each for each in made if DATA.sub(b"", each.before) != DATA.sub(b"", each.after)]
    sizes = [sum(len(each[k]) for each in made) for k in (1, 2)]
    segments = [sum(each.segments[k] for each in made) for k in (0, 1)]
    browser = Chromium()
    unseen, unlike = [], []
    for each in made:
        if each.after == each.before:
            continue
        before, after = node.render(each.before), node.render(each.after)
        if isinstance(before, str) or isinstance(after, str):
            if not isinstance(before, str):
                unseen.append(f"{each.path.name}: {after}")
            continue
        (image, scale), (height, width, _) = before, before[0].shape
        allowed = each.tolerance * view_scale(each.before, width / scale, height / scale) * scale
        if farther(image, after[0], allowed + 1):
            images = [browser.render(data, width, height) for data in (each.before, each.after)]
            pixels = farther(*images, allowed + 1) if images[0] is not None else 0
            if pixels:
                unlike.append(f"{each.path}: {pixels} pixels, within {allowed + 1:.1f}")
    shown = [each for each in made[:chromium] if browser.opens(each.before)]
    closed = sum(not browser.opens(each.after) for each in shown)
    browser.close()
    without = len(files) - len(made) - len(refused)
    print(f"{name}: {len(made):,} drawings, {without} without outlines, {len(refused)} refused")
    print(f"  {100 * smaller / len(made):.1f} % smaller, {larger} larger, {len(outside)} changed outside their data")
    print(
        f"  {sizes[0]:,} → {sizes[1]:,} bytes ({sizes[1] / sizes[0]:.3f}), {segments[0]:,} → {segments[1]:,} segments"
    )
    print(f"  {len(seconds) / sum(seconds):.0f} per second, the median drawing in {1000 * np.median(seconds):.1f} ms")
    print(f"  resvg does not open {len(unseen)}, Chromium {closed} of {len(shown)}")
    print(f"  an edge is farther than the tolerance and a pixel in {len(unlike)}", flush=True)
    for text in (*refused[:8], *unseen[:8], *unlike[:12]):
        print(f"    {text}", file=sys.stderr)
    return made


def raced(made: list[Lighter], node: Node, folder: Path) -> None:
    """Print the bytes of some drawings beside those of svgo, and of Inkscape and svgo."""
    svgo = [len(node.svgo(each.before)) for each in made]
    ours = [len(node.svgo(each.after)) for each in made]
    total = sum(len(each.before) for each in made)
    print(
        f"  {len(made)} of them: svgo {sum(svgo) / total:.3f} of the bytes, Knotwork and svgo {sum(ours) / total:.3f}"
    )
    if not shutil.which("inkscape"):
        print("  Inkscape is not installed")
        return
    rows = []
    for each, path in zip(made, simplified([each.path for each in made], folder), strict=True):
        if path is None:
            continue
        try:
            away = measured(each.path, path)
            again = made_lighter(each.path, away) if away > 0 else each
        except KnotworkError:
            continue
        if again:
            theirs = node.svgo(path.read_bytes())
            rows.append(
                [len(each.before), len(theirs), len(again.after), len(node.svgo(again.after)), away / each.tolerance]
            )
    if rows:
        given, theirs, alone, both, away = np.array(rows).T
        inkscape, alone, both = (each.sum() / given.sum() for each in (theirs, alone, both))
        print(
            f"  {len(rows)} at the distance of Inkscape's simplify ({np.median(away):.1f} × 0.2 % in the median):"
            f" Inkscape and svgo {inkscape:.3f} of the bytes, Knotwork {alone:.3f}, Knotwork and svgo {both:.3f}",
            flush=True,
        )


def main() -> None:
    """Fetch, reduce, check, race."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sample", type=int, default=0, help="so many of each package  [all]")
    parser.add_argument("--peers", type=int, default=40, help="of these, so many beside svgo and Inkscape")
    parser.add_argument("--chromium", type=int, default=100, help="of these, so many in Chromium")
    parser.add_argument("--only", help="one package")
    parser.add_argument("--cache", type=Path, default=Path("build/drawings"))
    asked = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)  # what is damaged in a drawing
    packages = fetched(asked.cache)
    node = Node(asked.cache)
    for name, files in packages.items():
        if asked.only in (None, name):
            some = random.Random(1).sample(files, min(asked.sample or len(files), len(files)))
            made = checked(name, some, node, asked.chromium)
            if asked.peers:
                raced(made[: asked.peers], node, asked.cache / "inkscape" / name)


if __name__ == "__main__":
    main()
