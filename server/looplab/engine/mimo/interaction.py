"""What a loop sees when the other loops close: its effective process, the gain and the margins that are left."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.delays import DelaySystem, delay_margins, delay_verdict, minimal_delay_system, series
from looplab.engine.delays.resolvent import transfer_matrix
from looplab.engine.delays.structure import channel
from looplab.engine.errors import EngineError
from looplab.engine.frequency.margins import Margins, margins
from looplab.engine.mimo.loops import MultiLoop
from looplab.engine.mimo.relative_gain import rga_at_rest
from looplab.engine.stability.closed_loop import Verdict
from looplab.engine.systems.polynomial import ComplexArray, FloatArray


@dataclass(frozen=True)
class Interaction:
    """One loop with the others open and closed.

    Attributes
    ----------
    own, effective : ndarray, shape (N,)
        Frequency response from the loop's controller to its output, the others in manual and as they are closed.
    own_gain, effective_gain : float or None
        The same at rest; None with a reason where it is not defined.
    relative_gain : float or None
        lambda of the pair: own gain over effective gain where the others act perfectly at rest.
    own_margins, effective_margins : Margins or None
        Of the loop's open loop; ``closed_loop_stable`` is that of the whole.
    others : Verdict or None
        Whether the other loops are stable while this one is in manual.
    reasons : dict of str
    """

    omega: FloatArray
    own: ComplexArray
    effective: ComplexArray
    own_gain: float | None
    effective_gain: float | None
    relative_gain: float | None
    own_margins: Margins | None
    effective_margins: Margins | None
    others: Verdict | None
    reasons: dict[str, str]


def effective_process(loops: MultiLoop, loop: int) -> DelaySystem:
    r"""The process that a loop's controller sees while the other loops stay as they are.

    .. math:: g_{11}^{eff} = g_{11} - \frac{g_{12}\, C_2\, g_{21}}{1 + C_2\, g_{22}} \quad (n = 2)

    Parameters
    ----------
    loops : MultiLoop
    loop : int
        Output whose controller is taken out.

    Returns
    -------
    DelaySystem
        From that controller's output to y, one input and one output.

    Raises
    ------
    IllPosedLoop

    References
    ----------
    .. [1] D. E. Seborg, T. F. Edgar, D. A. Mellichamp, F. J. Doyle, Process Dynamics and Control, 3rd ed., Wiley 2011,
       sec. 18.1.
    """
    n = loops.process.size
    found = channel(loops.with_loop(loop, False).system, [2 * n + loop], [loop])
    return found if loops.process.all_stable else minimal_delay_system(found).system


def _at_rest(system: DelaySystem) -> float | None:
    value = float(transfer_matrix(system, 0.0)[0, 0, 0].real)
    return value if np.isfinite(value) else None


def interaction(loops: MultiLoop, loop: int, omega: FloatArray) -> Interaction:
    r"""A loop with the others open and as they are.

    .. math:: \lambda_{11} = \frac{g_{11}(0)}{g_{11}^{eff}(0)} \quad\text{with integral action in the other loops}

    Parameters
    ----------
    loops : MultiLoop
        The loop itself counts as closed.
    loop : int
        Its output.
    omega : ndarray, shape (N,)
        [rad/time]

    Returns
    -------
    Interaction

    Raises
    ------
    IllPosedLoop

    References
    ----------
    .. [1] E. H. Bristol, IEEE Trans. Automatic Control 11 (1966) 133-134.
    """
    reasons: dict[str, str] = {}
    C = loops.controllers[loop].to_transfer_function()
    alone = effective_process(loops.with_others(loop, False), loop)
    seen = effective_process(loops, loop)
    own_margins = effective_margins = None
    try:
        own = loops.process.entries[loop][loops.pairing[loop]]
        if loops.decoupler is None:
            own_margins = margins(C * own)
        else:
            own_margins = delay_margins(series(DelaySystem.from_transfer_function(C), alone))
    except EngineError as error:
        reasons["own_margins"] = error.message
    try:
        effective_margins = delay_margins(series(DelaySystem.from_transfer_function(C), seen))
    except EngineError as error:
        reasons["effective_margins"] = error.message
    gains = {"own_gain": _at_rest(alone), "effective_gain": _at_rest(seen)}
    for name, value in gains.items():
        if value is None:
            reasons[name] = "infinite: the path integrates"
    relative = None
    try:
        relative = float(rga_at_rest(loops.process)[loop, loops.pairing[loop]])
    except EngineError as error:
        reasons["relative_gain"] = error.message
    others = None
    try:
        others = delay_verdict(seen)
    except EngineError as error:
        reasons["others"] = error.message
    s = 1j * omega
    return Interaction(
        omega,
        transfer_matrix(alone, s)[:, 0, 0],
        transfer_matrix(seen, s)[:, 0, 0],
        gains["own_gain"],
        gains["effective_gain"],
        relative,
        own_margins,
        effective_margins,
        others,
        reasons,
    )
