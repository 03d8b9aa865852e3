"""Tuning rules against their published tables, their scaling, and what they refuse."""

import numpy as np
import pytest

from looplab.engine.errors import EngineError, InvalidInput, RuleNotApplicable
from looplab.engine.systems import FOPDT
from looplab.engine.tuning import RULES, cohen_coon, ziegler_nichols_ultimate


@pytest.mark.parametrize(
    ("type", "gain", "integral", "derivative"),
    [("P", 0.5, None, None), ("PI", 0.45, 1 / 1.2, None), ("PID", 0.6, 0.5, 0.125)],
)
def test_ziegler_nichols_table(type: str, gain: float, integral: float | None, derivative: float | None) -> None:
    """J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759-768, ultimate-cycle settings."""
    for Ku, Pu in ((8.0, 3.6276), (-0.4, 120.0)):
        s = ziegler_nichols_ultimate(Ku, Pu, type)
        assert s.Kc == pytest.approx(gain * Ku)
        assert s.tau_I == (None if integral is None else pytest.approx(integral * Pu))
        assert s.tau_D == (None if derivative is None else pytest.approx(derivative * Pu))
        assert s.formula
        assert "1942" in s.source


@pytest.mark.parametrize("ratio", [0.01, 0.2, 1.0, 4.0])
def test_cohen_coon_table(ratio: float) -> None:
    """G. H. Cohen, G. A. Coon, Trans. ASME 75 (1953) 827-834; r = theta/tau."""
    K, tau = -2.5, 3.0
    theta, r = ratio * tau, ratio
    P, PI, PID = (cohen_coon(FOPDT(K, tau, theta), type) for type in ("P", "PI", "PID"))
    assert P.Kc == pytest.approx((1 / (K * r)) * (1 + r / 3))
    assert PI.Kc == pytest.approx((1 / (K * r)) * (0.9 + r / 12))
    assert PI.tau_I == pytest.approx(theta * (30 + 3 * r) / (9 + 20 * r))
    assert PID.Kc == pytest.approx((1 / (K * r)) * (4 / 3 + r / 4))
    assert PID.tau_I == pytest.approx(theta * (32 + 6 * r) / (13 + 8 * r))
    assert PID.tau_D == pytest.approx(theta * 4 / (11 + 2 * r))
    assert PI.tau_D is None
    assert P.tau_I is None


@pytest.mark.parametrize("type", ["P", "PI", "PID"])
def test_scaling_of_gain_and_time(type: str) -> None:
    a, b = cohen_coon(FOPDT(1, 0.5, 0.1), type), cohen_coon(FOPDT(4, 30, 6), type)
    assert b.Kc == pytest.approx(a.Kc / 4)
    for name in ("tau_I", "tau_D"):
        x, y = getattr(a, name), getattr(b, name)
        assert (x is None and y is None) or y == pytest.approx(60 * x)


@pytest.mark.parametrize(
    ("call", "error"),
    [
        (lambda: cohen_coon(FOPDT(1, 1, 0), "PI"), RuleNotApplicable),
        (lambda: cohen_coon(FOPDT(1, 1, 4.01), "PI"), RuleNotApplicable),
        (lambda: cohen_coon(FOPDT(1, 1, 1), "PD"), RuleNotApplicable),
        (lambda: ziegler_nichols_ultimate(0, 1, "P"), InvalidInput),
        (lambda: ziegler_nichols_ultimate(1, 0, "P"), InvalidInput),
        (lambda: ziegler_nichols_ultimate(1, np.nan, "P"), InvalidInput),
        (lambda: ziegler_nichols_ultimate(np.nan, 1, "P"), InvalidInput),
        (lambda: ziegler_nichols_ultimate(np.inf, 1, "P"), InvalidInput),
        (lambda: ziegler_nichols_ultimate(1, np.inf, "P"), InvalidInput),
        (lambda: ziegler_nichols_ultimate(1, 1, "PD"), RuleNotApplicable),
    ],
)
def test_refusals(call, error: type[EngineError]) -> None:
    with pytest.raises(error) as caught:
        call()
    assert caught.value.message
    assert caught.value.field


def test_every_rule_names_its_source_and_formulas() -> None:
    for rule in RULES.values():
        assert rule.name
        assert rule.source
        assert set(rule.formulas) == {"P", "PI", "PID"}
        assert rule.needs in ("ultimate", "model")
