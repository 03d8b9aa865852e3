"""Crossovers, margins and sensitivity peaks against root finding at 40 digits; verdicts against a count of turns."""

from typing import Any

import pytest

from looplab.engine.frequency import margins, nyquist_count
from looplab.engine.systems import TransferFunction
from references import cases


def system(case: dict[str, Any]) -> TransferFunction:
    return TransferFunction(
        [complex(*z) for z in case["zeros"]], [complex(*p) for p in case["poles"]], case["gain"], case["theta"]
    )


@pytest.mark.parametrize("case", cases("margins"))
def test_gain_crossovers(case: dict[str, Any]) -> None:
    found = margins(system(case))
    assert [c.omega for c in found.gain_crossovers] == pytest.approx(
        [c["omega"] for c in case["gain_crossovers"]], rel=1e-12
    )
    assert [c.PM_deg for c in found.gain_crossovers] == pytest.approx(
        [c["PM_deg"] for c in case["gain_crossovers"]], abs=1e-9
    )
    if not case["gain_crossovers"]:
        assert found.PM_deg is None
        assert found.omega_c is None
        assert "infinite" in found.reasons["PM_deg"]
    else:
        tightest = min(case["gain_crossovers"], key=lambda c: abs(c["PM_deg"]))
        assert abs(found.PM_deg) == pytest.approx(abs(tightest["PM_deg"]), abs=1e-9)


@pytest.mark.parametrize("case", cases("margins"))
def test_phase_crossovers(case: dict[str, Any]) -> None:
    """The engine leaves out those beyond GM = 20 that dead time adds without end."""
    found = margins(system(case))
    mine = [c for c in found.phase_crossovers if c.omega > 0]
    listed = case["phase_crossovers"]
    if case["phase_crossovers_beyond_the_list"]:
        must = [c for c in listed if c["GM"] < 20]
        assert len(mine) >= len(must)
        mine, listed = mine[: len(listed)], listed[: len(mine)]
    assert [c.omega for c in mine] == pytest.approx([c["omega"] for c in listed], rel=1e-12)
    assert [c.GM for c in mine] == pytest.approx([c["GM"] for c in listed], rel=1e-11)
    nearest = min(listed, key=lambda c: abs(c["GM_dB"]), default=None)
    ends_there = nearest is listed[-1] and len(found.phase_crossovers) > len(listed) if listed else True
    if not ends_there and all(c.omega > 0 for c in found.phase_crossovers):
        assert found.GM == pytest.approx(nearest["GM"], rel=1e-11)
        assert found.GM_dB == pytest.approx(nearest["GM_dB"], abs=1e-9)
        assert found.omega_180 == pytest.approx(nearest["omega"], rel=1e-12)


@pytest.mark.parametrize("case", cases("margins"))
@pytest.mark.parametrize("name", ["Ms", "Mt"])
def test_sensitivity_peaks(case: dict[str, Any], name: str) -> None:
    found, reference = margins(system(case)), case[name]
    assert getattr(found, name) == pytest.approx(reference["value"], rel=1e-10)
    omega = getattr(found, f"omega_{name}")
    if reference["omega"] == "inf":
        assert omega is None
        assert "higher" in found.reasons[f"omega_{name}"]
    elif reference["omega"] is not None:  # None: the same everywhere
        assert omega == pytest.approx(float(reference["omega"]), rel=1e-6, abs=1e-12)


@pytest.mark.parametrize("case", cases("margins"))
def test_verdict_and_delay_margin(case: dict[str, Any]) -> None:
    L = system(case)
    found, count = margins(L), nyquist_count(L)
    assert found.closed_loop_stable == (case["rhp_poles"] == 0)
    assert count.Z == case["rhp_poles"]
    assert count.N + count.P == count.Z
    if case["delay_margin"] is None:
        assert found.delay_margin is None
        assert found.reasons["delay_margin"]
    else:
        assert found.delay_margin == pytest.approx(case["delay_margin"], rel=1e-11)
