"""A part of the root locus as if under a magnifying glass: the branches' own points, as close as the window asks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.stability.locus.construction import Window
from looplab.engine.stability.locus.root_locus import RootLocus, root_locus
from looplab.engine.stability.polish import polish_closed_loop_poles
from looplab.engine.systems.transfer_function import TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

# In widths of the window: the longest step of a branch, and the longest at which it may turn by MOST_TURN [rad].
LONGEST_STEP, SHORT_STEP, MOST_TURN = 0.04, 0.004, 0.1
# Beyond the window, in widths of it, so that a line leaves the picture.
AROUND = 0.25
MAX_ROUNDS, MAX_POINTS = 45, 4000
# A window smaller than this, relative to its distance from the origin, shows rounding and not the locus.
SMALLEST = 1e-6
TOWARDS_ZERO = 60


@dataclass(frozen=True)
class LocusPiece:
    """A stretch of one branch: gains (increasing) and points s [rad/time], both of shape (n,)."""

    gains: FloatArray
    s: ComplexArray


@dataclass(frozen=True)
class LocusCloseUp:
    """What of the locus passes through a window.

    Attributes
    ----------
    view : ((float, float), (float, float))
        The window (re, im) [rad/time].
    pieces : tuple of LocusPiece
    complete : bool
        Nothing is missing in the window; with dead time that is known around the whole locus's own view only.
    """

    view: Window
    pieces: tuple[LocusPiece, ...]
    complete: bool


def locus_close_up(L: TransferFunction, view: Window) -> LocusCloseUp:
    r"""The root locus in a window, smooth at the window's own scale.

    .. math:: 1 + K L(s) = 0, \qquad K_m = \mathrm{Re}\left(-\frac{1}{L(s_m)}\right)

    Each branch of the whole locus is halved where it may pass the window: the middle of a chord s_m gives a gain K_m,
    and Newton's steps bring s_m onto the locus for it. Next to a break-away that is a gain quadratic in the distance,
    so the corner stays sharp however small the window.

    Parameters
    ----------
    L : TransferFunction
        Proper open loop for K = 1, dead time exact; give -L for negative gains.
    view : ((float, float), (float, float))
        (re, im), each (low, high) [rad/time].

    Returns
    -------
    LocusCloseUp

    Raises
    ------
    InvalidInput
        The window is no rectangle, or smaller than what rounding leaves of the locus; or no pole could move.

    References
    ----------
    .. [1] W. R. Evans, Trans. AIEE 69 (1950) 66-69.
    """
    (left, right), (bottom, top) = view
    width, height = right - left, top - bottom
    far = max(abs(left), abs(right), abs(bottom), abs(top))
    if not (np.isfinite([left, right, bottom, top]).all() and width > 0 and height > 0):
        raise InvalidInput("a window has [low, high] for re and for im, low < high", field="view")
    if min(width, height) < SMALLEST * far:
        raise InvalidInput("the window is too small to show more than rounding", field="view", hint="zoom out a little")
    whole = root_locus(L)
    window = _Glass(left, bottom, width, height)
    pieces: list[LocusPiece] = []
    for branch in whole.branches:
        there, s = _exact_meetings(whole, L, branch)
        gains = whole.gains[there]
        gains, s = _to_the_zero(whole, L, window, gains, s)
        if not np.any(s != s[0]):
            continue
        gains, s = _halved(L, window, gains, s, np.array([b.s for b in whole.breakaways], dtype=complex))
        pieces += _inside(window, gains, s)
    return LocusCloseUp(view, tuple(pieces), whole.complete and (not L.theta or _known(whole, view)))


def _known(whole: RootLocus, view: Window) -> bool:
    """Is the window within what the whole locus with dead time was followed in: its own view and half as much again?"""
    (left, right), (bottom, top) = whole.view
    room = 0.5 * top
    (a, b), (c, d) = view
    return a >= left - room and b <= right + room and c >= bottom - room and d <= top + room


@dataclass(frozen=True)
class _Glass:
    """The window as a unit square."""

    left: float
    bottom: float
    width: float
    height: float

    def at(self, s: ComplexArray) -> ComplexArray:
        return np.asarray((s.real - self.left) / self.width + 1j * (s.imag - self.bottom) / self.height)

    def near(self, z: ComplexArray) -> npt.NDArray[np.bool_]:
        """Chords, in units of the window, that may pass it: their box with its own size to spare overlaps it."""
        a, b = z[:-1], z[1:]
        spare = AROUND + 0.6 * np.abs(b - a)
        x0, x1 = np.minimum(a.real, b.real) - spare, np.maximum(a.real, b.real) + spare
        y0, y1 = np.minimum(a.imag, b.imag) - spare, np.maximum(a.imag, b.imag) + spare
        return np.asarray((x0 < 1) & (x1 > 0) & (y0 < 1) & (y1 > 0))


def _exact_meetings(
    whole: RootLocus, L: TransferFunction, branch: ComplexArray
) -> tuple[npt.NDArray[np.intp], ComplexArray]:
    """Where the branch is, and its points, with every break-away point it comes to exact.

    As eigenvalues double roots are known to half the digits; and one of the two may have been taken for the other.
    """
    s = branch.copy()
    for b in whole.breakaways:
        i = int(np.searchsorted(whole.gains, b.K))
        if i >= s.size or whole.gains[i] != b.K:
            continue
        beside = [j for j in (i - 1, i + 1) if 0 <= j < s.size and np.isfinite(s[j])]
        if np.isfinite(s[i]):
            meets = abs(s[i] - b.s) < 1e-4 * max(abs(b.s), 1e-9)
        else:
            # K - K_b = -K_b (ln L)'' (s - s_b)^2 / 2 next to it.
            bend = abs((1.0 / (b.s - L.poles) ** 2).sum() - (1.0 / (b.s - L.zeros) ** 2).sum())
            meets = any(bend * abs(s[j] - b.s) ** 2 < 18.0 * abs(whole.gains[j] / b.K - 1.0) for j in beside)
        if meets:
            s[i] = b.s
    there = np.flatnonzero(np.isfinite(s))
    return there, s[there]


def _to_the_zero(
    whole: RootLocus, L: TransferFunction, window: _Glass, gains: FloatArray, s: ComplexArray
) -> tuple[FloatArray, ComplexArray]:
    """Follow a branch that ends next to an open-loop zero until the window cannot tell them apart."""
    if gains[-1] != whole.gains[-1] or not L.zeros.size:
        return gains, s
    zero = L.zeros[np.argmin(np.abs(L.zeros - s[-1]))]
    if not window.near(window.at(np.array([zero, s[-1]])))[0] or abs(zero - s[-1]) > 0.1 * abs(s[-1] - s[0]):
        return gains, s
    order = int(np.count_nonzero(zero == L.zeros))
    more_gains, more = [gains[-1]], [s[-1]]
    for _ in range(TOWARDS_ZERO):
        K = 4.0 * more_gains[-1]
        guess = np.array([zero + (more[-1] - zero) * 4.0 ** (-1.0 / order)])
        found, good = polish_closed_loop_poles(L, guess, K)
        gap = abs(more[-1] - zero)
        if not good[0] or not abs(found[0] - zero) < gap or gap <= 4.0 * np.finfo(float).eps * abs(zero):
            break
        more_gains.append(K)
        more.append(complex(found[0]))
        if abs(window.at(np.array([found[0]]))[0] - window.at(np.array([zero]))[0]) < SHORT_STEP:
            break
    return np.concatenate([gains, more_gains[1:]]), np.concatenate([s, more[1:]])


def _halved(
    L: TransferFunction, window: _Glass, gains: FloatArray, s: ComplexArray, corners: ComplexArray
) -> tuple[FloatArray, ComplexArray]:
    done = np.zeros(gains.size - 1, dtype=bool)
    for _ in range(MAX_ROUNDS):
        z = window.at(s)
        step = np.abs(np.diff(z))
        wanted = step > LONGEST_STEP
        with np.errstate(all="ignore"):
            turn = np.abs(np.angle(np.diff(z)[1:] / np.diff(z)[:-1]))
        sharp = np.isin(s[1:-1], corners)
        bend = (turn > MOST_TURN) & ~sharp
        wanted[:-1] |= bend & (step[:-1] > SHORT_STEP)
        wanted[1:] |= bend & (step[1:] > SHORT_STEP)
        at = np.flatnonzero(wanted & window.near(z) & ~done)
        if not at.size or gains.size > MAX_POINTS:
            break
        middle, K, good = _middle(L, gains[at], gains[at + 1], s[at], s[at + 1])
        done[at[~good]] = True
        at, middle, K = at[good], middle[good], K[good]
        gains, s = np.insert(gains, at + 1, K), np.insert(s, at + 1, middle)
        done = np.insert(done, at + 1, False)
    return gains, s


def _middle(
    L: TransferFunction, K0: FloatArray, K1: FloatArray, s0: ComplexArray, s1: ComplexArray
) -> tuple[ComplexArray, FloatArray, npt.NDArray[np.bool_]]:
    """A point of the locus about half-way along each chord, its gain, and whether it was found."""
    guess, chord = 0.5 * (s0 + s1), np.abs(s1 - s0)
    with np.errstate(all="ignore"):
        K = (-1.0 / L(guess)).real
    between = np.isfinite(K) & (K > K0) & (K < K1)
    K = np.where(between, K, np.where(K0 > 0, np.sqrt(K0 * K1), 0.25 * K1))
    found, good = polish_closed_loop_poles(L, guess, K, steps=6)
    # On the real axis the locus has no imaginary part, and rounding is given none.
    found = np.where((s0.imag == 0) & (s1.imag == 0) & (np.abs(found.imag) < 0.1 * chord), found.real, found)
    good &= (np.abs(found - guess) < 0.45 * chord) & (K > K0) & (K < K1)
    return found, K, good


def _inside(window: _Glass, gains: FloatArray, s: ComplexArray) -> list[LocusPiece]:
    """The stretches that pass the window, with the points next to it."""
    near = np.concatenate([[False], window.near(window.at(s)), [False]])
    edges = np.flatnonzero(near[1:] != near[:-1])
    return [LocusPiece(gains[a : b + 1], s[a : b + 1]) for a, b in zip(edges[::2], edges[1::2], strict=True)]
