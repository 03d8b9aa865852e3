"""What pages need and no one commits: plotly.js, the style sheet it would inject, a font for formulas.

All three come out of installed packages and are served under `/vendor/` by a name that carries the hash of
the content, so that a browser may keep them for ever. A page names them by the placeholders `{{plotly_js}}`,
`{{plotly_css}}` (for `<link id="plotly.js-style-global" class="no-inline-styles" ...>`) and `{{math_font}}`
(a style sheet with the font and the rule that gives it to `<math>`), which `fill_page` turns into addresses.
"""

import gzip
import hashlib
import importlib.util
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from looplab.api.plotly_css import plotly_style_sheet
from looplab.resources import node_modules_dir

_KEEP_FOR_EVER = "public, max-age=31536000, immutable"

# Asked for in this order; the served file is fetched only where the system has none of them.
_SYSTEM_MATH_FONTS = ("Cambria Math", "STIX Two Math", "Latin Modern Math")
_MATH_FAMILY = "Looplab Math"


@dataclass(frozen=True)
class Asset:
    """A file of `/vendor/`: its address and where its bytes are."""

    url: str
    media_type: str
    source: Path | bytes

    @classmethod
    def of(cls, stem: str, suffix: str, media_type: str, source: Path | bytes) -> "Asset":
        """The asset under its hash; a file is hashed in pieces, which keeps megabytes out of the server's memory."""
        if isinstance(source, bytes):
            digest = hashlib.sha256(source)
        else:
            with source.open("rb") as file:
                digest = hashlib.file_digest(file, "sha256")
        return cls(f"/vendor/{stem}-{digest.hexdigest()[:16]}{suffix}", media_type, source)

    def read(self) -> bytes:
        return self.source if isinstance(self.source, bytes) else self.source.read_bytes()


def plotly_js_path() -> Path:
    """The plotly.js to serve: npm's small bundle if it is there, else the pip package's whole one."""
    node_modules = node_modules_dir()
    if node_modules is not None:
        small = node_modules / "plotly.js-cartesian-dist-min" / "plotly-cartesian.min.js"
        if small.is_file():
            return small
    whole = _package_dir("plotly") / "package_data" / "plotly.min.js"
    if not whole.is_file():
        raise FileNotFoundError(f"the installed plotly has no {whole.name}; run `pip install plotly`")
    return whole


def math_font_path() -> Path | None:
    """The math font of the installed packages, or None: pages then rely on the system's own."""
    try:
        fonts = _package_dir("ziamath") / "fonts"
    except FileNotFoundError:
        return None
    return next(iter(sorted(fonts.glob("*Math*.[ot]tf"))), None)


def _package_dir(name: str) -> Path:
    # find_spec does not run the package: importing plotly would cost the server its start-up time.
    spec = importlib.util.find_spec(name)
    if spec is None or not spec.submodule_search_locations:
        raise FileNotFoundError(f"the package {name} is not installed; run `pip install {name}`")
    return Path(spec.submodule_search_locations[0])


def math_style_sheet(font_url: str | None) -> str:
    """CSS that gives `<math>` a font with a MATH table: the system's if it has one, else `font_url`."""
    sources = [f'local("{name}")' for name in _SYSTEM_MATH_FONTS]
    if font_url is not None:
        kind = "opentype" if font_url.endswith(".otf") else "truetype"
        sources.append(f'url("{font_url}") format("{kind}")')
    return (
        f'@font-face {{ font-family: "{_MATH_FAMILY}"; font-display: swap; src: {", ".join(sources)}; }}\n'
        f'math {{ font-family: "{_MATH_FAMILY}", math; }}\n'
    )


@cache
def _assets() -> dict[str, Asset]:
    """Every asset by its placeholder; the font itself, which no page names, under its own key."""
    script = plotly_js_path()
    style = plotly_style_sheet(script.read_text(encoding="utf-8")).encode()
    assets = {
        "plotly_js": Asset.of("plotly", ".js", "text/javascript; charset=utf-8", script),
        "plotly_css": Asset.of("plotly", ".css", "text/css; charset=utf-8", style),
    }
    font = math_font_path()
    if font is not None:
        assets["math_font_file"] = Asset.of("math", font.suffix, f"font/{font.suffix[1:]}", font)
    face = math_style_sheet(assets["math_font_file"].url if font is not None else None).encode()
    assets["math_font"] = Asset.of("math", ".css", "text/css; charset=utf-8", face)
    return assets


@cache
def _compressed(asset: Asset) -> bytes:
    return gzip.compress(asset.read(), compresslevel=9, mtime=0)


def _route(asset: Asset) -> Route:
    async def serve(request: Request) -> Response:
        headers = {"Cache-Control": _KEEP_FOR_EVER, "Vary": "Accept-Encoding"}
        if "gzip" in request.headers.get("accept-encoding", ""):
            # Half a second for the whole plotly.js, once: in a thread, so that other requests are answered.
            body = await run_in_threadpool(_compressed, asset)
            headers["Content-Encoding"] = "gzip"
        else:
            body = await run_in_threadpool(asset.read)
        return Response(body, media_type=asset.media_type, headers=headers)

    return Route(asset.url, serve, methods=["GET"], include_in_schema=False)


def vendor_routes() -> list[Route]:
    """Routes of all assets, for the application to mount."""
    return [_route(asset) for asset in _assets().values()]


def fill_page(html: str) -> str:
    """The page with its asset placeholders turned into addresses."""
    for placeholder, asset in _assets().items():
        html = html.replace("{{" + placeholder + "}}", asset.url)
    return html
