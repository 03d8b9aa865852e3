"""Controllers beside each other on one plant, which need not be the model they were tuned on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from looplab.engine.frequency import Margins, margins
from looplab.engine.loop import PID, ClosedLoopStep, FeedbackLoop, Response, StepMetrics, closed_loop_step, step_metrics
from looplab.engine.loop import default_horizon as _loop_horizon
from looplab.engine.loop.metrics import NUMBERS
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class ComparedLoop:
    """One controller on the plant: robustness, both steps with their metrics, and the responses.

    ``margins.closed_loop_stable`` is the verdict; an unstable loop has no metrics, with the reason.
    """

    controller: PID
    margins: Margins
    setpoint: StepMetrics
    load: StepMetrics
    steps: ClosedLoopStep


def plant_horizon(plant: TransferFunction) -> float:
    """A horizon that suits a plant, whatever the controller [time]."""
    return _loop_horizon(FeedbackLoop(plant, PID(0.0)))


def judge_step(response: Response, *, setpoint: float, stable: bool) -> StepMetrics:
    """step_metrics, or none of them where the response of a stable loop leaves what can be computed.

    Parameters
    ----------
    response : Response
    setpoint : float
        1 for a setpoint step, 0 for a load step [output].
    stable : bool

    Returns
    -------
    StepMetrics
    """
    if stable and response.truncated_at is not None:
        reason = "undefined: y or u leaves +-1e9; choose units in which they are moderate"
        return StepMetrics(reasons=dict.fromkeys(NUMBERS, reason))
    return step_metrics(response, setpoint=setpoint, stable=stable)


def compare(
    plant: TransferFunction, controllers: Sequence[PID], horizon: float, points: int = 400
) -> tuple[ComparedLoop, ...]:
    """Judge each controller on the plant, exactly as the loop's own analysis does.

    Parameters
    ----------
    plant : TransferFunction
        Proper, dead time exact: the true plant, mismatch and all.
    controllers : sequence of PID
    horizon : float
        Common length of the responses; the integrals of the error run over it [time].
    points : int
        Samples wanted of each response, 20 to 5000.

    Returns
    -------
    tuple of ComparedLoop
        In the order given.

    Raises
    ------
    ImproperSystem, IllPosedLoop, InvalidInput, NoConvergence
        As the loop itself.
    """
    out = []
    for controller in controllers:
        loop = FeedbackLoop(plant, controller)
        found = margins(loop.open_loop)
        steps = closed_loop_step(loop, horizon, points)
        stable = found.closed_loop_stable
        out.append(
            ComparedLoop(
                controller,
                found,
                judge_step(steps.setpoint, setpoint=1.0, stable=stable),
                judge_step(steps.load, setpoint=0.0, stable=stable),
                steps,
            )
        )
    return tuple(out)
