"""Pole placement by output feedback: the controller that gives the closed loop a wanted characteristic polynomial."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from looplab.engine.design.coprimality import SharedRoot, nearest_pair, shared_roots
from looplab.engine.design.diophantine import Diophantine, solve_diophantine
from looplab.engine.design.pade import pade
from looplab.engine.design.pid_form import PIDForm, pid_form
from looplab.engine.errors import ImproperSystem, InvalidInput
from looplab.engine.loop import FeedbackLoop
from looplab.engine.stability import Verdict, closed_loop_poles, closed_loop_verdict
from looplab.engine.stability.closed_loop import verdict_from_poles
from looplab.engine.stability.notions import pole_text
from looplab.engine.stability.polish import polish_few
from looplab.engine.systems.polynomial import ComplexArray, FloatArray, from_roots
from looplab.engine.systems.transfer_function import MAX_ORDER, TransferFunction

Structure = Literal["biproper", "strictly_proper"]
ONE = TransferFunction()
# Above this the answer of Sylvester's matrix is noise, whatever the refinement.
LARGEST_CONDITION = 1e14
# Beyond this the coefficients, rounded to double precision, are of another loop.
LARGEST_RESIDUAL = 1e-8
# |ln(-L)| at a pole that was found.
CONVERGED = 1e-6
# Poles chosen for the caller: damping of the first pair, how much faster it is than the plant and the others than it;
# and how much faster than the fastest pole that was given.
DAMPING, QUICKER, SPREAD, BESIDE = 0.7, 2.0, 3.0, 1.5


@dataclass(frozen=True)
class PolePlacement:
    """A controller, and everything that says how good it is.

    Attributes
    ----------
    C : TransferFunction
        P/L, proper.
    design_plant : TransferFunction
        B/A: the plant that the poles were placed for, without dead time.
    degrees : dict
        n, m, L, P and D: of A, B and the three polynomials of the equation.
    L, P, D : ndarray
        Coefficients, highest power first; L holds the imposed factor.
    residual : float
        Largest coefficient of A L + B P - D over the largest of D, in scaled s [-].
    condition : float
        Of Sylvester's matrix in scaled s [-].
    scale : float
        s was measured in this [rad/time].
    closed_loop_poles : ndarray of complex
        Of the loop with the design plant [rad/time].
    pole_error : float
        Largest distance from a wanted pole to the one it got, relative to its size [-].
    controller_verdict : Verdict
        Whether the controller itself is stable, not the loop.
    static_gain : float or None
        T(0), from the setpoint to y; None with a reason.
    reference_gain : float or None
        1/T(0), what the setpoint is to be multiplied by so that y reaches it.
    pid : PIDForm
    verdict : Verdict
        Of the loop with the plant as it was given, its dead time exact.
    reasons : dict
        Why something is None.
    """

    C: TransferFunction
    design_plant: TransferFunction
    degrees: dict[str, int]
    L: FloatArray
    P: FloatArray
    D: FloatArray
    residual: float
    condition: float
    scale: float
    closed_loop_poles: ComplexArray
    pole_error: float
    controller_verdict: Verdict
    static_gain: float | None
    reference_gain: float | None
    pid: PIDForm
    verdict: Verdict
    reasons: dict[str, str] = field(default_factory=dict)


def required_degree(
    plant: TransferFunction, L_factor: TransferFunction = ONE, structure: Structure = "biproper"
) -> int:
    r"""Number of poles that can always be placed by a controller of least order.

    .. math:: n_d = 2n + f - 1 \text{ (biproper)}, \qquad n_d = 2n + f \text{ (strictly proper)}

    and never fewer than the n + f that are there.

    Parameters
    ----------
    plant : TransferFunction
        Of order n.
    L_factor : TransferFunction
        Its f zeros are poles that the controller shall have.
    structure : {"biproper", "strictly_proper"}

    Returns
    -------
    int

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, lemma 7.1, sec. 7.3.
    """
    n, f = plant.order, int(L_factor.zeros.size)
    return max(2 * n + f - (1 if structure == "biproper" else 0), n + f)


def completed_poles(plant: TransferFunction, given: ComplexArray, required: int) -> ComplexArray:
    """Poles that bring the given ones up to the number required: well damped, and faster than those given.

    Parameters
    ----------
    plant : TransferFunction
        Its poles set the pace where none are given.
    given : ndarray of complex
    required : int

    Returns
    -------
    ndarray of complex
        Empty where enough are given.
    """
    missing = required - given.size
    if missing <= 0:
        return np.zeros(0, dtype=complex)
    out: list[complex] = []
    if given.size:
        pace = BESIDE * float(np.abs(given).max())
    else:
        sizes = np.abs(plant.poles[plant.poles != 0])
        pace = QUICKER * float(np.exp(np.log(sizes).mean())) if sizes.size else 1.0
        if missing >= 2:
            out = [pace * complex(-DAMPING, sign * (1.0 - DAMPING**2) ** 0.5) for sign in (1.0, -1.0)]
            pace *= SPREAD
    out += [complex(-pace * (1.0 + 0.25 * i)) for i in range(missing - len(out))]
    # Figures that a person would type.
    rounded = [complex(float(f"{p.real:.3g}"), float(f"{p.imag:.3g}")) for p in out]
    return np.array(rounded, dtype=complex)


def _without_dead_time(plant: TransferFunction, order: int | None) -> TransferFunction:
    if not plant.theta:
        return plant
    if order is None:
        raise InvalidInput(
            "a plant with dead time has infinitely many closed-loop poles: a finite controller cannot place them all",
            field="plant",
            hint="use a Smith predictor, or design for a Padé approximation of the dead time (pade_order)",
        )
    return plant.without_dead_time() * pade(plant.theta, order)


def _refuse_shared(root: SharedRoot, plant: TransferFunction, factor: TransferFunction) -> InvalidInput:
    if root.root in factor.zeros.tolist():
        return InvalidInput(
            f"the plant has a zero at {root.text}, which is a pole that the controller is to have: they cancel, and "
            "the loop keeps that pole",
            field="L_factor",
            hint="a plant that passes nothing there cannot be held by feedback: leave this factor out",
        )
    reduced = _reduced(plant, root.root)
    if root.stable and root.in_D:
        hint = f"it is stable and among the wanted poles: cancel it first. Design for {reduced}, and leave it out of D"
    elif root.stable:
        hint = f"it is stable: it may be cancelled, and stays in the loop. Design for {reduced}"
    else:
        hint = "it is not stable: no controller on this input and output can move it. Find another actuator or sensor"
    return InvalidInput(
        f"numerator and denominator of the plant share the root {root.text}: that pole cannot be moved",
        field="plant",
        hint=hint,
    )


def _reduced(plant: TransferFunction, root: complex) -> str:
    """Text of the plant without one shared root (and its conjugate)."""
    left = {"zeros": plant.zeros.tolist(), "poles": plant.poles.tolist()}
    for values in left.values():
        for target in {root, root.conjugate()}:
            del values[int(np.argmin(np.abs(np.array(values) - target)))]
    return TransferFunction(left["zeros"], left["poles"], plant.gain).to_text()


def _refuse_condition(plant: TransferFunction, poles: ComplexArray, condition: float) -> InvalidInput:
    if not (plant.zeros.size and poles.size):
        return InvalidInput(
            f"the wanted poles and the plant's are too far apart for double precision (condition {condition:.1e})",
            field="D",
            hint="choose poles nearer to those of the plant, or fewer",
        )
    pole, zero = nearest_pair(poles, plant.zeros)
    return InvalidInput(
        f"numerator and denominator are too nearly not coprime: the pole {pole_text(pole)} lies at the zero "
        f"{pole_text(zero)} (condition {condition:.1e})",
        field="plant",
        hint="cancel the pair first, if it is stable",
    )


def _check_degree(wanted: int, required: int, plant: TransferFunction, f: int, structure: Structure) -> None:
    if required + 1 > MAX_ORDER:
        raise InvalidInput(f"this would need {required} poles, more than {MAX_ORDER}", field="plant")
    if wanted >= required:
        return
    formula = f"2·{plant.order}{f' + {f}' if f else ''}{' - 1' if structure == 'biproper' else ''}"
    raise InvalidInput(
        f"{wanted} poles are given, and this plant needs {required} of them ({formula})",
        field="D",
        hint=f"give {required - wanted} more; extra ones are best some times faster than those that shall be seen",
    )


def _scale(*roots: ComplexArray) -> float:
    sizes = np.abs(np.concatenate(roots))
    sizes = sizes[sizes > 0]
    return float(2.0 ** np.round(np.log2(sizes).mean())) if sizes.size else 1.0


def _pole_error(wanted: ComplexArray, found: ComplexArray) -> float:
    apart = np.abs(wanted[:, None] - found) / np.maximum(np.abs(wanted), 1e-3 * np.abs(wanted).max())[:, None]
    from scipy.optimize import linear_sum_assignment  # late: a server that does not need it is 26 MB smaller

    return float(apart[linear_sum_assignment(apart)].max())


def _placed(loop: FeedbackLoop, wanted: ComplexArray) -> ComplexArray:
    """Poles of the loop: next to the wanted ones, where each is found there; else from the state matrix.

    Where a pole and a zero of the plant nearly cancel, eigenvalues lose all their digits.
    """
    found = polish_few(loop.open_loop, wanted, steps=4)
    with np.errstate(divide="ignore", invalid="ignore"):
        missed = np.abs(np.log(-loop.open_loop(found)))
    single = np.unique(np.round(wanted, 12)).size == wanted.size
    return found if single and (missed < CONVERGED).all() else closed_loop_poles(loop).poles


def _controller(found: Diophantine, factor: TransferFunction) -> TransferFunction:
    try:
        L = TransferFunction.from_polynomials([1.0], found.L)
        P = TransferFunction.from_polynomials(found.P, [1.0])
        return TransferFunction(P.zeros, np.concatenate([L.poles, factor.zeros]), float(found.P[0] / found.L[0]))
    except InvalidInput as error:
        raise InvalidInput(
            f"the controller for these poles leaves double precision: {error.message}",
            field="D",
            hint="choose poles nearer to those of the plant",
        ) from error


def pole_placement(
    plant: TransferFunction,
    poles: ComplexArray,
    L_factor: TransferFunction = ONE,
    structure: Structure = "biproper",
    pade_order: int | None = None,
) -> PolePlacement:
    r"""The controller of least order that gives the loop the wanted poles.

    .. math:: A(s)\,L(s) + B(s)\,P(s) = D(s), \qquad C(s) = \frac{P(s)}{L(s)}

    Parameters
    ----------
    plant : TransferFunction
        B/A, proper.
    poles : ndarray of complex
        Roots of D, closed under conjugation: ``required_degree`` of them, or more [rad/time].
    L_factor : TransferFunction
        Its zeros become poles of the controller: s for integral action, s^2 + w^2 against a sine.
    structure : {"biproper", "strictly_proper"}
        The least number of poles asked for: strictly proper controllers pass less noise and need one pole more.
    pade_order : int or None
        Order of the Padé approximation that the poles are placed for, where the plant has a dead time.

    Returns
    -------
    PolePlacement

    Raises
    ------
    InvalidInput
        Too few poles, a root that numerator and denominator share, a dead time without ``pade_order``, or a plant
        that is zero.
    ImproperSystem
        The plant differentiates, or the only controller does.

    References
    ----------
    .. [1] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, ch. 7.
    .. [2] K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 3rd ed., Prentice Hall 1997, ch. 5.
    """
    given = plant.require_proper("plant")
    plant = _without_dead_time(given, pade_order)
    if not plant.gain:
        raise InvalidInput("the plant is zero: no controller acts on it", field="plant")
    if not plant.order + L_factor.zeros.size:
        raise InvalidInput(
            "the plant is a mere gain: there is no pole to place", field="plant", hint="let the controller integrate"
        )
    wanted = TransferFunction(zeros=poles).zeros
    f = L_factor.zeros.size
    _check_degree(wanted.size, required_degree(plant, L_factor, structure), plant, f, structure)
    all_poles = np.concatenate([plant.poles, L_factor.zeros])
    shared = shared_roots(all_poles, plant.zeros, wanted)
    if shared:
        raise _refuse_shared(shared[0], plant, L_factor)
    scale = _scale(plant.poles, plant.zeros, wanted)
    D = from_roots(wanted)
    found = solve_diophantine(from_roots(all_poles), plant.num, D, scale)
    if not (found.condition < LARGEST_CONDITION and found.residual < LARGEST_RESIDUAL):
        raise _refuse_condition(plant, all_poles, found.condition)
    if found.L.size - 1 < wanted.size - all_poles.size:
        raise ImproperSystem(
            "with these poles the controller would have to differentiate", field="D", hint="give one pole more"
        )
    C = _controller(found, L_factor)
    loop = FeedbackLoop(plant, C)
    placed = _placed(loop, wanted)
    reasons: dict[str, str] = {}
    static = _static_gain(plant, C, reasons)
    return PolePlacement(
        C,
        plant,
        {"n": plant.order, "m": int(plant.zeros.size), "L": C.order, "P": found.P.size - 1, "D": int(wanted.size)},
        np.convolve(from_roots(L_factor.zeros), found.L),
        found.P,
        D,
        found.residual,
        found.condition,
        scale,
        placed,
        _pole_error(wanted, placed),
        verdict_from_poles(C.poles, "pole", "controller"),
        static,
        1.0 / static if static else None,
        pid_form(C),
        closed_loop_verdict(FeedbackLoop(given, C)),
        reasons,
    )


def _static_gain(plant: TransferFunction, C: TransferFunction, reasons: dict[str, str]) -> float | None:
    """T(0) = L(0)/(1 + L(0)), and why it or its inverse is missing."""
    open_loop = C * plant
    if open_loop.gain and open_loop.origin_order > 0:
        return 1.0
    at_rest = open_loop.dc_gain if open_loop.gain else 0.0
    if abs(1.0 + at_rest) < 1e-12:
        reasons["static_gain"] = reasons["reference_gain"] = "undefined: a pole of the loop lies at the origin"
        return None
    if not at_rest:
        reasons["reference_gain"] = "there is none: a constant setpoint does not reach y"
    return at_rest / (1.0 + at_rest)
