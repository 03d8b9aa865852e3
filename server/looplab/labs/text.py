"""Text of a lab: Markdown with $math$ in, safe HTML with MathML out.

Three layers keep a hostile text harmless: raw HTML is off in Markdown, formulas know no command that makes a link
or runs a script, and a sanitiser with a short list of allowed tags has the last word.
"""

from collections.abc import Sequence
from functools import cache, lru_cache
from itertools import pairwise
from typing import Any
from urllib.parse import urlsplit

import math_core
import nh3
from markdown_it import MarkdownIt
from markdown_it.token import Token
from mdit_py_plugins.dollarmath import dollarmath_plugin

from looplab.engine.errors import InvalidInput

MAX_LATEX = 2000
WORD_JOINER = "\N{WORD JOINER}"
_CLOSING = tuple(".,;:!?)")
MAX_DEPTH = 40
"""Braces inside braces in a formula."""

_TEXT_TAGS = {
    *("p", "br", "hr", "em", "strong", "s", "code", "pre", "blockquote", "ul", "ol", "li", "a", "span", "div"),
    *("h3", "h4", "h5", "h6", "table", "thead", "tbody", "tr", "th", "td"),
}
_MATH_TAGS = {
    *("math", "mrow", "mi", "mo", "mn", "mtext", "mspace", "mfrac", "msqrt", "mroot", "mstyle", "mpadded"),
    *("msub", "msup", "msubsup", "munder", "mover", "munderover", "mmultiscripts", "mprescripts", "mphantom"),
    *("mtable", "mtr", "mtd", "menclose", "merror"),
}
_MATH_ATTRIBUTES = {
    *("display", "displaystyle", "scriptlevel", "mathvariant", "stretchy", "symmetric", "fence", "separator"),
    *("lspace", "rspace", "largeop", "movablelimits", "form", "minsize", "maxsize", "accent", "accentunder"),
    *("linethickness", "width", "height", "depth", "voffset", "columnspan", "rowspan", "style"),
}
_ATTRIBUTES = dict.fromkeys(_MATH_TAGS, _MATH_ATTRIBUTES)
_ATTRIBUTES |= {"a": {"href"}, "th": {"style"}, "td": {"style"}, "ol": {"start"}}
_STYLES = {
    *("text-align", "justify-items", "color", "vertical-align", "width", "height"),
    *("padding", "padding-left", "padding-right", "padding-top", "padding-bottom"),
    *("border", "border-left", "border-right", "border-top", "border-bottom"),
}
_LINKS = {"http", "https", "mailto"}
_CLEANER = nh3.Cleaner(
    tags=_TEXT_TAGS | _MATH_TAGS,
    clean_content_tags={"script", "style"},
    attributes=_ATTRIBUTES,
    allowed_classes={"div": {"math", "table"}, "span": {"math"}},
    filter_style_properties=_STYLES,
    url_schemes=_LINKS,
    url_relative="deny",
    link_rel="noopener noreferrer",
)


@lru_cache(maxsize=4096)
def render_math(latex: str, display: bool = False) -> str:
    """One formula as MathML.

    Parameters
    ----------
    latex : str
        The formula without its dollar signs, at most ``MAX_LATEX`` characters.
    display : bool
        On a line of its own (large operators, limits above and below).

    Raises
    ------
    InvalidInput
        It is not a formula of the supported LaTeX, too long or too deep.
    """
    if len(latex) > MAX_LATEX or _depth(latex) > MAX_DEPTH:
        raise InvalidInput(
            "A formula is too long or too deep.",
            field="latex",
            hint=f"At most {MAX_LATEX} characters and {MAX_DEPTH} braces inside each other.",
        )
    # A converter of its own for each formula: \newcommand in one must not leak into the next.
    converter = math_core.LatexToMathML(fancy_error=False)
    try:
        mathml = converter.convert_with_local_state(latex, displaystyle=display)
    except math_core.LatexError as error:
        raise InvalidInput(
            f"The formula {_shortened(latex)} cannot be typeset: {_reason(error)}",
            field="latex",
            hint="Use the LaTeX of amsmath; \\href, \\url and packages are not available.",
        ) from error
    return _CLEANER.clean(mathml)


def render_text(markdown: str) -> str:
    """A text as HTML; a formula that cannot be typeset is shown as it was written."""
    return _CLEANER.clean(_parser().render(markdown, {}))


def render_line(markdown: str) -> str:
    """A text that stands inside a line (a list item, a label), without its paragraph."""
    return _CLEANER.clean(_parser().renderInline(markdown, {}))


def plain(text: str) -> str:
    """Words that are not Markdown, safe between tags."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def text_problems(markdown: str) -> list[str]:
    """What an author should repair: formulas that cannot be typeset, links that lead nowhere, raw HTML."""
    problems: list[str] = []
    parsed = _parser().parse(markdown, {})
    for opening, inline in pairwise(parsed):
        if opening.type == "th_open" and not any(
            token.type == "text" and token.content for token in inline.children or []
        ):
            problems.append("The head of a table's column needs words: gain $K_c$, not $K_c$ alone.")
    for token in _all_tokens(parsed):
        if token.type in ("math_inline", "math_inline_double", "math_block"):
            try:
                render_math(token.content.strip())
            except InvalidInput as error:
                problems.append(error.message)
        elif token.type == "text":
            if "](" in token.content:
                problems.append("A link is not one: it must be [words](https://...), http or mailto.")
            if "$$" in token.content:
                problems.append("A $$ stands alone: display math starts and ends with $$.")
            if "</" in token.content:
                problems.append("HTML is shown as text: use Markdown.")
    return problems


@cache
def _parser() -> MarkdownIt:
    parser = MarkdownIt("commonmark", {"html": False, "xhtmlOut": False}).enable("table").disable("image")
    # "from $3 to $4" is money: a formula has no blank inside its dollars and no digit beside them.
    parser.use(dollarmath_plugin, allow_space=False, allow_digits=False, double_inline=True)
    parser.validateLink = _link_is_allowed  # type: ignore[method-assign]
    for name, rule in {
        "math_inline": _formula,
        "math_inline_double": _formula,
        "math_block": _formula,
        "heading_open": _heading,
        "heading_close": _heading,
        "table_open": _scrolling_table,
        "table_close": _scrolling_table,
    }.items():
        parser.add_render_rule(name, rule)
    return parser


def _formula(renderer: Any, tokens: Sequence[Token], index: int, options: Any, env: Any) -> str:
    token = tokens[index]
    try:
        mathml = render_math(token.content.strip(), token.type != "math_inline")
    except InvalidInput:
        # The student sees the source rather than nothing; `looplab labs check` has told the author.
        mathml = f"<code>{plain(token.content)}</code>"
    if token.type == "math_block":
        return f'<div class="math">{mathml}</div>\n'
    if token.type == "math_inline_double":
        return f'<span class="math">{mathml}</span>'
    following = tokens[index + 1].content if index + 1 < len(tokens) else ""
    # A line may break after a formula, but its full stop must not start the next one.
    return mathml + WORD_JOINER if following[:1] in _CLOSING else mathml


def _heading(renderer: Any, tokens: Sequence[Token], index: int, options: Any, env: Any) -> str:
    # The page owns h1 (the lab) and h2 (its parts): the highest heading of a text is h3, whatever it was written as.
    highest = min(int(token.tag[1]) for token in tokens if token.type == "heading_open")
    token = tokens[index]
    level = int(token.tag[1]) - highest + 3
    return f"<h{min(level, 6)}>" if token.nesting == 1 else f"</h{min(level, 6)}>\n"


def _scrolling_table(renderer: Any, tokens: Sequence[Token], index: int, options: Any, env: Any) -> str:
    # A wide table scrolls by itself: on a phone the page must not.
    html = str(renderer.renderToken(tokens, index, options, env))
    return f'<div class="table">{html}' if tokens[index].nesting == 1 else f"{html}</div>"


def _link_is_allowed(url: str) -> bool:
    try:
        return urlsplit(url.strip()).scheme.lower() in _LINKS
    except ValueError:
        return False


def _all_tokens(tokens: Sequence[Token]) -> list[Token]:
    return [inner for token in tokens for inner in (token, *(token.children or []))]


def _depth(latex: str) -> int:
    depth = deepest = 0
    for character in latex:
        depth += (character == "{") - (character == "}")
        deepest = max(deepest, depth)
    return deepest


def _reason(error: Exception) -> str:
    text = " ".join(str(error).split())
    return text if text.endswith(".") else f"{text}."


def _shortened(latex: str) -> str:
    text = " ".join(latex.split())
    return f"${text}$" if len(text) <= 80 else f"${text[:77]}...$"
