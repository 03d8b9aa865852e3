"""A model with its control loops is a model again: valves, sensors and controllers are states and formulas.

What is continuous is written into the model's own document, so that its Jacobian stays exact; what a sampled controller
or a dead time gives comes in as an input. Settings are parameters: the closed loop is compiled once for all of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from itertools import count
from typing import Any

from looplab.engine.errors import IllPosedLoop
from looplab.engine.nonlinear.control_loop.settings import ControlLoop
from looplab.engine.nonlinear.language import BUILT_IN
from looplab.engine.nonlinear.model import CompiledModel, compile_model


@dataclass(frozen=True)
class Structure:
    """What of a loop makes a difference to the formulas; numbers do not.

    Attributes
    ----------
    output, input : int
        By their place in the model.
    continuous, derivative : bool
    limits : (bool, bool)
        Whether there is a u_min and a u_max.
    anti_windup : str
    sensor, valve : str
        Lag: "", "first", "second" or "rate".
    delayed_sensor, delayed_valve : bool
    """

    output: int
    input: int
    continuous: bool
    derivative: bool
    limits: tuple[bool, bool]
    anti_windup: str
    sensor: str
    valve: str
    delayed_sensor: bool
    delayed_valve: bool

    @property
    def given(self) -> bool:
        """Whether the input, or what enters the valve, comes from outside: held samples or a delayed signal."""
        return not self.continuous or self.delayed_valve


def structure_of(model: CompiledModel, loop: ControlLoop, limits: tuple[bool, bool]) -> Structure:
    """The structure of a loop whose names are known to the model."""

    def kind(lag: Any) -> str:
        if lag is None:
            return ""
        return "second" if lag.zeta is not None else "rate" if lag.rate is not None else "first"

    continuous = loop.sampling_time is None
    return Structure(
        model.output_names.index(loop.output),
        model.input_names.index(loop.input),
        continuous,
        continuous and bool(loop.controller.tau_D),
        limits if continuous else (False, False),
        loop.anti_windup if continuous and any(limits) and loop.Ki else "none",
        kind(loop.sensor.lag),
        kind(loop.valve.lag),
        continuous and loop.sensor.theta > 0,
        continuous and loop.valve.theta > 0,
    )


class LoopNames:
    """How the parts of one loop are called in the closed loop's document."""

    def __init__(self, prefix: str) -> None:
        self.prefix = prefix

    def __call__(self, part: str) -> str:
        return self.prefix + part


@dataclass(frozen=True)
class LoopModel:
    """The closed loop as a model, and how the parts of each loop are called in it."""

    model: CompiledModel
    names: tuple[LoopNames, ...]


@lru_cache(maxsize=32)
def loop_model(plant: CompiledModel, structures: tuple[Structure, ...]) -> LoopModel:
    """The plant with its loops closed, compiled.

    Its states begin with the plant's, its outputs with the plant's; parameters have the value 1 until they are set.

    Raises
    ------
    IllPosedLoop
        A loop is algebraic: its output and its input depend on each other at once.
    """
    _refuse_algebraic(plant, structures)
    document = plant.document
    taken = [
        each.name
        for items in (document.parameters, document.inputs, document.variables, document.states, document.outputs)
        for each in items
    ]
    start = next(p for n in count() if not any(name.startswith(p := f"c{n}_") for name in taken))
    names = tuple(LoopNames(f"{start}{index}_") for index in range(len(structures)))
    moved = {document.inputs[s.input].name for s in structures}
    parts = _Parts([], [asdict(i) for i in document.inputs if i.name not in moved], [], [], [])
    for structure, name in zip(structures, names, strict=True):
        expression = document.outputs[structure.output].expression
        _write(parts, name, structure, document.inputs[structure.input].name, expression)
    return LoopModel(
        compile_model(
            {
                "id": document.id,
                "title": document.title,
                "time_unit": document.time_unit,
                "parameters": [*map(asdict, document.parameters), *parts.parameters],
                "inputs": parts.inputs,
                "variables": [*map(asdict, document.variables), *parts.variables],
                # A start as a formula may be of an input that is now moved by a valve: it is always set from outside.
                "states": [*({**asdict(s), "initial": 0.0} for s in document.states), *parts.states],
                "outputs": [*map(asdict, document.outputs), *parts.outputs],
                "events": [*map(asdict, document.events)],
            },
            BUILT_IN,
        ),
        names,
    )


def _refuse_algebraic(plant: CompiledModel, structures: Sequence[Structure]) -> None:
    """Follow what depends on what at once, from loop to loop."""
    equations = plant.equations
    direct: dict[int, list[int]] = {}
    for i, loop in enumerate(structures):
        reached = set(plant.graph.reachable([equations.outputs[loop.output]]))
        open_to = loop.continuous and not loop.sensor and not loop.delayed_sensor
        direct[i] = [
            j
            for j, other in enumerate(structures)
            if open_to
            and not (other.given or other.valve)
            and equations.leaves[plant.input_names[other.input]] in reached
        ]
    for i, loop in enumerate(structures):
        seen: set[int] = set()
        waiting = list(direct[i])
        while waiting:
            each = waiting.pop()
            if each == i:
                name = plant.output_names[loop.output]
                raise IllPosedLoop(
                    f"the loop is algebraic: {name} depends at once on what its controller does",
                    field=f"loops[{i}]",
                    hint="give it a lag of the valve or of the sensor, or a sampling time",
                )
            if each not in seen:
                seen.add(each)
                waiting += direct[each]


@dataclass(frozen=True)
class _Parts:
    """What the loops add to the document."""

    parameters: list[dict[str, Any]]
    inputs: list[dict[str, Any]]
    variables: list[dict[str, Any]]
    states: list[dict[str, Any]]
    outputs: list[dict[str, Any]]

    def parameter(self, name: str) -> str:
        self.parameters.append({"name": name, "value": 1.0})
        return name

    def input(self, name: str) -> str:
        self.inputs.append({"name": name, "value": 0.0})
        return name

    def variable(self, name: str, expression: str) -> str:
        self.variables.append({"name": name, "expression": expression})
        return name

    def state(self, name: str, equation: str) -> str:
        self.states.append({"name": name, "initial": 0.0, "equation": equation})
        return name

    def output(self, name: str, expression: str) -> None:
        self.outputs.append({"name": name, "expression": expression})

    def lag(self, kind: str, source: str, out: str, own: str) -> None:
        """The state ``out`` that follows ``source``; ``own`` begins the names of what it needs."""
        tau = self.parameter(f"{own}tau")
        if kind == "second":
            zeta, speed = self.parameter(f"{own}zeta"), f"{own}d"
            self.state(out, speed)
            self.state(speed, f"({source} - {out} - 2*{zeta}*{tau}*{speed})/{tau}^2")
        elif kind == "rate":
            rate = self.parameter(f"{own}rate")
            self.state(out, f"clip(({source} - {out})/{tau}, -{rate}, {rate})")
        else:
            self.state(out, f"({source} - {out})/{tau}")


def _write(parts: _Parts, name: LoopNames, structure: Structure, moved: str, measured: str) -> None:
    """One loop: from what is measured to the input that is moved."""
    signal = parts.variable(name("y"), measured)
    if structure.sensor:
        parts.lag(structure.sensor, signal, name("s"), name("s_"))
        signal = name("s")
    parts.output(name("sensor"), signal)
    if structure.continuous:
        if structure.delayed_sensor:
            signal = parts.input(name("sensor_past"))
        u = _controller(parts, name, structure, signal)
        parts.output(name("out"), u)
    if structure.given:
        u = name("u_given") if structure.valve else moved
        parts.input(u)
    if structure.valve:
        parts.lag(structure.valve, u, moved, name("valve_"))
    elif not structure.given:
        parts.variable(moved, u)
    parts.output(name("moved"), moved)


def _controller(parts: _Parts, name: LoopNames, structure: Structure, signal: str) -> str:
    """A continuous controller: the name of u after saturation."""
    Kc, Ki, beta, r0 = (parts.parameter(name(each)) for each in ("Kc", "Ki", "beta", "r0"))
    r, noise, auto, manual = (parts.input(name(each)) for each in ("r", "noise", "auto", "manual"))
    y = parts.variable(name("measured"), f"{signal} + {noise}")
    v = f"{Kc}*({r} - {y} + ({beta} - 1)*({r} - {r0})) + {name('I')}"
    if structure.derivative:
        gamma, KD, T = (parts.parameter(name(each)) for each in ("gamma", "KD", "Tf"))
        past = name("filter")
        v += f" + {KD}*({gamma}*{r} - {y} - {past})"
        parts.state(past, f"({gamma}*{r} - {y} - {past})/{T}")
    v = parts.variable(name("v"), f"if({auto} > 0.5, {v}, {manual})")
    low, high = (
        parts.parameter(name(end)) if there else ""
        for end, there in zip(("u_min", "u_max"), structure.limits, strict=True)
    )
    u = v
    if low:
        u = f"max({u}, {low})"
    if high:
        u = f"min({u}, {high})"
    u = parts.variable(name("u"), u)
    rate = f"{Ki}*({r} - {y})"
    if structure.anti_windup == "back_calculation":
        rate += f" + ({u} - {v})/{parts.parameter(name('T_t'))}"
    elif structure.anti_windup == "clamping":
        rate = parts.variable(name("rate"), rate)
        band = parts.parameter(name("band"))
        # Steep, but without a jump: along the limit a jump would make the solver switch for ever.
        above = f"clip(({high} - {v})/{band}, 0, 1)" if high else "1"
        below = f"clip(({v} - {low})/{band}, 0, 1)" if low else "1"
        rate = f"{rate}*if({rate} > 0, {above}, {below})"
    parts.state(name("I"), f"if({auto} > 0.5, {rate}, 0)")
    parts.output(name("measured"), y)
    parts.output(name("v"), v)
    return u
