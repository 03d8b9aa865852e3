"""What is wrong with a lab, said so that its author finds the place: the file, the JSON path, the remedy."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, ValidationError

from looplab.engine.errors import EngineError
from looplab.labs.schema import Lab
from looplab.labs.text import text_problems
from looplab.schemas import json_path


@dataclass(frozen=True)
class Problem:
    """One thing to repair; ``path`` is where in the JSON, such as ``parts[0].blocks[2].tolerance``."""

    path: str
    message: str

    def __str__(self) -> str:
        return f"{self.path}: {self.message}" if self.path else self.message


class LabError(EngineError):
    """A lab that cannot be used; ``problems`` has every reason, the message the first."""

    def __init__(self, name: str, problems: Sequence[Problem]) -> None:
        first, *others = problems
        more = f" (and {len(others)} more)" if others else ""
        super().__init__(
            f"{name}: {first}{more}",
            field=first.path or None,
            hint="Run `looplab labs check` on the file to see every problem.",
        )
        self.name = name
        self.problems = list(problems)


def schema_problems(data: Any, error: ValidationError) -> list[Problem]:
    """Pydantic's errors with paths that exist in the author's JSON."""
    return [Problem(json_path(data, item["loc"]), _sentence(item)) for item in error.errors(include_url=False)]


def texts(lab: Lab) -> Iterator[tuple[str, str]]:
    """Every Markdown text of a lab with its JSON path; a symbol counts as the formula it is."""
    for index, objective in enumerate(lab.objectives):
        yield f"objectives[{index}]", objective
    for path, model in _models(lab, ""):
        for name in _TEXTS & type(model).model_fields.keys():
            value = getattr(model, name)
            if isinstance(value, str):
                yield f"{path}.{name}", f"${value}$" if name == "symbol" else value
        for index, hint in enumerate(getattr(model, "hints", [])):
            yield f"{path}.hints[{index}]", hint


def content_problems(lab: Lab) -> list[Problem]:
    """What the schema alone cannot see: texts that cannot be shown, systems that the engine refuses."""
    problems = [Problem(path, message) for path, text in texts(lab) for message in text_problems(text)]
    for path, model in _models(lab, ""):
        if hasattr(model, "to_engine"):
            try:
                model.to_engine()
            except EngineError as error:
                problems.append(Problem(f"{path}.{error.field}" if error.field else path, error.message))
    return problems


_TEXTS = {"markdown", "prompt", "solution", "feedback", "text", "symbol"}


def _models(model: BaseModel, path: str) -> Iterator[tuple[str, BaseModel]]:
    """Every model inside a lab with its JSON path; tests hold answers, not content."""
    for name in type(model).model_fields:
        value = getattr(model, name)
        here = f"{path}.{name}" if path else name
        items = enumerate(value) if isinstance(value, list) and name != "tests" else []
        inner = [(here, value), *((f"{here}[{index}]", item) for index, item in items)]
        for where, item in inner:
            if isinstance(item, BaseModel):
                if not hasattr(item, "to_engine"):
                    yield from _models(item, where)
                yield where, item


def _sentence(item: Any) -> str:
    if item["type"] == "extra_forbidden":
        return "there is no such key; look at lab.schema.json for those that are"
    if item["type"] == "missing":
        return "this key is needed"
    if item["type"] == "value_error":
        return str(item["msg"]).removeprefix("Value error, ")
    message = str(item["msg"])
    return message[:1].lower() + message[1:]
