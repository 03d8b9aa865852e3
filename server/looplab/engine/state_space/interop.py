"""Models of this engine as objects of python-control, and back. python-control is imported only when asked for."""

from __future__ import annotations

from typing import Any

import numpy as np

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space.model import StateSpaceModel
from looplab.engine.systems.transfer_function import TransferFunction


def to_control(system: TransferFunction | StateSpaceModel) -> Any:
    """The system as a ``control.StateSpace``; a factored system is never expanded into coefficients.

    Parameters
    ----------
    system : TransferFunction or StateSpaceModel

    Returns
    -------
    control.StateSpace

    Raises
    ------
    InvalidInput
        The system has a dead time: python-control has none (its ``pade`` makes an approximation).
    ImproperSystem
        More zeros than poles.
    """
    import control

    if isinstance(system, TransferFunction):
        if system.theta:
            raise InvalidInput(
                "python-control has no dead time",
                field="theta",
                hint="convert without_dead_time() and add control.pade(theta, n), which approximates it",
            )
        system = StateSpaceModel.from_transfer_function(system)
    return control.StateSpace(system.A, system.B, system.C, system.D)


def from_control(system: Any) -> TransferFunction | StateSpaceModel:
    """A continuous-time ``control.TransferFunction`` (one input, one output) or ``control.StateSpace``.

    Parameters
    ----------
    system : control.TransferFunction or control.StateSpace

    Returns
    -------
    TransferFunction or StateSpaceModel
        As the kind that was given.

    Raises
    ------
    InvalidInput
        It is in discrete time, of another kind, or a matrix of transfer functions.
    """
    import control

    if not isinstance(system, control.StateSpace | control.TransferFunction):
        raise InvalidInput(
            f"a {type(system).__name__} cannot be converted", field="system", hint="give control.tf or control.ss"
        )
    if not system.isctime():
        raise InvalidInput("the system is in discrete time", field="system", hint="only continuous time is served")
    if isinstance(system, control.StateSpace):
        return StateSpaceModel(system.A, system.B, system.C, system.D)
    if system.ninputs != 1 or system.noutputs != 1:
        raise InvalidInput(
            "a matrix of transfer functions cannot be converted", field="system", hint="take one entry, or control.ss"
        )
    return TransferFunction.from_polynomials(np.asarray(system.num[0][0]), np.asarray(system.den[0][0]))
