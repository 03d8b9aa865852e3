"""How large a formula and a model may be."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Bounds that keep any text quick to read, differentiate and compute.

    Attributes
    ----------
    characters, tokens, depth : int
        Of one expression: its length, its parts, and how deep brackets, signs and powers are nested.
    nodes : int
        Of a model: operations of all its expressions and their derivatives, each counted once.
    expressions, states : int
        Of a model.
    """

    characters: int = 500
    tokens: int = 200
    depth: int = 40
    nodes: int = 2_000
    expressions: int = 40
    states: int = 12


# For models that our own code writes, such as a column with a state for each tray.
BUILT_IN = Limits(characters=2_000, tokens=600, depth=40, nodes=40_000, expressions=400, states=120)
