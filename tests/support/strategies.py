"""Random systems and loops for property tests, and their effort.

LOOPLAB_EXAMPLES=1000 looks further than the fixed examples of the everyday run.
"""

import os

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from looplab.engine.loop import PID
from looplab.engine.systems import TransferFunction

_wanted = int(os.environ.get("LOOPLAB_EXAMPLES", "0"))


def effort(examples: int = 40) -> settings:
    return settings(
        max_examples=_wanted or examples, deadline=None, derandomize=not _wanted, database=None,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large],
    )  # fmt: skip


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Three significant digits: failures stay readable, and roots are neither equal nor nearly equal by accident."""
    return st.floats(low, high).map(lambda v: float(f"{v:.3g}"))


magnitudes = st.floats(-1.0, 1.0).map(lambda e: float(f"{10.0**e:.3g}"))


@st.composite
def root_sets(draw: st.DrawFn, size: int, stable: bool, axis: bool = False) -> list[complex]:
    """``size`` roots closed under conjugation, 0.1 to 10 in size."""
    roots: list[complex] = []
    while len(roots) < size:
        side = -1.0 if stable else draw(st.sampled_from([-1.0, -1.0, 1.0]))
        r = draw(magnitudes)
        if size - len(roots) >= 2 and draw(st.booleans()):
            zeta = 0.0 if axis and draw(st.integers(0, 3)) == 0 else draw(numbers(0.05, 0.95))
            p = complex(side * r * zeta, r * (1 - zeta**2) ** 0.5)
            roots += [p, p.conjugate()]
        else:
            roots.append(complex(0.0 if axis and draw(st.integers(0, 3)) == 0 else side * r))
    return roots


@st.composite
def systems(
    draw: st.DrawFn,
    order: tuple[int, int] = (1, 4),
    excess: int = 1,
    stable: bool = True,
    axis: bool = False,
    theta: bool = False,
    gain: bool = True,
) -> TransferFunction:
    """Proper systems with relative degree ``excess`` at least."""
    n = draw(st.integers(*order))
    m = draw(st.integers(0, max(0, n - excess)))
    k = draw(magnitudes) * (draw(st.sampled_from([1.0, 1.0, -1.0])) if gain else 1.0)
    return TransferFunction(
        draw(root_sets(m, stable=False)), draw(root_sets(n, stable, axis)), k, draw(magnitudes) if theta else 0.0
    )


@st.composite
def controllers(draw: st.DrawFn) -> PID:
    return PID(
        Kc=draw(magnitudes) * draw(st.sampled_from([1.0, 1.0, -1.0])),
        tau_I=draw(st.none() | magnitudes), tau_D=draw(st.none() | magnitudes), alpha=draw(numbers(0.05, 0.5)),
        form=draw(st.sampled_from(["ideal", "series"])),
    )  # fmt: skip
