"""What surrounds the entities of a drawing of AutoCAD 2000: the least that CAD programs ask for, a group per line."""

from __future__ import annotations

#: the handles of the entities begin here; `1F` is the model that owns them
FIRST = 0x100


def _table(name: str, handle: str, records: str = "", count: int = 1) -> str:
    more = "100 AcDbDimStyleTable\n" if name == "DIMSTYLE" else ""
    head = f"0 TABLE\n2 {name}\n5 {handle}\n330 0\n100 AcDbSymbolTable\n70 {count if records else 0}\n{more}"
    return head + records + "0 ENDTAB\n"


def _record(table: str, handle: str, owner: str, mark: str, name: str, more: str = "") -> str:
    code = 105 if table == "DIMSTYLE" else 5
    head = f"0 {table}\n{code} {handle}\n330 {owner}\n100 AcDbSymbolTableRecord\n100 {mark}\n2 {name}\n"
    return head + more


def _line_type(handle: str, name: str) -> str:
    return _record("LTYPE", handle, "5", "AcDbLinetypeTableRecord", name, "70 0\n3 \n72 65\n73 0\n40 0.0\n")


def _block(name: str, owner: str, handles: tuple[str, str], paper: str = "") -> str:
    head = f"0 BLOCK\n5 {handles[0]}\n330 {owner}\n100 AcDbEntity\n{paper}8 0\n100 AcDbBlockBegin\n2 {name}\n70 0\n"
    tail = f"0 ENDBLK\n5 {handles[1]}\n330 {owner}\n100 AcDbEntity\n{paper}8 0\n100 AcDbBlockEnd\n"
    return f"{head}10 0.0\n20 0.0\n30 0.0\n3 {name}\n1 \n{tail}"


def _section(name: str, content: str) -> str:
    return f"0 SECTION\n2 {name}\n{content}0 ENDSEC\n"


_VIEW = "70 0\n10 0.0\n20 0.0\n11 1.0\n21 1.0\n12 0.0\n22 0.0\n13 0.0\n23 0.0\n14 10.0\n24 10.0\n15 10.0\n25 10.0\n"
_VIEW += "16 0.0\n26 0.0\n36 1.0\n17 0.0\n27 0.0\n37 0.0\n40 100.0\n41 1.5\n42 50.0\n43 0.0\n44 0.0\n50 0.0\n51 0.0\n"
_VIEW += "71 0\n72 100\n73 1\n74 3\n75 0\n76 0\n77 0\n78 0\n"
_FONT = "70 0\n40 0.0\n41 1.0\n50 0.0\n71 0\n42 2.5\n3 txt\n4 \n"
_TYPES = _line_type("14", "ByBlock") + _line_type("15", "ByLayer") + _line_type("16", "Continuous")
_LAYER = "70 0\n62 7\n6 Continuous\n"
_SPACES = _record("BLOCK_RECORD", "1F", "1", "AcDbBlockTableRecord", "*Model_Space")
_SPACES += _record("BLOCK_RECORD", "1B", "1", "AcDbBlockTableRecord", "*Paper_Space")
_TABLES = "".join(
    [
        _table("VPORT", "8", _record("VPORT", "29", "8", "AcDbViewportTableRecord", "*Active", _VIEW)),
        _table("LTYPE", "5", _TYPES, 3),
        _table("LAYER", "2", _record("LAYER", "10", "2", "AcDbLayerTableRecord", "0", _LAYER)),
        _table("STYLE", "3", _record("STYLE", "11", "3", "AcDbTextStyleTableRecord", "Standard", _FONT)),
        _table("VIEW", "6"),
        _table("UCS", "7"),
        _table("APPID", "9", _record("APPID", "12", "9", "AcDbRegAppTableRecord", "ACAD", "70 0\n")),
        _table("DIMSTYLE", "A", _record("DIMSTYLE", "27", "A", "AcDbDimStyleTableRecord", "Standard", "70 0\n")),
        _table("BLOCK_RECORD", "1", _SPACES, 2),
    ]
)
_BLOCKS = _block("*Model_Space", "1F", ("20", "21")) + _block("*Paper_Space", "1B", ("1C", "1D"), "67 1\n")
_OBJECTS = "0 DICTIONARY\n5 C\n330 0\n100 AcDbDictionary\n281 1\n3 ACAD_GROUP\n350 D\n"
_OBJECTS += "0 DICTIONARY\n5 D\n330 C\n100 AcDbDictionary\n281 1\n"


def drawing(entities: str, following: int) -> str:
    """Return the text of a drawing of these entities; handles from `following` on are free."""
    variables = f"9 $ACADVER\n1 AC1015\n9 $HANDSEED\n5 {following:X}\n9 $INSUNITS\n70 0\n9 $MEASUREMENT\n70 1\n"
    before = _section("HEADER", variables) + _section("CLASSES", "") + _section("TABLES", _TABLES)
    before += _section("BLOCKS", _BLOCKS) + "0 SECTION\n2 ENTITIES\n"
    after = "0 ENDSEC\n" + _section("OBJECTS", _OBJECTS) + "0 EOF\n"
    return _in_lines(before) + entities + _in_lines(after)


def _in_lines(text: str) -> str:
    """Return groups with the code and the value in a line each."""
    return "".join(f"{code:>3}\n{value}\n" for code, value in (row.split(" ", 1) for row in text.splitlines()))
