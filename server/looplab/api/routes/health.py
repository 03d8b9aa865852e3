"""Is the server up, and which version is it?"""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel

from looplab import __version__

router = APIRouter(tags=["service"])


class Health(BaseModel):
    """The server answers."""

    status: str
    version: str


@router.get("/health", summary="Is the server up?")
def health() -> Health:
    """Always "ok": an answer is the sign of life."""
    return Health(status="ok", version=__version__)
