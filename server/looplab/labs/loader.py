"""Finds and reads labs. A lab is looked up by its id among the files that are there; an id never makes a path."""

import os
import re
from pathlib import Path
from typing import Any

import orjson
from pydantic import ValidationError

from looplab.labs.problems import LabError, Problem, content_problems, schema_problems
from looplab.labs.render import render_lab
from looplab.labs.schema import Lab
from looplab.resources import labs_dir

MAX_BYTES = 256 * 1024
SCHEMA_FILE = "lab.schema.json"
_ID = re.compile(r"[a-z0-9][a-z0-9-]{0,63}")


def parse_lab(source: bytes | str, name: str = "lab") -> Lab:
    """A lab from its JSON text.

    Raises
    ------
    LabError
        The text is not JSON, or not a lab, or a text in it cannot be shown; every problem has its JSON path.
    """
    raw = source.encode("utf-8", "replace") if isinstance(source, str) else source
    if len(raw) > MAX_BYTES:
        raise LabError(name, [Problem("", f"it is larger than {MAX_BYTES // 1024} KiB")])
    try:
        data = orjson.loads(raw)
    except orjson.JSONDecodeError as error:
        message = f"not JSON: {error.msg} at line {error.lineno}, column {error.colno}"
        raise LabError(name, [Problem("", message)]) from error
    return validate_lab(data, name)


def validate_lab(data: Any, name: str = "lab") -> Lab:
    """A lab from JSON that is already read. Raises LabError like `parse_lab`."""
    if not isinstance(data, dict):
        raise LabError(name, [Problem("", "a lab is a JSON object: { ... }")])
    try:
        lab = Lab.model_validate(data)
    except ValidationError as error:
        raise LabError(name, schema_problems(data, error)) from error
    problems = content_problems(lab)
    if problems:
        raise LabError(name, problems)
    return lab


def read_lab(path: Path) -> Lab:
    """A lab from its file, whose name is its id."""
    try:
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise LabError(path.name, [Problem("", f"cannot be read: {error.strerror}")]) from error
    lab = parse_lab(raw, path.name)
    if lab.id != path.stem:
        message = f"{lab.id!r} is not the name of the file; call the file {lab.id}.json or the lab {path.stem!r}"
        raise LabError(path.name, [Problem("id", message)])
    return lab


def lab_files(folder: Path) -> dict[str, Path]:
    """The files of a folder that can be labs, by id, in alphabetical order."""
    return {
        path.stem: path
        for path in sorted(folder.glob("*.json"))
        if path.name != SCHEMA_FILE and _ID.fullmatch(path.stem)
    }


class Library:
    """The labs of one folder. A file that changes is read again, so an author sees the edit on reload."""

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder or default_folder()
        self._read: dict[str, tuple[tuple[int, int], Lab | LabError]] = {}
        self._rendered: dict[str, tuple[tuple[int, int], dict[str, Any]]] = {}

    def get(self, lab_id: str) -> Lab | None:
        """The lab of this id, or None. Raises LabError where its file is not a lab."""
        if not _ID.fullmatch(lab_id):
            return None
        path = lab_files(self.folder).get(lab_id)
        return None if path is None else self._load(path)

    def all(self) -> list[Lab]:
        """Every lab that can be used; one that cannot must not hide the others."""
        labs = []
        for path in lab_files(self.folder).values():
            try:
                labs.append(self._load(path))
            except LabError:
                continue
        return labs

    def rendered(self, lab_id: str) -> dict[str, Any]:
        """A lab that `get` has found, as its page shows it; rendered once per edit."""
        stamp, _ = self._read[lab_id]
        known = self._rendered.get(lab_id)
        if known is None or known[0] != stamp:
            lab = self.get(lab_id)
            assert lab is not None
            known = self._rendered[lab_id] = (self._read[lab_id][0], render_lab(lab))
        return known[1]

    def _load(self, path: Path) -> Lab:
        try:
            stat = path.stat()
        except OSError as error:
            raise LabError(path.name, [Problem("", f"cannot be read: {error.strerror}")]) from error
        stamp = (stat.st_mtime_ns, stat.st_size)
        known = self._read.get(path.stem)
        if known is None or known[0] != stamp:
            try:
                known = (stamp, read_lab(path))
            except LabError as error:
                known = (stamp, error)
            self._read[path.stem] = known
        if isinstance(known[1], LabError):
            raise known[1]
        return known[1]


def default_folder() -> Path:
    """LOOPLAB_LABS where it is set, else the labs that come with looplab."""
    own = os.environ.get("LOOPLAB_LABS")
    return Path(own) if own else labs_dir()
