"""A small lab with one exercise of each kind; tests change it to see what happens."""

import copy
from typing import Any

import pytest

from looplab.labs import Lab, validate_lab

TESTS_OF_NUMBER = [
    {"case": "author", "answer": 8},
    {"case": "mistake", "answer": 18.06, "feedback": "ratio"},
    {"case": "blank", "answer": None},
    {"case": "wrong", "answer": 3},
]

SMALL_LAB: dict[str, Any] = {
    "$schema": "./lab.schema.json",
    "id": "small",
    "title": "A small lab",
    "level": "introductory",
    "section": "19.1",
    "minutes": 10,
    "summary": "One exercise of each kind.",
    "objectives": ["Find $K_u$."],
    "bench": {
        "plant": {"type": "expr", "text": "1/(s+1)^3"},
        "controller": {"type": "pid", "form": "ideal", "Kc": 1, "tau_I": None, "tau_D": None, "alpha": 0.1},
        "sliders": [
            {"knob": "Kc", "min": 0.1, "max": 20, "step": 0.1, "scale": "log"},
            {"knob": "tau_I", "min": 0.2, "max": 20, "step": 0.1, "can_be_off": True},
            {"knob": "tau_D", "min": 0.02, "max": 5, "step": 0.02, "can_be_off": True},
        ],
        "panels": ["step"],
    },
    "parts": [
        {
            "id": "all-kinds",
            "title": "All kinds",
            "blocks": [
                {"type": "text", "markdown": ["Read", "", "$$G(s) = \\frac{1}{(s+1)^3}$$"]},
                {
                    "type": "number",
                    "id": "ku",
                    "title": "The ultimate gain",
                    "prompt": "What is $K_u$?",
                    "fields": [
                        {
                            "id": "Ku",
                            "label": "Ultimate gain",
                            "symbol": "K_u",
                            "answer": {"quantity": "Ku"},
                            "tolerance": {"relative": 0.01},
                            "mistakes": [{"answer": {"quantity": "GM_dB"}, "feedback": "As a ratio, please."}],
                        }
                    ],
                    "hints": ["Look at the phase."],
                    "solution": "It is **8**.",
                    "tests": TESTS_OF_NUMBER,
                },
                {
                    "type": "number",
                    "id": "pi",
                    "title": "PI settings",
                    "prompt": "Which?",
                    "fields": [
                        {
                            "id": "Kc",
                            "label": "Gain",
                            "answer": {"rule": "ziegler_nichols", "type": "PI", "setting": "Kc"},
                            "tolerance": {"relative": 0.01},
                        },
                        {
                            "id": "tau_I",
                            "label": "Integral time",
                            "unit": "s",
                            "answer": {"value": 3.023, "source": "Pu/1.2"},
                            "tolerance": {"absolute": 0.05},
                            "mistakes": [{"answer": {"quantity": "Pu", "times": 1.2}, "feedback": "Divide instead."}],
                        },
                    ],
                    "solution": "3.6 and 3.023.",
                    "tests": [
                        {"case": "author", "answer": {"Kc": 3.6, "tau_I": 3.02}},
                        {"case": "mistake", "answer": {"Kc": 3.6, "tau_I": 4.353}, "feedback": "Divide"},
                        {"case": "blank", "answer": {}},
                        {"case": "wrong", "answer": {"Kc": 1, "tau_I": 1}},
                    ],
                },
                {
                    "type": "choice",
                    "id": "why",
                    "title": "Why?",
                    "prompt": "Pick.",
                    "options": [
                        {"id": "a", "text": "Because.", "correct": True, "feedback": "Yes."},
                        {"id": "b", "text": "Why not.", "feedback": "Think again."},
                        {"id": "c", "text": "Who knows.", "feedback": "You will."},
                    ],
                    "solution": "Because.",
                    "tests": [
                        {"case": "author", "answer": "a"},
                        {"case": "mistake", "answer": "b", "feedback": "Think"},
                        {"case": "blank", "answer": None},
                        {"case": "wrong", "answer": "c"},
                    ],
                },
                {
                    "type": "transfer_function",
                    "id": "system",
                    "title": "As a system",
                    "prompt": "Type it.",
                    "symbol": "G(s)",
                    "answer": {"type": "expr", "text": "2 exp(-0.5 s)/((s+1)(s+3))"},
                    "mistakes": [{"system": {"type": "expr", "text": "2/((s+1)(s+3))"}, "feedback": "The dead time!"}],
                    "solution": "So.",
                    "tests": [
                        {"case": "author", "answer": "2 exp(-0.5 s)/(s^2+4s+3)"},
                        {"case": "mistake", "answer": "2/(s^2+4s+3)", "feedback": "dead time"},
                        {"case": "blank", "answer": ""},
                        {"case": "wrong", "answer": "1/s"},
                    ],
                },
                {
                    "type": "design",
                    "id": "design",
                    "title": "Design",
                    "prompt": "Build it.",
                    "specifications": [
                        {"measure": "overshoot_pct", "limit": 25, "feedback": "Too lively."},
                        {"measure": "Ms", "limit": 2, "feedback": "Too near to -1."},
                        {"measure": "GM", "relation": ">=", "limit": 2, "feedback": "Too little room."},
                    ],
                    "solution": "Like this.",
                    "tests": [
                        {"case": "author", "answer": {"Kc": 4.8, "tau_I": 3, "tau_D": 0.8}},
                        {
                            "case": "mistake",
                            "answer": {"Kc": 4.8, "tau_I": 1.8138, "tau_D": 0.45345},
                            "feedback": "Too lively",
                        },
                        {"case": "blank", "answer": None},
                        {"case": "wrong", "answer": {"Kc": 9}},
                    ],
                },
            ],
        }
    ],
}


@pytest.fixture
def data() -> dict[str, Any]:
    """The small lab as JSON, free to be changed."""
    return copy.deepcopy(SMALL_LAB)


@pytest.fixture
def lab() -> Lab:
    return validate_lab(copy.deepcopy(SMALL_LAB))
