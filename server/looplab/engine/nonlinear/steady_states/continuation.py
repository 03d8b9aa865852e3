"""Steady states over one input or parameter: branches, their stability, turning points and Hopf points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput, NonFinite
from looplab.engine.nonlinear.document import Setting, State
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.steady_states.curve import Curve, CurveFollower
from looplab.engine.nonlinear.steady_states.equations import (
    Box,
    SteadyEquations,
    known_states,
    require_autonomous,
    search_box,
)
from looplab.engine.nonlinear.steady_states.search import find_roots
from looplab.engine.systems.polynomial import FloatArray

MAX_BRANCHES = 12
# Values of the quantity at which branches are looked for, as parts of its range.
_LEVELS = (0.5, 0.0, 1.0, 0.25, 0.75)
_LEAST_SCALE = 0.02


@dataclass(frozen=True)
class SpecialPoint:
    """A point where stability changes or the curve turns.

    Attributes
    ----------
    branch, index : int
        Which point of which branch.
    kind : str
        "turning" (the curve turns back, det A = 0), "hopf" (a complex pair crosses the axis) or "branch" (an
        eigenvalue passes through zero without a turn: another curve crosses).
    value : float
        Of the quantity.
    x : tuple of float
    determinant : float
        Of A, relative to the product of the sizes of its rows with each state on its scale [-].
    omega : float or None
        Of the pair that crosses, where it is a Hopf point [rad/time].
    """

    branch: int
    index: int
    kind: str
    value: float
    x: Values
    determinant: float
    omega: float | None


@dataclass(frozen=True)
class SteadyStateCurves:
    """All branches that were found over [low, high], and their special points.

    ``curves[i].points[j].y`` are the states followed by the value of the quantity.
    """

    over: str
    low: float
    high: float
    curves: tuple[Curve, ...]
    special: tuple[SpecialPoint, ...]
    box: FloatArray


def default_range(setting: Setting | State) -> tuple[float, float]:
    """The declared range of a quantity; a missing bound is half its nominal value away (1 where that is zero)."""
    value = setting.value if isinstance(setting, Setting) else 0.0
    reach = 0.5 * abs(value) or 1.0
    low = value - reach if setting.min is None else setting.min
    high = value + reach if setting.max is None else setting.max
    return (low, high) if low < high else (low, low + 2 * reach)


def checked_range(setting: Setting | State, low: float | None, high: float | None) -> tuple[float, float]:
    """The range asked for, inside the declared one; raises InvalidInput naming low or high."""
    least, most = default_range(setting)
    low, high = least if low is None else low, most if high is None else high
    for value, field in ((low, "low"), (high, "high")):
        outside = (setting.min is not None and value < setting.min) or (setting.max is not None and value > setting.max)
        if outside or not np.isfinite(value):
            raise InvalidInput(f"{setting.name} can be {least:g} to {most:g}", field=field)
    if not low < high:
        raise InvalidInput("low must be less than high", field="high")
    return low, high


def trace_all(
    equations: SteadyEquations, box: FloatArray, known: list[FloatArray], levels: list[float], starts: int, judged: bool
) -> tuple[CurveFollower, list[Curve]]:
    """Every curve that a search at some levels of the quantity leads to.

    Parameters
    ----------
    equations : SteadyEquations
        With ``over``.
    box : ndarray, shape (k + 1, 2)
    known : list of ndarray, shape (k,)
        Starts.
    levels : list of float
        Values of ``over``.
    starts : int
        At each level.
    judged : bool
        Whether stability matters.
    """
    seeds: list[FloatArray] = []
    for level in levels:
        x, u, p = equations.arguments(np.append(known[0], level))
        at_level = SteadyEquations(equations.model, tuple(x), tuple(u), tuple(p), equations.free)
        for root, _ in find_roots(at_level, box[:-1], known, starts)[0]:
            if root.null.size:
                names = [equations.model.state_names[equations.free[i]] for i in np.flatnonzero(root.null.any(axis=0))]
                raise InvalidInput(
                    f"{' and '.join(names)} may have any value at the steady states, so they are no single curve",
                    field="over",
                    hint="a model with an integrator has a continuum of steady states; see its steady states",
                )
            seeds.append(np.append(root.y, level))
    if not seeds:
        return CurveFollower(equations, box, box[:, 1] - box[:, 0], judged), []
    width = _scales(np.array(seeds), box)
    follower = CurveFollower(equations, box, width, judged)
    curves: list[Curve] = []
    for seed in seeds:
        if len(curves) < MAX_BRANCHES and not any(follower.passes(curve, seed) for curve in curves):
            try:
                curves.append(follower.follow(seed))
            except (NonFinite, np.linalg.LinAlgError):
                continue
    return follower, [curve for curve in curves if len(curve.points) > 1]


def _scales(seeds: FloatArray, box: FloatArray) -> FloatArray:
    """How far the solutions spread, so that a curve is as smooth as it is seen; the last is the whole range."""
    whole = box[:, 1] - box[:, 0]
    width = np.clip(np.ptp(seeds, axis=0), _LEAST_SCALE * whole, whole)
    width[-1] = whole[-1]
    return np.asarray(width)


def find_setting(model: CompiledModel, name: str) -> Setting:
    """The input or parameter of a name; raises InvalidInput naming ``over``."""
    settings = (*model.document.inputs, *model.document.parameters)
    found = next((each for each in settings if each.name == name), None)
    if found is None:
        hint = f"there are {', '.join([each.name for each in settings][:16])}" if settings else None
        raise InvalidInput(f"the model has no input or parameter {name[:40]!a}", field="over", hint=hint)
    return found


def continue_steady_states(
    model: CompiledModel,
    u: Values,
    p: Values,
    over: str,
    low: float | None = None,
    high: float | None = None,
    box: Box | None = None,
    starts: int = 30,
    near: Values | None = None,
) -> SteadyStateCurves:
    r"""Steady states over one input or parameter, followed around turning points.

    .. math:: 0 = f(x, \lambda), \qquad \dot x_s^T (x - x_k) + \dot\lambda_s (\lambda - \lambda_k) = \Delta s

    Branches begin at what a search finds at a few values of the quantity; a branch that none of these values meets is
    missed. Where the tangent or an eigenvalue changes sign the point is located by bisection along the arc.

    Parameters
    ----------
    model : CompiledModel
    u, p : tuple of float
        Inputs and parameters, in the model's order.
    over : str
        Name of the input or parameter.
    low, high : float or None
        Its range; None takes the declared one.
    box : mapping of str to (float, float), or None
        Bounds of states.
    starts : int
        At each value of the search.
    near : tuple of float or None
        A state to start from.

    Returns
    -------
    SteadyStateCurves

    Raises
    ------
    InvalidInput
        The equations depend on t, the steady states form a continuum, or an argument is out of range.

    References
    ----------
    .. [1] H. B. Keller, Numerical solution of bifurcation and nonlinear eigenvalue problems, in P. Rabinowitz (ed.),
       Applications of Bifurcation Theory, Academic Press 1977, 359-384 (pseudo-arclength).
    .. [2] W. J. F. Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria, SIAM 2000, chapter 4.
    """
    require_autonomous(model)
    setting = find_setting(model, over)
    low, high = checked_range(setting, low, high)
    known = known_states(model, u, p)
    if near is not None:
        known.insert(0, near)
    bounds = search_box(model, known, box)
    whole = np.vstack([bounds, [low, high]])
    equations = SteadyEquations(model, known[0], u, p, tuple(range(len(model.state_names))), over)
    names = (*model.input_names, *model.parameter_names)
    own = (*u, *p)[names.index(over)]
    levels = [own] * (low <= own <= high) + [low + part * (high - low) for part in _LEVELS]
    follower, curves = trace_all(equations, whole, [np.array(x) for x in known], levels, starts, True)
    special = [
        _special(follower, branch, index, curve)
        for branch, curve in enumerate(curves)
        for index, point in enumerate(curve.points)
        if point.special
    ]
    return SteadyStateCurves(over, low, high, tuple(curves), tuple(special), whole)


def _special(follower: CurveFollower, branch: int, index: int, curve: Curve) -> SpecialPoint:
    point = curve.points[index]
    A = follower.equations.jacobian(point.y)[:, :-1] * follower.width[:-1]
    sizes = np.linalg.norm(A, axis=1)
    determinant = float(np.linalg.det(A / np.where(sizes > 0, sizes, 1.0)[:, None]))
    omega = None
    if point.special == "hopf":
        axis = min((pole for pole in point.poles if pole.imag > 0), key=lambda pole: abs(pole.real))
        omega = float(axis.imag)
    values = point.y.tolist()
    return SpecialPoint(branch, index, point.special, values[-1], tuple(values[:-1]), determinant, omega)
