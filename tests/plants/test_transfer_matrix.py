"""The ethanol-water column: its entries at any frequency, its steps in closed form, its gains."""

import numpy as np
import pytest

from looplab.engine.errors import InvalidInput
from looplab.engine.nonlinear.inputs import InputCourse
from looplab.engine.response import ramp, step
from looplab.plants import group_of, load_transfer_matrix, plant_ids, transfer_matrix_document, transfer_matrix_ids
from looplab.plants.transfer_matrix import matrix_response

COLUMN = load_transfer_matrix("ethanol-water")


def lag_step(t, K, tau, theta):
    late = np.maximum(t - theta, 0.0)
    return K * (1 - np.exp(-late / tau))


def last_step(t):
    """0.87 (11.6 s + 1)/((3.89 s + 1)(18.8 s + 1)) in partial fractions, a minute late."""
    late, a, b = np.maximum(t - 1, 0.0), 3.89, 18.8
    return 0.87 * (1 + (11.6 - a) / (a - b) * np.exp(-late / a) + (11.6 - b) / (b - a) * np.exp(-late / b))


def test_the_list():
    assert transfer_matrix_ids() == [
        *("ethanol-water", "ogunnaike-ray", "quadruple-tank", "quadruple-tank-crossed"),
        *("vinante-luyben", "wardle-wood", "wood-berry"),
    ]
    assert all(group_of(name) in {"Columns", "Tanks"} for name in transfer_matrix_ids())
    assert not set(transfer_matrix_ids()) & set(plant_ids())
    assert group_of("ethanol-water") == "Columns"
    document = transfer_matrix_document("ethanol-water")
    assert document["kind"] == "transfer-matrix" and "AIChE" in document["source"]
    document["title"] = "changed"
    assert transfer_matrix_document("ethanol-water")["title"] != "changed"


def test_entries():
    s = 1j * np.geomspace(1e-3, 10, 25)
    expected = [
        [0.66 * np.exp(-2.6 * s) / (6.7 * s + 1), -0.0049 * np.exp(-s) / (9.06 * s + 1)],
        [
            -34.7 * np.exp(-9.2 * s) / (8.15 * s + 1),
            0.87 * (11.6 * s + 1) * np.exp(-s) / ((3.89 * s + 1) * (18.8 * s + 1)),
        ],
    ]
    for row, printed in zip(COLUMN.entries, expected, strict=True):
        for entry, values in zip(row, printed, strict=True):
            assert entry.system()(s) == pytest.approx(values, rel=1e-12)


def test_formulas():
    assert COLUMN.entries[0][0].to_latex() == r"\frac{0.66 e^{-2.6 s}}{6.7 s + 1}"
    assert COLUMN.entries[1][1].to_latex() == r"\frac{0.87(11.6 s + 1) e^{-s}}{(3.89 s + 1)(18.8 s + 1)}"


def test_steps_of_both_inputs_add():
    courses = {"u1": InputCourse(0.0).plus(step(0.1, 3.0)), "u2": -2.0}
    found = matrix_response(COLUMN, courses, 80.0, 401)
    t = found.t
    y1 = 0.1 * lag_step(t - 3, 0.66, 6.7, 2.6) - 2 * lag_step(t, -0.0049, 9.06, 1)
    y2 = 0.1 * lag_step(t - 3, -34.7, 8.15, 9.2) - 2 * last_step(t)
    assert found.y == pytest.approx(np.column_stack([y1, y2]), abs=1e-12)
    assert found.u[[0, 14, 15, -1]] == pytest.approx(np.array([[0, -2], [0, -2], [0.1, -2], [0.1, -2]]))


def test_it_rests_at_its_gains():
    for j in range(2):
        found = matrix_response(COLUMN, {f"u{j + 1}": 1.0}, 1000.0, 11)
        assert found.y[-1] == pytest.approx(COLUMN.gains()[:, j], rel=1e-9)
    G = COLUMN.gains()
    assert (G * np.linalg.inv(G).T)[0, 0] == pytest.approx(1.421, abs=5e-4)


def test_what_runs_away_is_cut():
    found = matrix_response(COLUMN, {"u1": InputCourse(0.0).plus(ramp(1e6, 0.0))}, 1000.0, 1001)
    assert found.truncated_at is not None and found.t[-1] < found.truncated_at < 60
    assert found.truncated_reason and np.isfinite(found.y).all() and len(found.y) == len(found.t) == len(found.u)


def test_an_input_that_it_has_not():
    with pytest.raises(InvalidInput) as refused:
        matrix_response(COLUMN, {"R": 1.0}, 10.0, 11)
    assert refused.value.field == "inputs.R"
