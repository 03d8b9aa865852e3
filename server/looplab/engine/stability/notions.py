"""Notions of stability: Lyapunov, asymptotic and marginal; on the imaginary axis the Jordan structure decides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.systems.transfer_function import MAX_ORDER, TransferFunction

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

# Eigenvalues this near to the axis, and singular values this small, count as on it and as zero; relative to norm(A).
AXIS_TOLERANCE = 1e-9
RANK_TOLERANCE = 1e-9
POLE_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Mode:
    """An eigenvalue on the imaginary axis and its Jordan blocks.

    Attributes
    ----------
    eigenvalue : complex
        [rad/time]
    algebraic, geometric : int
        Multiplicity as a root of the characteristic polynomial, and number of eigenvectors.
    largest_block : int
        Size of the largest Jordan block; the mode grows like t^(largest_block - 1).
    singular_values : tuple of float
        Of A - eigenvalue I, largest first; the geometric multiplicity is how many lie below ``threshold``. Empty where
        the structure is known without them (a transfer function has one block for each pole).
    threshold : float
    """

    eigenvalue: complex
    algebraic: int
    geometric: int
    largest_block: int
    singular_values: tuple[float, ...] = ()
    threshold: float = 0.0


@dataclass(frozen=True)
class StabilityNotion:
    """Verdict on x' = A x at the origin.

    Attributes
    ----------
    poles : ndarray of complex, rightmost first
    verdict : str
        "stable" (asymptotically), "marginal" (Lyapunov stable only), "unstable".
    lyapunov_stable, asymptotically_stable : bool
    axis_modes : tuple of Mode
        Those with no negative imaginary part.
    because : str
    """

    poles: ComplexArray
    verdict: str
    lyapunov_stable: bool
    asymptotically_stable: bool
    axis_modes: tuple[Mode, ...]
    because: str


def pole_text(p: complex) -> str:
    """2, -1 ± 3j, ±2j, 0."""
    size = abs(p)
    re = 0.0 if abs(p.real) <= 1e-12 * size else p.real
    if abs(p.imag) <= 1e-12 * size:
        return f"{re:.4g}"
    return (f"{re:.4g} " if re else "") + ("± " if re else "±") + f"{abs(p.imag):.4g}j"


def _judge(poles: ComplexArray, right: ComplexArray, modes: list[Mode]) -> StabilityNotion:
    poles = poles[np.lexsort((poles.imag, np.round(poles.real, 9)))[::-1]]
    shown = tuple(m for m in modes if m.eigenvalue.imag >= 0)
    if right.size:
        worst = complex(right[np.argmax(right.real)])
        because = (
            f"an eigenvalue lies in the right half-plane, at {pole_text(worst)}: "
            f"the state grows like exp({worst.real:.4g} t)"
        )
        return StabilityNotion(poles, "unstable", False, False, shown, because)
    blocks = [m for m in shown if m.largest_block > 1]
    if blocks:
        m = max(blocks, key=lambda m: m.largest_block)
        power = "t" if m.largest_block == 2 else f"t^{m.largest_block - 1}"
        because = (
            f"the eigenvalue {pole_text(m.eigenvalue)} on the imaginary axis is {m.algebraic}-fold but has only "
            f"{m.geometric} eigenvector{'s' if m.geometric > 1 else ''}: a Jordan block of size {m.largest_block}, "
            f"and the state grows like {power}"
        )
        return StabilityNotion(poles, "unstable", False, False, shown, because)
    if shown:
        names = " and ".join(pole_text(m.eigenvalue) for m in shown)
        full = any(m.algebraic > 1 for m in shown)
        extra = "each with as many eigenvectors as its multiplicity (no Jordan block)" if full else "each simple"
        because = (
            f"eigenvalues on the imaginary axis at {names}, {extra}: "
            "the state stays bounded but does not return to zero"
        )
        return StabilityNotion(poles, "marginal", True, False, shown, because)
    if not poles.size:
        return StabilityNotion(poles, "stable", True, True, (), "the system has no state")
    slowest = pole_text(complex(poles[0]))
    because = f"every eigenvalue has a negative real part; the rightmost is {slowest}"
    return StabilityNotion(poles, "stable", True, True, (), because)


def _clusters(values: ComplexArray, scale: float) -> list[ComplexArray]:
    """Groups of eigenvalues that rounding may have split: m equal ones scatter by about eps^(1/m)."""
    left = list(range(values.size))
    out: list[ComplexArray] = []
    for size in range(values.size, 1, -1):
        reach = 8.0 * np.finfo(float).eps ** (1.0 / size) * scale
        again = True
        while again:
            again = False
            for seed in left:
                group, grown = {seed}, True
                while grown:
                    near = {j for j in left if any(abs(values[j] - values[i]) <= reach for i in group)}
                    grown, group = near != group, near
                if len(group) >= size:
                    out.append(values[sorted(group)])
                    left = [j for j in left if j not in group]
                    again = True
                    break
    return out + [values[[i]] for i in left]


def _mode(A: FloatArray, eigenvalue: complex, count: int, scale: float, tolerance: float) -> Mode:
    shifted = A - eigenvalue * np.eye(A.shape[0])
    sigma = np.linalg.svd(shifted, compute_uv=False)
    threshold = tolerance * scale
    geometric = max(1, min(count, int(np.count_nonzero(sigma <= threshold))))
    block, power = 1, shifted / scale
    nullity = geometric
    while nullity < count and block < count:
        power = power @ (shifted / scale)
        block += 1
        nullity = int(np.count_nonzero(np.linalg.svd(power, compute_uv=False) <= tolerance))
    return Mode(eigenvalue, count, geometric, block if geometric < count else 1, tuple(sigma.tolist()), threshold)


def state_matrix(value: npt.ArrayLike, field: str, rows: int | None = None, columns: int | None = None) -> FloatArray:
    """A finite matrix of the shape wanted; raises InvalidInput naming ``field``."""
    try:
        M = np.atleast_2d(np.asarray(value, dtype=float))
    except (TypeError, ValueError):
        M = np.full((1, 1), np.nan)
    if M.ndim != 2 or not np.isfinite(M).all():
        raise InvalidInput(f"{field} must be a matrix of finite numbers", field=field, hint="[[0, 1], [-2, -3]]")
    if (rows is not None and M.shape[0] != rows) or (columns is not None and M.shape[1] != columns):
        wanted = f"{rows if rows is not None else 'any'} x {columns if columns is not None else 'any'}"
        raise InvalidInput(f"{field} is {M.shape[0]} x {M.shape[1]}, not {wanted}", field=field)
    return M


def matrix_stability(A: npt.ArrayLike, tolerance: float = RANK_TOLERANCE) -> StabilityNotion:
    r"""Lyapunov, asymptotic, marginal or unstable: x' = A x at the origin.

    .. math:: \Re\lambda_i < 0 \;\forall i \quad\text{or}\quad
        \Re\lambda_i = 0 \Rightarrow \dim\ker(A - \lambda_i I) = \text{multiplicity of } \lambda_i

    Parameters
    ----------
    A : array_like, shape (n, n)
        [1/time]
    tolerance : float
        A singular value of A - lambda I below this fraction of norm(A) counts as zero [-].

    Returns
    -------
    StabilityNotion
        Eigenvalues that rounding has split (a cluster of m scatters by about eps^(1/m)) are judged by their mean; on
        the axis the rank test decides, with the singular values it went by.

    Raises
    ------
    InvalidInput
        A is not square, not finite, or larger than 50.

    References
    ----------
    .. [1] H. K. Khalil, Nonlinear Systems, 3rd ed., Prentice Hall 2002, theorem 4.5.
    """
    M = state_matrix(A, "A")
    n = M.shape[0]
    if M.shape[1] != n:
        raise InvalidInput(f"A must be square, not {n} x {M.shape[1]}", field="A")
    if n > MAX_ORDER:
        raise InvalidInput(f"order {n} exceeds the limit of {MAX_ORDER}", field="A")
    scale = float(np.linalg.norm(M, 2))
    if scale == 0.0:
        zero = Mode(0j, n, n, 1, (0.0,) * n, 0.0)
        return _judge(np.zeros(n, dtype=complex), np.zeros(0, dtype=complex), [zero])
    values = np.linalg.eigvals(M).astype(complex)
    right: list[complex] = []
    modes: list[Mode] = []
    settled: list[complex] = []
    for group in _clusters(values, scale):
        mean = complex(group.mean())
        if abs(mean.real) > AXIS_TOLERANCE * scale:
            right += [mean] if mean.real > 0 else []
            settled += list(group)
            continue
        at = complex(0.0, 0.0 if abs(mean.imag) <= AXIS_TOLERANCE * scale else mean.imag)
        modes.append(_mode(M, at, group.size, scale, tolerance))
        settled += [at] * group.size
    return _judge(np.array(settled, dtype=complex), np.array(right, dtype=complex), modes)


def system_stability(system: TransferFunction) -> StabilityNotion:
    """The same verdict for a transfer function as it is written, cancelled poles included.

    Parameters
    ----------
    system : TransferFunction
        Its dead time does not matter for stability. Each pole has one Jordan block of the size of its multiplicity,
        as in any connection of one input with one output that needs all its states.

    Returns
    -------
    StabilityNotion
    """
    poles = np.array(system.poles) if system.gain or system.order else np.zeros(0, dtype=complex)
    near = np.abs(poles.real) <= POLE_TOLERANCE * np.abs(poles)
    right = poles[~near & (poles.real > 0)]
    modes: list[Mode] = []
    axis = list(poles[near])
    while axis:
        at = axis[0]
        same = [p for p in axis if abs(p - at) <= POLE_TOLERANCE * abs(at)]
        axis = [p for p in axis if abs(p - at) > POLE_TOLERANCE * abs(at)]
        modes.append(Mode(complex(0.0, at.imag), len(same), 1, len(same)))
    return _judge(poles, right, modes)
