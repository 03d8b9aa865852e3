"""Ideal, series and parallel form are one transfer function, both ways, with and without the derivative filter."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.tuning import (
    Gains,
    ParallelGains,
    ideal_to_parallel,
    ideal_to_series,
    parallel_to_ideal,
    proportional_band,
    series_to_ideal,
)
from strategies import effort

S = np.array([0.1j, 1.0j, 30.0j, 0.5 + 2.0j])
times = st.floats(1e-3, 1e3)
shares = st.floats(0.0, 0.99)


def ideal_C(g: Gains, Tf: float) -> np.ndarray:
    integral = 1 / (g.tau_I * S) if g.tau_I is not None else 0
    return g.Kc * (1 + integral + g.tau_D * S / (Tf * S + 1))


def series_C(g: Gains, Tf: float) -> np.ndarray:
    integral = 1 / (g.tau_I * S) if g.tau_I is not None else 0
    return g.Kc * (1 + integral) * (g.tau_D * S + 1) / (Tf * S + 1)


@effort(60)
@given(times, times, shares, st.floats(-50, 50).filter(lambda v: abs(v) > 1e-3))
def test_series_to_ideal_and_back(tau_I: float, tau_D: float, share: float, Kc: float) -> None:
    slow, fast = max(tau_I, tau_D), min(tau_I, tau_D)
    Tf = share * fast
    series = Gains(Kc, slow, fast)
    ideal = series_to_ideal(series, Tf)
    np.testing.assert_allclose(ideal_C(ideal, Tf), series_C(series, Tf), rtol=1e-11)
    back = ideal_to_series(ideal, Tf)
    np.testing.assert_allclose(series_C(back, Tf), series_C(series, Tf), rtol=1e-6)


@effort(60)
@given(times, st.floats(0.0, 0.2499), shares)
def test_ideal_to_series(tau_I: float, ratio: float, share: float) -> None:
    ideal = Gains(-2.0, tau_I, ratio * tau_I)
    series = ideal_to_series(ideal)
    assert series.tau_I is not None
    assert series.tau_I >= series.tau_D
    np.testing.assert_allclose(series_C(series, 0.0), ideal_C(ideal, 0.0), rtol=1e-11)


@pytest.mark.parametrize("Tf", [0.0, 0.05])
def test_complex_zeros_have_no_series_form(Tf: float) -> None:
    with pytest.raises(RuleNotApplicable, match="zeros are complex"):
        ideal_to_series(Gains(1.0, 4.0, 1.01), Tf)
    if not Tf:
        # tau_I = 4 tau_D is the last: two equal times.
        assert ideal_to_series(Gains(3.0, 4.0, 1.0)) == Gains(1.5, 2.0, 2.0)


def test_controllers_without_one_of_the_actions() -> None:
    assert series_to_ideal(Gains(2.0, 3.0)) == Gains(2.0, 3.0)
    assert ideal_to_series(Gains(2.0, 3.0)) == Gains(2.0, 3.0)
    for Tf in (0.0, 0.2):
        PD = Gains(2.0, None, 0.7)
        np.testing.assert_allclose(ideal_C(series_to_ideal(PD, Tf), Tf), series_C(PD, Tf), rtol=1e-13)
        np.testing.assert_allclose(series_C(ideal_to_series(PD, Tf), Tf), ideal_C(PD, Tf), rtol=1e-13)


def test_parallel_both_ways() -> None:
    ideal = Gains(-2.0, 5.0, 0.5)
    parallel = ideal_to_parallel(ideal)
    assert parallel == ParallelGains(-2.0, -0.4, -1.0)
    assert parallel_to_ideal(parallel) == ideal
    assert parallel_to_ideal(ParallelGains(3.0)) == Gains(3.0)


@pytest.mark.parametrize(
    "call",
    [
        lambda: parallel_to_ideal(ParallelGains(0.0, 1.0)),
        lambda: parallel_to_ideal(ParallelGains(1.0, -1.0)),
        lambda: parallel_to_ideal(ParallelGains(-1.0, 0.0, 1.0)),
        lambda: Gains(1.0, 0.0),
        lambda: Gains(1.0, 1.0, -1.0),
        lambda: Gains(np.nan),
        lambda: series_to_ideal(Gains(1.0, 1.0, 0.2), -0.1),
        lambda: proportional_band(0.0),
    ],
)
def test_bad_input(call) -> None:
    with pytest.raises(InvalidInput) as caught:
        call()
    assert caught.value.field


def test_a_filter_slower_than_its_lead_has_no_ideal_form() -> None:
    with pytest.raises(RuleNotApplicable):
        series_to_ideal(Gains(1.0, 1.0, 0.2), 0.3)


def test_proportional_band() -> None:
    """D. E. Seborg et al., 3rd ed. 2011, sec. 8.2.1: PB = 100 %/Kc."""
    assert proportional_band(0.5) == 200.0
    assert proportional_band(-4.0) == 25.0
