"""Compare and Gain map against closed forms and against the loop's own analysis."""

import json
import re

import pytest
from playwright.sync_api import Page, expect

from workbench import chip, curve, field, open_analyses, open_workbench, settled

FOPDT = "plant=fopdt&K=1&tau=5&theta=1&type=PI&Kc=2&tau_I=5"
RULES = "compare.rules=ziegler_nichols_reaction.PI,simc.PI"


def cells(page: Page, name: str) -> list[str]:
    row = page.locator("#panel-compare table.compare tbody tr").filter(has_text=name)
    return [cell.inner_text().strip() for cell in row.locator("td").all()]


def test_rules_side_by_side(page: Page):
    """SIMC on K=1, tau=5, theta=1: Kc = tau/(2 theta) = 2.5, tau_I = min(tau, 8 theta) = 5, L = 0.5 exp(-s)/s."""
    open_analyses(page, "compare", query=f"{FOPDT}&{RULES}")
    simc = cells(page, "SIMC")
    assert simc[:2] == ["2.50", "5.00"]
    # |L| = 1 at w = 0.5, where the phase is -90 deg - 0.5 rad; the phase is -180 deg at w = pi/2, where |L| = 1/pi.
    assert simc[3:5] == ["3.14", "61.4"]
    # e integrates to 1/(Kc/tau_I) = 2 without overshoot; a load to tau_I/Kc = 2.
    assert float(simc[8].replace("−", "-")) >= 2.0
    assert cells(page, "reaction curve")[:2] == ["4.50", "3.33"]
    now = cells(page, "Now (PI)")
    assert now[:2] == ["2.00", "5.00"]
    settled(page)
    expect(chip(page, "Ms")).to_have_text(now[5])
    x, y = curve(page, "compare", "now")
    assert x[0] == 0 and abs(y[-1] - 1) < 0.01


def test_a_row_sets_the_gains(page: Page):
    open_analyses(page, "compare", query=f"{FOPDT}&{RULES}")
    page.locator("#panel-compare tr").filter(has_text="SIMC").locator("th").click()
    expect(field(page, "Kc")).to_have_value("2.5")
    expect(page.locator("#panel-compare tbody tr").first).to_contain_text("2.50")
    button = page.get_by_role("button", name=re.compile("^Use Ziegler"))
    button.focus()
    button.press("Enter")
    expect(field(page, "Kc")).to_have_value("4.5")


def test_rules_are_added_and_removed(page: Page):
    open_analyses(page, "compare", query=f"{FOPDT}&{RULES}")
    page.get_by_label("Add a rule").select_option(label="AMIGO (Åström–Hägglund), PID")
    expect(page.locator("#panel-compare tbody tr")).to_have_count(5)
    page.get_by_role("button", name="Remove SIMC").click()
    expect(page.locator("#panel-compare tbody tr")).to_have_count(4)
    expect(page).to_have_url(re.compile(r"compare\.rules=ziegler_nichols_reaction\.PI,amigo\.PID"))


def test_a_model_error_gives_bands_and_the_worst_case(page: Page):
    open_analyses(page, "compare", query=f"{FOPDT}&{RULES}&compare.spread_pct=20")
    worst = page.get_by_role("table", name=re.compile("^The worst of 9 plants"))
    # With tau_I = tau the loop is worst where it is fastest and latest: most gain, least lag, most dead time.
    expect(worst.get_by_role("row", name=re.compile("SIMC"))).to_contain_text("K × 1.2, τ × 0.8, θ × 1.2")
    settled(page)
    x, y = curve(page, "compare", "band now")
    half = len(x) // 2
    assert x[:half] == list(reversed(x[half:]))
    assert all(high >= low for high, low in zip(y[:half], reversed(y[half:]), strict=True))
    assert max(y[:half]) > max(curve(page, "compare", "now")[1])


def test_another_plant_than_the_rules_were_told(page: Page):
    """Twice the gain halves the gain margin of SIMC, pi, and leaves its settings."""
    open_analyses(page, "compare", query=f"{FOPDT}&{RULES}")
    page.get_by_label("True P(s) =").fill("2 exp(-s)/(5s+1)")
    expect(page.locator("#panel-compare tr").filter(has_text="SIMC")).to_contain_text("1.57")
    assert cells(page, "SIMC")[:2] == ["2.50", "5.00"]


@pytest.mark.allow_console(r"status of 422")
def test_a_true_plant_that_is_none_is_told_in_place(page: Page):
    open_analyses(page, "compare", query=f"{FOPDT}&{RULES}")
    typed = page.get_by_label("True P(s) =")
    typed.fill("1/(s+")
    expect(typed).to_have_attribute("aria-invalid", "true")
    typed.fill("")
    expect(typed).not_to_have_attribute("aria-invalid", "true")


def test_the_limit_on_the_map_is_exact(page: Page):
    """1/(s+1)^3 under PI: s^4 + 3 s^3 + 3 s^2 + (1 + K) s + K/tau_I, limit tau_I = 9 K/((1 + K)(8 - K))."""
    open_analyses(page, "gain_map")
    settled(page)
    x, y = curve(page, "gain_map", "limit")
    points = [(K, tau) for K, tau in zip(x, y, strict=True) if K is not None and tau is not None]
    assert len(points) > 50
    for K, tau in points:
        assert tau == pytest.approx(9 * K / ((1 + K) * (8 - K)), rel=1e-6)


def test_a_contour_of_the_map_is_what_the_loop_says(page: Page):
    open_analyses(page, "gain_map")
    settled(page)
    x, y = curve(page, "gain_map", "Ms")
    inner = [(K, tau) for K, tau in zip(x, y, strict=True) if K is not None and 0.5 < K < 3]
    levels = [1.2, 1.4, 1.6, 2, 3]
    for K, tau in inner[:: max(1, len(inner) // 12)]:
        loop = {"plant": {"type": "expr", "text": "1/(s+1)^3"}, "controller": {"type": "pid", "Kc": K, "tau_I": tau}}
        answer = page.request.post("/api/v1/loop", data={"loop": loop, "want": ["margins"]})
        Ms = answer.json()["panels"]["margins"]["Ms"]
        assert min(abs(Ms - level) / level for level in levels) < 0.02


def handle(page: Page):
    return page.locator("#panel-gain_map .handle")


def test_the_handle_moves_by_keys(page: Page):
    open_analyses(page, "gain_map")
    settled(page)
    handle(page).focus()
    handle(page).press("ArrowRight")
    expect(field(page, "Kc")).to_have_value("1.43")
    handle(page).press("Shift+ArrowUp")
    expect(field(page, "tau_I")).to_have_value("2.77")
    expect(handle(page)).to_have_attribute("aria-label", re.compile("Kc 1.43, τI 2.77.s"))
    settled(page)
    page.get_by_role("button", name="Undo").click()
    expect(field(page, "Kc")).to_have_value("1.4")


def test_the_handle_is_dragged_and_the_loop_follows(page: Page):
    asked: list[dict] = []
    page.on("request", lambda r: r.url.endswith("/loop") and asked.append(json.loads(r.post_data or "{}")))
    open_analyses(page, "gain_map")
    settled(page)
    box = handle(page).bounding_box()
    assert box
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    ticks = page.locator("#panel-gain_map .xtick text").all_inner_texts()
    before = len(asked)
    page.mouse.move(*middle)
    page.mouse.down()
    page.mouse.move(middle[0] + 60, middle[1] - 40, steps=6)
    moving = float(field(page, "Kc").input_value())
    assert moving > 1.4
    page.mouse.up()
    settled(page)
    after = handle(page).bounding_box()
    assert after
    assert after["x"] - box["x"] == pytest.approx(60, abs=2)
    assert after["y"] - box["y"] == pytest.approx(-40, abs=2)
    assert len(asked) > before
    assert asked[-1]["loop"]["controller"]["Kc"] == moving
    assert page.locator("#panel-gain_map .xtick text").all_inner_texts() == ticks


def test_a_controller_that_is_not_PI_is_told_so(page: Page):
    open_analyses(page, "gain_map", query="type=PID")
    settled(page)
    expect(handle(page)).to_be_hidden()
    expect(page.locator("#panel-gain_map")).to_contain_text("choose PI in the Controller card")
    page.locator("#panel-gain_map").get_by_role("button", name="Use SIMC").click()
    expect(handle(page)).to_be_visible()
    expect(field(page, "Kc")).to_have_value("0.5")


def test_the_closed_loop_time_is_the_students(page: Page):
    """SIMC on K=1, tau=5, theta=1 with tau_c = 3: Kc = 5/(3 + 1), tau_I = min(5, 4 (3 + 1))."""
    open_workbench(page, f"{FOPDT}&show=step")
    page.locator("#card-tune .card-toggle").click()
    own = page.get_by_label("closed-loop time constant tau c, in s")
    own.fill("3")
    own.press("Enter")
    expect(page).to_have_url(re.compile("tune.tau_c=3"))
    simc = page.locator("#card-tune details").filter(has_text="SIMC")
    simc.locator("summary").click()
    expect(simc.locator(".setting").first).to_contain_text("1.250")
    expect(simc.locator(".setting").first).to_contain_text("5.000")


def test_the_slider_from_robust_to_fast_sets_the_best_gains(page: Page):
    """Whatever it sets has the Ms that it says; to the left is slower and more robust."""
    open_workbench(page, f"{FOPDT}&signal=load&show=step")
    page.locator("#card-trade-off .card-toggle").click()
    limit = page.get_by_label("Ms up to", exact=True)
    for Ms, words in (("1.7", "No PI does much better"), ("1.35", "No PI does much better")):
        limit.fill(Ms)
        limit.press("Enter")
        expect(page.locator("#card-trade-off")).to_contain_text(words)
        settled(page)
        assert abs(float(chip(page, "Ms").inner_text()) / float(Ms) - 1) < 0.03
    expect(limit).to_have_value("1.35")
    field(page, "tau_I").fill("20")
    field(page, "tau_I").press("Enter")
    expect(page.locator("#card-trade-off")).to_contain_text("The best PI with this Ms reaches")
    page.get_by_role("radio", name="PD").check()
    expect(page.locator("#card-trade-off")).to_contain_text("choose one in the Controller card")
