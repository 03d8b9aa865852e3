"""What closing a loop does to another one, decouplers, and settings for several loops."""

import numpy as np
import pytest

from looplab.engine.delays.resolvent import transfer_matrix
from looplab.engine.errors import InvalidInput, RuleNotApplicable
from looplab.engine.loop import PID
from looplab.engine.mimo import (
    Change,
    MultiLoop,
    blt,
    dynamic_decoupler,
    effective_process,
    interaction,
    rga_at_rest,
    simulate_loops,
    static_decoupler,
    tune_alone,
)
from looplab.engine.tuning import RULES, KnownPlant, Options
from processes import library, matrix

OMEGA = np.geomspace(1e-3, 3, 60)
WOOD_BERRY = library("wood-berry")
PI = (PID(0.375, 8.29), PID(-0.075, 23.6))
LOOPS = MultiLoop(WOOD_BERRY, (0, 1), PI, (True, True))


def test_the_effective_process_is_its_formula():
    G = WOOD_BERRY.response(OMEGA)
    C2 = PI[1].to_transfer_function().response(OMEGA)
    formula = G[:, 0, 0] - G[:, 0, 1] * G[:, 1, 0] * C2 / (1 + C2 * G[:, 1, 1])
    found = interaction(LOOPS, 0, OMEGA)
    assert found.effective == pytest.approx(formula, rel=1e-10)
    assert found.own == pytest.approx(G[:, 0, 0], rel=1e-12)
    assert found.effective_gain == pytest.approx(12.8 / found.relative_gain, rel=1e-12)
    assert found.own_gain == pytest.approx(12.8) and found.others.closed_loop_stable


def test_margins_are_where_the_effective_open_loop_says():
    found = interaction(LOOPS, 0, OMEGA)
    assert found.own_margins is not None and found.effective_margins is not None
    seen = effective_process(LOOPS, 0)
    for margins, process in ((found.own_margins, None), (found.effective_margins, seen)):
        omega = np.array([margins.omega_c, margins.omega_180])
        L = transfer_matrix(process, 1j * omega)[:, 0, 0] if process else WOOD_BERRY.entries[0][0].response(omega)
        L = L * PI[0].to_transfer_function().response(omega)
        assert abs(L[0]) == pytest.approx(1, rel=1e-9)
        assert np.degrees(np.angle(-L[0])) == pytest.approx(margins.PM_deg, rel=1e-8)
        assert (-margins.GM * L[1]).real == pytest.approx(1, rel=1e-8)
    # The whole is stable by its own verdict and by that of the loop that is closed last.
    assert found.effective_margins.closed_loop_stable == LOOPS.verdict.closed_loop_stable
    assert found.effective_margins.PM_deg < found.own_margins.PM_deg


def test_three_loops_leave_a_third_its_gain_over_lambda():
    process = library("ogunnaike-ray")
    loops = MultiLoop(process, (0, 1, 2), blt(process).controllers, (True,) * 3)
    for i in range(3):
        at_rest = transfer_matrix(effective_process(loops, i), 0.0)[0, 0, 0].real
        assert at_rest == pytest.approx(process.gains()[i, i] / rga_at_rest(process)[i, i], rel=1e-10)


def test_a_static_decoupler_makes_the_gains_diagonal():
    process = library("ogunnaike-ray")
    found = static_decoupler(process)
    D = np.array([[entry.gain for entry in row] for row in found.matrix])
    assert process.gains() @ D == pytest.approx(np.diag(np.diagonal(process.gains())), abs=1e-10)
    with pytest.raises(InvalidInput, match="integrates"):
        static_decoupler(matrix([["1/s", "1"], ["1", "1/(s+1)"]]))


def test_a_decoupler_that_can_be_built_is_exact():
    found = dynamic_decoupler(WOOD_BERRY)
    assert found.exact and all(not element.problems for element in found.elements)
    loops = MultiLoop(WOOD_BERRY, (0, 1), PI, (True, True), found.matrix)
    answer = simulate_loops(loops, [Change("setpoint", 0, 1.0)], 100.0, 300)
    assert np.abs(answer.y[:, 1]).max() < 1e-10 and np.abs(answer.y[-1, 0] - 1) < 0.01
    # What each loop sees now is g11 - g12 g21/g22, whatever the other does.
    G = WOOD_BERRY.response(OMEGA)
    seen = transfer_matrix(effective_process(loops, 0), 1j * OMEGA)[:, 0, 0]
    assert seen == pytest.approx(G[:, 0, 0] - G[:, 0, 1] * G[:, 1, 0] / G[:, 1, 1], rel=1e-8)


def test_a_prediction_is_named_dropped_or_waited_for():
    process = library("ethanol-water")
    dropped, waited = dynamic_decoupler(process), dynamic_decoupler(process, "wait")
    first = dropped.elements[0]
    assert first.theta == pytest.approx(-1.6) and "1.6" in first.problems[0] and not dropped.exact
    assert first.realised.theta == 0.0 and first.realised.dc_gain == pytest.approx(0.0049 / 0.66)
    assert waited.exact
    G = process.response(OMEGA)
    D = np.stack([[entry.response(OMEGA) for entry in row] for row in waited.matrix]).transpose(2, 0, 1)
    apart = G @ D
    assert np.abs(apart[:, 0, 1] / G[:, 0, 1]).max() < 1e-12 and np.abs(apart[:, 1, 0] / G[:, 1, 0]).max() < 1e-12


def test_what_else_cannot_be_built_is_named():
    process = matrix([["(1-2s)/(3s+1)^2", "1/(5s+1)"], ["1/(2s+1)", "4/(6s+1)^2"]])
    first, second = dynamic_decoupler(process).elements
    assert any("unstable" in problem for problem in first.problems)
    assert first.realised.order == 0 and first.realised.gain == pytest.approx(-1.0)
    assert any("differentiate" in problem for problem in second.problems)
    assert second.realised.is_proper and second.realised.dc_gain == pytest.approx(-0.25)
    with pytest.raises(InvalidInput, match="two loops"):
        dynamic_decoupler(library("ogunnaike-ray"))


@pytest.mark.parametrize(
    ("plant", "gains", "times"),
    [
        # W. L. Luyben, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 654-660, table of BLT settings.
        ("wood-berry", (0.375, -0.075), (8.29, 23.6)),
        ("vinante-luyben", (-1.07, 1.97), (7.1, 2.58)),
        ("wardle-wood", (27.4, -13.3), (41.4, 52.9)),
    ],
)
def test_blt_settings_in_print(plant, gains, times):
    found = blt(library(plant))
    assert [c.Kc for c in found.controllers] == pytest.approx(gains, rel=8e-3)
    assert [c.tau_I for c in found.controllers] == pytest.approx(times, rel=5e-3)
    # And by the definition: the peak is 2n dB, and nothing is above it.
    G = library(plant).response(np.geomspace(1e-3, 10, 4000))
    C = np.stack([c.to_transfer_function().response(np.geomspace(1e-3, 10, 4000)) for c in found.controllers], axis=1)
    whole = np.linalg.det(np.eye(2) + G * C[:, None, :])
    assert (20 * np.log10(np.abs((whole - 1) / whole))).max() == pytest.approx(4.0, abs=1e-3)


def test_blt_says_where_it_cannot():
    with pytest.raises(RuleNotApplicable, match="loop 1"):
        blt(library("quadruple-tank"))
    with pytest.raises(RuleNotApplicable, match="pairing"):
        blt(WOOD_BERRY.paired((1, 0)))
    with pytest.raises(RuleNotApplicable, match="stable"):
        blt(matrix([["exp(-s)/s", "1"], ["1", "exp(-s)/(s+1)"]]))


def test_each_loop_alone_by_a_rule():
    first, second = tune_alone(WOOD_BERRY, "simc", "PI", Options())
    expected = KnownPlant.of(WOOD_BERRY.entries[1][1]).tune(RULES["simc"], "PI")
    assert second.controller is not None and second.controller.Kc == expected.Kc < 0
    assert first.controller is not None and first.controller.tau_I == pytest.approx(8.0)
    assert tune_alone(library("quadruple-tank"), "simc", "PI", Options())[0].reason is not None
