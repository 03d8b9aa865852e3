"""What may be named where: Plotly in one module, the document neither in core nor in the pure plots."""

import re

import pytest

# Namespaces are names, not addresses that a browser would ask.
NAMES = ("http://www.w3.org/",)
FIGURE = "plots/figure.js"


def test_only_the_figure_names_plotly(scripts):
    naming = {str(script.path) for script in scripts if re.search(r"\bPlotly\b", script.code)}
    assert naming == {FIGURE}


@pytest.mark.parametrize("room", ["core", "plots"])
def test_no_document_where_data_is_turned_into_data(scripts, room):
    touching = [
        f"{script.path}: {found[0]}"
        for script in scripts
        if script.room == room and str(script.path) != FIGURE
        for found in re.finditer(r"(?<![.\w])(?:document|customElements|HTML\w*Element|SVG\w*Element)\b", script.code)
    ]
    assert touching == []


@pytest.mark.parametrize("suffix", ["js", "css", "html", "svg"])
def test_no_page_asks_another_host(web, suffix):
    asked = [
        f"{path.relative_to(web)}: {address}"
        for path in web.rglob(f"*.{suffix}")
        for address in re.findall(r"""(?:https?:)?//[\w.-]+\.[a-z]{2,}[^\s"'`)<]*""", path.read_text(encoding="utf-8"))
        if not address.startswith(NAMES)
    ]
    assert asked == []


def test_nothing_is_left_for_a_debugger(scripts):
    left = [str(script.path) for script in scripts if re.search(r"\bdebugger\b|\bconsole\.log\b", script.code)]
    assert left == []


@pytest.mark.parametrize("sink", [r"\beval\s*\(", r"\bnew Function\b", r"\bdocument\.write", r"\bouterHTML\s*="])
def test_no_text_becomes_code(scripts, sink):
    assert [str(script.path) for script in scripts if re.search(sink, script.code)] == []
