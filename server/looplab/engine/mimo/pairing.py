"""Which input controls which output: every pairing judged by its relative gains and its Niederlinski index."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations

import numpy as np

from looplab.engine.mimo.process import ProcessMatrix
from looplab.engine.mimo.relative_gain import equilibrated, rest_gains, rga_at_rest, rga_number
from looplab.engine.systems.polynomial import FloatArray

NI_ASSUMES = (
    "all entries stable, integral action in every loop, and each loop stable when it is closed alone: then a negative "
    "index means that all loops together are unstable; for two loops a positive one means stability at low gains"
)


@dataclass(frozen=True)
class Pairing:
    """One way to pair; ``inputs[i]`` controls output i.

    ``niederlinski`` is None where it is not defined or says nothing, with ``niederlinski_reason``. ``faults`` are the
    reasons against the pairing, none where it is acceptable.
    """

    inputs: tuple[int, ...]
    relative_gains: tuple[float, ...]
    niederlinski: float | None
    niederlinski_reason: str | None
    rga_number: float
    faults: tuple[str, ...]

    @property
    def acceptable(self) -> bool:
        """Whether nothing speaks against it."""
        return not self.faults

    def written(self) -> str:
        """The pairs as people write them."""
        return ", ".join(f"y{i + 1} with u{j + 1}" for i, j in enumerate(self.inputs))


@dataclass(frozen=True)
class PairingStudy:
    """All pairings, the best first; ``recommended`` is None where something speaks against each of them."""

    rga: FloatArray
    pairings: tuple[Pairing, ...]
    recommended: Pairing | None
    because: str


def niederlinski_index(K: FloatArray, pairing: tuple[int, ...]) -> float | None:
    r"""The Niederlinski index of a pairing.

    .. math:: N = \frac{\det K}{\prod_i k_{ii}}

    Parameters
    ----------
    K : ndarray, shape (n, n)
        Gains at rest [output/input].
    pairing : tuple of int
        Input of each output; K is taken with its columns in this order.

    Returns
    -------
    float or None
        [-]; None where a paired gain is zero. Negative: with integral action in every loop, and each loop stable when
        closed alone, all of them closed are unstable, however they are tuned (entries stable and rational; for n = 2
        the sign decides, for more loops a positive index is necessary only).

    References
    ----------
    .. [1] A. Niederlinski, Automatica 7 (1971) 691-701.
    .. [2] P. Grosdidier, M. Morari, B. R. Holt, Ind. Eng. Chem. Fundam. 24 (1985) 221-235, theorem 5.
    """
    ordered = equilibrated(K)[:, list(pairing)]
    diagonal = np.diagonal(ordered)
    return float(np.linalg.det(ordered) / np.prod(diagonal)) if diagonal.all() else None


def study_pairings(process: ProcessMatrix) -> PairingStudy:
    """Every pairing of a process, and the one to prefer: nothing against it, and the RGA nearest to one on its pairs.

    Raises
    ------
    InvalidInput
        The relative gains at rest are not defined.
    """
    leading, rga = rest_gains(process).leading, rga_at_rest(process)
    judged = [_judge(process, leading, rga, each) for each in permutations(range(process.size))]
    judged.sort(key=lambda each: (not each.acceptable, each.rga_number))
    best = judged[0] if judged[0].acceptable else None
    return PairingStudy(rga, tuple(judged), best, _because(judged[0], best))


def _judge(process: ProcessMatrix, leading: FloatArray, rga: FloatArray, inputs: tuple[int, ...]) -> Pairing:
    gains = tuple(float(rga[i, j]) for i, j in enumerate(inputs))
    faults, reason = [], None
    for i, (j, value) in enumerate(zip(inputs, gains, strict=True)):
        name = f"lambda_{i + 1}{j + 1}"
        if value < -1e-9:
            faults.append(f"{name} = {value:.3g} is negative: the loop's gain changes its sign when the others close")
        elif value <= 1e-9:
            faults.append(f"{name} is zero: u{j + 1} alone does not move y{i + 1}")
    if process.all_stable:
        index = niederlinski_index(leading, inputs)
        if index is None:
            reason = "undefined: a paired gain is zero"
        elif index <= 0:
            faults.append(
                f"the Niederlinski index is {index:.3g}: with integral action all loops together are unstable"
            )
    else:
        index, reason = None, "the theorem is for stable entries: here one integrates or is unstable"
    return Pairing(inputs, gains, index, reason, float(rga_number(rga, inputs)), tuple(faults))


def _because(first: Pairing, best: Pairing | None) -> str:
    if best is None:
        return f"something speaks against every pairing; the least, against {first.written()}: {first.faults[0]}"
    gains = ", ".join(f"{value:.3g}" for value in best.relative_gains)
    index = f", the Niederlinski index {best.niederlinski:.3g} is positive" if best.niederlinski else ""
    return f"{best.written()}: the relative gains {gains} are positive and nearest to 1{index}"
