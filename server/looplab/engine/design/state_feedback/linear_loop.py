"""The linear closed loop: its matrices, its exact responses, and the loop transfer function at the plant's input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from looplab.engine.design.state_feedback.full_state import StateFeedback
from looplab.engine.errors import InvalidInput
from looplab.engine.state_space import StateSpaceModel, to_transfer_function
from looplab.engine.systems import TransferFunction
from looplab.engine.systems.polynomial import FloatArray


@dataclass(frozen=True)
class LinearLoop:
    """z' = A z + B_r r + B_d d with z = (x, x_I, estimate), and u = F z + N r.

    Attributes
    ----------
    A, B_r, B_d, F, N : ndarrays
        r are the setpoints; d is added to u where it enters the plant.
    open_A : ndarray
        A where the plant's input is not u: what the loop is cut at for its transfer function.
    found : StateFeedback
    """

    A: FloatArray
    B_r: FloatArray
    B_d: FloatArray
    F: FloatArray
    N: FloatArray
    open_A: FloatArray
    found: StateFeedback


@dataclass(frozen=True)
class Push:
    """A pulse added to the inputs of the plant: sizes (m,), from ``start`` on for ``duration`` [time]."""

    size: FloatArray
    start: float
    duration: float


@dataclass(frozen=True)
class LinearRun:
    """Deviations from the steady state: x (count, n), y (count, p), u (count, m) without d, estimate or None."""

    t: FloatArray
    x: FloatArray
    y: FloatArray
    u: FloatArray
    estimate: FloatArray | None


def linear_loop(found: StateFeedback) -> LinearLoop:
    r"""The whole loop as one linear system.

    .. math:: \dot x = A x + B (u + d), \quad \dot x_I = r - C_r x - D_r (u + d), \quad
              \dot{\hat x} = A \hat x + B u + L (y - C \hat x - D u), \quad u = -K \hat x + K_I x_I + N r

    Parameters
    ----------
    found : StateFeedback

    Returns
    -------
    LinearLoop
        By the separation principle its poles are those of A - B K with the integrators, and of A - L C.

    References
    ----------
    .. [1] D. G. Luenberger, An introduction to observers, IEEE Trans. Autom. Control 16 (1971) 596-602.
    """
    model, settings = found.model, found.settings
    A, B, C, D = model.A, model.B, model.C, model.D
    n, m, q = model.states, model.inputs, len(settings.controlled)
    rows = list(settings.controlled)
    integrators = q if settings.integral else 0
    whole = n + integrators + (n if found.L is not None else 0)
    at_I, at_hat = slice(n, n + integrators), slice(n + integrators, whole)
    F = np.zeros((m, whole))
    F[:, at_I] = found.K_I if integrators else np.zeros((m, 0))
    open_A, B_v, B_u, B_r = np.zeros((whole, whole)), np.zeros((whole, m)), np.zeros((whole, m)), np.zeros((whole, q))
    open_A[:n, :n], B_v[:n] = A, B
    if integrators:
        open_A[at_I, :n], B_v[at_I], B_r[at_I] = -C[rows], -D[rows], np.eye(q)
    if found.L is None:
        F[:, :n] = -found.K
    else:
        seen = list(settings.measured)
        F[:, at_hat] = -found.K
        open_A[at_hat, :n], open_A[at_hat, at_hat] = found.L @ C[seen], A - found.L @ C[seen]
        # The observer knows u, and sees what enters the plant only through the outputs.
        B_v[at_hat], B_u[at_hat] = found.L @ D[seen], B - found.L @ D[seen]
    open_A = open_A + B_u @ F
    return LinearLoop(open_A + B_v @ F, B_r + (B_v + B_u) @ found.N, B_v, F, found.N, open_A, found)


def loop_transfer(loop: LinearLoop) -> TransferFunction:
    """L(s) where the only input enters the plant, under negative feedback: K (s I - A)^-1 B where nothing else acts.

    Raises
    ------
    InvalidInput
        The plant has several inputs.
    """
    if loop.F.shape[0] != 1:
        raise InvalidInput("a loop with several inputs has no single loop transfer function", field="plant")
    return to_transfer_function(StateSpaceModel(loop.open_A, loop.B_d, -loop.F))


def linear_run(
    loop: LinearLoop, t: FloatArray, x0: FloatArray, r: FloatArray | None = None, pushes: Sequence[Push] = ()
) -> LinearRun:
    """The linear response from a state, after a step of the setpoints at t = 0 and pushes; exact.

    The observer begins at the steady state: it does not know x0.

    Parameters
    ----------
    loop : LinearLoop
    t : ndarray, shape (count,)
        Increasing from 0 [time].
    x0 : ndarray, shape (n,)
        Deviation from the steady state.
    r : ndarray, shape (q,), or None
        Setpoints as deviations.
    pushes : sequence of Push

    Returns
    -------
    LinearRun

    Raises
    ------
    InvalidInput
        The response grows beyond all numbers.
    """
    model = loop.found.model
    n, size = model.states, loop.A.shape[0]
    steady = loop.B_r @ r if r is not None else np.zeros(size)
    z = np.zeros(size)
    z[:n] = x0
    edges = sorted({edge for push in pushes for edge in (push.start, push.start + push.duration)})

    def pushed(at: float) -> FloatArray:
        on = [push.size for push in pushes if push.start <= at < push.start + push.duration]
        return np.asarray(sum(on, np.zeros(model.inputs)))

    states = np.empty((t.size, size))
    now = 0.0
    steps: dict[tuple[float, bytes], FloatArray] = {}
    with np.errstate(over="ignore", invalid="ignore"):
        for index, target in enumerate(t.tolist()):
            for end in [*(edge for edge in edges if now < edge < target), target]:
                d = pushed(now)
                # Steps of equal length are the same to rounding: one exponential for all of them.
                key = float(f"{end - now:.12g}"), d.tobytes()
                if key not in steps:
                    whole = np.zeros((size + 1, size + 1))
                    whole[:size, :size], whole[:size, size] = loop.A, steady + loop.B_d @ d
                    steps[key] = expm(whole * key[0])
                z = steps[key][:size, :size] @ z + steps[key][:size, size]
                now = end
            states[index] = z
    if not np.isfinite(states).all():
        raise InvalidInput("the linear response grows beyond all numbers", field="horizon", hint="a shorter horizon")
    u = states @ loop.F.T + (loop.N @ r if r is not None else 0.0)
    x = states[:, :n]
    d = np.array([pushed(at) for at in t.tolist()])
    y = x @ model.C.T + (u + d) @ model.D.T
    return LinearRun(t, x, y, u, states[:, -n:] if loop.found.L is not None else None)
