"""Files as loggers and spreadsheets leave them: all of 2 exp(-s)/(5 s + 1), written in hostile ways."""

from pathlib import Path

import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.identification.csv_record import read_csv
from looplab.engine.identification.identify import identify
from looplab.engine.identification.record import make_record

RECORDS = Path(__file__).parent / "records"


@pytest.mark.parametrize(
    ("name", "first", "units", "missing"),
    [
        ("semicolons-and-units-row", 0.0, {"t": "min", "u": "%", "y": "°C"}, 0),
        ("irregular-from-100", 100.0, {"t": "s", "u": "", "y": ""}, 0),
        ("german-with-bom", 0.0, {"t": "s", "u": "%", "y": "K"}, 0),
        ("gaps", 0.0, {"t": "", "u": "", "y": ""}, 14),
    ],
)
def test_the_plant_is_found_in_every_file(name, first, units, missing):
    read = read_csv((RECORDS / f"{name}.csv").read_bytes().decode("utf-8"))
    assert read.t[0] == first
    assert read.units == units
    assert sum(value is None for value in read.y) == missing
    found = identify(make_record(read.t, read.u, read.y), "least_squares").fitted
    # The files hold four decimals of a change of 2 or 10.
    assert (found.model.K, found.model.tau, found.model.theta) == pytest.approx((2, 5, 1), rel=5e-4)


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("text-in-the-middle", "line 18, column 3: y is not a number"),
        ("two-columns", "line 1, column 2: 2 cells, but t, u and y are needed"),
    ],
)
def test_what_cannot_be_read_is_named_with_its_place(name, place):
    with pytest.raises(InvalidInput) as refused:
        read_csv((RECORDS / f"{name}.csv").read_text(encoding="utf-8"))
    assert place in refused.value.message


def test_units_stand_directly_below_the_header_or_not_at_all():
    assert read_csv("t;u;y\n[s];m3/h;-\n0;1;2\n").units == {"t": "s", "u": "m3/h", "y": "-"}
    with pytest.raises(InvalidInput, match="line 3, column 1: t is not a number"):
        read_csv("t;u;y\n0;1;2\n[s];[V];[V]\n")
    with pytest.raises(InvalidInput, match="line 2, column 1: t is not a number"):
        read_csv("t;u;y\n1h;1;2\n")
