"""The plane of PI settings against the exact loop at its nodes; the spread of plants against its own definition."""

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.frequency import margins
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step, step_metrics
from looplab.engine.stability import pi_gain_ranges
from looplab.engine.systems import FOPDT, parse_transfer_function
from looplab.engine.tuning import gain_map, perturbed_plant, sensitivity


@pytest.mark.parametrize("text", ["exp(-s)/(5s+1)", "-2/(s+1)^3", "exp(-s)/s", "exp(-0.2s)/(s-1)"])
@pytest.mark.parametrize("aim", ["load", "setpoint"])
def test_nodes_are_those_of_the_exact_loop(text: str, aim) -> None:
    P = parse_transfer_function(text)
    found = gain_map(P, points=(7, 6), aim=aim)
    assert np.isfinite(found.Ms).any()
    assert not np.isfinite(found.Ms).all()
    for row, tau_I in enumerate(found.tau_I.tolist()):
        ranges = pi_gain_ranges(P, tau_I, negative=True)
        for column, Kc in enumerate(found.Kc.tolist()):
            Ms, value = found.Ms[row, column], found.value[row, column]
            assert np.isfinite(Ms) == (Kc in ranges)
            if not np.isfinite(Ms) or Ms > 5:
                continue
            loop = FeedbackLoop(P, PID(Kc, tau_I))
            assert margins(loop.open_loop).Ms == pytest.approx(Ms, rel=0.01)
            if np.isfinite(value) and row % 2 == column % 2:
                steps = closed_loop_step(loop, 40 * np.sqrt(tau_I + 4), 1500)
                response, setpoint = (steps.load, 0.0) if aim == "load" else (steps.setpoint, 1.0)
                e = abs(response.y[-1] - setpoint)
                if e < 1e-6:
                    IAE = step_metrics(response, setpoint=setpoint, stable=True).IAE
                    assert pytest.approx(value, rel=0.02) == IAE


@pytest.mark.parametrize("text", ["exp(-s)/(5s+1)", "1/(s+1)^4", "exp(-0.2s)/(s-1)"])
def test_the_boundary_has_poles_on_the_imaginary_axis(text: str) -> None:
    P = parse_transfer_function(text)
    found = gain_map(P, points=(4, 4))
    on = np.isfinite(found.boundary_Kc)
    assert on.sum() > 50
    for Kc, tau_I in zip(found.boundary_Kc[on][::40], found.boundary_tau_I[on][::40], strict=True):
        ends = [e.K for r in pi_gain_ranges(P, float(tau_I), negative=True).ranges for e in (r.low, r.high)]
        assert min(abs(e / Kc - 1) for e in ends if e) < 1e-9


def test_a_map_of_a_loop_without_boundary_needs_a_window() -> None:
    P = parse_transfer_function("1/(s+1)")
    with pytest.raises(RuleNotApplicable, match="no boundary"):
        gain_map(P)
    found = gain_map(P, (0.1, 10.0), (0.5, 5.0), (4, 4))
    assert np.isfinite(found.Ms).all()
    for bad in (dict(Kc_range=(1.0, 0.5)), dict(tau_I_range=(0.0, 1.0)), dict(points=(3, 8))):
        with pytest.raises(InvalidInput):
            gain_map(parse_transfer_function("1/(s+1)^3"), **bad)


def test_factors_of_a_first_order_plant_are_those_of_its_parameters() -> None:
    P = FOPDT(2.0, 5.0, 1.0).to_transfer_function()
    s = 0.2 + 0.7j
    for K, tau, theta in ((0.8, 1.2, 1.0), (1.1, 0.7, 1.5)):
        assert perturbed_plant(P, K, tau, theta)(s) == pytest.approx(
            FOPDT(2.0 * K, 5.0 * tau, theta).to_transfer_function()(s)
        )
    slope = perturbed_plant(parse_transfer_function("2/(s(3s+1))"), 1.5, 2.0, 1.0)
    assert slope(s) == pytest.approx(3.0 / (s * (6 * s + 1)))


def test_the_spread_tells_its_worst_case() -> None:
    P = FOPDT(1.0, 5.0, 1.0).to_transfer_function()
    C = PID(2.5, 5.0)
    found = sensitivity(P, C, 20.0, 40.0, 200)
    assert len(found.cases) == 9
    assert found.unstable == ()
    assert found.worst_Ms is not None
    assert found.setpoint is not None
    # Most gain, least lag and most dead time is worst for the margins.
    assert (found.worst_Ms.K, found.worst_Ms.tau, found.worst_Ms.theta) == pytest.approx((1.2, 0.8, 1.2))
    corner = FOPDT(1.2, 4.0, 1.2).to_transfer_function()
    assert found.worst_Ms.loop.margins.Ms == pytest.approx(margins(C.to_transfer_function() * corner).Ms, rel=1e-9)
    y = closed_loop_step(FeedbackLoop(corner, C), 40.0, 2000).setpoint
    inside = np.interp(found.t, y.t, y.y)
    assert (inside <= found.setpoint.high + 5e-3).all()
    assert (inside >= found.setpoint.low - 5e-3).all()
    assert found.setpoint.high.max() == pytest.approx(y.y.max(), abs=5e-3)


def test_instability_within_the_spread_is_said() -> None:
    P = FOPDT(1.0, 5.0, 1.0).to_transfer_function()
    # Ku = 8.5: 30 % more of everything that hurts is too much for Kc = 6.
    found = sensitivity(P, PID(6.0, 8.0), 30.0, 40.0, 60)
    assert found.unstable
    assert any(c.K > 1 and c.theta > 1 for c in found.unstable)
    all_bad = sensitivity(P, PID(60.0, 8.0), 10.0, 10.0, 60)
    assert len(all_bad.unstable) == 9
    assert all_bad.worst_Ms is None
    assert all_bad.setpoint is None
    assert len(sensitivity(parse_transfer_function("1/(s+1)^3"), PID(1.0, 3.0), 10.0, 30.0, 60).cases) == 5
    with pytest.raises(InvalidInput):
        sensitivity(P, PID(1.0), 0.0, 10.0)
