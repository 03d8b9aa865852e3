"""T = L/(1 + L) as one transfer function: against its definition, and where it is refused."""

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.stability import setpoint_transfer
from looplab.engine.systems import parse_transfer_function
from placed_loops import placed_loops


@pytest.mark.parametrize(
    ("plant", "controller"),
    [
        ("1/(s+1)^3", PID(Kc=1.4, tau_I=2.2)),
        ("(s+2)/(s+1)", PID(Kc=1.0)),
        ("2/((s-1)(0.1s+1))", PID(Kc=2.0, tau_I=2.0, tau_D=0.1)),
        ("(1-s)/(s^2+0.2s+1)", PID(Kc=0.3)),
        ("0/(s+1)", PID(Kc=1.0)),
    ],
)
def test_it_is_L_over_one_plus_L(plant, controller):
    loop = FeedbackLoop(parse_transfer_function(plant), controller)
    omega = np.logspace(-2, 2, 25)
    L = loop.open_loop.response(omega)
    np.testing.assert_allclose(setpoint_transfer(loop).response(omega), L / (1 + L), rtol=1e-10)


def test_a_mode_that_cancels_in_the_loop_is_not_in_it():
    """3/((s+4)(s-4)) under (s-4)/s: T = 3/((s+1)(s+3)), the pole at 4 hides inside."""
    loop = FeedbackLoop(parse_transfer_function("3/((s+4)(s-4))"), parse_transfer_function("(s-4)/s"))
    T = setpoint_transfer(loop)
    np.testing.assert_allclose(sorted(T.poles.real), [-3, -1], rtol=1e-12)
    assert T.zeros.size == 0
    assert T.gain == pytest.approx(3, rel=1e-14)


def test_real_poles_close_together_stay_real():
    """Closed-loop poles drawn on the negative axis: no rounding may part one from a conjugate that it does not have."""
    for loop, _, _ in placed_loops():
        T, omega = setpoint_transfer(loop), np.logspace(-1, 1, 9)
        L = loop.open_loop.response(omega)
        np.testing.assert_allclose(T.response(omega), L / (1 + L), rtol=1e-6)


def test_dead_time_and_a_setpoint_weight_are_refused():
    with pytest.raises(InvalidInput) as refused:
        setpoint_transfer(FeedbackLoop(parse_transfer_function("exp(-s)/(s+1)"), PID(Kc=1.0)))
    assert refused.value.field == "plant.theta"
    with pytest.raises(InvalidInput) as refused:
        setpoint_transfer(FeedbackLoop(parse_transfer_function("1/(s+1)"), PID(Kc=1.0, beta=0.5)))
    assert refused.value.field == "controller.beta"
