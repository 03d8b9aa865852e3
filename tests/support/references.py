"""Reads tests/references/*.json: values computed without looplab, see tests/references/make/README.md."""

import json
from functools import cache
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parents[1] / "references"


@cache
def reference(name: str) -> dict[str, Any]:
    return json.loads((FOLDER / f"{name}.json").read_text())


def cases(name: str) -> list[Any]:
    """The cases of a file as pytest parameters, named."""
    import pytest

    return [pytest.param(case, id=case["name"]) for case in reference(name)["cases"]]
