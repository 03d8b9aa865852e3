"""Markdown and formulas become safe HTML and MathML, whatever was written."""

from html.parser import HTMLParser
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from looplab.engine.errors import InvalidInput
from looplab.labs.loader import Library
from looplab.labs.problems import texts
from looplab.labs.text import render_line, render_math, render_text, text_problems

ALLOWED_SCHEMES = ("http:", "https:", "mailto:")


class Auditor(HTMLParser):
    """Reads HTML as a browser would and collects what could do harm."""

    def __init__(self) -> None:
        super().__init__()
        self.harm: list[str] = []
        self.tags: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        if tag in ("script", "style", "iframe", "object", "embed", "img", "svg", "form", "input", "base", "link"):
            self.harm.append(tag)
        for name, value in attrs:
            text = (value or "").strip().lower()
            if name.startswith("on") or name in ("src", "srcdoc", "xlink:href", "action", "formaction", "id"):
                self.harm.append(f"{tag} {name}")
            if name == "href" and not text.startswith(ALLOWED_SCHEMES):
                self.harm.append(f"{tag} href={value}")
            if name == "style" and ("url(" in text or "expression" in text or "position" in text):
                self.harm.append(f"{tag} style={value}")

    def handle_comment(self, data: str) -> None:
        self.harm.append("comment")


def audit(html: str) -> Auditor:
    auditor = Auditor()
    auditor.feed(html)
    auditor.close()
    return auditor


def test_markdown_and_math() -> None:
    html = render_text(
        "# Head\n\n*a* **b** `c` [d](https://example.org)\n\n- $x < 1$\n\n| a | b |\n|---|---|\n| 1 | $2$ |"
    )
    assert "<h3>Head</h3>" in html
    assert "<em>a</em> <strong>b</strong> <code>c</code>" in html
    assert '<a href="https://example.org" rel="noopener noreferrer">d</a>' in html
    assert "<math><mi>x</mi><mo>&lt;</mo><mn>1</mn></math>" in html
    assert '<div class="table"><table>' in html


def test_headings_start_below_those_of_the_page() -> None:
    assert render_text("### A\n\n#### B\n\n### C") == "<h3>A</h3>\n<h4>B</h4>\n<h3>C</h3>\n"
    assert render_text("A\n=\n\nB\n-") == "<h3>A</h3>\n<h4>B</h4>\n"


def test_a_full_stop_stays_with_its_formula() -> None:
    assert "</math>\N{WORD JOINER}." in render_text("It is $x$.")


def test_display_math_is_a_block() -> None:
    assert render_text("$$\n\\frac{1}{2}\n$$").startswith('<div class="math"><math display="block">')
    assert '<math display="block">' in render_text("inline $$x$$ too")
    assert render_math("x", display=True).startswith('<math display="block">')
    assert render_math("x").startswith("<math>")


def test_money_is_not_math() -> None:
    assert "<math" not in render_text("from $3 to $4")


def test_a_line_has_no_paragraph() -> None:
    assert render_line("the gain $K_c$") == "the gain <math><msub><mi>K</mi><mi>c</mi></msub></math>"


@pytest.mark.parametrize(
    "latex",
    [
        r"\begin{pmatrix} a & b \\ c & d \end{pmatrix}",
        r"\begin{cases} 0 & t < 0 \\ 1 & t \ge 0 \end{cases}",
        r"\begin{aligned} a &= b \\ c &= d \end{aligned}",
        r"\begin{array}{c|cc} s^2 & 1 & 2 \\ \hline s & 3 & 4 \end{array}",
        r"K_c\left(1 + \frac{1}{\tau_I s}\right)",
        r"\mathcal{L}\{f\} = \int_0^\infty f(t)\,\mathrm{e}^{-st}\,dt",
        r"\overline{y}_{\max}, \quad \hat y, \quad \angle 30^\circ, \quad \operatorname{Re} s",
    ],
)
def test_the_latex_of_the_subject(latex: str) -> None:
    html = render_math(latex, display=True)
    assert "merror" not in html
    assert audit(html).harm == []


@pytest.mark.parametrize(
    "latex",
    [
        r"\foo",
        r"\href{javascript:alert(1)}{x}",
        r"\url{https://example.org}",
        r"\frac{1}{",
        r"\newcommand{\a}{\a\a}\a",
        r"\def\a{\a}\a",
        r"\includegraphics{x}",
        r"\input{/etc/passwd}",
        "{" * 41 + "x" + "}" * 41,
        r"\sqrt{" * 500 + "x" + "}" * 500,
        "x" * 2001,
    ],
)
def test_a_formula_that_is_refused_says_why(latex: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        render_math(latex)
    assert caught.value.message
    assert caught.value.hint


def test_a_command_defined_in_one_formula_is_unknown_in_the_next() -> None:
    render_math(r"\newcommand{\gain}{K_c}\gain")
    with pytest.raises(InvalidInput):
        render_math(r"\gain")


HOSTILE = [
    "<script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "[a](javascript:alert(1))",
    "[a](JaVaScRiPt:alert(1))",
    "[a](java\tscript:alert(1))",
    "[a](&#106;avascript:alert(1))",
    "[a](data:text/html,<script>alert(1)</script>)",
    "[a](vbscript:x)",
    "[a](//evil.example/x)",
    "[a](/labs)",
    "[a]: javascript:alert(1)\n\n[a]",
    "<javascript:alert(1)>",
    "![a](https://evil.example/x.png)",
    "![a](javascript:alert(1))",
    "$\\href{javascript:alert(1)}{x}$",
    "$\\text{<img src=x onerror=alert(1)>}$",
    "$\\text{</mtext><script>alert(1)</script>}$",
    "$$\n</math><script>alert(1)</script>\n$$",
    "`<script>alert(1)</script>`",
    "```html\n<script>alert(1)</script>\n```",
    "<!-- x -->",
    "<div style='position:fixed;inset:0'>x</div>",
    "$\\color{red;position:fixed}x$",
    '[a](https://example.org "onmouseover=alert(1)")',
    "[a](https://example.org'onmouseover='alert(1))",
    "<math><mtext><style><img src onerror=alert(1)></style></mtext></math>",
    "> " * 500 + "x",
    "[" * 3000,
    "$" * 3000,
    "*a" * 2000,
    "\x00\x01\u202e\ufeff",
]


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_text_is_harmless(text: str) -> None:
    assert audit(render_text(text)).harm == []
    assert audit(render_line(text)).harm == []


@given(
    st.lists(
        st.one_of(
            st.sampled_from([*HOSTILE[:26], "$", "$$", "<", ">", "](", "\n", "\n\n", "`", "|", "\\", "{", "}", '"']),
            st.text(max_size=8),
        ),
        max_size=12,
    )
)
@settings(max_examples=150, deadline=None)
def test_any_text_is_harmless(pieces: list[str]) -> None:
    assert audit(render_text("".join(pieces))).harm == []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("$\\foo$", "\\foo"),
        ("$$\n\\frac{1}{\n$$", "cannot be typeset"),
        ("[here](/labs/other)", "link"),
        ("[here](javascript:x)", "link"),
        ("<b>bold</b>", "HTML"),
        ("$$ x", "$$"),
        ("| | $x$ |\n|---|---|\n| 1 | 2 |", "needs words"),
    ],
)
def test_an_author_is_told_what_to_repair(text: str, said: str) -> None:
    assert any(said in problem for problem in text_problems(text))


def test_a_good_text_has_no_problems() -> None:
    assert text_problems("From $3 to $4: $a < b$, [x](https://example.org), `a[i](j)` and `</b>`.") == []


def test_every_formula_of_every_lab_renders(repository: Path) -> None:
    labs = Library(repository / "labs").all()
    assert labs
    for lab in labs:
        for path, text in texts(lab):
            assert text_problems(text) == [], f"{lab.id}: {path}"
            assert audit(render_text(text)).harm == [], f"{lab.id}: {path}"
