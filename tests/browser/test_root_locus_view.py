"""The root locus of the workbench: gains of the other sign, what is constructed by hand, and a closer look."""

import re

import numpy as np
from playwright.sync_api import Page, expect

from access import violations
from workbench import open_workbench, settled

LOCUS = "document.querySelector('#panel-root_locus .plot')"


def trace(page: Page, name: str) -> np.ndarray:
    """The points of a trace as complex numbers, NaN in the gaps."""
    x, y = page.evaluate(
        f"(name) => {{ const t = {LOCUS}.data.find((t) => t.name === name); return [[...t.x], [...t.y]]; }}", name
    )
    return np.array(x, dtype=float) + 1j * np.array(y, dtype=float)


def ranges(page: Page) -> tuple[list[float], list[float]]:
    return tuple(page.evaluate(f"[{LOCUS}._fullLayout.xaxis.range, {LOCUS}._fullLayout.yaxis.range]"))


def zoom(page: Page, corner: complex, opposite: complex) -> None:
    """Drags a rectangle from one point of the s-plane to another."""
    frame = page.locator("#panel-root_locus .nsewdrag").bounding_box()
    assert frame is not None
    (x0, x1), (y0, y1) = ranges(page)

    def at(s: complex) -> tuple[float, float]:
        return (
            frame["x"] + frame["width"] * (s.real - x0) / (x1 - x0),
            frame["y"] + frame["height"] * (1 - (s.imag - y0) / (y1 - y0)),
        )

    page.mouse.move(*at(corner))
    page.mouse.down()
    page.mouse.move(*at(0.5 * (corner + opposite)))
    page.mouse.move(*at(opposite))
    page.mouse.up()


def test_zoomed_in_the_locus_has_no_corner_but_the_meeting_point(page: Page):
    """1/(s(s+1)(s+2)): two branches meet at -1 + 1/sqrt(3) at right angles."""
    meeting = -1 + 3**-0.5
    open_workbench(page, "plant=1/(s(s%2B1)(s%2B2))&type=P&Kc=0.5&show=root_locus")
    settled(page)
    whole = trace(page, "locus")
    for half in (0.15, 0.02):
        with page.expect_response(re.compile("/root-locus$")) as answered:
            zoom(page, meeting - half + half * 1j, meeting + half - half * 1j)
        assert answered.value.ok
        settled(page)
    (x0, x1), (y0, y1) = ranges(page)
    assert x1 - x0 < 0.06

    def seen(points: np.ndarray) -> np.ndarray:
        return (points.real > x0) & (points.real < x1) & (points.imag > y0) & (points.imag < y1)

    closer = trace(page, "locus")
    assert np.count_nonzero(seen(closer)) > 30
    assert np.count_nonzero(seen(whole)) < 10, "from afar there would be corners"
    z = (closer.real - x0) / (x1 - x0) + 1j * (closer.imag - y0) / (y1 - y0)
    step = np.diff(z)
    with np.errstate(invalid="ignore"):  # gaps
        turn = np.degrees(np.abs(np.angle(step[1:] / step[:-1])))
    inner = seen(closer[1:-1]) & np.isfinite(turn)
    corner = inner & (turn > 15)
    assert np.count_nonzero(corner) == 2, "each branch turns once"
    assert np.abs(closer[1:-1][corner] - meeting).max() < 1e-9
    assert np.allclose(turn[corner], 90, atol=2)

    # Back to the whole picture, the whole locus is drawn again.
    page.get_by_role("button", name="More for Root locus").click()
    page.get_by_role("menuitem", name=re.compile("Reset zoom")).click()
    settled(page)
    assert trace(page, "locus").size == whole.size


def test_gains_of_the_other_sign_on_request(page: Page):
    """1/(s+1)^3 with K < 0: along the real axis to the right, and away at +-120 deg; through 0 for K = -1."""
    open_workbench(page, "plant=1/(s%2B1)^3&type=P&Kc=2&show=root_locus")
    settled(page)
    toggle = page.get_by_role("button", name=re.compile("^K < 0"))
    assert np.isnan(trace(page, "locus for K < 0")).all()
    toggle.click()
    settled(page)
    expect(toggle).to_have_attribute("aria-pressed", "true")
    s = trace(page, "locus for K < 0")
    s = s[np.isfinite(s)]
    K = -((s + 1) ** 3)
    assert (np.abs(K.imag) < 1e-5 * np.maximum(np.abs(K), 1e-3)).all()
    assert (K.real < 1e-6).all()
    page.get_by_role("button", name="Numbers of Root locus as a table").click()
    table = page.get_by_role("region", name="Numbers of Root locus")
    expect(table.get_by_role("row", name=re.compile("^axis crossing, K < 0 0 0 −1.0000"))).to_be_visible()
    expect(
        table.get_by_role("row", name=re.compile("^asymptote from the centroid, K < 0 −1.0000 0 — 120"))
    ).to_be_visible()
    expect(table.get_by_role("row", name=re.compile("^axis crossing 0 1.7321 8.0000"))).to_be_visible()
    assert violations(page) == []


def test_the_table_tells_what_is_constructed_by_hand(page: Page):
    """(s^2+2s+5) in the denominator of 1/(s(s+2)(...)): complex break-aways at -1 +- 1.58i, asymptotes from -1."""
    open_workbench(page, "plant=1/(s(s%2B2)(s^2%2B2s%2B5))&type=P&Kc=1&show=root_locus")
    settled(page)
    page.get_by_role("button", name="Numbers of Root locus as a table").click()
    table = page.get_by_role("region", name="Numbers of Root locus")
    # K = -s(s+2)(s^2+2s+5) with u = s^2 + 2s: K = -u(u+5), greatest at u = -2.5: 6.25, where s = -1 +- i sqrt(1.5).
    expect(table.get_by_role("row", name=re.compile("^breakaway −1.0000 1.2247 6.2500"))).to_be_visible()
    expect(table.get_by_role("row", name=re.compile("^breakaway −1.0000 0 4.0000"))).to_be_visible()
    expect(table.get_by_role("row", name=re.compile("^departure from pole −1.0000 2.0000 0 −90"))).to_be_visible()
    expect(table.get_by_role("row", name=re.compile("^asymptote from the centroid −1.0000 0 — 45"))).to_be_visible()
