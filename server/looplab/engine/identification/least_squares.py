"""Low-order models by least squares: linear parameters in closed form, the others by search (variable projection)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.identification.exact_response import LowOrder, RecordedInput, free_response
from looplab.engine.identification.intervals import confidence_intervals
from looplab.engine.identification.levenberg_marquardt import central_jacobian, levenberg_marquardt
from looplab.engine.identification.record import Record
from looplab.engine.identification.result import Fitted
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.integrating import IPDT
from looplab.engine.systems.polynomial import FloatArray

Structure = Literal["FOPDT", "SOPDT", "IPDT"]
_ZETAS = (0.1, 0.3, 0.6, 1.0, 1.6, 3.0)
_ZETA_RANGE = (0.005, 30.0)
_STARTS = 3
_GRID_SAMPLES = 400
_FIRST_STEPS = 12
_PARAMETERS = {"FOPDT": ("tau", "theta"), "SOPDT": ("tau", "zeta", "theta"), "IPDT": ("theta",)}


@dataclass(frozen=True)
class Unknowns:
    """What is estimated beside the model and the level.

    Attributes
    ----------
    free_start : bool
        The plant need not be at rest when the record begins: its states there are estimated too.
    drift : bool
        A straight line is added to the output; of an integrating plant, what an unbalanced input does.
    """

    free_start: bool = False
    drift: bool = False


class _Problem:
    """y = K g(t; tau, zeta, theta) + level + drift + free response; v are the nonlinear ones, scaled."""

    def __init__(self, record: Record, structure: Structure, unknowns: Unknowns) -> None:
        self.structure, self.unknowns = structure, unknowns
        self.input = RecordedInput(record)
        seen = record.seen
        self.t, self.y = record.t[seen], record.y[seen]
        self.t0, self.span = float(record.t[0]), record.span
        first = self.input.knots[int(np.argmax((self.input.a != 0) | (self.input.b != 0)))]
        self.longest = max(float(self.t[-1] - first), 0.0)
        # The output is of the order of 1 in the sums, whatever its unit.
        self.size = float(np.ptp(self.y))

    def shape(self, v: FloatArray) -> tuple[float, ...]:
        """(), (tau,) or (tau, zeta) of scaled parameters."""
        return tuple(np.exp(v[:-1]).tolist())

    def rest(self, shape: tuple[float, ...], t: FloatArray) -> list[FloatArray]:
        """Columns beside the response itself."""
        columns = [np.ones(t.size)]
        if self.unknowns.drift:
            columns.append((t - self.t0) / self.span)
        if self.unknowns.free_start:
            columns += free_response(shape, t - self.t0)
        return columns

    def columns(self, v: FloatArray) -> FloatArray:
        """All columns at the samples, shape (n, linear parameters)."""
        shape = self.shape(v)
        g = self.input.response(shape, float(v[-1]) * self.span, self.t)
        return np.stack([g, *self.rest(shape, self.t)], axis=1)

    def linear(self, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Best linear parameters and the residual, for given others."""
        columns = self.columns(v)
        c = np.asarray(np.linalg.lstsq(columns, self.y, rcond=None)[0], dtype=float)
        return c, self.y - columns @ c

    def residual(self, v: FloatArray) -> FloatArray:
        """Relative to the range of y, shape (n,)."""
        return self.linear(v)[1] / self.size

    def thinned(self) -> _Problem:
        """The same with fewer samples of y, for the first steps of the search."""
        every = max(1, self.t.size // _GRID_SAMPLES)
        out = copy(self)
        out.t, out.y = self.t[::every], self.y[::every]
        return out

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Of the scaled parameters."""
        fast = math.log(1e-2 * float(np.diff(self.t).min()))
        low, high = {"IPDT": ([], []), "FOPDT": ([fast], [math.log(100.0 * self.span)])}.get(
            self.structure,
            ([fast, math.log(_ZETA_RANGE[0])], [math.log(100.0 * self.span), math.log(_ZETA_RANGE[1])]),
        )
        return np.array([*low, 0.0]), np.array([*high, 0.98 * self.longest / self.span])

    def starts(self) -> list[FloatArray]:
        """The best points of a grid, no two of them neighbours."""
        t, y = self.t, self.y / self.size
        thetas = 0.95 * self.longest * np.linspace(0.0, 1.0, 48) ** 1.5
        shortest = max(0.2 * self.span / self.t.size, 1e-4 * self.span)
        taus = np.geomspace(shortest, 5.0 * self.span, 20 if self.structure == "FOPDT" else 14)
        shapes: list[tuple[float, ...]] = [()]
        if self.structure == "FOPDT":
            shapes = [(tau,) for tau in taus.tolist()]
        elif self.structure == "SOPDT":
            shapes = list(product(taus.tolist(), _ZETAS))
            thetas = thetas[::2]
        times = np.repeat(t[None], thetas.size, axis=0) - thetas[:, None]
        cost = np.empty((len(shapes), thetas.size))
        for i, shape in enumerate(shapes):
            Q = np.linalg.qr(np.stack(self.rest(shape, t), axis=1))[0]
            g = self.input.response(shape, 0.0, times.ravel()).reshape(times.shape)
            g = g - (g @ Q) @ Q.T
            left = y - Q @ (Q.T @ y)
            size = np.maximum(np.einsum("ij,ij->i", g, g), 1e-300)
            cost[i] = left @ left - (g @ left) ** 2 / size
        out: list[FloatArray] = []
        taken: list[tuple[float, ...]] = []
        for flat in np.argsort(cost, axis=None):
            i, j = divmod(int(flat), thetas.size)
            place = (*np.log(shapes[i]).tolist(), 4.0 * float(thetas[j]) / self.span)
            if all(max(abs(a - b) for a, b in zip(place, other, strict=True)) > 0.7 for other in taken):
                taken.append(place)
                out.append(np.array([*np.log(shapes[i]), thetas[j] / self.span]))
            if len(out) == _STARTS:
                break
        return out


def least_squares(record: Record, structure: Structure, unknowns: Unknowns | None = None) -> Fitted:
    r"""Model, level and, where asked for, drift and initial state, with the least sum of squared residuals.

    .. math::

        \min_{K, y_0, d, x_0, \tau, \zeta, \theta} \sum_j \bigl(y_j - y_0 - d\,(t_j - t_0) - x_0(t_j)
        - K\,g(t_j; \tau, \zeta, \theta)\bigr)^2

    g answers the recorded input exactly, whatever it is and however it was sampled. The linear parameters are solved
    for at each step; tau, zeta and theta start from a grid and are refined from its best points.

    Parameters
    ----------
    record : Record
    structure : {"FOPDT", "SOPDT", "IPDT"}
    unknowns : Unknowns or None
        None: at rest before the record, and no drift.

    Returns
    -------
    Fitted
        With 95 % confidence intervals of the model's parameters, linearised about the estimate: for independent normal
        noise of one size, and a structure that is the plant's.

    Raises
    ------
    RuleNotApplicable
        The output does not vary, or there are fewer samples than unknowns.

    References
    ----------
    .. [1] G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413-432 (variable projection).
    .. [2] L. Ljung, System Identification, 2nd ed., Prentice Hall 1999, ch. 9 (asymptotic covariance).
    """
    problem = _Problem(record, structure, unknowns or Unknowns())
    if not problem.size:
        raise RuleNotApplicable("the output does not vary", field="y")
    low, high = problem.bounds()
    coarse = problem.thinned()
    first = [levenberg_marquardt(coarse.residual, v, low, high, _FIRST_STEPS) for v in coarse.starts()]
    best = min(first, key=lambda fit: fit[1])[0]
    v = levenberg_marquardt(problem.residual, best, low, high)[0]
    c, residual = problem.linear(v)
    K, theta = float(c[0]), float(v[-1]) * problem.span
    if not K or not math.isfinite(K):
        raise RuleNotApplicable("the output does not answer to the input", field="y")
    shape = problem.shape(v)
    names = ("K", *_PARAMETERS[structure])
    count = c.size + v.size
    if residual.size <= count:
        raise RuleNotApplicable(f"{residual.size} samples are too few for {count} unknowns", field="y")
    model = _model(structure, K, shape, theta)
    order = [0, *range(c.size, count)]
    scales = np.array([1.0, *shape, problem.span])
    intervals = confidence_intervals(np.array([K, *shape, theta]), scales, _jacobian(problem, v, c), order, residual)
    columns = problem.rest(shape, record.t)
    extra = sum((k * column for k, column in zip(c[2:], columns[1:], strict=True)), np.zeros(record.t.size))
    estimated = {"y0": float(c[1])}
    if problem.unknowns.drift:
        estimated["drift"] = float(c[2]) / problem.span
    return Fitted(
        model,
        float(c[1]),
        extra,
        dict(zip(names, intervals, strict=True)),
        notes=_edges(structure, v, low, high),
        estimated=estimated,
    )


def _jacobian(problem: _Problem, v: FloatArray, c: FloatArray) -> FloatArray:
    """Of the model's output after all parameters, the linear ones first, shape (n, all)."""
    return np.hstack([problem.columns(v), central_jacobian(lambda w: problem.columns(w) @ c, v)])


def _model(structure: Structure, K: float, shape: Sequence[float], theta: float) -> LowOrder:
    if structure == "FOPDT":
        return FOPDT(K, shape[0], theta)
    return SOPDT(K, shape[0], shape[1], theta) if structure == "SOPDT" else IPDT(K, theta)


def _edges(structure: Structure, v: FloatArray, low: FloatArray, high: FloatArray) -> tuple[str, ...]:
    """Parameters that ended where the search ends; no dead time is an answer, not an edge."""
    found = []
    for k, name in enumerate(_PARAMETERS[structure]):
        if v[k] >= high[k] - 1e-9 or (v[k] <= low[k] + 1e-9 and name != "theta"):
            found.append(f"{name} ended on the edge of what was searched: the record does not determine it")
    return tuple(found)
