"""Chromium for the page tests, and a guard that no page may err, break its policy or leave its host."""

import os
import re
import shutil
from collections.abc import Callable, Iterator, Sequence
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import BrowserContext, ConsoleMessage, Request, WebError

# Chromium's own background traffic has no place in a test; as root it has no sandbox.
CHROMIUM_FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]

# The shell is the same engine without the windows that a browser draws for nobody: a third of the work less.
CHROMIUMS = ("chromium-headless-shell", "chromium")

# A report can come without a console line (a policy of report-only, a later navigation): say it ourselves.
REPORT_POLICY = """
addEventListener("securitypolicyviolation", (event) =>
  console.error(`policy: ${event.violatedDirective} blocked ${event.blockedURI} in ${event.sourceFile}`));
"""


@pytest.fixture(scope="session")
def browser_type_launch_args(browser_type_launch_args: dict[str, object]) -> dict[str, object]:
    name = os.environ.get("LOOPLAB_CHROMIUM") or next(filter(shutil.which, CHROMIUMS), CHROMIUMS[-1])
    path = shutil.which(name)
    if path is None:
        pytest.fail(
            f"the page tests need Chromium and there is no {name!r}: apt-get install chromium, "
            "or name another Chromium in LOOPLAB_CHROMIUM",
            pytrace=False,
        )
    return {**browser_type_launch_args, "executable_path": path, "headless": True, "args": CHROMIUM_FLAGS}


@pytest.fixture(scope="session")
def base_url(server_url: str) -> str:
    """`page.goto("/workbench")` goes to the server of this session."""
    return server_url


def watch(context: BrowserContext, host: str, allowed: Sequence[str] = ()) -> list[str]:
    """The list that what its pages should never do is added to, from now on."""
    offences: list[str] = []

    def on_console(message: ConsoleMessage) -> None:
        if message.type == "error" and not any(re.search(pattern, message.text) for pattern in allowed):
            offences.append(f"console error: {message.text} ({message.location.get('url')})")

    def on_error(error: WebError) -> None:
        offences.append(f"uncaught: {error.error}")

    def on_request(sent: Request) -> None:
        target = urlsplit(sent.url)
        if target.scheme not in ("data", "blob") and target.netloc != host:
            offences.append(f"request to another host: {sent.method} {sent.url}")

    context.add_init_script(REPORT_POLICY)
    context.on("console", on_console)
    context.on("weberror", on_error)
    context.on("request", on_request)
    return offences


@pytest.fixture(scope="session")
def watcher() -> Callable[..., list[str]]:
    return watch


@pytest.fixture
def context(context: BrowserContext, server_url: str, request: pytest.FixtureRequest) -> Iterator[BrowserContext]:
    """A browser context whose pages fail the test by what they should never do.

    A test that provokes an error on purpose says which: `@pytest.mark.allow_console(r"status of 422")`.
    """
    allowed = [pattern for mark in request.node.iter_markers("allow_console") for pattern in mark.args]
    offences = watch(context, urlsplit(server_url).netloc, allowed)
    yield context
    assert not offences, "\n".join(offences)
