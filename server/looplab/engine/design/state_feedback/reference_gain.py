"""Following a setpoint: the gain before the loop, and integrators inside it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space import StateSpaceModel
from looplab.engine.systems.polynomial import FloatArray


def _steady(model: StateSpaceModel, controlled: Sequence[int]) -> FloatArray:
    rows = list(controlled)
    if not 1 <= len(rows) <= model.inputs:
        raise InvalidInput(
            f"{len(rows)} outputs cannot be held at setpoints by {model.inputs} inputs",
            field="controlled",
            hint="as many as there are inputs, or fewer",
        )
    whole = np.block([[model.A, model.B], [model.C[rows], model.D[rows]]])
    sigma = np.linalg.svd(_scaled(whole), compute_uv=False)
    if sigma[-1] <= 1e-12 * sigma[0]:
        raise InvalidInput(
            "the plant has a zero at s = 0 from its inputs to these outputs: no steady input holds them at a setpoint",
            field="controlled",
            hint="hold another output",
        )
    return whole


def _scaled(matrix: FloatArray) -> FloatArray:
    rows = np.abs(matrix).max(axis=1, keepdims=True)
    return matrix / np.where(rows > 0, rows, 1.0)


def reference_gain(model: StateSpaceModel, K: FloatArray, controlled: Sequence[int]) -> FloatArray:
    r"""The gain N of u = -K x + N r for which outputs come to rest at their setpoints.

    .. math:: \begin{bmatrix} A & B \\ C & D \end{bmatrix} \begin{bmatrix} N_x \\ N_u \end{bmatrix} =
              \begin{bmatrix} 0 \\ I \end{bmatrix}, \qquad N = N_u + K N_x

    Parameters
    ----------
    model : StateSpaceModel
        n states, m inputs.
    K : ndarray, shape (m, n)
    controlled : sequence of int
        q outputs, counted from 0, q <= m.

    Returns
    -------
    ndarray, shape (m, q)
        Of least size where the inputs are more than the outputs. It is exact for this model only.

    Raises
    ------
    InvalidInput
        More outputs than inputs, or a zero at s = 0.

    References
    ----------
    .. [1] G. F. Franklin, J. D. Powell, A. Emami-Naeini, Feedback Control of Dynamic Systems, 6th ed., Pearson 2010,
       section 7.5.
    """
    whole = _steady(model, controlled)
    wanted = np.vstack([np.zeros((model.states, len(controlled))), np.eye(len(controlled))])
    found = np.linalg.lstsq(whole, wanted, rcond=None)[0]
    return np.asarray(found[model.states :] + K @ found[: model.states])


def with_integrators(model: StateSpaceModel, controlled: Sequence[int]) -> tuple[FloatArray, FloatArray]:
    r"""The plant with the integral of each control error as a state more.

    .. math:: \begin{bmatrix} \dot x \\ \dot x_I \end{bmatrix} =
              \begin{bmatrix} A & 0 \\ -C & 0 \end{bmatrix} \begin{bmatrix} x \\ x_I \end{bmatrix} +
              \begin{bmatrix} B \\ -D \end{bmatrix} u + \begin{bmatrix} 0 \\ I \end{bmatrix} r

    Parameters
    ----------
    model : StateSpaceModel
        n states, m inputs.
    controlled : sequence of int
        q outputs, counted from 0, q <= m.

    Returns
    -------
    tuple of ndarray, shapes (n + q, n + q) and (n + q, m)

    Raises
    ------
    InvalidInput
        More outputs than inputs, or a zero at s = 0, which would cancel the integrator.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, Princeton 2008, section 6.4.
    """
    _steady(model, controlled)
    n, m, q = model.states, model.inputs, len(controlled)
    A, B = np.zeros((n + q, n + q)), np.zeros((n + q, m))
    A[:n, :n], B[:n] = model.A, model.B
    A[n:, :n], B[n:] = -model.C[list(controlled)], -model.D[list(controlled)]
    return A, B
