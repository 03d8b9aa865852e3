"""What a plant's page works out: steady states, map, linear model, balance, phase plane, profile and closed loop."""

import re

import pytest
from playwright.sync_api import Locator, Page, expect

from access import barriers
from looplab.plants import plant_document

SLOW = 30_000


def ask(page: Page, panel_id: str) -> Locator:
    panel = page.locator(f"#panel-{panel_id}")
    panel.locator(".plant-form .button.primary").click()
    expect(panel).to_have_class(re.compile("answered"), timeout=SLOW)
    return panel


def open_plant(page: Page, plant_id: str, query: str = "") -> None:
    page.goto(f"/plants/{plant_id}?{query}")
    expect(page.locator("#panel-plant-run .js-line").first).to_be_attached(timeout=SLOW)


def test_the_reactor_rests_in_three_states_and_runs_from_each(page: Page):
    open_plant(page, "cstr")
    panel = ask(page, "plant-steady")
    known = sorted(point["near"]["T"] for point in plant_document("cstr")["operating_points"])
    rows = panel.locator("tbody tr")
    expect(rows).to_have_count(3)
    shown = sorted(
        float(text.split()[0].replace("\u202fK", "")) for text in rows.locator("td:nth-child(2)").all_inner_texts()
    )
    assert shown == pytest.approx(known, rel=5e-4)
    expect(panel.locator(".yes-no", has_text="unstable")).to_have_count(1)
    unstable = rows.filter(has=page.locator(".yes-no", has_text="unstable"))
    unstable.get_by_role("button", name=re.compile("Start the run")).click()
    expect(page).to_have_url(re.compile(r"x\.T=385\.11"))


def test_a_linear_model_goes_to_the_workbench(page: Page):
    open_plant(page, "gravity-drained-tank")
    panel = ask(page, "plant-linear")
    # dh/dt = (Fi - beta sqrt(h))/A at h = 1: the gain is 2 sqrt(h)/beta, the time constant 2 A sqrt(h)/beta.
    values = {each["name"]: each["value"] for each in plant_document("gravity-drained-tank")["parameters"]}
    table = panel.locator("table.values").first
    expect(table.locator("tr", has_text="static gain")).to_contain_text(f"{2 / values['beta']:.4f}")
    expect(table.locator("tr", has_text="time constants")).to_contain_text(f"{2 * values['A'] / values['beta']:.2f}")
    panel.get_by_role("link", name="Open in the workbench").click()
    expect(page).to_have_url(re.compile("/workbench.*plant=ss"))
    expect(page.locator("#panel-step .js-line").first).to_be_attached(timeout=SLOW)


def test_a_loop_holds_the_reactor_where_it_is_unstable(page: Page):
    open_plant(page, "cstr", "x.cA=0.724446&x.T=385.1107")
    panel = page.locator("#panel-plant-loop")
    panel.get_by_label("Manipulated").select_option("Q")
    panel.get_by_role("button", name="Suggest gain and action").click()
    expect(panel).to_have_class(re.compile("answered"), timeout=SLOW)
    expect(panel.get_by_label("Action")).to_have_value("direct")
    panel.get_by_role("button", name=re.compile("as a table")).click()
    t, r, y = (float(cell) for cell in panel.locator(".data-table tbody tr").last.locator("td").all_inner_texts()[:3])
    assert t == 10
    assert y == pytest.approx(r, abs=0.5)
    # The drawing plays the loop's run.
    expect(page.get_by_role("button", name="Back to the live run")).to_be_visible()


def test_a_trajectory_starts_where_it_is_typed(page: Page):
    open_plant(page, "jacketed-cstr")
    panel = ask(page, "plant-phase")
    panel.get_by_role("textbox", name=re.compile("^From cA")).fill("0.2")
    panel.get_by_role("button", name="Add a trajectory").click()
    panel.get_by_role("button", name=re.compile("as a table")).click()
    first = panel.locator(".data-table tbody tr").first.locator("td")
    expect(first).to_have_text(["1.0000", "0", "0.20000", "350.00"], timeout=SLOW)


def test_states_in_a_row_have_a_profile(page: Page):
    open_plant(page, "tanks-in-series")
    expect(page.locator("#panel-plant-profile .js-line")).to_have_count(2)
    open_plant(page, "cstr")
    expect(page.locator("#panel-plant-profile")).to_have_count(0)


@pytest.mark.parametrize("width", [1440, 360])
def test_answered_analyses_pass_axe(page: Page, width: int):
    page.set_viewport_size({"width": width, "height": 900})
    open_plant(page, "jacketed-cstr")
    for panel_id in ("plant-steady", "plant-map", "plant-linear", "plant-balance", "plant-phase"):
        ask(page, panel_id)
    assert barriers(page, colours=width > 1000) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
