"""Integrating plants as an integrator with dead time: the half rule as published, the line y(t) ends on."""

import numpy as np
import pytest

from looplab.engine.errors import RuleNotApplicable
from looplab.engine.loop import step_response
from looplab.engine.low_order import integrating_half_rule, ramp_asymptote
from looplab.engine.systems import DIPDT, IPDT, parse_transfer_function


@pytest.mark.parametrize(
    ("text", "PI", "PID"),
    [
        # S. Skogestad, J. Process Control 13 (2003), Table 4, E8.
        ("1/(s(s+1)^2)", IPDT(1.0, 1.5), IPDT(1.0, 0.5, 1.5)),
        # By the rule itself.
        ("-2 exp(-s)/s", IPDT(-2.0, 1.0), IPDT(-2.0, 1.0)),
        ("3(1-2s)exp(-s)/(s(4s+1))", IPDT(3.0, 5.0), IPDT(3.0, 3.0, 4.0)),
        ("0.5 exp(-s)/(s^2(2s+1))", DIPDT(0.5, 2.0), DIPDT(0.5, 2.0)),
    ],
)
def test_half_rule(text: str, PI: IPDT | DIPDT, PID: IPDT | DIPDT) -> None:
    P = parse_transfer_function(text)
    for lags, expected in ((0, PI), (1, PID)):
        found = integrating_half_rule(P, lags)
        assert type(found) is type(expected)
        assert vars(found) == pytest.approx(vars(expected), rel=1e-12)


@pytest.mark.parametrize("text", ["1/(s(s+1)^2)", "-2(1-s)exp(-0.5s)/(s(3s+1)(s^2+s+1))", "(0.5s+1)/(s(2s+1))"])
def test_the_step_response_ends_on_the_line(text: str) -> None:
    P = parse_transfer_function(text)
    line = ramp_asymptote(P)
    response = step_response(P, 120.0, 400)
    np.testing.assert_allclose(response.y[-1], line.K * (response.t[-1] - line.theta), rtol=1e-9)


def test_models_are_transfer_functions() -> None:
    s = 0.3 + 0.8j
    assert IPDT(2.0, 0.5, 3.0).to_transfer_function()(s) == pytest.approx(2 * np.exp(-0.5 * s) / (s * (3 * s + 1)))
    assert DIPDT(2.0, 0.5).to_transfer_function()(s) == pytest.approx(2 * np.exp(-0.5 * s) / s**2)


@pytest.mark.parametrize(
    ("find", "text"),
    [
        (lambda P: integrating_half_rule(P, 0), "1/(s+1)"),
        (lambda P: integrating_half_rule(P, 0), "1/s^3"),
        (lambda P: integrating_half_rule(P, 0), "1/(s(s-1))"),
        (lambda P: integrating_half_rule(P, 0), "1/(s(s^2+s+1))"),
        (lambda P: integrating_half_rule(P, 0), "(5s+1)/(s(s+1))"),
        (ramp_asymptote, "1/s^2"),
        (ramp_asymptote, "(5s+1)/(s(s+1))"),
    ],
)
def test_refusals(find, text: str) -> None:
    with pytest.raises(RuleNotApplicable) as caught:
        find(parse_transfer_function(text))
    assert caught.value.field
