"""The gang of four: poles after cancellation, hidden modes found and named, dead time by Nyquist."""

import numpy as np
import pytest
from hypothesis import assume, given

from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.stability import closed_loop_verdict, internal_stability
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import controllers, effort, systems

NAMES = ("S", "PS", "CS", "T")


def internal(P: str, C: str | PID):
    controller = parse_transfer_function(C) if isinstance(C, str) else C
    return internal_stability(FeedbackLoop(parse_transfer_function(P), controller))


def poles(found, name: str) -> list[complex]:
    return sorted(np.round(getattr(found, name).poles, 9) + 0.0, key=lambda z: (z.real, z.imag))


def test_the_example_of_the_notes() -> None:
    """Section 18: G = 3/((s+4)(s-4)), C = (s-4)/s: T looks stable, the input sensitivity has poles 4, -1, -3."""
    found = internal("3/((s+4)(s-4))", "(s-4)/s")
    assert poles(found, "PS") == pytest.approx([-3, -1, 4])
    for name in ("S", "CS", "T"):
        assert poles(found, name) == pytest.approx([-3, -1])
        assert getattr(found, name).stable
    assert not found.PS.stable
    assert not found.internally_stable
    hidden, = found.cancellations  # fmt: skip
    assert (hidden.root, hidden.zero_of, hidden.pole_of, hidden.seen_in) == (4, "controller", "plant", ("PS",))
    assert hidden.text.startswith("the controller's zero at +4 cancels the plant's pole at +4: a hidden unstable mode")
    assert found.because == hidden.text


@pytest.mark.parametrize(
    ("P", "C", "stable", "unstable_in"),
    [
        ("(s-1)/(s+1)^2", "1/(s-1)", False, ["CS"]),
        ("1/(s^2+1)", "(s^2+1)/(s(s+1))", False, ["PS"]),
        ("s/(s+1)", "1/s", False, ["CS"]),
        ("(s+2)/(s+1)", "(s+1)/(s+2)", True, []),
        ("(s-1)/((s-1)(s+1))", "2", False, []),
        ("1/(s+1)", "(s-3)/(s-3)", False, []),
        ("1/(s+1)^3", "1", True, []),
        ("1/(s+1)^3", "9", False, list(NAMES)),
        ("1/(s-1)", "0", False, ["PS"]),
        ("1/((s-1)^2(s+1))", "(s-1)^2/(s+5)^2", False, ["PS"]),
        ("exp(-0.1s)/((s+4)(s-4))", "3(s-4)/s", False, ["PS"]),
        ("exp(-s)/s", "1.5", True, []),
        ("exp(-s)/s", "1.6", False, list(NAMES)),
        ("1", "0.5", True, []),
    ],
)
def test_who_shows_what(P: str, C: str, stable: bool, unstable_in: list[str]) -> None:
    found = internal(P, C)
    assert found.internally_stable == stable
    assert [n for n in NAMES if not getattr(found, n).stable] == unstable_in
    assert found.because
    assert all(getattr(found, n).because for n in NAMES)
    if not stable and not unstable_in:
        assert "none of the four" in found.because


def test_multiplicity() -> None:
    cancelled, = internal("1/((s-1)^2(s+1))", "(s-1)^2/(s+5)^2").cancellations  # fmt: skip
    assert cancelled.multiplicity == 2


def values(loop: FeedbackLoop, s: complex) -> dict[str, complex]:
    P, C = loop.plant(s), loop.C(s)
    return {"S": 1 / (1 + P * C), "PS": P / (1 + P * C), "CS": C / (1 + P * C), "T": P * C / (1 + P * C)}


@effort(60)
@given(systems(order=(1, 3), stable=False), controllers())
def test_each_pole_is_a_pole_of_its_function(P: TransferFunction, C: PID) -> None:
    """Next to a simple pole the function is huge; the four share their poles where nothing cancels."""
    loop = FeedbackLoop(P, C)
    found = internal_stability(loop)
    verdict = closed_loop_verdict(loop)
    assume(verdict.verdict != "marginal")
    assert found.internally_stable == verdict.closed_loop_stable
    everything = found.S.poles
    gap = np.abs(everything[:, None] - everything[None, :]) + 1e9 * np.eye(everything.size)
    assume(everything.size and gap.min() > 1e-2 * np.abs(everything).max())
    # a zero right beside the pole would need a closer look
    roots = np.concatenate([loop.open_loop.zeros, loop.open_loop.poles])
    assume(np.abs(everything[:, None] - roots[None, :]).min(initial=np.inf) > 1e-2 * gap.min())
    for name in NAMES:
        for p in getattr(found, name).poles:
            near, far = (abs(values(loop, p + d * gap.min())[name]) for d in (1e-5, 1e-3))
            assert near > 30 * far


@effort(40)
@given(systems(order=(1, 2), stable=True), systems(order=(1, 2), stable=True, excess=0))
def test_a_planted_cancellation_is_found(P: TransferFunction, C: TransferFunction) -> None:
    """A pole at +0.77 of the plant that the controller cancels: always in PS, never elsewhere, never stable."""
    plant = TransferFunction(P.zeros, [*P.poles, 0.77], P.gain)
    controller = TransferFunction([*C.zeros, 0.77], [*C.poles, -5.0], C.gain)
    loop = FeedbackLoop(plant, controller)
    found = internal_stability(loop)
    assert not found.internally_stable
    assert any(c.root == 0.77 and c.seen_in == ("PS",) and not c.stable for c in found.cancellations)
    assert np.abs(found.PS.poles - 0.77).min() == 0
    for name in ("S", "CS", "T"):
        assert np.abs(getattr(found, name).poles - 0.77).min(initial=1) > 1e-6
    assert closed_loop_verdict(loop).verdict == "unstable"
