"""The linear system with dead times anywhere inside it: a rational part whose delays are pulled out to channels."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.linalg import matrix_balance

from looplab.engine.errors import InvalidInput
from looplab.engine.state_space.model import StateSpaceModel
from looplab.engine.systems.polynomial import FloatArray
from looplab.engine.systems.realization import realize
from looplab.engine.systems.transfer_function import LARGEST, MAX_CONNECTED_ORDER, SMALLEST, TransferFunction

MAX_DELAYS = 40


@dataclass(frozen=True, eq=False)
class DelaySystem:
    r"""A linear system with internal dead times; immutable, hashable by content.

    .. math::

        \dot x = A x + B_1 u + B_2 w, \quad y = C_1 x + D_{11} u + D_{12} w, \quad
        z = C_2 x + D_{21} u + D_{22} w, \qquad w_i(t) = z_i(t - \tau_i)

    The form is that of ControlSystems.jl's ``DelayLtiSystem`` and of MATLAB's ``InternalDelay``: it is closed under
    series, parallel and feedback connection (``connections``), which transfer functions with a dead time are not.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B : ndarray, shape (n, m + k)
        [B1, B2]: the last k columns belong to the delayed signals w.
    C : ndarray, shape (p + k, n)
        [C1; C2]: the last k rows are the signals z on their way into the delays.
    D : ndarray, shape (p + k, m + k)
    tau : ndarray, shape (k,)
        Dead times of the channels, > 0 [time].

    Raises
    ------
    InvalidInput
        Shapes do not fit, a number is not finite or out of range, or there are more than 200 states or 40 delays.
    """

    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: FloatArray
    tau: FloatArray

    def __post_init__(self) -> None:
        for name in ("A", "B", "C", "D", "tau"):
            array = np.array(getattr(self, name), dtype=float)
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        n, k = self.A.shape[0], self.tau.size
        rows, columns = self.D.shape
        if self.A.shape != (n, n) or self.B.shape != (n, columns) or self.C.shape != (rows, n):
            raise InvalidInput("the shapes of A, B, C and D do not fit together", field="A")
        if self.tau.shape != (k,) or rows <= k or columns <= k:
            raise InvalidInput("a delayed system needs an input and an output beside its delay channels", field="tau")
        if n > MAX_CONNECTED_ORDER:
            raise InvalidInput(f"{n} states exceed the limit of {MAX_CONNECTED_ORDER}", field="A")
        if k > MAX_DELAYS:
            raise InvalidInput(f"{k} dead times exceed the limit of {MAX_DELAYS}", field="tau")
        if not ((self.tau >= SMALLEST) & (self.tau <= LARGEST)).all():
            raise InvalidInput(f"dead times must be from {SMALLEST:g} to {LARGEST:g}", field="tau")
        if not all(np.isfinite(array).all() for array in (self.A, self.B, self.C, self.D)):
            raise InvalidInput("the connected system has numbers beyond double precision", hint="choose other units")

    @classmethod
    def from_transfer_function(cls, system: TransferFunction) -> DelaySystem:
        """A cascade of sections, and one channel for the dead time, where the output is delayed.

        Raises
        ------
        ImproperSystem
            More zeros than poles.
        """
        rational = cls.from_state_space(StateSpaceModel.from_channel(realize(system)), 0.0)
        return rational.delayed(system.theta)

    @classmethod
    def from_state_space(cls, model: StateSpaceModel, theta: float = 0.0) -> DelaySystem:
        """A state-space model whose inputs are delayed by ``theta``, >= 0 [time]."""
        rational = cls(model.A, model.B, model.C, model.D, np.zeros(0))
        if not theta:
            return rational
        n, m, p = model.states, model.inputs, model.outputs
        return cls(
            model.A,
            np.hstack([np.zeros((n, m)), model.B]),
            np.vstack([model.C, np.zeros((m, n))]),
            np.block([[np.zeros((p, m)), model.D], [np.eye(m), np.zeros((m, m))]]),
            np.full(m, theta),
        )

    @classmethod
    def static(cls, D: npt.ArrayLike) -> DelaySystem:
        """A gain without states or delays, D of shape (p, m)."""
        d = np.atleast_2d(np.asarray(D, dtype=float))
        return cls(np.zeros((0, 0)), np.zeros((0, d.shape[1])), np.zeros((d.shape[0], 0)), d, np.zeros(0))

    @cached_property
    def key(self) -> bytes:
        """Content of the system; equal systems have equal keys."""
        sizes = np.array([self.order, self.inputs, self.outputs], dtype=float)
        return b"".join((a + 0.0).tobytes() for a in (sizes, self.tau, self.A, self.B, self.C, self.D))

    def __hash__(self) -> int:
        return hash(self.key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, DelaySystem) and self.key == other.key

    @property
    def order(self) -> int:
        """Number of states n of the rational part."""
        return int(self.A.shape[0])

    @property
    def inputs(self) -> int:
        """Number of inputs m."""
        return int(self.D.shape[1]) - self.tau.size

    @property
    def outputs(self) -> int:
        """Number of outputs p."""
        return int(self.D.shape[0]) - self.tau.size

    @property
    def B1(self) -> FloatArray:
        """Inputs to states, shape (n, m)."""
        return self.B[:, : self.inputs]

    @property
    def B2(self) -> FloatArray:
        """Delayed signals to states, shape (n, k)."""
        return self.B[:, self.inputs :]

    @property
    def C1(self) -> FloatArray:
        """States to outputs, shape (p, n)."""
        return self.C[: self.outputs]

    @property
    def C2(self) -> FloatArray:
        """States to signals that will be delayed, shape (k, n)."""
        return self.C[self.outputs :]

    @property
    def D11(self) -> FloatArray:
        """Inputs straight to outputs, shape (p, m)."""
        return self.D[: self.outputs, : self.inputs]

    @property
    def D12(self) -> FloatArray:
        """Delayed signals to outputs, shape (p, k)."""
        return self.D[: self.outputs, self.inputs :]

    @property
    def D21(self) -> FloatArray:
        """Inputs straight into the delays, shape (k, m)."""
        return self.D[self.outputs :, : self.inputs]

    @property
    def D22(self) -> FloatArray:
        """From delay to delay without a state between, shape (k, k)."""
        return self.D[self.outputs :, self.inputs :]

    @cached_property
    def balanced(self) -> DelaySystem:
        """The same system with its states scaled to equal sizes by powers of two."""
        if not self.order:
            return self
        size = np.abs(self.A) + np.abs(self.B2) @ np.abs(self.C2)
        _, (scale, _) = matrix_balance(size, permute=False, separate=True)
        return DelaySystem(self.A * (scale / scale[:, None]), self.B / scale[:, None], self.C * scale, self.D, self.tau)

    def delayed(self, theta: float) -> DelaySystem:
        """The same system with each output later by ``theta``, >= 0 [time]."""
        if not theta:
            return self
        p, k = self.outputs, self.tau.size
        C = np.vstack([np.zeros((p, self.order)), self.C2, self.C1])
        D = np.block(
            [
                [np.zeros((p, self.inputs + k)), np.eye(p)],
                [self.D21, self.D22, np.zeros((k, p))],
                [self.D11, self.D12, np.zeros((p, p))],
            ]
        )
        B = np.hstack([self.B, np.zeros((self.order, p))])
        return DelaySystem(self.A, B, C, D, np.append(self.tau, np.full(p, theta)))

    def rational(self) -> StateSpaceModel:
        """The system as a state-space model, where nothing is delayed.

        Raises
        ------
        InvalidInput
            It has dead times, or more than 50 states.
        """
        if self.tau.size:
            raise InvalidInput("a system with dead times has no state-space model", field="tau")
        return StateSpaceModel(self.A, self.B, self.C, self.D)

    def require_single(self) -> DelaySystem:
        """Return self, or raise InvalidInput where there is more than one input or output."""
        if self.inputs != 1 or self.outputs != 1:
            raise InvalidInput(
                f"one input and one output are needed here, not {self.inputs} and {self.outputs}", field="system"
            )
        return self
