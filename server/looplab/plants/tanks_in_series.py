"""N stirred tanks in series: the document for any N."""

from __future__ import annotations

from typing import Any

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear import BUILT_IN


def tanks_in_series(N: int = 5) -> dict[str, Any]:
    r"""A solution flows through N equal stirred tanks, which smooth its concentration.

    .. math:: \frac{V}{N} \frac{dc_i}{dt} = F (c_{i-1} - c_i), \quad
        \frac{c_N(s)}{c_0(s)} = \frac{1}{(1 + s V/(N F))^N} \to e^{-s V/F}

    Parameters
    ----------
    N : int
        Number of tanks; they share the volume V, so the mean residence time V/F stays and the response nears a dead
        time as N grows.

    Returns
    -------
    dict
        A model document with the states c_1, ..., c_N and the inputs c_0 and F; the output is c_N.

    Raises
    ------
    InvalidInput
        N is not in 1 .. 120.

    References
    ----------
    .. [1] O. Levenspiel, Chemical Reaction Engineering, 3rd ed., Wiley, 1999, chapter 14.
    """
    if not 1 <= N <= BUILT_IN.states:
        raise InvalidInput(f"there must be 1 to {BUILT_IN.states} tanks", field="N")
    numbers = range(1, N + 1)
    return {
        "id": "tanks-in-series",
        "title": "Stirred tanks in series",
        "summary": f"A solution flows through {N} equal stirred tanks that share one volume. Each is first order; in a "
        "row they answer ever later and ever more sharply, and very many of them are a dead time.",
        "notes": "13",
        "time_unit": "min",
        "parameters": [
            {"name": "V", "value": 5, "unit": "m³", "min": 0.1, "max": 100, "latex": "V", "source": "chosen"}
            | {"meaning": "volume of all tanks together"}
        ],
        "inputs": [
            {"name": "c_0", "value": 0.5, "unit": "mol/l", "min": 0, "max": 1, "latex": "c_0", "source": "chosen"}
            | {"meaning": "concentration in the feed"},
            {"name": "F", "value": 1, "unit": "m³/min", "min": 0, "max": 2, "latex": "F", "source": "chosen"}
            | {"meaning": "flow through all tanks"},
        ],
        "variables": [
            {"name": "tau", "expression": f"V/({N}*F)", "unit": "min", "meaning": "time constant of a tank"}
            | {"latex": r"\tau"}
        ],
        "states": [
            {
                "name": f"c_{i}",
                "initial": "c_0",
                "equation": f"{N}*F/V*(c_{i - 1} - c_{i})",
                "unit": "mol/l",
                "meaning": f"concentration in tank {i}",
                "latex": f"c_{{{i}}}",
            }
            for i in numbers
        ],
        "outputs": [
            {"name": f"c_{N}", "expression": f"c_{N}", "unit": "mol/l", "meaning": "concentration that flows out"}
            | {"latex": f"c_{{{N}}}"}
        ],
        "operating_points": [
            {"name": "half", "title": "feed of half strength", "near": dict.fromkeys((f"c_{i}" for i in numbers), 0.5)},
            {"name": "slow", "title": "half the flow: twice as slow", "inputs": {"F": 0.5}}
            | {"near": dict.fromkeys((f"c_{i}" for i in numbers), 0.5)},
        ],
    }
