"""Worked values of the course, from the engine to full precision and to the printed digits (references/golden.json)."""

import numpy as np
import pytest

from looplab.engine.frequency import margins
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step, step_metrics
from looplab.engine.stability import closed_loop_poles, closed_loop_verdict, root_locus
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
