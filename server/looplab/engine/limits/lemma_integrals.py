r"""Integrals of a loop's response under an exponential weight, from the response itself.

The weighted signals x e^{-ct} of a loop obey equations of the same kind: A becomes A - c, and the shift z by the dead
time becomes z e^{-c theta}. With the integral as one state more, the exact response of that loop is the integral.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.limits.interpolation import right_half_plane
from looplab.engine.limits.measured import measured_loop
from looplab.engine.loop.dead_time import delayed_response
from looplab.engine.loop.delay_free import delay_free_response
from looplab.engine.loop.equations import LoopEquations, loop_equations
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.loop.step_response import SHORTEST_DEAD_TIME
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.polynomial import ComplexArray

FloatArray = npt.NDArray[np.float64]

# e^{-36} is below rounding.
DECAY = 36.0
POINTS = 64


@dataclass(frozen=True)
class LemmaIntegral:
    r"""One of the integrals that a right-half-plane zero or pole fixes.

    Attributes
    ----------
    root : float
        The real zero or pole c [rad/time].
    kind : str
        "zero" or "pole".
    signal, step : str
        "y" or "e"; after a unit step of "setpoint" or "load".
    value : float
        Integral of signal times e^{-ct} over the simulated response [output*time].
    theorem : float
        What the constraint says it is [output*time].
    """

    root: float
    kind: str
    signal: str
    step: str
    value: float
    theorem: float


class _Weighted:
    """[loop states, r, d, integral of y, integral of r - y] under the weight e^{-ct}."""

    def __init__(self, equations: LoopEquations, c: float, theta: float) -> None:
        self.equations, self.c, self.shift = equations, c, np.exp(-c * theta)

    def __call__(self, z: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        A, rows = self.equations.at(z * self.shift)
        k, n = A.shape[:2]
        out = np.zeros((k, n + 2, n + 2), dtype=complex)
        out[:, :n, :n] = A - self.c * np.eye(n)
        out[:, n, :n], out[:, n + 1, :n] = rows[:, 0], -rows[:, 0]
        out[:, n + 1, n - 2] += 1.0
        integrals = np.zeros((k, 2, n + 2), dtype=complex)
        integrals[:, 0, n] = integrals[:, 1, n + 1] = 1.0
        return out, integrals


def weighted_integrals(loop: FeedbackLoop, c: float) -> FloatArray:
    r"""Integrals of y e^{-ct} and (r - y) e^{-ct} after unit steps of setpoint and load, dead time exact.

    .. math:: \int_0^{36/c} y(t)\, e^{-ct}\, dt

    Parameters
    ----------
    loop : FeedbackLoop
        Plant and controller only, all dead time in the plant; stable.
    c : float
        > 0 [rad/time].

    Returns
    -------
    ndarray, shape (2, 2)
        Rows y and r - y, columns setpoint and load [output*time]. What lies beyond 36/c is below rounding.

    Raises
    ------
    InvalidInput
        c is not positive, or the dead time is below a millionth of 36/c.

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, sec. 8.6.
    """
    if not c > 0:
        raise InvalidInput("the weight must decay: c must be positive", field="c")
    theta, equations, horizon = loop.theta, loop_equations(loop), DECAY / c
    if 0 < theta < SHORTEST_DEAD_TIME * horizon:
        raise InvalidInput("the dead time is too short beside the zero or pole", field="theta")
    symbol = _Weighted(equations, c, theta)
    starts = np.concatenate([equations.starts, np.zeros((2, 2))])
    if theta == 0.0:
        A, rows = (m[0].real for m in symbol(np.ones(1, dtype=complex)))
        return delay_free_response(A, rows, starts, horizon / (POINTS - 1), POINTS)[-1]
    neutral = abs(equations.DpDc) * float(symbol.shift)
    _, out = delayed_response(symbol, starts, theta, horizon, POINTS, neutral)
    return out[-1]


def lemma_integrals(loop: FeedbackLoop) -> tuple[LemmaIntegral, ...]:
    r"""The integrals that the real right-half-plane zeros z and poles p of L fix, on the loop's own step responses.

    .. math::

        \int_0^\infty y\,e^{-zt}dt = 0, \quad \int_0^\infty e\,e^{-zt}dt = \frac1z, \quad
        \int_0^\infty e\,e^{-pt}dt = 0 \qquad \text{(setpoint)}

        \int_0^\infty y\,e^{-zt}dt = 0, \qquad \int_0^\infty y\,e^{-pt}dt = \frac{1}{p\,C(p)} \qquad \text{(load)}

    Parameters
    ----------
    loop : FeedbackLoop
        Stable. Actuator, plant and sensor count as one plant, and y is what the controller sees; the setpoint weight
        is left out.

    Returns
    -------
    tuple of LemmaIntegral
        For the load only zeros and poles of the plant.

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, lemmas 8.3 and 8.4.
    """
    L, _ = split_hidden_modes(loop.open_loop)
    alone = measured_loop(loop)
    out: list[LemmaIntegral] = []
    for kind, roots in (("zero", L.zeros), ("pole", L.poles)):
        own = alone.plant.zeros if kind == "zero" else alone.plant.poles
        right = right_half_plane(roots)
        for c in sorted(set(right.real[right.imag == 0].tolist())):
            (y_r, y_d), (e_r, _) = weighted_integrals(alone, c).tolist()
            if kind == "zero":
                out.append(LemmaIntegral(c, kind, "y", "setpoint", y_r, 0.0))
                out.append(LemmaIntegral(c, kind, "e", "setpoint", e_r, 1.0 / c))
                if c in own:
                    out.append(LemmaIntegral(c, kind, "y", "load", y_d, 0.0))
            else:
                out.append(LemmaIntegral(c, kind, "e", "setpoint", e_r, 0.0))
                if c in own:
                    value = 1.0 / alone.C(c)
                    out.append(LemmaIntegral(c, kind, "y", "load", y_d, float(value.real) / c))
    return tuple(out)
