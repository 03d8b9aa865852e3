"""What a response settles at, or why it does not."""

from __future__ import annotations

from dataclasses import dataclass

from looplab.engine.response.inputs import InputSignal
from looplab.engine.systems.polynomial import ComplexArray


@dataclass(frozen=True)
class FinalValue:
    """The limit of y, or None with the ``reason``."""

    value: float | None
    reason: str | None


def final_value(poles: ComplexArray, dc_gain: float, signal: InputSignal) -> FinalValue:
    """Limit of the response for t to infinity, from any initial state.

    Parameters
    ----------
    poles : ndarray of complex, shape (n,)
        All of them, hidden ones too [rad/time].
    dc_gain : float
        G(0); used only where every mode decays.
    signal : InputSignal

    Returns
    -------
    FinalValue
        G(0) times the input's last value; none where a mode or the input itself does not settle.
    """
    # Within rounding of the axis is on it.
    lasting = [p for p in poles if p.real >= -1e-12 * abs(p)]
    if lasting:
        worst = max(lasting, key=lambda p: (p.real, abs(p.imag)))
        at = f"{0.0 if abs(worst.real) <= 1e-12 * abs(worst) else worst.real:.4g}" + (
            f" ± {abs(worst.imag):.4g}j" if worst.imag else ""
        )
        return FinalValue(None, f"the pole at {at} does not decay")
    a, b = signal.starts[-1]
    if b or (signal.omega and a):
        return FinalValue(None, "the input does not settle")
    return FinalValue(float(dc_gain * a) + 0.0, None)
