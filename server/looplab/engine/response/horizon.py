"""How long a response is worth looking at."""

from __future__ import annotations

import numpy as np

from looplab.engine.response.inputs import InputSignal
from looplab.engine.systems.polynomial import ComplexArray


def response_horizon(poles: ComplexArray, signal: InputSignal, theta: float = 0.0) -> float:
    """A horizon that shows the response whole, rounded up to two digits [time].

    Parameters
    ----------
    poles : ndarray of complex, shape (n,)
        [rad/time]
    signal : InputSignal
    theta : float
        Dead time [time].

    Returns
    -------
    float
        After the last change of the input and the dead time: eight time constants of the slowest mode (three of a
        growing one), at least eight periods of a sine or of a lasting oscillation.
    """
    spans = [10.0 / abs(p) if p.real == 0 else (8.0 if p.real < 0 else 3.0) / abs(p.real) for p in poles if p != 0]
    spans = [min(s, 400.0 / abs(p)) for s, p in zip(spans, poles[poles != 0], strict=True)]
    lasting = [abs(p) for p in poles if p != 0 and abs(p.real) < 1e-3 * abs(p)]
    spans += [16.0 * np.pi / w for w in [*lasting, signal.omega] if w]
    past = float(signal.times[-1])
    want = (max(spans) if spans else max(10.0 * theta, 0.5 * past)) or 10.0
    want = min(max(want + past + theta, 1e-9), 1e9)
    power = 10.0 ** (np.floor(np.log10(want)) - 1)
    return float(f"{np.ceil(want / power - 1e-9) * power:.6g}")
