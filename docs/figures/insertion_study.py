"""Make the pictures of insertion/counts.md, errors.md and speed.md: python docs/figures/insertion_study.py.

Counts are made anew; errors and times are those that `make accuracy` and `make methods` left in benchmarks/.
"""

import json
from dataclasses import astuple

import numpy as np
from common import GOLD, GREEN, GREY, PLUM, ROOT, plain, plt, save

import knotwork as kw
from knotwork.insertion import METHODS, count
from knotwork.plotting import INK, KNOT

MEASURED = ROOT / "benchmarks"

#: methods that pictures compare, with their colour and the dash of the line
SHOWN = {
    "boehm": (INK, "-"),
    "oslo": (KNOT, "-"),
    "oslo-improved": (KNOT, (0, (4, 2))),
    "goldman-modified": (GOLD, "-"),
    "goldman-modified-improved": (GOLD, (0, (4, 2))),
    "sablonniere": (GREEN, "-"),
    "sablonniere-improved": (GREEN, (0, (4, 2))),
    "goldman-sablonniere-recursive": (GREEN, (0, (1, 1.5))),
    "factored": (PLUM, "-"),
    "factored-split": (PLUM, (0, (4, 2))),
    "merge": ("black", (0, (1, 1.5))),
}


def spread(n, m, intervals, d=3):
    """Return a curve of uneven knots, and m new ones: evenly shared out among so many intervals, at uneven places."""
    i = np.arange(2 * n + max(intervals, 1) + 2.0)
    t = i * (1 + i / 128)
    rng = np.random.default_rng(7)
    at = n + (np.arange(m) * intervals) // m
    return kw.curve(np.outer(i[: len(t) - n - 1], np.ones(d)), n, t), t[at] + (t[at + 1] - t[at]) * rng.uniform(
        0.1, 0.9, m
    )


def operations(name, curve, new):
    """Return additions, multiplications and divisions together."""
    return sum(astuple(count(name, curve, new))[:3])


def counts():
    """Draw counts against degree, against the spread of the new knots, and against the dimension."""
    fig, (left, middle, right) = plt.subplots(1, 3, figsize=(12.5, 4.4), layout="constrained")
    degrees, m = range(1, 9), 48
    for name, (colour, dash) in SHOWN.items():
        if name != "merge":
            found = [count(name, *spread(n, m, 1)).combinations / m for n in degrees]
            left.plot(degrees, found, color=colour, linestyle=dash, marker=".", label=name)
    left.plot([], color="black", linestyle=(0, (1, 1.5)), marker=".", label="merge")
    left.legend(frameon=False, handlelength=3, fontsize=8, loc="upper left")
    plain(left, title=f"{m} knots in one interval", xlabel="degree", ylabel="combinations per knot", ylim=(0, 50))
    few, shares = 24, (1, 2, 4, 8, 24, 48, 96)
    for name, (colour, dash) in SHOWN.items():
        found = [operations(name, *spread(3, few, k)) / few for k in shares]
        middle.plot([k / few for k in shares], found, color=colour, linestyle=dash, marker=".")
    plain(
        middle, title=f"cubics in 3-D, {few} knots spread", xlabel="intervals per knot", xscale="log",
        ylabel="operations per knot", ylim=(0, 165),
    )  # fmt: skip
    middle.set_xticks([1 / 24, 1 / 4, 1, 4], ["1/24", "1/4", "1", "4"])
    middle.minorticks_off()
    forms = {
        "boehm": (INK, "-"), "boehm-rewritten": (INK, (0, (4, 2))), "factored": (PLUM, "-"),
        "oslo-row": (KNOT, "-"), "goldman-row": (GOLD, "-"), "merge": ("black", (0, (1, 1.5))),
    }  # fmt: skip
    dims = (1, 2, 3, 4, 6, 8, 12)
    for name, (colour, dash) in forms.items():
        found = [operations(name, *spread(3, few, 1, d)) / (few * d) for d in dims]
        right.plot(dims, found, color=colour, linestyle=dash, marker=".", label=name)
    plain(
        right,
        title=f"cubics, {few} knots in one interval",
        xlabel="dimension d",
        ylabel="operations per knot and coordinate",
    )
    right.set_ylim(0)
    right.legend(frameon=False, handlelength=3, fontsize=8)
    save(fig, "insertion/counts.png", dpi=130)


def errors():
    """Draw worst and typical errors against degree, for even and ill-spaced knots."""
    told = json.loads((MEASURED / "accuracy.json").read_text())
    spacings = list(dict.fromkeys(line["spacing"] for line in told))
    fig, axes = plt.subplots(1, len(spacings), figsize=(13.5, 4.4), layout="constrained", sharey=True)
    lines = {
        "boehm": (INK, "-"), "boehm-rewritten": (INK, (0, (1, 1.5))), "merge": ("black", (0, (4, 2))),
        "morken": (GREY, "-"), "oslo": (KNOT, "-"), "sablonniere": (GREEN, "-"),
        "factored": (PLUM, "-"), "factored-split": (PLUM, (0, (4, 2))),
    }  # fmt: skip
    for ax, spacing in zip(axes, spacings, strict=True):
        for name, (colour, dash) in lines.items():
            found = {line["degree"]: line["errors"][name] for line in told if line["spacing"] == spacing}
            ax.plot(list(found), [worst for _, worst in found.values()], color=colour, linestyle=dash, label=name)
            ax.plot(list(found), [typical for typical, _ in found.values()], ".", color=colour, markersize=4)
        ax.axhline(2.0**53, color=GREY, linewidth=0.6)
        plain(ax, title=spacing, xlabel="degree", yscale="log", ylim=(0.3, 1e22))
    axes[0].set_ylabel("error in units of $2^{-53}$")
    axes[1].annotate("as large as the points", (1, 2.0**53), (0, 3), textcoords="offset points", fontsize=8, color=GREY)
    axes[0].legend(frameon=False, handlelength=3, fontsize=8, loc="upper left", bbox_to_anchor=(0, 0.98))
    save(fig, "insertion/errors.png", dpi=130)


def speed():
    """Draw the times of all kernels as ratios to that of the merge."""
    told = [line for line in json.loads((MEASURED / "methods.json").read_text()) if line["dim"] == 3]
    sizes = [(16, 1000), (1000, 1000), (20_000, 20_000)]
    names = [name for name, method in METHODS.items() if name != "merge" and not method.name.endswith("-rewritten")]
    fig, axes = plt.subplots(1, len(sizes), figsize=(12, 8.2), layout="constrained", sharey=True)
    for ax, (points, m) in zip(axes, sizes, strict=True):
        for degree, colour in ((3, INK), (5, GREEN), (7, KNOT)):
            (line,) = [x for x in told if (x["points"], x["knots"], x["degree"]) == (points, m, degree)]
            found = [line["kernel"][name] / line["kernel"]["merge"] for name in names]
            ax.plot(found, range(len(names)), "o", color=colour, markersize=4.5, label=f"degree {degree}")
        ax.axvline(1, color=GREY, linewidth=0.8)
        plain(
            ax,
            title=f"{points} points + {m} knots, {line['spread']}",
            xscale="log",
            xlabel="times as long as the merge",
        )
        ax.grid(axis="y", alpha=0.3)
        ax.set_xticks([0.2, 0.5, 1, 2, 5, 10], ["0.2", "0.5", "1", "2", "5", "10"])
        ax.minorticks_off()
    axes[0].set_yticks(range(len(names)), names, fontsize=8)
    axes[0].invert_yaxis()
    axes[0].legend(frameon=False, loc="lower right")
    save(fig, "insertion/speed.png", dpi=130)


if __name__ == "__main__":
    for picture in (counts, errors, speed):
        picture()
