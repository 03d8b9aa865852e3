"""POST /loop: golden values to the printed digits, keys, and the shape of the answer."""

from collections.abc import Callable
from typing import Any, get_args

import numpy as np
import pytest

from looplab.api.answers.loop import LoopAnswer
from looplab.api.routes.loop import ON_REQUEST, PanelName

Ask = Callable[..., dict[str, Any]]

ZN = "1/(s+1)^3"
ZN_PI = {"Kc": 3.6, "tau_I": 3.0230}
ZN_PID = {"Kc": 4.8, "tau_I": 1.8138, "tau_D": 0.45345, "alpha": 0.1}
DELAYED = "exp(-0.1s)/(0.5s+1)"


# Recomputed worked values of the lecture notes, section 19.1.1: Ziegler-Nichols on 1/(s+1)^3.
def test_ziegler_nichols_pi_as_printed(loop_of: Ask) -> None:
    panels = loop_of(ZN, ZN_PI, want=["margins", "metrics"])
    margins, metrics = panels["margins"], panels["metrics"]["setpoint"]
    assert round(metrics["overshoot_pct"], 1) == 56.1
    assert round(margins["GM"], 2) == 1.52
    assert round(margins["PM_deg"], 1) == 14.8
    assert round(margins["Ms"], 2) == 4.93


def test_ziegler_nichols_pid_as_printed(loop_of: Ask) -> None:
    panels = loop_of(ZN, ZN_PID, want=["margins", "metrics"])
    margins, metrics = panels["margins"], panels["metrics"]["setpoint"]
    assert round(metrics["overshoot_pct"], 1) == 42.7
    assert round(margins["PM_deg"], 1) == 29.4
    assert round(margins["Ms"], 2) == 2.24
    assert round(metrics["t_settle"], 2) == 9.19


# Section 17.3.1: GM = 5 dB and PM = 30 deg on exp(-0.1 s)/(0.5 s + 1), then another dead time and time constant.
@pytest.mark.parametrize(
    ("plant", "Kc", "stable", "expected"),
    [
        (DELAYED, 4.781, True, {"GM_dB": (5.00, 2), "omega_180": (16.887, 3), "PM_deg": (48.5, 1)}),
        ("exp(-0.15s)/(0.5s+1)", 4.781, True, {"GM_dB": (1.81, 2), "PM_deg": (21.7, 1)}),
        (DELAYED, 6.136, True, {"GM_dB": (2.83, 2), "PM_deg": (30.0, 1)}),
        ("exp(-0.15s)/(0.5s+1)", 6.136, False, {}),
        ("exp(-0.1s)/(0.25s+1)", 6.136, False, {}),
        ("exp(-0.15s)/(0.5s+1)", 5.889, True, {}),
        ("exp(-0.15s)/(0.5s+1)", 5.891, False, {}),
        ("exp(-0.1s)/(0.25s+1)", 4.586, True, {}),
        ("exp(-0.1s)/(0.25s+1)", 4.588, False, {}),
    ],
)
def test_margin_exercise(
    loop_of: Ask, plant: str, Kc: float, stable: bool, expected: dict[str, tuple[float, int]]
) -> None:
    panels = loop_of(plant, {"Kc": Kc}, want=["margins", "verdict"])
    assert panels["margins"]["closed_loop_stable"] is stable
    assert panels["verdict"]["closed_loop_stable"] is stable
    for name, (value, digits) in expected.items():
        assert round(panels["margins"][name], digits) == value, name


# Section 16: breakaways of 2(s+1)/(s(s-4)), stable for K > 2.
def test_root_locus_of_the_notes(loop_of: Ask) -> None:
    locus = loop_of("2(s+1)/(s(s-4))", {"Kc": 3.0}, want=["root_locus"])["root_locus"]
    found = [(round(b["s"][0], 3), round(b["K"], 3)) for b in locus["breakaways"]]
    assert found == [(1.236, 0.764), (-3.236, 5.236)]
    assert [(round(c["omega"], 9), round(c["K"], 9)) for c in locus["imaginary_axis_crossings"]] == [(2.0, 2.0)]
    assert loop_of("2(s+1)/(s(s-4))", {"Kc": 2.01}, want=["verdict"])["verdict"]["closed_loop_stable"]
    assert not loop_of("2(s+1)/(s(s-4))", {"Kc": 1.99}, want=["verdict"])["verdict"]["closed_loop_stable"]


# Section 18: the cancelled unstable pole of C = (s-4)/s with G = 3/((s+4)(s-4)) stays: poles 4, -1, -3.
def test_hidden_unstable_mode(post: Any) -> None:
    loop = {
        "plant": {"type": "expr", "text": "3/((s+4)(s-4))"},
        "controller": {"type": "expr", "text": "(s-4)/s"},
    }
    panels = post("/loop", {"loop": loop, "want": ["verdict", "poles"]}).json()["panels"]
    assert panels["verdict"]["verdict"] == "unstable"
    assert sorted(re for re, _ in panels["poles"]["poles"]) == pytest.approx([-3, -1, 4], abs=1e-12)


def test_step_response_of_an_integrator_with_dead_time(loop_of: Ask) -> None:
    """y of e^{-s}/s under P control is the piecewise polynomial sum (-1)^(k-1) Kc^k (t-k)^k/k!."""
    from math import factorial

    Kc = 0.7
    step = loop_of("exp(-s)/s", {"Kc": Kc}, want=["step"], horizon=15, points=301)["step"]
    t = np.array(step["t"])
    exact = sum((-1) ** (k - 1) * Kc**k * np.maximum(t - k, 0) ** k / factorial(k) for k in range(1, 16))
    assert np.abs(np.array(step["setpoint"]["y"]) - exact).max() < 1e-11
    assert np.abs(np.array(step["setpoint"]["u"]) - Kc * (1 - exact)).max() < 1e-11


# Fifty lags cost seconds, and differ in their numbers, not in how these are written.
SLOW = "1/(s+1)^50"
PLANTS = ["1/(s+1)^3", "exp(-0.1s)/(.5s+1)", "exp(-s)", "4", "0", "1/s", "-1/(s+1)", "1/(s^2+1)", "s/(s+1)",
          "(s^2+1)/(s+1)^3", "exp(-s)(2s+1)/(s+1)", "1/(s-1)", SLOW, "exp(-20s)/(s+1)"]  # fmt: skip
SETTINGS = [
    {"Kc": 0.5, "tau_I": 2, "tau_D": 0.5},
    {"Kc": 0},
    {"Kc": -0.4},
    {"Kc": 4, "tau_I": 0.1, "form": "series", "tau_D": 0.1},
    {"Kc": 0.5, "tau_I": 2, "beta": 0.5, "action": "direct"},
]


ENCODED = [(plant, arrays) for plant in PLANTS for arrays in ("list", "f4") if (plant, arrays) != (SLOW, "f4")]


@pytest.mark.parametrize(("plant", "arrays"), ENCODED)
@pytest.mark.parametrize("settings", SETTINGS, ids=str)
def test_every_answer_has_the_described_shape(post: Any, plant: str, settings: dict[str, Any], arrays: str) -> None:
    loop = {"plant": {"type": "expr", "text": plant}, "controller": {"type": "pid", **settings}}
    answer = post("/loop", {"loop": loop, "want": get_args(PanelName), "arrays": arrays})
    assert answer.status_code == 200, answer.text
    parsed = LoopAnswer.model_validate_json(answer.content)
    panels = parsed.panels
    assert panels.verdict is not None
    assert panels.margins is not None
    assert panels.verdict.closed_loop_stable == panels.margins.closed_loop_stable
    for name, value in panels.margins.model_dump().items():
        if value is None and name not in panels.margins.reasons:
            pytest.fail(f"{name} is null without a reason")
    assert panels.metrics is not None
    for side in (panels.metrics.setpoint, panels.metrics.load):
        unexplained = [n for n, v in side.model_dump().items() if v is None and n not in side.reasons]
        assert not unexplained


def test_an_unchanged_panel_is_left_out(post: Any) -> None:
    def ask(Kc: float, have: dict[str, str]) -> dict[str, Any]:
        loop = {"plant": {"type": "expr", "text": ZN}, "controller": {"type": "pid", **ZN_PI, "Kc": Kc}}
        body: dict[str, Any] = post("/loop", {"loop": loop, "have": have}).json()
        return body

    first = ask(3.6, {})
    keys = {name: panel["key"] for name, panel in first["panels"].items()}
    # The locus depends on the plant and tau_I but not on the gain.
    assert ask(3.7, keys)["unchanged"] == ["root_locus"]
    same = ask(3.6, keys)
    assert same["panels"] == {}
    assert set(same["unchanged"]) == set(keys)


def test_what_explains_more_closely_comes_on_request(loop_of: Ask) -> None:
    assert set(loop_of(ZN, ZN_PI)) == set(get_args(PanelName)) - set(ON_REQUEST)
    panels = loop_of(ZN, ZN_PI, want=list(ON_REQUEST))
    assert set(panels) == set(ON_REQUEST)
    integral, lags = panels["asymptotes"]["corners"]
    assert (integral["kind"], integral["slope_change"]) == ("zero", 1)
    assert (lags["s"], lags["multiplicity"], lags["slope_change"]) == ([-1, 0], 3, -3)
    # K -> -K: the asymptotes lie between those of K > 0, 0 and +-120 deg.
    assert panels["root_locus_negative"]["asymptotes"]["angles_deg"] == [0, 120, 240]


def test_the_gang_of_six_with_a_setpoint_weight(loop_of: Ask) -> None:
    """1/(s+1) with Kc = 2, beta = 1/2: C + F = 1, so r to y is 1/(s+3) and T 2/(s+3)."""
    settings = {"Kc": 2, "beta": 0.5}
    panels = loop_of("1/(s+1)", settings, want=["sensitivity", "gang_steps"], omega=[0.01, 100], horizon=3)
    gang, steps = panels["sensitivity"], panels["gang_steps"]
    omega = np.array(gang["omega"])
    assert gang["feedforward"] == steps["feedforward"] == -1
    expected = -20 * np.log10(np.hypot(3, omega))
    assert np.abs(gang["TF_dB"] - expected).max() < 1e-12
    assert np.abs(gang["T_dB"] - (expected + 20 * np.log10(2))).max() < 1e-12
    assert np.abs(np.array(steps["TF"]) - (1 - np.exp(-3 * np.array(steps["t"]))) / 3).max() < 1e-13


def test_f4_arrays_are_the_numbers(loop_of: Ask) -> None:
    import base64

    exact = np.array(loop_of(ZN, ZN_PI, want=["step"])["step"]["setpoint"]["y"])
    packed = loop_of(ZN, ZN_PI, want=["step"], arrays="f4")["step"]["setpoint"]["y"]
    assert packed["dtype"] == "f4"
    assert np.abs(np.frombuffer(base64.b64decode(packed["bdata"]), "<f4") - exact).max() < 1e-6


def test_a_direct_acting_controller_suits_a_negative_gain(loop_of: Ask) -> None:
    direct = loop_of("-2/(s+1)^3", {"Kc": 1, "tau_I": 2, "action": "direct"}, want=["verdict", "metrics"])
    reverse = loop_of("2/(s+1)^3", {"Kc": 1, "tau_I": 2}, want=["verdict", "metrics"])
    assert direct["verdict"]["closed_loop_stable"]
    a, b = direct["metrics"]["setpoint"], reverse["metrics"]["setpoint"]
    assert a["overshoot_pct"] == pytest.approx(b["overshoot_pct"], rel=1e-9)
    assert a["IAE"] == pytest.approx(b["IAE"], rel=1e-9)


@pytest.mark.parametrize(("plant", "Kc"), [("0/(s+1)", 2.0), ("1/(s+1)", 0.0)])
def test_a_loop_that_is_cut(loop_of: Ask, plant: str, Kc: float) -> None:
    """L = 0: S = 1, PS = P, CS = C, T = 0; what is zero has no decibels and no straight lines."""
    panels = loop_of(plant, {"Kc": Kc}, want=["bode", "sensitivity", "asymptotes"])
    bode, sensitivity = panels["bode"], panels["sensitivity"]
    assert bode["L"] is None
    assert sensitivity["T_dB"] is None
    assert sensitivity["omega"] == bode["omega"]
    assert np.abs(sensitivity["S_dB"]).max() == 0.0
    for name, curve in (("PS_dB", bode["P"]), ("CS_dB", bode["C"])):
        if curve is None:
            assert sensitivity[name] is None
        else:
            assert sensitivity[name] == pytest.approx(curve["mag_dB"], abs=1e-12)
    assert panels["asymptotes"]["omega"] == panels["asymptotes"]["corners"] == []
