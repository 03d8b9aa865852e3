"""The text parser: a text means what it says, round trips keep the system, hostile text is refused in order."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from looplab.engine.errors import EngineError
from looplab.engine.systems import TransferFunction, parse_transfer_function
from strategies import effort, systems

S = np.array([0.3 + 0.7j, -0.45 + 1.3j, 2.1 - 0.2j])


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("(s+3)/(s^2*(s+2)) exp(-0.1 s)", lambda s: (s + 3) / (s**2 * (s + 2)) * np.exp(-0.1 * s)),
        ("1/(s+1)^3", lambda s: 1 / (s + 1) ** 3),
        ("2 s (s+1)/((s+2)(s+3))", lambda s: 2 * s * (s + 1) / ((s + 2) * (s + 3))),
        ("3(1-2s)/((5s+1)(10s+1))", lambda s: 3 * (1 - 2 * s) / ((5 * s + 1) * (10 * s + 1))),
        ("e^(-0.5 s)/(2 s + 1)", lambda s: np.exp(-0.5 * s) / (2 * s + 1)),
        ("1/(s^2 + 2 s + 10) + 1/(s + 1)", lambda s: 1 / (s**2 + 2 * s + 10) + 1 / (s + 1)),
        ("-s^2/(s+1)^4", lambda s: -(s**2) / (s + 1) ** 4),
        ("(s+1)^-2", lambda s: (s + 1) ** -2),
        ("2**3/(s+1)", lambda s: 8 / (s + 1)),
        ("1 - 1/(s+1)", lambda s: s / (s + 1)),
        ("1.5e-2/(1e1 s + .5)", lambda s: 0.015 / (10 * s + 0.5)),
        ("--1/(s+1)", lambda s: 1 / (s + 1)),
        ("[2 {s + 1}]/(s + 2)^2", lambda s: 2 * (s + 1) / (s + 2) ** 2),
        ("pi/(s+1)", lambda s: np.pi / (s + 1)),
        ("1/s/(s+1)", lambda s: 1 / s / (s + 1)),
        ("exp(-s) exp(-0.5 s)/(s+1)", lambda s: np.exp(-1.5 * s) / (s + 1)),
        ("exp(-s)^2/(s+1)", lambda s: np.exp(-2 * s) / (s + 1)),
        ("(1/(s+1))^2/(1/(s+3))", lambda s: (s + 3) / (s + 1) ** 2),
        (
            "4.8*(1 + 1/(1.81 s) + 0.45 s/(0.045 s + 1))",
            lambda s: 4.8 * (1 + 1 / (1.81 * s) + 0.45 * s / (0.045 * s + 1)),
        ),
        ("7", lambda s: 7 + 0 * s),
        ("  1 / ( s + 1 )  ", lambda s: 1 / (s + 1)),
        ("1/(s²+3·s+2)", lambda s: 1 / (s**2 + 3 * s + 2)),
    ],
)
def test_a_text_means_what_it_says(text: str, value) -> None:
    np.testing.assert_allclose(parse_transfer_function(text)(S), value(S), rtol=1e-12)


def test_factors_stay_factors() -> None:
    G = parse_transfer_function("(s+3)/((s+1)^10 (s+1.001)^2)")
    assert np.count_nonzero(G.poles == -1) == 10
    assert np.count_nonzero(G.poles == -1.001) == 2
    assert G.zeros.tolist() == [-3]


def test_a_common_denominator_is_not_squared() -> None:
    G = parse_transfer_function("1/(s+1) + 2/(s+1)")
    assert G.order == 1


def test_differences_cancel_exactly() -> None:
    assert parse_transfer_function("1/(s+1) - 1/(s+1)").gain == 0
    assert parse_transfer_function("1 - 1/(s+1)").zeros.tolist() == [0]


@effort(80)
@given(systems(order=(1, 5), stable=False, axis=True, theta=True, excess=0) | systems(order=(1, 6), stable=False))
def test_text_reads_back_as_the_same_system(G: TransferFunction) -> None:
    back = parse_transfer_function(G.to_text(digits=17))
    assert back.theta == pytest.approx(G.theta, rel=1e-15)
    assert (back.order, back.zeros.size) == (G.order, G.zeros.size)
    np.testing.assert_allclose(back(S), G(S), rtol=1e-10)


@effort(60)
@given(systems(order=(1, 4), stable=False, axis=True, theta=True, excess=0))
def test_six_digits_are_six_digits(G: TransferFunction) -> None:
    s = 3.0 + 20j  # away from the roots, where rounding them matters little
    back = parse_transfer_function(G.to_text())
    assert back(s) == pytest.approx(G(s), rel=2e-4, abs=1e-30)


TOKENS = [
    "s",
    "1",
    "0",
    "2.5",
    "1e5",
    "9e99",
    ".",
    "+",
    "-",
    "*",
    "/",
    "^",
    "**",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "exp",
    "e",
    "pi",
    "x",
    " ",
    "s2",
    ",",
    "exp(-s)",
    "(s+1)",
    "\n",
    "½",
    "∞",
    "NaN",
    "__import__",
    "'",
    "\0",
    "\ud800",
    "s^9",
]


@effort(400)
@given(st.lists(st.sampled_from(TOKENS), max_size=25).map("".join) | st.text(max_size=30))
@example("(" * 200 + "s" + ")" * 200)
@example("-" * 499 + "s")
@example("((((((((((s+1)^9)^9)^9)^9)^9)^9)^9)^9)^9)^9")
@example("9^9^9^9")
@example("(9^50)^50")
@example("1e308*1e308")
@example("1/1e-308/1e-308")
@example("(s+1)^99999999999999999999")
@example("s^-1e300")
@example("exp(-1e999 s)")
@example("exp(exp(-s))")
@example("exp(1000)")
@example("1/(1e-320 s+1)")
@example("0/0")
@example("0^-1")
@example("exp(-s)+1")
@example("s" * 500)
@example("1/(" + "s+" * 240 + "1)")
def test_hostile_text_gives_a_system_or_an_error_with_a_column(text: str) -> None:
    try:
        G = parse_transfer_function(text)
    except EngineError as error:
        assert error.message
        column = getattr(error, "column", None)
        assert column is None or 1 <= column <= len(text) + 1
    else:
        assert np.isfinite(G.gain)
        assert np.isfinite(G.poles).all()
        assert np.isfinite(G.zeros).all()
        assert G.theta >= 0
        assert max(G.order, G.zeros.size) <= 50
