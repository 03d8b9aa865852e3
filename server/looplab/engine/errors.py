"""Errors of the engine: what is wrong, in which field, and a way out. They know nothing of HTTP."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class EngineError(ValueError):
    """A request the engine cannot answer.

    Parameters
    ----------
    message : str
        What is wrong, in one sentence.
    field : str or None
        Name of the offending input, as the caller spelled it.
    hint : str or None
        What would be right.
    """

    def __init__(self, message: str, *, field: str | None = None, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.field = field
        self.hint = hint

    def __reduce__(self) -> tuple[Callable[..., EngineError], tuple[type[EngineError], dict[str, Any]]]:
        # Workers send errors back: as they are, whatever arguments the subclass is made from.
        return _restored, (type(self), {**self.__dict__, "args": self.args})


def _restored(kind: type[EngineError], state: dict[str, Any]) -> EngineError:
    error = kind.__new__(kind)
    for name, value in state.items():
        setattr(error, name, value)
    return error


class InvalidInput(EngineError):
    """An input is malformed or outside its range."""


class ParseError(InvalidInput):
    """A text could not be read as a transfer function or a formula; ``column`` is 1-based."""

    def __init__(self, message: str, *, column: int, field: str | None = None, hint: str | None = None) -> None:
        super().__init__(f"{message} (column {column})", field=field, hint=hint)
        self.column = column


class ImproperSystem(EngineError):
    """More zeros than poles: the system would have to differentiate its input (it is not causal)."""


class IllPosedLoop(EngineError):
    """The loop has an algebraic loop without a solution (1 + C(inf) P(inf) = 0)."""


class RuleNotApplicable(EngineError):
    """A tuning rule is outside the range it was made for."""


class NonFinite(EngineError):
    """An equation has no finite real value at a point.

    Parameters
    ----------
    message : str
        What is wrong, in one sentence.
    t : float
        When [time].
    field : str
        The equation, e.g. ``states[1].equation``.
    """

    def __init__(self, message: str, *, t: float, field: str) -> None:
        super().__init__(message, field=field)
        self.t = t


class NoConvergence(EngineError):
    """An iteration did not reach its tolerance."""
