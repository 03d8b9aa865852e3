"""The JavaScript of the pages as text: code without comments and strings, and the imports it makes."""

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path, PurePosixPath

import pytest

_TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)|(?P<string>"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'|`(?:[^`\\]|\\.)*`)""",
    re.DOTALL,
)
_IMPORT = re.compile(r"""(?:^|[\s}])(?:from|import)\s*\(?\s*["']([^"'\n]+)["']""")


@dataclass(frozen=True)
class Script:
    """A module of web/, e.g. `plots/bode.js` in the room `plots`."""

    path: PurePosixPath
    text: str

    @property
    def room(self) -> str:
        return self.path.parts[0] if len(self.path.parts) > 1 else ""

    @cached_property
    def code(self) -> str:
        """The text with comments gone and strings emptied: what names it really uses."""
        return _TOKEN.sub(lambda token: "''" if token["string"] else " ", self.text)

    @cached_property
    def imports(self) -> list[PurePosixPath]:
        """Modules of web/ that it imports; a foreign one keeps its own spelling and is found in no room."""
        without_comments = _TOKEN.sub(lambda token: token["string"] or " ", self.text)
        return [self._resolve(name) for name in _IMPORT.findall(without_comments)]

    def _resolve(self, name: str) -> PurePosixPath:
        if name.startswith("/static/"):
            return PurePosixPath(name.removeprefix("/static/"))
        parts: list[str] = list(self.path.parent.parts) if name.startswith(".") else []
        for part in PurePosixPath(name).parts:
            if part == "..":
                parts.pop()
            elif part != ".":
                parts.append(part)
        return PurePosixPath(*parts)


@pytest.fixture(scope="session")
def web(repository: Path) -> Path:
    return repository / "web"


@pytest.fixture(scope="session")
def scripts(web: Path) -> list[Script]:
    return [
        Script(PurePosixPath(path.relative_to(web).as_posix()), path.read_text(encoding="utf-8"))
        for path in sorted(web.rglob("*.js"))
    ]
