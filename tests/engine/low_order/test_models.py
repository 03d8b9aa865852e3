"""Low-order models: the examples of Skogestad and Seborg, what each method preserves, and the deviation."""

import numpy as np
import pytest
from hypothesis import given

from looplab.engine.errors import ImproperSystem, RuleNotApplicable
from looplab.engine.laplace import LaplaceInput, inverse_transform, partial_fractions
from looplab.engine.low_order import (
    StepCurve,
    approximate,
    half_rule,
    largest_deviation,
    least_squares_fit,
    model_step,
    real_lags,
    taylor,
)
from looplab.engine.systems import FOPDT, SOPDT, TransferFunction, parse_transfer_function
from strategies import effort, magnitudes, numbers, systems

# Seborg et al., Process Dynamics and Control, 3rd ed., examples 6.4 and 6.5.
SEBORG_4 = "(1-0.1s)/((5s+1)(3s+1)(0.5s+1))"
SEBORG_5 = "(1-s)exp(-s)/((12s+1)(3s+1)(0.2s+1)(0.05s+1))"
# Skogestad, J. Process Control 13 (2003), the examples of section 2.
SKOGESTAD_2 = "(1-0.3s)(0.08s+1)/((2s+1)(s+1)(0.4s+1)(0.2s+1)(0.05s+1)^3)"
SKOGESTAD_E3 = "2(15s+1)/((20s+1)(s+1)(0.1s+1)^2)"


@pytest.mark.parametrize(
    ("text", "K", "tau", "theta"),
    [
        (SEBORG_4, 1, 6.5, 2.1),
        (SEBORG_5, 1, 13.5, 3.75),
        (SKOGESTAD_2, 1, 2.5, 1.47),
        (SKOGESTAD_E3, 1.5, 1.05, 0.15),
        ("1/((s+1)(0.2s+1))", 1, 1.1, 0.1),
        ("-3/(s+1)^4", -3, 1.5, 2.5),
    ],
)
def test_half_rule_first_order(text: str, K: float, tau: float, theta: float) -> None:
    found = half_rule(parse_transfer_function(text), "FOPDT")
    assert isinstance(found, FOPDT)
    assert (found.K, found.tau, found.theta) == pytest.approx((K, tau, theta), rel=1e-12)


@pytest.mark.parametrize(
    ("text", "K", "tau_1", "tau_2", "theta"),
    [
        (SEBORG_5, 1, 12, 3.1, 2.15),
        (SKOGESTAD_2, 1, 2, 1.2, 0.77),
        (SKOGESTAD_E3, 1.5, 1, 0.15, 0.05),
        ("1/(s+1)^4", 1, 1.5, 1, 1.5),
    ],
)
def test_half_rule_second_order(text: str, K: float, tau_1: float, tau_2: float, theta: float) -> None:
    found = half_rule(parse_transfer_function(text), "SOPDT")
    assert isinstance(found, SOPDT)
    assert (found.K, found.theta) == pytest.approx((K, theta), rel=1e-12)
    assert real_lags(found) == pytest.approx((tau_1, tau_2), rel=1e-7)


def test_taylor() -> None:
    found = taylor(parse_transfer_function(SEBORG_4), "FOPDT")
    assert isinstance(found, FOPDT)
    assert (found.tau, found.theta) == pytest.approx((5, 3.6), rel=1e-12)
    pair = taylor(parse_transfer_function("2exp(-s)/((s^2+0.4s+1)(0.1s+1))"), "SOPDT")
    assert isinstance(pair, SOPDT)
    assert (pair.K, pair.tau, pair.zeta, pair.theta) == pytest.approx((2, 1, 0.2, 1.1), rel=1e-12)


@given(systems(order=(2, 6), stable=True, theta=True))
@effort(40)
def test_taylor_and_half_rule_keep_the_average_residence_time(G: TransferFunction) -> None:
    """-G'(0)/G(0), dead time plus lags minus leads, is that of the model (half rule: where no left zeros are)."""
    exact = -complex(G.log_derivative(np.zeros(1, dtype=complex))[0]).real
    for method in (taylor, half_rule):
        if method is half_rule and (G.zeros.real < 0).any():
            continue
        for kind in ("FOPDT", "SOPDT"):
            try:
                model = method(G, kind).to_transfer_function()  # type: ignore[arg-type]
            except RuleNotApplicable:
                continue
            assert -complex(model.log_derivative(np.zeros(1, dtype=complex))[0]).real == pytest.approx(exact, rel=1e-9)


@given(K=magnitudes, tau=magnitudes, zeta=numbers(0.1, 3.0), theta=magnitudes)
@effort(30)
def test_the_closed_form_of_a_model_is_its_response(K: float, tau: float, zeta: float, theta: float) -> None:
    for model in (FOPDT(K, tau, theta), SOPDT(K, tau, zeta, theta), SOPDT(K, tau, 1.0, theta)):
        t = np.linspace(0, theta + 10 * tau, 200)
        exact = inverse_transform(partial_fractions(model.to_transfer_function(), LaplaceInput("step")))
        assert np.abs(model_step(model, t) - exact(t)).max() < 1e-10 * K


@given(K=magnitudes, tau=magnitudes, zeta=numbers(0.2, 1.5), theta=magnitudes)
@effort(8)
def test_a_fit_finds_a_plant_of_its_own_kind(K: float, tau: float, zeta: float, theta: float) -> None:
    for model, kind in ((FOPDT(K, tau, theta), "FOPDT"), (SOPDT(K, tau, zeta, theta), "SOPDT")):
        plant = model.to_transfer_function()
        curve = StepCurve(plant)
        found = least_squares_fit(plant, kind, curve)  # type: ignore[arg-type]
        assert largest_deviation(curve, found).value < 1e-4 * K


@pytest.mark.parametrize("text", [SEBORG_4, SEBORG_5, "1/(s+1)^5", "3/((s^2+s+1)(0.3s+1)^2)"])
def test_no_other_model_is_closer_in_the_mean_square(text: str) -> None:
    plant = parse_transfer_function(text)
    comparison = approximate(plant)
    curve = comparison.curve
    assert curve is not None
    t = np.linspace(0, curve.theta + curve.horizon, 800)
    error = {
        (found.method, found.type): float(np.mean((curve(t) - model_step(found.model, t)) ** 2))
        for found in comparison.models
        if found.model is not None
    }
    for kind in ("FOPDT", "SOPDT"):
        best = error["least_squares", kind]
        assert all(best <= value * (1 + 1e-6) for (_, other), value in error.items() if other == kind)
    assert error["least_squares", "SOPDT"] < error["least_squares", "FOPDT"]


def test_the_deviation_is_the_largest() -> None:
    """1/(s+1)^5 against its half-rule FOPDT: largest at the model's dead time 3.5, where the model still is 0."""
    plant = parse_transfer_function("1/(s+1)^5")
    found = largest_deviation(StepCurve(plant), half_rule(plant, "FOPDT"))
    x = 3.5
    exact = 1 - np.exp(-x) * (1 + x + x**2 / 2 + x**3 / 6 + x**4 / 24)
    assert found.t == pytest.approx(3.5)
    assert found.value == pytest.approx(exact, abs=1e-11)


@given(systems(order=(1, 6), stable=True, theta=True))
@effort(15)
def test_the_curve_is_the_response(G: TransferFunction) -> None:
    curve = StepCurve(G)
    t = np.linspace(0, G.theta + 0.5 * curve.horizon, 137)
    exact = inverse_transform(partial_fractions(G, LaplaceInput("step")))
    away = np.abs(t - G.theta) > 1e-9
    assert np.abs(curve(t) - exact(t))[away].max() < 5e-6 * max(curve.size, 1e-300)


@pytest.mark.parametrize(
    ("text", "word"),
    [("1/s", "does not settle"), ("1/(s-1)", "does not settle"), ("s/(s+1)", "began"), ("2", "no poles")],
)
def test_a_plant_without_models_says_why(text: str, word: str) -> None:
    comparison = approximate(parse_transfer_function(text))
    assert comparison.curve is None
    assert word in (comparison.reason or "")
    assert len(comparison.models) == 8
    assert all(found.model is None and found.reason == comparison.reason for found in comparison.models)


def test_refusals_are_told_apart() -> None:
    found = {(f.method, f.type): f for f in approximate(parse_transfer_function("2/((s^2+0.4s+1)(0.1s+1))")).models}
    assert "real poles" in (found["half_rule", "FOPDT"].reason or "")
    assert "complex" in (found["taylor", "FOPDT"].reason or "")
    assert found["taylor", "SOPDT"].model is not None
    # A response that starts beyond its 28.3 % point has no two points.
    jump = {(f.method, f.type): f for f in approximate(parse_transfer_function("(s+1.5)/(s+0.75)")).models}
    assert "jumps past" in (jump["two_point", "FOPDT"].reason or "")
    with pytest.raises(ImproperSystem):
        approximate(parse_transfer_function("s^2/(s+1)"))
    with pytest.raises(RuleNotApplicable, match="dead time would be negative"):
        taylor(parse_transfer_function(SKOGESTAD_E3), "FOPDT")
