"""The list of tuning rules, in the order in which they are shown."""

from __future__ import annotations

from typing import Literal

from looplab.engine.tuning import (
    amigo,
    astrom_hagglund_relay,
    chien_hrones_reswick,
    cohen_coon_rule,
    error_integrals,
    imc,
    lambda_tuning,
    shinskey,
    simc,
    tyreus_luyben,
    ziegler_nichols,
    ziegler_nichols_reaction,
)
from looplab.engine.tuning.settings import Rule

RuleName = Literal[
    "ziegler_nichols", "tyreus_luyben", "astrom_hagglund_relay",
    "ziegler_nichols_reaction", "cohen_coon", "chr_setpoint_0", "chr_setpoint_20", "chr_load_0", "chr_load_20", "amigo",
    "imc", "lambda_tuning", "simc",
    "iae_load", "ise_load", "itae_load", "iae_setpoint", "itae_setpoint", "shinskey",
]  # fmt: skip

_ORDER: tuple[Rule, ...] = (
    ziegler_nichols.RULE,
    tyreus_luyben.RULE,
    astrom_hagglund_relay.RULE,
    ziegler_nichols_reaction.RULE,
    cohen_coon_rule.RULE,
    *chien_hrones_reswick.RULES,
    amigo.RULE,
    imc.RULE,
    lambda_tuning.RULE,
    simc.RULE,
    *error_integrals.RULES,
    shinskey.RULE,
)
RULES: dict[str, Rule] = {rule.id: rule for rule in _ORDER}
