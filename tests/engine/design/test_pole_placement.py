"""Pole placement: the equation in exact arithmetic, the worked example, and what is refused with which words."""

from fractions import Fraction

import numpy as np
import pytest

from looplab.engine.design import pade, pid_form, pole_placement, sylvester_matrix
from looplab.engine.design.pole_placement import required_degree
from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID, FeedbackLoop
from looplab.engine.systems import TransferFunction, parse_transfer_function

S = TransferFunction(zeros=[0.0])
NOTES = parse_transfer_function("2/((s+1)(s+2))")
D = parse_transfer_function("(s^2+5s+16)(s+40)").zeros


def product(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


def exact(coefficients) -> list[Fraction]:
    return [Fraction(float(c)) for c in coefficients]


def backward_error(plant: TransferFunction, L, P, D) -> Fraction:
    """|A L + B P - D| over |A| |L| + |B| |P| + |D|, coefficient by coefficient, without rounding."""

    def aligned(terms: list[Fraction]) -> list[Fraction]:
        return [Fraction(0)] * (len(D) - len(terms)) + terms

    AL, BP = product(exact(plant.den), exact(L)), product(exact(plant.num), exact(P))
    sizes = [
        product([abs(v) for v in exact(a)], [abs(v) for v in exact(b)]) for a, b in ((plant.den, L), (plant.num, P))
    ]
    worst = Fraction(0)
    for al, bp, d, x, y in zip(*map(aligned, (AL, BP, exact(D), *sizes)), strict=True):
        if x + y + abs(d):
            worst = max(worst, abs(al + bp - d) / (x + y + abs(d)))
    return worst


def test_the_example_of_the_notes():
    found = pole_placement(NOTES, D)
    np.testing.assert_allclose(found.P / found.L[0], [44, 278], rtol=1e-14)
    np.testing.assert_allclose(found.L / found.L[0], [1, 42], rtol=1e-14)
    assert found.static_gain == pytest.approx(556 / 640, rel=1e-14)
    assert found.reference_gain == pytest.approx(640 / 556, rel=1e-14)
    assert found.residual < 1e-15
    assert found.pole_error < 1e-13
    assert found.controller_verdict.closed_loop_stable
    assert found.verdict.verdict == "stable"
    # A lead is a PD with a filter; a PID it is not: nothing in it integrates.
    assert found.pid.controller.type == "PD"


def test_what_the_printed_answer_is_exact_for():
    """3(s+41)/(49s+517) upside down solves the same D for 3/((s+1)(s+3)); as printed it places other poles."""
    other = pole_placement(parse_transfer_function("3/((s+1)(s+3))"), D)
    np.testing.assert_allclose(3 * other.P / other.L[0], [49, 517], rtol=1e-13)
    np.testing.assert_allclose(other.L / other.L[0], [1, 41], rtol=1e-13)
    printed = parse_transfer_function("3(s+41)/(49s+517)")
    poles = np.roots(np.polyadd(np.convolve(NOTES.den, printed.den), np.convolve(NOTES.num, printed.num)))
    np.testing.assert_allclose(sorted(poles.real), [-10.60, -1.48, -1.48], atol=0.005)


def random_roots(rng, count: int) -> list[complex]:
    out: list[complex] = []
    while len(out) < count:
        size = 10 ** rng.uniform(-1, 1)
        if count - len(out) > 1 and rng.random() < 0.5:
            angle = rng.uniform(0.2, 3.0)
            out += [size * np.exp(1j * angle), size * np.exp(-1j * angle)]
        else:
            out.append(size * rng.choice([-1.0, 1.0]))
    return out


def test_two_hundred_random_problems_satisfy_the_equation():
    rng = np.random.default_rng(21)
    worst = Fraction(0)
    for _ in range(200):
        n = int(rng.integers(1, 6))
        plant = TransferFunction(
            random_roots(rng, int(rng.integers(0, n + 1))), random_roots(rng, n), rng.uniform(0.1, 5)
        )
        factor = S if rng.random() < 0.5 and plant.zeros.size < n else TransferFunction()
        structure = rng.choice(["biproper", "strictly_proper"])
        count = required_degree(plant, factor, structure) + int(rng.integers(0, 2))
        wanted = -np.abs(np.real(random_roots(rng, count))) - 0.1
        found = pole_placement(plant, wanted, factor, structure)
        worst = max(worst, backward_error(plant, found.L, found.P, np.poly(wanted)))
        assert found.C.is_proper
        assert structure == "biproper" or found.C.relative_degree >= 1
        assert np.count_nonzero(found.C.poles == 0) == factor.zeros.size
        assert found.static_gain == pytest.approx(1.0, abs=1e-12) or not factor.zeros.size
    assert worst <= Fraction(1, 10**10)


def test_an_integrator_makes_the_offset_zero_and_a_pid_of_a_second_order_plant():
    found = pole_placement(NOTES, np.append(D, -30.0), S)
    assert found.static_gain == 1.0
    assert 0 in found.C.poles
    C = found.pid.controller
    assert C.type == "PID"
    s = np.array([0.3 + 1j, 5j, 40.0])
    np.testing.assert_allclose(C.to_transfer_function()(s), found.C(s), rtol=1e-11)


def test_any_factor_can_be_imposed_on_the_controller():
    """Poles at +-2j in the controller: a load sin 2t leaves nothing in y, for T(2j) = 1."""
    found = pole_placement(NOTES, np.array([-3, -4, -5, -6, -7]), TransferFunction(zeros=[2j, -2j]))
    L = found.C * NOTES
    near = L(2j * (1 + 1e-9))
    assert abs(near / (1 + near) - 1) < 1e-6
    assert found.pid.reason


@pytest.mark.parametrize(
    ("plant", "poles", "words"),
    [
        ("(s+2)/((s+1)(s+2))", [-3, -4, -2], "share the root -2"),
        ("(s^2+2s+5)/((s^2+2s+5)(s+1))", [-3.0] * 5, "-1 ± 2j"),
        ("(s-1)/((s-1)(s+3))", [-3.0, -4, -5], "share the root 1"),
    ],
)
def test_a_shared_root_is_named(plant, poles, words):
    with pytest.raises(InvalidInput, match=words.replace("±", ".")) as caught:
        pole_placement(parse_transfer_function(plant), np.array(poles))
    hint = caught.value.hint or ""
    assert ("cancel it first. Design for 1/(s + 1)" in hint) == (-2 in poles)
    assert ("not stable" in hint) == ("s-1" in plant)


def test_an_integrator_on_a_zero_at_the_origin_is_refused():
    with pytest.raises(InvalidInput, match="zero at 0") as caught:
        pole_placement(parse_transfer_function("s/((s+1)(s+2))"), np.array([-3, -4, -5, -6.0]), S)
    assert caught.value.field == "L_factor"


def test_the_degree_that_fits_is_said():
    with pytest.raises(InvalidInput, match=r"2 poles are given, and this plant needs 4 of them \(2.2 \+ 1 - 1\)"):
        pole_placement(NOTES, np.array([-1.0, -2.0]), S)


def test_nearly_cancelling_roots_and_many_equal_poles_are_placed_as_well_as_numbers_allow():
    near = pole_placement(parse_transfer_function("(s+1.0000001)/((s+1)(s+2))"), np.array([-3.0, -4, -6]))
    assert near.condition > 1e7
    assert near.pole_error < 1e-6
    equal = pole_placement(parse_transfer_function("1/(s+1)^3"), np.full(5, -2.0))
    # Five equal roots answer a change of eps by eps^(1/5).
    assert 1e-6 < equal.pole_error < 0.02
    with pytest.raises(InvalidInput, match="too far apart"):
        pole_placement(parse_transfer_function("1e-6/((1e6s+1)(1e-6s+1))"), np.array([-1e3, -1.0, -1.0]))
    with pytest.raises(InvalidInput, match="mere gain"):
        pole_placement(parse_transfer_function("5"), np.array([]))


def test_a_dead_time_is_approximated_only_where_asked():
    plant = parse_transfer_function("exp(-0.3s)/(s+1)")
    with pytest.raises(InvalidInput, match="dead time") as caught:
        pole_placement(plant, np.array([-2.0]))
    assert "Smith" in (caught.value.hint or "")
    found = pole_placement(plant, np.array([-2.0, -3, -4, -5, -6]), pade_order=2)
    assert found.design_plant.theta == 0
    assert found.verdict.closed_loop_stable
    # Order n meets the exponential to the power 2n: error (2n)!^-1-like, from the definition.
    s = 0.2j
    assert abs(pade(0.3, 3)(s) - np.exp(-0.3 * s)) < 1e-10


def test_sylvester_is_singular_exactly_for_a_shared_root():
    shared = sylvester_matrix(np.poly([-1, -2]), np.poly([-2.0]), 1, 1, 3)
    apart = sylvester_matrix(np.poly([-1, -2]), np.poly([-3.0]), 1, 1, 3)
    # Its determinant is the resultant: prod B(roots of A), here (-1 + 3)(-2 + 3).
    assert abs(np.linalg.det(shared)) < 1e-14
    assert abs(np.linalg.det(apart)) == pytest.approx(2.0)


@pytest.mark.parametrize("C", [PID(2.0, 3.0, 0.7, 0.2), PID(-2.0, 3.0), PID(4.0), PID(2.0, None, 0.4, 0.05)])
def test_a_pid_is_recognised(C):
    found = pid_form(C.to_transfer_function()).controller
    assert found.type == C.type
    for name in ("Kc", "tau_I", "tau_D"):
        assert (getattr(found, name) or 0.0) == pytest.approx(getattr(C, name) or 0.0, rel=1e-12)


def test_a_loop_with_the_controller_has_the_poles():
    """The definition, by numpy's own polynomials on an unstable plant with a zero in the right half-plane."""
    plant = parse_transfer_function("(s-3)/((s-1)(s+2))")
    found = pole_placement(plant, np.array([-1, -2 + 1j, -2 - 1j, -5.0]), S)
    loop = FeedbackLoop(plant, found.C)
    d = np.polyadd(np.convolve(loop.plant.den, loop.C.den), np.convolve(loop.plant.num, loop.C.num))
    np.testing.assert_allclose(sorted(np.roots(d).real), [-5, -2, -2, -1], rtol=1e-9)
    assert not found.controller_verdict.closed_loop_stable
