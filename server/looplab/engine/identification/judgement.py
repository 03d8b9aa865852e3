"""How far an identified model may be trusted: fit, and what the data warn of."""

from __future__ import annotations

import math

import numpy as np

from looplab.engine.identification.record import Record, input_changes
from looplab.engine.identification.result import Fitted
from looplab.engine.systems.integrating import IPDT
from looplab.engine.systems.polynomial import FloatArray

_SMALLEST_RATIO = 10.0
_WIDE = 0.5
_FLAT_SAMPLES = 5
_CORNER = 0.2


def fit_percent(y: FloatArray, y_hat: FloatArray) -> float | None:
    r"""How much of the output's variation a model explains.

    .. math:: 100\,\Bigl(1 - \frac{\lVert y - \hat y\rVert}{\lVert y - \bar y\rVert}\Bigr)

    Parameters
    ----------
    y, y_hat : ndarray, shape (n,)

    Returns
    -------
    float or None
        100 is perfect, 0 no better than the mean, negative worse; None where y does not vary [%].

    References
    ----------
    .. [1] L. Ljung, System Identification, 2nd ed., Prentice Hall 1999, sec. 16.4 (normalised root mean square error).
    """
    spread = float(np.linalg.norm(y - y.mean()))
    return 100.0 * (1.0 - float(np.linalg.norm(y - y_hat)) / spread) if spread else None


def warnings(record: Record, fitted: Fitted, residuals: FloatArray) -> tuple[str, ...]:
    """What speaks against a model: of the data, and of the estimate."""
    out = [*record.notes, *fitted.notes]
    y, r = record.y[record.seen], residuals[record.seen]
    sigma = float(np.sqrt(np.mean(r**2)))
    moved = abs(fitted.model.K) * record.swing
    if isinstance(fitted.model, IPDT):
        moved = float(np.ptp(y))
    if sigma * _SMALLEST_RATIO > moved:
        out.append(
            f"what the input moves is only {moved / sigma:.1f} times the residuals: "
            "a larger step, or less noise, is needed"
        )
    out += _length(record, fitted)
    if _runs_flat(y):
        out.append("the output runs into a flat end, as where a sensor or valve is at its limit: saturation suspected")
    if fitted.intervals is not None:
        values = vars(fitted.model)
        wide = [name for name, (low, high) in fitted.intervals.items() if high - low > 2 * _WIDE * abs(values[name])]
        # A dead time may well be none: its interval is judged against the time constants.
        tau = values.get("tau") or record.span
        low, high = fitted.intervals["theta"]
        wide = [name for name in wide if name != "theta" or high - low > _WIDE * tau]
        if wide:
            out.append(
                f"{' and '.join(wide)} can hardly be told from these data: the interval is wider than half the value"
            )
        if _coloured(r, float(np.ptp(y))):
            out.append(
                "the residuals follow one another: the structure is too simple or the noise is coloured, and the "
                "intervals are too narrow"
            )
    return tuple(dict.fromkeys(out))


def _length(record: Record, fitted: Fitted) -> list[str]:
    if isinstance(fitted.model, IPDT):
        return []
    change = np.flatnonzero(input_changes(record)[1:])
    last = float(record.t[change[-1] + 1]) if change.size else float(record.t[0])
    first = (
        float(record.t[0])
        if record.u[0] != record.u_before
        else (float(record.t[change[0] + 1]) if change.size else last)
    )
    zeta = getattr(fitted.model, "zeta", 1.0)
    settle = fitted.model.theta + 3.0 * fitted.model.tau * max(zeta, 0.5)
    # An input that keeps moving shows the dynamics all along; it is the whole of it that must be long enough.
    followed = float(record.t[-1]) - (last if change.size <= 2 else first)
    if followed < settle:
        return [
            f"the record is too short: it follows the input's change for {followed:.3g}, theta + 3 tau is {settle:.3g}"
        ]
    return []


def _runs_flat(y: FloatArray) -> bool:
    """Whether y stays exactly at its highest or lowest value, and got there with a corner."""
    fastest = float(np.abs(np.diff(y)).max())
    for edge in (float(y.max()), float(y.min())):
        at = y == edge
        run = best = start = 0
        for k, flat in enumerate(at.tolist()):
            run = run + 1 if flat else 0
            if run > best:
                best, start = run, k - run + 1
        if best >= max(_FLAT_SAMPLES, math.ceil(0.05 * y.size)) and start > 1:
            approach = abs(float(y[start] - y[start - 1])), abs(float(y[start - 1] - y[start - 2]))
            if min(approach[1], approach[0] + approach[1]) > _CORNER * fastest:
                return True
    return False


def _coloured(r: FloatArray, span: float) -> bool:
    """Whether neighbours are correlated, by the lag-one correlation beyond three of its deviations."""
    if float(np.abs(r).max()) < 1e-6 * span or r.size < 20:
        return False
    r = r - r.mean()
    return float(r[1:] @ r[:-1]) > 3.0 / math.sqrt(r.size) * float(r @ r)
