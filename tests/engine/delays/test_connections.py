"""Connections against the algebra of complex numbers, and conversions there and back."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from looplab.engine.delays import (
    Block,
    DelaySystem,
    append,
    connect,
    control_loop,
    feedback,
    frequency_response,
    in_feedback,
    in_parallel,
    in_series,
    minimal_delay_system,
    parallel,
    series,
    single_transfer_function,
    smith_predictor,
    summing,
)
from looplab.engine.delays.resolvent import transfer_and_slope
from looplab.engine.delays.structure import channel, pruned
from looplab.engine.errors import IllPosedLoop, InvalidInput
from looplab.engine.state_space import StateSpaceModel
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems

OMEGA = np.logspace(-2, 2, 60)
S = 1j * OMEGA
parts = systems(order=(1, 3), excess=0, theta=True) | systems(order=(1, 3), excess=1)
made = DelaySystem.from_transfer_function


def response(system: DelaySystem) -> np.ndarray:
    return frequency_response(system, OMEGA)[:, 0, 0]


def close(found: np.ndarray, expected: np.ndarray, rtol: float = 1e-9) -> None:
    np.testing.assert_allclose(found, expected, rtol=rtol, atol=rtol * float(np.abs(expected).max()))


@effort(40)
@given(parts, parts, parts)
def test_series_parallel_and_feedback_are_product_sum_and_quotient(
    F: TransferFunction, G: TransferFunction, H: TransferFunction
) -> None:
    f, g, h = (system(S) for system in (F, G, H))
    a, b, c = made(F), made(G), made(H)
    close(response(series(a, b)), f * g)
    close(response(parallel(a, b, -1.0)), f - g)
    assume(np.abs(1 + f * g).min() > 1e-3)
    try:
        loop = feedback(a, b)
    except IllPosedLoop:
        assume(False)
    close(response(loop), f / (1 + f * g), 1e-8)
    # What is connected can be connected again.
    close(response(series(parallel(loop, c), c)), (f / (1 + f * g) + h) * h, 1e-8)


def test_the_slope_is_the_derivative() -> None:
    loop = feedback(made(parse_transfer_function("2 exp(-0.7s)/(s+1)")), made(parse_transfer_function("exp(-0.4s)")))
    s = np.array([0.3 + 0.8j, 2.0j, 1.0 - 0.5j])
    value, slope = transfer_and_slope(loop, s)
    P, dP = 2 * np.exp(-0.7 * s) / (s + 1), -2 * np.exp(-0.7 * s) * (0.7 * (s + 1) + 1) / (s + 1) ** 2
    h = np.exp(-0.4 * s)
    close(value[:, 0, 0], P / (1 + P * h), 1e-12)
    close(slope[:, 0, 0], (dP + 0.4 * P * P * h) / (1 + P * h) ** 2, 1e-12)


def test_a_junction_and_wires_make_the_same_loop() -> None:
    """r - y_m by a summing junction and wires, against feedback()."""
    P, H = parse_transfer_function("exp(-s)/(s+1)"), parse_transfer_function("0.5 exp(-0.3s)/(0.2s+1)")
    all_of_it = append(summing([1, -1]), made(P), made(H))
    wires = np.zeros((4, 3))
    wires[1, 2] = wires[2, 0] = wires[3, 1] = 1.0
    loop = connect(all_of_it, wires, [[1], [0], [0], [0]], [[0, 1, 0]])
    close(response(loop), response(feedback(made(P), made(H))), 1e-12)


@given(st.floats(-5, 5))
@effort(20)
def test_an_algebraic_loop_of_gain_one_has_no_solution(gain: float) -> None:
    assume(abs(gain) > 0.1)
    G = made(TransferFunction((), (), gain))
    with pytest.raises(IllPosedLoop):
        feedback(G, made(TransferFunction((), (), -1 / gain)))
    # Behind a dead time it has one: the loop is no longer algebraic.
    assert feedback(G, made(TransferFunction((), (), -1 / gain, 0.1))).tau.tolist() == [0.1]


def test_several_channels_keep_their_shapes() -> None:
    model = StateSpaceModel([[0, 1], [-2, -3]], [[0, 1], [1, 0]], [[1, 0]], [[0, 0.5]])
    system = DelaySystem.from_state_space(model, 0.4)
    assert (system.inputs, system.outputs, system.tau.tolist()) == (2, 1, [0.4, 0.4])
    expected = [model(s) * np.exp(-0.4 * s) for s in S[:5]]
    np.testing.assert_allclose(frequency_response(system, OMEGA[:5]), expected, rtol=1e-12)
    with pytest.raises(InvalidInput, match="2 to 1"):
        series(system, system)
    with pytest.raises(InvalidInput):
        system.rational()
    assert DelaySystem.from_state_space(model).rational() == model


@effort(25)
@given(systems(order=(1, 4), excess=0, theta=True))
def test_a_transfer_function_comes_back_as_it_was(G: TransferFunction) -> None:
    back = single_transfer_function(made(G))
    assert back.theta == pytest.approx(G.theta, rel=1e-14)
    close(back(S), G(S), 1e-8)


def test_delays_along_a_chain_add_up_to_one() -> None:
    chain = series(made(parse_transfer_function("2 exp(-s)/(s+1)")), made(parse_transfer_function("3 exp(-2s)/(s+4)")))
    found = single_transfer_function(chain)
    assert found.theta == pytest.approx(3.0)
    assert sorted(found.poles.real) == pytest.approx([-4, -1])
    assert found.gain == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("system", "why"),
    [
        (feedback(made(parse_transfer_function("exp(-s)/(s+1)"))), "in a loop"),
        (parallel(made(parse_transfer_function("1")), made(parse_transfer_function("exp(-s)"))), "2 terms"),
    ],
)
def test_what_is_no_single_transfer_function_says_so(system: DelaySystem, why: str) -> None:
    with pytest.raises(InvalidInput, match=why):
        single_transfer_function(system)


def test_blocks_stay_transfer_functions_as_long_as_they_are() -> None:
    block = {
        text: Block.of(parse_transfer_function(text))
        for text in ("2/(s+1)", "1/(s+3)", "exp(-s)/(s+2)", "4 exp(-s)/(s+5)", "exp(-2s)")
    }
    chain = in_series([block["2/(s+1)"], block["exp(-s)/(s+2)"], block["exp(-2s)"]])
    assert chain.transfer_function is not None
    assert chain.transfer_function.theta == 3.0
    assert chain.system.tau.tolist() == [3.0], "one dead time, not two"
    # (s+5)/((s+2)(s+5)) + 4 (s+2)/...: 5 (s + 13/5)/((s+2)(s+5)) e^{-s}
    total = in_parallel([block["exp(-s)/(s+2)"], block["4 exp(-s)/(s+5)"]])
    assert total.transfer_function is not None
    assert total.transfer_function.zeros.real == pytest.approx([-13 / 5])
    assert total.transfer_function.gain == pytest.approx(5.0)
    close(response(total.system), total.transfer_function(S), 1e-10)
    # 2/(s+1) under 1/(s+3): 2 (s+3)/(s^2 + 4s + 5)
    loop = in_feedback(block["2/(s+1)"], block["1/(s+3)"])
    assert loop.transfer_function is not None
    assert sorted(loop.transfer_function.poles.imag) == pytest.approx([-1, 1])
    assert loop.transfer_function.zeros.real == pytest.approx([-3])
    for no, why in (
        (in_parallel([block["2/(s+1)"], block["exp(-2s)"]]), "different dead times"),
        (in_feedback(block["exp(-s)/(s+2)"]), "in a loop"),
        (in_series([in_feedback(block["exp(-s)/(s+2)"]), block["exp(-2s)"]]), "in a loop"),
    ):
        assert no.transfer_function is None
        assert why in (no.reason or "")


def test_the_minimal_form_says_what_it_took_out() -> None:
    """The zero of C = 2 (s+1)/s meets the pole of the model at -1: one hidden mode, none of the dead times."""
    model = parse_transfer_function("exp(-s)/(s+1)")
    predictor = smith_predictor(parse_transfer_function("2 (s+1)/s"), model)
    found = minimal_delay_system(predictor)
    assert (predictor.order, found.system.order) == (2, 1)
    assert [m.pole.real for m in found.removed] == pytest.approx([-1.0])
    assert found.removed_delays == ()
    assert found.tolerance == 1e-10
    assert found.smallest_kept is not None
    assert found.largest_removed is not None
    assert found.largest_removed < 1e-14 < 1e-3 < found.smallest_kept
    close(response(found.system), response(predictor), 1e-12)


def test_a_delay_that_nothing_shows_is_taken_out() -> None:
    idle = connect(append(made(parse_transfer_function("1/(s+1)")), made(parse_transfer_function("exp(-3s)/(s+2)"))),
                   np.zeros((2, 2)), [[1.0], [1.0]], [[1.0, 0.0]])  # fmt: skip
    found = minimal_delay_system(idle)
    assert found.removed_delays == (3.0,)
    assert [m.pole.real for m in found.removed] == pytest.approx([-2.0])
    assert [m.hidden_from for m in found.removed] == ["output"]


def test_the_smith_predictor_is_its_formula() -> None:
    C, G = parse_transfer_function("2 (s+1)/s"), parse_transfer_function("1.3 exp(-0.8s)/(2s+1)")
    P = parse_transfer_function("1.1 exp(-0.9s)/(1.5s+1)")
    predictor = smith_predictor(C, G)
    c, g0, g = C(S), G.without_dead_time()(S), G(S)
    expected = c / (1 + c * (g0 - g))
    close(response(predictor), expected, 1e-11)
    loop = frequency_response(control_loop(made(P), predictor), OMEGA)
    L = P(S) * expected
    close(loop[:, 0, 0], L / (1 + L), 1e-10)
    close(loop[:, 0, 1], P(S) / (1 + L), 1e-10)
    close(loop[:, 1, 0], expected / (1 + L), 1e-10)


def test_malformed_systems_are_refused() -> None:
    for arrays in (
        ([[0.0]], [[1.0, 2.0]], [[1.0]], [[0.0]], []),
        ([[0.0]], [[1.0]], [[1.0]], [[0.0]], [1.0]),
        ([[0.0]], [[1.0, 1.0]], [[1.0], [1.0]], np.zeros((2, 2)), [-1.0]),
        ([[np.inf]], [[1.0]], [[1.0]], [[0.0]], []),
    ):
        with pytest.raises(InvalidInput):
            DelaySystem(*(np.array(a, dtype=float) for a in arrays))
    with pytest.raises(InvalidInput):
        append()


def test_pruning_takes_out_what_is_idle_and_rounds_nothing():
    lag, late = (
        DelaySystem.from_transfer_function(parse_transfer_function(text)) for text in ("2/(3s+1)", "exp(-s)/(s+2)^2")
    )
    idle = DelaySystem.from_transfer_function(parse_transfer_function("exp(-5s)/s"))
    whole = append(lag, late, idle)
    one = channel(whole, [1], [1])
    assert one == late
    # In a loop each needs the other: nothing may go.
    loop = connect(append(lag, late), [[0, -1], [1, 0]], [[1], [0]], [[0, 1]])
    assert pruned(loop) == loop
