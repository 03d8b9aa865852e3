"""Bode, margins and Nyquist of delayed open loops: tabulated margins with the dead time split, and the definitions."""

from typing import Any

import numpy as np
import pytest

from looplab.engine.delays import (
    DelaySystem,
    delay_bode,
    delay_margins,
    delay_nyquist,
    delay_verdict,
    feedback,
    frequency_response,
    parallel,
    series,
    smith_predictor,
)
from looplab.engine.errors import InvalidInput
from looplab.engine.systems import TransferFunction, parse_transfer_function
from references import cases

made = DelaySystem.from_transfer_function


def split(case: dict[str, Any]) -> DelaySystem:
    zeros, poles = ([complex(*z) for z in case[name]] for name in ("zeros", "poles"))
    theta = case["theta"]
    L = TransferFunction(zeros, poles, case["gain"], 0.3 * theta)
    return series(made(L), made(TransferFunction((), (), 1.0, 0.7 * theta)))


# Beyond order 10 the realised cascade loses digits that the factored form keeps.
TABLE = [c for c in cases("margins") if len(c.values[0]["poles"]) <= 8]


@pytest.mark.parametrize("case", TABLE)
def test_tabulated_crossovers_and_peaks(case: dict[str, Any]) -> None:
    found = delay_margins(split(case))
    assert found.closed_loop_stable == (case["rhp_poles"] == 0)
    assert [c.omega for c in found.gain_crossovers] == pytest.approx(
        [c["omega"] for c in case["gain_crossovers"]], rel=1e-8
    )
    assert [c.PM_deg for c in found.gain_crossovers] == pytest.approx(
        [c["PM_deg"] for c in case["gain_crossovers"]], abs=1e-6
    )
    mine = [c for c in found.phase_crossovers if c.omega > 0]
    for c in case["phase_crossovers"]:
        if c["GM"] < 19 and c["omega"] > 0:
            near = min(mine, key=lambda m: abs(m.omega - c["omega"]))
            assert near.omega == pytest.approx(c["omega"], rel=1e-7)
            assert near.GM == pytest.approx(c["GM"], rel=1e-6)
    for name in ("Ms", "Mt"):
        # Where |L| does not fade the peak is the largest up to the cut, and says so.
        if name not in found.reasons and case[name]["value"] < 1e6:
            assert getattr(found, name) == pytest.approx(case[name]["value"], rel=1e-6)


@pytest.fixture(scope="module")
def smith() -> DelaySystem:
    predictor = smith_predictor(parse_transfer_function("2 (s+1)/s"), parse_transfer_function("exp(-s)/(s+1)"))
    return series(predictor, made(parse_transfer_function("1.1 exp(-1.3s)/(0.8s+1)")))


def formula(omega: np.ndarray) -> np.ndarray:
    """The same open loop written out."""
    s = 1j * omega
    C = 2 * (s + 1) / s
    return 1.1 * np.exp(-1.3 * s) / (0.8 * s + 1) * C / (1 + C * (1 - np.exp(-s)) / (s + 1))


def test_margins_of_a_smith_predictor_are_what_they_are_called(smith: DelaySystem) -> None:
    found = delay_margins(smith)
    assert found.closed_loop_stable
    for c in found.gain_crossovers:
        value = formula(np.array([c.omega]))[0]
        assert abs(value) == pytest.approx(1.0, abs=1e-10)
        assert np.degrees(np.angle(-value)) == pytest.approx(c.PM_deg, abs=1e-7)
    for p in found.phase_crossovers:
        value = formula(np.array([p.omega]))[0]
        assert value.real < 0
        assert abs(value.imag) <= 1e-9 * abs(value)
        assert 1 / abs(value) == pytest.approx(p.GM, rel=1e-9)
    omega = np.geomspace(1e-3, 100, 400_001)
    L = formula(omega)
    assert found.Ms == pytest.approx(np.abs(1 / (1 + L)).max(), rel=1e-6)
    assert found.Mt == pytest.approx(np.abs(L / (1 + L)).max(), rel=1e-6)
    # None is missed: every change of sign of ln|L| on a fine grid, below the cut.
    log = np.log(np.abs(L))
    assert np.count_nonzero(log[1:] * log[:-1] < 0) == len(found.gain_crossovers)
    assert "listed up to" in found.reasons["phase_crossovers"]


def test_the_delay_margin_is_where_stability_ends(smith: DelaySystem) -> None:
    room = delay_margins(smith).delay_margin
    assert room is not None
    for factor, stable in ((0.9999, True), (1.0001, False)):
        late = series(smith, made(TransferFunction((), (), 1.0, factor * room)))
        assert delay_verdict(feedback(late)).closed_loop_stable is stable


def test_the_gain_margin_is_where_stability_ends(smith: DelaySystem) -> None:
    found = delay_margins(smith)
    first = min(c.GM for c in found.phase_crossovers if c.GM > 1)
    for factor, stable in ((0.9999, True), (1.0001, False)):
        assert (
            delay_verdict(feedback(series(smith, made(TransferFunction((), (), factor * first))))).closed_loop_stable
            is stable
        )


def test_bode_follows_the_phase(smith: DelaySystem) -> None:
    data = delay_bode(smith, 0.01, 30.0)
    assert data.omega[0] == pytest.approx(0.01)
    assert data.omega[-1] == pytest.approx(30.0)
    L = formula(data.omega)
    np.testing.assert_allclose(data.mag_dB, 20 * np.log10(np.abs(L)), rtol=0, atol=1e-8)
    np.testing.assert_allclose(np.exp(1j * np.radians(data.phase_deg)), L / np.abs(L), atol=1e-9)
    assert (np.abs(np.diff(data.phase_deg)) < 30).all(), "no turn is jumped over"
    assert data.phase_deg[0] == pytest.approx(-90, abs=3), "anchored at one integrator"


def test_nyquist_counts_closed_against_open_poles(smith: DelaySystem) -> None:
    curve, count = delay_nyquist(smith)
    assert (count.N, count.P, count.Z) == (0, 0, 0)
    np.testing.assert_allclose(curve.re + 1j * curve.im, formula(curve.omega), rtol=1e-9)
    tight = series(smith, made(TransferFunction((), (), 3.0)))
    _, count = delay_nyquist(tight)
    assert count.Z is not None
    assert count.Z == count.N > 0
    unstable = parallel(
        made(parse_transfer_function("4 exp(-0.1s)/(s-1)")), made(parse_transfer_function("0.1 exp(-0.3s)"))
    )
    _, count = delay_nyquist(unstable)
    assert (count.N, count.P, count.Z) == (-1, 1, 0)


def test_a_system_that_passes_nothing() -> None:
    nothing = parallel(made(parse_transfer_function("1/(s+1)")), made(parse_transfer_function("1/(s+1)")), -1.0)
    found = delay_margins(nothing)
    assert (found.GM, found.PM_deg, found.Ms, found.Mt) == (None, None, 1.0, 0.0)
    assert "zero" in found.reasons["GM"]
    with pytest.raises(InvalidInput):
        delay_bode(nothing)
    with pytest.raises(InvalidInput):
        delay_bode(made(parse_transfer_function("1/(s+1)")), 2.0, 1.0)


def test_a_response_at_a_pole_is_infinite() -> None:
    value = frequency_response(made(parse_transfer_function("exp(-s)/s")), np.array([0.0, 1.0]))[:, 0, 0]
    assert np.isinf(value[0])
    assert value[1] == pytest.approx(-1j * np.exp(-1j))
