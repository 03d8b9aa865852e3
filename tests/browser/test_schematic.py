"""A drawing moves with its values, says them, keeps still where motion is not wanted, and survives its mistakes."""

import json
import math
from pathlib import Path
from typing import get_args

import pytest
from playwright.sync_api import Page, expect

from looplab.schemas.schematic import Schematic
from looplab.schemas.schematic.values import ColourBinding, ColourName

DRAWINGS = sorted((Path(__file__).resolve().parents[2] / "server" / "looplab" / "plants" / "schematics").glob("*.json"))

SHOW = """async ([drawing, values, units, width]) => {
  await import("/static/components/plant-schematic.js");
  const sheet = document.createElement("link");
  sheet.rel = "stylesheet";
  sheet.href = "/static/styles/schematic.css";
  document.head.append(sheet);
  await new Promise((loaded) => { sheet.onload = loaded; });
  const host = document.createElement("div");
  host.style.width = `${width}px`;
  const element = document.createElement("plant-schematic");
  host.append(element);
  document.querySelector("main").replaceChildren(host);
  element.drawing = drawing;
  element.units = units;
  element.values = values;
  return element.problems;
}"""
SET = "(values) => { document.querySelector('plant-schematic').values = values; }"
RUNNING = """() => document.querySelector("plant-schematic").getAnimations({ subtree: true })
  .filter((animation) => animation.playState === "running").length"""

TANK = {
    "title": "A tank",
    "view": [480, 320],
    "shapes": [
        {"kind": "tank", "id": "tank", "x": 100, "y": 100, "width": 100, "height": 200}
        | {"level": {"signal": "h", "from": [0, 2]}, "fill": {"signal": "T", "from": [0, 100], "scale": "temperature"}},
        {"kind": "rod", "id": "rod", "x": 300, "y": 200, "length": 80}
        | {"rotate": {"signal": "phi", "from": [0, math.pi], "to": [0, 180], "clamp": False}},
        {"kind": "pipe", "points": [[200, 280], [400, 280]], "flow": {"signal": "F", "from": [0, 2]}},
        {"kind": "readout", "signal": "h", "x": 470, "y": 30, "decimals": 2},
    ],
}


def show(page: Page, drawing: object, values: dict[str, float], width: int = 480) -> list[dict[str, str]]:
    page.goto("/labs")
    return page.evaluate(SHOW, [drawing, values, {"h": "m"}, width])


def test_levels_angles_and_numbers_follow_the_values(page: Page):
    assert show(page, TANK, {"h": 0.5, "T": 0.0, "phi": 0.0, "F": 1.0}) == []
    liquid = page.locator("[data-id=tank] rect").first
    expect(liquid).to_have_attribute("height", "50")
    expect(liquid).to_have_attribute("y", "150")
    kept = liquid.element_handle()
    cold = liquid.evaluate("(node) => getComputedStyle(node).fill")

    page.evaluate(SET, {"h": 1.5, "T": 100.0, "phi": -3 * math.pi / 2})
    expect(liquid).to_have_attribute("height", "150")
    expect(page.locator("[data-id=rod] > g")).to_have_attribute("transform", "rotate(-270)")
    expect(page.locator(".readout-value")).to_have_text("1.50")
    assert liquid.evaluate("(node) => getComputedStyle(node).fill") != cold
    # the same node, moved: nothing is built again
    assert kept is not None and kept.evaluate("(node) => node.isConnected")

    page.evaluate(SET, {"h": 7.0})
    expect(liquid).to_have_attribute("height", "200")


def test_a_screen_reader_hears_the_values_once_they_rest(page: Page):
    show(page, TANK, {"h": 0.5, "T": 0.0, "phi": 0.0, "F": 1.0})
    picture = page.get_by_role("img", name="A tank: h 0.50 m")
    expect(picture).to_be_visible()
    status = page.locator("plant-schematic [role=status]")
    page.wait_for_timeout(1700)
    expect(status).to_have_text("")
    page.evaluate(SET, {"h": 1.25})
    expect(status).to_have_text("")
    expect(status).to_have_text("A tank: h 1.25 m", timeout=4000)
    expect(page.get_by_role("img", name="A tank: h 1.25 m")).to_be_visible()


def test_flow_runs_stops_and_stands_still(page: Page):
    show(page, TANK, {"h": 0.5, "T": 0.0, "phi": 0.0, "F": 1.0})
    assert page.evaluate(RUNNING) == 1
    page.evaluate(SET, {"F": 0.0})
    assert page.evaluate(RUNNING) == 0
    page.evaluate(SET, {"F": 2.0})
    assert page.evaluate(RUNNING) == 1
    page.evaluate("() => { document.querySelector('plant-schematic').still = true; }")
    assert page.evaluate(RUNNING) == 0


def test_dashes_run_the_way_of_the_flow(page: Page):
    two_ways = {
        "view": [480, 320],
        "shapes": [TANK["shapes"][2] | {"flow": {"signal": "F", "from": [-2, 2], "to": [-1, 1]}}],
    }
    show(page, two_ways, {"F": 1.0})
    rate = """() => document.querySelector("plant-schematic").getAnimations({ subtree: true })[0].playbackRate"""
    forwards = page.evaluate(rate)
    page.evaluate(SET, {"F": -1.0})
    assert forwards > 0 and page.evaluate(rate) == -forwards
    assert page.evaluate(RUNNING) == 1


def test_nothing_runs_for_those_who_ask_for_less_motion(page: Page):
    page.emulate_media(reduced_motion="reduce")
    show(page, TANK, {"h": 0.5, "T": 0.0, "phi": 0.0, "F": 1.0})
    page.wait_for_timeout(300)
    assert page.evaluate(RUNNING) == 0
    page.emulate_media(reduced_motion="no-preference")
    page.wait_for_timeout(300)
    assert page.evaluate(RUNNING) == 1


def test_what_is_wrong_is_told_and_the_rest_is_drawn(page: Page):
    broken = {
        "view": [480, 320],
        "shapes": [
            {"kind": "teapot", "x": 0, "y": 0},
            {"kind": "tank", "x": 0, "y": 0, "width": -3, "height": 20},
            {"kind": "tank", "x": 0, "y": 0, "width": 30, "height": 20, "level": {"signal": "h", "from": [1, 1]}},
            {"kind": "disc", "x": 0, "y": 0, "r": 5, "fill": "url(#x)"},
            {"kind": "group", "x": 0, "y": 0, "shapes": [{"kind": "pipe", "points": [[0, 0]]}]},
            {"kind": "text", "text": "t", "x": 0, "y": 0, "repeat": {"count": 2, "index": "(", "step": [0, 0]}},
            None,
            {"kind": "readout", "signal": "nowhere", "x": 20, "y": 20},
            {"kind": "readout", "signal": "h", "x": 20, "y": 60},
        ],
    }
    problems = show(page, broken, {"h": 1.0, "infinite": 2.0})
    assert [problem["path"] for problem in problems] == [
        "shapes[0].kind",
        "shapes[1].width",
        "shapes[2].level.from",
        "shapes[3].fill",
        "shapes[4].shapes[0].points",
        "shapes[5].repeat",
        "shapes[6].kind",
        "shapes[7].signal",
    ]
    expect(page.locator(".readout-value")).to_have_text(["—", "1.00"])
    page.evaluate("() => { document.querySelector('plant-schematic').values = { h: Infinity }; }")
    expect(page.locator(".readout-value").last).to_have_text("—")


def test_the_browser_draws_the_kinds_of_the_schema(page: Page):
    kinds = Schematic.model_json_schema(by_alias=True)["$defs"]
    known = {shape["properties"]["kind"]["const"] for shape in kinds.values() if "kind" in shape.get("properties", {})}
    page.goto("/labs")
    drawn = page.evaluate("async () => (await import('/static/components/plant-schematic.js')).PlantSchematic.kinds")
    assert len(drawn) == len(known)
    assert set(drawn) == known


def test_the_browser_knows_the_colours_of_the_schema(page: Page):
    scales = get_args(ColourBinding.model_fields["scale"].annotation)
    fills = [*get_args(ColourName), *({"signal": "T", "scale": scale} for scale in scales)]
    discs = [{"kind": "disc", "x": 20, "y": 20, "r": 5, "fill": fill} for fill in fills]
    assert show(page, {"view": [480, 320], "shapes": discs}, {"T": 0.3}) == []
    # a colour whose token is missing would leave the disc as it is: black, or not filled
    painted = page.locator(".shape-disc circle").evaluate_all("(all) => all.map((c) => getComputedStyle(c).fill)")
    assert [fill for fill, colour in zip(fills, painted, strict=True) if colour in ("none", "rgb(0, 0, 0)")] == ["none"]


MEASURE = """() => {
  const picture = document.querySelector("plant-schematic svg");
  const frame = picture.getBoundingClientRect();
  const parts = [...picture.querySelectorAll(".chip, text, .vessel, .arrow-head, .body, .pipe-wall")];
  const boxes = parts.map((part) => part.getBoundingClientRect()).filter((box) => box.width > 0);
  const ink = [Math.min(...boxes.map((b) => b.left)) - frame.left, frame.right - Math.max(...boxes.map((b) => b.right)),
    Math.min(...boxes.map((b) => b.top)) - frame.top, frame.bottom - Math.max(...boxes.map((b) => b.bottom))];
  const scale = frame.width / picture.viewBox.baseVal.width;
  const words = [...picture.querySelectorAll(".readout-text")];
  const text = words.map((node) => parseFloat(getComputedStyle(node).fontSize));
  return { width: frame.width, margin: Math.min(...ink), text: Math.min(...text) * scale };
}"""


@pytest.mark.parametrize("width", [320, 960])
def test_every_plant_is_drawn_whole(page: Page, width: int):
    """Nothing is amiss, nothing is cut off, and the text can be read."""
    page.goto("/labs")
    amiss = {}
    for path in DRAWINGS:
        drawing = json.loads(path.read_text(encoding="utf-8"))
        values = {name: 0.5 for _, name in Schematic.model_validate(drawing).signals()}
        problems = page.evaluate(SHOW, [drawing, values, {}, width])
        seen = page.evaluate(MEASURE)
        whole = seen["margin"] >= -1 and abs(seen["width"] - width) <= 1
        if problems or not whole or seen["text"] < 10.9:
            amiss[path.stem] = (problems, seen)
    assert amiss == {}
