"""What a linear system is: factored transfer functions with dead time, their text, models and state space."""

from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.integrating import DIPDT, IPDT
from looplab.engine.systems.realization import StateSpace, realize
from looplab.engine.systems.text import expression_latex, parse_transfer_function
from looplab.engine.systems.transfer_function import TransferFunction

__all__ = [
    "DIPDT",
    "FOPDT",
    "IPDT",
    "SOPDT",
    "StateSpace",
    "TransferFunction",
    "expression_latex",
    "parse_transfer_function",
    "realize",
]
