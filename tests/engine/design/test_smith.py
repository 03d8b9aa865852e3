"""The Smith predictor beside PI and PID: its peak, what it tolerates, and where it fails, against other methods."""

import numpy as np
import pytest

from looplab.engine.delays import DelaySystem, delay_margins, delay_verdict, feedback, series, smith_predictor
from looplab.engine.design.mismatch import MismatchLoop
from looplab.engine.design.smith_loop import known_failures, smith_loop
from looplab.engine.design.smith_tuning import nominal_peak, smith_tuning
from looplab.engine.design.stable_region import stable_intervals, stable_region
from looplab.engine.errors import RuleNotApplicable
from looplab.engine.frequency import margins
from looplab.engine.loop import PID
from looplab.engine.systems import FOPDT, parse_transfer_function
from looplab.engine.tuning import perturbed_plant

MODEL = FOPDT(1.0, 2.0, 4.0).to_transfer_function()
ONE = np.ones(1)
BOX = {"K": (0.2, 2.9), "tau": (0.3, 3.0), "theta": (0.0, 3.0)}


def open_loop(C, model, plant):
    return series(smith_predictor(C.to_transfer_function(), model), DelaySystem.from_transfer_function(plant))


def test_the_tuned_predictor_has_the_peak_asked_for():
    tuned = smith_tuning(MODEL, 1.6)
    assert tuned.on_limit
    # SIMC without dead time: Kc = tau/(K tau_c), tau_I = tau, so that T = exp(-theta s)/(tau_c s + 1).
    assert pytest.approx(2.0 / tuned.tau_c) == tuned.controller.Kc
    assert tuned.controller.tau_I == pytest.approx(2.0)
    omega = np.linspace(0.0, 20.0, 400_001)
    S = 1 - np.exp(-4j * omega) / (tuned.tau_c * 1j * omega + 1)
    assert np.abs(S).max() == pytest.approx(1.6, rel=1e-8)
    assert delay_margins(open_loop(tuned.controller, MODEL, MODEL)).Ms == pytest.approx(1.6, rel=1e-9)


def test_without_mismatch_the_peak_stays_below_two_however_fast():
    assert 1.9 < nominal_peak(PID(100.0, 2.0), MODEL) < 2.0
    assert not smith_tuning(MODEL, 3.0).on_limit
    assert nominal_peak(PID(1e-3, 2.0), MODEL) < 1.01


def test_the_nominal_response_is_the_dead_time_and_a_lag():
    tuned = smith_tuning(MODEL, 1.5)
    loop = smith_loop(tuned.controller, MODEL, MODEL, 40.0, 401)
    t = loop.steps.setpoint.t
    expected = np.where(t > 4, 1 - np.exp(-np.maximum(t - 4, 0) / tuned.tau_c), 0.0)
    np.testing.assert_allclose(loop.steps.setpoint.y, expected, atol=1e-9)
    assert loop.load.IAE is not None


def test_the_verdict_on_mismatched_plants_is_that_of_the_argument_principle():
    C = PID(1.9, 2.0)
    loop = MismatchLoop(C, MODEL, MODEL)
    rng = np.random.default_rng(7)
    points = {name: rng.uniform(*BOX[name], 3) for name in BOX}
    counts = loop.roots_right(points["K"], points["tau"], points["theta"])
    assert len(set(counts.tolist())) > 1
    for i, count in enumerate(counts):
        plant = perturbed_plant(MODEL, *(float(points[n][i]) for n in ("K", "tau", "theta")))
        assert delay_verdict(feedback(open_loop(C, MODEL, plant))).rhp_poles == count


def test_the_ends_of_the_stable_stretches_are_the_margins():
    C = smith_tuning(MODEL, 1.6).controller
    loop, found = MismatchLoop(C, MODEL, MODEL), delay_margins(open_loop(C, MODEL, MODEL))
    [[(low, high)]] = stable_intervals(loop, "theta", {"K": ONE, "tau": ONE}, (0.0, 3.0))
    assert low == 0
    assert high == pytest.approx(1 + found.delay_margin / 4.0, rel=1e-10)
    [[(_, high)]] = stable_intervals(loop, "K", {"tau": ONE, "theta": ONE}, (0.05, 10.0))
    assert high == pytest.approx(found.GM, rel=1e-10)
    # Without a predictor: the margins of the plain loop.
    plain = MismatchLoop(PID(0.3, 2.5), MODEL, None)
    found = margins(PID(0.3, 2.5).to_transfer_function() * MODEL)
    [[(_, high)]] = stable_intervals(plain, "K", {"tau": ONE, "theta": ONE}, (0.05, 10.0))
    assert high == pytest.approx(found.GM, rel=1e-10)


def test_a_fast_predictor_does_not_survive_a_shorter_dead_time_either():
    """The known surprise: with K off, islands of stability on both sides of the model's dead time."""
    loop = MismatchLoop(PID(6.0, 2.0), MODEL, MODEL)
    [stretches] = stable_intervals(loop, "theta", {"K": ONE, "tau": ONE}, (0.0, 3.0))
    [around] = [s for s in stretches if s[0] < 1 < s[1]]
    assert around[0] > 0.5
    assert around[1] < 1.5
    region = stable_region(loop, "theta_K", {"K": 1.0, "tau": 1.0, "theta": 1.0}, rows=5)
    assert region.intervals[0] == ((0.0, 3.0),)
    assert sum(b - a for a, b in region.intervals[-1]) < 0.5


def test_an_integrating_model_leaves_an_offset_of_its_slope_times_the_dead_time():
    model = parse_transfer_function("0.5 exp(-2s)/s")
    C = smith_tuning(model, 1.5).controller
    loop = smith_loop(C, model, model, 400.0, 400)
    assert loop.steps.load.final_y == pytest.approx(0.5 * 2.0)
    assert loop.steps.load.y[-1] == pytest.approx(1.0, abs=1e-4)
    assert loop.margins.closed_loop_stable
    assert "offset of 1 per unit" in known_failures(C, model)[0]


def test_an_unstable_model_is_said_to_stay_unstable():
    model = parse_transfer_function("2 exp(-0.2s)/(s-1)")
    loop = smith_loop(PID(2.0, 3.0), model, model, 40.0, 200)
    assert not loop.margins.closed_loop_stable
    assert loop.setpoint.IAE is None
    assert loop.steps.load.y[-1] > 100
    assert loop.steps.load.truncated_at == 7.0
    assert "unstable" in known_failures(PID(2.0, 3.0), model)[0]
    with pytest.raises(RuleNotApplicable, match="no plant at all"):
        MismatchLoop(PID(2.0, 3.0), model, model)


def test_nothing_to_predict_is_refused():
    with pytest.raises(RuleNotApplicable, match="nothing to predict"):
        smith_tuning(parse_transfer_function("1/(2s+1)"), 1.6)
