"""`looplab bench`: one gain move against python-control doing the same work, and what it costs the server."""

from looplab.bench.command import main

__all__ = ["main"]
