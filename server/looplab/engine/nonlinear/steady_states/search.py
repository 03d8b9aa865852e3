"""All steady states in a box, as far as many starts find them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from looplab.engine.errors import InvalidInput, NonFinite
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.steady_states.equations import (
    Box,
    SteadyEquations,
    known_states,
    require_autonomous,
    search_box,
)
from looplab.engine.nonlinear.steady_states.newton import Root, settle, solve
from looplab.engine.nonlinear.steady_states.verdict import judge, kind_of
from looplab.engine.systems.polynomial import ComplexArray, FloatArray

STARTS = 100
MAX_STARTS = 400
_SAME = 1e-6
_EDGE = 1e-9


@dataclass(frozen=True)
class SteadyState:
    """One steady state.

    Attributes
    ----------
    x : tuple of float
    residual : float
        Largest abs(f_i) there [state/time].
    eigenvalues : ndarray of complex
        Of df/dx, rightmost first [rad/time].
    verdict, because : str
        stable, marginal or unstable, and why.
    kind : str
        node, focus, saddle, centre or degenerate.
    free : tuple of str
        States that may have any value here (together, where there are several): a continuum of steady states.
    found_by : int
        How many starts ended here.
    """

    x: Values
    residual: float
    eigenvalues: ComplexArray
    verdict: str
    because: str
    kind: str
    free: tuple[str, ...]
    found_by: int


@dataclass(frozen=True)
class SteadyStateSearch:
    """What a search has found: ``converged`` of ``starts`` ended at a solution inside the ``box``, shape (n, 2)."""

    steady_states: tuple[SteadyState, ...]
    starts: int
    converged: int
    box: FloatArray

    @property
    def remark(self) -> str:
        """How far the search can be trusted, in words."""
        if not self.steady_states:
            return f"none of {self.starts} starts came to rest in the box: probably there is no steady state in it"
        return (
            f"{self.converged} of {self.starts} starts came to rest; a search from many starts finds what most of "
            "them lead to, and may miss a steady state that hardly any leads to"
        )


def spread(count: int, box: FloatArray) -> FloatArray:
    """Points that fill a box evenly, always the same ones.

    The additive recurrence with the powers of the root of g^(d+1) = g + 1, shape (count, d).
    """
    d = box.shape[0]
    g = 2.0
    for _ in range(60):
        g = (1.0 + g) ** (1.0 / (d + 1))
    steps = g ** -np.arange(1.0, d + 1)
    fractions = (0.5 + np.arange(1, count + 1)[:, None] * steps) % 1.0
    return np.asarray(box[:, 0] + fractions * (box[:, 1] - box[:, 0]))


def find_roots(
    equations: SteadyEquations, box: FloatArray, known: Sequence[FloatArray], starts: int
) -> tuple[list[tuple[Root, int]], int]:
    """Distinct solutions inside a box with how many starts led to each, and how many starts led to any.

    Parameters
    ----------
    equations : SteadyEquations
        Without ``over``.
    box : ndarray, shape (k, 2)
    known : sequence of ndarray, shape (k,)
        Starts that are tried first, and harder.
    starts : int
        How many points of the box are tried besides.
    """
    width = box[:, 1] - box[:, 0]
    found: list[tuple[Root, int]] = []
    converged = 0
    for number, start in enumerate([*known, *spread(starts, box)]):
        root = solve(equations, start, box)
        if number < len(known) and (root is None or not _inside(root.y, box)):
            root = settle(equations, start, box)
        if root is None or not _inside(root.y, box):
            continue
        converged += 1
        root = _confirmed(equations, root, box) if root.null.size else root
        for place, (other, count) in enumerate(found):
            apart = (root.y - other.y) / width
            # Along the free directions of a continuum all of it is one solution.
            if np.linalg.norm(apart - other.null.T @ (other.null @ apart)) <= _SAME:
                found[place] = (other, count + 1)
                break
        else:
            found.append((root, 1))
    return found, converged


def _confirmed(equations: SteadyEquations, root: Root, box: FloatArray) -> Root:
    """A singular Jacobian may be a continuum or a double root: only along a continuum there are solutions nearby."""
    width = box[:, 1] - box[:, 0]
    kept = []
    for direction in root.null:
        other = solve(equations, root.y + 1e-3 * width * direction, box)
        if other is not None and abs(direction @ ((other.y - root.y) / width)) > 5e-4:
            kept.append(direction)
    return Root(root.y, np.array(kept).reshape(-1, root.y.size), True)


def _inside(y: FloatArray, box: FloatArray) -> bool:
    slack = _EDGE * (box[:, 1] - box[:, 0])
    return bool(((y >= box[:, 0] - slack) & (y <= box[:, 1] + slack)).all())


def find_steady_states(
    model: CompiledModel,
    u: Values,
    p: Values,
    box: Box | None = None,
    starts: int = STARTS,
    near: Values | None = None,
) -> SteadyStateSearch:
    r"""Steady states with these inputs and parameters, as many as a search from many starts finds.

    .. math:: 0 = f(x, u, p)

    Damped Newton steps with the exact Jacobian start at the initial state, at the states of the operating points and
    at points that fill the box evenly. Where the Jacobian has no full rank, as with an integrator, the smallest step is
    taken, and the states that it leaves free are named.

    Parameters
    ----------
    model : CompiledModel
    u, p : tuple of float
        Inputs and parameters, in the model's order.
    box : mapping of str to (float, float), or None
        Bounds of states to search between; others as the model declares them, or around what is known.
    starts : int
        From 1 to 400.
    near : tuple of float or None
        A start to be tried first.

    Returns
    -------
    SteadyStateSearch
        Sorted by the states.

    Raises
    ------
    InvalidInput
        The equations depend on t, or an argument is out of range.

    References
    ----------
    .. [1] P. Deuflhard, Newton Methods for Nonlinear Problems, Springer 2004, section 3.3 (natural monotonicity test).
    """
    require_autonomous(model)
    if not 1 <= starts <= MAX_STARTS:
        raise InvalidInput(f"starts must be from 1 to {MAX_STARTS}", field="starts")
    known = known_states(model, u, p)
    if near is not None:
        known.insert(0, near)
    bounds = search_box(model, known, box)
    equations = SteadyEquations(model, known[0], u, p, tuple(range(len(model.state_names))))
    first = [np.array(each) for each in known]
    roots, converged = find_roots(equations, bounds, first, starts)
    home = first[0]
    placed = _distinct(
        [(_at_home(equations, root, home, bounds), count) for root, count in roots], bounds[:, 1] - bounds[:, 0]
    )
    states = sorted((steady_state(equations, root, count) for root, count in placed), key=lambda state: state.x)
    return SteadyStateSearch(tuple(states), len(first) + starts, converged, bounds)


def _free(root: Root) -> list[int]:
    return np.flatnonzero(np.abs(root.null).max(axis=0, initial=0.0) > _SAME).tolist() if root.null.size else []


def _at_home(equations: SteadyEquations, root: Root, home: FloatArray, box: FloatArray) -> Root:
    """Of a continuum, the point where the first free state has the value of the known state."""
    free = _free(root)
    if not free:
        return root
    held = free[0]
    others = [index for index in range(root.y.size) if index != held]
    start = root.y.copy()
    start[held] = home[held]
    if others:
        rest = SteadyEquations(equations.model, tuple(start.tolist()), equations.u, equations.p, tuple(others))
        found = solve(rest, start[others], box[others])
        if found is None:
            return root
        start[others] = found.y
    # The equation of the state that was held has to agree.
    again = solve(equations, start, box)
    if again is None or not _inside(again.y, box) or not np.allclose(again.y, start, rtol=1e-7, atol=1e-9):
        return root
    return Root(again.y, root.null, True)


def _distinct(roots: list[tuple[Root, int]], width: FloatArray) -> list[tuple[Root, int]]:
    """One of each: a bent continuum is found in many places, which have come to the same point."""
    kept: list[tuple[Root, int]] = []
    for root, count in roots:
        for place, (other, so_far) in enumerate(kept):
            if np.linalg.norm((root.y - other.y) / width) <= _SAME:
                kept[place] = (other, so_far + count)
                break
        else:
            kept.append((root, count))
    return kept


def steady_state(equations: SteadyEquations, root: Root, found_by: int = 1) -> SteadyState:
    """A solution with its verdict, judged by the free states alone where others are held."""
    x = equations.arguments(root.y)[0]
    poles, verdict, because = judge(equations.jacobian(root.y))
    names = tuple(equations.model.state_names[equations.free[index]] for index in _free(root))
    residual = float(np.abs(equations.residual(root.y)).max())
    return SteadyState(tuple(x), residual, poles, verdict, because, kind_of(poles), names, found_by)


def steady_state_near(model: CompiledModel, u: Values, p: Values, near: Values) -> SteadyState:
    """The steady state that a start leads to.

    Where the model's own initial state leads nowhere, as from rest where every derivative is zero, those of its
    operating points are tried in turn.

    Raises
    ------
    InvalidInput
        The equations depend on t, or nothing comes to rest from there within the bounds.
    """
    require_autonomous(model)
    known = known_states(model, u, p)
    box = search_box(model, [near, *known])
    # A start is allowed outside the bounds of what is looked for.
    box = np.column_stack([np.minimum(box[:, 0], near), np.maximum(box[:, 1], near)])
    for begin in known if near == known[0] else [near]:
        equations = SteadyEquations(model, begin, u, p, tuple(range(len(begin))))
        start = np.array(begin)
        root = solve(equations, start, box)
        if root is None or not _inside(root.y, box):
            root = settle(equations, start, box)
        if root is not None and _inside(root.y, box):
            return steady_state(equations, _confirmed(equations, root, box) if root.null.size else root)
    raise InvalidInput(
        "no steady state was found near this point",
        field="near",
        hint="try other states, inputs or parameters; some models have no steady state",
    )


def outputs_at(model: CompiledModel, state: SteadyState, u: Values, p: Values) -> dict[str, float | None]:
    """Outputs by name, None where they have no finite value."""
    try:
        return dict(zip(model.output_names, model.outputs(0.0, state.x, u, p), strict=True))
    except NonFinite:
        return dict.fromkeys(model.output_names)
