"""Each mistake is reported at its column, with a way out."""

import pytest

from looplab.engine.errors import ParseError
from looplab.engine.systems import parse_transfer_function


@pytest.mark.parametrize(
    ("text", "column", "says"),
    [
        ("", 1, "empty"),
        ("   ", 1, "empty"),
        ("1/(s+1", 7, "not closed"),
        ("1/(s+1))", 8, "not opened"),
        ("1/(s+)", 6, "cannot stand here"),
        ("1/", 3, "too early"),
        ("2 x/(s+1)", 3, "unknown name"),
        ("1/(s2+1)", 4, "unknown name"),
        ("1/(s+0,5)", 7, "cannot be read"),
        ("1 $ 2", 3, "cannot be read"),
        ("exp(0.1 s)/(s+1)", 1, "prediction"),
        ("1/exp(-0.1 s)", 1, "future"),
        ("exp(-s^2)", 1, "multiple of s"),
        ("exp -s", 5, "brackets"),
        ("1/(s+1)(s+2)", 8, "above or below"),
        ("1/(s-s)", 3, "zero"),
        ("(s+1)^0.5", 7, "whole number"),
        ("(s+1)^51", 7, "50"),
        ("(s+1)^30*(s+2)^30/(s+3)^60", 25, "50"),
        ("1e999", 1, "too large"),
        ("2^3^2", 4, "brackets"),
        ("1/(s+1) + exp(-s)/(s+2)", 9, "dead time"),
        ("(s+1]", 5, "not closed"),
    ],
)
def test_column_and_message(text: str, column: int, says: str) -> None:
    with pytest.raises(ParseError) as caught:
        parse_transfer_function(text)
    assert says in caught.value.message
    assert caught.value.column == column
    assert f"column {column}" in caught.value.message


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("1/(s+0,5)", "point"),
        ("1/(s2+1)", "s^2"),
        ("exp(0.1 s)", "exp(-0.1 s)"),
        ("1/(s+1)(s+2)", "brackets"),
        ("", "1/(s+1)^3"),
    ],
)
def test_a_way_out_is_offered(text: str, hint: str) -> None:
    with pytest.raises(ParseError) as caught:
        parse_transfer_function(text)
    assert hint in caught.value.hint


def test_length_and_depth_are_bounded() -> None:
    with pytest.raises(ParseError, match="500"):
        parse_transfer_function("s" + " " * 500)
    with pytest.raises(ParseError, match="nested"):
        parse_transfer_function("(" * 60 + "s" + ")" * 60)
