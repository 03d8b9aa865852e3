"""A pool of worker processes. A task that takes too long is ended with its process; the others go on.

No exception can stop a solver inside compiled code: only the end of its process does.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import TimeoutError as DeadlinePassed
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeVar

from looplab.engine.errors import EngineError
from looplab.jobs.budget import EXIT_CODE, within_budget

if TYPE_CHECKING:
    from pebble import ProcessPool

T = TypeVar("T")
# Read by the process that the workers are copies of, so that a new one is there at once.
PRELOAD = [
    "looplab.jobs.budget",
    "looplab.jobs.tasks",
    "looplab.jobs.steady_tasks",
    "looplab.jobs.linear_tasks",
    "looplab.jobs.feedback_tasks",
    "looplab.engine.nonlinear.control_loop.simulation",
    "looplab.engine.nonlinear.state_feedback.simulation",
]
# A short burst is held back rather than refused.
HOLD = 0.5
LONGEST_WAIT = 10.0


class TooSlow(EngineError):
    """A task has used up its processor time, or passed its deadline."""


class Overloaded(Exception):
    """There is more work than the workers can do; ``retry_after`` is in seconds."""

    retry_after = 1


def default_workers() -> int:
    """Two, or half of a larger machine's processors."""
    return max(2, min(8, (os.cpu_count() or 1) // 2))


class WorkerPool:
    """Worker processes, started with the first task.

    Parameters
    ----------
    workers : int or None
        How many processes; None takes ``default_workers``.
    budget : float
        Most processor time of one task [s].
    deadline : float
        Longest time of one task, however busy the machine is [s].
    waiting : int
        Most tasks that wait for a worker.
    """

    def __init__(
        self, workers: int | None = None, budget: float = 2.0, deadline: float = 20.0, waiting: int = 16
    ) -> None:
        self.workers = workers or default_workers()
        self.budget, self.deadline, self.waiting = budget, deadline, waiting
        self._pool: ProcessPool | None = None
        self._starting = threading.Lock()
        self._inside = 0

    async def run(self, function: Callable[..., T], *args: Any) -> T:
        """The function's result, computed by a worker.

        Parameters
        ----------
        function : callable
            Of a module, so that a worker finds it by name.
        *args
            What can be pickled: documents and settings, not functions.

        Raises
        ------
        TooSlow
            The budget is spent, or the deadline has passed.
        Overloaded
            Too many tasks wait already, or this one has waited too long.
        EngineError
            Whatever the function raises.
        """
        await self._admission()
        self._inside += 1
        try:
            running = self._running()
            # Starting processes takes a while: not in the event loop.
            pool = await asyncio.to_thread(self._started) if running is None else running
            task = pool.schedule(within_budget, args=(self.budget, function, *args), timeout=self.deadline)
            future = asyncio.wrap_future(task)
            done, _ = await asyncio.wait({future}, timeout=LONGEST_WAIT + self.deadline)
            if not done:
                future.cancel()
                raise Overloaded
            return future.result()
        except DeadlinePassed as error:
            raise self._too_slow() from error
        except Exception as error:
            code = _exit_code(error)
            if code is None:
                raise
            raise (self._too_slow() if code == EXIT_CODE else Overloaded()) from error
        finally:
            self._inside -= 1

    def _too_slow(self) -> TooSlow:
        return TooSlow(
            f"this takes more than {self.budget:g} s of computing",
            hint="a shorter horizon, fewer starts, or a model that is smaller, less stiff or switches less",
        )

    async def _admission(self) -> None:
        until = time.monotonic() + HOLD
        while self._inside >= self.workers + self.waiting:
            if time.monotonic() > until:
                raise Overloaded
            await asyncio.sleep(0.02)

    def _started(self) -> ProcessPool:
        with self._starting:
            self._pool = self._running() or _new_pool(self.workers)
            return self._pool

    def _running(self) -> ProcessPool | None:
        pool = self._pool
        return pool if pool is not None and pool.active else None

    def close(self) -> None:
        """End the workers, whatever they do."""
        with self._starting:
            pool, self._pool = self._pool, None
        if pool is not None:
            pool.stop()
            pool.join()


def _new_pool(workers: int) -> ProcessPool:
    # Only a server that gets such a request pays for the import and the processes.
    from pebble import ProcessPool

    if sys.platform == "win32":
        return ProcessPool(workers, context=multiprocessing.get_context("spawn"), initializer=_prepare)
    # Never a copy of the server itself: its threads and sockets do not belong in a worker.
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOAD)
    return ProcessPool(workers, context=context, initializer=_prepare)


def _prepare() -> None:
    """In a worker, before its first task: the deadline is for the task, not for imports."""
    for module in PRELOAD:
        import_module(module)


def _exit_code(error: Exception) -> int | None:
    """How the worker ended, where it did; a killed one for want of memory, say, has one too."""
    from pebble import ProcessExpired

    return int(error.exitcode) if isinstance(error, ProcessExpired) else None
