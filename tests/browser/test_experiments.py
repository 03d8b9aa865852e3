"""From an experiment to a controller: the flow, lines to be dragged, records of one's own, the loop under the hand."""

import math
import re
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest
from playwright.sync_api import Page, expect

from access import violations

RECORDS = Path(__file__).parents[1] / "engine" / "identification" / "records"
# All methods side by side take a second of a free processor.
SLOW = 20_000
FOPDT = "plant=fopdt&K=2&tau=10&theta=3"


def numbers(page: Page) -> dict[str, float]:
    """K, tau, theta and the fit, as the page shows them."""
    names = page.locator(".model-numbers dt").all_inner_texts()
    values = page.locator(".model-numbers dd strong").all_inner_texts()
    return {name: float(value.split()[0].split("\u202f")[0]) for name, value in zip(names, values, strict=True)}


def query(page: Page) -> dict[str, str]:
    return {name: values[0] for name, values in parse_qs(urlsplit(page.url).query).items()}


def begin(page: Page, action: str) -> None:
    """Presses the experiment's button, and watches its beginning."""
    page.get_by_role("button", name=action).click()
    expect(page.locator("#panel-experiment .js-line").first).to_be_attached()


def test_from_a_step_to_a_controller_on_the_true_plant(page: Page):
    page.goto(f"/experiments?{FOPDT}&method=least_squares")
    begin(page, "Make the step")
    curve = page.locator("#panel-experiment .js-line").nth(1)
    early = len(curve.get_attribute("d") or "")
    expect(page.locator("#step-model .empty")).to_be_visible()
    page.wait_for_function(
        "(n) => document.querySelectorAll('#panel-experiment .js-line')[1].getAttribute('d').length > n + 50", arg=early
    )
    page.get_by_role("button", name="Show all").click()
    expect(page.locator(".model-numbers")).to_be_visible(timeout=SLOW)
    assert numbers(page) == pytest.approx({"K": 2, "τ": 10, "θ": 3, "fit": 100})
    # SIMC with tau_c = theta: Kc = tau/(2 K theta), tau_I = tau.
    page.get_by_role("button", name=re.compile("^Try SIMC")).click()
    expect(page.locator(".run-says")).to_have_text(
        re.compile("The model promised (\\d+) % overshoot; the true plant gives \\1 %")
    )
    there = urlsplit(page.get_by_role("link", name="Open model and controller").get_attribute("href") or "")
    at = {name: values[0] for name, values in parse_qs(there.query).items()}
    assert (at["plant"], at["type"]) == ("fopdt", "PI")
    assert [float(at[name]) for name in ("K", "tau", "theta", "Kc", "tau_I")] == pytest.approx(
        [2, 10, 3, 5 / 6, 10], rel=1e-5
    )
    page.reload()
    expect(page.locator(".run-says")).to_contain_text("The model promised", timeout=SLOW)
    assert numbers(page)["τ"] == 10


def test_a_nonlinear_plant_is_controlled_by_what_was_read_off_it(page: Page):
    page.goto("/experiments?plant=library&id=tanks-in-series&pick=simc.PI&change=0.05")
    expect(page.locator(".run-says")).to_contain_text("the true plant gives", timeout=SLOW)
    page.get_by_role("button", name="Numbers of Promised and true as a table").click()
    # The promise may have more samples, at the corners that its dead time makes.
    rows = page.locator("#panel-true-loop tbody tr")
    last = rows.filter(has_not_text="—").last.locator("td").all_inner_texts()
    # From 0.5 mol/l a step of 0.05, kept by integral action; in the feed as much, for the tanks have a gain of one.
    assert [float(last[k]) for k in (1, 2)] == pytest.approx([0.55, 0.55], rel=2e-3)


def test_construction_lines_are_dragged(page: Page):
    page.goto(f"/experiments?{FOPDT}&line.t2=20")
    expect(page.locator(".model-methods table")).to_be_visible(timeout=SLOW)
    handle = {k: page.get_by_role("button", name=f"Line t{k}") for k in "₀₁₂"}

    def line(k: str) -> float:
        found = re.search(r"at ([\d.]+)", handle[k].get_attribute("aria-label") or "")
        assert found is not None
        return float(found.group(1))

    def by_formula() -> dict[str, float]:
        tau = 1.5 * (line("₂") - line("₁"))
        return {"τ": tau, "θ": max(0.0, line("₂") - line("₀") - tau)}

    assert line("₂") == 20
    assert numbers(page)["τ"] == pytest.approx(by_formula()["τ"], rel=2e-3)
    handle["₂"].focus()
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Shift+ArrowLeft")
    assert line("₂") < 20
    expect(page).to_have_url(re.compile(r"line\.t2=1\d\."))
    keyed = numbers(page)
    assert [keyed[name] for name in "τθ"] == pytest.approx([by_formula()[name] for name in "τθ"], abs=0.02)
    box = handle["₁"].bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    before = line("₁")
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x - 15, y + 20, steps=4)
    page.mouse.up()
    assert line("₁") < before
    dragged = numbers(page)
    assert dragged["τ"] > keyed["τ"]
    assert dragged["τ"] == pytest.approx(by_formula()["τ"], abs=0.02)
    page.get_by_role("button", name="Back to the method's own lines").click()
    # Two points are exact on a first-order lag with dead time.
    assert numbers(page)["τ"] == pytest.approx(10, rel=0.01)
    expect(page).not_to_have_url(re.compile("line"))


@pytest.mark.allow_console("status of 422")
def test_records_of_ones_own(page: Page):
    page.goto("/experiments?method=least_squares")
    page.get_by_text("Use a record of your own", exact=True).click()
    text = page.get_by_label("Record as text")
    text.fill((RECORDS / "german-with-bom.csv").read_bytes().decode("utf-8"))
    expect(page.locator("#panel-identify")).to_contain_text("Istwert [K]", timeout=SLOW)
    assert numbers(page) == pytest.approx({"K": 2, "τ": 5, "θ": 1, "fit": 100}, rel=1e-3)
    message = page.locator("#step-model .step-message")
    page.locator("input[type=file]").set_input_files(RECORDS / "text-in-the-middle.csv")
    expect(message).to_contain_text("Line 18, column 3: y is not a number")
    expect(message).to_contain_text("It reads: 8.0,1,sensor fault")
    expect(page.locator("#panel-identify")).to_be_hidden()
    text.fill("a;b;c;d\n" + "".join(f"{k};{int(k > 1)};{k * k};7\n" for k in range(12)))
    page.get_by_label("output y").select_option("c")
    page.get_by_role("button", name="Read these columns").click()
    expect(page.locator("#panel-identify")).to_contain_text("c", timeout=SLOW)


def test_the_loop_rings_under_the_hand(page: Page):
    page.goto("/experiments?plant=1/(s%2B1)^3&experiment=hand&Kc=4")
    page.get_by_role("button", name="Start the loop").click()
    page.get_by_label("Speed").select_option("3 ×")
    word = page.locator("#panel-by-hand .hand-word")
    expect(word).to_have_text("decaying", timeout=SLOW)
    expect(page.get_by_role("button", name="This is Ku")).to_be_disabled()
    gain = page.locator("gain-slider input[type=text]")
    # Ku = 8 at omega = sqrt(3).
    gain.fill("8")
    gain.press("Enter")
    page.get_by_role("button", name="Bump the setpoint").click()
    expect(word).to_have_text("sustained", timeout=SLOW)
    page.get_by_role("button", name="This is Ku").click()
    rows = page.locator(".experiment-findings tbody tr")
    Pu = float(rows.nth(1).locator("td").first.inner_text().split("\u202f")[0])
    assert Pu == pytest.approx(2 * math.pi / math.sqrt(3), rel=0.01)
    expect(rows.first).to_have_text(re.compile(r"Ku\s*8\.000\s*8\.000\s*0\.00 %"))
    expect(page.get_by_role("button", name=re.compile("^Try Ziegler–Nichols .ultimate"))).to_be_visible()
    gain.fill("12")
    gain.press("Enter")
    expect(word).to_have_text(re.compile("growing|run away"), timeout=SLOW)


@pytest.mark.allow_console("status of 422")
def test_what_has_no_ultimate_gain_says_why(page: Page):
    page.goto("/experiments?plant=1/(s%2B1)&experiment=search")
    page.get_by_role("button", name="Search Ku").click()
    expect(page.locator("#step-experiment .step-message")).to_contain_text("its phase never reaches -180 deg")
    page.get_by_label("P(s) =").fill("1/((s-1)(0.1s+1)^2)")
    page.wait_for_timeout(500)
    page.get_by_role("button", name="Search Ku").click()
    page.get_by_role("button", name="Show all").click()
    # s^3 + 19 s^2 + 80 s + 100 (Kc - 1): stable from 1 on, and for 19*80 > 100 (Kc - 1).
    expect(page.locator(".experiment-findings")).to_contain_text("gains from 1 to 16.2 hold it")


LIVE = """async ({A, B, C, theta, Kc, step, until, then}) => {
  const { createProportionalLoop } = await import("/static/core/experiments/proportional-loop.js");
  const loop = createProportionalLoop({ A, B, C, theta }, { Kc, step });
  loop.until(until);
  if (then) { loop.Kc = then; loop.until(2 * until); }
  return loop.curves;
}"""


def test_the_live_loop_is_the_exact_one(page: Page):
    page.goto("/api")
    # u = 3 (1 - y), then 5 (1 - y), on 1/(s + 1): y goes to 3/4 like exp(-4 t), then to 5/6 like exp(-6 t).
    lag = {"A": [[-1]], "B": [[1]], "C": [[1]]}
    curves = page.evaluate(LIVE, {**lag, "theta": 0, "Kc": 3, "step": 0.002, "until": 1, "then": 5})
    first = 0.75 * (1 - math.exp(-4))
    want = [
        0.75 * (1 - math.exp(-4 * t)) if t <= 1 else 5 / 6 + (first - 5 / 6) * math.exp(-6 * (t - 1))
        for t in curves["t"]
    ]
    assert curves["y"] == pytest.approx(want, abs=1e-5)
    # With dead time: nothing until 0.5, the open loop's 2 (1 - exp(-t)) until 1, then the next step of the method.
    curves = page.evaluate(LIVE, {**lag, "theta": 0.5, "Kc": 2, "step": 0.002, "until": 1.5, "then": None})

    def exact(t: float) -> float:
        a, b = max(t - 0.5, 0), max(t - 1, 0)
        return 2 * (1 - math.exp(-a)) - 4 * (1 - math.exp(-b) - b * math.exp(-b))

    assert curves["y"] == pytest.approx([exact(t) for t in curves["t"]], abs=1e-5)


def test_lines_and_swings_read_what_they_are_made_of(page: Page):
    page.goto("/api")
    read = page.evaluate("""async () => {
      const { modelOfLines } = await import("/static/core/experiments/construction.js");
      const { lagResponse } = await import("/static/core/experiments/lag-response.js");
      const { createSwings, judge } = await import("/static/core/experiments/swings.js");
      const t = Array.from({ length: 4001 }, (_, k) => k / 50);
      const record = { t, u: t.map((s) => (s >= 5 ? 3 : 1)), u_before: 1 };
      const y = lagResponse({ K: 2, tau: 4, theta: 1.5 }, record, 10);
      const made = 6.5;
      const lines = { t0: 5, y0: 10, y_final: 14 };
      const of = (method, more) => modelOfLines(method, { ...lines, ...more }, 2, { t, y });
      const swings = createSwings(1e-6);
      for (const s of t) swings.push(s, Math.exp(-0.05 * s) * Math.cos(2 * s));
      return {
        y,
        tangent: of("tangent", { t1: made, t2: made + 4 }),
        two_point: of("two_point", { t1: made + 4 / 3, t2: made + 4 }),
        area: of("area", { t_ar: made + 4 }),
        sk: of("sundaresan_krishnaswamy", { t1: 9, t2: 15 }),
        none: of("two_point", { t1: 9, t2: 8 }),
        judged: judge(swings.points),
      };
    }""")
    for k in range(0, 4001, 250):
        t = k / 50
        assert read["y"][k] == pytest.approx(10 + 4 * (1 - math.exp(-max(t - 6.5, 0) / 4)), abs=1e-12)
    exact = {"K": 2, "tau": 4, "theta": 1.5}
    for method in ("tangent", "two_point"):
        assert read[method] == pytest.approx(exact)
    # Straight lines between the samples.
    assert read["area"] == pytest.approx(exact, rel=1e-4)
    # By the formula in the paper: 0.67 (10 - 4), 1.3 x 4 - 0.29 x 10.
    assert read["sk"] == pytest.approx({"K": 2, "tau": 4.02, "theta": 2.3})
    assert read["none"] is None
    assert read["judged"]["ratio"] == pytest.approx(math.exp(-0.05 * math.pi), rel=1e-4)
    assert read["judged"]["Pu"] == pytest.approx(math.pi, rel=1e-4)
    assert read["judged"]["verdict"] == "decaying"


@pytest.mark.parametrize(("width", "scheme"), [(1440, "light"), (360, "dark")])
def test_the_page_passes_axe(page: Page, width: int, scheme: str):
    page.set_viewport_size({"width": width, "height": 900})
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    page.goto(f"/experiments?{FOPDT}&pick=simc.PI&line.t2=22")
    expect(page.locator(".run-says")).to_contain_text("The model promised", timeout=SLOW)
    page.evaluate("for (const fold of document.querySelectorAll('details')) fold.open = true")
    assert violations(page) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
