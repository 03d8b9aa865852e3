"""A task within a budget of processor time, which a busy machine does not shorten."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")
# Missing on Windows: there the pool's deadline alone ends a task.
HAS_TIMER = hasattr(signal, "setitimer")
# How a worker ends whose budget is spent.
EXIT_CODE = -int(signal.SIGPROF) if HAS_TIMER else None


def within_budget(seconds: float, function: Callable[..., T], *args: Any) -> T:
    """The function's result; past its budget the kernel ends the whole process, inside compiled code too.

    Only for worker processes.
    """
    if not HAS_TIMER:
        return function(*args)
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        return function(*args)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
