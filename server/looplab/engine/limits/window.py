"""Which limits bind for a plant, and what bandwidth is left between them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.frequency.response import default_grid, log_magnitude
from looplab.engine.limits.delay import delay_bound
from looplab.engine.limits.frequency_search import last_fall, widened
from looplab.engine.limits.interpolation import right_half_plane
from looplab.engine.limits.mismatch import Spread, full_error
from looplab.engine.limits.roots import pole_bound, zero_bound
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.stability.notions import pole_text
from looplab.engine.systems.hidden_modes import split_hidden_modes
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]

# Without a word about the actuator: ten times what it takes in the end.
USUAL_RATIO = 10.0


@dataclass(frozen=True)
class Demands:
    r"""What is asked of the loop and what is known of its surroundings; None leaves a limit out.

    Parameters
    ----------
    u_limit : float or None
        Largest \|u\| for a unit of r; None is ten times the u that holds it [input/output].
    noise_omega, noise_gain : float or None, float
        From where on the sensor is noisy [rad/time], and how much of it may reach y [-].
    load_error : float or None
        Largest error that a unit of load may leave [output/load].
    spread : Spread
        How far the model may be off.
    """

    u_limit: float | None = None
    noise_omega: float | None = None
    noise_gain: float = 0.1
    load_error: float | None = None
    spread: Spread = field(default_factory=Spread)

    def __post_init__(self) -> None:
        for name in ("u_limit", "noise_omega", "noise_gain", "load_error"):
            value = getattr(self, name)
            if value is not None and not (np.isfinite(value) and value > 0):
                raise InvalidInput("must be a positive number", field=name)
        if self.noise_gain >= 1:
            raise InvalidInput("the noise that may pass must be less than all of it", field="noise_gain")


@dataclass(frozen=True)
class Limit:
    """One limit of the bandwidth.

    Attributes
    ----------
    id : str
        "pole", "load" (lower); "zero", "dead_time", "actuator", "noise", "mismatch" (upper).
    side : str
        "lower" or "upper".
    omega : float or None
        [rad/time]; None where there is no such limit.
    binding : bool
        The tightest on its side.
    because : str
        What sets it, or why there is none.
    """

    id: str
    side: str
    omega: float | None
    because: str
    binding: bool = False


@dataclass(frozen=True)
class Window:
    """The limits, and the bandwidths between the highest lower and the lowest upper one [rad/time].

    ``open`` is whether anything is left between them; ``low`` and ``high`` are None without a limit on that side.
    """

    limits: tuple[Limit, ...]
    low: float | None
    high: float | None
    open: bool


def _text(value: float) -> str:
    return f"{value:.4g}"


def _pole(L: TransferFunction) -> Limit:
    poles = right_half_plane(L.poles)
    if not poles.size:
        return Limit("pole", "lower", None, "the loop has no unstable pole to catch")
    worst = max(poles.tolist(), key=pole_bound)
    return Limit(
        "pole", "lower", pole_bound(worst),
        f"the unstable pole at {pole_text(worst)} runs away; the loop must be faster to catch it",
    )  # fmt: skip


def _zero(L: TransferFunction) -> Limit:
    zeros = right_half_plane(L.zeros)
    if not zeros.size:
        return Limit("zero", "upper", None, "there is no zero in the right half-plane")
    worst = min(zeros.tolist(), key=zero_bound)
    return Limit(
        "zero", "upper", zero_bound(worst),
        f"the zero at {pole_text(worst)} pulls y the wrong way; a faster loop only makes that worse",
    )  # fmt: skip


def _dead_time(L: TransferFunction) -> Limit:
    if not L.theta:
        return Limit("dead_time", "upper", None, "there is no dead time in the loop")
    why = f"nothing that is done shows before the dead time of {_text(L.theta)} is over"
    return Limit("dead_time", "upper", delay_bound(L.theta), why)


def _actuator(path: TransferFunction, u_limit: float | None) -> Limit:
    at_rest = path.dc_gain
    if u_limit is None:
        if not np.isfinite(at_rest) or at_rest == 0.0:
            what = "integrates" if at_rest else "passes nothing at rest"
            return Limit("actuator", "upper", None, f"the plant {what}: say how large u may be for a unit of r")
        u_limit = USUAL_RATIO / abs(at_rest)
    level = -np.log(u_limit)
    grid = widened(default_grid(path))
    omega = last_fall(lambda w: log_magnitude(path, w), grid, level)
    if omega is None:
        if log_magnitude(path, grid[:1])[0] > level:
            return Limit("actuator", "upper", None, "the plant never falls off: u need not grow with frequency")
        why = f"a u of {_text(u_limit)} is too little at every frequency: not even at rest can y reach r"
        return Limit("actuator", "upper", 0.0, why)
    return Limit("actuator", "upper", omega, f"beyond it a unit of r takes more u than {_text(u_limit)}: |P| < 1/u")


def _noise(demands: Demands) -> Limit:
    if demands.noise_omega is None:
        return Limit("noise", "upper", None, "say from which frequency on the sensor is noisy")
    omega = demands.noise_gain * demands.noise_omega
    share = _text(100.0 * demands.noise_gain)
    why = f"of the noise from {_text(demands.noise_omega)} on {share} % may pass, and |T| falls about as ωc/ω"
    return Limit("noise", "upper", omega, why)


def _mismatch(plant: TransferFunction, spread: Spread) -> Limit:
    omega = full_error(plant, spread)
    if omega is None:
        return Limit("mismatch", "upper", None, "the error of the model stays below the model itself")
    return Limit("mismatch", "upper", omega, "from there on the model may be wrong by as much as it is: |GΔ| ≥ 1")


def _load(path: TransferFunction, load_error: float | None) -> Limit:
    if load_error is None:
        return Limit("load", "lower", None, "say how large an error a unit of load may leave")
    grid = widened(default_grid(path))
    omega = last_fall(lambda w: log_magnitude(path, w), grid, np.log(load_error))
    if omega is None:
        return Limit("load", "lower", None, f"no load moves y by more than {_text(load_error)}, even without control")
    why = f"up to there a unit of load moves y by more than {_text(load_error)}; the loop must hold against it"
    return Limit("load", "lower", omega, why)


def bandwidth_window(loop: FeedbackLoop, demands: Demands | None = None) -> Window:
    r"""Between which bandwidths a good loop around this plant must lie, whatever the controller.

    .. math:: \max(2p,\ \omega_d) < \omega_c < \min\left(\tfrac z2,\ \tfrac1\theta,\ \omega_u,\
        \varepsilon\,\omega_n,\ \omega_\Delta\right)

    with \|Gd\| = load_error at omega_d, \|P\| = 1/u_limit at omega_u, and a relative model error of 1 at omega_Delta.

    Parameters
    ----------
    loop : FeedbackLoop
        Its controller matters only where it has zeros, poles or dead time of its own on the right.
    demands : Demands or None

    Returns
    -------
    Window
        Rules of thumb for |S| and |T| up to 2, each exact in its own terms; several close together bind harder.

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 5.14.
    .. [2] G. C. Goodwin, S. F. Graebe, M. E. Salgado, Control System Design, Prentice Hall 2001, ch. 8.
    """
    demands = demands or Demands()
    L, _ = split_hidden_modes(loop.open_loop)
    found = [
        _pole(L),
        _load(loop.load_path, demands.load_error),
        _zero(L),
        _dead_time(L),
        _actuator(loop.path, demands.u_limit),
        _mismatch(loop.plant, demands.spread),
        _noise(demands),
    ]
    low, high = (_tightest(found, side, pick) for side, pick in (("lower", max), ("upper", min)))
    limits = tuple(replace(limit, binding=limit in (low, high)) for limit in found)
    ends = low.omega if low else None, high.omega if high else None
    is_open = ends[1] != 0.0 and (ends[0] is None or ends[1] is None or ends[0] < ends[1])
    return Window(limits, ends[0], ends[1], is_open)


def _tightest(limits: list[Limit], side: str, pick: Callable[..., Limit]) -> Limit | None:
    given = [limit for limit in limits if limit.side == side and limit.omega is not None]
    return pick(given, key=lambda limit: limit.omega) if given else None
