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
        growing one) and one and a half times what the others delay it, at least eight periods of a sine or of a
        lasting oscillation.
    """
    # Many equal lags answer late: each delays the step by Re(-1/p), its time constant where p is real.
    delays = [-(1.0 / complex(p)).real for p in poles if p.real < 0]
    late = 1.5 * (sum(delays) - max(delays, default=0.0))

    def span(p: complex) -> float:
        if p.real == 0:
            return 10.0 / abs(p)
        own = min((8.0 if p.real < 0 else 3.0) / abs(p.real), 400.0 / abs(p))
        return own + late if p.real < 0 else own

    spans = [span(complex(p)) for p in poles if p != 0]
    lasting = [abs(p) for p in poles if p != 0 and abs(p.real) < 1e-3 * abs(p)]
    spans += [16.0 * np.pi / w for w in [*lasting, signal.omega] if w]
    past = float(signal.times[-1])
    want = (max(spans) if spans else max(10.0 * theta, 0.5 * past)) or 10.0
    want = min(max(want + past + theta, 1e-9), 1e9)
    power = 10.0 ** (np.floor(np.log10(want)) - 1)
    return float(f"{np.ceil(want / power - 1e-9) * power:.6g}")
