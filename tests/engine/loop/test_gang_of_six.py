"""The gang of six against its definitions, over frequency with exact dead time and as step responses."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.loop.gang_of_six import GANG, gang_of_six, gang_steps
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems

OMEGA = np.geomspace(0.01, 100, 61)


@effort(60)
@given(systems(theta=True, excess=0), st.floats(0.1, 5), st.floats(0.2, 5), st.sampled_from([0.0, 0.3, 1.0, 1.4]))
def test_magnitudes_are_the_definitions(P: TransferFunction, Kc: float, tau_I: float, beta: float) -> None:
    """PI with beta: u = Kc ((beta r - y) + (r - y)/(tau_I s)), from polynomials and exp(-s theta)."""
    s = 1j * OMEGA
    num, den = (np.polyval(np.atleast_1d(np.poly(roots)), s) for roots in (P.zeros, P.poles))
    p = P.gain * num / den * np.exp(-s * P.theta)
    c, forward = Kc * (1 + 1 / (tau_I * s)), Kc * (beta + 1 / (tau_I * s))
    assume(np.abs(1 + p * c).min() > 1e-3)
    assume(np.abs(p).min() > 1e-9)
    S = 1 / (1 + p * c)
    expected = {"S": S, "PS": p * S, "CS": c * S, "T": p * c * S, "CFS": forward * S, "TF": p * forward * S}
    found = gang_of_six(FeedbackLoop(P, PID(Kc, tau_I, beta=beta)), OMEGA)
    for name in GANG:
        assert np.exp(getattr(found, name)) == pytest.approx(np.abs(expected[name]), rel=1e-6), name


def test_without_a_setpoint_weight_four_are_left() -> None:
    found = gang_of_six(FeedbackLoop(parse_transfer_function("exp(-s)/(s+1)"), PID(1.2, 2.0)), OMEGA)
    assert (found.CFS == found.CS).all()
    assert found.TF == pytest.approx(found.T, abs=1e-13)


def test_step_responses_in_closed_form() -> None:
    """P = 1/(s+1), Kc = 2, beta = 1/2: S = (s+1)/(s+3), C + F = 1."""
    steps = gang_steps(FeedbackLoop(parse_transfer_function("1/(s+1)"), PID(2.0, beta=0.5)), 3.0, 101)
    fade = np.exp(-3 * steps.t)
    expected = {
        "S": (1 + 2 * fade) / 3,
        "PS": (1 - fade) / 3,
        "CS": (2 + 4 * fade) / 3,
        "T": 2 * (1 - fade) / 3,
        "CFS": (1 + 2 * fade) / 3,
        "TF": (1 - fade) / 3,
    }
    for name in GANG:
        assert getattr(steps, name) == pytest.approx(expected[name], abs=1e-13), name
    assert steps.truncated_reason is None


def test_step_responses_of_an_integrator_with_dead_time() -> None:
    """exp(-s)/s with Kc = 0.4, beta = 0: no setpoint gets through, and T is the sum of (-1)^(k-1) Kc^k (t-k)^k/k!."""
    from math import factorial

    steps = gang_steps(FeedbackLoop(parse_transfer_function("exp(-s)/s"), PID(0.4, beta=0.0)), 8.0, 81)
    T = sum((-1) ** (k - 1) * 0.4**k * np.maximum(steps.t - k, 0) ** k / factorial(k) for k in range(1, 9))
    assert steps.T == pytest.approx(T, abs=1e-12)
    assert steps.S == pytest.approx(1 - T, abs=1e-12)
    assert steps.CS == pytest.approx(0.4 * (1 - T), abs=1e-12)
    assert steps.PS == pytest.approx(T / 0.4, abs=1e-12)
    assert np.abs(steps.TF).max() < 1e-12
    assert np.abs(steps.CFS).max() < 1e-12


def test_an_unstable_loop_is_cut_with_a_reason() -> None:
    steps = gang_steps(FeedbackLoop(parse_transfer_function("1/(s-4)"), PID(1.0)), 30.0)
    assert steps.T.size < steps.t.size
    assert steps.truncated_reason is not None
