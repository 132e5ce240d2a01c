"""What the commands say about splines: facts, and tables that a person likes to read."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Sequence
from decimal import MAX_EMAX, MIN_EMIN, Context, Decimal, localcontext
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from knotwork import Spline, SplineSpace

#: curves that a table shows one by one; of longer lists the largest and the sum of the others
ROWS = 12


def kind(spline: Spline) -> str:
    """Return the kind of a spline in words."""
    names = {1: "curve", 2: "surface", 3: "volume"}
    words = [names.get(spline.parameters, f"{spline.parameters}-parameter spline")]
    if any(space.periodic for space in spline.spaces):
        words.insert(0, "closed" if spline.parameters == 1 else "periodic")
    if spline.rational:
        words.insert(0, "rational")
    return " ".join(words) + (" of numbers" if spline.scalar else f" in {spline.dim}-D")


def repetitions(space: SplineSpace) -> tuple[dict[int, int], list[int]]:
    """Return how many interior knots have each multiplicity, and the multiplicities of the ends.

    In a periodic space all knots are interior, and there are no ends.
    """
    from knotwork.knots import multiplicities

    found = multiplicities(space.knots, space.breaks).tolist()
    inside, ends = (found[:-1], []) if space.periodic else (found[1:-1], [found[0], found[-1]])
    return dict(sorted(Counter(inside).items())), ends


def continuity(space: SplineSpace) -> int | None:
    """Return the least continuity that the knots allow inside the domain, -1 for a jump; None for a single piece."""
    inside, _ = repetitions(space)
    return space.degree - max(inside) if inside else None


def facts(spline: Spline) -> dict[str, Any]:
    """Return what there is to know about a spline, lists have one entry per parameter."""
    spread = [repetitions(space) for space in spline.spaces]
    real = spline.coefficients.dtype.kind != "c"
    return {
        "kind": kind(spline),
        "dimension": spline.dim,
        "rational": spline.rational,
        "dtype": "exact" if spline.coefficients.dtype == object else str(spline.coefficients.dtype),
        "degree": list(spline.degree),
        "points": [space.dimension for space in spline.spaces],
        "periodic": [space.periodic for space in spline.spaces],
        "pieces": [len(space.breaks) - 1 for space in spline.spaces],
        "knots": [{"inside": {str(m): count for m, count in inside.items()}, "ends": ends} for inside, ends in spread],
        "continuity": [continuity(space) for space in spline.spaces],
        "domain": [list(space.domain) for space in spline.spaces],
        "bounds": spline.bounds.tolist() if real else None,
    }


def described(spline: Spline) -> list[tuple[str, str]]:
    """Return the facts of a spline as names and texts."""
    f = facts(spline)
    return [
        ("kind", f["kind"] + ("" if f["dtype"] == "float64" else f", {f['dtype']}")),
        ("degree", _by(f["degree"])),
        ("points", _by(f"{n:,}" for n in f["points"])),
        ("pieces", _by(f"{n:,}" for n in f["pieces"])),
        *[("knots" + _letter(spline, i), _knots(space)) for i, space in enumerate(spline.spaces)],
        ("continuity", _by(map(_smooth, f["continuity"]))),
        ("domain", _by(map(interval, f["domain"]))),
        ("bounds", _by(map(interval, zip(*f["bounds"], strict=True))) if f["bounds"] else "complex numbers"),
    ]


def summary(splines: Sequence[Spline]) -> str:
    """Return a text about a few splines, a table about many."""
    if len(splines) <= 3:
        return "\n\n".join(
            "\n".join([f"[{i}]", *(f"  {name:<12}{text}" for name, text in described(s))])
            for i, s in enumerate(splines)
        )
    rows = []
    for i, s in enumerate(splines):
        told = dict(described(s))
        knots = " | ".join(_knots(space) for space in s.spaces)
        rows.append([str(i), told["kind"], told["degree"], told["points"], told["continuity"], knots, told["bounds"]])
    return table("><>><<<", ["#", "kind", "degree", "points", "continuity", "knots inside; ends", "bounds"], rows)


def comparison(rows: Sequence[dict[str, Any]]) -> str:
    """Return the table of what was done to each spline: points and pieces before and after, bound and time."""
    shown = rows if len(rows) <= ROWS else sorted(rows, key=lambda r: -math.prod(r["points"][0]))[: ROWS - 1]
    rest = [r for r in rows if r not in shown]
    cells = [_compared(str(r["index"]), [r]) for r in shown]
    if rest:
        cells.append(_compared(f"{len(rest)} others", rest))
    total = _compared("all", rows) if len(rows) > 1 else None
    return table(">>>>>>>>", ["#", "degree", "points", "→ after", "pieces", "→ after", "bound", "time"], cells, total)


def conversions(rows: Sequence[dict[str, Any]]) -> str:
    """Return how many splines were converted in which way, and whether exactly."""
    kinds = Counter((r["how"], "exact" if r["exact"] else "within the bound") for r in rows)
    return "; ".join(f"{counted(n, 'spline')} by {how}, {exactly}" for (how, exactly), n in sorted(kinds.items()))


def _compared(name: str, rows: Sequence[dict[str, Any]]) -> list[str]:
    if len(rows) == 1:  # each direction by itself
        counts = [_by(f"{n:,}" for n in rows[0][what][i]) for what in ("points", "pieces") for i in (0, 1)]
    else:
        counts = [f"{sum(math.prod(r[what][i]) for r in rows):,}" for what in ("points", "pieces") for i in (0, 1)]
    degrees = sorted({_by(r["degree"]) for r in rows})
    bounds = [r["bound"] for r in rows]
    return [
        name,
        degrees[0] if len(degrees) == 1 else f"{degrees[0]}–{degrees[-1]}",
        *counts,
        shown(max(bounds), 3),
        duration(sum(r["seconds"] for r in rows)),
    ]


def conditions(rows: Sequence[dict[str, Any]]) -> str:
    """Return the table of condition numbers: of each basis, and of inserting knots if any were."""
    header = ["#", "degree", "points", "basis"]
    cells = [[str(r["index"]), str(r["degree"]), f"{r['points']:,}", shown(r["basis"])] for r in rows]
    if rows and "insertion" in rows[0]:
        header += ["insertion", "one knot ≤", "relative error ≤"]
        for line, r in zip(cells, rows, strict=True):
            error = "–" if r["error"] is None else shown(r["error"], 2)
            line += [shown(r["insertion"]), shown(r["worst"]), error]
    return table(">" * len(header), header, cells)


def table(align: str, header: Sequence[str], rows: Sequence[Sequence[str]], total: Sequence[str] | None = None) -> str:
    """Return rows aligned under a header, a last one below a rule."""
    every = [header, *rows, *([total] if total else [])]
    widths = [max(len(row[i]) for row in every) for i in range(len(header))]
    lines = ["  ".join(f"{c:{a}{w}}" for c, a, w in zip(row, align, widths, strict=True)).rstrip() for row in every]
    rule = "─" * max(map(len, lines))
    lines.insert(1, rule)
    if total:
        lines.insert(-1, rule)
    return "\n".join(lines)


def as_json(told: Any) -> str:
    """Return something as JSON: exact numbers as floats, and as text like "-1/3" where float64 does not reach."""
    return json.dumps(told, indent=2, ensure_ascii=False, default=lambda x: str(x) if _rounded(x) is None else float(x))


def shown(x: Any, digits: int = 6) -> str:
    """Return a number with so many digits, be it beyond float64."""
    if _rounded(x) is not None:
        return f"{float(x):.{digits}g}"
    with localcontext(Context(prec=digits, Emax=MAX_EMAX, Emin=MIN_EMIN)):
        return f"{(Decimal(x.numerator) / Decimal(x.denominator)).normalize():g}"


def upward(x: Any) -> Any:
    """Return a bound as the least float that is no smaller, or as it is if there is none."""
    if _rounded(x) is None:
        return x
    near = float(x)
    return near if near >= x else math.nextafter(near, math.inf)


def _rounded(x: Any) -> float | None:
    """Return the float nearest to a number; None if there is none or it is 0 and the number is not."""
    try:
        near = float(x)
    except OverflowError:
        return None
    return near if near or not x else None


def interval(ends: Sequence[Any]) -> str:
    """Return an interval as a text."""
    return f"[{shown(ends[0])}, {shown(ends[1])}]"


def error_of(bound: float) -> str:
    """Return what there is to say about the error of what was written."""
    return f", with an error of at most {bound:.3g}" if bound else ""


def duration(seconds: float) -> str:
    """Return a time with its unit."""
    return f"{seconds * 1000:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"


def counted(n: int, what: str, many: str | None = None) -> str:
    """Return a count with its noun, of which `many` is the plural if that takes more than an s."""
    return f"{n:,} {what if n == 1 else many or what + 's'}"


def _knots(space: SplineSpace) -> str:
    inside, ends = repetitions(space)
    told = [f"{count:,} of multiplicity {m}" for m, count in inside.items()] or ["none inside"]
    return ", ".join(told) + (f"; ends {ends[0]} and {ends[1]}" if ends else "")


def _smooth(order: int | None) -> str:
    return "one piece" if order is None else "jumps" if order < 0 else f"C{order}"


def _letter(spline: Spline, axis: int) -> str:
    return "" if spline.parameters == 1 else f" {'uvw'[axis]}" if axis < 3 else f" {axis}"


def _by(parts: Any) -> str:
    return " × ".join(map(str, parts))
