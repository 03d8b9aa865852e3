"""What axe finds wrong with a page, in the light theme and in the dark one."""

from typing import Any

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

# Of all rules only these look at colours.
OF_COLOUR = ["color-contrast", "link-in-text-block"]


def violations(page: Page, rules: list[str] | None = None, *, without: list[str] | None = None) -> list[str]:
    """What axe finds wrong with the page as it is now, by all its rules or by some."""
    options: dict[str, Any] = {"runOnly": {"type": "rule", "values": rules}} if rules else {}
    options["rules"] = {rule: {"enabled": False} for rule in without or []}
    found = Axe().run(page, options=options).response["violations"]
    return [f"{v['id']}: {v['help']} at {[node['html'][:120] for node in v['nodes']]}" for v in found]


def barriers(page: Page, *, colours: bool = True) -> list[str]:
    """What axe finds in the light theme, and what the dark one changes about that: its colours.

    To look at colours takes most of the time: a page that is looked at in two widths shows them in one.
    """
    if not colours:
        return violations(page, without=OF_COLOUR)
    found = []
    for scheme, rules in (("light", None), ("dark", OF_COLOUR)):
        page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
        expect(page.locator("html")).to_have_attribute("data-theme", scheme)
        # Colours fade from one theme to the other, and plots are drawn anew.
        page.wait_for_timeout(600)
        found += [f"{scheme}: {each}" for each in violations(page, rules)]
    return found
