"""Several loops on one process: relative gains, pairing, decentralised PID loops, interaction and decouplers."""

from looplab.engine.mimo.decoupling import Decoupler, Element, Prediction, dynamic_decoupler, static_decoupler
from looplab.engine.mimo.interaction import Interaction, effective_process, interaction
from looplab.engine.mimo.loops import MultiLoop
from looplab.engine.mimo.pairing import NI_ASSUMES, Pairing, PairingStudy, niederlinski_index, study_pairings
from looplab.engine.mimo.process import ProcessMatrix, check_pairing
from looplab.engine.mimo.relative_gain import relative_gain_array, rga_at_rest, rga_number, rga_response
from looplab.engine.mimo.simulation import Change, MultiLoopResponse, simulate_loops
from looplab.engine.mimo.singular_values import SingularValues, singular_values
from looplab.engine.mimo.tuning import BLTSettings, LoopSettings, blt, tune_alone

__all__ = [
    "NI_ASSUMES",
    "BLTSettings",
    "Change",
    "Decoupler",
    "Element",
    "Interaction",
    "LoopSettings",
    "MultiLoop",
    "MultiLoopResponse",
    "Pairing",
    "PairingStudy",
    "Prediction",
    "ProcessMatrix",
    "SingularValues",
    "blt",
    "check_pairing",
    "dynamic_decoupler",
    "effective_process",
    "interaction",
    "niederlinski_index",
    "relative_gain_array",
    "rga_at_rest",
    "rga_number",
    "rga_response",
    "simulate_loops",
    "singular_values",
    "static_decoupler",
    "study_pairings",
    "tune_alone",
]
