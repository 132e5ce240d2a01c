"""Where Boehm's algorithm overtakes the merge: written by benchmarks/race.py --crossovers."""

#: degree: (share of new knots from the first to the last new one, least number of new knots), …
CROSSOVERS: dict[int, tuple[tuple[float, int], ...]] = {
    4: ((0.99, 1000),),
    5: ((0.75, 3000), (0.99, 1000)),
    6: ((0.75, 1000),),
    7: ((0.75, 1000),),
    8: ((0.75, 1000),),
    9: ((0.5, 1000), (0.99, 300)),
}
