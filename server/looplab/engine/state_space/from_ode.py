"""A linear differential equation, input derivatives included, as a state-space model in companion form."""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.state_space.model import MAX_STATES, StateSpaceModel
from looplab.engine.systems.polynomial import FloatArray, trim
from looplab.engine.systems.transfer_function import LARGEST

Form = Literal["phase", "controllable", "observable"]


def _coefficients(value: npt.ArrayLike, name: str) -> FloatArray:
    c = np.atleast_1d(np.asarray(value, dtype=float))
    if c.ndim != 1 or not c.size or not np.isfinite(c).all():
        raise InvalidInput(f"{name} must be a list of finite numbers, highest derivative first", field=name)
    return trim(c)


def markov_parameters(a: FloatArray, b: FloatArray) -> FloatArray:
    """First n+1 coefficients of b(s)/a(s) in powers of 1/s; a monic and b of n+1 coefficients each."""
    h = np.zeros(a.size)
    for k in range(a.size):
        h[k] = b[k] - a[1 : k + 1] @ h[:k][::-1]
    return h


def from_ode(a: npt.ArrayLike, b: npt.ArrayLike, form: Form = "phase") -> StateSpaceModel:
    r"""State-space model of a linear ordinary differential equation with constant coefficients.

    .. math:: a_n y^{(n)} + \dots + a_1 y' + a_0 y = b_m u^{(m)} + \dots + b_1 u' + b_0 u, \qquad m \le n

    Parameters
    ----------
    a, b : array_like
        Coefficients from the highest derivative down.
    form : {"phase", "controllable", "observable"}
        "phase": the states are y and its derivatives less the part that the input drives directly
        (x1 = y - h0 u, x2 = x1' - h1 u, ...); without input derivatives they are y, y', y'' ...
        "controllable" and "observable" are the canonical forms of those names.

    Returns
    -------
    StateSpaceModel
        One input, one output, n states; A is the companion matrix of a, or its transpose.

    Raises
    ------
    InvalidInput
        A coefficient is not finite, every a is zero, or n exceeds 50.
    ImproperSystem
        m > n: y would hold derivatives of a step.

    References
    ----------
    .. [1] K. Ogata, Modern Control Engineering, 5th ed., Prentice Hall 2010, section 2-5.
    """
    bottom, top = _coefficients(a, "a"), _coefficients(b, "b")
    if not bottom.any():
        raise InvalidInput("every coefficient of y is zero", field="a", hint="give at least one that is not")
    n = bottom.size - 1
    if n > MAX_STATES:
        raise InvalidInput(f"order {n} exceeds the limit of {MAX_STATES}", field="a")
    if top.size > bottom.size:
        raise ImproperSystem(
            f"the highest derivative of u ({top.size - 1}) is above that of y ({n}): the system would differentiate "
            "its input, which no real device does",
            field="b",
            hint="add the lag that the device has",
        )
    with np.errstate(over="ignore", invalid="ignore"):
        top = np.concatenate([np.zeros(n + 1 - top.size), top]) / bottom[0]
        bottom = bottom / bottom[0]
    for c, name in ((bottom, "a"), (top, "b")):
        if not np.abs(c).max() <= LARGEST:
            raise InvalidInput("the coefficients are too far apart", field=name, hint="choose another time unit")
    A = np.eye(n, k=1)
    if n:
        A[-1] = -bottom[:0:-1]
    D = [[top[0]]]
    if form == "phase":
        h = markov_parameters(bottom, top)
        return StateSpaceModel(A, h[1:, None], np.eye(1, n), D)
    rest = (top[1:] - top[0] * bottom[1:])[::-1]
    controllable = StateSpaceModel(A, np.eye(n, 1, k=1 - n), rest[None, :], D)
    return controllable if form == "controllable" else controllable.dual()


def initial_state(model: StateSpaceModel, y: npt.ArrayLike) -> FloatArray:
    """The state at which y, y', y'' ... have given values just before t = 0, where u has been zero.

    Parameters
    ----------
    model : StateSpaceModel
        One output.
    y : array_like
        y(0), y'(0), ... up to n values; those left out are 0.

    Returns
    -------
    ndarray, shape (n,)

    Raises
    ------
    InvalidInput
        More than n values, or the values contradict the model (it has unobservable states).
    """
    values = np.atleast_1d(np.asarray(y, dtype=float))
    n = model.states
    if not np.abs(values).max(initial=0.0) <= LARGEST:
        raise InvalidInput(f"initial values must be finite numbers up to {LARGEST:g}", field="y")
    if values.size > n:
        raise InvalidInput(
            f"{values.size} initial values for a system of order {n}",
            field="y",
            hint="a system of order n has n initial values: y, y', ... up to its derivative n - 1",
        )
    if not n:
        return np.zeros(0)
    # In units of the system's own speed the rows C, CA, CA^2 ... stay of one size.
    speed = np.abs(model.poles).max() or 1.0
    rows = [model.C[0]]
    for _ in range(n - 1):
        rows.append(rows[-1] @ model.A / speed)
    seen = np.array(rows)
    want = np.zeros(n)
    want[: values.size] = values / speed ** np.arange(values.size)
    row_size, column_size = np.abs(seen).max(axis=1), np.abs(seen).max(axis=0)
    row_size, column_size = np.where(row_size, row_size, 1.0), np.where(column_size, column_size, 1.0)
    z, *_ = np.linalg.lstsq(seen / row_size[:, None] / column_size, want / row_size, rcond=None)
    x = z / column_size
    if not np.abs(seen @ x - want).max() <= 1e-8 * max(np.abs(want).max(), 1e-300):
        raise InvalidInput(
            "no state gives these initial values: the system has modes that its output does not show",
            field="y",
            hint="give the initial state itself, or cancel the hidden modes",
        )
    return x
