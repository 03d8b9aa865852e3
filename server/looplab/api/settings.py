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
    """

    max_body: int = MAX_BODY
    pages: bool = True
