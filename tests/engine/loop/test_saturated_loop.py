"""The saturated linear loop: two ways of computing it, another simulator, exact linear loops and definitions."""

import numpy as np
import pytest
from scipy.linalg import expm

from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID, SaturatedLoop, simulate_saturated
from looplab.engine.loop.saturated_loop import _numbers, in_blocks, one_by_one
from looplab.engine.systems import parse_transfer_function

PLANTS = {
    "three lags": "1/(s+1)^3",
    "integrator": "0.5/(s*(s+1))",
    "unstable": "1/((s-0.5)*(0.2*s+1))",
    "oscillator": "(1-0.3*s)/(s^2+0.4*s+1)",
}
CONTROLLERS = {
    "P": PID(1.5),
    "PI": PID(2.0, 1.2),
    "PID": PID(4.0, 1.5, 0.4),
    "weighted": PID(4.0, 1.5, 0.4, 0.2, beta=0.3),
    "wild": PID(60.0, 0.2, 0.3),
}
METHODS = ["none", "back_calculation", "clamping"]


def loop(plant="1/(s+1)^3", controller=CONTROLLERS["PID"], h=0.1, low=-0.5, high=1.4, method="none", **more):
    return SaturatedLoop(parse_transfer_function(plant), controller, h, low, high, method, **more)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("controller", CONTROLLERS)
@pytest.mark.parametrize("plant", PLANTS)
def test_the_two_ways_agree_to_rounding(plant, controller, method):
    case = loop(PLANTS[plant], CONTROLLERS[controller], method=method)
    k = _numbers(case)
    # From limit to limit the wild one is chaotic: each round multiplies the last digit's difference.
    samples = 100 if controller == "wild" else 300
    blocks, steps = in_blocks(case, k, samples, 1.0, 0.1), one_by_one(case, k, samples, 1.0, 0.1)
    # Up to where an unstable loop has forgotten its digits.
    calm = np.abs(steps).max(axis=1).cumsum() < 1e4
    scale = np.abs(steps[calm]).max()
    np.testing.assert_allclose(blocks[calm], steps[calm], atol=1e-10 * scale)


def by_hand(plant, controller, h, low, high, method, samples, T_t, delay=0.0, d=0.0):
    """The algorithm written out, with the plant carried by exp(A t) in companion form."""
    num, den = plant
    n = len(den) - 1
    A = np.zeros((n, n))
    A[0], A[1:, :-1] = -np.array(den[1:]) / den[0], np.eye(n - 1)
    B = np.eye(n)[0]
    C = np.pad(num, (n - len(num), 0)) / den[0]
    M = np.zeros((n + 1, n + 1))
    M[:n, :n], M[:n, n] = A, B
    x, integral, D, last, sent, out = np.zeros(n), 0.0, 0.0, 0.0, [], []
    Kc, T_f = controller.Kc, controller.alpha * (controller.tau_D or 0.0)
    whole, part = int(delay / h + 1e-9), delay % h if delay % h < h * (1 - 1e-9) else 0.0
    for k in range(samples + 1):
        y = C @ x
        e = 1.0 - y
        D = (T_f * D + Kc * (controller.tau_D or 0.0) * (e - last)) / (T_f + h)
        step = Kc * h / controller.tau_I * e
        v = Kc * (controller.beta - y) + D + integral + step
        if method == "clamping" and ((v > high and step > 0) or (v < low and step < 0)):
            v, step = v - step, 0.0
        u = min(max(v, low), high)
        integral += step + (min(1.0, h / T_t) * (u - v) if method == "back_calculation" else 0.0)
        last = e
        out.append((y, v, u))
        sent.append(u)
        before = sent[k - whole - 1] if k > whole else 0.0
        after = sent[k - whole] if k >= whole else 0.0
        for value, time in ((before, part), (after, h - part)):
            x = (expm(M * time) @ np.append(x, value + d))[:n]
    return np.array(out)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("delay", [0.0, 0.1, 0.04, 0.73])
def test_the_algorithm_written_out(method, delay):
    controller = CONTROLLERS["weighted"]
    text = f"2/((s+1)*(0.5*s+1)) * exp(-{delay}*s)" if delay else "2/((s+1)*(0.5*s+1))"
    found = simulate_saturated(loop(text, controller, method=method, T_t=0.8, high=0.9), 150, d=0.05)
    plant = ([2.0], [0.5, 1.5, 1.0])
    expected = by_hand(plant, controller, 0.1, -0.5, 0.9, method, 150, 0.8, delay, d=0.05)
    np.testing.assert_allclose(np.stack([found.y, found.u_command, found.u], axis=1), expected, atol=1e-11)
    assert (found.u == 0.9).any()


def test_far_limits_are_none():
    free = simulate_saturated(loop(low=-np.inf, high=np.inf), 200)
    wide = simulate_saturated(loop(low=-1e6, high=1e6, method="clamping"), 200)
    np.testing.assert_allclose(free.y, wide.y, atol=1e-13)
    assert free.y[-1] == pytest.approx(1.0, abs=1e-3)


def test_windup_and_its_cures():
    """u = 0.5 cannot reach r = 1: the integral grows by Kc h/tau_I e, v - u settles at T_t times that, or it stands."""
    cases = {m: simulate_saturated(loop("1/(s+1)", PID(2.0, 1.0), high=0.5, method=m, T_t=0.7), 400) for m in METHODS}
    v = {name: found.u_command for name, found in cases.items()}
    assert v["none"][-1] - v["none"][-2] == pytest.approx(2.0 * 0.1 * 0.5, rel=1e-9)
    assert v["back_calculation"][-1] - 0.5 == pytest.approx(0.7 * 2.0 * 0.5, rel=1e-9)
    assert v["clamping"][-1] == v["clamping"][-2] < 2.0


def test_direct_action_is_the_mirror():
    up, down = (simulate_saturated(loop(controller=c), 50).y for c in (PID(-2.0, 1.0), PID(2.0, 1.0, action="direct")))
    assert np.array_equal(up, down)


def test_an_unstable_loop_is_cut():
    found = simulate_saturated(loop(controller=PID(100.0), low=-np.inf, high=np.inf), 5000)
    assert found.truncated_reason is not None
    assert found.truncated_at == pytest.approx(found.t[-1] + 0.1)
    assert np.isfinite(found.y).all()


@pytest.mark.parametrize(
    ("more", "field"),
    [
        ({"plant": "(s+2)/(s+1)"}, "plant"),
        ({"h": 0.0}, "h"),
        ({"low": 2.0}, "u_max"),
        ({"method": "hope"}, "anti_windup"),
        ({"controller": PID(1.0, 1.0, form="series")}, "controller.form"),
        ({"plant": "exp(-50*s)/(s+1)", "h": 1e-3}, "h"),
    ],
)
def test_settings_out_of_range_are_named(more, field):
    with pytest.raises(InvalidInput) as error:
        loop(**more)
    assert error.value.field == field
