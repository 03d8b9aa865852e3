"""The reactors: their steady states from the one equation that the balances leave, and which of them hold."""

from itertools import pairwise

import mpmath
import numpy as np
import pytest

from looplab.engine.nonlinear.simulation import simulate_open_loop
from looplab.plants import load_plant

VARIABLE, JACKETED = load_plant("cstr-variable-volume"), load_plant("jacketed-cstr")


def steady(balance, low, high):
    """Every temperature where the balance changes its sign, to 30 digits."""
    with mpmath.workdps(30):
        T = [mpmath.mpf(t) / 2 for t in range(2 * low, 2 * high)]
        changes = [(a, b) for a, b in pairwise(T) if balance(a) * balance(b) < 0]
        return [float(mpmath.findroot(balance, ends, solver="anderson", tol=1e-50)) for ends in changes]


def jacketed_balance(Tc):
    """At rest cA = F/(F + k V), and heat: F (Ti - T) + J k V cA = UA (T - Tc)/(rho cp)."""

    def balance(T):
        k = mpmath.mpf("7.2e10") * mpmath.exp(-8750 / T)
        return 350 - T + 50000 / mpmath.mpf(239) * k / (1 + k) - 50000 / mpmath.mpf(23900) * (T - Tc)

    return balance


def verdict(model, x, u):
    return np.linalg.eigvals(model.state_jacobian(0.0, x, u, model.p0)).real.max()


def test_at_constant_volume_it_is_the_reactor_of_the_notes():
    """Notes 3.1 with Q = 2e6: 331.1, 385.1 (unstable) and 529.6 K; the volume only integrates."""

    def balance(T):
        k = mpmath.mpf("7.2e10") * mpmath.exp(-10000 / T)
        return 330 - T + 200 * k / (1 + k)

    found = steady(balance, 250, 700)
    assert found == pytest.approx([331.1, 385.1, 529.6], abs=0.05)
    for T, unstable in zip(found, (False, True, False), strict=True):
        k = 7.2e10 * np.exp(-1e4 / T)
        x = [100.0, 1 / (1 + k), T]
        assert VARIABLE.f(0.0, x, VARIABLE.u0, VARIABLE.p0) == pytest.approx([0, 0, 0], abs=1e-9)
        poles = np.linalg.eigvals(VARIABLE.state_jacobian(0.0, x, VARIABLE.u0, VARIABLE.p0))
        assert np.abs(poles).min() < 1e-12
        assert (poles.real.max() > 1e-6) == unstable


@pytest.mark.parametrize(("F", "reason"), [(90.0, "the reactor overflows"), (130.0, "the reactor is empty")])
def test_the_volume_integrates_until_it_ends(F, reason):
    found = simulate_open_loop(VARIABLE, np.linspace(0, 10, 201), {"F": F})
    assert found.truncated_reason == reason
    rate = 100 - F
    assert found.x[:, 0] == pytest.approx(100 + rate * found.t, rel=1e-9)
    assert found.truncated_at == pytest.approx((125 - 100) / rate if rate > 0 else (2 - 100) / rate, abs=1e-9)


def test_what_is_fed_flows_out_or_reacts():
    """Integrals of both balances over 5 min, V varying: A in moles, heat in cal above 0 K."""
    t = np.linspace(0, 5, 4001)
    found = simulate_open_loop(VARIABLE, t, {"F": 97.0, "Ti": 360.0}, rtol=1e-11)
    V, cA, T = found.x.T
    r = 7.2e10 * np.exp(-1e4 / T) * cA

    def integral(y):
        return (t[2] - t[0]) / 6 * (y[:-2:2] + 4 * y[1:-1:2] + y[2::2]).sum()

    moles, heat = V * cA, 1000 * V * T
    assert moles[-1] - moles[0] == pytest.approx(5 * 100 - integral(97 * cA + r * V), rel=1e-8)
    fed = 5 * 1000 * 100 * 360
    assert heat[-1] - heat[0] == pytest.approx(fed + integral(2e5 * r * V - 97_000 * T) - 5 * 2e6, abs=1e-8 * fed)


@pytest.mark.parametrize(
    ("Tc", "expected"),
    [(290, ["holds"]), (300, ["holds", "unstable", "unstable"]), (305, ["unstable"]), (310, ["holds"])],
)
def test_the_jacket_decides_how_many_steady_states_there_are(Tc, expected):
    u = JACKETED.inputs({"Tc": Tc})
    found = steady(jacketed_balance(Tc), 280, 480)
    states = [[1 / (1 + 7.2e10 * np.exp(-8750 / T)), T] for T in found]
    for x in states:
        assert JACKETED.f(0.0, x, u, JACKETED.p0) == pytest.approx([0, 0], abs=1e-10)
    assert ["unstable" if verdict(JACKETED, x, u) > 0 else "holds" for x in states] == expected
    for point in JACKETED.document.operating_points:
        if point.inputs.get("Tc", 300) == Tc:
            assert min(abs(point.near["T"] - T) for T in found) < 0.05, point.name


def test_the_middle_state_is_that_of_the_book():
    """Seborg et al., Table 2.3: cA = 0.5 mol/l and T = 350 K at Tc = 300 K."""
    T = steady(jacketed_balance(300), 280, 480)[1]
    assert T == pytest.approx(350, abs=0.01)
    assert 1 / (1 + 7.2e10 * np.exp(-8750 / T)) == pytest.approx(0.5, abs=1e-4)


def test_at_305_K_it_swings_for_ever():
    found = simulate_open_loop(JACKETED, np.linspace(0, 60, 4001), {"Tc": 305.0})
    T = found.x[found.t > 30, 1]
    peaks = T[1:-1][(T[1:-1] > T[:-2]) & (T[1:-1] > T[2:])]
    assert len(peaks) > 10
    assert np.ptp(T) > 40
    assert peaks == pytest.approx(peaks[0], abs=0.2)
