"""The best settings: within the limits, on them where they bind, and no grid of exact loops finds better ones."""

from itertools import product

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.frequency import margins
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step, step_metrics
from looplab.engine.systems import TransferFunction, parse_transfer_function
from looplab.engine.tuning import optimal_tuning, trade_off


def exact(P: TransferFunction, C: PID, criterion: str, aim: str, horizon: float) -> tuple[float, float, float]:
    """Criterion, Ms and Mt of one loop; infinite where it is not stable."""
    loop = FeedbackLoop(P, C)
    found = margins(loop.open_loop)
    if not found.closed_loop_stable or found.Ms is None or found.Mt is None:
        return np.inf, np.inf, np.inf
    steps = closed_loop_step(loop, horizon, 400)
    response, setpoint = (steps.load, 0.0) if aim == "load" else (steps.setpoint, 1.0)
    return getattr(step_metrics(response, setpoint=setpoint, stable=True), criterion), found.Ms, found.Mt


CASES = [
    ("exp(-s)/(5s+1)", "PI", "IAE", "load", 1.6, None, 60.0),
    ("1/(s+1)^4", "PI", "IAE", "setpoint", 1.6, None, 60.0),
    ("-2/(s+1)^4", "PI", "ITAE", "load", 2.0, 1.1, 80.0),
    ("exp(-s)/s", "PI", "ISE", "load", 1.7, None, 120.0),
    ("1/(s+1)^3", "PID", "IAE", "load", 1.6, None, 40.0),
]


@pytest.mark.parametrize(("text", "type", "criterion", "aim", "Ms", "Mt", "horizon"), CASES)
def test_no_settings_nearby_or_on_a_grid_are_better(text, type, criterion, aim, Ms, Mt, horizon) -> None:
    P = parse_transfer_function(text)
    found = optimal_tuning(P, type, criterion, aim, Ms, Mt)
    C = found.controller
    value, Ms_found, Mt_found = exact(P, C, criterion, aim, horizon)
    assert found.value == pytest.approx(value, rel=2e-3)
    assert (found.Ms, found.Mt) == pytest.approx((Ms_found, Mt_found), rel=1e-12)
    assert Ms_found <= Ms * (1 + 1e-9)
    assert Mt is None or Mt_found <= Mt * (1 + 1e-9)
    assert found.active
    assert found.edges == ()
    gains = np.geomspace(0.6, 1.6, 9)
    times = np.geomspace(0.5, 2.0, 9)
    derivative = np.geomspace(0.6, 1.6, 4) if type == "PID" else [1.0]
    for k, i, d in product(gains, times, derivative):
        other = PID(C.Kc * k, (C.tau_I or 1) * i, C.tau_D and C.tau_D * d, 0.1)
        # Cheap first: most of the grid is outside the limits.
        peaks = margins(other.to_transfer_function() * P)
        if not peaks.closed_loop_stable or (peaks.Ms or 9) > Ms or (Mt is not None and (peaks.Mt or 9) > Mt):
            continue
        assert exact(P, other, criterion, aim, horizon)[0] > value * (1 - 2e-3)


def test_a_limit_that_does_not_bind_is_not_said_to() -> None:
    """The IAE-optimal setpoint response of e^{-s}/(5s+1) needs no more than Ms = 1.8: a limit of 3 is not reached."""
    P = parse_transfer_function("exp(-s)/(5s+1)")
    found = optimal_tuning(P, "PI", "IAE", "setpoint", 3.0)
    assert found.active == ()
    assert found.Ms < 2.0
    value = exact(P, found.controller, "IAE", "setpoint", 60.0)[0]
    for factor in (0.97, 1.03):
        C = PID(found.controller.Kc * factor, found.controller.tau_I)
        assert exact(P, C, "IAE", "setpoint", 60.0)[0] >= value * (1 - 1e-4)


def test_proportional_control_takes_the_largest_gain_allowed() -> None:
    P = parse_transfer_function("1/(s+1)^3")
    found = optimal_tuning(P, "P", Ms=1.6)
    assert found.value is None
    assert "offset" in found.reasons["value"]
    assert found.active == ("Ms",)
    larger = margins(P * (found.controller.Kc * 1.001))
    assert larger.Ms is not None
    assert larger.Ms > 1.6
    on_integrator = optimal_tuning(parse_transfer_function("exp(-s)/s"), "P", "IAE", "setpoint", 1.6)
    assert on_integrator.value is not None
    # No overshoot at this gain: the integral of the error is 1/(Kc K).
    assert on_integrator.value == pytest.approx(
        exact(parse_transfer_function("exp(-s)/s"), on_integrator.controller, "IAE", "setpoint", 60.0)[0], rel=1e-3
    )


@pytest.mark.parametrize(
    ("text", "type", "word"),
    [
        ("1/(s+1)", "PI", "any gain"),
        ("1/(s+1)", "P", "any gain"),
        ("1/(s+1)^2", "PID", "any gain"),
        ("exp(-0.2s)/(s-1)", "PI", "within the limits"),
        ("exp(-2s)/(s-1)", "PID", "within the limits"),
    ],
)
def test_refusals(text: str, type, word: str) -> None:
    with pytest.raises(RuleNotApplicable, match=word):
        optimal_tuning(parse_transfer_function(text), type, Ms=1.6)


def test_limits_are_checked() -> None:
    for Ms, Mt in ((1.0, None), (5.0, None), (1.6, 1.0)):
        with pytest.raises(InvalidInput):
            optimal_tuning(parse_transfer_function("1/(s+1)^3"), "PI", Ms=Ms, Mt=Mt)


def test_an_unstable_plant_can_be_held_with_derivative_action() -> None:
    found = optimal_tuning(parse_transfer_function("exp(-0.2s)/(s-1)"), "PID", Ms=2.0)
    assert margins(
        found.controller.to_transfer_function() * parse_transfer_function("exp(-0.2s)/(s-1)")
    ).closed_loop_stable
    assert found.Ms <= 2.0 * (1 + 1e-9)


def test_more_robustness_costs_more() -> None:
    P = parse_transfer_function("1/(s+1)^4")
    found = trade_off(P, "PI", "IAE", "load", [2.0, 1.3, 1.6])
    assert found.limits == (1.3, 1.6, 2.0)
    values = [result.value for result in found.results if result and result.value]
    assert values == sorted(values, reverse=True)
    assert len(values) == 3
    alone = optimal_tuning(P, "PI", "IAE", "load", 2.0)
    assert values[-1] == pytest.approx(alone.value, rel=1e-3)
    unstable = trade_off(parse_transfer_function("exp(-0.2s)/(s-1)"), "PI", "IAE", "load", [1.2, 3.5])
    assert unstable.results[0] is None
    assert "within the limits" in unstable.reasons["1.2"]
