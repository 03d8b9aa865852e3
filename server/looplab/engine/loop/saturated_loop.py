"""A linear loop with a sampled PID controller whose output saturates: exact, fast, with and without dead time."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.controllers import PID
from looplab.engine.loop.step_response import LARGEST_VALUE
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import TransferFunction

MAX_SAMPLES = 20_000
MAX_DELAY = 20_000
_BLOCK = 64
ANTI_WINDUP = ("none", "back_calculation", "clamping")


@dataclass(frozen=True)
class SaturatedLoop:
    """What is simulated.

    Attributes
    ----------
    plant : TransferFunction
        Strictly proper, with its dead time.
    controller : PID
        In the ideal form.
    h : float
        Sampling time [time].
    u_min, u_max : float
        May be infinite [input].
    anti_windup : str
        none, back_calculation or clamping.
    T_t : float or None
        Tracking time; None is sqrt(tau_I tau_D), or tau_I without a derivative [time].
    """

    plant: TransferFunction
    controller: PID
    h: float
    u_min: float = -math.inf
    u_max: float = math.inf
    anti_windup: str = "none"
    T_t: float | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.h) and self.h > 0):
            raise InvalidInput("the sampling time must be positive", field="h")
        if not self.u_min < self.u_max:
            raise InvalidInput("u_min must be less than u_max", field="u_max")
        if self.anti_windup not in ANTI_WINDUP:
            raise InvalidInput(f"anti_windup must be one of {', '.join(ANTI_WINDUP)}", field="anti_windup")
        if self.T_t is not None and not (math.isfinite(self.T_t) and self.T_t > 0):
            raise InvalidInput("T_t must be positive", field="T_t")
        if self.controller.form != "ideal":
            raise InvalidInput("the controller must have the ideal form", field="controller.form")
        if self.plant.relative_degree < 1:
            raise InvalidInput(
                "the plant answers its input at once: a sample would depend on what it decides",
                field="plant",
                hint="give the plant a lag",
            )
        if self.plant.theta / self.h > MAX_DELAY:
            raise InvalidInput(f"the dead time is longer than {MAX_DELAY} samples", field="h")


@dataclass(frozen=True)
class SaturatedResponse:
    """Values at the samples, shape (samples + 1,): y, and u before and after saturation, held until the next one.

    Cut where a value leaves +-1e9: ``truncated_at`` [time] and ``truncated_reason`` are None for a whole response.
    """

    t: FloatArray
    y: FloatArray
    u_command: FloatArray
    u: FloatArray
    truncated_at: float | None = None
    truncated_reason: str | None = None


@dataclass(frozen=True)
class _Plant:
    """The plant from sample to sample: x = Phi x + now u(k - delay) + late u(k - delay - 1), y = C x."""

    Phi: FloatArray
    now: FloatArray
    late: FloatArray
    C: FloatArray
    delay: int


@lru_cache(maxsize=64)
def _sampled_plant(plant: TransferFunction, h: float) -> _Plant:
    ss = realize(plant)
    whole = math.floor(plant.theta / h * (1.0 + 1e-12))
    part = max(plant.theta - whole * h, 0.0)
    if part < 1e-12 * h:
        part = 0.0
    Phi, now = _held(ss.A, ss.B, h - part)
    late = np.zeros_like(now)
    if part:
        # First the older input for ``part``, then the newer one.
        first, late = _held(ss.A, ss.B, part)
        late, Phi = Phi @ late, Phi @ first
    return _Plant(Phi, now, late, ss.C, whole)


@dataclass(frozen=True)
class _Numbers:
    """The plant from sample to sample, and coefficients of the controller (backward differences)."""

    plant: _Plant
    Kc: float
    beta: float
    integral: float
    decay: float
    slope: float
    tracking: float
    clamping: bool


def simulate_saturated(loop: SaturatedLoop, samples: int, r: float = 1.0, d: float = 0.0) -> SaturatedResponse:
    r"""Steps of the setpoint and of a load at the plant's input, from rest.

    .. math::

        x_{k+1} = \Phi x_k + \Gamma_0 (u_{k-m} + d) + \Gamma_1 (u_{k-m-1} + d), \qquad u_k = \mathrm{sat}(v_k)

    The controller is that of ``SampledPID`` with backward differences. Without dead time the loop is affine between
    changes of its mode (in range, at a limit, integral clamped): 64 samples are one product, used up to the first
    change. With dead time, m samples and a part of one, the samples go one by one through straight-line code.

    Parameters
    ----------
    loop : SaturatedLoop
    samples : int
        How many sampling times, up to 20000.
    r, d : float
        Sizes of the steps at t = 0 [output, input].

    Returns
    -------
    SaturatedResponse

    Raises
    ------
    InvalidInput
        The number of samples is out of range.

    References
    ----------
    .. [1] K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 3rd ed., Prentice Hall 1997, secs. 3.2 and 8.5.
    """
    if not 1 <= samples <= MAX_SAMPLES:
        raise InvalidInput(f"samples must be from 1 to {MAX_SAMPLES}", field="samples")
    numbers = _numbers(loop)
    with np.errstate(over="ignore", invalid="ignore"):
        way = one_by_one if loop.plant.theta else in_blocks
        rows = way(loop, numbers, samples, r, d)
        bad = ~(np.abs(rows) < LARGEST_VALUE).all(axis=1)
    stop = int(np.argmax(bad)) if bad.any() else samples + 1
    t = np.asarray(loop.h * np.arange(samples + 1))
    y, v, u = rows[:stop].T
    if stop > samples:
        return SaturatedResponse(t, y, v, u)
    why = f"the response grows beyond {LARGEST_VALUE:g}: the loop is unstable"
    return SaturatedResponse(t[:stop], y, v, u, float(t[stop]), why)


def _numbers(loop: SaturatedLoop) -> _Numbers:
    c, h = loop.controller, loop.h
    tau_D, filter_time = c.tau_D or 0.0, c.alpha * (c.tau_D or 0.0)
    T_t = loop.T_t or (math.sqrt(c.tau_I * tau_D) if c.tau_I and tau_D else c.tau_I or math.inf)
    Kc = c.sign * c.Kc
    return _Numbers(
        _sampled_plant(loop.plant, h), Kc, c.beta,
        h * Kc / c.tau_I if c.tau_I else 0.0,
        filter_time / (filter_time + h),
        Kc * tau_D / (filter_time + h),
        min(1.0, h / T_t) if loop.anti_windup == "back_calculation" else 0.0,
        loop.anti_windup == "clamping",
    )  # fmt: skip


def _held(A: FloatArray, B: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
    """exp(A time) and the integral of exp(A s) B over it."""
    n = B.size
    M = np.zeros((n + 1, n + 1))
    M[:n, :n], M[:n, n] = A * time, B * time
    E = expm(M)
    return E[:n, :n], E[:n, n]


def in_blocks(loop: SaturatedLoop, k: _Numbers, samples: int, r: float, d: float) -> FloatArray:
    """y, v and u at the samples, shape (samples + 1, 3), of a loop without dead time: block by block."""
    n, low, high = k.plant.C.size, loop.u_min, loop.u_max
    # The state: plant, integral, derivative, last error, and 1.
    size = n + 4
    I, D, last, one = range(n, size)  # noqa: E741 (the integral's name in the field)
    y, e, e_last = np.zeros(size), np.zeros(size), np.zeros(size)
    y[:n] = k.plant.C
    e[one], e_last[last] = r, 1.0
    e -= y
    derivative = k.slope * (e - e_last)
    derivative[D] += k.decay
    increment = k.integral * e
    trial = k.Kc * e + derivative + increment
    trial[I] += 1.0
    trial[one] += k.Kc * (k.beta - 1.0) * r
    seen = np.stack([y, trial, increment])
    powers: dict[tuple[bool, int], FloatArray] = {}

    def block(frozen: bool, side: int) -> FloatArray:
        """States after 1, 2, ... 64 samples in one mode, shape (64, size, size)."""
        v = trial - increment if frozen else trial
        u = v.copy()
        if side:
            u[:], u[one] = 0.0, high if side > 0 else low
        A = np.zeros((size, size))
        A[:n, :n] = k.plant.Phi
        A[:n] += np.outer(k.plant.now, u)
        A[:n, one] += k.plant.now * d
        A[I, I] = 1.0
        A[I] += (0.0 if frozen else 1.0) * increment + k.tracking * (u - v)
        A[D], A[last], A[one, one] = derivative, e, 1.0
        out = np.empty((_BLOCK, size, size))
        out[0] = A
        have = 1
        while have < _BLOCK:
            out[have : 2 * have] = out[:have] @ out[have - 1]
            have *= 2
        return out

    rows = np.empty((samples + 1, 3))
    z = np.zeros(size)
    z[one] = 1.0
    at, length = 0, _BLOCK
    while at <= samples:
        frozen, side, _ = _modes((seen @ z)[None, :], low, high, k.clamping)
        mode = (bool(frozen[0]), int(side[0]))
        if mode not in powers:
            powers[mode] = block(*mode)
        states = np.concatenate([z[None, :], powers[mode][:length] @ z])
        values = states @ seen.T
        frozen, side, v = _modes(values, low, high, k.clamping)
        changed = np.flatnonzero((frozen != mode[0]) | (side != mode[1]))
        # The first state in another mode still comes from this one.
        stay = int(changed[0]) if changed.size else length
        kept = min(stay, samples + 1 - at)
        rows[at : at + kept, 0], rows[at : at + kept, 1] = values[:kept, 0], v[:kept]
        at, z = at + kept, states[stay]
        # Where the mode changes often, long blocks are work for nothing.
        length = min(2 * length, _BLOCK) if stay == length else max(4, min(2 * stay, _BLOCK))
    rows[:, 2] = np.clip(rows[:, 1], low, high)
    return rows


def _modes(
    values: FloatArray, low: float, high: float, clamping: bool
) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.int_], FloatArray]:
    """Whether the integral is clamped, at which limit u is (-1, 0, 1), and v; each of shape (count,)."""
    _, v, increment = values.T
    frozen = np.zeros(v.shape, dtype=bool)
    if clamping:
        frozen = ((v > high) & (increment > 0)) | ((v < low) & (increment < 0))
        v = np.where(frozen, v - increment, v)
    return frozen, (v > high).astype(int) - (v < low), v


def one_by_one(loop: SaturatedLoop, k: _Numbers, samples: int, r: float, d: float) -> FloatArray:
    """The same with dead time, or without: sample by sample."""
    run = _straight_line(loop.plant, loop.h, k.clamping)
    weight = k.Kc * (k.beta - 1.0) * r
    return np.array(run(samples, r, d, loop.u_min, loop.u_max, k.Kc, weight, k.integral, k.decay, k.slope, k.tracking))


@lru_cache(maxsize=64)
def _straight_line(plant: TransferFunction, h: float, clamping: bool) -> Callable[..., list[tuple[float, ...]]]:
    """Code for one plant, made of its numbers alone: no name or text of a user is in it."""
    k = _sampled_plant(plant, h)
    n = k.C.size

    def number(value: float) -> str:
        return f"({float(value)!r})"

    def combination(row: FloatArray) -> str:
        return " + ".join(f"{number(c)}*x{i}" for i, c in enumerate(row) if c) or "0.0"

    xs = "".join(f"x{i}, " for i in range(n))
    new = "".join(f"{combination(k.Phi[i])} + {number(k.now[i])}*newer + {number(k.late[i])}*older, " for i in range(n))
    clamp = (
        "if (v > high and increment > 0.0) or (v < low and increment < 0.0):",
        "    v, increment = v - increment, 0.0",
    )
    lines = [
        "def run(samples, r, d, low, high, Kc, weight, gain, decay, slope, tracking):",
        f"    {xs} = {(0.0,) * n!r}",
        "    integral = derivative = last = 0.0",
        f"    sent, rows = [d] * {k.delay + 1}, []",
        "    for sample in range(samples + 1):",
        *(
            "        " + line
            for line in (
                f"y = {combination(k.C)}",
                "e = r - y",
                "derivative = decay*derivative + slope*(e - last)",
                "increment = gain*e",
                "v = Kc*e + weight + derivative + integral + increment",
                *(clamp if clamping else ()),
                "u = low if v < low else high if v > high else v",
                "integral += increment + tracking*(u - v)",
                "last = e",
                "rows.append((y, v, u))",
                "sent.append(u + d)",
                "newer, older = sent[sample + 1], sent[sample]",
                f"{xs} = {new}",
            )
        ),
        "    return rows",
    ]
    space = {"range": range, "__builtins__": {}}
    exec(compile("\n".join(lines), "<looplab saturated loop>", "exec"), space)
    return space["run"]  # type: ignore[return-value]
