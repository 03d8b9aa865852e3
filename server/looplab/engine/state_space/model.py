"""The state-space model with any number of inputs and outputs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space.eigenvalues import eigenvalues
from looplab.engine.systems.polynomial import ComplexArray, FloatArray
from looplab.engine.systems.realization import StateSpace, realize
from looplab.engine.systems.transfer_function import LARGEST, TransferFunction

MAX_STATES = 50
MAX_CHANNELS = 10
# Below this, scaling to equal sizes would overflow.
TINIEST = 1e-100


def _matrix(value: npt.ArrayLike, name: str) -> FloatArray:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        array = np.zeros(())
    # No row at all: nothing says how long a row would have been.
    if array.shape == (0,):
        array = np.zeros((0, 0))
    if array.ndim != 2:
        raise InvalidInput(
            f"{name} must be a matrix: a list of rows of equal length",
            field=name,
            hint="for example [[0, 1], [-2, -3]]",
        )
    sizes = np.abs(array[array != 0])
    if not (np.isfinite(array).all() and sizes.max(initial=0.0) <= LARGEST and sizes.min(initial=1.0) >= TINIEST):
        raise InvalidInput(
            f"{name} must hold finite numbers, zero or from {TINIEST:g} to {LARGEST:g} in size",
            field=name,
            hint="choose units in which the numbers are moderate",
        )
    array.setflags(write=False)
    return array


def _shaped(array: FloatArray, shape: tuple[int, int], name: str, why: str) -> None:
    if array.shape != shape:
        rows, columns = array.shape
        raise InvalidInput(f"{name} is {rows} x {columns}; it must be {shape[0]} x {shape[1]}", field=name, hint=why)


@dataclass(frozen=True, eq=False)
class StateSpaceModel:
    r"""x' = A x + B u, y = C x + D u; immutable, hashable by content.

    ``realize`` makes the flat one-channel ``StateSpace`` that simulations step through; ``channel`` gives the same of
    one input and output of this model.

    Parameters
    ----------
    A : ndarray, shape (n, n)
        n from 0 (a static gain) to 50 [1/time].
    B : ndarray, shape (n, m)
    C : ndarray, shape (p, n)
    D : ndarray, shape (p, m) or None
        None is no direct feedthrough. m and p are from 1 to 10.

    Raises
    ------
    InvalidInput
        A shape does not fit, a number is not finite, or a size is out of range.
    """

    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: FloatArray

    def __init__(self, A: npt.ArrayLike, B: npt.ArrayLike, C: npt.ArrayLike, D: npt.ArrayLike | None = None) -> None:
        b, c = _matrix(B, "B"), _matrix(C, "C")
        a = _matrix(A, "A")
        n = a.shape[0]
        m, p = b.shape[1], c.shape[0]
        _shaped(a, (n, n), "A", "A maps states to their derivatives, so it is square")
        if n > MAX_STATES:
            raise InvalidInput(f"{n} states exceed the limit of {MAX_STATES}", field="A")
        _shaped(b, (n, m), "B", "B has a row for each state and a column for each input")
        _shaped(c, (p, n), "C", "C has a row for each output and a column for each state")
        d = _matrix(np.zeros((p, m)) if D is None else D, "D")
        _shaped(d, (p, m), "D", "D has a row for each output and a column for each input")
        for count, what, name in ((m, "inputs", "B"), (p, "outputs", "C")):
            if not 1 <= count <= MAX_CHANNELS:
                raise InvalidInput(f"{count} {what}: there must be 1 to {MAX_CHANNELS}", field=name)
        for name, value in (("A", a), ("B", b), ("C", c), ("D", d)):
            object.__setattr__(self, name, value)

    @classmethod
    def from_transfer_function(cls, system: TransferFunction) -> StateSpaceModel:
        """A realisation of the rational part as a cascade of sections; cancelling poles and zeros stay as states.

        Raises
        ------
        ImproperSystem
            More zeros than poles.
        """
        return cls.from_channel(realize(system))

    @classmethod
    def static(cls, D: npt.ArrayLike) -> StateSpaceModel:
        """A gain without states, D of shape (p, m)."""
        d = _matrix(D, "D")
        return cls(np.zeros((0, 0)), np.zeros((0, d.shape[1])), np.zeros((d.shape[0], 0)), d)

    @classmethod
    def from_channel(cls, channel: StateSpace) -> StateSpaceModel:
        """The model with one input and one output."""
        return cls(channel.A, channel.B[:, None], channel.C[None, :], [[channel.D]])

    @cached_property
    def key(self) -> bytes:
        """Content of the model; equal models have equal keys."""
        sizes = np.array([self.states, self.inputs, self.outputs], dtype=float)
        return b"".join((array + 0.0).tobytes() for array in (sizes, self.A, self.B, self.C, self.D))

    def __hash__(self) -> int:
        return hash(self.key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, StateSpaceModel) and self.key == other.key

    @property
    def states(self) -> int:
        """Number of states n."""
        return int(self.A.shape[0])

    @property
    def inputs(self) -> int:
        """Number of inputs m."""
        return int(self.B.shape[1])

    @property
    def outputs(self) -> int:
        """Number of outputs p."""
        return int(self.C.shape[0])

    @cached_property
    def poles(self) -> ComplexArray:
        """Eigenvalues of A, shape (n,), those at the origin exact [rad/time]."""
        return eigenvalues(self.A)

    def channel(self, output: int = 0, input: int = 0) -> StateSpace:
        """One input and one output, counted from 0, with all states.

        Raises
        ------
        InvalidInput
            There is no such input or output.
        """
        for index, count, name in ((output, self.outputs, "output"), (input, self.inputs, "input")):
            if not 0 <= index < count:
                raise InvalidInput(f"there is no {name} {index}", field=name, hint=f"they are counted 0 to {count - 1}")
        return StateSpace(self.A, self.B[:, input], self.C[output], float(self.D[output, input]))

    def require_single(self) -> StateSpace:
        """The only channel.

        Raises
        ------
        InvalidInput
            There are several inputs or outputs.
        """
        for count, name, what in ((self.inputs, "B", "inputs"), (self.outputs, "C", "outputs")):
            if count != 1:
                raise InvalidInput(
                    f"the system has {count} {what}; one input and one output are needed here",
                    field=name,
                    hint=f"keep the {'column of B and D' if name == 'B' else 'row of C and D'} you mean",
                )
        return self.channel()

    def dual(self) -> StateSpaceModel:
        """The dual model (A^T, C^T, B^T, D^T): controllable where this one is observable."""
        return StateSpaceModel(self.A.T, self.C.T, self.B.T, self.D.T)

    def transformed(self, T: FloatArray) -> StateSpaceModel:
        """The same system in other coordinates, x = T z with T invertible, shape (n, n)."""
        inverse = np.linalg.inv(T)
        return StateSpaceModel(inverse @ self.A @ T, inverse @ self.B, self.C @ T, self.D)

    def __call__(self, s: complex) -> ComplexArray:
        """G(s) = C (s I - A)^-1 B + D, shape (p, m); s is not a pole."""
        n = self.states
        inner = np.linalg.solve(s * np.eye(n) - self.A, self.B.astype(complex))
        return np.asarray(self.C @ inner + self.D, dtype=complex)
