"""PID forms against their defining formulas, conversions, and the settings that are refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import EngineError, ImproperSystem, InvalidInput
from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.systems import parse_transfer_function
from strategies import effort, magnitudes, numbers

S = np.array([0.01j, 0.3 + 0.7j, 4j, 100j])


@effort(80)
@given(magnitudes, st.none() | magnitudes, st.none() | magnitudes, numbers(0.01, 1.0))
def test_ideal_and_series_forms(Kc: float, tau_I: float | None, tau_D: float | None, alpha: float) -> None:
    integral = 1 / (tau_I * S) if tau_I else 0
    ideal = Kc * (1 + integral + (tau_D * S / (alpha * tau_D * S + 1) if tau_D else 0))
    series = Kc * (1 + integral) * ((tau_D * S + 1) / (alpha * tau_D * S + 1) if tau_D else 1)
    np.testing.assert_allclose(PID(Kc, tau_I, tau_D, alpha).to_transfer_function()(S), ideal, rtol=1e-11)
    np.testing.assert_allclose(
        PID(Kc, tau_I, tau_D, alpha, form="series").to_transfer_function()(S), series, rtol=1e-11
    )


@effort(40)
@given(magnitudes, magnitudes, magnitudes, numbers(0.01, 1.0))
def test_parallel_form(Kp: float, Ki: float, Kd: float, alpha: float) -> None:
    C = PID.from_parallel(Kp, Ki, Kd, alpha)
    expected = Kp + Ki / S + Kd * S / (alpha * (Kd / Kp) * S + 1)
    np.testing.assert_allclose(C.to_transfer_function()(S), expected, rtol=1e-11)


@pytest.mark.parametrize(
    ("settings", "type"), [((1,), "P"), ((1, 2), "PI"), ((1, None, 1), "PD"), ((1, 2, 3), "PID"), ((1, 2, 0), "PI")]
)
def test_type(settings: tuple, type: str) -> None:
    assert PID(*settings).type == type


@pytest.mark.parametrize(
    ("settings", "field"),
    [
        (dict(Kc=np.nan), "Kc"),
        (dict(Kc=np.inf), "Kc"),
        (dict(Kc=1, tau_I=0), "tau_I"),
        (dict(Kc=1, tau_I=-2), "tau_I"),
        (dict(Kc=1, tau_D=-1), "tau_D"),
        (dict(Kc=1, tau_I=np.inf), "tau_I"),
        (dict(Kc=1, alpha=-0.1), "alpha"),
        (dict(Kc=1, alpha=np.nan), "alpha"),
        (dict(Kc=1, form="magic"), "form"),
        (dict(Kc=1, action="sideways"), "action"),
        (dict(Kc=1, beta=np.nan), "beta"),
    ],
)
def test_refused_settings(settings: dict, field: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        PID(**settings)
    assert caught.value.field == field


def test_an_unfiltered_derivative_is_improper_and_the_hint_says_what_to_do() -> None:
    with pytest.raises(ImproperSystem) as caught:
        PID(1, 1, 1, alpha=0)
    assert caught.value.field == "alpha"
    assert "0.1" in caught.value.hint
    assert PID(1, 1, None, alpha=0).type == "PI"


@pytest.mark.parametrize("settings", [(0, 1, 0), (1, -1, 0), (1, 0, -1), (0, 0, 1)])
def test_parallel_settings_without_an_ideal_form(settings: tuple) -> None:
    with pytest.raises(EngineError) as caught:
        PID.from_parallel(*settings)
    assert caught.value.field in ("Kp", "Ki", "Kd")


@pytest.mark.parametrize(
    ("text", "filtered"),
    [
        ("2(1 + 1/(5s) + 0.5s)", "2 (1 + 1/(5 s) + 0.5 s/(0.05 s + 1))"),
        ("-3(1 + 0.2s)", "-3 (1 + 0.2 s/(0.02 s + 1))"),
    ],
)
def test_a_typed_pid_without_a_filter_is_named_and_its_filtered_form_offered(text: str, filtered: str) -> None:
    with pytest.raises(ImproperSystem) as caught:
        FeedbackLoop(parse_transfer_function("1/(s+1)^2"), parse_transfer_function(text))
    assert "not causal" in caught.value.message
    assert filtered in caught.value.hint
    FeedbackLoop(parse_transfer_function("1/(s+1)^2"), parse_transfer_function(filtered))


@pytest.mark.parametrize("text", ["s", "1/s + s", "(s+1)^3/s", "s^2 + s + 1", "1 - s"])
def test_what_differentiates_otherwise_is_told_so(text: str) -> None:
    with pytest.raises(ImproperSystem) as caught:
        FeedbackLoop(parse_transfer_function("1/(s+1)^4"), parse_transfer_function(text))
    assert "differentiates" in caught.value.message
