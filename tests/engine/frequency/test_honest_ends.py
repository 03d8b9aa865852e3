"""Where a list is cut or a peak lies at an end of the frequency axis, the answer says so."""

import pytest

from looplab.engine.frequency import margins
from looplab.engine.systems import parse_transfer_function


@pytest.mark.parametrize("text", ["4 exp(-0.1s)/(0.5s+1)", "0.5 exp(-s)"])
def test_crossovers_of_dead_time_tell_where_their_list_ends(text: str) -> None:
    result = margins(parse_transfer_function(text))
    said = result.reasons["phase_crossovers"]
    assert "infinitely many" in said
    end = float(said.rsplit("= ", 1)[1])
    assert max(c.omega for c in result.phase_crossovers) <= end * 1.001


def test_a_whole_list_needs_no_words() -> None:
    assert "phase_crossovers" not in margins(parse_transfer_function("4/(s+1)^3")).reasons


@pytest.mark.parametrize(
    ("text", "Ms", "omega_Ms", "Mt", "omega_Mt"),
    [
        # S = (s+1)/(3s+1): largest, 1, at rest; T = 2s/(3s+1) tends to 2/3
        ("2s/(s+1)", 1.0, 0.0, 2 / 3, None),
        # S = 1/9, T = 8/9 at every frequency
        ("8", 1 / 9, None, 8 / 9, None),
        # S = s/(s+1) tends to 1; T = 1/(s+1) is 1 at rest
        ("1/s", 1.0, None, 1.0, 0.0),
    ],
)
def test_peaks_at_the_ends(text: str, Ms: float, omega_Ms: float | None, Mt: float, omega_Mt: float | None) -> None:
    result = margins(parse_transfer_function(text))
    assert result.Ms == pytest.approx(Ms, rel=1e-9)
    assert result.Mt == pytest.approx(Mt, rel=1e-9)
    assert (result.omega_Ms, result.omega_Mt) == (omega_Ms, omega_Mt)
