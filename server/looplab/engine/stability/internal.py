"""Internal stability: the poles of the gang of four after cancellation, and the modes that a cancellation hides."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.stability.cancellation import CANCEL_TOLERANCE, cancel
from looplab.engine.stability.closed_loop import Verdict, closed_loop_poles, closed_loop_verdict
from looplab.engine.stability.notions import POLE_TOLERANCE, pole_text
from looplab.engine.systems.transfer_function import TransferFunction

ComplexArray = npt.NDArray[np.complex128]

# Computed closed-loop poles meet exact zeros to about this fraction of their size.
COMPUTED_TOLERANCE = 1e-7


@dataclass(frozen=True)
class GangMember:
    """One closed-loop transfer function of the four.

    Attributes
    ----------
    poles : ndarray of complex
        After cancellation, rightmost first; with dead time the rightmost of infinitely many [rad/time].
    complete : bool
    stable : bool
        No pole on the imaginary axis or right of it (with dead time by Nyquist's count).
    because : str
    """

    poles: ComplexArray
    complete: bool
    stable: bool
    because: str


@dataclass(frozen=True)
class Cancellation:
    """A zero that cancels a pole in the loop.

    Attributes
    ----------
    root : complex
        Upper one of a pair [rad/time].
    zero_of, pole_of : str
        "plant" or "controller".
    multiplicity : int
    stable : bool
        The hidden mode dies out.
    seen_in : tuple of str
        Which of S, PS, CS, T still have the pole.
    text : str
    """

    root: complex
    zero_of: str
    pole_of: str
    multiplicity: int
    stable: bool
    seen_in: tuple[str, ...]
    text: str


@dataclass(frozen=True)
class InternalStability:
    """The gang of four, what cancels, and whether every signal in the loop stays bounded."""

    S: GangMember
    PS: GangMember
    CS: GangMember
    T: GangMember
    cancellations: tuple[Cancellation, ...]
    internally_stable: bool
    because: str


def _left(p: complex) -> bool:
    return p.real < -POLE_TOLERANCE * abs(p)


def _side(p: complex) -> str:
    if _left(p):
        return "stable"
    return "unstable" if p.real > POLE_TOLERANCE * abs(p) else "undamped"


def _signed(p: complex) -> str:
    text = pole_text(p)
    return f"+{text}" if p.real > POLE_TOLERANCE * abs(p) else text


def _name(roots: ComplexArray, zero_of: str, pole_of: str, seen_in: tuple[str, ...]) -> list[Cancellation]:
    out: list[Cancellation] = []
    rest = [p for p in roots if p.imag >= 0]
    while rest:
        p = complex(rest[0])
        same = [q for q in rest if abs(q - p) <= CANCEL_TOLERANCE * abs(p)]
        rest = [q for q in rest if abs(q - p) > CANCEL_TOLERANCE * abs(p)]
        at = _signed(p)
        s, cancels = ("s", "cancel") if p.imag > 0 or len(same) > 1 else ("", "cancels")
        if zero_of == pole_of:
            who = f"the {zero_of}'s own zero{s} at {at} {cancels} its pole{s} there"
            where = "none of the four transfer functions shows it"
        else:
            who = f"the {zero_of}'s zero{s} at {at} {cancels} the {pole_of}'s pole{s} at {at}"
            where = f"{' and '.join(seen_in)} show{'s' if len(seen_in) == 1 else ''} it, T does not"
        text = f"{who}: a hidden {_side(p)} mode ({where})"
        out.append(Cancellation(p, zero_of, pole_of, len(same), _left(p), seen_in, text))
    return out


def _member(
    zeros: list[ComplexArray], hidden: ComplexArray, moved: ComplexArray, verdict: Verdict, complete: bool
) -> GangMember:
    """One of the four: ``hidden`` poles are exact open-loop roots, ``moved`` ones the computed closed-loop poles."""
    left = np.concatenate(zeros)
    if complete:
        left, moved_left, moved_gone = cancel(left, moved, COMPUTED_TOLERANCE)
    else:
        moved_left, moved_gone = moved, moved[:0]
    _, hidden_left, _ = cancel(left, hidden, CANCEL_TOLERANCE)
    poles = np.concatenate([hidden_left, moved_left])
    poles = poles[np.lexsort((poles.imag, np.round(poles.real, 9)))[::-1]]
    bad = [complex(p) for p in hidden_left if not _left(p)]
    if bad:
        names = " and ".join(dict.fromkeys(_signed(p) for p in bad))
        return GangMember(poles, complete, False, f"the cancelled pole at {names} is still in it")
    if verdict.closed_loop_stable:
        because = "every pole lies in the left half-plane" if poles.size else "it has no poles"
        return GangMember(poles, complete, True, because)
    if moved_gone.size and all(_left(complex(p)) for p in moved_left):
        return GangMember(poles, complete, True, "its own zeros cancel the poles that are not stable")
    return GangMember(poles, complete, False, verdict.because)


@lru_cache(maxsize=64)
def internal_stability(loop: FeedbackLoop) -> InternalStability:
    r"""Poles of the gang of four after cancellation, and the cancellations that hide modes.

    .. math::

        S = \frac{1}{1 + PC}, \quad PS = \frac{P}{1 + PC}, \quad CS = \frac{C}{1 + PC}, \quad T = \frac{PC}{1 + PC}

    With P = N_P/D_P and C = N_C/D_C, what the controller's zeros cancel of D_P leaves S, CS and T but stays in PS;
    what the plant's zeros cancel of D_C leaves S, PS and T but stays in CS. The rest moves to the roots of
    D_P D_C + N_P N_C of the reduced loop.

    Parameters
    ----------
    loop : FeedbackLoop
        Dead time exact: the verdict is then Nyquist's. Actuator, plant and sensor count as one plant.

    Returns
    -------
    InternalStability
        Internally stable: all four are stable, and so is what plant and controller hide within themselves.

    References
    ----------
    .. [1] K. J. Åström, R. M. Murray, Feedback Systems, 2nd ed., Princeton University Press 2021, sec. 12.1.
    """
    P, C = loop.path, loop.C
    zp, pp, own_p = cancel(P.zeros, P.poles)
    zc, pc, own_c = cancel(C.zeros, C.poles)
    zc_left, pp_left, by_controller = cancel(zc, pp)
    zp_left, pc_left, by_plant = cancel(zp, pc)
    reduced = FeedbackLoop(
        TransferFunction(zp_left, pp_left, P.gain, P.theta), TransferFunction(zc_left, pc_left, C.gain, C.theta)
    )
    moved = closed_loop_poles(reduced)
    verdict = closed_loop_verdict(reduced)
    none = np.zeros(0, dtype=complex)

    def member(zeros: list[ComplexArray], hidden: ComplexArray) -> GangMember:
        return _member(zeros, hidden, moved.poles, verdict, moved.complete)

    # What is cancelled reappears as a zero of the function on the other side.
    S = member([pp_left, pc_left], none)
    T = member([zp_left, zc_left], none) if P.gain and C.gain else GangMember(none, True, True, "it is zero")
    PS = member([zp_left, pc_left, by_plant], by_controller) if P.gain else GangMember(none, True, True, "it is zero")
    CS = member([zc_left, pp_left, by_controller], by_plant) if C.gain else GangMember(none, True, True, "it is zero")
    named = [
        *_name(by_controller, "controller", "plant", ("PS",)),
        *_name(by_plant, "plant", "controller", ("CS",)),
        *_name(own_p, "plant", "plant", ()),
        *_name(own_c, "controller", "controller", ()),
    ]
    hidden = [c for c in named if not c.stable]
    stable = verdict.closed_loop_stable and not hidden
    if hidden:
        because = hidden[0].text
    elif stable and named:
        because = "all four transfer functions are stable, and every cancelled mode is"
    else:
        because = "all four transfer functions are stable" if stable else verdict.because
    return InternalStability(S, PS, CS, T, tuple(named), stable, because)
