"""The inverted pendulum: its poles, its energy, its fall."""

import numpy as np
import pytest

from looplab.engine.nonlinear.simulation import simulate_open_loop
from looplab.plants import load_plant

PENDULUM = load_plant("cart-pendulum")
M, m, MU, L, J, GAMMA, G = 0.5, 0.2, 0.1, 0.3, 0.006, 0.01, 9.8


def characteristic(side: int) -> list[float]:
    """Coefficients of det(s I - A)/s at the upright (side 1) or hanging (side -1) pendulum.

    From (M + m) s^2 x + side m l s^2 phi + mu s x = F and J_t s^2 phi + side m l s^2 x + gamma s phi = side m g l phi,
    J_t = J + m l^2: ((M + m) s + mu)(J_t s^2 + gamma s - side m g l) - (m l)^2 s^3 = 0.
    """
    cart, rod = [M + m, MU], [J + m * L**2, GAMMA, -side * m * G * L]
    return np.polysub(np.polymul(cart, rod), [(m * L) ** 2, 0, 0, 0]).tolist()


@pytest.mark.parametrize(("phi", "side"), [(0.0, 1), (np.pi, -1)])
def test_the_poles_are_those_of_the_closed_form(phi, side):
    A = PENDULUM.state_jacobian(0.0, [0.0, 0.0, phi, 0.0], PENDULUM.u0, PENDULUM.p0)
    expected = np.sort_complex(np.append(np.roots(characteristic(side)), 0.0))
    assert np.sort_complex(np.linalg.eigvals(A)) == pytest.approx(expected, abs=1e-10)


def test_the_upright_poles_are_those_of_the_notes():
    A = PENDULUM.state_jacobian(0.0, [0.0] * 4, PENDULUM.u0, PENDULUM.p0)
    assert np.sort(np.linalg.eigvals(A).real) == pytest.approx([-5.876, -0.143, 0.0, 5.307], abs=1e-3)


def test_hanging_it_swings_and_rests():
    A = PENDULUM.state_jacobian(0.0, [0.0, 0.0, np.pi, 0.0], PENDULUM.u0, PENDULUM.p0)
    poles = np.linalg.eigvals(A)
    assert np.abs(poles.imag).max() > 5
    assert np.sort(poles.real)[:3].max() < 0


def test_without_friction_the_energy_stays():
    t = np.linspace(0, 10, 501)
    found = simulate_open_loop(
        PENDULUM, t, parameters={"mu": 0, "gamma": 0, "x_end": 1000}, initial={"phi": 1.0, "v": 0.3}, rtol=1e-12
    )
    p = PENDULUM.parameters({"mu": 0, "gamma": 0})
    energy = np.array([PENDULUM.variables(0.0, x.tolist(), PENDULUM.u0, p)[-1] for x in found.x])
    # kinetic energy of the cart and of the rod's centre and turn, by Koenig's theorem
    _, v, phi, omega = found.x.T
    centre = (v + L * omega * np.cos(phi)) ** 2 + (L * omega * np.sin(phi)) ** 2
    koenig = 0.5 * M * v**2 + 0.5 * m * centre + 0.5 * J * omega**2 + m * G * L * np.cos(phi)
    assert energy == pytest.approx(koenig, abs=1e-12)
    assert energy == pytest.approx(energy[0], abs=1e-8)


def test_it_falls_and_says_so():
    found = simulate_open_loop(PENDULUM, np.linspace(0, 2, 101))
    fallen = found.events[0]
    assert fallen.message == "the pendulum has fallen past the horizontal"
    assert fallen.t < 1
    assert abs(fallen.x[2]) == pytest.approx(np.pi / 2, abs=1e-8)
    assert found.truncated_at is None


def test_the_cart_stops_at_the_end_of_its_track():
    found = simulate_open_loop(PENDULUM, np.linspace(0, 5, 101), {"F": 2.0})
    assert found.truncated_reason == "the cart hits the end of the track"
    assert found.x[-1, 0] == pytest.approx(1.2, abs=1e-9)
