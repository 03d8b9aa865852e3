"""A plant that is a matrix of transfer functions: its card, its page, and the way from an entry to the workbench."""

import math
import re
from urllib.parse import parse_qs, urlsplit

import pytest
from playwright.sync_api import Page, expect


def test_a_transfer_matrix_has_a_card_curves_and_a_way_to_the_workbench(page: Page):
    page.goto("/plants")
    shelf = page.locator(".plants-shelf", has=page.get_by_role("heading", name="Columns"))
    card = shelf.locator(".plant-tile", has_text="Ethanol-water column as a transfer matrix")
    expect(card.locator("svg")).to_be_attached()
    card.get_by_role("link").click()
    panel = page.locator("#panel-transfer-matrix")
    expect(panel.locator(".js-line").first).to_be_attached(timeout=20_000)
    expect(page.locator(".matrix-entry math")).to_have_count(4)

    # K (1 - exp(-(t - theta)/tau)) of both entries of u1 at the end of the run, 6 (18.8 + 1) in two digits
    ends = [K * (1 - math.exp(-(120 - theta) / tau)) for K, tau, theta in ((0.66, 6.7, 2.6), (-34.7, 8.15, 9.2))]
    said = panel.locator(".plant-words")
    expect(said).to_contain_text(re.compile(r"step of 1\.00\sgal/min in u1"))
    told = dict(re.findall(r"(y\d) = (-?[\d.]+)", said.inner_text().replace("\u2212", "-")))
    assert [float(told[name]) for name in ("y1", "y2")] == pytest.approx(ends, rel=1e-3)

    panel.get_by_role("radio", name=re.compile("^u2")).check()
    panel.get_by_role("textbox", name=re.compile("^Step size")).fill("10")
    page.keyboard.press("Enter")
    expect(said).to_contain_text(re.compile(r"step of 10\.0\spsi in u2"))

    links = page.get_by_role("link", name=re.compile("^Open in the workbench"))
    queries = [parse_qs(urlsplit(link.get_attribute("href") or "").query) for link in links.all()]
    assert queries[0] == {"plant": ["fopdt"], "K": ["0.66"], "tau": ["6.7"], "theta": ["2.6"]}
    links.nth(3).click()
    # the entry with a zero goes as a formula, which the workbench reads
    expect(page.locator("#panel-response .js-line, .panel .js-line").first).to_be_attached(timeout=15_000)
    assert parse_qs(urlsplit(page.url).query)["plant"] == queries[3]["plant"]
    expect(page.locator("[aria-invalid=true]")).to_have_count(0)
