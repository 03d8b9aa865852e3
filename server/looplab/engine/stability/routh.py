"""The Routh array of a polynomial, with both singular cases, exact on typed numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from itertools import pairwise
from typing import Any

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.transfer_function import MAX_ORDER

Number = Fraction | float
# Of one array all entries are fractions or all are floats; a union would not let them be multiplied.
Row = tuple[Any, ...]

# A float with no more significant digits than this was typed, not computed: it means its decimal.
TYPED_DIGITS = 12
COEFFICIENT_TOLERANCE = 1e-13
ROUNDING = 2.3e-16


@dataclass(frozen=True)
class RouthRow:
    """One row of the array.

    Attributes
    ----------
    power : int
        The row belongs to s^power; its entries are coefficients of s^power, s^(power-2) ...
    entries : tuple of Fraction or float
        What the rows below are computed from.
    kind : str
        "given" (the first two), "computed", "multiplied" (the first entry was zero), "auxiliary" (the row was zero).
    computed : tuple or None
        The row before it was replaced; None where it was not.
    note : str or None
        What was done to the row, and why that is allowed.
    """

    power: int
    entries: Row
    kind: str
    computed: Row | None = None
    note: str | None = None

    @property
    def label(self) -> str:
        """s^3, s^2, s^1, s^0."""
        return f"s^{self.power}"


@dataclass(frozen=True)
class RouthArray:
    """The array and what it proves.

    Attributes
    ----------
    coefficients : tuple of Fraction or float
        The polynomial, highest power first, leading zeros dropped.
    rows : tuple of RouthRow
    auxiliary_polynomials : tuple of (int, tuple)
        Degree and full coefficients of each auxiliary polynomial (the row above a zero row).
    sign_changes, rhp_roots, imaginary_axis_roots, lhp_roots : int
        Roots with their multiplicity; sign changes of the first column equal the roots in the right half-plane.
    stable : bool
        Every root lies in the open left half-plane.
    exact : bool
        Computed with fractions: the counts are theorems. Otherwise zeros are decided with ``tolerance``.
    tolerance : float or None
        Relative uncertainty of each coefficient; an entry is zero when it is below its propagated uncertainty.
    because : str
    """

    coefficients: Row
    rows: tuple[RouthRow, ...]
    auxiliary_polynomials: tuple[tuple[int, Row], ...]
    sign_changes: int
    rhp_roots: int
    imaginary_axis_roots: int
    lhp_roots: int
    stable: bool
    exact: bool
    tolerance: float | None
    because: str


def _fraction(value: object) -> Fraction | None:
    """The number that was typed, or None for a computed float."""
    if isinstance(value, int | Fraction):
        return Fraction(value)
    if isinstance(value, Decimal):
        return Fraction(value)
    text = repr(float(value))  # type: ignore[arg-type]
    digits = text.split("e")[0].lstrip("-").replace(".", "").strip("0")
    return Fraction(text) if len(digits) <= TYPED_DIGITS else None


def _read(coefficients: Sequence[object], tolerance: float) -> tuple[list[Any], bool]:
    try:
        finite = all(math.isfinite(c) for c in coefficients)  # type: ignore[arg-type]
    except (TypeError, OverflowError):
        finite = False
    if not finite or not len(coefficients):
        raise InvalidInput(
            "the polynomial must be a list of finite numbers, highest power first",
            field="polynomial",
            hint="s^3 + 6 s^2 + 11 s + 6 is [1, 6, 11, 6]",
        )
    if not 0 < tolerance < 1e-3:
        raise InvalidInput("the tolerance must be between 0 and 0.001", field="tolerance", hint="1e-13 is usual")
    exact = [_fraction(c) for c in coefficients]
    typed = [c for c in exact if c is not None]
    values: list[Any] = list(typed) if len(typed) == len(exact) else [float(c) for c in coefficients]  # type: ignore[arg-type]
    while values and values[0] == 0:
        values = values[1:]
    if not values:
        raise InvalidInput(
            "the polynomial is zero", field="polynomial", hint="give at least one coefficient that is not zero"
        )
    if len(values) - 1 > MAX_ORDER:
        raise InvalidInput(f"degree {len(values) - 1} exceeds the limit of {MAX_ORDER}", field="polynomial")
    return values, len(typed) == len(exact)


class _Table:
    """Rows as they grow; with floats each entry carries the uncertainty it inherits."""

    def __init__(self, values: list[Any], exact: bool, tolerance: float) -> None:
        self.exact = exact
        self.degree = len(values) - 1
        first, second = values[0::2], values[1::2]
        self.unsure: list[list[float]] = [
            [] if exact else [tolerance * abs(float(c)) for c in r] for r in (first, second)
        ]
        self.rows = [RouthRow(self.degree, tuple(first), "given")]
        self.auxiliary: list[tuple[int, Row]] = []
        if self.degree:
            self._add(second, self.unsure.pop(), "given")

    def grow(self) -> None:
        """Compute the next row from the last two."""
        a, b = self.rows[-2].entries, self.rows[-1].entries
        ua, ub = self.unsure[-2], self.unsure[-1]
        row: list[Any] = []
        unsure: list[float] = []
        for j in range((self.rows[-1].power - 1) // 2 + 1):
            top = a[j + 1] if j + 1 < len(a) else a[0] * 0
            right = b[j + 1] if j + 1 < len(b) else b[0] * 0
            cross = a[0] * right / b[0]
            row.append(top - cross)
            if not self.exact:
                u_top = ua[j + 1] if j + 1 < len(a) else 0.0
                u_right = ub[j + 1] if j + 1 < len(b) else 0.0
                spread = (abs(a[0]) * u_right + abs(right) * ua[0] + abs(cross) * ub[0]) / abs(b[0])
                unsure.append(float(u_top + spread + ROUNDING * (abs(top) + 3 * abs(cross))))
        self._add(row, unsure, "computed")

    def _add(self, row: list[Any], unsure: list[float], kind: str) -> None:
        """Append a row, repaired where its first entry or all of it is zero."""
        power = self.rows[-1].power - 1
        if not self.exact:
            row = [0.0 if abs(c) <= u else c for c, u in zip(row, unsure, strict=True)]
        computed = tuple(row)
        zeros = next((i for i, c in enumerate(row) if c != 0), None)
        note = None
        if zeros is None:
            row, note = self._derivative(), self._zero_row_note()
            above = self.unsure[-1]
            unsure = [(power + 1 - 2 * j) * u for j, u in enumerate(above[: len(row)])]
            kind = "auxiliary"
        elif zeros:
            sign = (-1) ** zeros
            row = [c + sign * (row[j + zeros] if j + zeros < len(row) else 0) for j, c in enumerate(row)]
            if unsure:
                unsure = [u + (unsure[j + zeros] if j + zeros < len(row) else 0.0) for j, u in enumerate(unsure)]
            kind = "multiplied"
            shift = f"{'-' if sign < 0 else '+'} s^{2 * zeros}"
            note = (
                f"the first entry is zero: the row is multiplied by 1 {shift}, which on s = jw is "
                f"1 + w^{2 * zeros} > 0, so the count of roots on either side of the axis stays as it is"
            )
        self.rows.append(RouthRow(power, tuple(row), kind, computed if note else None, note))
        self.unsure.append(unsure)

    def _derivative(self) -> list[Any]:
        above = self.rows[-1]
        full: list[Any] = [above.entries[0] * 0] * (above.power + 1)
        for j, c in enumerate(above.entries):
            full[2 * j] = c
        self.auxiliary.append((above.power, tuple(full)))
        return [(above.power - 2 * j) * c for j, c in enumerate(above.entries) if above.power - 2 * j > 0]

    def _zero_row_note(self) -> str:
        above = self.rows[-1]
        return (
            f"the row is zero: the row above, {polynomial_text(self.auxiliary[-1][1])}, is the auxiliary polynomial; "
            f"it divides the polynomial and its {above.power} root{'s lie' if above.power > 1 else ' lies'} symmetric "
            "to the origin. Its derivative takes the row's place"
        )


def _changes(rows: Sequence[RouthRow]) -> int:
    signs = [row.entries[0] > 0 for row in rows]
    return sum(a != b for a, b in pairwise(signs))


def number_text(value: Number, digits: int = 6) -> str:
    """7/3 where the fraction is short and exact, else a decimal."""
    if isinstance(value, Fraction):
        text = str(value)
        if len(text) <= 16:
            return text
    return f"{float(value) + 0.0:.{digits}g}"


def polynomial_text(coefficients: Sequence[Any]) -> str:
    """The polynomial in s, for example ``2 s^2 + 8``."""
    degree = len(coefficients) - 1
    out = ""
    for i, c in enumerate(coefficients):
        if c == 0:
            continue
        power = degree - i
        s = "" if power == 0 else "s" if power == 1 else f"s^{power}"
        size = number_text(abs(c))
        body = s if s and size == "1" else f"{size} {s}".strip()
        out += (" - " if c < 0 else " + ") + body
    if not out:
        return "0"
    return out[3:] if out.startswith(" + ") else "-" + out[3:]


def _because(degree: int, right: int, axis: int) -> str:
    if not degree:
        return "a constant has no roots"
    if not right and not axis:
        roots = f"all {degree} roots lie" if degree > 1 else "the one root lies"
        return f"the first column does not change sign: {roots} in the left half-plane"
    parts = []
    if right:
        parts.append(
            f"the first column changes sign {right} time{'s' if right > 1 else ''}: "
            f"{right} root{'s lie' if right > 1 else ' lies'} in the right half-plane"
        )
    if axis:
        parts.append(f"the auxiliary polynomial puts {axis} root{'s' if axis > 1 else ''} on the imaginary axis")
    return "; ".join(parts)


def routh_array(coefficients: Sequence[object], tolerance: float = COEFFICIENT_TOLERANCE) -> RouthArray:
    r"""Count the roots of a real polynomial on either side of the imaginary axis, without computing them.

    .. math:: c_{k,j} = c_{k-2,j+1} - \frac{c_{k-2,0}\; c_{k-1,j+1}}{c_{k-1,0}}

    A first entry that is zero in a row that is not: with p leading zeros the row is multiplied by
    :math:`1 + (-1)^p s^{2p}`, positive on the axis. Unlike the :math:`\varepsilon` method it needs no limit, works in
    exact arithmetic and is also right when roots lie on the axis. A zero row: the row above is the auxiliary
    polynomial, whose roots are symmetric to the origin; its derivative replaces the zero row. Of its k roots as many
    lie right as the first column changes sign from there on, as many left, the rest on the axis.

    Parameters
    ----------
    coefficients : sequence of int, float, Fraction or Decimal
        Highest power first. Numbers of up to 12 digits are taken as the decimals they are written as, and the array
        is then computed with fractions.
    tolerance : float
        Relative uncertainty of each coefficient where one is not such a number [-].

    Returns
    -------
    RouthArray

    Raises
    ------
    InvalidInput
        No finite coefficients, all of them zero, degree above 50, or entries beyond double precision.

    References
    ----------
    .. [1] F. R. Gantmacher, The Theory of Matrices, vol. 2, Chelsea 1959, ch. XV.
    .. [2] M. Benidir, B. Picinbono, IEEE Trans. Autom. Control 35 (1990) 218-222 (the row with a first zero).
    """
    values, exact = _read(coefficients, tolerance)
    table = _Table(values, exact, tolerance)
    while table.rows[-1].power > 0:
        table.grow()
    rows = tuple(table.rows)
    try:
        finite = all(math.isfinite(float(c)) for row in rows for c in row.entries)
    except OverflowError:
        finite = False
    if not finite:
        raise InvalidInput(
            "the coefficients lie too far apart: the array leaves double precision",
            field="polynomial",
            hint="choose a time unit in which they are moderate",
        )
    right, axis = _changes(rows), 0
    if table.auxiliary:
        size = table.auxiliary[0][0]
        axis = size - 2 * _changes(rows[table.degree - size :])
    return RouthArray(
        tuple(values), rows, tuple(table.auxiliary), right, right, axis, table.degree - right - axis,
        right == 0 and axis == 0, exact, None if exact else tolerance, _because(table.degree, right, axis),
    )  # fmt: skip
