"""Random feedback loops of every kind, the same ones in every run, and L(s) straight from the numbers they are made of.

Each loop is written down in factors that no code of the engine has touched: (s - r), (s^2 + 2 zeta w s + w^2), and the
controller's own formula.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.systems import TransferFunction

FORMS = ("P", "PI", "PD ideal", "PD series", "PID ideal", "PID series", "PID parallel", "PID direct")
KINDS = ("stable", "stable", "integrating", "unstable", "resonant", "inverse response", "double integrator")


@dataclass(frozen=True)
class Factors:
    """gain prod(zeros) / prod(poles) e^{-theta s}; a factor is (r,) for s - r or (zeta, w) for a pair of roots."""

    gain: float
    zeros: tuple[tuple[float, ...], ...]
    poles: tuple[tuple[float, ...], ...]
    theta: float

    def __call__(self, s: np.ndarray) -> np.ndarray:
        return self.gain * _product(self.zeros, s) / _product(self.poles, s) * np.exp(-self.theta * s)


def _product(factors: Sequence[tuple[float, ...]], s: np.ndarray) -> np.ndarray:
    out = np.ones_like(np.asarray(s, dtype=complex))
    for f in factors:
        out = out * (s - f[0] if len(f) == 1 else s * s + 2 * f[0] * f[1] * s + f[1] ** 2)
    return out


def _roots(factors: Sequence[tuple[float, ...]]) -> list[complex]:
    out: list[complex] = []
    for f in factors:
        if len(f) == 1:
            out.append(complex(f[0]))
        else:
            zeta, w = f
            p = complex(-zeta * w, w * np.sqrt(1 - zeta**2))
            out += [p, p.conjugate()]
    return out


@dataclass(frozen=True)
class RandomLoop:
    """One loop; ``kind`` and ``form`` say what it is an example of."""

    number: int
    kind: str
    form: str
    plant: Factors
    loop: FeedbackLoop = field(repr=False)

    @property
    def controller(self) -> PID:
        c = self.loop.controller
        assert isinstance(c, PID)
        return c

    def per_gain(self, s: np.ndarray) -> np.ndarray:
        """L0(s) = L(s)/Kc, with the formula of the controller's form."""
        c = self.controller
        integral = 1 / (c.tau_I * s) if c.tau_I is not None else 0.0
        tau_D = c.tau_D or 0.0
        lag = c.alpha * tau_D * s + 1
        if c.form == "series":
            return (1 + integral) * (tau_D * s + 1) / lag * self.plant(s)
        return (1 + integral + tau_D * s / lag) * self.plant(s)

    def open_loop(self, s: np.ndarray) -> np.ndarray:
        """L(s)."""
        return self.loop.gain * self.per_gain(s)

    @cached_property
    def roots(self) -> tuple[list[complex], list[complex], float]:
        """Zeros, poles and leading gain of L0, the controller's from its polynomials."""
        c = self.controller
        tau_D, tau_I = c.tau_D or 0.0, c.tau_I
        lag = [c.alpha * tau_D, 1.0] if tau_D else [1.0]
        integral = [tau_I, 0.0] if tau_I is not None else [1.0]
        if c.form == "series":
            num = np.polymul([tau_I, 1.0] if tau_I is not None else [1.0], [tau_D, 1.0] if tau_D else [1.0])
        else:
            num = np.polymul(integral, lag)
            if tau_I is not None:
                num = np.polyadd(num, lag)
            if tau_D:
                num = np.polyadd(num, np.polymul([tau_D, 0.0], integral))
        den = np.polymul(integral, lag)
        zeros = [*_roots(self.plant.zeros), *np.roots(num).tolist()]
        poles = [*_roots(self.plant.poles), *np.roots(den).tolist()]
        return zeros, poles, float(self.plant.gain * num[0] / den[0])


def _real(rng: np.random.Generator) -> float:
    return float(f"{10 ** rng.uniform(-0.8, 0.8):.3g}")


def _pair(rng: np.random.Generator, low: float, high: float) -> tuple[float, float]:
    return float(f"{rng.uniform(low, high):.2g}"), _real(rng)


def _plant(rng: np.random.Generator, kind: str, order: int, theta: float) -> Factors:
    poles: list[tuple[float, ...]] = []
    if kind == "integrating":
        poles.append((0.0,))
    elif kind == "double integrator" and order > 1:
        poles += [(0.0,), (0.0,)]
    elif kind == "unstable":
        poles.append(_pair(rng, -0.6, -0.05) if order > 1 and rng.random() < 0.4 else (_real(rng),))
    elif kind == "resonant" and order > 1:
        poles.append(_pair(rng, 0.02, 0.2))
    while (left := order - len(_roots(poles))) > 0:
        if left > 1 and rng.random() < 0.35:
            poles.append(_pair(rng, 0.1, 0.95))
        elif poles and rng.random() < 0.1 and len(poles[-1]) == 1 and poles[-1][0] < 0:
            poles.append(poles[-1])
        else:
            poles.append((-_real(rng),))
    zeros: list[tuple[float, ...]] = []
    if kind == "inverse response":
        zeros.append((_real(rng),))
        if order > 2 and rng.random() < 0.3:
            zeros.append(_pair(rng, -0.8, -0.1))
    room = order - len(_roots(zeros)) - int(rng.random() < 0.9)
    while room > 0 and rng.random() < 0.4:
        zeros.append(_pair(rng, 0.1, 0.9) if room > 1 and rng.random() < 0.3 else (-_real(rng),))
        room = order - len(_roots(zeros)) - 1
    return Factors(1.0, tuple(zeros), tuple(poles), theta)


def _pid(rng: np.random.Generator, form: str, Kc: float) -> PID:
    tau_I, tau_D, alpha = _real(rng), float(f"{0.3 * _real(rng):.3g}"), float(rng.choice([0.05, 0.1, 0.2]))
    match form:
        case "P":
            return PID(Kc)
        case "PI":
            return PID(Kc, tau_I)
        case "PD ideal" | "PD series":
            return PID(Kc, None, tau_D, alpha, form.split()[1])
        case "PID parallel":
            return PID.from_parallel(Kc, Kc / tau_I, Kc * tau_D, alpha)
        case "PID direct":
            return PID(-Kc, tau_I, tau_D, alpha, action="direct")
    return PID(Kc, tau_I, tau_D, alpha, form.split()[1])


def random_loops(count: int = 500, seed: int = 20260) -> list[RandomLoop]:
    """``count`` loops; kinds, forms, orders and dead time go round so that each meets each."""
    rng = np.random.default_rng(seed)
    out: list[RandomLoop] = []
    while len(out) < count:
        i = len(out)
        kind, form = KINDS[i % len(KINDS)], FORMS[i % len(FORMS)]
        order = int(rng.integers(1, 11))
        theta = float(f"{10 ** rng.uniform(-1.3, 0.5):.3g}") if rng.random() < 0.4 else 0.0
        shape = _plant(rng, kind, order, theta)
        # A gain that puts a crossover among the corners, or well below.
        w = 10 ** rng.uniform(-1.0, 1.0)
        size = abs(shape(np.array(1j * w)))
        sign = -1.0 if rng.random() < 0.1 else 1.0
        rhp = sum(1 for f in (*shape.zeros, *shape.poles) if len(f) == 1 and f[0] > 0)
        gain = float(f"{sign * (-1.0) ** rhp * 10 ** rng.uniform(-1.0, 0.5) / size:.3g}")
        plant = Factors(gain, shape.zeros, shape.poles, theta)
        controller = _pid(rng, form, float(f"{10 ** rng.uniform(-0.5, 0.5):.3g}"))
        system = TransferFunction(_roots(plant.zeros), _roots(plant.poles), gain, theta)
        end = abs(controller.to_transfer_function().high_frequency_gain * system.high_frequency_gain)
        if end >= 0.95:
            continue  # biproper: with dead time neutral and unstable, without it close to ill-posed
        out.append(RandomLoop(i, kind, form, plant, FeedbackLoop(system, controller)))
    return out
