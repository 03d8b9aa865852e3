"""What can be set when the server starts."""

from __future__ import annotations

from dataclasses import dataclass

from looplab.api.limits import MAX_BODY


@dataclass(frozen=True)
class Settings:
    """Settings of the application.

    Attributes
    ----------
    max_body : int
        Largest request body [bytes].
    pages : bool
        Serve the pages beside the API.
    workers : int or None
        Processes for formulas and ODE solvers; None takes two, or half of a larger machine's processors.
    budget : float
        Most processor time of one such computation [s].
    deadline : float
        Longest time of one such computation, however busy the machine is [s].
    waiting : int
        Most computations that wait for a worker.
    """

    max_body: int = MAX_BODY
    pages: bool = True
    workers: int | None = None
    budget: float = 2.0
    deadline: float = 20.0
    waiting: int = 16
