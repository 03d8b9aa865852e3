"""Relative gains, pairings and singular values: printed arrays, the definition, and its limits."""

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.loop import PID
from looplab.engine.mimo import (
    MultiLoop,
    niederlinski_index,
    relative_gain_array,
    rga_at_rest,
    rga_number,
    rga_response,
    singular_values,
    study_pairings,
)
from processes import library, matrix

# Skogestad and Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005: sec. 3.4 and 10.6.
LV_COLUMN = [[87.8, -86.4], [108.2, -109.6]]
CRACKER = [[16.8, 30.5, 4.30], [-16.7, 31.0, -1.41], [1.27, 54.1, 5.40]]
THREE = [[10.2, 5.6, 1.4], [15.5, -8.4, -0.7], [18.1, 0.4, 1.8]]


@pytest.mark.parametrize(
    ("K", "printed"),
    [
        (LV_COLUMN, [[35.1, -34.1], [-34.1, 35.1]]),
        (CRACKER, [[1.50, 0.99, -1.48], [-0.41, 0.97, 0.45], [-0.08, -0.95, 2.03]]),
        (THREE, [[0.96, 1.45, -1.41], [0.94, -0.37, 0.43], [-0.90, -0.07, 1.98]]),
    ],
)
def test_arrays_in_print(K, printed):
    found = relative_gain_array(K)
    digits = 1 if abs(printed[0][0]) > 10 else 2
    assert np.array_equal(np.round(found, digits), printed)


@pytest.mark.parametrize(
    ("plant", "printed", "half_a_digit"),
    [
        # The notes' column, not the 0.772 that a misprinted sign gives.
        ("ethanol-water", 1.421, 5e-4),
        # W. L. Luyben, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 654-660, table of processes.
        ("wood-berry", 2.01, 5e-3),
        ("vinante-luyben", 1.63, 5e-3),
        ("wardle-wood", 2.69, 5e-3),
        # K. H. Johansson, IEEE Trans. Control Syst. Technol. 8 (2000) 456-465, from the valves: the printed transfer
        # functions have two digits.
        ("quadruple-tank", 1.4, 0.05),
        ("quadruple-tank-crossed", -0.64, 0.05),
    ],
)
def test_processes_in_print(plant, printed, half_a_digit):
    assert rga_at_rest(library(plant))[0, 0] == pytest.approx(printed, abs=half_a_digit)


def test_the_definition_on_random_matrices():
    rng = np.random.default_rng(3)
    for n in (2, 3, 4, 5):
        K = rng.normal(size=(n, n)) * 10.0 ** rng.uniform(-6, 6, (n, 1))
        Λ = relative_gain_array(K)
        assert Λ.sum(axis=0) == pytest.approx(np.ones(n), abs=1e-9)
        assert Λ.sum(axis=1) == pytest.approx(np.ones(n), abs=1e-9)
        # Gain with all other inputs held, over gain with all other outputs held.
        for i, j in ((0, 0), (n - 1, 1)):
            u = np.linalg.solve(K, np.eye(n)[i])
            assert Λ[i, j] == pytest.approx(K[i, j] * u[j], rel=1e-8)
        assert relative_gain_array(K * rng.uniform(1, 1e4, n)) == pytest.approx(Λ, abs=1e-8)


def test_over_frequency_it_starts_at_rest_and_sums_to_one():
    process = library("ogunnaike-ray")
    omega = np.geomspace(1e-7, 1, 40)
    found = rga_response(process, omega)
    assert found[0] == pytest.approx(rga_at_rest(process), abs=1e-4)
    assert found.sum(axis=2) == pytest.approx(np.ones((40, 3)), abs=1e-10)
    G = process.response(omega)[-1]
    assert found[-1] == pytest.approx(G * np.linalg.inv(G).T, abs=1e-12)
    assert rga_number(found, (0, 1, 2))[-1] == pytest.approx(np.abs(found[-1] - np.eye(3)).sum())


@pytest.mark.parametrize(
    "rows",
    [
        [["1/s", "2/(s+1)"], ["3/(s+1)", "4/(s+2)"]],
        [["1/s", "-2/s"], ["3/(s+1)", "4/(s+2)"]],
        [["1/s", "2/(s+1)"], ["3/s^2", "4/(s (s+2))"]],
        [["s/(s+1)", "2/(s+1)", "1"], ["3", "1/s", "0"], ["1/(s+3)", "5", "2/s"]],
    ],
)
def test_integrators_have_the_limit_of_the_frequency_response(rows):
    process = matrix(rows)
    nearly = rga_response(process, np.array([1e-8]))[0]
    assert rga_at_rest(process) == pytest.approx(nearly, abs=1e-6)


def test_what_has_no_relative_gain_is_refused():
    for rows in ([["1/(s+1)", "2/(s+1)"], ["2/(s+2)", "2/(s+1)"]], [["1/s", "2/s"], ["2/s", "4/s"]]):
        with pytest.raises(InvalidInput, match="singular"):
            rga_at_rest(matrix(rows))
    with pytest.raises(InvalidInput, match="zero"):
        rga_at_rest(matrix([["1/(s+1)", "0"], ["2/(s+1)", "0"]]))


def test_singular_values_in_print():
    # Skogestad and Postlethwaite, 2nd ed., secs. 3.3 and 3.4.
    found = singular_values(np.array([LV_COLUMN]))
    assert found.values[0] == pytest.approx([197.2, 1.39], abs=0.05)
    assert found.condition_number[0] == pytest.approx(141.7, abs=0.05)


def test_the_least_condition_number_is_the_least():
    G = library("wood-berry").response(np.array([0.3]))[0]
    found = singular_values(G[None])
    assert found.minimized is not None
    scale = np.geomspace(0.05, 20, 81)
    numbers = [np.linalg.cond(np.diag([1, a]) @ G @ np.diag([1, b])) for a in scale for b in scale]
    assert found.minimized[0] <= min(numbers) * (1 + 1e-12)
    assert found.minimized[0] == pytest.approx(min(numbers), rel=5e-3)
    assert singular_values(np.eye(3)[None]).minimized is None


def test_pairings_in_print():
    # Johansson: the tanks whose water goes across must be paired across.
    across = study_pairings(library("quadruple-tank-crossed"))
    assert across.recommended is not None and across.recommended.inputs == (1, 0)
    straight = study_pairings(library("wood-berry"))
    assert straight.recommended is not None and straight.recommended.inputs == (0, 1)
    refused = straight.pairings[-1]
    assert not refused.acceptable and any("lambda_12" in fault and "negative" in fault for fault in refused.faults)
    # The only pairing of this plant with positive relative gains everywhere.
    best = study_pairings(matrix([[f"{k}/(s+1)" for k in row] for row in THREE])).recommended
    assert best is not None and best.inputs == (1, 0, 2)
    assert best.niederlinski == pytest.approx(np.linalg.det(np.array(THREE)[:, [1, 0, 2]]) / (5.6 * 15.5 * 1.8))


def test_a_negative_index_is_unstable_however_slow_the_loops_are():
    process = library("wood-berry")
    assert niederlinski_index(process.gains(), (1, 0)) == pytest.approx(1 - (12.8 * 19.4) / (18.9 * 6.6))
    for gain in (1e-3, 1e-5):
        crossed = MultiLoop(process, (1, 0), (PID(-gain, 20.0), PID(gain, 20.0)), (True, True))
        assert crossed.verdict.verdict == "unstable" and crossed.verdict.rhp_poles == 1
        straight = MultiLoop(process, (0, 1), (PID(gain, 20.0), PID(-gain, 20.0)), (True, True))
        assert straight.verdict.closed_loop_stable


def test_where_the_index_says_nothing_there_is_none():
    study = study_pairings(matrix([["1/s", "0.2/(s+1)"], ["0.1/(s+1)", "2/(s+1)"]]))
    assert study.recommended is not None and study.recommended.niederlinski is None
    assert "stable entries" in (study.recommended.niederlinski_reason or "")
