"""A recorded experiment: times, input and output, and what is known of the input between and before the samples."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.polynomial import FloatArray

Hold = Literal["zero", "linear"]
MIN_SAMPLES, MAX_SAMPLES = 8, 5000
LARGEST = 1e100


@dataclass(frozen=True)
class Record:
    """Samples of one input and one output, in any units, at any times.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Strictly increasing; need not begin at zero nor be even [time].
    u : ndarray, shape (n,)
        [input]
    y : ndarray, shape (n,)
        nan where it is missing [output].
    hold : {"zero", "linear"}
        Whether u keeps its value until the next sample, or goes there in a straight line.
    u_before : float
        u before the first sample, for ever: the plant may still be answering to it [input].
    notes : tuple of str
        What was done to the data.
    """

    t: FloatArray
    u: FloatArray
    y: FloatArray
    hold: Hold
    u_before: float
    notes: tuple[str, ...] = field(default=())

    @property
    def seen(self) -> npt.NDArray[np.bool_]:
        """Where y is there, shape (n,)."""
        return np.isfinite(self.y)

    @property
    def span(self) -> float:
        """From the first to the last sample [time]."""
        return float(self.t[-1] - self.t[0])

    @property
    def swing(self) -> float:
        """Distance from the lowest to the highest input, the one before the record among them [input]."""
        return float(max(self.u.max(), self.u_before) - min(self.u.min(), self.u_before))


def _column(values: Sequence[float | None], name: str) -> FloatArray:
    array = np.array([math.nan if v is None else v for v in values], dtype=float)
    if array.ndim != 1 or np.isinf(array).any() or (np.abs(array[np.isfinite(array)]) > LARGEST).any():
        raise InvalidInput(f"{name} must be a list of numbers up to {LARGEST:g}", field=name)
    return array


def make_record(
    t: Sequence[float],
    u: Sequence[float | None],
    y: Sequence[float | None],
    hold: Hold = "zero",
    u_before: float | None = None,
    limit: int = MAX_SAMPLES,
) -> Record:
    """A record from columns, checked, cleaned of gaps and thinned to the limit.

    A missing u is the one before it; a missing y is left out of every sum. Where there are more samples than the
    limit only each k-th y is kept, but every sample at which u changes, so that the input stays what it was.

    Parameters
    ----------
    t : sequence of float
        [time]
    u : sequence of float or None
        None where missing [input].
    y : sequence of float or None
        None where missing [output].
    hold : {"zero", "linear"}
    u_before : float or None
        u before the record; None is its first value [input].
    limit : int
        Most samples kept.

    Returns
    -------
    Record

    Raises
    ------
    InvalidInput
        Columns do not fit together, times do not increase, there are fewer than 8 samples, or u never changes, or
        changes at more samples than the limit.
    """
    times, inputs, outputs = _column(t, "t"), _column(u, "u"), _column(y, "y")
    for name, column in (("u", inputs), ("y", outputs)):
        if column.size != times.size:
            raise InvalidInput(f"there are {times.size} times but {column.size} values", field=name)
    if not np.isfinite(times).all():
        raise InvalidInput(f"sample {int(np.argmin(np.isfinite(times)))} has no time", field="t")
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size:
        raise InvalidInput(
            f"times must increase, but sample {late[0] + 1} is not later than the one before it",
            field="t",
            hint="sort the rows by time, and keep one of each time",
        )
    notes = []
    known = np.isfinite(inputs)
    if not known.any():
        raise InvalidInput("there is no input in the record", field="u")
    if not known.all():
        first = int(known.argmax())
        gaps = int((~known[first:]).sum())
        if first:
            notes.append(f"the first {first} samples have no input and are left out")
        if gaps:
            notes.append(f"{gaps} missing values of u are taken as the last one before them")
        latest = np.maximum.accumulate(np.where(known, np.arange(known.size), 0))
        times, inputs, outputs = times[first:], inputs[latest][first:], outputs[first:]
    missing = int((~np.isfinite(outputs)).sum())
    if missing:
        notes.append(f"{missing} missing values of y are left out")
    if outputs.size - missing < MIN_SAMPLES:
        raise InvalidInput(f"a record needs at least {MIN_SAMPLES} samples with y", field="y")
    before = float(inputs[0]) if u_before is None else u_before
    record = Record(times, inputs, outputs, hold, before, tuple(notes))
    if record.swing == 0:
        raise InvalidInput(
            "the input never changes, so nothing can be learnt from the output",
            field="u",
            hint="if it changed when the record began, say what it was before in u_before",
        )
    return _thinned(record, limit)


def _thinned(record: Record, limit: int) -> Record:
    n = record.t.size
    if n <= limit:
        return record
    change = input_changes(record)
    if change.sum() > limit // 2:
        raise InvalidInput(
            f"the input changes at {int(change.sum())} of {n} samples; at most {limit // 2} such changes can be kept "
            f"beyond {limit} samples",
            field="u",
            hint="average the record over longer intervals, or send a part of it",
        )
    every = math.ceil(n / (limit - int(change.sum())))
    keep = change.copy()
    keep[::every] = keep[-1] = True
    note = f"of {n} samples each {every}th is used, and all at which u changes"
    return replace(record, t=record.t[keep], u=record.u[keep], y=record.y[keep], notes=(*record.notes, note))


def input_changes(record: Record) -> npt.NDArray[np.bool_]:
    """Samples that the input's course needs, shape (n,): where it jumps, or where its line bends."""
    if record.hold == "zero":
        change = np.append(record.u[0] != record.u_before, np.diff(record.u) != 0)
    else:
        slope = np.diff(record.u) / np.diff(record.t)
        change = np.ones(record.t.size, dtype=bool)
        change[1:-1] = np.diff(slope) != 0
    change[0] = True
    return change
