"""Race all methods of knot insertion and the peers that are installed: one run, turns interleaved, ratios of medians.

    python benchmarks/race.py [--quick] [--only WORD]     the race; the numbers go to benchmarks/race.json
    python benchmarks/race.py --crossovers                where Boehm's algorithm overtakes the merge, by degree

Curves, arrays in, arrays out, all kernels compiled before the clock runs. "whole" is `insert` with this method, checks
and bookkeeping included (which interval a new knot lies in, which vertices change); "kernel" leaves them out, as the
counts of the text do. Times are of the machine and the moment; what carries over are ratios to `insert` by itself.
"""

import argparse
import json
import statistics
import time
from pathlib import Path

import numpy as np

import knotwork as kw
from knotwork.arithmetic import kernel
from knotwork.insertion import METHODS
from knotwork.insertion.merge import refined
from knotwork.insertion.methods.setting import Setting
from knotwork.insertion.refinement import refine
from peers import installed
from run import readable, timed

HERE = Path(__file__).parent
TABLE = HERE.parent / "src" / "knotwork" / "insertion" / "crossovers.py"
#: (degree, old points, new knots, dimension, spread)
GRID = [
    *[(n, 16, 10, 3, "spread") for n in (2, 3, 5)],
    *[(n, 1000, 1000, d, "spread") for d in (1, 3) for n in (1, 2, 3, 5, 7)],
    *[(n, 16, 1000, d, "one interval") for d in (1, 3) for n in (1, 2, 3, 5, 7)],
    *[(n, 20_000, 200, 3, "spread") for n in (3, 7)],
    *[(n, 20_000, 20_000, 3, "spread") for n in (3, 5, 7)],
    *[(n, 16, 20_000, 3, "one interval") for n in (3, 5, 7)],
]


def problem(n, points, m, d, spread):
    """Return knots, new knots and points; the old knots are even, the new ones random, over all or in one interval."""
    rng = np.random.default_rng(n)
    t = kw.SplineSpace.clamped(n, points).knots
    middle = (len(t) - 1) // 2
    lo, hi = (t[0], t[-1]) if spread == "spread" else (t[middle], t[middle + 1])
    return t, np.sort(rng.uniform(lo, hi, m)), rng.random((points, d))


def contenders(t, W, P, n):
    """Return what is raced, by name and kind: `insert`, every method whole and its kernel alone, the peers."""
    ready = Setting(t, W, P, n)
    racers = {("insert", "whole"): lambda: kw.insert(kw.curve(P, n, t), W).coefficients}
    for name, method in METHODS.items():
        racers[name, "whole"] = lambda name=name: kw.insert(kw.curve(P, n, t), W, method=name).coefficients
        racers[name, "kernel"] = lambda method=method: method.points(ready)
    racers["merge", "kernel"] = lambda: refined(t, W, len(P), n, P[None], 0, len(P) + len(W))  # and its bookkeeping
    for name, peer in installed().items():
        if name != "knotwork" and peer.insert(t, n, P, W) is not None:
            racers[name, "peer"] = lambda peer=peer: peer.insert(t, n, P, W)
    return racers


def race(racers, rounds):
    """Return the median time of each in seconds; in every round each has a turn of warm calls."""
    calls, seconds = {}, {key: [] for key in racers}
    for key, run in racers.items():
        run()
        calls[key] = max(1, int(0.001 / timed(run, (), 1)))
    for _ in range(rounds):
        for key, run in racers.items():
            if rounds > 5 and seconds[key] and seconds[key][0] > 0.1 and len(seconds[key]) >= 3:
                continue  # it would only hold up the others
            run()
            seconds[key].append(timed(run, (), calls[key]))
    return {key: statistics.median(found) for key, found in seconds.items()}


def keep(name, lines):
    """Write one line of JSON for each dictionary, numbers to three digits."""
    text = ",\n".join(json.dumps(line) for line in lines)
    HERE.joinpath(name).write_text("[\n" + text + "\n]\n")


def short(x):
    """Return a number to three digits."""
    return float(f"{x:.3g}")


SHARES = (0.25, 0.5, 0.75, 0.99)
MANY = (100, 300, 1000, 3000, 10_000, 30_000)
WINS = 0.87  # the time of another method over that of the merge from which it is taken


def ratio(n, share, m, rounds):
    """Return the time of Boehm's algorithm over that of the merge, in 1-D or 3-D; that share of the knots is new."""
    found = []
    for d in (1, 3):
        old = np.linspace(0, 1, max(1, round(m / share) - m) + 2)
        rng = np.random.default_rng(m)
        curve = kw.curve(rng.random((len(old) + n - 1, d)), n, np.concatenate([[0] * n, old, [1] * n]))
        new = np.sort(rng.random(m))
        racers = {
            "merge": lambda c=curve, x=new: refine(c, 0, c.space.new_knots(x)),
            "boehm": lambda c=curve, x=new: METHODS["boehm"].run(c, x),
        }
        times = race(racers, rounds)
        found.append(times["boehm"] / times["merge"])
    return max(found)


def crossovers(rounds):
    """Print where Boehm's algorithm overtakes the merge, and keep it where `insert` finds it."""
    kept = {}
    for n in range(1, 10):
        rows = []
        for share in SHARES:
            ratios = [ratio(n, share, m, rounds) for m in MANY]
            print(
                f"degree {n}, {share:4.0%} new: "
                + "  ".join(f"{m}: {x:.2f}" for m, x in zip(MANY, ratios, strict=True)),
                flush=True,
            )
            wins = [all(x < WINS for x in ratios[i:]) for i in range(len(MANY))]
            if any(wins) and (not rows or MANY[wins.index(True)] < rows[-1][1]):
                rows.append((share, MANY[wins.index(True)]))
        if rows:
            kept[n] = tuple(rows)
    TABLE.write_text(
        '"""Where Boehm\'s algorithm overtakes the merge: written by benchmarks/race.py --crossovers."""\n\n'
        "#: degree: (share of new knots from the first to the last new one, least number of new knots), …\n"
        "CROSSOVERS: dict[int, tuple[tuple[float, int], ...]] = {\n"
        + "".join(f"    {n}: {rows!r},\n" for n, rows in kept.items())
        + "}\n"
    )


def main():
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few rounds, noisier medians")
    parser.add_argument("--only", default="", help="only cases whose line holds this word")
    parser.add_argument("--crossovers", action="store_true", help="measure what `method='auto'` goes by")
    options = parser.parse_args()
    kernel.mode = "always"
    rounds = 3 if options.quick else 11
    if options.crossovers:
        crossovers(rounds)
        return
    start, told = time.perf_counter(), []
    for case in GRID:
        n, points, m, d, spread = case
        title = f"degree {n}, {points} + {m} in {d}-D, {spread}"
        if options.only not in title:
            continue
        t, W, P = problem(*case)
        found = race(contenders(t, W, P, n), rounds)
        ours = found["insert", "whole"]
        ratios = {
            kind: {name: short(x / ours) for (name, k), x in found.items() if k == kind}
            for kind in ("whole", "kernel", "peer")
        }
        told.append(
            dict(zip(("degree", "points", "knots", "dim", "spread"), case, strict=True), insert=short(ours), **ratios)
        )
        print(f"\n{title}: insert {readable(1e6 * ours)}; times as long:", flush=True)
        for kind in ("whole", "kernel", "peer"):
            best = sorted((x, name) for name, x in ratios[kind].items() if name != "insert")
            shown = best if kind == "peer" else [*best[:6], *best[-2:]]
            print(f"  {kind:7}" + "  ".join(f"{name} {x:.2f}" for x, name in shown))
    if not options.only:
        keep("race.json", told)
    print(f"\n{time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
