"""CSV as loggers and spreadsheets write it, and as attackers do."""

import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.identification.csv_record import read_csv


@pytest.mark.parametrize(
    "text",
    [
        "t [min],u (%),y / K\n0.5,1,300.5\n1.5,,301\n2.5,2,NA\n",
        "\ufeff# logger 7\n\nTime [min];MV;PV\n0,5;1;300,5\n1,5;;301\n2,5;2;-\n",
        "t\tu\ty\r\n0,5\t1\t300,5\r\n1,5\t\t301\r\n2,5\t2\tnan\r\n",
        '"y","t","u"\n"300.5","0.5","1"\n301,1.5,\n,+2.5,2e0\n',
        "0.5,1,300.5\n1.5,,301\n2.5,2,\n",
    ],
)
def test_the_same_record_written_in_many_ways(text):
    read = read_csv(text)
    assert (read.t, read.u, read.y) == ([0.5, 1.5, 2.5], [1.0, None, 2.0], [300.5, 301.0, None])


def test_units_and_names():
    read = read_csv("Time [min],valve,T (K),note\n0,1,2,3\n", {"t": "Time", "u": "valve", "y": "T"})
    assert read.names == {"t": "Time", "u": "valve", "y": "T"}
    assert read.units == {"t": "min", "u": "", "y": "K"}
    assert read.time_unit == "min"


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("t,u,y\n1,=cmd|' /C calc'!A0,3\n", "line 2, column 2: u is not a number"),
        ("t,u,y\n1,2,3\n2,2\n", "line 3, column 2: 2 cells"),
        ('t,u,y\n1,"2,3\n', "line 2, column 3: a quoted cell"),
        ("t;u;y\n1;2;1.234,5\n", "line 2, column 3: y is not a number"),
        ("t,u,y\n1,2,1e999\n", "line 2, column 3: y is beyond"),
        ("t,u,y\n12:00:01,2,1\n", "line 2, column 1: t is not a number"),
        ("t,u,y\n,2,1\n", "line 2, column 1: a row without its time"),
        ("t,u,y\n1,\0,1\n", "line 2, column 3: a zero byte"),
        ("t,u,y\n1,１,1\n", "line 2, column 2: u is not a number"),
        ("a,b,c,d\n1,2,3,4\n", "line 1, column 1: it is not clear which column is t"),
        ("1\n2\n", "line 1, column 1: 1 cells"),
        ("t,u,y\n0,5,1,2\n", "line 2, column 4: 4 cells"),
        ("t,u,y\n", "no rows of numbers"),
        ("", "no rows of numbers"),
    ],
)
def test_hostile_text_is_refused_with_its_place(text, place):
    with pytest.raises(InvalidInput) as refused:
        read_csv(text)
    assert place in refused.value.message
    assert "calc" not in refused.value.message
