"""The Smith predictor: a controller that sees its model's answer before the dead time."""

from __future__ import annotations

from looplab.engine.delays.connections import append, connect, feedback, parallel, series
from looplab.engine.delays.system import DelaySystem
from looplab.engine.systems.transfer_function import TransferFunction


def smith_predictor(controller: TransferFunction, model: TransferFunction) -> DelaySystem:
    r"""The predictor with its model inside, as one controller from e to u.

    .. math:: C_{smith} = \frac{C}{1 + C\,(G_{m0} - G_{m0} e^{-\theta_m s})}

    Where the model is the plant, the dead time leaves the loop: y = C G_m0/(1 + C G_m0) e^{-\theta_m s} r.

    Parameters
    ----------
    controller : TransferFunction
        C, designed for the model without its dead time.
    model : TransferFunction
        G_m with its dead time theta_m [time].

    Returns
    -------
    DelaySystem
        States of the controller and of one model; one delay.

    Raises
    ------
    ImproperSystem, IllPosedLoop

    References
    ----------
    .. [1] O. J. M. Smith, Closer control of loops with dead time, Chem. Eng. Progress 53(5) (1957) 217-219.
    .. [2] J. E. Normey-Rico, E. F. Camacho, Control of Dead-time Processes, Springer 2007, ch. 5.
    """
    C, ahead = (DelaySystem.from_transfer_function(G) for G in (controller, model.without_dead_time()))
    one = DelaySystem.static([[1.0]])
    return feedback(C, series(ahead, parallel(one, one.delayed(model.theta), -1.0)))


def control_loop(plant: DelaySystem, controller: DelaySystem) -> DelaySystem:
    r"""A plant under a controller, for any two systems of one input and output.

    .. math:: y = P (u + d), \qquad u = C (r - y)

    Parameters
    ----------
    plant, controller : DelaySystem
        P and C.

    Returns
    -------
    DelaySystem
        From r and d to y and u.

    Raises
    ------
    IllPosedLoop
        P and C form an algebraic loop of gain -1.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 12.1.
    """
    both = append(plant.require_single(), controller.require_single())
    wires, swap = [[0.0, 1.0], [-1.0, 0.0]], [[0.0, 1.0], [1.0, 0.0]]
    return connect(both, wires, swap, [[1.0, 0.0], [0.0, 1.0]])
