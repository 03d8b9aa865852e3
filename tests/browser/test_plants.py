"""The plant library and its pages: drawings that move with the run, curves that grow, what happens said in words."""

import math
import re

import pytest
from playwright.sync_api import Locator, Page, expect

from access import barriers
from looplab.plants import plant_document, plant_ids, transfer_matrix_document, transfer_matrix_ids

VALUES = "document.querySelector('plant-schematic').values"


def open_plant(page: Page, plant_id: str, query: str = "") -> Locator:
    page.goto(f"/plants/{plant_id}?{query}")
    expect(page.locator("#panel-plant-run .js-line").first).to_be_attached()
    return page.locator(".run-play")


def clock(page: Page) -> float:
    found = re.search(r"t = ([\d.]+)", page.locator(".run-clock").inner_text())
    assert found is not None
    return float(found.group(1))


def run_until(page: Page, t: float) -> float:
    """Runs past t, and rests; the clock there."""
    page.locator(".run-play").click()
    page.wait_for_function("(t) => parseFloat(document.querySelector('.run-clock').textContent.slice(4)) > t", arg=t)
    page.locator(".run-play").click()
    expect(page.locator(".run-play")).to_have_text("Run")
    page.wait_for_timeout(100)
    return clock(page)


def test_the_library_shows_every_plant_and_finds_by_word(page: Page):
    page.goto("/plants")
    cards = page.locator(".plant-tile")
    documents = [*map(plant_document, plant_ids()), *map(transfer_matrix_document, transfer_matrix_ids())]
    expect(cards).to_have_count(len(documents))
    titles = {document["title"] for document in documents}
    assert set(page.locator(".plant-tile h3").all_inner_texts()) == titles
    page.get_by_label("Search").fill("pendulum cart")
    expect(page.locator(".plant-tile:visible")).to_have_count(1)
    page.get_by_label("Search").fill("zzz")
    expect(page.get_by_role("status").filter(has_text="No plant")).to_be_visible()
    page.get_by_label("Search").fill("pendulum")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", level=1)).to_have_text(plant_document("cart-pendulum")["title"], timeout=20_000)


def test_a_run_follows_the_exact_course_and_grows_its_curve(page: Page):
    # A bulb in a bath at 100: first order, T_m = 100 - 80 exp(-t/tau).
    open_plant(page, "thermometer", "u.T_f=100")
    tau = page.request.get("/api/v1/plants/thermometer").json()["time_scale"]
    before = page.locator("#panel-plant-run .js-line").first.get_attribute("d") or ""
    t = run_until(page, 2.0)
    shown = page.evaluate(VALUES)
    # The clock is read to four digits, the curve is straight between samples.
    assert shown["T_m"] == pytest.approx(100 - 80 * math.exp(-t / tau), abs=0.02)
    assert len(page.locator("#panel-plant-run .js-line").first.get_attribute("d") or "") > len(before) + 100


def test_an_input_steps_while_the_plant_runs(page: Page):
    open_plant(page, "thermometer")
    t = run_until(page, 0.5)
    page.get_by_role("button", name=re.compile("^Step T_f up")).click()
    expect(page).to_have_url(re.compile(r"u\.T_f="))
    level = float(page.url.split("u.T_f=")[1])
    assert level > 20
    later = run_until(page, t + 1.5)
    tau = page.request.get("/api/v1/plants/thermometer").json()["time_scale"]
    # The step comes at the next sample after the clock, at most a fortieth of a second on.
    low, high = (level - (level - 20) * math.exp(-max(0, later - t - late) / tau) for late in (0.03, 0.0))
    assert low - 0.02 <= page.evaluate(VALUES)["T_m"] <= high + 0.02


def test_what_happens_is_said_with_its_time(page: Page):
    # A dh/dt = -beta sqrt(h): sqrt(h) falls evenly, from h = 1 to 0.001.
    document = plant_document("gravity-drained-tank")
    value = {each["name"]: each["value"] for each in document["parameters"]}
    empty = 2 * value["A"] / value["beta"] * (1 - math.sqrt(0.001))
    open_plant(page, "gravity-drained-tank", "u.Fi=0&x.h=1")
    page.locator(".run-play").click()
    log = page.get_by_role("log")
    expect(log).to_contain_text(f"The tank is empty, at t = {empty:.4g}"[:-1], timeout=15_000)
    page.locator(".run-play").click()


def test_an_experiment_shows_its_complete_curves(page: Page):
    open_plant(page, "thermometer")
    page.get_by_text("Experiment", exact=True).click()
    form = page.locator("form")
    form.get_by_label("Course").select_option("Pulse")
    form.get_by_role("textbox", name=re.compile("^Runs for")).fill("40")
    form.get_by_role("button", name="Run the experiment").click()
    expect(page.get_by_role("button", name="Back to the live run")).to_be_visible()
    scrub = page.get_by_label("Moment of the run")
    scrub.focus()
    page.keyboard.press("End")
    expect(page.locator(".run-clock")).to_have_text("t = 40.00 s")
    page.get_by_role("button", name="Back to the live run").click()
    expect(page.get_by_role("button", name="Reset")).to_be_visible()


def test_a_run_is_driven_by_keys_alone(page: Page):
    play = open_plant(page, "heater")
    play.focus()
    page.keyboard.press("Space")
    expect(play).to_have_text("Pause")
    page.keyboard.press("Space")
    expect(play).to_have_text("Run")
    slider = page.get_by_role("slider", name=re.compile("^Q"))
    slider.focus()
    page.keyboard.press("ArrowRight")
    expect(page).to_have_url(re.compile(r"u\.Q=1010"))


@pytest.mark.allow_console("status of 404")
def test_a_plant_that_is_not_there(page: Page):
    page.goto("/plants/cstrr")
    expect(page.get_by_role("heading", name="No such plant")).to_be_visible()
    expect(page.locator("main")).to_contain_text("cstr")


@pytest.mark.parametrize("width", [1440, 360])
@pytest.mark.parametrize("path", ["/plants", "/plants/cstr"])
def test_the_pages_pass_axe(page: Page, path: str, width: int):
    page.set_viewport_size({"width": width, "height": 900})
    page.goto(path)
    expect(page.locator("plant-schematic svg").first).to_be_visible()
    page.evaluate("for (const fold of document.querySelectorAll('details')) fold.open = true")
    assert barriers(page, colours=width > 1000) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_a_column_has_a_legend_of_few_and_a_list_of_the_others(page: Page):
    page.goto("/plants/distillation")
    # Forty equations are read before the first curve is there.
    expect(page.locator("#panel-plant-run .js-line").first).to_be_attached(timeout=20_000)
    legend = page.locator("#panel-plant-run .legend button")
    expect(legend).to_have_count(8)
    page.get_by_label("Add a curve").select_option("x_10")
    expect(page.get_by_role("button", name="x_10: state")).to_have_attribute("aria-pressed", "true")
    expect(page.locator("#panel-plant-run .y4title")).to_have_text("x_10")
