"""The commands `methods` and `count` say what the catalogue and the tables hold."""

import json
from dataclasses import asdict

import pytest
from click.testing import CliRunner

from knotwork.cli import main
from knotwork.insertion import METHODS
from knotwork.insertion.counts.tables import tables


def run(*words, code=0):
    result = CliRunner().invoke(main, list(words))
    assert result.exit_code == code, result.output
    return result


def test_the_catalogue():
    told = json.loads(run("methods", "--json").stdout)
    assert [m["name"] for m in told] == list(METHODS)
    assert told[0]["section"] == "§4.5"
    lines = run("methods").stdout.splitlines()
    assert lines[0] == f"{len(METHODS)} methods"
    assert [line.split()[0] for line in lines[4:]] == list(METHODS)


def test_the_tables():
    told = json.loads(run("count", "--degree", "2", "--dim", "1", "--knots", "6", "--across", "3", "--json").stdout)
    assert told["tables"] == json.loads(json.dumps([asdict(table) for table in tables(2, 1, 6, 3)]))
    assert (told["degree"], told["dim"], told["knots"]) == (2, 1, 6)


def test_what_is_shown():
    shown = run("count", "--across", "4").stdout
    assert [line.partition(":")[0] for line in shown.splitlines() if "able 4" in line or "ables 4" in line] == [
        "Tables 4.1 and 4.2",
        "Tables 4.3 and 4.4",
        "Tables 4.5 and 4.6",
    ]
    lines = [line.split() for line in shown.splitlines()]
    assert ["boehm", "standard", "360", "360", "60", "60"] in lines
    assert ["oslo-improved", "standard", *("≤ 792 | 696 " * 2 + "≤ 132 | 116 " * 2).split()] in lines


def test_surfaces_in_both_orders():
    shown = run("count", "--knots", "4", "--across", "8").stdout
    rows = [line.split()[3:] for line in shown.splitlines() if line.startswith("oslo-row") and "first" in line]
    assert len(rows) == 2
    assert rows[0] != rows[1]


@pytest.mark.parametrize("words", [("--degree", "0"), ("--knots", "0"), ("--dim", "x")])
def test_bad_input(words):
    result = run("count", *words, code=2)
    assert result.stdout == ""
    assert words[0] in result.stderr
