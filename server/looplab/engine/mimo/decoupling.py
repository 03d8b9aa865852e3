"""Decouplers: what each controller must do to the other input so that its loop leaves the other output alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.mimo.loops import Decoupling
from looplab.engine.mimo.process import ProcessMatrix
from looplab.engine.mimo.relative_gain import SINGULAR, equilibrated
from looplab.engine.systems.polynomial import ComplexArray
from looplab.engine.systems.transfer_function import TransferFunction

Prediction = Literal["drop", "wait"]
# Relative distance at which a pole and a zero count as one.
SAME = 1e-9
# Filter of an improper element over its fastest lead.
FILTER = 0.1


@dataclass(frozen=True)
class Element:
    """One crossing path of a decoupler.

    Attributes
    ----------
    name : str
        "d12": from controller 2 to the input of loop 1.
    zeros, poles, gain, theta :
        The ideal path; ``theta`` is negative where it would have to know the future [time].
    problems : tuple of str
        Why it cannot be built as it is; none where it can.
    realised : TransferFunction
        What is built instead.
    """

    name: str
    zeros: ComplexArray
    poles: ComplexArray
    gain: float
    theta: float
    problems: tuple[str, ...]
    realised: TransferFunction


@dataclass(frozen=True)
class Decoupler:
    """``matrix[i][k]``: from controller k to the input of loop i, in the order of the loops; ``elements`` say how ideal
    it is. ``exact`` where every crossing effect vanishes at all frequencies."""

    matrix: Decoupling
    elements: tuple[Element, ...]
    exact: bool


def _static(value: float) -> TransferFunction:
    return TransferFunction((), (), value)


def static_decoupler(process: ProcessMatrix) -> Decoupler:
    r"""The decoupler that is right at rest, for any number of loops.

    .. math:: D = G(0)^{-1} \operatorname{diag}(G(0)), \qquad G(0) D = \operatorname{diag}(G(0))

    Each loop keeps the gain of its own entry, so that its settings keep their meaning.

    Parameters
    ----------
    process : ProcessMatrix
        With the loops on the diagonal (``paired``).

    Returns
    -------
    Decoupler
        Gains only.

    Raises
    ------
    InvalidInput
        An entry integrates, or the gains are singular, or a loop's own gain is zero.

    References
    ----------
    .. [1] D. E. Seborg, T. F. Edgar, D. A. Mellichamp, F. J. Doyle, Process Dynamics and Control, 3rd ed., Wiley 2011,
       sec. 18.6.
    """
    K = process.gains()
    if not np.diagonal(K).all():
        raise InvalidInput("a loop's own gain at rest is zero: nothing can be decoupled there", field="decoupler")
    if not abs(np.linalg.det(equilibrated(K))) > SINGULAR:
        raise InvalidInput("the gains at rest are singular: they have no inverse", field="decoupler")
    D = np.linalg.solve(K, np.diag(np.diagonal(K)))
    matrix = tuple(tuple(_static(float(value)) for value in row) for row in D)
    return Decoupler(matrix, (), False)


def _reduced(zeros: list[complex], poles: list[complex]) -> tuple[ComplexArray, ComplexArray]:
    """Zeros and poles less the pairs that are equal."""
    left = list(poles)
    kept = []
    for z in zeros:
        near = min(left, key=lambda p: abs(p - z), default=None)
        if near is not None and abs(near - z) <= SAME * max(abs(near), abs(z)):
            left.remove(near)
        else:
            kept.append(z)
    return np.array(kept, dtype=complex), np.array(left, dtype=complex)


def _realised(
    zeros: ComplexArray, poles: ComplexArray, gain: float, theta: float
) -> tuple[list[str], TransferFunction]:
    """What speaks against an ideal element, and the element without it; its dead time is left to the caller."""
    problems = []
    if theta < 0:
        problems.append(f"it would have to act {-theta:g} before the other controller does (a prediction)")
    unstable = poles[poles.real > 0]
    at_rest = poles[poles == 0].size - zeros[zeros == 0].size
    if at_rest > 0:
        problems.append("it would integrate, and drift away")
    if unstable.size:
        problems.append("a right half-plane zero of the loop's own entry would be a pole of it: it would be unstable")
    if unstable.size or at_rest > 0:
        if at_rest > 0:
            return problems, _static(0.0)
        nonzero = gain * float(np.prod(-zeros).real / np.prod(-poles).real) if not (zeros == 0).any() else 0.0
        return problems, _static(nonzero)
    missing = zeros.size - poles.size
    if missing > 0:
        problems.append(f"it has {missing} more zero{'s' if missing > 1 else ''} than poles: it would differentiate")
        rate = float(np.abs(zeros).max()) / FILTER
        return problems, TransferFunction(zeros, [*poles, *[-rate] * missing], gain * rate**missing)
    return problems, TransferFunction(zeros, poles, gain)


def dynamic_decoupler(process: ProcessMatrix, prediction: Prediction = "drop") -> Decoupler:
    r"""The simplified decoupler of two loops.

    .. math:: D = \begin{bmatrix} 1 & d_{12}\\ d_{21} & 1 \end{bmatrix}, \quad
        d_{12} = -\frac{g_{12}}{g_{11}}, \quad d_{21} = -\frac{g_{21}}{g_{22}}

    The loops then see :math:`g_{11} - g_{12} g_{21}/g_{22}` and :math:`g_{22} - g_{12} g_{21}/g_{11}`.

    Parameters
    ----------
    process : ProcessMatrix
        Two by two, with the loops on the diagonal (``paired``).
    prediction : {"drop", "wait"}
        Where an element would have to know the future: leave its dead time out, or delay the other controller's own
        path by as much, which keeps the decoupling exact and costs that loop the dead time.

    Returns
    -------
    Decoupler
        Realisable: predictions as chosen, a filter at a tenth of the fastest lead where it would differentiate, the
        gain at rest where it would be unstable.

    Raises
    ------
    InvalidInput
        There are not two loops, or a loop's own entry is zero.

    References
    ----------
    .. [1] W. L. Luyben, AIChE J. 16 (1970) 198-203.
    .. [2] E. Gagnon, A. Pomerleau, A. Desbiens, ISA Trans. 37 (1998) 265-276.
    """
    if process.size != 2:
        raise InvalidInput(
            f"the dynamic decoupler is for two loops, not {process.size}",
            field="decoupler",
            hint="use the static one",
        )
    elements: list[Element] = []
    for i in (0, 1):
        k = 1 - i
        own, cross = process.entries[i][i], process.entries[i][k]
        if not own.gain:
            raise InvalidInput(
                f"u{i + 1} alone does not move y{i + 1}: there is no loop to decouple", field="decoupler"
            )
        name = f"d{i + 1}{k + 1}"
        if not cross.gain:
            nothing = np.zeros(0, dtype=complex)
            elements.append(Element(name, nothing, nothing, 0.0, 0.0, (), _static(0.0)))
            continue
        zeros, poles = _reduced([*cross.zeros, *own.poles], [*cross.poles, *own.zeros])
        gain, theta = -cross.gain / own.gain, cross.theta - own.theta
        # Differences of decimals: what is left of them is no dead time.
        theta = 0.0 if abs(theta) < 1e-12 * max(cross.theta, own.theta, 1e-300) else float(f"{theta:.12g}")
        problems, realised = _realised(zeros, poles, gain, theta)
        late = TransferFunction(realised.zeros, realised.poles, realised.gain, max(theta, 0.0))
        elements.append(Element(name, zeros, poles, gain, theta, tuple(problems), late))
    # Controller k waits as long as the element that it drives would have to be early.
    waits = [0.0, 0.0]
    if prediction == "wait":
        waits = [max(0.0, -elements[1].theta), max(0.0, -elements[0].theta)]
    matrix = tuple(
        tuple(TransferFunction((), (), 1.0, waits[k]) if i == k else _moved(elements[i], waits[k]) for k in (0, 1))
        for i in (0, 1)
    )
    exact = all(len(each.problems) == (prediction == "wait" and each.theta < 0) for each in elements)
    return Decoupler(matrix, tuple(elements), exact)


def _moved(element: Element, wait: float) -> TransferFunction:
    """The element in a path whose controller waits."""
    G = element.realised
    return TransferFunction(G.zeros, G.poles, G.gain, max(0.0, element.theta + wait)) if G.gain else G
