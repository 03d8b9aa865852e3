"""Tuning rules against their published tables (a second source each), their scaling, and what they refuse."""

from math import pi, sqrt

import numpy as np
import pytest

from looplab.engine.errors import EngineError, InvalidInput, RuleNotApplicable
from looplab.engine.loop import PID, FeedbackLoop, closed_loop_step, step_metrics
from looplab.engine.systems import DIPDT, FOPDT, IPDT, SOPDT, TransferFunction
from looplab.engine.tuning import (
    RULES,
    TYPES,
    KnownPlant,
    Options,
    RuleName,
    Settings,
    UltimatePoint,
    cohen_coon,
    optimal_tuning,
    relay_point,
    ziegler_nichols_ultimate,
)

# a = theta/tau. Kc K, tau_I/theta, tau_D/theta.
# Ziegler-Nichols, CHR: K. J. Åström, T. Hägglund, PID Controllers, 2nd ed., ISA 1995, ch. 4 (in a and in L or T);
# Cohen-Coon with PD: A. O'Dwyer's form in decimals is rounded, D. R. Coughanowr's (1991) has fractions as here.
REACTION = {
    ("ziegler_nichols_reaction", "P"): lambda a: (1 / a, None, None),
    ("ziegler_nichols_reaction", "PI"): lambda a: (0.9 / a, 10 / 3, None),
    ("ziegler_nichols_reaction", "PID"): lambda a: (1.2 / a, 2, 0.5),
    ("cohen_coon", "P"): lambda a: ((1 + a / 3) / a, None, None),
    ("cohen_coon", "PI"): lambda a: ((0.9 + a / 12) / a, (30 + 3 * a) / (9 + 20 * a), None),
    ("cohen_coon", "PD"): lambda a: ((5 / 4 + a / 6) / a, None, (6 - 2 * a) / (22 + 3 * a)),
    ("cohen_coon", "PID"): lambda a: ((4 / 3 + a / 4) / a, (32 + 6 * a) / (13 + 8 * a), 4 / (11 + 2 * a)),
    ("chr_setpoint_0", "P"): lambda a: (0.3 / a, None, None),
    ("chr_setpoint_0", "PI"): lambda a: (0.35 / a, 1.2 / a, None),
    ("chr_setpoint_0", "PID"): lambda a: (0.6 / a, 1 / a, 0.5),
    ("chr_setpoint_20", "P"): lambda a: (0.7 / a, None, None),
    ("chr_setpoint_20", "PI"): lambda a: (0.6 / a, 1 / a, None),
    ("chr_setpoint_20", "PID"): lambda a: (0.95 / a, 1.4 / a, 0.47),
    ("chr_load_0", "P"): lambda a: (0.3 / a, None, None),
    ("chr_load_0", "PI"): lambda a: (0.6 / a, 4, None),
    ("chr_load_0", "PID"): lambda a: (0.95 / a, 2.4, 0.42),
    ("chr_load_20", "P"): lambda a: (0.7 / a, None, None),
    ("chr_load_20", "PI"): lambda a: (0.7 / a, 2.3, None),
    ("chr_load_20", "PID"): lambda a: (1.2 / a, 2, 0.42),
    ("iae_load", "PI"): lambda a: (0.984 * a**-0.986, a ** (0.707 - 1) / 0.608, None),
    ("itae_load", "PI"): lambda a: (0.859 * a**-0.977, a ** (0.680 - 1) / 0.674, None),
    ("itae_load", "PID"): lambda a: (1.357 * a**-0.947, a ** (0.738 - 1) / 0.842, 0.381 * a**-0.005),
    ("itae_setpoint", "PI"): lambda a: (0.586 * a**-0.916, 1 / a / (1.03 - 0.165 * a), None),
    ("itae_setpoint", "PID"): lambda a: (0.965 * a**-0.85, 1 / a / (0.796 - 0.1465 * a), 0.308 * a ** (0.929 - 1)),
}


def tuned(rule: str, type: str, plant: TransferFunction | FOPDT, **options: float) -> Settings:
    known = KnownPlant(model=plant) if isinstance(plant, FOPDT) else KnownPlant.of(plant)
    return known.tune(RULES[rule], type, Options(**options))


@pytest.mark.parametrize(("rule", "type"), REACTION)
@pytest.mark.parametrize("a", [0.1, 0.35, 1.0])
def test_tables_of_the_reaction_curve(rule: str, type: str, a: float) -> None:
    K, theta = -2.5, 0.7
    found = tuned(rule, type, FOPDT(K, theta / a, theta))
    gain, integral, derivative = REACTION[rule, type](a)
    assert found.Kc == pytest.approx(gain / K, rel=1e-12)
    assert found.tau_I == (None if integral is None else pytest.approx(integral * theta, rel=1e-12))
    assert found.tau_D == (None if derivative is None else pytest.approx(derivative * theta, rel=1e-12))


@pytest.mark.parametrize(
    ("rule", "type", "gain", "integral", "derivative"),
    [
        ("ziegler_nichols", "P", 0.5, None, None),
        ("ziegler_nichols", "PI", 0.45, 1 / 1.2, None),
        ("ziegler_nichols", "PID", 0.6, 0.5, 0.125),
        ("tyreus_luyben", "PI", 1 / 3.2, 2.2, None),
        ("tyreus_luyben", "PID", 1 / 2.2, 2.2, 1 / 6.3),
    ],
)
def test_tables_of_the_ultimate_cycle(
    rule: str, type: str, gain: float, integral: float | None, derivative: float | None
) -> None:
    """Ziegler and Nichols 1942; Tyreus and Luyben 1992 as in D. E. Seborg et al., 3rd ed. 2011, ch. 12."""
    for Ku, Pu in ((8.0, 3.6276), (-0.4, 120.0)):
        found = KnownPlant(ultimate=UltimatePoint.of(Ku, Pu)).tune(RULES[rule], type)
        assert found.Kc == pytest.approx(gain * Ku)
        assert found.tau_I == (None if integral is None else pytest.approx(integral * Pu))
        assert found.tau_D == (None if derivative is None else pytest.approx(derivative * Pu))


@pytest.mark.parametrize("PM_deg", [20.0, 45.0, 70.0])
def test_the_relay_rule_moves_the_ultimate_point_to_its_phase_margin(PM_deg: float) -> None:
    """By definition: L(i omega_180) = -e^{i PM}, with tau_I = 4 tau_D, before the derivative is filtered."""
    P = TransferFunction((), (-1, -1, -1, -0.4), 3.0, 0.3)
    point = KnownPlant.of(P).ultimate()
    s = KnownPlant.of(P).tune(RULES["astrom_hagglund_relay"], "PID", Options(PM_deg=PM_deg))
    w = 1j * point.omega_180
    assert s.tau_I is not None
    assert s.tau_D is not None
    L = s.Kc * (1 + 1 / (s.tau_I * w) + s.tau_D * w) * P(w)
    assert L == pytest.approx(-np.exp(1j * np.radians(PM_deg)), abs=1e-9)
    assert s.tau_I == pytest.approx(4 * s.tau_D)


def test_a_relay_gives_the_ultimate_gain_by_its_describing_function() -> None:
    point = relay_point(2.0, 0.5, 7.0, hysteresis=0.3)
    assert point.Ku == pytest.approx(4 * 2 / (pi * 0.4))
    assert point.Pu * point.omega_180 == pytest.approx(2 * pi)
    for bad in ((0, 1, 1), (1, 0.1, 1), (1, 1, 0), (1, np.nan, 1)):
        with pytest.raises(InvalidInput):
            relay_point(*bad, hysteresis=0.2)


def test_imc_is_the_controller_that_its_definition_gives() -> None:
    """C = (1/G_minus) f/(1 - f e^{-theta s}) with e^{-theta s} replaced as each case says (Seborg, sec. 12.2.2)."""
    K, tau, theta, tau_c = 2.0, 5.0, 1.0, 1.5
    s = np.array([0.3j, 1.0 + 0.2j])
    model = FOPDT(K, tau, theta)
    PI, PID_ = (tuned("imc", t, model, tau_c=tau_c) for t in ("PI", "PID"))
    assert PI.tau_I is not None
    # First-order Taylor: e^{-theta s} = 1 - theta s.
    assert PI.Kc * (1 + 1 / (PI.tau_I * s)) == pytest.approx((tau * s + 1) / K / ((tau_c + theta) * s))
    # First-order Padé.
    assert PID_.tau_I is not None
    assert PID_.tau_D is not None
    C = PID_.Kc * (1 + 1 / (PID_.tau_I * s) + PID_.tau_D * s)
    assert pytest.approx((tau * s + 1) * (theta / 2 * s + 1) / K / ((tau_c + theta / 2) * s)) == C
    second = tuned("imc", "PID", SOPDT(K, tau, 0.3, theta).to_transfer_function(), tau_c=tau_c)
    assert second.tau_I is not None
    assert second.tau_D is not None
    C = second.Kc * (1 + 1 / (second.tau_I * s) + second.tau_D * s)
    assert pytest.approx((tau**2 * s**2 + 2 * 0.3 * tau * s + 1) / K / ((tau_c + theta) * s)) == C
    assert tuned("lambda_tuning", "PID", model, tau_c=tau_c).Kc == pytest.approx(PID_.Kc)
    assert tuned("lambda_tuning", "PI", model).Kc == pytest.approx(tau / (K * (3 * tau + theta)))
    assert tuned("imc", "PI", model).Kc == pytest.approx(tau / (K * (0.8 + theta)))


@pytest.mark.parametrize(
    ("rule", "type", "Kc", "tau_I", "tau_D"),
    [
        # D. E. Seborg et al., 3rd ed. 2011, Table 12.1 (cases M and N); Skogestad 2003, Table 1; Åström and Hägglund
        # 2006, p. 229 and 233; F. G. Shinskey 1994 (PI) and 1996, Table 4.4, row 0 (PID).
        ("imc", "PI", lambda c: (2 * c + 1) / (c + 1) ** 2, lambda c: 2 * c + 1, None),
        ("imc", "PID", lambda c: (2 * c + 1) / (c + 0.5) ** 2, lambda c: 2 * c + 1, lambda c: (c + 0.25) / (2 * c + 1)),
        ("lambda_tuning", "PI", lambda c: (2 * c + 1) / (c + 1) ** 2, lambda c: 2 * c + 1, None),
        ("simc", "PI", lambda c: 1 / (c + 1), lambda c: 4 * (c + 1), None),
        ("amigo", "PI", lambda c: 0.35, lambda c: 13.4, None),
        ("amigo", "PID", lambda c: 0.45, lambda c: 8.0, lambda c: 0.5),
        ("ziegler_nichols_reaction", "PI", lambda c: 0.9, lambda c: 10 / 3, None),
        ("shinskey", "PI", lambda c: 100 / 105, lambda c: 4.0, None),
        ("shinskey", "PID", lambda c: 100 / 78, lambda c: 1.9, lambda c: 0.48),
    ],
)
@pytest.mark.parametrize("tau_c", [1.0, 3.0])
def test_integrating_processes(rule, type, Kc, tau_I, tau_D, tau_c) -> None:
    K, theta = -0.2, 3.0
    found = tuned(rule, type, IPDT(K, theta).to_transfer_function(), tau_c=tau_c * theta)
    assert found.Kc == pytest.approx(Kc(tau_c) / (K * theta), rel=1e-12)
    assert found.tau_I == pytest.approx(tau_I(tau_c) * theta, rel=1e-12)
    assert found.tau_D == (None if tau_D is None else pytest.approx(tau_D(tau_c) * theta, rel=1e-12))


def test_simc_on_a_double_integrator_is_the_series_controller_of_the_paper() -> None:
    """S. Skogestad, J. Process Control 13 (2003), Table 1: Kc = 1/(4 K (tau_c+theta)^2), both times 4 (tau_c+theta)."""
    found = tuned("simc", "PID", DIPDT(0.5, 2.0).to_transfer_function())
    assert found.published is not None
    assert (found.published.Kc, found.published.tau_I, found.published.tau_D) == pytest.approx((1 / 32, 16, 16))
    # Ideal form of two equal times: the gain doubles, tau_I doubles, tau_D halves.
    assert (found.Kc, found.tau_I, found.tau_D) == pytest.approx((1 / 16, 32, 8))


@pytest.mark.parametrize("ratio", [0.1, 0.3, 1.0])
@pytest.mark.parametrize("rule", ["iae_load", "ise_load", "itae_load", "iae_setpoint", "itae_setpoint"])
def test_correlations_are_nearly_optimal(rule: str, ratio: float) -> None:
    """A misprint in a coefficient would cost: each PI is within 25 % of the best one by its own criterion."""
    criterion, aim = rule.split("_")
    P = FOPDT(1.0, 1.0 / ratio, 1.0).to_transfer_function()
    found = tuned(rule, "PI", P)
    assert found.tau_I is not None
    best = optimal_tuning(P, "PI", criterion.upper(), aim, 4.0)
    steps = closed_loop_step(FeedbackLoop(P, PID(found.Kc, found.tau_I)), 80.0, 1600)
    response, setpoint = (steps.load, 0.0) if aim == "load" else (steps.setpoint, 1.0)
    value = getattr(step_metrics(response, setpoint=setpoint, stable=True), criterion.upper())
    assert best.value is not None
    assert value < 1.25 * best.value


@pytest.mark.parametrize(("ratio", "printed"), [(0.0, 1.94), (0.2, 1.79), (0.5, 1.61), (1.0, 1.44)])
def test_shinskeys_table_gives_the_iae_printed_beside_it(ratio: float, printed: float) -> None:
    """F. G. Shinskey, Process Control Systems, 4th ed. 1996, Table 4.4: IAE over K theta (1 - e^{-theta/tau})."""
    P = (IPDT(1.0, 1.0) if ratio == 0 else FOPDT(1.0, 1.0 / ratio, 1.0)).to_transfer_function()
    s = tuned("shinskey", "PID", P)
    loop = FeedbackLoop(P, PID(s.Kc, s.tau_I, s.tau_D, alpha=0.005))
    IAE = step_metrics(closed_loop_step(loop, 40.0, 2000).load, setpoint=0.0, stable=True).IAE
    assert IAE is not None
    best = 1.0 if ratio == 0 else 1.0 - np.exp(-ratio)
    assert IAE / best == pytest.approx(printed, rel=0.015)


def test_every_rule_names_its_source_range_and_formulas() -> None:
    assert set(RULES) == set(RuleName.__args__)
    for name, rule in RULES.items():
        assert rule.id == name
        assert all((rule.name, rule.source, rule.family, rule.validity))
        assert rule.types
        assert set(rule.types) <= set(TYPES)
        assert all(rule.formula(type) for type in rule.types)
        assert ("ultimate" in rule.formulas) == (rule.needs == "ultimate")


@pytest.mark.parametrize("name", RULES)
@pytest.mark.parametrize("text", ["lags", "integrator"])
def test_scaling_of_gain_and_time(name: str, text: str) -> None:
    """P(s/a) b: gains 1/b, times 1/a as large, whatever the rule; and a refusal stays a refusal."""
    a, b = 0.125, -4.0
    poles, zeros = np.array([-1.0, -2.0, -4.0] if text == "lags" else [0.0, -2.0, -4.0]), np.array([-9.0])
    P = TransferFunction(zeros, poles, 2.0, 0.3)
    Q = TransferFunction(zeros * a, poles * a, b * 2.0 * a**2, 0.3 / a)
    for type in RULES[name].types:
        try:
            x = tuned(name, type, P)
        except RuleNotApplicable:
            with pytest.raises(RuleNotApplicable):
                tuned(name, type, Q)
            continue
        y = tuned(name, type, Q)
        assert y.Kc * b == pytest.approx(x.Kc, rel=1e-6)
        for p, q in ((x.tau_I, y.tau_I), (x.tau_D, y.tau_D)):
            assert (p is None and q is None) or q * a == pytest.approx(p, rel=1e-6)


@pytest.mark.parametrize(
    ("call", "error"),
    [
        (lambda: cohen_coon(FOPDT(1, 1, 0), "PI"), RuleNotApplicable),
        (lambda: cohen_coon(FOPDT(1, 1, 4.01), "PI"), RuleNotApplicable),
        (lambda: cohen_coon(FOPDT(1, 1, 3), "PD"), RuleNotApplicable),
        (lambda: tuned("tyreus_luyben", "PD", FOPDT(1, 1, 1)), RuleNotApplicable),
        (lambda: tuned("chr_load_0", "PI", FOPDT(1, 1, 0.099)), RuleNotApplicable),
        (lambda: tuned("itae_load", "PI", FOPDT(1, 1, 1.01)), RuleNotApplicable),
        (lambda: tuned("itae_setpoint", "P", FOPDT(1, 1, 0.5)), RuleNotApplicable),
        (lambda: tuned("shinskey", "PI", FOPDT(1, 1, 0.21)), RuleNotApplicable),
        (lambda: tuned("shinskey", "PID", FOPDT(1, 1, 1.01)), RuleNotApplicable),
        (lambda: tuned("amigo", "PI", FOPDT(1, 1, 0)), RuleNotApplicable),
        (lambda: tuned("simc", "PI", FOPDT(1, 1, 0)), RuleNotApplicable),
        (lambda: tuned("simc", "PID", FOPDT(1, 1, 1)), RuleNotApplicable),
        (lambda: tuned("simc", "PID", IPDT(1, 1).to_transfer_function()), RuleNotApplicable),
        (lambda: tuned("simc", "PI", DIPDT(1, 1).to_transfer_function()), RuleNotApplicable),
        (lambda: tuned("cohen_coon", "PI", IPDT(1, 1).to_transfer_function()), RuleNotApplicable),
        (lambda: tuned("ziegler_nichols", "PI", TransferFunction((), (1.0,), 1.0, 0.2)), RuleNotApplicable),
        (lambda: KnownPlant(ultimate=UltimatePoint.of(1, 1)).tune(RULES["amigo"], "PI"), RuleNotApplicable),
        (lambda: tuned("astrom_hagglund_relay", "PID", FOPDT(1, 1, 1), PM_deg=90), InvalidInput),
        (lambda: ziegler_nichols_ultimate(0, 1, "P"), InvalidInput),
        (lambda: ziegler_nichols_ultimate(1, 0, "P"), InvalidInput),
        (lambda: ziegler_nichols_ultimate(1, np.nan, "P"), InvalidInput),
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


def test_an_unstable_plant_is_told_the_gains_that_hold_it() -> None:
    """e^{-0.2 s}/(s - 1): 1 < Kc < sqrt(1 + w^2) with arctan w = 0.2 w, w = 7.16 (written out by hand)."""
    P = TransferFunction((), (1.0,), 1.0, 0.2)
    with pytest.raises(RuleNotApplicable, match=r"Kc between 1 and 7\.23"):
        tuned("ziegler_nichols", "PI", P)
    w = 7.0
    for _ in range(50):
        w = np.arctan(w) / 0.2
    assert round(sqrt(1 + w**2), 2) == 7.23
