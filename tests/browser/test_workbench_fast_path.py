"""The fast path draws what Plotly draws: every line and marker within a pixel, and many times faster."""

import statistics

import numpy as np
import pytest
from playwright.sync_api import Page
from scipy.spatial import cKDTree

from workbench import open_workbench, settled

PLOTS = ["step", "bode", "nyquist", "nichols", "root_locus", "sensitivity"]
LOOPS = {
    "rational": "plant=1/(s%2B1)^3&type=PI&Kc=1.4&tau_I=2.2",
    "dead time": "plant=fopdt&K=1&tau=0.5&theta=0.1&type=PID&Kc=2.2&tau_I=0.5&tau_D=0.05",
    "unstable plant": "plant=2/((s-1)(0.1s%2B1))&type=PI&Kc=2&tau_I=2",
    "integrators": "plant=(s%2B3)/(s^2(s%2B2)(s%2B4))&type=PD&Kc=3&tau_D=2",
}

# One move of the gain, seen twice: as the fast path drew it, and as Plotly drew the same data after a rest.
MOVE_AND_LOOK = """
async (share) => {
  // A subplot is cut at its frame: what lies outside is drawn by neither.
  const window_of = (trace) => {
    const id = trace.closest("[clip-path]").getAttribute("clip-path").match(/#([^"')]+)/)[1];
    const frame = document.getElementById(id).querySelector("rect");
    return [Number(frame.getAttribute("width")), Number(frame.getAttribute("height"))];
  };
  const shapes = () => Object.fromEntries([...document.querySelectorAll(".panel .plot")].map((plot) => [
    plot.closest(".panel").id,
    [...plot.querySelectorAll("g.trace.scatter")].map((trace) => ({
      lines: [...trace.querySelectorAll("path.js-line")].map((path) => path.getAttribute("d")),
      points: [...trace.querySelectorAll("path.point")].map((path) => path.getAttribute("transform")),
      size: window_of(trace),
    })),
  ]));
  const seen = { fast: {}, react: {} };
  const panels = [...document.querySelectorAll(".panel:has(.plot)")].map((panel) => panel.id);
  const slider = document.querySelector("gain-slider[name=Kc] input[type=range]");
  const looked = new Promise((done) => {
    addEventListener("figure-drawn", (event) => {
      const id = event.target.closest(".panel").id;
      const { way } = event.detail;
      seen[way][id] = shapes()[id];
      if (panels.every((panel) => panel in seen.react)) done();
    });
    setTimeout(done, 8000);
  });
  slider.value = String(Number(slider.value) + 1000 * share);
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  await looked;
  return seen;
}
"""


def segments(trace: dict) -> np.ndarray:
    """All segments that a trace's paths draw, shape (n, 4): x0, y0, x1, y1 [px]."""
    found = [np.empty((0, 4))]
    for path in trace["lines"]:
        for stretch in path.split("M")[1:]:
            points = np.array([pair.split(",") for pair in stretch.rstrip("Z").split("L")], dtype=float)
            found.append(np.hstack([points[:-1], points[1:]]))
    return np.vstack(found)


def to_segments(points: np.ndarray, drawn: np.ndarray) -> np.ndarray:
    """From points, shape (n, 1, 2), to segments, shape (n or 1, m, 4), each to the nearest of its own [px]."""
    start, along = drawn[..., :2], drawn[..., 2:] - drawn[..., :2]
    share = ((points - start) * along).sum(axis=-1) / np.maximum((along**2).sum(axis=-1), 1e-12)
    away = start + np.clip(share, 0.0, 1.0)[..., None] * along - points
    return np.sqrt((away**2).sum(axis=-1)).min(axis=-1, initial=np.inf)


def distances(points: np.ndarray, drawn: np.ndarray) -> np.ndarray:
    """From each point to the nearest drawn segment [px]: those nearby first, all of them only where these are far."""
    if not len(points) or not len(drawn):
        return np.full(len(points), np.inf)
    middles = cKDTree(0.5 * (drawn[:, :2] + drawn[:, 2:]))
    _, nearby = middles.query(points, k=range(1, min(6, len(drawn)) + 1))
    nearest = to_segments(points[:, None], drawn[nearby])
    for i in np.flatnonzero(nearest > 0.2):
        nearest[i] = to_segments(points[i][None, None], drawn[None])[0]
    return nearest


def visible(drawn: np.ndarray, size: list[float]) -> np.ndarray:
    inside = (drawn[:, :2] >= 0.0) & (drawn[:, :2] <= np.array(size))
    return drawn[inside.all(axis=1), :2]


def apart(fast: dict, react: dict) -> float:
    """The farthest that a visible vertex of one drawing lies from the other drawing [px]."""
    ours, theirs, size = segments(fast), segments(react), react["size"]
    gaps = [distances(visible(ours, size), theirs), distances(visible(theirs, size), ours)]
    return float(np.concatenate(gaps).max(initial=0.0))


def place(transform: str) -> tuple[float, float]:
    x, y = transform.removeprefix("translate(").removesuffix(")").split(",")
    return float(x), float(y)


@pytest.mark.parametrize("loop", LOOPS)
def test_fast_path_and_plotly_agree_within_a_pixel(page: Page, loop: str, record_property):
    open_workbench(page, f"{LOOPS[loop]}&show={','.join(PLOTS)}")
    settled(page)
    seen = page.evaluate(MOVE_AND_LOOK, 0.04)
    worst = dict.fromkeys(PLOTS, 0.0)
    skipped: list[str] = []
    for plot in PLOTS:
        fast, react = seen["fast"].get(f"panel-{plot}"), seen["react"][f"panel-{plot}"]
        if fast is None:  # a curve came into being, and Plotly had to draw at once
            skipped.append(plot)
            continue
        assert len(fast) == len(react)
        for ours, theirs in zip(fast, react, strict=True):
            worst[plot] = max(worst[plot], apart(ours, theirs))
            near = sorted(place(t) for t in ours["points"] if "-99999" not in t)
            there = sorted(place(t) for t in theirs["points"])
            assert len(near) == len(there), plot
            for (x0, y0), (x1, y1) in zip(near, there, strict=True):
                worst[plot] = max(worst[plot], abs(x0 - x1), abs(y0 - y1))
    record_property("worst_px", worst)
    print(f"{loop}: at most {max(worst.values()):.3f} px apart")
    assert max(worst.values()) < 1.0, worst
    assert len(skipped) <= 1, skipped


def test_a_margin_that_comes_and_goes_is_drawn_right(page: Page):
    """P control of a lag has no crossover at a low gain: points and stems must appear, vanish and come back."""
    open_workbench(page, "plant=1/(s%2B1)&type=P&Kc=0.5&show=bode")
    settled(page)
    # The two markers of the gain crossover, one on each curve; only nodes in sight count.
    count = (
        "[...document.querySelectorAll('#panel-bode path.point')]"
        ".filter((p) => !p.getAttribute('transform').includes('-99999')).length"
    )
    move = "(value) => { const s = document.querySelector('gain-slider[name=Kc] input[type=range]');"
    move += " s.value = value; s.dispatchEvent(new Event('input', { bubbles: true })); }"
    assert page.evaluate(count) == 0
    for value, expected in ((500, 2), (200, 0), (600, 2)):
        page.evaluate(move, value)
        page.wait_for_timeout(60)
        settled(page)
        assert page.evaluate(count) == expected


def test_the_fast_path_takes_less_than_half_of_plotlys_time(page: Page, record_property):
    open_workbench(page)
    settled(page)
    for step in range(6):
        page.evaluate(MOVE_AND_LOOK, 0.01 if step % 2 else -0.01)
    drawings = page.evaluate("window.drawings.slice(-96)")
    ms = {way: statistics.median(d["ms"] for d in drawings if d["way"] == way) for way in ("fast", "react")}
    ratio = ms["fast"] / ms["react"]
    record_property("fast_ms", ms["fast"])
    record_property("react_ms", ms["react"])
    record_property("ratio", ratio)
    print(f"fast path {ms['fast']:.2f} ms, Plotly.react {ms['react']:.2f} ms a plot: ratio {ratio:.3f}")
    assert ratio < 0.5
