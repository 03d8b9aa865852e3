"""The arcs at infinity against their definition: L along a small half circle to the right of each pole on the axis."""

import numpy as np
import pytest
from hypothesis import assume, given

from looplab.engine.frequency.indentation import indentation_arcs
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems


def turned(L: TransferFunction, omega: float, radius: float) -> tuple[float, float, float]:
    """Angle of L at both ends of the indentation [deg], and the angle turned in between, anti-clockwise [deg]."""
    around = np.radians(np.linspace(-90.0, 90.0, 721))
    angle = np.unwrap(np.angle(L(1j * omega + radius * np.exp(1j * around))))
    start, end = np.degrees(angle[[0, -1]])
    return float(start), float(end), float(end - start)


def apart(a: float, b: float) -> float:
    return abs((a - b + 180.0) % 360.0 - 180.0)


@effort(80)
@given(systems(order=(1, 5), stable=False, axis=True, theta=True))
def test_arcs_are_the_images_of_the_indentations(L: TransferFunction) -> None:
    roots = np.concatenate([L.zeros, L.poles])
    gaps = np.abs(roots[:, None] - roots[None, :])
    assume(gaps[gaps > 0].min(initial=1.0) > 1e-2)
    arcs = indentation_arcs(L)
    on_axis = np.unique(L.poles[(L.poles.real == 0) & (L.poles.imag >= 0)].imag)
    assert {a.omega for a in arcs} <= set(on_axis.tolist())
    for arc in arcs:
        start, end, turn = turned(L, arc.omega, 1e-7)
        assert turn == pytest.approx(-arc.turn_deg, abs=0.05)
        assert apart(start, arc.start_deg) < 0.05
        assert apart(end, arc.end_deg) < 0.05
        assert -180 < arc.start_deg <= 180


# Angles by hand: 1/s^m comes from +90 m and leaves at -90 m; at j the rest of 1/((s^2+1)(s+1)) is 1/(2j (1+j)).
@pytest.mark.parametrize(
    ("text", "arcs"),
    [
        ("5/s", [(0, 1, 90, -90)]),
        ("-5/s", [(0, 1, -90, -270)]),
        ("1/(s^2(s+1))", [(0, 2, 180, -180)]),
        ("(s+1)/s^3", [(0, 3, -90, -630)]),
        ("s/(s^2(s+1))", [(0, 1, 90, -90)]),
        ("1/((s^2+1)(s+1))", [(1, 1, -45, -225)]),
        ("1/(s(s^2+4)^2)", [(0, 1, 90, -90), (2, 2, -90, -450)]),
        ("exp(-0.5s)/(s^2+1)", [(1, 1, -28.64788975654116, -208.64788975654116)]),
        ("1/(s+1)", []),
        ("(s^2+1)/((s^2+1)(s+1))", []),
    ],
)
def test_arcs_by_hand(text: str, arcs: list[tuple[float, int, float, float]]) -> None:
    found = indentation_arcs(parse_transfer_function(text))
    assert [(a.omega, a.multiplicity) for a in found] == [(pytest.approx(w), m) for w, m, *_ in arcs]
    for arc, (_, _, start, end) in zip(found, arcs, strict=True):
        assert (arc.start_deg, arc.end_deg) == (pytest.approx(start), pytest.approx(end))
