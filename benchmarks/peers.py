"""Race Knotwork against the peers that are installed: one run, turns interleaved, medians, ratios to Knotwork.

    python benchmarks/peers.py [--quick] [--only WORD]

Cubic curves in 3-D; arrays in, arrays out, unless a line says "value": then a spline that is there already.
Absolute times are of the machine and the moment; the ratios are what carries over.
"""

import argparse
import os
import statistics
import subprocess
import sys
import time

import numpy as np

import knotwork as kw
from contenders import Pantr, installed
from knotwork.arithmetic import kernel


def cubic(n, seed=0):
    """Return knots and points of a clamped cubic with random points."""
    return kw.SplineSpace.clamped(3, n).knots, np.random.default_rng(seed).random((n, 3))


def new_knots(m):
    """Return m sorted random knots inside the domain."""
    return np.sort(np.random.default_rng(1).random(m))


def tasks():
    """Yield (name, goal in microseconds or None, task, arguments, rows for ns per row or None)."""
    for n, goal in ((10, 6), (1000, 15), (100_000, 150)):
        t, P = cubic(n)
        yield f"insert 1 knot, n = {n} (value)", goal, "insert_value", (kw.curve(P, 3, t), 0.5000123), None
        yield f"insert 1 knot, n = {n}", None, "insert", (t, 3, P, 0.5000123), None
    for n, m, goal in ((1000, 1000, 30), (100_000, 100_000, 1600), (10, 100_000, 1200)):
        t, P = cubic(n)
        yield f"refine {n} + {m}, random", goal, "insert", (t, 3, P, new_knots(m)), n + m
        yield f"refine {n} + {m}, even", goal, "insert", (t, 3, P, np.linspace(1e-6, 1 - 1e-6, m)), n + m
    u = np.random.default_rng(2).random(100_000)
    for n in (1000, 100_000):
        t, P = cubic(n)
        yield f"evaluate 1e5 points, n = {n}, sorted", 3300, "evaluate", (t, 3, P, np.sort(u)), 100_000
        yield f"evaluate 1e5 points, n = {n}, unsorted", 3300, "evaluate", (t, 3, P, u), 100_000
    t, P = cubic(1000)
    yield "derivatives 0 … 3 at 1e5 points, n = 1000", 9000, "derivatives", (t, 3, P, np.sort(u)), 100_000
    for n, goal in ((1000, None), (100_000, 10_000)):
        t, P = cubic(n)
        yield f"to Bézier, n = {n}", goal, "bezier", (t, 3, P), None
    t, P = cubic(1000)
    yield "elevate, n = 1000", None, "elevate", (t, 3, P), None
    yield "split, n = 1000", None, "split", (t, 3, P, 0.4321), None
    refined = kw.insert(kw.curve(P[:500], 3), new_knots(500))
    yield "remove 500 of 1000", None, "remove", (refined.space.knots, 3, refined.points, new_knots(500)), None
    x = np.linspace(0, 1, 1000)
    smooth = np.stack([np.sin(9 * x), np.cos(7 * x) * x, x**2], axis=1)
    yield "reduce 1000 to 1e-3", None, "reduce", (t, 3, smooth, 1e-3), None
    yield from geometry()
    for n, m, goal in ((100, 100, 300), (1000, 1000, 50_000)):
        t, _ = cubic(n)
        net = np.random.default_rng(3).random((n, n, 3))
        yield f"bicubic {n}² + {m} + {m}", goal, "surface", (t, 3, net, new_knots(m)), None


def geometry():
    """Yield tasks of geometry, in the plane."""
    rng = np.random.default_rng(4)
    t = kw.SplineSpace.clamped(3, 1000).knots
    wave = np.sin(np.linspace(0.01, 100 * np.pi, 1000)) + 0.01 * rng.standard_normal(1000)
    yield "zeros, n = 1000, 100 of them", None, "zeros", (t, 3, wave), None
    for n in (4, 100, 1000):
        space = kw.SplineSpace.clamped(3, n).knots
        polygons = [rng.standard_normal((n, 2)).cumsum(axis=0) for _ in range(2)]
        if n == 4:  # two waves: three crossings
            polygons = np.array([[[0, 0], [1, 3], [2, -3], [3, 0]], [[0, 1], [1, -3], [2, 3], [3, -1]]], float)
        yield f"intersect {n} with {n}", None, "intersect", tuple((P, 3, space) for P in polygons), None
    t = kw.SplineSpace.clamped(3, 100).knots
    P = rng.random((100, 2)).cumsum(axis=0)
    yield "closest to 10,000 points, n = 100", None, "closest", (t, 3, P, 50 * rng.random((10_000, 2))), 10_000
    yield "flatten to 1e-3, n = 100", None, "flatten", (t, 3, P, 1e-3), None
    near = P + 0.01 * rng.standard_normal(P.shape)
    yield "distance, n = 100", None, "distance", ((P, 3, t), (near, 3, t)), None


def timed(run, arguments, calls):
    """Return the mean time of so many calls in seconds."""
    start = time.perf_counter()
    for _ in range(calls):
        run(*arguments)
    return (time.perf_counter() - start) / calls


def race(contenders, arguments, quick):
    """Return the median time of each contender in microseconds, their turns interleaved."""
    batches = {}
    for name, run in contenders.items():
        if run(*arguments) is None:
            continue
        once = timed(run, arguments, 1)
        if once < 1:  # slower ones would only hold up the rest
            once = timed(run, arguments, 1 + int(0.01 / once))
            batches[name] = 1 + int(0.005 / once)  # as many warm calls per turn
    times = {name: [] for name in batches}
    budget, start, rounds = (0.3 if quick else 2.0), time.perf_counter(), 0
    while rounds < 5 or (time.perf_counter() - start < budget and rounds < 500):
        for name, calls in batches.items():
            run = contenders[name]
            time.sleep(0.01)  # the threads of the one before come to rest
            timed(run, arguments, 1 + calls // 2)
            times[name].append(timed(run, arguments, calls))
        rounds += 1
    return {name: 1e6 * statistics.median(found) for name, found in times.items()}


def thread_gains():
    """Yield large jobs and how many times as long they take on one processor as on all, turns interleaved."""
    (t, P), (s, _), net = cubic(100_000), cubic(1000), np.random.default_rng(3).random((1000, 1000, 3))
    curve, surface, few, many = kw.curve(P, 3, t), kw.surface(net, (3, 3), (s, s)), new_knots(1000), new_knots(100_000)
    jobs = {
        "refine 100000 + 100000": lambda: kw.insert(curve, many),
        "refine 10 + 100000": lambda: kw.insert(kw.curve(P[:10]), many),
        "bicubic 1000² + 1000 + 1000": lambda: kw.insert(kw.insert(surface, few, 0), few, 1),
    }
    given = os.environ.get("KNOTWORK_THREADS", "")
    for name, job in jobs.items():
        found = {"1": [], given: []}
        for _ in range(30):
            for threads, seconds in found.items():
                os.environ["KNOTWORK_THREADS"] = threads
                job()
                seconds.append(timed(job, (), 1))
        yield name, statistics.median(found["1"]) / statistics.median(found[given])
    os.environ["KNOTWORK_THREADS"] = given


def import_ratio():
    """Return the time of `import knotwork` over that of `import numpy`, medians of fresh processes in turn."""
    found = {"numpy": [], "knotwork": []}
    for _ in range(7):
        for name, seconds in found.items():
            code = f"import time; a = time.perf_counter(); import {name}; print(time.perf_counter() - a)"
            seconds.append(float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout))
    return statistics.median(found["knotwork"]) / statistics.median(found["numpy"])


def _ratio(x):
    """Return a ratio with one digit after the point, small ones with two digits."""
    return f"{x:.1f}" if x >= 0.95 else f"{x:.2g}"


def readable(microseconds):
    """Return a time in µs or ms."""
    return f"{microseconds:.1f} µs" if microseconds < 1000 else f"{microseconds / 1000:.2f} ms"


def main():
    """Run the race and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="short runs, noisier medians")
    parser.add_argument("--only", default="", help="only tasks whose name holds this word")
    options = parser.parse_args()
    kernel.mode = "always"
    contenders = installed()
    others = [name for name in contenders if name != "knotwork"]
    print(f"{os.cpu_count()} processors; numpy {np.__version__}; peers: {', '.join(others) or 'none installed'}\n")
    print(f"{'task':46}{'goal':>10}{'knotwork':>11}{'per row':>10}   times as long as knotwork")
    for name, goal, task, arguments, rows in tasks():
        if options.only not in name:
            continue
        runs = {peer: getattr(methods, task) for peer, methods in contenders.items() if hasattr(methods, task)}
        if task == "insert_value" and "pantr" in runs:
            spline = arguments[0]
            native = Pantr._curve(spline.space.knots, 3, spline.points)
            runs["pantr"] = lambda _, u, native=native: native.insert_knots([u])
        found = race(runs, arguments, options.quick)
        ours = found.pop("knotwork")
        per_row = f"{1000 * ours / rows:.1f} ns" if rows else ""
        ratios = "  ".join(f"{peer} {_ratio(time / ours)}" for peer, time in sorted(found.items(), key=lambda x: x[1]))
        mark = "" if goal is None else readable(goal)
        print(f"{name:46}{mark:>10}{readable(ours):>11}{per_row:>10}   {ratios}", flush=True)
    if not options.only:
        gains = ", ".join(f"{name}: {gain:.2f}" for name, gain in thread_gains())
        print(f"\none processor takes so many times as long as all ({gains})")
        print(f"\nimport knotwork takes {import_ratio():.2f} times as long as import numpy (goal: 1.3)")


if __name__ == "__main__":
    main()
