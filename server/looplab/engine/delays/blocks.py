"""Block diagrams of one-channel systems: connected exactly, and as one transfer function while they are one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from looplab.engine.delays import connections
from looplab.engine.delays.system import DelaySystem
from looplab.engine.errors import EngineError, InvalidInput
from looplab.engine.state_space import invariant_zeros
from looplab.engine.state_space.model import MAX_STATES
from looplab.engine.systems.polynomial import pair_conjugates
from looplab.engine.systems.transfer_function import TransferFunction


@dataclass(frozen=True)
class Block:
    """A system of one input and one output.

    Attributes
    ----------
    system : DelaySystem
        With every state and dead time.
    transfer_function : TransferFunction or None
        The same as zeros, poles, gain and one dead time, nothing cancelled; None where it is no such system, with the
        ``reason``.
    """

    system: DelaySystem
    transfer_function: TransferFunction | None
    reason: str | None = None

    @classmethod
    def of(cls, transfer_function: TransferFunction) -> Block:
        """A transfer function as a block; raises ImproperSystem where it differentiates."""
        return cls(DelaySystem.from_transfer_function(transfer_function), transfer_function)


def _connected(system: DelaySystem, known: TransferFunction | str) -> Block:
    return Block(system, known) if isinstance(known, TransferFunction) else Block(system, None, known)


def in_series(blocks: list[Block]) -> Block:
    """One after the other. Neighbours that are transfer functions become one, with one dead time.

    Raises
    ------
    InvalidInput
        There is no block.
    """
    if not blocks:
        raise InvalidInput("a series needs at least one system", field="of")
    merged = blocks[:1]
    for block in blocks[1:]:
        last = merged[-1]
        if last.transfer_function is not None and block.transfer_function is not None:
            merged[-1] = Block.of(last.transfer_function * block.transfer_function)
        else:
            merged.append(block)
    if len(merged) == 1:
        return merged[0]
    system = merged[0].system
    for block in merged[1:]:
        system = connections.series(system, block.system)
    reason = next(block.reason for block in merged if block.reason is not None)
    return Block(system, None, reason)


def _rational_sum(system: DelaySystem, poles: list[TransferFunction], theta: float) -> TransferFunction | str:
    if system.order > MAX_STATES:
        return f"it has more than {MAX_STATES} poles"
    try:
        zeros, gain = invariant_zeros(system.rational())
        return TransferFunction(zeros, np.concatenate([G.poles for G in poles if G.gain]), gain, theta)
    except EngineError as error:
        return error.message


def in_parallel(blocks: list[Block], signs: list[float] | None = None) -> Block:
    """The same input for all, their outputs added with ``signs`` (None is all plus).

    Raises
    ------
    InvalidInput
        There is no block, or not one sign for each.
    """
    if not blocks:
        raise InvalidInput("a sum needs at least one system", field="of")
    signs = [1.0] * len(blocks) if signs is None else signs
    if len(signs) != len(blocks):
        raise InvalidInput(f"{len(blocks)} systems need {len(blocks)} signs, not {len(signs)}", field="signs")
    split = DelaySystem.static(np.ones((len(blocks), 1)))
    theta = {block.transfer_function.theta for block in blocks if block.transfer_function}
    known = [block.transfer_function for block in blocks if block.transfer_function is not None]
    together = len(known) == len(blocks) and len(theta) == 1
    parts = [DelaySystem.from_transfer_function(G.without_dead_time()) for G in known] if together else None
    inner = connections.append(*(parts or [block.system for block in blocks]))
    system = connections.series(connections.series(split, inner), connections.summing(signs))
    if together:
        late = theta.pop()
        return _connected(system.delayed(late), _rational_sum(system, known, late))
    reason = next((block.reason for block in blocks if block.reason is not None), None)
    return Block(system, None, reason or "it is a sum of terms with different dead times")


def in_feedback(forward: Block, backward: Block | None = None, sign: float = -1.0) -> Block:
    """A loop around ``forward``, through ``backward`` or directly; ``sign`` is that of what comes back.

    Raises
    ------
    IllPosedLoop
        The loop is an algebraic one without a solution.
    """
    back = backward or Block.of(TransferFunction())
    system = connections.feedback(forward.system, back.system if backward else None, sign)
    G, H = forward.transfer_function, back.transfer_function
    if G is None or H is None:
        return Block(system, None, forward.reason or back.reason)
    if G.theta or H.theta:
        return Block(system, None, "a dead time lies in a loop")
    if system.order > MAX_STATES:
        return Block(system, None, f"it has more than {MAX_STATES} poles")
    through = 1.0 - sign * G.high_frequency_gain * H.high_frequency_gain
    poles = pair_conjugates(system.rational().poles) if G.gain and H.gain else np.concatenate([G.poles, H.poles])
    try:
        closed = TransferFunction(np.concatenate([G.zeros, H.poles]), poles, G.gain / through)
    except EngineError as error:
        return Block(system, None, error.message)
    return Block(system, closed)
