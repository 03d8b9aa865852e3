"""State-space models: conversions, controllability and observability, Gramians."""

from looplab.engine.state_space.controllability import (
    Mode,
    RankTest,
    StructureAnalysis,
    analyse_structure,
    controllability_matrix,
    observability_matrix,
)
from looplab.engine.state_space.from_ode import from_ode, initial_state
from looplab.engine.state_space.gramians import Gramians, gramians
from looplab.engine.state_space.interop import from_control, to_control
from looplab.engine.state_space.minimal_realization import MinimalRealization, RemovedMode, minimal_realization
from looplab.engine.state_space.model import StateSpaceModel
from looplab.engine.state_space.to_transfer_function import (
    Cancellation,
    MinimalForm,
    invariant_zeros,
    minimal,
    to_transfer_function,
)

__all__ = [
    "Cancellation",
    "Gramians",
    "MinimalForm",
    "MinimalRealization",
    "Mode",
    "RankTest",
    "RemovedMode",
    "StateSpaceModel",
    "StructureAnalysis",
    "analyse_structure",
    "controllability_matrix",
    "from_control",
    "from_ode",
    "gramians",
    "initial_state",
    "invariant_zeros",
    "minimal",
    "minimal_realization",
    "observability_matrix",
    "to_control",
    "to_transfer_function",
]
