"""The page of the API: every route is on it, an example can be sent, and the code it gives runs."""

import json
import subprocess
import sys

import pytest
from playwright.sync_api import Page, expect

from access import barriers


def route(page: Page, name: str):
    return page.get_by_role("region", name=name, exact=True)


def test_every_route_of_the_description_is_shown(page: Page):
    page.goto("/api")
    description = page.request.get("/api/v1/openapi.json").json()
    expect(page.locator(".api-route")).to_have_count(sum(len(methods) for methods in description["paths"].values()))


def test_an_example_is_sent_and_answered(page: Page):
    page.goto("/api")
    loop = route(page, "POST /api/v1/loop")
    loop.get_by_role("button", name="Send").click()
    expect(loop.get_by_role("status")).to_contain_text("200 OK")
    expect(loop.locator(".api-answer")).to_contain_text('"closed_loop_stable": true')


@pytest.mark.allow_console("status of 4")
def test_a_wrong_request_shows_the_error(page: Page):
    page.goto("/api")
    tune = route(page, "POST /api/v1/tune")
    tune.get_by_label("Request").fill('{"plant": {"type": "expr", "text": "1/(s+q)"}}')
    tune.get_by_role("button", name="Send").click()
    expect(tune.get_by_role("status")).to_contain_text("422")
    expect(tune.locator(".api-answer")).to_contain_text('"error"')


def test_the_python_it_gives_runs(page: Page):
    page.goto("/api")
    loop = route(page, "POST /api/v1/loop")
    loop.get_by_role("radio", name="Python").check()
    code = loop.locator("pre").last.inner_text()
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert "'closed_loop_stable': True" in done.stdout


def test_the_body_of_the_curl_line_is_the_example(page: Page):
    page.goto("/api")
    loop = route(page, "POST /api/v1/loop")
    line = loop.locator("pre").last.inner_text()
    body = line.split("-d '")[1].removesuffix("'")
    assert json.loads(body) == json.loads(loop.get_by_label("Request").input_value())


@pytest.mark.parametrize("width", [1440, 360])
def test_the_page_passes_axe(page: Page, width: int):
    page.set_viewport_size({"width": width, "height": 800})
    page.goto("/api")
    expect(page.locator(".api-route").first).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    # The routes are alike: some of them are enough to look at.
    page.evaluate("document.querySelectorAll('.api-route').forEach((route, i) => i % 6 && route.remove())")
    assert barriers(page, colours=width > 1000) == []
