"""A model as its author writes it: a plain dict (one JSON document), read into frozen dataclasses."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.fields import Fields
from looplab.engine.nonlinear.language import RESERVED, Limits

TIME_UNITS = ("s", "min", "h", "d")
ACTIONS = ("stop", "report")
MAX_ID = 64
MAX_OPERATING_POINTS = 20
MAX_EVENTS = 10
_ID = re.compile(r"[a-z0-9][a-z0-9-]*", re.ASCII)


@dataclass(frozen=True)
class Setting:
    """A parameter or an input: a number that can be set.

    Attributes
    ----------
    name : str
    value : float
        Nominal [unit].
    unit, meaning, latex, source : str
        Text for the reader; empty where not given.
    min, max : float or None
        Range it may be set in [unit].
    """

    name: str
    value: float
    unit: str
    min: float | None
    max: float | None
    meaning: str
    latex: str
    source: str


@dataclass(frozen=True)
class Quantity:
    """A variable or an output: a number that is computed. Attributes as those of ``Setting``."""

    name: str
    expression: str
    unit: str
    meaning: str
    latex: str


@dataclass(frozen=True)
class State:
    """A state and its differential equation.

    Attributes
    ----------
    name : str
    initial : float or str
        A number, or an expression of parameters and inputs [unit].
    equation : str
        d(name)/dt [unit/time].
    min, max : float or None
        A simulation ends where the state leaves this range [unit].
    unit, meaning, latex : str
    """

    name: str
    initial: float | str
    equation: str
    unit: str
    min: float | None
    max: float | None
    meaning: str
    latex: str


@dataclass(frozen=True)
class OperatingPoint:
    """Inputs and parameters to start from, and roughly where the steady state is (``near``: state -> value)."""

    name: str
    title: str
    inputs: Mapping[str, float]
    parameters: Mapping[str, float]
    near: Mapping[str, float]


@dataclass(frozen=True)
class Event:
    """What happens when a comparison becomes true: a simulation stops there, or goes on and reports it."""

    name: str
    when: str
    action: str
    message: str


@dataclass(frozen=True)
class ModelDocument:
    """A model's document. ``schematic`` is kept as it is: the engine does not look into it."""

    id: str
    title: str
    summary: str
    notes: str
    time_unit: str
    parameters: tuple[Setting, ...]
    inputs: tuple[Setting, ...]
    variables: tuple[Quantity, ...]
    states: tuple[State, ...]
    outputs: tuple[Quantity, ...]
    operating_points: tuple[OperatingPoint, ...]
    events: tuple[Event, ...]
    schematic: Any = field(default=None, compare=False)


def read_document(data: object, limits: Limits) -> ModelDocument:
    """Read a document strictly; formulas are not looked into yet.

    Parameters
    ----------
    data : mapping
        As ``json.loads`` gives it.
    limits : Limits

    Returns
    -------
    ModelDocument
        ``outputs`` are the states where the document gives none.

    Raises
    ------
    InvalidInput
        With the place of the mistake, e.g. ``states[1].initial``.
    """
    fields = Fields(data)
    fields.get("$schema")
    many = limits.expressions
    document = ModelDocument(
        id=fields.name("id", _ID, MAX_ID),
        title=fields.text("title", longest=200),
        summary=fields.text("summary", ""),
        notes=fields.text("notes", "", longest=200),
        time_unit=_one_of(fields, "time_unit", TIME_UNITS, "s"),
        parameters=fields.list("parameters", _setting, 2 * many),
        inputs=fields.list("inputs", _setting, limits.states),
        variables=fields.list("variables", _quantity, many),
        states=fields.list("states", _state, limits.states),
        outputs=fields.list("outputs", _quantity, many),
        operating_points=fields.list("operating_points", _operating_point, MAX_OPERATING_POINTS),
        events=fields.list("events", _event, MAX_EVENTS),
        schematic=fields.get("schematic"),
    )
    fields.done()
    if not document.states:
        raise InvalidInput(
            "a model has at least one state", field="states", hint='{"name": "x", "equation": "-x", ...}'
        )
    _check_names(document)
    if not document.outputs:
        outputs = tuple(Quantity(s.name, s.name, s.unit, s.meaning, s.latex) for s in document.states)
        document = ModelDocument(**{**document.__dict__, "outputs": outputs})
    count = sum(map(len, (document.variables, document.states, document.outputs, document.events)))
    if count > limits.expressions:
        raise InvalidInput(f"the model has {count} expressions, more than {limits.expressions}", field="variables")
    return document


def _one_of(fields: Fields, key: str, allowed: tuple[str, ...], default: str) -> str:
    value = fields.text(key, default)
    if value not in allowed:
        raise InvalidInput(f"{key} must be one of {', '.join(allowed)}", field=fields.at(key))
    return value


def _range(fields: Fields) -> tuple[float | None, float | None]:
    low, high = fields.optional_number("min"), fields.optional_number("max")
    if low is not None and high is not None and not low < high:
        raise InvalidInput("min must be less than max", field=fields.at("max"))
    return low, high


def _setting(fields: Fields) -> Setting:
    name, value = fields.name(), fields.number("value")
    low, high = _range(fields)
    check_range(value, low, high, name, fields.at("value"))
    texts = (fields.text("meaning", ""), fields.text("latex", "", 200), fields.text("source", ""))
    return Setting(name, value, fields.text("unit", "", 40), low, high, *texts)


def _quantity(fields: Fields) -> Quantity:
    texts = (fields.text("unit", "", 40), fields.text("meaning", ""), fields.text("latex", "", 200))
    return Quantity(fields.name(), fields.text("expression"), *texts)


def _state(fields: Fields) -> State:
    initial = fields.get("initial", True)
    return State(
        fields.name(),
        fields.text("initial") if isinstance(initial, str) else fields.number("initial"),
        fields.text("equation"),
        fields.text("unit", "", 40),
        *_range(fields),
        fields.text("meaning", ""),
        fields.text("latex", "", 200),
    )


def _operating_point(fields: Fields) -> OperatingPoint:
    return OperatingPoint(
        fields.name(pattern=_ID, longest=MAX_ID),
        fields.text("title", "", 200),
        fields.numbers("inputs"),
        fields.numbers("parameters"),
        fields.numbers("near"),
    )


def _event(fields: Fields) -> Event:
    name, when = fields.name(), fields.text("when")
    return Event(name, when, _one_of(fields, "action", ACTIONS, "report"), fields.text("message", "", 200))


def check_range(value: float, low: float | None, high: float | None, name: str, path: str) -> None:
    """Refuse a value outside its declared range."""
    if (low is not None and value < low) or (high is not None and value > high):
        ends = " and ".join(
            f"{word} {end:g}" for word, end in (("at least", low), ("at most", high)) if end is not None
        )
        raise InvalidInput(f"{name} must be {ends}", field=path)


def _check_names(document: ModelDocument) -> None:
    seen: dict[str, str] = {}
    for kind in ("parameters", "inputs", "variables", "states"):
        for index, item in enumerate(getattr(document, kind)):
            path = f"{kind}[{index}].name"
            if item.name in RESERVED:
                raise InvalidInput(f"{item.name!r} has a meaning of its own in formulas", field=path, hint="rename it")
            if item.name in seen:
                raise InvalidInput(f"the name {item.name!r} is taken by {seen[item.name]}", field=path)
            seen[item.name] = path
    for kind in ("outputs", "operating_points", "events"):
        _check_unique(getattr(document, kind), kind)
    for index, point in enumerate(document.operating_points):
        for key, kind in (("inputs", "inputs"), ("parameters", "parameters"), ("near", "states")):
            known = {item.name: item for item in getattr(document, kind)}
            for name, value in getattr(point, key).items():
                path = f"operating_points[{index}].{key}.{name}"
                if name not in known:
                    raise InvalidInput(f"the model has no {kind.removesuffix('s')} {name[:40]!a}", field=path)
                check_range(value, known[name].min, known[name].max, name, path)


def _check_unique(items: Iterable[Any], kind: str) -> None:
    names: set[str] = set()
    for index, item in enumerate(items):
        if item.name in names:
            raise InvalidInput(f"the name {item.name!r} stands twice", field=f"{kind}[{index}].name")
        names.add(item.name)
