"""Signals of a loop under a setpoint, a load and noise of its sensor, sampled for their spectrum."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.loop.feedback_loop import FeedbackLoop
from looplab.engine.loop.step_response import closed_loop_step
from looplab.engine.stability.closed_loop import closed_loop_verdict

FloatArray = npt.NDArray[np.float64]

MAX_SAMPLES = 2048


@dataclass(frozen=True)
class SampledSignals:
    """y, u, e = r - y and the noise n over t, evenly spaced, shape (N,) each [output], [input], [time].

    ``pulse_y`` and ``pulse_u`` are what one sample of noise of size 1, held for one step, adds to y and u.
    """

    t: FloatArray
    y: FloatArray
    u: FloatArray
    e: FloatArray
    n: FloatArray
    pulse_y: FloatArray
    pulse_u: FloatArray


def loop_signals(
    loop: FeedbackLoop,
    horizon: float,
    samples: int,
    setpoint: float = 1.0,
    load: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
) -> SampledSignals:
    r"""y, u and e of a stable loop after steps of setpoint and load at t = 0, with noise of its sensor.

    .. math:: y(t) = r\,\phi_r(t) + d\,\phi_d(t) - \sum_k (n_k - n_{k-1})\, \phi_n(t - t_k)

    phi are the exact step responses. The noise is normal, one value for each sample, held until the next: with the
    controller at C (r - y - n) it acts as a setpoint of the other sign, without the setpoint's weight.

    Parameters
    ----------
    loop : FeedbackLoop
        Stable; dead time exact.
    horizon : float
        Length [time].
    samples : int
        N wanted, 20 to 2048. With dead time there may be up to twice as many, so that its multiples are samples.
    setpoint, load : float
        Sizes of the steps [output], [load].
    noise : float
        Standard deviation of n, >= 0 [output].
    seed : int
        The same seed, the same noise.

    Returns
    -------
    SampledSignals
        y is what leaves the plant, without the noise.

    Raises
    ------
    InvalidInput
        The loop is not stable, its response grows out of bounds, or a value is outside its range.
    NoConvergence
        The dead time is too long for the speed of the loop and the horizon.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton 2021, sec. 12.1 (signals of the loop).
    """
    if not 20 <= samples <= MAX_SAMPLES:
        raise InvalidInput(f"samples must be from 20 to {MAX_SAMPLES}", field="samples")
    if not (np.isfinite(noise) and noise >= 0):
        raise InvalidInput("the noise must be zero or positive", field="noise")
    verdict = closed_loop_verdict(loop)
    if not verdict.closed_loop_stable:
        raise InvalidInput(
            f"the loop is not stable, and what grows has no spectrum: {verdict.because}",
            field="loop",
            hint="make the loop stable",
        )
    steps = closed_loop_step(loop, horizon, samples)
    plain = closed_loop_step(replace(loop, controller=loop.C), horizon, samples) if loop.feedforward else steps
    responses = (steps.setpoint, steps.load, plain.setpoint)
    if any(response.truncated_reason for response in responses):
        raise InvalidInput("the response grows out of bounds", field="loop", hint="choose other units")
    N = steps.t.size
    n = noise * np.random.default_rng(seed).standard_normal(N)
    jumps = np.diff(n, prepend=0.0)

    def heard(phi: FloatArray) -> FloatArray:
        # Linear convolution: twice the length leaves no room to wrap around.
        return np.asarray(np.fft.irfft(np.fft.rfft(jumps, 2 * N) * np.fft.rfft(phi, 2 * N), 2 * N)[:N])

    y = setpoint * steps.setpoint.y + load * steps.load.y - heard(plain.setpoint.y)
    u = setpoint * steps.setpoint.u + load * steps.load.u - heard(plain.setpoint.u)
    pulses = (-np.diff(phi, prepend=0.0) for phi in (plain.setpoint.y, plain.setpoint.u))
    return SampledSignals(steps.t, y, u, setpoint - y, n, *pulses)
