"""Three seconds of dragging a gain: every frame is asked for, one request is in flight, the last value is shown."""

import json

import pytest
from playwright.sync_api import Page, Request, expect

from workbench import chip, field, open_workbench, settled

SECONDS = 3
LOOPS = {"rational": "", "dead time": "plant=fopdt&K=1&tau=0.5&theta=0.1&type=PI&Kc=2.2&tau_I=0.5"}

# A new value each frame, as fast as a hand and a screen can give them; then the release.
DRAG = """
async ({ seconds, last }) => {
  const slider = document.querySelector("gain-slider[name=Kc] input[type=range]");
  const set = (value) => { slider.value = String(value); slider.dispatchEvent(new Event("input", { bubbles: true })); };
  const ticks = () =>
    [...document.querySelectorAll(".plot .xtick text, .plot .ytick text")].map((tick) => tick.textContent).join();
  const labels = new Set();
  const begin = performance.now();
  let frames = 0;
  await new Promise((done) => {
    const frame = () => {
      const t = performance.now() - begin;
      if (t > 1000 * seconds) return done();
      frames += 1;
      labels.add(ticks());
      set(Math.round(380 + 220 * Math.sin(t / 600)));
      requestAnimationFrame(frame);
    };
    frame();
  });
  set(last);
  const release = performance.now();
  slider.dispatchEvent(new Event("change", { bubbles: true }));
  return { begin, release, frames, labels: [...labels] };
}
"""


class Traffic:
    """The `/loop` requests of a page: how many, how many at once, what they asked."""

    def __init__(self, page: Page) -> None:
        self.sent: list[Request] = []
        self.under_way = 0
        self.most = 0
        page.on("request", self._sent)
        page.on("requestfinished", self._over)
        page.on("requestfailed", self._over)

    def _sent(self, request: Request) -> None:
        if request.url.endswith("/loop"):
            self.sent.append(request)
            self.under_way += 1
            self.most = max(self.most, self.under_way)

    def _over(self, request: Request) -> None:
        if request.url.endswith("/loop"):
            self.under_way -= 1


@pytest.mark.parametrize("loop", LOOPS)
def test_dragging_a_gain(page: Page, loop: str, record_property):
    open_workbench(page, LOOPS[loop])
    settled(page)
    traffic = Traffic(page)

    drag = page.evaluate(DRAG, {"seconds": SECONDS, "last": 470})
    settled(page)
    drawings = page.evaluate("window.drawings")
    moving = [d for d in drawings if drag["begin"] <= d["at"] <= drag["release"]]
    updates = sum(d["panel"] == "panel-step" for d in moving) / SECONDS
    redrawn = [d for d in moving if d["way"] == "react"]
    after = [d for d in drawings if d["at"] > drag["release"]]
    # What is drawn of the answer at rest is the last value; the curve may be seen before Plotly has its turn.
    seen: dict[str, float] = {}
    final: dict[str, float] = {}
    for drawing in (d for d in after if not d["moving"]):
        seen.setdefault(drawing["panel"], drawing["at"] - drag["release"])
        if drawing["way"] == "react":
            final[drawing["panel"]] = drawing["at"] - drag["release"]
    found = {
        "loop": loop,
        "updates_per_second": round(updates, 1),
        "frames_per_second": round(drag["frames"] / SECONDS, 1),
        "requests": len(traffic.sent),
        "most_in_flight": traffic.most,
        "redrawn_by_plotly_while_moving": len(redrawn),
        "final_lag_ms": round(max(seen.values())),
        "final_drawing_ms": round(max(final.values())),
    }
    for name, value in found.items():
        record_property(name, value)
    print(json.dumps(found))

    # The slider at 470 of 1000 between 0.1 and 100 is 10^(-1 + 3 * 0.47) = 2.57.
    assert field(page, "Kc").input_value() == "2.57"
    asked = json.loads(traffic.sent[-1].post_data or "{}")
    assert asked["loop"]["controller"]["Kc"] == 2.57, "the last value is the last one asked for"
    assert asked["points"] > 500, "at rest in full quality"
    answer = traffic.sent[-1].response()
    assert answer is not None and answer.ok
    margins = answer.json()["panels"].get("margins")
    if margins:
        expect(chip(page, "GM")).to_contain_text(f"{margins['GM']:.3g}"[:4])
    assert traffic.most == 1, "one request in flight"
    assert set(final) >= {"panel-step", "panel-bode", "panel-nyquist"}
    assert updates > 2


def test_axes_hold_while_a_gain_moves(page: Page):
    open_workbench(page)
    settled(page)
    labels = page.evaluate(DRAG, {"seconds": 1, "last": 700})["labels"]
    assert len(labels) == 1, "all frames have the same tick labels"


def test_the_last_of_many_values_is_shown_even_if_the_server_is_slow(page: Page):
    open_workbench(page)
    settled(page)
    traffic = Traffic(page)

    def slowly(route):
        page.wait_for_timeout(150)
        route.continue_()

    page.route("**/api/v1/loop", slowly)
    box = field(page, "Kc")
    for value in ("2", "2.5", "3", "3.5", "4"):
        box.fill(value)
    box.press("Enter")
    # GM times Kc is the limit 4.635 of this loop.
    expect(chip(page, "GM")).to_contain_text("1.16")
    settled(page)
    expect(chip(page, "GM")).to_contain_text("1.16")
    assert traffic.most == 1
    assert len(traffic.sent) < 6, "values that were overtaken are not sent"
