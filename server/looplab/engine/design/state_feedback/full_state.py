"""A state feedback with its observer, setpoint and integrators, made from a linear model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.design.state_feedback.lqr import lqr
from looplab.engine.design.state_feedback.placement import eigenvector_condition, matched, place_poles
from looplab.engine.design.state_feedback.reference_gain import reference_gain, with_integrators
from looplab.engine.design.state_feedback.settings import ByPoles, ByWeights, DesignSettings, Faster
from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.state_space import StateSpaceModel
from looplab.engine.state_space.eigenvalues import eigenvalues
from looplab.engine.systems.polynomial import ComplexArray, FloatArray


@dataclass(frozen=True)
class GainResult:
    """A gain with the poles it gives.

    ``desired`` and ``error`` are None where weights, not poles, were asked for; ``residual`` is that of the Riccati
    equation then. ``condition`` as in ``Placement``.
    """

    gain: FloatArray
    desired: ComplexArray | None
    obtained: ComplexArray
    error: float | None
    condition: float | None
    kept: ComplexArray
    residual: float | None


@dataclass(frozen=True)
class StateFeedback:
    """u = -K x + K_I x_I + N r, with x_I' = r - y, and x the observer's estimate where there is one.

    Attributes
    ----------
    model : StateSpaceModel
    settings : DesignSettings
    K, K_I, N : ndarrays, shapes (m, n), (m, q) and (m, q)
        K_I is zero without integrators; N is zero with them, or where it does not exist.
    N_reason : str or None
        Why there is no N.
    L : ndarray, shape (n, p) or None
        Of the measured outputs.
    feedback, observer : GainResult and GainResult or None
        The gain of the plant with its integrators; that of the observer, transposed as L is.
    """

    model: StateSpaceModel
    settings: DesignSettings
    K: FloatArray
    K_I: FloatArray
    N: FloatArray
    N_reason: str | None
    L: FloatArray | None
    feedback: GainResult
    observer: GainResult | None


def design_state_feedback(model: StateSpaceModel, settings: DesignSettings) -> StateFeedback:
    """The gains that settings ask for.

    Parameters
    ----------
    model : StateSpaceModel
        At least one state.
    settings : DesignSettings

    Returns
    -------
    StateFeedback

    Raises
    ------
    InvalidInput
        As ``place_poles``, ``lqr`` and ``with_integrators`` do, with ``gain`` or ``observer`` in front of the field.
    NoConvergence
        A Riccati equation is too badly conditioned.
    """
    if not model.states:
        raise InvalidInput("a static gain has no states to feed back", field="plant")
    controlled = settings.controlled
    A, B = model.A, model.B
    if settings.integral and controlled:
        A, B = with_integrators(model, controlled)
    feedback = _gain(A, B, settings.gain, "gain", dual=False)
    n, shape = model.states, (model.inputs, len(controlled))
    K, K_I, N, reason = feedback.gain[:, :n], np.zeros(shape), np.zeros(shape), None
    if settings.integral and controlled:
        K_I = -feedback.gain[:, n:]
    elif controlled:
        try:
            N = reference_gain(model, K, controlled)
        except InvalidInput as error:
            reason = error.message
    observer = None
    if settings.observer is not None:
        rows = list(settings.measured)
        if not rows:
            raise InvalidInput("an observer needs an output to see", field="measured")
        how = settings.observer
        if isinstance(how, Faster):
            how = ByPoles(tuple((how.speed * eigenvalues(model.A - model.B @ K)).tolist()))
        observer = _gain(model.A.T, model.C[rows].T, how, "observer", dual=True)
    return StateFeedback(
        model, settings, K, K_I, N, reason, None if observer is None else observer.gain.T, feedback, observer
    )


def _gain(A: FloatArray, B: FloatArray, how: ByPoles | ByWeights, field: str, dual: bool) -> GainResult:
    try:
        if isinstance(how, ByPoles):
            found = place_poles(A, B, how.poles, dual)
            return GainResult(found.K, found.desired, found.obtained, found.error, found.condition, found.kept, None)
        best = lqr(A, B, how.Q, how.R, dual)
    except EngineError as error:
        error.field = f"{field}.{error.field}" if error.field else field
        raise
    condition = eigenvector_condition(A - B @ best.K)
    return GainResult(best.K, None, best.poles, None, condition, np.zeros(0, dtype=complex), best.residual)


def separated_poles(found: StateFeedback) -> ComplexArray:
    """Poles of feedback and observer as each was designed: by the separation principle those of the whole loop."""
    both = [found.feedback.obtained, *([] if found.observer is None else [found.observer.obtained])]
    return np.concatenate(both)


def whole_loop_poles(A: FloatArray, found: StateFeedback) -> ComplexArray:
    """Eigenvalues of the whole loop's matrix, in the order of ``separated_poles``."""
    return matched(eigenvalues(A), separated_poles(found))
