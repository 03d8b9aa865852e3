"""The guard of every page test sees what it is there for: without this, a silent page proves nothing."""

from urllib.parse import urlsplit

import pytest

BROKEN_POLICY = "document.body.append(Object.assign(document.createElement('script'), { text: '1' }))"
NOT_CAUGHT = "setTimeout(() => { throw new Error('not caught'); }, 0)"
ELSEWHERE = "new Image().src = 'http://127.0.0.2:9/x.png'"


@pytest.fixture
def watched(browser, server_url, watcher):
    """A page of the server under a strict policy, and what the guard has seen of it."""
    context = browser.new_context(base_url=server_url)
    offences = watcher(context, urlsplit(server_url).netloc, allowed=["on purpose"])
    page = context.new_page()
    page.route(
        "**/strict",
        lambda route: route.fulfill(
            body="<!doctype html><link rel=icon href=data:,><body>text",
            content_type="text/html",
            headers={"Content-Security-Policy": "script-src 'self'"},
        ),
    )
    page.goto("/strict")
    yield page, offences
    context.close()


def test_a_well_behaved_page_passes(watched):
    page, offences = watched
    page.evaluate("console.warn('a warning'); console.error('an error on purpose')")
    page.wait_for_timeout(50)
    assert offences == []


@pytest.mark.parametrize(
    ("deed", "seen"),
    [
        ("console.error('broken')", "console error: broken"),
        (NOT_CAUGHT, "uncaught: "),
        (ELSEWHERE, "request to another host: GET http://127.0.0.2:9/x.png"),
        (BROKEN_POLICY, "console error: policy: script-src"),
    ],
)
def test_a_misdeed_is_seen(watched, deed, seen):
    page, offences = watched
    page.evaluate(deed)
    page.wait_for_timeout(200)
    assert any(offence.startswith(seen) for offence in offences), offences
