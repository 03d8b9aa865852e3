"""Small model documents for tests."""

from collections.abc import Sequence
from typing import Any


def model(equations: Sequence[str] | str, initial: Sequence[float | str] | float = 1.0, **more: Any) -> dict[str, Any]:
    """A document with states x (one equation), or x1, x2, ...; ``more`` are its other fields."""
    texts = [equations] if isinstance(equations, str) else list(equations)
    starts = [initial] * len(texts) if isinstance(initial, int | float) else list(initial)
    names = ["x"] if len(texts) == 1 else [f"x{i + 1}" for i in range(len(texts))]
    states = [
        {"name": name, "initial": start, "equation": text}
        for name, start, text in zip(names, starts, texts, strict=True)
    ]
    return {"id": "test", "title": "Test", "states": states, **more}


def parameters(**values: float) -> list[dict[str, Any]]:
    """Parameters (or inputs) by name."""
    return [{"name": name, "value": value} for name, value in values.items()]


# Notes 3.1, with the cooling that leaves the reactor alight (Q = 2e6 cal/min).
CSTR: dict[str, Any] = {
    "id": "cstr",
    "title": "Stirred tank reactor",
    "time_unit": "min",
    "parameters": parameters(V=100, k0=7.2e10, EbyR=1e4, J=200, rho_cp=1000),
    "inputs": parameters(Fi=100, cAi=1, Ti=350, Q=2e6),
    "variables": [
        {"name": "r", "expression": "k*cA"},
        {"name": "k", "expression": "k0*exp(-EbyR/T)"},
    ],
    "states": [
        {"name": "cA", "initial": 1, "equation": "Fi/V*(cAi - cA) - r"},
        {"name": "T", "initial": "Ti", "equation": "Fi/V*(Ti - T) + J*r - Q/(V*rho_cp)"},
    ],
    "outputs": [{"name": "conversion", "expression": "1 - cA/cAi"}, {"name": "T", "expression": "T"}],
}
