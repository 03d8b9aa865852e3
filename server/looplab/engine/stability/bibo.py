"""Bounded-input bounded-output stability, and the bounded input that shows it is missing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.stability.cancellation import CANCEL_TOLERANCE, cancel
from looplab.engine.stability.notions import POLE_TOLERANCE, pole_text
from looplab.engine.systems.transfer_function import TransferFunction

ComplexArray = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class BoundedInput:
    """A bounded input that gives an unbounded output: ``u`` as text in t, and how the output grows."""

    name: str
    u: str
    output: str


@dataclass(frozen=True)
class BIBO:
    """Bounded-input bounded-output verdict.

    Attributes
    ----------
    stable : bool
    poles : ndarray of complex
        Of the minimal system: what input and output see [rad/time].
    cancelled : ndarray of complex
        Poles that they do not see.
    because : str
    unbounded : BoundedInput or None
        A bounded input with an unbounded output; None for a stable system.
    """

    stable: bool
    poles: ComplexArray
    cancelled: ComplexArray
    because: str
    unbounded: BoundedInput | None


def _growth(power: int, rest: str) -> str:
    t = "t" if power == 1 else f"t^{power}"
    return f"{t} {rest}".strip()


def _worst_input(poles: ComplexArray) -> BoundedInput:
    near = np.abs(poles.real) <= POLE_TOLERANCE * np.abs(poles)
    right = poles[~near & (poles.real > 0)]
    if right.size:
        p = complex(right[np.argmax(right.real)])
        wave = f" cos({abs(p.imag):.6g} t + phi)" if p.imag else ""
        rate = "" if p.real == 1.0 else f"{p.real:.6g} "
        return BoundedInput("a step", "1", f"exp({rate}t){wave}")
    axis = poles[near]
    times = [int(np.count_nonzero(np.abs(axis - p) <= POLE_TOLERANCE * abs(p))) for p in axis]
    i = int(np.argmax(times))
    if axis[i] == 0:
        return BoundedInput("a step", "1", _growth(times[i], ""))
    w = f"{abs(axis[i].imag):.6g}"
    sine = "sin(t)" if w == "1" else f"sin({w} t)"
    wave = "cos(t + phi)" if w == "1" else f"cos({w} t + phi)"
    return BoundedInput("resonance: a sine at the frequency of the pole", sine, _growth(times[i], wave))


def bibo_from_poles(poles: ComplexArray, cancelled: ComplexArray) -> BIBO:
    """The verdict from the poles that input and output see.

    Parameters
    ----------
    poles, cancelled : ndarray of complex
        Minimal poles, and those left out [rad/time].

    Returns
    -------
    BIBO
    """
    bad = poles[poles.real >= -POLE_TOLERANCE * np.abs(poles)]
    hidden = cancelled[cancelled.real >= -POLE_TOLERANCE * np.abs(cancelled)]
    if bad.size:
        names = " and ".join(dict.fromkeys(pole_text(complex(p)) for p in bad))
        found = _worst_input(bad)
        because = (
            f"not every pole has a negative real part ({names}): "
            f"u = {found.u} gives an output that grows like {found.output}"
        )
        return BIBO(False, poles, cancelled, because, found)
    because = "every pole that input and output see has a negative real part"
    if hidden.size:
        names = " and ".join(dict.fromkeys(pole_text(complex(p)) for p in hidden))
        because += f"; the mode at {names} is cancelled: BIBO stable, but not stable inside"
    return BIBO(True, poles, cancelled, because, None)


def bibo(system: TransferFunction, tolerance: float = CANCEL_TOLERANCE) -> BIBO:
    """Does every bounded input give a bounded output?

    Parameters
    ----------
    system : TransferFunction
        Dead time does not matter.
    tolerance : float
        A zero this near to a pole, relative to its size, cancels it [-].

    Returns
    -------
    BIBO
        Decided by the poles that remain after cancellation. A system with more zeros than poles is not BIBO stable.
    """
    if system.gain == 0.0:
        return bibo_from_poles(np.zeros(0, dtype=complex), np.array(system.poles))
    _, poles, gone = cancel(system.zeros, system.poles, tolerance)
    if not system.is_proper:
        burst = BoundedInput("an ever faster sine", "sin(t^2)", "t cos(t^2)")
        return BIBO(False, poles, gone, "the system differentiates its input: a step gives an impulse", burst)
    return bibo_from_poles(poles, gone)
