"""Find where Boehm's algorithm overtakes the merge, by degree: what `insert(method="auto")` goes by.

    python benchmarks/crossovers.py [--quick]

It prints the ratios of medians, and at the end the table that stands in knotwork/insertion/auto.py: whoever trusts the
run copies it there.
"""

import argparse

import numpy as np

import knotwork as kw
from knotwork.arithmetic import kernel
from knotwork.insertion import METHODS
from knotwork.insertion.refinement import refine
from methods import race

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
    """Return where Boehm's algorithm overtakes the merge, and print the ratios that say so."""
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
    return kept


def main():
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few rounds, noisier medians")
    rounds = 3 if parser.parse_args().quick else 11
    kernel.mode = "always"
    kept = crossovers(rounds)
    print("\nCROSSOVERS: dict[int, tuple[tuple[float, int], ...]] = {")
    for n, rows in kept.items():
        print(f"    {n}: {rows!r},")
    print("}")


if __name__ == "__main__":
    main()
