"""The HTML pages keep to their policy and say what a reader, or a screen reader, needs."""

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import get_args
from urllib.error import HTTPError

import pytest

from looplab.labs.schema.bench import Panel
from serving import read

REPOSITORY = Path(__file__).resolve().parents[2]
PAGES = sorted((REPOSITORY / "web").glob("*.html"))


class Page(HTMLParser):
    """The start tags of a page, and the text of its title."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.title = ""
        self._in_title = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._in_title = tag == "title"

    def handle_endtag(self, tag: str) -> None:
        self._in_title = False

    def handle_data(self, data: str) -> None:
        if self._in_title:
            self.title += data

    def all(self, name: str) -> list[dict[str, str | None]]:
        return [attributes for tag, attributes in self.tags if tag == name]


@pytest.fixture(params=PAGES, ids=lambda path: path.name)
def html(request):
    return Page(request.param.read_text(encoding="utf-8"))


def test_there_are_pages():
    assert {path.name for path in PAGES} >= {"index.html", "workbench.html", "lab.html"}


def test_a_page_names_itself_and_its_language(html):
    assert html.title.strip()
    assert html.all("html")[0].get("lang") == "en"
    assert any(meta.get("name") == "viewport" for meta in html.all("meta"))
    assert len(html.all("main")) == 1


def test_nothing_inline_that_the_policy_forbids(html):
    assert all(script.get("src") for script in html.all("script")), "a script without src"
    assert html.all("style") == [], "a style element"
    handlers = [name for _, attributes in html.tags for name in attributes if name.startswith("on")]
    assert handlers == []


def test_what_a_page_loads_is_a_file_or_a_placeholder(html):
    for reference in [script.get("src") for script in html.all("script")] + [
        link.get("href") for link in html.all("link")
    ]:
        assert reference is not None
        if reference.startswith("/static/"):
            assert (REPOSITORY / "web" / reference.removeprefix("/static/")).is_file(), reference
        else:
            assert reference in ("{{plotly_js}}", "{{plotly_css}}", "{{math_font}}") or reference.startswith("data:"), (
                reference
            )


def test_a_page_with_plotly_links_its_style_as_plotly_looks_for_it(html):
    if any(script.get("src") == "{{plotly_js}}" for script in html.all("script")):
        link = next(link for link in html.all("link") if link.get("href") == "{{plotly_css}}")
        assert link.get("id") == "plotly.js-style-global"
        assert "no-inline-styles" in (link.get("class") or "").split()


def test_links_of_a_page_are_answered(html, server_url):
    targets = {link.get("href") or "" for link in html.all("a")}
    broken = []
    for target in sorted(target.split("#")[0] for target in targets if target.startswith("/")):
        try:
            read(server_url + target)
        except HTTPError as error:
            error.close()
            broken.append(f"{target}: {error.code}")
    assert broken == []


def test_a_lab_shows_every_panel_that_its_schema_knows():
    page = (REPOSITORY / "web/pages/lab.js").read_text(encoding="utf-8")
    (mounts,) = re.findall(r"^const MOUNTS = \{\n(.*?)^\};", page, re.MULTILINE | re.DOTALL)
    assert re.findall(r"^  (\w+):", mounts, re.MULTILINE) == list(get_args(Panel))
