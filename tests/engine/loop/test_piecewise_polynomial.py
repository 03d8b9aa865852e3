r"""e^{-theta s}/s under P control: e = 1 - y is the piecewise polynomial sum (-Kc)^k (t - k theta)^k / k!."""

from fractions import Fraction
from math import factorial

import numpy as np
import pytest

from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step
from looplab.engine.systems import TransferFunction, parse_transfer_function


def exact_error(Kc: Fraction, theta: Fraction, t: Fraction) -> Fraction:
    return sum(((-Kc) ** k * (t - k * theta) ** k / factorial(k) for k in range(int(t / theta) + 1)), Fraction(0))


@pytest.mark.parametrize(
    ("Kc", "theta"), [("0.5", "1"), ("1.5", "1"), ("0.367879441171442", "1"), ("3", "0.5"), ("0.01", "16")]
)
def test_step_response_is_the_piecewise_polynomial(Kc: str, theta: str) -> None:
    plant = parse_transfer_function(f"exp(-{theta} s)/s")
    loop = FeedbackLoop(plant=plant, controller=PID(Kc=float(Kc)))
    result = closed_loop_step(loop, horizon=30 * float(theta), points=601)
    steps = np.round(result.t / float(theta) * 20).astype(int)
    np.testing.assert_allclose(steps * float(theta) / 20, result.t, rtol=1e-13)
    e = np.array([float(exact_error(Fraction(Kc), Fraction(theta), Fraction(theta) * int(k) / 20)) for k in steps])
    np.testing.assert_allclose(result.setpoint.y, 1 - e, rtol=0, atol=1e-12)
    np.testing.assert_allclose(result.setpoint.u, float(Kc) * e, rtol=0, atol=1e-12 * max(1, float(Kc)))


def test_load_on_the_same_loop() -> None:
    """y(t) = sum over k of (-Kc)^k (t - (k+1) theta)^(k+1)/(k+1)!: the integral of the error, delayed."""
    Kc, theta = Fraction(2, 5), Fraction(1)
    result = closed_loop_step(FeedbackLoop(TransferFunction((), (0.0,), 1.0, 1.0), PID(0.4)), horizon=20.0, points=201)
    exact = []
    for t in (Fraction(k, 10) for k in range(201)):
        terms = ((-Kc) ** k * (t - (k + 1) * theta) ** (k + 1) / factorial(k + 1) for k in range(int(t / theta)))
        exact.append(float(sum(terms, Fraction(0))))
    np.testing.assert_allclose(result.t, np.arange(201) / 10, rtol=1e-13)
    np.testing.assert_allclose(result.load.y, exact, rtol=0, atol=1e-12)
