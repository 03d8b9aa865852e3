"""The pages: HTML files of web/ with their asset addresses filled in, and the static files beside them."""

from __future__ import annotations

from pathlib import Path

from fastapi import FastAPI
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from looplab.api.assets import fill_page, vendor_routes
from looplab.resources import web_dir

PAGES = {
    "/": "index.html",
    "/workbench": "workbench.html",
    "/labs": "labs.html",
    "/labs/{lab_id}": "lab.html",
    "/plants": "plants.html",
    "/plants/{plant_id}": "plant.html",
    "/experiments": "experiments.html",
    "/mimo": "mimo.html",
    "/state-feedback": "state-feedback.html",
    "/design": "design.html",
    "/pole-placement": "pole-placement.html",
    "/smith-predictor": "smith-predictor.html",
    "/api": "api.html",
}


class Static(StaticFiles):
    """Static files that a browser asks for anew each time (304 when unchanged): modules must never be of two ages."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """The file, to be revalidated."""
        response = await super().get_response(path, scope)
        response.headers["Cache-Control"] = "no-cache"
        return response


def _page(file: Path) -> Route:
    async def show(_: Request) -> Response:
        if not file.is_file():
            raise HTTPException(404)
        return HTMLResponse(fill_page(file.read_text(encoding="utf-8")), headers={"Cache-Control": "no-cache"})

    path = next(p for p, name in PAGES.items() if name == file.name)
    return Route(path, show, methods=["GET"], include_in_schema=False, name=file.stem)


def install(app: FastAPI) -> None:
    """Add the pages, /static and /vendor to the application."""
    web = web_dir()
    app.router.routes.extend(_page(web / name) for name in PAGES.values())
    app.router.routes.extend(vendor_routes())
    app.router.routes.append(Mount("/static", Static(directory=web), name="static"))
