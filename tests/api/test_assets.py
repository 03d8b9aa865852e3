"""Plotly, its style sheet and the math font come out of the installed packages, each under its hash."""

import gzip
import hashlib
import re

import pytest
from starlette.applications import Starlette
from starlette.testclient import TestClient

from looplab.api import assets
from looplab.api.plotly_css import plotly_style_sheet

PAGE = '<link href="{{plotly_css}}"><link href="{{math_font}}"><script src="{{plotly_js}}"></script>'


@pytest.fixture(scope="module")
def client():
    return TestClient(Starlette(routes=assets.vendor_routes()))


def addresses():
    return re.findall(r'(?:href|src)="([^"]*)"', assets.fill_page(PAGE))


def test_a_page_gets_addresses_that_are_served(client):
    css, font_css, script = addresses()
    assert client.get(css).headers["content-type"] == "text/css; charset=utf-8"
    assert client.get(font_css).headers["content-type"] == "text/css; charset=utf-8"
    assert client.get(script).headers["content-type"] == "text/javascript; charset=utf-8"


def test_an_address_carries_the_hash_of_the_content(client):
    for address in addresses():
        body = client.get(address).content
        assert hashlib.sha256(body).hexdigest()[:16] in address


def test_a_page_keeps_what_is_not_a_placeholder():
    assert assets.fill_page("<p>{{name}} $x^{2}$</p>") == "<p>{{name}} $x^{2}$</p>"


@pytest.mark.parametrize("accepted", ["gzip", "br, gzip;q=0.5"])
def test_a_browser_gets_it_compressed_and_keeps_it(client, accepted):
    script = addresses()[2]
    with client.stream("GET", script, headers={"Accept-Encoding": accepted}) as answer:
        raw = b"".join(answer.iter_raw())
        assert answer.headers["content-encoding"] == "gzip"
        assert answer.headers["vary"] == "Accept-Encoding"
        assert "immutable" in answer.headers["cache-control"]
    assert gzip.decompress(raw) == assets.plotly_js_path().read_bytes()
    assert len(raw) < 0.4 * len(gzip.decompress(raw))


def test_a_client_without_gzip_gets_it_plain(client):
    answer = client.get(addresses()[0], headers={"Accept-Encoding": "identity"})
    assert "content-encoding" not in answer.headers
    assert ".js-plotly-plot .plotly .main-svg{" in answer.text


def test_the_small_bundle_of_npm_is_preferred(tmp_path, monkeypatch):
    small = tmp_path / "plotly.js-cartesian-dist-min" / "plotly-cartesian.min.js"
    small.parent.mkdir()
    small.write_text("// small")
    monkeypatch.setattr(assets, "node_modules_dir", lambda: tmp_path)
    assert assets.plotly_js_path() == small
    monkeypatch.setattr(assets, "node_modules_dir", lambda: None)
    assert assets.plotly_js_path().name == "plotly.min.js"


def test_the_font_asks_the_system_first_and_then_the_server(client):
    sheet = client.get(addresses()[1]).text
    sources = re.search(r"src: (.*?);", sheet)[1]
    assert sources.index('local("Cambria Math")') < sources.index("url(")
    font = client.get(re.search(r'url\("([^"]*)"\)', sources)[1])
    assert font.headers["content-type"] == "font/ttf"
    assert b"MATH" in font.content[:600], "the table directory of a math font names the MATH table"


def test_without_a_font_package_the_system_serves(monkeypatch):
    def missing(name):
        raise FileNotFoundError(name)

    monkeypatch.setattr(assets, "_package_dir", missing)
    assert assets.math_font_path() is None
    assert "url(" not in assets.math_style_sheet(None)


def test_the_rules_of_the_installed_plotly_are_all_read():
    source = assets.plotly_js_path().read_text(encoding="utf-8")
    sheet = plotly_style_sheet(source)
    rules = sheet.splitlines()
    assert len(rules) > 40
    assert all(re.fullmatch(r"[^{}]+\{[^{}]+\}", rule) for rule in rules)
    assert all(rule.startswith((".js-plotly-plot .plotly", ".plotly-notifier")) for rule in rules)
    assert ".js-plotly-plot .plotly .main-svg{position:absolute;top:0;left:0;pointer-events:none;}" in rules


def test_rules_are_read_however_the_literal_is_quoted():
    source = (
        """var r={"X,X div":'font:"Open Sans";',"X [title]:after":`content:"\\u00b7";`,Y:"top:0;"};"""
        """for(let k in r)q=k.replace(/^,/," ,").replace(/X/g,".a .b").replace(/Y/g,".c"),add(q,r[k]);"""
    )
    assert plotly_style_sheet(source).splitlines() == [
        ".c{top:0;}",
        '.a .b [title]:after{content:"·";}',
        '.a .b,.a .b div{font:"Open Sans";}',
    ]


@pytest.mark.parametrize(
    "source",
    [
        "nothing here",
        'for(k in r)q=k.replace(/^,/," ,").replace(/X/g,".a"),f(q,r[k])',
        'r={"X":some()};for(k in r)q=k.replace(/^,/," ,").replace(/X/g,".a"),f(q,r[k])',
    ],
)
def test_an_unknown_plotly_is_said_not_guessed(source):
    with pytest.raises(ValueError, match=r"requirements\.lock"):
        plotly_style_sheet(source)
