"""Worked values of the course, from the engine to full precision and to the printed digits (references/golden.json)."""

import numpy as np
import pytest

from looplab.engine.frequency import margins, nyquist_count
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step, step_metrics
from looplab.engine.response import simulate, step
from looplab.engine.stability import (
    closed_loop_poles,
    closed_loop_verdict,
    gain_ranges,
    pi_gain_ranges,
    root_locus,
    routh_array,
)
from looplab.engine.state_space import StateSpaceModel
from looplab.engine.systems import FOPDT, parse_transfer_function
from looplab.engine.tuning import cohen_coon, ultimate_point, ziegler_nichols_ultimate
from references import reference

GOLDEN = {case["name"]: case for case in reference("golden")["cases"]}


def digits(value: float, expected: dict) -> bool:
    return value == pytest.approx(expected["value"], rel=1e-12)


def test_ziegler_nichols_on_the_third_order_plant() -> None:
    case = GOLDEN["ziegler_nichols_third_order"]
    point = ultimate_point(parse_transfer_function(case["plant"]))
    assert digits(point.omega_180, case["omega_180"])
    assert digits(point.Ku, case["Ku"])
    assert digits(point.Pu, case["Pu"])
    for type in ("P", "PI", "PID"):
        s = ziegler_nichols_ultimate(point.Ku, point.Pu, type)
        for name in ("Kc", "tau_I", "tau_D"):
            if name in case[type]:
                assert digits(getattr(s, name), case[type][name])
            else:
                assert getattr(s, name) is None
    assert s.tau_D * s.alpha == pytest.approx(0.045345, abs=5e-7)


@pytest.mark.parametrize("type", ["PI", "PID"])
def test_its_closed_loops(type: str) -> None:
    case = GOLDEN["ziegler_nichols_third_order"]
    s = ziegler_nichols_ultimate(8.0, 2 * np.pi / 3**0.5, type)
    loop = FeedbackLoop(parse_transfer_function(case["plant"]), PID(s.Kc, s.tau_I, s.tau_D, s.alpha))
    m = margins(loop.open_loop)
    r = closed_loop_step(loop, horizon=30.0)
    metrics = step_metrics(r.setpoint, setpoint=1.0, stable=m.closed_loop_stable)
    for name, printed in case["closed_loop_printed"][type].items():
        value = getattr(m, name) if hasattr(m, name) else getattr(metrics, name)
        decimals = len(str(printed).split(".")[1])
        assert round(value, decimals) == printed, name
    assert closed_loop_verdict(loop).verdict == "stable"


def test_cohen_coon() -> None:
    case = GOLDEN["cohen_coon"]
    model = FOPDT(case["K"], case["tau"], case["theta"])
    for type in ("P", "PI", "PID"):
        s = cohen_coon(model, type)
        for name, expected in case[type].items():
            assert digits(getattr(s, name), expected), (type, name)


def test_gain_margin_of_5_dB() -> None:
    case = GOLDEN["gain_margin_5dB"]
    point = ultimate_point(parse_transfer_function(case["plant"]))
    assert digits(point.omega_180, case["omega_180"])
    assert digits(point.Ku, case["Ku"])
    Kc = point.Ku / 10 ** (5 / 20)
    assert digits(Kc, case["Kc"])
    m = margins(FeedbackLoop(parse_transfer_function(case["plant"]), PID(Kc)).open_loop)
    assert m.GM_dB == pytest.approx(5, abs=1e-12)
    assert digits(m.PM_deg, case["PM_deg"])
    late = case["longer_dead_time"]
    m = margins(FeedbackLoop(parse_transfer_function(late["plant"]), PID(Kc)).open_loop)
    assert m.closed_loop_stable
    assert m.GM_dB == pytest.approx(late["GM_dB"]["value"], abs=1e-11)
    assert m.PM_deg == pytest.approx(late["PM_deg"]["value"], abs=1e-10)


def test_phase_margin_of_30_degrees() -> None:
    case = GOLDEN["phase_margin_30"]
    Kc = case["Kc"]["value"]
    m = margins(FeedbackLoop(parse_transfer_function(case["plant"]), PID(Kc)).open_loop)
    assert m.PM_deg == pytest.approx(30, abs=1e-10)
    assert digits(m.GM_dB, case["GM_dB"])
    for changed in ("longer_dead_time", "faster_lag"):
        plant = parse_transfer_function(case[changed]["plant"])
        assert not margins(FeedbackLoop(plant, PID(Kc)).open_loop).closed_loop_stable
        assert digits(ultimate_point(plant).Ku, case[changed]["Kc_limit"])
    limit = case["longer_dead_time"]["Kc_limit"]["value"]
    nominal = margins(FeedbackLoop(parse_transfer_function(case["plant"]), PID(limit)).open_loop)
    assert digits(nominal.PM_deg, case["longer_dead_time"]["PM_deg_that_suffices"])


def test_root_locus_breakaways() -> None:
    case = GOLDEN["root_locus_breakaways"]
    L = parse_transfer_function(case["plant"])
    found = root_locus(L)
    for b, expected in zip(found.breakaways, case["breakaways"], strict=True):
        assert digits(b.s.real, expected["s"])
        assert digits(b.K, expected["K"])
    (crossing,) = found.imaginary_axis_crossings
    assert crossing.K == pytest.approx(case["stable_above"], rel=1e-12)
    assert crossing.omega == pytest.approx(case["crossing_omega"], rel=1e-12)


def test_internal_stability() -> None:
    case = GOLDEN["internal_stability"]
    loop = FeedbackLoop(parse_transfer_function(case["plant"]), parse_transfer_function(case["controller"]))
    assert sorted(p.real for p in closed_loop_poles(loop).poles) == pytest.approx(case["poles"], rel=1e-12)
    assert not closed_loop_verdict(loop).closed_loop_stable


def test_stable_gains_of_a_PI_controller() -> None:
    """Every Kc > 0 from tau_I = 0.5 on, else Kc < 4/(1/tau_I - 2)."""
    case = GOLDEN["routh_PI"]
    P = parse_transfer_function(case["plant"])
    for tau_I, limit in zip(case["tau_I"], case["Kc_limit"], strict=True):
        assert limit == pytest.approx(4 / (1 / tau_I - 2), rel=1e-12)
        (stable,) = pi_gain_ranges(P, tau_I).ranges
        assert stable.low.K == 0
        assert stable.high.K == pytest.approx(limit, rel=1e-11)
        for K, changes in ((limit * (1 - 1e-9), 0), (limit * (1 + 1e-9), 2)):
            # s^3 + 2 s^2 + (2 + Kc) s + Kc/tau_I
            assert routh_array([1, 2, 2 + K, K / tau_I]).sign_changes == changes
    for tau_I in (case["unlimited_from_tau_I"], 1.0, 10.0):
        (stable,) = pi_gain_ranges(P, tau_I).ranges
        assert (stable.low.K, stable.high.K) == (0, None)


def test_a_loop_that_no_gain_stabilises() -> None:
    case = GOLDEN["root_locus_never_stable"]
    L = parse_transfer_function(case["plant"])
    assert gain_ranges(L).ranges == ()
    locus = root_locus(L)
    right = np.count_nonzero(locus.branches.real > 0, axis=0)
    assert right[1:].min() >= case["rhp_at_least"]
    for K in np.logspace(-4, 6, 41):
        assert nyquist_count(L * K).Z >= case["rhp_at_least"]


def test_the_controller_that_moves_its_actuator_hard() -> None:
    """P = 10/((s+10)(s+1)), C = 10 (s+10)(s+1)/(s (s+12)): C S = 10 (s+10)(s+1)/(s^2+12 s+100) from 10 down to 1.

    Seen from a step on the measurement, u goes from -10 to -1; |C S| peaks with 12.54 at 12.85 rad/time.
    """
    loop = FeedbackLoop(parse_transfer_function("10/((s+10)(s+1))"), parse_transfer_function("10(s+10)(s+1)/(s(s+12))"))
    u = closed_loop_step(loop, horizon=3.0).setpoint.u
    assert -u[0] == pytest.approx(-10, rel=1e-12)
    assert -u[-1] == pytest.approx(-1, abs=1e-5)
    omega = np.linspace(10, 16, 6001)
    CS = np.abs(loop.C.response(omega) / (1 + loop.open_loop.response(omega)))
    assert round(CS.max(), 2) == 12.54
    # 157 x^2 - 19800 x - 1015600 = 0 for x = omega^2; printed with its last digit cut off
    peak = ((19800 + (19800**2 + 4 * 157 * 1015600) ** 0.5) / 314) ** 0.5
    assert omega[CS.argmax()] == pytest.approx(peak, abs=1e-3)
    assert int(peak * 100) == 1285


def test_two_zeros_in_the_right_half_plane() -> None:
    """(s^2-3s+2)/(2 (s+1)^4): up first, then an undershoot of 8.27 % at t = 2.0; settled (2 %) at 10.28."""
    G = parse_transfer_function("(s^2-3s+2)/(2(s+1)^4)")
    assert G.dc_gain == pytest.approx(1, rel=1e-12)
    r = simulate(StateSpaceModel.from_transfer_function(G).channel(), step(), 20.0, 4001)
    assert (r.y[1:20] > 0).all()
    assert round(-100 * r.y.min(), 2) == 8.27
    assert round(r.t[r.y.argmin()], 1) == 2.0
    assert round(r.t[np.flatnonzero(np.abs(r.y - 1) > 0.02)[-1]], 2) == pytest.approx(10.28, abs=0.01)


def test_inverse_response_process() -> None:
    """Skogestad and Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, ch. 2: 3(1-2s)/((5s+1)(10s+1)).

    Ku = 2.5, Pu = 15.2; PI with Kc = 1.14, tau_I = 12.7: GM 1.63, PM 19.4 deg, Ms 3.92, Mt 3.35 (from rounded settings
    there, so the last digit is given room).
    """
    P = parse_transfer_function("3(1-2s)/((5s+1)(10s+1))")
    point = ultimate_point(P)
    assert point.Ku == pytest.approx(2.5, rel=1e-12)
    assert round(point.Pu, 1) == 15.2
    m = margins(FeedbackLoop(P, PID(1.14, 12.7)).open_loop)
    assert m.closed_loop_stable
    assert m.GM == pytest.approx(1.63, abs=0.005)
    assert m.PM_deg == pytest.approx(19.4, abs=0.15)
    assert m.Ms == pytest.approx(3.92, abs=0.03)
    assert m.Mt == pytest.approx(3.35, abs=0.03)
