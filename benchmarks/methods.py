"""Race all methods of knot insertion and the peers that are installed: one run, turns interleaved, ratios of medians.

    python benchmarks/methods.py [--quick] [--only WORD]     the numbers go to benchmarks/methods.json

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
from contenders import installed
from knotwork.arithmetic import kernel
from knotwork.insertion import METHODS
from knotwork.insertion.merge import refined_blocks
from knotwork.insertion.methods.problem import Problem
from peers import readable, timed

HERE = Path(__file__).parent
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
    ready = Problem(t, W, P, n)
    racers = {("insert", "whole"): lambda: kw.insert(kw.curve(P, n, t), W).coefficients}
    for name, method in METHODS.items():
        racers[name, "whole"] = lambda name=name: kw.insert(kw.curve(P, n, t), W, method=name).coefficients
        racers[name, "kernel"] = lambda method=method: method.points(ready)
    racers["merge", "kernel"] = lambda: refined_blocks(t, W, len(P), n, P[None], 0, len(P) + len(W))
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


def main():
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few rounds, noisier medians")
    parser.add_argument("--only", default="", help="only cases whose line holds this word")
    options = parser.parse_args()
    kernel.mode = "always"
    rounds = 3 if options.quick else 11
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
        keep("methods.json", told)
    print(f"\n{time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
