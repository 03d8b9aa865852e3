"""Stable loops around unstable plants: open-loop and closed-loop poles are drawn, and L = Q/D - 1 leads there."""

import numpy as np

from looplab.engine.loop import FeedbackLoop
from looplab.engine.systems import TransferFunction


def placed_loops(count: int = 40, seed: int = 7) -> list[tuple[FeedbackLoop, list[complex], float]]:
    """Loops with their unstable open-loop poles and lim s L(s); zeros fall where they may, to the right too."""
    rng = np.random.default_rng(seed)
    out = []
    while len(out) < count:
        n = int(rng.integers(2, 6))
        unstable: list[complex] = (
            [complex(rng.uniform(0.1, 2.0))]
            if rng.random() < 0.6
            else [x := complex(rng.uniform(0.1, 1.0), rng.uniform(0.5, 2.0)), x.conjugate()]
        )
        poles = [*unstable, *(-rng.uniform(0.2, 5.0, n)).tolist()][: max(n, len(unstable))]
        D, Q = np.poly(poles).real, np.poly(-rng.uniform(0.3, 4.0, len(poles))).real
        N = (Q - D)[1:]
        L = TransferFunction(np.roots(N), poles, float(N[0]))
        out.append((FeedbackLoop(L, TransferFunction([], [], 1.0)), unstable, float(N[0])))
    return out
