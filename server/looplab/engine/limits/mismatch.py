"""What a wrong model leaves: its error as a weight over frequency, and whether the loop is safe from it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.frequency.response import default_grid
from looplab.engine.limits.frequency_search import first_rise, highest, widened
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning.sensitivity import LARGEST_SPREAD, perturbed_plant

FloatArray = npt.NDArray[np.float64]

TAU_FACTORS = 33
CURVE_POINTS = 300


@dataclass(frozen=True)
class Spread:
    """How far gain, time constants and dead time may be off, each by -p to +p per cent [%]."""

    K_pct: float = 20.0
    tau_pct: float = 20.0
    theta_pct: float = 20.0

    def __post_init__(self) -> None:
        for name in ("K_pct", "tau_pct", "theta_pct"):
            if not 0.0 <= getattr(self, name) <= LARGEST_SPREAD:
                raise InvalidInput(f"the spread must be from 0 to {LARGEST_SPREAD:g} %", field=name)


@dataclass(frozen=True)
class Mismatch:
    r"""The loop against every plant within the spread.

    Attributes
    ----------
    omega_limit : float or None
        Where the model error first reaches the size of the model itself [rad/time]; None where it never does.
    peak, omega_peak : float
        Largest \|T\| times the weight, and where [-], [rad/time].
    robustly_stable : bool
        The peak is below 1: stable on every plant within the spread.
    worst_S : float or None
        Bound on \|S_Delta\| = 1/\|1 + T G_Delta\|, by which the error of the loop may grow [-]; None where the peak is
        not below 1.
    omega, weight, T : ndarray, shape (n,)
        \|G_Delta\| at its largest, and \|T\| [-], over omega [rad/time].
    """

    omega_limit: float | None
    peak: float
    omega_peak: float
    robustly_stable: bool
    worst_S: float | None
    omega: FloatArray
    weight: FloatArray
    T: FloatArray


@lru_cache(maxsize=32)
def _other_time_constants(plant: TransferFunction, tau_pct: float) -> tuple[TransferFunction, ...]:
    """The plant without its dead time, its time constants within -tau_pct to +tau_pct per cent."""
    rational, q = plant.without_dead_time(), 0.01 * tau_pct
    factors = np.geomspace(1.0 - q, 1.0 + q, TAU_FACTORS).tolist() if q else [1.0]
    return tuple(perturbed_plant(rational, 1.0, factor, 1.0) for factor in factors)


def multiplicative_weight(plant: TransferFunction, spread: Spread, omega: FloatArray) -> FloatArray:
    r"""Largest relative model error over all plants whose gain, time constants and dead time lie within the spread.

    .. math:: w(\omega) = \max_{G'} |G_\Delta(i\omega)|, \qquad G_\Delta = \frac{G' - G}{G}, \qquad
        1 + G_\Delta = k_K\, \frac{G_0(k_\tau i\omega)}{G_0(i\omega)}\, e^{-(k_\theta - 1)\theta i\omega}

    For a given factor of the time constants the worst gain and dead time are found in closed form: the angle that comes
    nearest to pi, and one end of the gain. Over the time constants it is the largest of 33 factors, ends included.

    Parameters
    ----------
    plant : TransferFunction
        G, dead time exact.
    spread : Spread
    omega : ndarray, shape (n,)
        > 0 [rad/time].

    Returns
    -------
    ndarray, shape (n,)
        [-]; the additive error is w times \|G\|.

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 7.4.
    """
    p = 0.01 * spread.K_pct
    own = plant.without_dead_time().response(omega)
    reach = 0.01 * spread.theta_pct * plant.theta * omega
    worst = np.zeros(omega.shape)
    for other in _other_time_constants(plant, spread.tau_pct):
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = other.response(omega) / own
        # The dead time turns the error by up to ``reach`` either way; half a turn is the worst.
        angle = np.minimum(np.abs(np.angle(ratio)) + reach, np.pi)
        turned = np.abs(ratio) * np.exp(1j * angle)
        for k in (1.0 - p, 1.0 + p):
            worst = np.fmax(worst, np.abs(k * turned - 1.0))
    return worst


def log_weight(plant: TransferFunction, spread: Spread, omega: FloatArray) -> FloatArray:
    """ln of multiplicative_weight; -inf where there is no error."""
    with np.errstate(divide="ignore"):
        return np.log(multiplicative_weight(plant, spread, omega))


@lru_cache(maxsize=32)
def full_error(plant: TransferFunction, spread: Spread) -> float | None:
    r"""Where the model error first reaches the size of the model itself.

    .. math:: w(\omega_\Delta) = 1

    Parameters
    ----------
    plant : TransferFunction
    spread : Spread

    Returns
    -------
    float or None
        [rad/time]; None where it never does.

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 7.4.
    """
    return first_rise(lambda omega: log_weight(plant, spread, omega), widened(default_grid(plant)), 0.0)


def mismatch(loop: FeedbackLoop, spread: Spread) -> Mismatch:
    r"""Robust stability of a loop whose plant lies within a spread of its model.

    .. math:: |T(i\omega)|\, w(\omega) < 1 \;\; \forall \omega, \qquad
        S_\Delta = \frac{1}{1 + T G_\Delta}, \quad |S_\Delta| \le \frac{1}{1 - |T| w}

    Parameters
    ----------
    loop : FeedbackLoop
        Stable with the model itself.
    spread : Spread
        Of the plant; actuator and sensor are taken as known.

    Returns
    -------
    Mismatch
        The condition is sufficient: it counts every error of the size w, also those that no plant of the spread has.

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 7.5.
    .. [2] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, sec. 5.9.
    """
    L, plant = loop.open_loop, loop.plant

    def size_of_T(omega: FloatArray) -> FloatArray:
        value = L.response(omega)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(np.isfinite(value), np.abs(value / (1.0 + value)), 1.0)

    def log_product(omega: FloatArray) -> FloatArray:
        with np.errstate(divide="ignore"):
            return log_weight(plant, spread, omega) + np.log(size_of_T(omega))

    grid = default_grid(L)
    peak, omega_peak = highest(log_product, widened(grid))
    omega = np.geomspace(0.1 * grid[0], 10.0 * grid[-1], CURVE_POINTS)
    safe = peak < 1.0
    return Mismatch(
        full_error(plant, spread), peak, omega_peak, safe,
        1.0 / (1.0 - peak) if safe else None, omega, multiplicative_weight(plant, spread, omega), size_of_T(omega),
    )  # fmt: skip
