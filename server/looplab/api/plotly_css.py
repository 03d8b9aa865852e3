"""The style sheet of plotly.js, read out of its own minified source.

Plotly adds its rules through a `<style>` element, which a Content-Security-Policy without 'unsafe-inline'
forbids; it leaves that out where the page links the same rules itself. No package carries them as a file, so
they are read where they stand: an object literal `{selector: declarations}` that a loop writes into the page,
with X and Y in the selectors standing for Plotly's own classes.
"""

import re

# for(s in rules)full=s.replace(/^,/," ,").replace(/X/g,".js-plotly-plot .plotly").replace(/Y/g,...),add(...)
_LOOP = re.compile(
    r"""for\((?:var |let |const )?(?P<key>[\w$]+) in (?P<rules>[\w$]+)\)"""
    r"""[^;]{0,80}?\.replace\(/\^,/,(?:" ,"|' ,')\)"""
    r"""(?P<scopes>(?:\.replace\(/[A-Z]/g,(?:"[^"]*"|'[^']*')\))+)"""
)
_SCOPE = re.compile(r"""\.replace\(/([A-Z])/g,["']([^"']*)["']\)""")
_STRING = r""""(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|`(?:[^`\\$]|\\.)*`"""
_ENTRY = re.compile(
    rf"""\s*(?P<selector>{_STRING}|[A-Za-z_$][\w$]*)\s*:\s*(?P<declarations>{_STRING})\s*(?P<end>[,}}])"""
)
_ESCAPE = re.compile(r"\\(?:u\{([0-9a-fA-F]+)\}|u([0-9a-fA-F]{4})|x([0-9a-fA-F]{2})|(\r\n|.))", re.DOTALL)
_NAMED = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f", "v": "\v", "0": "\0", "\n": "", "\r\n": ""}


def plotly_style_sheet(source: str) -> str:
    """CSS equal to what this plotly.js would inject.

    Raises
    ------
    ValueError
        The source has no such rules: a plotly.js that looplab does not know.
    """
    loop = _LOOP.search(source)
    if loop is None:
        raise ValueError(_unknown("the loop that adds its style rules"))
    rules = _literal(source, loop["rules"], loop.start())
    scopes = _SCOPE.findall(loop["scopes"])
    lines = []
    for selector, declarations in rules:
        for letter, scope in scopes:
            selector = selector.replace(letter, scope)
        lines.append(f"{selector}{{{declarations}}}")
    # Plotly inserts every rule before the ones already there: of two equally specific ones the first wins.
    return "\n".join(reversed(lines)) + "\n"


def _literal(source: str, name: str, before: int) -> list[tuple[str, str]]:
    """The entries of the last `name={...}` that stands before the loop."""
    start = max(source.rfind(f"{name}={{", 0, before), source.rfind(f"{name} = {{", 0, before))
    if start < 0:
        raise ValueError(_unknown("the table of its style rules"))
    position = source.index("{", start) + 1
    entries: list[tuple[str, str]] = []
    while entry := _ENTRY.match(source, position):
        entries.append((_text(entry["selector"]), _text(entry["declarations"])))
        position = entry.end()
        if entry["end"] == "}":
            return entries
    raise ValueError(_unknown(f"a style rule after the {len(entries)}th"))


def _text(literal: str) -> str:
    """The value of a JavaScript string literal; a bare property name stands for itself."""
    if literal[0] not in "\"'`":
        return literal

    def character(escape: re.Match[str]) -> str:
        code = escape[1] or escape[2] or escape[3]
        return chr(int(code, 16)) if code else _NAMED.get(escape[4], escape[4])

    return _ESCAPE.sub(character, literal[1:-1])


def _unknown(what: str) -> str:
    return f"cannot read {what} in the installed plotly.js; install the versions of requirements.lock"
