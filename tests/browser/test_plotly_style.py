"""The style sheet served for Plotly is rule for rule what Plotly would have injected itself."""

import pytest
from playwright.sync_api import Browser

from looplab.api import assets
from looplab.api.plotly_css import plotly_style_sheet

RULES = "(sheet) => [...sheet.cssRules].map((rule) => rule.cssText)"


@pytest.mark.parametrize("bundle", ["served", "of the pip package"])
def test_the_sheet_is_what_plotly_injects(browser: Browser, bundle, monkeypatch):
    if bundle == "of the pip package":
        monkeypatch.setattr(assets, "node_modules_dir", lambda: None)
    script = assets.plotly_js_path().read_text(encoding="utf-8")
    page = browser.new_page()
    try:
        page.add_script_tag(content=script)
        injected = page.evaluate(f"({RULES})(document.getElementById('plotly.js-style-global').sheet)")
        page.evaluate(
            "(css) => { const style = document.createElement('style'); style.id = 'ours';"
            " style.textContent = css; document.head.append(style); }",
            plotly_style_sheet(script),
        )
        ours = page.evaluate(f"({RULES})(document.getElementById('ours').sheet)")
    finally:
        page.close()
    assert len(injected) > 40
    assert ours == injected
