"""A lab as its reader gets it: texts as HTML, formulas as MathML, and nothing that gives an answer away."""

from typing import Any

from looplab.engine.nomenclature import NOMENCLATURE
from looplab.labs.grading.design import demand
from looplab.labs.grading.quantity import show, tolerance_text
from looplab.labs.schema import (
    Bench,
    ChoiceExercise,
    DesignExercise,
    Exercise,
    Lab,
    NumberExercise,
    Slider,
    TextBlock,
    TransferFunctionExercise,
)
from looplab.labs.text import render_line, render_math, render_text
from looplab.schemas import ExpressionSystem

# Units a person needs beside a knob; a gain's own (input over output) depends on signals the bench does not name.
_UNITS = {"time": "{time}", "rad/time": "rad/{time}", "%": "%", "dB": "dB", "deg": "°"}


def list_entry(lab: Lab) -> dict[str, Any]:
    """What the list of labs says about one."""
    return {
        "id": lab.id,
        "title": lab.title,
        "level": lab.level,
        "section": lab.section,
        "summary": lab.summary,
        "minutes": lab.minutes,
        "exercises": sum(1 for _ in lab.exercises()),
    }


def render_lab(lab: Lab) -> dict[str, Any]:
    """The lab for its page. Answers, solutions, mistakes and tests stay on the server."""
    number = 0
    parts = []
    for part in lab.parts:
        blocks: list[dict[str, Any]] = []
        for block in part.blocks:
            if isinstance(block, TextBlock):
                blocks.append({"type": "text", "html": render_text(block.markdown)})
            else:
                number += 1
                blocks.append(_exercise(block, number, lab.bench))
        parts.append({"id": part.id, "title": part.title, "settings": part.settings, "blocks": blocks})
    return {
        **list_entry(lab),
        "objectives_html": [render_line(objective) for objective in lab.objectives],
        "bench": _bench(lab.bench),
        "parts": parts,
    }


def _bench(bench: Bench) -> dict[str, Any]:
    plant = bench.plant.to_engine()
    latex = bench.plant.to_latex()
    return {
        "time_unit": bench.time_unit,
        "plant": bench.plant.model_dump(),
        "controller": bench.controller.model_dump(),
        "plant_text": plant.to_text(),
        "plant_latex": latex,
        "plant_mathml": render_math(latex),
        **_instrument("actuator", bench.actuator),
        **_instrument("sensor", bench.sensor),
        "horizon": bench.horizon,
        "response": bench.response and bench.response.model_dump(),
        "laplace": bench.laplace and bench.laplace.model_dump(),
        "panels": list(bench.panels),
        "sliders": [_slider(slider, bench) for slider in bench.sliders],
    }


def _instrument(name: str, system: ExpressionSystem | None) -> dict[str, Any]:
    found = {name: None, f"{name}_mathml": None}
    return found if system is None else {name: system.text, f"{name}_mathml": render_math(system.to_latex())}


def _slider(slider: Slider, bench: Bench) -> dict[str, Any]:
    symbol = NOMENCLATURE[slider.knob]
    return {
        "knob": slider.knob,
        "label": slider.label or symbol.meaning.partition(",")[0].capitalize(),
        "symbol_mathml": render_math(symbol.latex),
        "unit": _UNITS.get(symbol.unit, "").format(time=bench.time_unit),
        "min": slider.min,
        "max": slider.max,
        "step": slider.step,
        "scale": slider.scale,
        "can_be_off": slider.can_be_off,
        "value": bench.settings()[slider.knob],
    }


def _exercise(exercise: Exercise, number: int, bench: Bench) -> dict[str, Any]:
    return {
        "type": exercise.type,
        "id": exercise.id,
        "number": number,
        "title": exercise.title,
        "points": exercise.points,
        "prompt_html": render_text(exercise.prompt),
        "hints_html": [render_text(hint) for hint in exercise.hints],
        **_particulars(exercise, bench),
    }


def _particulars(exercise: Exercise, bench: Bench) -> dict[str, Any]:
    if isinstance(exercise, NumberExercise):
        return {
            "fields": [
                {
                    "id": field.id,
                    "label": field.label,
                    "symbol_mathml": render_math(field.symbol) if field.symbol else None,
                    "unit": field.unit,
                    "tolerance_text": tolerance_text(field.tolerance, field.unit),
                }
                for field in exercise.fields
            ]
        }
    if isinstance(exercise, ChoiceExercise):
        return {
            "several": exercise.several,
            "options": [{"id": option.id, "html": render_line(option.text)} for option in exercise.options],
        }
    if isinstance(exercise, TransferFunctionExercise):
        return {
            "symbol_mathml": render_math(exercise.symbol) if exercise.symbol else None,
            "tolerance_text": f"within {show(100 * exercise.tolerance)} %",
        }
    assert isinstance(exercise, DesignExercise)
    return {
        "specifications": [
            {
                "name": spec.measure,
                "relation": spec.relation,
                "limit": spec.limit,
                "text": demand(spec, bench.time_unit),
            }
            for spec in exercise.specifications
        ]
    }
