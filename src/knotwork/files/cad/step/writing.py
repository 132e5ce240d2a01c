"""B-splines as entities of STEP: new files, and new ones in the place of old ones."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from knotwork.arithmetic.arrays import Array
from knotwork.files.cad.shapes import in_space, plain
from knotwork.files.cad.step.syntax import Text, references
from knotwork.knots import distinct
from knotwork.spline import Spline


def entity(spline: Spline, name: str, ids: Any) -> str:
    """Return the text of a B-spline after `#1=`, its control points the entities of given numbers."""
    stem = "CURVE" if spline.parameters == 1 else "SURFACE"
    rows = [distinct(space.knots) for space in spline.spaces]
    counts = ",".join(f"({','.join(str(int(m)) for m in multiplicities)})" for _, multiplicities in rows)
    knots = ",".join(_numbers(breaks) for breaks, _ in rows)
    degrees = ",".join(map(str, spline.degree))
    closed = ",".join([".F."] * spline.parameters)
    base = f"{degrees},{_nested(ids, lambda i: f'#{i}')},.UNSPECIFIED.,{closed},.F."
    more = f"{counts},{knots},.UNSPECIFIED."
    if spline.weights is None:
        return f"B_SPLINE_{stem}_WITH_KNOTS({name},{base},{more})"
    return (
        f"(BOUNDED_{stem}()B_SPLINE_{stem}({base})B_SPLINE_{stem}_WITH_KNOTS({more})"
        f"{stem}()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_{stem}({_numbers(spline.weights)})"
        f"REPRESENTATION_ITEM({name}))"
    )


def _numbers(x: Array) -> str:
    return _nested(x.tolist(), _number)


def _nested(values: Any, text: Any) -> str:
    return f"({','.join(_nested(v, text) for v in values)})" if isinstance(values, list) else text(values)


def _number(x: float) -> str:
    """Return a float in full: the shortest digits that give it back."""
    text = repr(float(x)).upper()
    return text if "." in text else text.replace("E", ".E")


def points_of(spline: Spline, first: int) -> tuple[list[str], Any]:
    """Return statements of the control points, numbered from `first` on, and these numbers in the shape of the net."""
    net = in_space(spline.points)
    flat = net.reshape(-1, 3).tolist()
    texts = [f"#{i}=CARTESIAN_POINT('',{_nested(p, _number)});" for i, p in enumerate(flat, first)]
    ids: Any = list(range(first, first + len(flat)))
    if net.ndim == 3:
        ids = [ids[k : k + net.shape[1]] for k in range(0, len(ids), net.shape[1])]
    return texts, ids


def rewrite(text: Text, changed: dict[int, Spline]) -> bytes:
    """Return the file with some B-splines replaced; points that were theirs alone go, all else stays as it was."""
    uses = Counter(references(text.text))  # the statement of an entity counts as one
    pieces: list[tuple[int, int, str]] = []
    following = text.largest + 1
    for key, spline in changed.items():
        name, a, b = text.place(key)
        points, ids = points_of(spline, following)
        following += len(points)
        record = text.record(key)
        given = record.get("REPRESENTATION_ITEM", next(iter(record.values())))
        label = given[0] if given and isinstance(given[0], str) and not given[0].startswith(".") else ""
        pieces.append((a - len(name), b, entity(spline, f"'{label}'", ids)))
        pieces.append((text.start(key), text.start(key), "".join(p + "\n" for p in points)))
        uses.subtract(references(text.text[a:b]))
        for old in set(references(text.text[a:b])):
            if uses[old] <= 1 and text.name(old) == "CARTESIAN_POINT":
                start, end = text.start(old), text.place(old)[2] + 1
                if text.text[end : end + 2] == "\r\n":
                    end += 2
                elif text.text[end : end + 1] == "\n":
                    end += 1
                pieces.append((start, end, ""))
    result, at = [], 0
    for start, end, new in sorted(pieces, key=lambda p: (p[0], p[1])):
        result += [text.text[at:start], new]
        at = end
    return "".join([*result, text.text[at:]]).encode("latin-1")


def encode(splines: Sequence[Spline], accuracy: float | None) -> tuple[bytes, float]:
    """Return a file of AP214 that holds the curves and surfaces as one set, in millimetres."""
    lines, items = [], []
    following = 100
    for i, given in enumerate(splines):
        spline = plain(given, f"splines[{i}]")
        points, ids = points_of(spline, following)
        following += len(points) + 1
        lines += [*points, f"#{following - 1}={entity(spline, chr(39) * 2, ids)};"]
        items.append(following - 1)
    surfaces = any(s.parameters == 2 for s in splines)
    kind = "SURFACE" if surfaces else "WIREFRAME"
    held = "GEOMETRIC_SET" if surfaces else "GEOMETRIC_CURVE_SET"
    refs = ",".join(f"#{i}" for i in items)
    head = f"""ISO-10303-21;
HEADER;
FILE_DESCRIPTION(('curves and surfaces'),'2;1');
FILE_NAME('','2000-01-01T00:00:00',(''),(''),'Knotwork','Knotwork','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));
ENDSEC;
DATA;
#1=APPLICATION_CONTEXT('automotive_design');
#2=APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#1);
#3=PRODUCT_CONTEXT('',#1,'mechanical');
#4=PRODUCT('splines','splines','',(#3));
#5=PRODUCT_DEFINITION_FORMATION('','',#4);
#6=PRODUCT_DEFINITION_CONTEXT('part definition',#1,'design');
#7=PRODUCT_DEFINITION('design','',#5,#6);
#8=PRODUCT_DEFINITION_SHAPE('','',#7);
#9=SHAPE_DEFINITION_REPRESENTATION(#8,#10);
#10=GEOMETRICALLY_BOUNDED_{kind}_SHAPE_REPRESENTATION('',(#11),#12);
#11={held}('',({refs}));
#12=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#16))\
GLOBAL_UNIT_ASSIGNED_CONTEXT((#13,#14,#15))REPRESENTATION_CONTEXT('',''));
#13=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#14=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#15=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());
#16=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),#13,'','');
"""
    return "".join([head, *(line + "\n" for line in lines), "ENDSEC;\nEND-ISO-10303-21;\n"]).encode(), 0.0
