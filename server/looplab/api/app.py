"""The application: the API under /api/v1, the pages beside it."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import APIRouter, FastAPI
from starlette.requests import Request
from starlette.responses import RedirectResponse

from looplab import __version__
from looplab.api import errors, pages
from looplab.api.limits import BodyLimit
from looplab.api.routes import ROUTERS
from looplab.api.security import SecurityHeaders
from looplab.api.settings import Settings
from looplab.jobs import WorkerPool

DESCRIBED_AT = "/api/v1/openapi.json"
DESCRIPTION = """Feedback loops with exact dead time: simulate, analyse, tune, grade.

Names are the symbols of the field (Kc, tau_I, GM_dB, PM_deg, Ms ...); frequency is rad per time unit; a complex number
is [re, im]. What is infinite or undefined is null, with the reason beside it. Every error has one shape."""


async def _description(_: Request) -> RedirectResponse:
    """Tools look for the description at the root first."""
    return RedirectResponse(DESCRIBED_AT)


def create_app(settings: Settings | None = None) -> FastAPI:
    """Build the application.

    Parameters
    ----------
    settings : Settings or None
        None takes the defaults.

    Returns
    -------
    FastAPI
    """
    settings = settings or Settings()
    workers = WorkerPool(settings.workers, settings.budget, settings.deadline, settings.waiting)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        yield
        workers.close()

    app = FastAPI(
        lifespan=lifespan,
        title="looplab",
        version=__version__,
        description=DESCRIPTION,
        openapi_url=DESCRIBED_AT,
        # The interactive pages would load scripts from another host.
        docs_url=None,
        redoc_url=None,
    )
    app.state.workers = workers
    v1 = APIRouter(prefix="/api/v1")
    for router in ROUTERS:
        v1.include_router(router)
    app.include_router(v1)
    errors.install(app)
    app.add_route("/openapi.json", _description, include_in_schema=False)
    if settings.pages:
        pages.install(app)
    app.add_middleware(BodyLimit, limit=settings.max_body)
    app.add_middleware(SecurityHeaders)
    return app
