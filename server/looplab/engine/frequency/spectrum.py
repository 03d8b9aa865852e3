"""Discrete Fourier transform of sampled signals: spectrum, inverse, Parseval, windows, aliasing, leakage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

Window = Literal["rectangular", "hann"]
WINDOWS: tuple[Window, ...] = get_args(Window)
MIN_SAMPLES, MAX_SAMPLES = 2, 4096
# Bins on either side of a line that are its own: a window's main lobe.
MAIN_LOBE: dict[Window, int] = {"rectangular": 0, "hann": 1}


@dataclass(frozen=True)
class Spectrum:
    r"""The spectrum of N samples, non-negative frequencies only.

    Attributes
    ----------
    frequency, omega : ndarray, shape (N // 2 + 1,)
        k/(N Delta) and 2 pi k/(N Delta) [cycles/time], [rad/time].
    U : ndarray of complex, shape (N // 2 + 1,)
        With 1/sqrt(N) before the sum: the energy of signal and spectrum is the same [signal].
    amplitude : ndarray, shape (N // 2 + 1,)
        Size of the sine at each frequency, the window's loss made up for [signal]; at 0 and at half the sampling rate
        the size of the mean and of the alternating part.
    windowed : ndarray, shape (N,)
        What was transformed [signal].
    energy, spectral_energy : float
        Sums of the squares of ``windowed`` and of \|U\|, over all N frequencies [signal^2].
    parseval_residual : float
        Their difference, relative to the energy [-].
    inverse_error : float
        Largest difference between ``windowed`` and what the inverse transform makes of U [signal].
    resolution, highest : float
        1/(N Delta), and half the sampling rate [cycles/time].
    """

    frequency: FloatArray
    omega: FloatArray
    U: ComplexArray
    amplitude: FloatArray
    windowed: FloatArray
    energy: float
    spectral_energy: float
    parseval_residual: float
    inverse_error: float
    resolution: float
    highest: float


def dft(u: npt.ArrayLike) -> ComplexArray:
    r"""Discrete Fourier transform of N samples.

    .. math:: U_k = \frac{1}{\sqrt N} \sum_{n=0}^{N-1} u_n\, e^{-2\pi i k n/N}

    Parameters
    ----------
    u : array_like, shape (N,)
        [signal]

    Returns
    -------
    ndarray of complex, shape (N,)
        U_k belongs to k/(N Delta), from half the sampling rate on to k/(N Delta) less the sampling rate [signal].

    Notes
    -----
    Counting samples from 1, as some textbooks do, turns each U_k by 2 pi k/N and leaves its size.

    References
    ----------
    .. [1] L. Ljung, System Identification: Theory for the User, 2nd ed., Prentice Hall 1999, sec. 2.2.
    """
    return np.asarray(np.fft.fft(_samples(u), norm="ortho"))


def inverse_dft(U: npt.ArrayLike) -> ComplexArray:
    r"""The samples that a transform belongs to.

    .. math:: u_n = \frac{1}{\sqrt N} \sum_{k=0}^{N-1} U_k\, e^{2\pi i k n/N}

    Parameters
    ----------
    U : array_like of complex, shape (N,)
        As from ``dft`` [signal].

    Returns
    -------
    ndarray of complex, shape (N,)
        [signal]

    References
    ----------
    .. [1] L. Ljung, System Identification: Theory for the User, 2nd ed., Prentice Hall 1999, sec. 2.2.
    """
    return np.asarray(np.fft.ifft(np.asarray(U, dtype=complex), norm="ortho"))


def window_values(window: Window, count: int) -> FloatArray:
    r"""A window over N samples.

    .. math:: w_n = 1, \qquad w_n = \tfrac12\left(1 - \cos\frac{2\pi n}{N}\right) \text{ (Hann)}

    Parameters
    ----------
    window : str
        "rectangular" or "hann".
    count : int
        N.

    Returns
    -------
    ndarray, shape (N,)
        [-]

    Raises
    ------
    InvalidInput
        There is no such window.

    References
    ----------
    .. [1] F. J. Harris, On the use of windows for harmonic analysis with the discrete Fourier transform, Proc. IEEE 66
       (1978) 51-83.
    """
    if window not in WINDOWS:
        raise InvalidInput(f"there is no window {window!r}", field="window", hint="use " + " or ".join(WINDOWS))
    if window == "rectangular":
        return np.ones(count)
    return np.asarray(np.sin(np.pi * np.arange(count) / count) ** 2)


def _samples(u: npt.ArrayLike) -> FloatArray:
    values = np.asarray(u, dtype=float)
    if values.ndim != 1 or not MIN_SAMPLES <= values.size <= MAX_SAMPLES:
        raise InvalidInput(f"a signal has from {MIN_SAMPLES} to {MAX_SAMPLES} samples", field="values")
    if not (np.abs(values) <= 1e100).all():
        raise InvalidInput("samples must be finite numbers up to 1e100", field="values")
    return values


def spectrum(u: npt.ArrayLike, rate: float, window: Window = "rectangular") -> Spectrum:
    r"""Spectrum of a sampled signal.

    .. math:: f_k = \frac{k}{N\Delta}, \qquad A_k = \frac{2\sqrt N}{\sum_n w_n} |U_k|, \qquad
        \sum_n |w_n u_n|^2 = \sum_k |U_k|^2

    Parameters
    ----------
    u : array_like, shape (N,)
        [signal]
    rate : float
        Samples per time, 1/Delta > 0.
    window : str
        "rectangular" or "hann".

    Returns
    -------
    Spectrum

    Raises
    ------
    InvalidInput
        Fewer than 2 or more than 4096 samples, or a rate that is not positive.

    References
    ----------
    .. [1] L. Ljung, System Identification: Theory for the User, 2nd ed., Prentice Hall 1999, sec. 2.2.
    .. [2] F. J. Harris, Proc. IEEE 66 (1978) 51-83 (windows and their coherent gain).
    """
    values = _samples(u)
    if not (np.isfinite(rate) and 1e-12 <= rate <= 1e12):
        raise InvalidInput("the sampling rate must be a positive number", field="rate")
    N = values.size
    w = window_values(window, N)
    windowed = values * w
    U = dft(windowed)
    energy, spectral = float(windowed @ windowed), float((np.abs(U) ** 2).sum())
    half = U[: N // 2 + 1]
    amplitude = 2.0 * np.sqrt(N) / w.sum() * np.abs(half)
    # Their mirror images are themselves.
    amplitude[0] *= 0.5
    if N % 2 == 0:
        amplitude[-1] *= 0.5
    frequency = np.arange(N // 2 + 1) * rate / N
    return Spectrum(
        frequency, 2.0 * np.pi * frequency, half, amplitude, windowed, energy, spectral,
        abs(spectral - energy) / energy if energy else 0.0,
        float(np.abs(inverse_dft(U) - windowed).max()), rate / N, rate / 2.0,
    )  # fmt: skip


def alias(frequency: float, rate: float) -> tuple[float, int]:
    r"""The frequency at which a sampled sine is seen.

    .. math:: f_a = |f - k f_s| \le f_s/2

    Parameters
    ----------
    frequency : float
        f >= 0 [cycles/time].
    rate : float
        f_s > 0 [samples/time].

    Returns
    -------
    alias : float
        [cycles/time]
    k : int
        0 where the sine is seen where it is.

    References
    ----------
    .. [1] K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 3rd ed., Prentice Hall 1997, sec. 7.4.
    """
    k = int(np.ceil(frequency / rate - 0.5))
    return abs(frequency - k * rate), k


def leakage_pct(found: Spectrum, lines: npt.ArrayLike, window: Window) -> float:
    r"""Share of the energy that does not lie at the lines of a signal, nor in their windows' main lobes.

    .. math:: 100\, \frac{\sum_{k \notin \text{lines}} |U_k|^2}{\sum_k |U_k|^2}

    Parameters
    ----------
    found : Spectrum
    lines : array_like, shape (m,)
        Frequencies that are in the signal, after aliasing; each belongs to the bin nearest to it [cycles/time].
    window : str
        The one that was used.

    Returns
    -------
    float
        [%]; 0 for sines that fit a whole number of times into the record.

    References
    ----------
    .. [1] F. J. Harris, Proc. IEEE 66 (1978) 51-83.
    """
    power = np.abs(found.U) ** 2
    power[1 : (found.windowed.size + 1) // 2] *= 2.0
    total = power.sum()
    own = np.zeros(power.size, dtype=bool)
    for line in np.atleast_1d(np.asarray(lines, dtype=float)):
        k = int(np.rint(line / found.resolution))
        own[max(k - MAIN_LOBE[window], 0) : k + MAIN_LOBE[window] + 1] = True
    return float(100.0 * power[~own].sum() / total) if total else 0.0


def noise_amplitude(pulse: npt.ArrayLike, deviation: float, window: Window = "rectangular") -> FloatArray:
    r"""Amplitudes that white noise has, in the mean square, behind a system that answers a pulse.

    .. math:: \sqrt{\mathrm{E} A_k^2} = 2 \sigma\, \Big|\sum_n h_n e^{-2\pi i k n/N}\Big|\,
        \frac{\sqrt{\sum_n w_n^2}}{\sum_n w_n}

    Parameters
    ----------
    pulse : array_like, shape (N,)
        h, the answer to one sample of size 1 [signal/noise].
    deviation : float
        sigma of the noise, one value a sample [noise].
    window : str
        "rectangular" or "hann".

    Returns
    -------
    ndarray, shape (N // 2 + 1,)
        At the frequencies of ``spectrum`` [signal]; half of it at 0 and at half the sampling rate.

    References
    ----------
    .. [1] L. Ljung, System Identification: Theory for the User, 2nd ed., Prentice Hall 1999, sec. 2.3.
    """
    h = _samples(pulse)
    w = window_values(window, h.size)
    out = np.asarray(2.0 * deviation * np.abs(np.fft.rfft(h)) * np.sqrt((w**2).sum()) / w.sum())
    out[0] *= 0.5
    if h.size % 2 == 0:
        out[-1] *= 0.5
    return out
