"""A record from CSV text, as loggers and spreadsheets write it. Cells are data: nothing in them is ever evaluated."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from looplab.engine.errors import InvalidInput

MAX_LINES, MAX_COLUMNS = 200_000, 40
_NUMBER = re.compile(r"[+-]?(\d{1,40}([.,]\d{0,40})?|[.,]\d{1,40})([eE][+-]?\d{1,4})?", re.ASCII)
_MISSING = {"", "na", "n/a", "nan", "null", "none", "-", "--", "?"}
_COMMENT = ("#", "%", "//", "!")
_UNIT = re.compile(r"^(.*?)\s*(?:[\[(]([^\])]*)[\])]|[/,]\s*(\S+))?\s*$")
_KNOWN = {
    "t": {"t", "time", "zeit", "temps", "tid", "tiempo", "tempo"},
    "u": {"u", "input", "in", "mv", "op", "co", "m", "valve", "step", "eingang", "stellgröße"},
    "y": {"y", "output", "out", "pv", "measurement", "c", "ausgang", "istwert", "messwert"},
}
_TIME_UNITS = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("min", "mins", "minute", "minutes"), "min"),
    **dict.fromkeys(("h", "hr", "hrs", "hour", "hours"), "h"),
    **dict.fromkeys(("d", "day", "days"), "d"),
}


@dataclass(frozen=True)
class Columns:
    """What was read from a CSV text.

    Attributes
    ----------
    t : list of float
        [time]
    u, y : list of float or None
        None where the cell is empty [input, output].
    names, units : dict
        Of t, u and y, as the header has them; empty without a header.
    time_unit : str or None
        s, min, h or d where the header says so.
    """

    t: list[float]
    u: list[float | None]
    y: list[float | None]
    names: Mapping[str, str]
    units: Mapping[str, str]
    time_unit: str | None


def _bad(line: int, column: int, message: str, hint: str | None = None) -> InvalidInput:
    return InvalidInput(f"line {line}, column {column}: {message}", field="csv", hint=hint)


def _delimiter(line: str) -> str:
    outside = re.sub(r'"[^"]*"', "", line)
    return next((mark for mark in (";", "\t", ",") if mark in outside), ",")


def _cells(line: str, number: int, delimiter: str) -> list[str]:
    if line.count('"') % 2:
        raise _bad(number, line.index('"') + 1, "a quoted cell does not end on its line", "close the quotation mark")
    try:
        cells = next(csv.reader([line], delimiter=delimiter, strict=True))
    except csv.Error:
        raise _bad(number, line.index('"') + 1, "the quotation marks do not fit", "quote whole cells only") from None
    if len(cells) > MAX_COLUMNS:
        raise _bad(number, MAX_COLUMNS + 1, f"more than {MAX_COLUMNS} cells", "keep the columns of t, u and y")
    return [cell.strip() for cell in cells]


def _number(cell: str, delimiter: str) -> float | None:
    """The cell's number; nan where it is missing, None where it is none."""
    if cell.lower() in _MISSING:
        return math.nan
    if not _NUMBER.fullmatch(cell) or (delimiter == "," and "," in cell):
        return None
    return float(cell.replace(",", "."))


def _places(header: Sequence[str], wanted: Mapping[str, str], line: int) -> dict[str, int]:
    """Column of t, u and y by the names the caller gave, by usual names, or in this order where there are three."""
    names = [_UNIT.sub(r"\1", cell).strip().lower() for cell in header]
    out: dict[str, int] = {}
    for role in ("t", "u", "y"):
        given = wanted.get(role)
        if given is not None:
            low = given.strip().lower()
            found = [k for k, cell in enumerate(header) if low in (cell.lower(), names[k])]
            if len(found) != 1:
                what = "no column" if not found else "more than one column"
                raise InvalidInput(f"line {line}: {what} of this name", field=f"columns.{role}")
        else:
            found = [k for k, name in enumerate(names) if name in _KNOWN[role]]
        if len(found) == 1:
            out[role] = found[0]
    if len(out) < 3 or len(set(out.values())) < 3:
        if len(header) != 3 or wanted:
            missing = next((role for role in ("t", "u", "y") if role not in out), "u")
            raise _bad(line, 1, f"it is not clear which column is {missing}", "name the columns in `columns`")
        return {"t": 0, "u": 1, "y": 2}
    return out


def read_csv(text: str, columns: Mapping[str, str] | None = None) -> Columns:
    """Columns of t, u and y from CSV text.

    Cells are parted by semicolons, tabs or commas (the first of these that the first line has); with semicolons and
    tabs a decimal comma is understood. A first line that is not numbers is the header, with units as in ``t [min]``,
    ``T (K)``, or in a row of their own below it. Empty lines and lines that begin with # % ! or // are passed over;
    empty cells, NA, NaN and - are missing values.

    Parameters
    ----------
    text : str
    columns : mapping or None
        Names of the columns of t, u and y, where they cannot be told from the header.

    Returns
    -------
    Columns

    Raises
    ------
    InvalidInput
        With line and column of what cannot be read.
    """
    lines = text.removeprefix("\ufeff").splitlines()
    if len(lines) > MAX_LINES:
        raise InvalidInput(f"more than {MAX_LINES} lines", field="csv", hint="send a part of the record")
    delimiter, places = "", dict[str, int]()
    names: dict[str, str] = {}
    units: dict[str, str] = {}
    width, below_header = 0, False
    out: dict[str, list[float | None]] = {"t": [], "u": [], "y": []}
    for number, line in enumerate(lines, 1):
        if "\0" in line:
            raise _bad(number, line.index("\0") + 1, "a zero byte: this is not text", "export as CSV, UTF-8")
        if not line.strip(" \t;,") or line.lstrip().startswith(_COMMENT):
            continue
        if not delimiter:
            delimiter = _delimiter(line)
            header = _cells(line, number, delimiter)
            width = len(header)
            if width < 3:
                raise _bad(number, width, f"{width} cells, but t, u and y are needed", "part cells by , ; or tab")
            is_header = any(_number(cell, delimiter) is None for cell in header) or bool(columns)
            places = _places(header if is_header else [""] * width, columns or {}, number)
            if is_header:
                names, units = _named(header, places)
                below_header = True
                continue
        cells = _cells(line, number, delimiter)
        if below_header and _is_units(cells, places, delimiter):
            units = {role: cells[k].strip("[]() ")[:20] for role, k in places.items()}
        else:
            _row(cells, number, width, delimiter, places, out)
        below_header = False
    if not out["t"]:
        raise InvalidInput("there are no rows of numbers in the CSV text", field="csv")
    times = [v for v in out["t"] if v is not None]
    return Columns(times, out["u"], out["y"], names, units, _TIME_UNITS.get(units.get("t", "").lower()))


def _is_units(cells: Sequence[str], places: Mapping[str, int], delimiter: str) -> bool:
    """Whether a row stands for units: no number in it, and not even a digit where the time is."""
    if len(cells) <= max(places.values()) or any(char.isdigit() for char in cells[places["t"]]):
        return False
    values = [_number(cells[k], delimiter) for k in places.values()]
    return values[0] is None and all(value is None or math.isnan(value) for value in values)


def _named(header: Sequence[str], places: Mapping[str, int]) -> tuple[dict[str, str], dict[str, str]]:
    names, units = {}, {}
    for role, k in places.items():
        found = _UNIT.match(header[k])
        names[role] = (found[1] if found else header[k])[:60]
        units[role] = ((found[2] or found[3] or "") if found else "").strip()[:20]
    return names, units


def _row(
    cells: Sequence[str],
    line: int,
    width: int,
    delimiter: str,
    places: Mapping[str, int],
    out: Mapping[str, list[float | None]],
) -> None:
    if len(cells) != width:
        hint = "a decimal comma needs cells parted by ; or tabs" if delimiter == "," and len(cells) > width else None
        raise _bad(line, min(len(cells), width) + (len(cells) > width), f"{len(cells)} cells, but {width} before", hint)
    for role, k in places.items():
        value = _number(cells[k], delimiter)
        if value is None:
            hint = "write plain numbers such as 12.5 or 1e-3"
            if role == "t" and ":" in cells[k]:
                hint = "write the time as a number, in seconds or minutes from the start"
            elif cells[k].startswith("="):
                hint = "formulas are not computed: export their values"
            raise _bad(line, k + 1, f"{role} is not a number", hint)
        if math.isinf(value):
            raise _bad(line, k + 1, f"{role} is beyond double precision")
        if math.isnan(value) and role == "t":
            raise _bad(line, k + 1, "a row without its time", "leave the row out")
        out[role].append(None if math.isnan(value) else value)
