"""Root loci of systems never seen before, beside python-control's `root_locus_map`."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from looplab.bench.scenarios import PADE_ORDER
from looplab.bench.timing import WARM_UP, interleave


@dataclass(frozen=True)
class Locus:
    """gain prod(s - z)/prod(s - p) exp(-theta s)."""

    name: str
    zeros: tuple[complex, ...]
    poles: tuple[complex, ...]
    gain: float
    theta: float = 0.0

    def ours(self, stretch: float) -> Any:
        """By looplab, every root ``stretch`` times as fast."""
        from looplab.engine.stability import root_locus
        from looplab.engine.systems import TransferFunction

        zeros, poles = (stretch * np.array(roots, dtype=complex) for roots in (self.zeros, self.poles))
        return root_locus(TransferFunction(zeros, poles, self.gain, self.theta / stretch))

    def peer(self, stretch: float) -> Any:
        """By python-control; its dead time is a Pade fraction."""
        import control

        zeros, poles = (stretch * np.array(roots, dtype=complex) for roots in (self.zeros, self.poles))
        L = control.tf(self.gain * np.poly(zeros).real, np.poly(poles).real)
        if self.theta:
            L = L * control.tf(*control.pade(self.theta / stretch, PADE_ORDER))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return control.root_locus_map(L)


_CUBE_ROOT = 5.0 ** (1.0 / 3.0)
LOCI = (
    Locus(
        "(s+3)/(s^2 (s+2)(s+4)(s^2+2s+9)(s^3+5))",
        (-3.0,),
        (
            *(0.0, 0.0, -2.0, -4.0),
            *(complex(-1.0, 8.0**0.5), complex(-1.0, -(8.0**0.5)), -_CUBE_ROOT),
            *(_CUBE_ROOT * complex(0.5, 0.75**0.5), _CUBE_ROOT * complex(0.5, -(0.75**0.5))),
        ),
        1.0,
    ),
    Locus("exp(-0.1 s)/(0.5 s + 1), PI", (-3.0,), (0.0, -2.0), 2.0, 0.1),
)


def measure(rounds: int, tick: Callable[[str], None]) -> list[dict[str, Any]]:
    """Time every locus; rows as those of the moves."""
    rows = []
    for locus in LOCI:

        def advance(name: str = locus.name) -> None:
            tick(f"locus: {name}")

        stretches = [1.0 + 1e-7 * i for i in range(1, rounds + WARM_UP + 1)]
        timed = interleave(locus.ours, locus.peer, stretches, advance)
        rows.append(
            {
                "way": "",
                "loop": locus.name,
                "what": "root locus",
                "goal": None,
                "note": "",
                "pade_order": PADE_ORDER if locus.theta else None,
                **timed,
            }
        )
    return rows
