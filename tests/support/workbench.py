"""The workbench as its tests use it: open it, find its parts, wait until it has drawn."""

from playwright.sync_api import Locator, Page, expect

# Drawings are counted from the first script on, so that none is missed.
COUNT_DRAWINGS = """
window.drawings = [];
addEventListener("figure-drawn", (event) => window.drawings.push({
  panel: event.target.closest(".panel").id, at: performance.now(), ...event.detail,
}));
"""


def open_workbench(page: Page, query: str = "") -> None:
    page.add_init_script(COUNT_DRAWINGS)
    page.goto("/workbench" + (f"?{query}" if query else ""))
    expect(verdict(page)).to_be_visible()
    expect(page.locator(".panel .js-line").first).to_be_attached()


def verdict(page: Page) -> Locator:
    return page.locator(".verdict[data-verdict]")


def slider(page: Page, name: str) -> Locator:
    return page.get_by_role("slider", name=name)


def field(page: Page, name: str) -> Locator:
    return page.locator(f"gain-slider[name={name}] input[type=text]")


def chip(page: Page, name: str) -> Locator:
    return page.locator(f".chip-{name} .chip-value")


def settled(page: Page) -> None:
    """Waits until every plot has been drawn by Plotly after the last change and nothing more comes."""
    before = -1
    while (now := page.evaluate("window.drawings.length")) != before:
        before = now
        page.wait_for_timeout(400)


def open_analyses(page: Page, *names: str, query: str = "") -> None:
    """Opens the workbench with these analyses alone, and waits until each has its answer."""
    page.add_init_script(COUNT_DRAWINGS)
    page.goto(f"/workbench?show={','.join(names)}" + (f"&{query}" if query else ""))
    for name in names:
        expect(page.locator(f"#panel-{name} .analysis-content")).to_be_visible(timeout=20_000)
    expect(verdict(page)).to_be_visible()


def curve(page: Page, panel: str, name: str) -> tuple[list[float], list[float]]:
    """x and y of a trace as Plotly was given them."""
    plot = page.locator(f"#panel-{panel} .plot")
    expect(plot.locator(".scatterlayer").first).to_be_attached()
    x, y = plot.evaluate(
        "(plot, name) => { const { x, y } = plot.data.find((trace) => trace.name === name);"
        " return [Array.from(x), Array.from(y)]; }",
        name,
    )
    return x, y
