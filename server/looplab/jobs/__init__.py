"""Work that may not run in the server's own process: it goes to workers that can be ended."""

from looplab.jobs.pool import Overloaded, TooSlow, WorkerPool

__all__ = ["Overloaded", "TooSlow", "WorkerPool"]
