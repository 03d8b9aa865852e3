"""What a simulation gives."""

from __future__ import annotations

from dataclasses import dataclass

from looplab.engine.systems.polynomial import FloatArray


@dataclass(frozen=True)
class EventRecord:
    """An event that has happened: its name, its message, when, and the state there."""

    name: str
    message: str
    t: float
    x: tuple[float, ...]


@dataclass(frozen=True)
class Simulation:
    """A simulated model.

    Attributes
    ----------
    t : ndarray, shape (count,)
        The times asked for, up to where it was cut, and the time of the cut itself [time].
    x, y, u : ndarray, shapes (count, n), (count, q), (count, m)
        States, outputs and inputs; u holds the new value at a jump.
    events : tuple of EventRecord
        In the order in which they happened.
    truncated_at, truncated_reason : float and str, or None
        Where the simulation was cut, and why.
    calls : int
        Evaluations of the equations.
    """

    t: FloatArray
    x: FloatArray
    y: FloatArray
    u: FloatArray
    events: tuple[EventRecord, ...]
    truncated_at: float | None
    truncated_reason: str | None
    calls: int
