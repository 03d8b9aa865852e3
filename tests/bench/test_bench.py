"""The benchmark compares like with like, writes its figures, and its exact reference is the tests' own."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from looplab.bench import accuracy, column, loci, moves, nonlinear_loops, ours, peer, saturated
from looplab.bench.nonlinear_scenarios import SCENARIOS, ControlScenario
from looplab.bench.scenarios import DELAY_FREE
from looplab.cli import app
from references import reference


def walk(value: Any) -> list[float]:
    if isinstance(value, dict):
        return [n for v in value.values() for n in walk(v)]
    if isinstance(value, list):
        return [n for v in value for n in walk(v)]
    return [value] if isinstance(value, float) else []


@pytest.mark.slow
def test_a_quick_run_writes_finite_figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Shorter nonlinear loops than the benchmark's: python-control takes seconds for each."""
    monkeypatch.setattr(nonlinear_loops, "SCENARIOS", tuple(replace(s, samples=60) for s in SCENARIOS))
    out = tmp_path / "bench.json"
    result = CliRunner().invoke(app, ["bench", "--quick", "--no-server", "--out", str(out)])
    assert result.exit_code == 0, result.output
    figures = json.loads(out.read_text())
    assert all(math.isfinite(n) for n in walk(figures))
    assert {r["what"] for r in figures["moves"]} >= {move.name for move in moves.MOVES}
    assert {r["way"] for r in figures["moves"]} == {*moves.WAYS, ""}
    assert "gain move, with locus" in result.output
    for r in figures["moves"]:
        assert r["ratio"] > 0
    for r in figures["control"]:
        # The reactor is unstable: what the solvers leave grows until the controller has it.
        assert r["difference"] < 1e-2
        assert r["ratio"] > 0
    for r in figures["accuracy"]:
        assert max(r["errors"]["looplab"].values()) < 1e-10
        assert max(r["errors"]["python-control, Pade 5"].values()) > 1e-4


@pytest.mark.parametrize("polynomials", [False, True])
def test_both_do_the_same_work_without_dead_time(polynomials: bool) -> None:
    a = ours.Ours(DELAY_FREE).move(3.0, True)
    b = peer.Peer(DELAY_FREE, polynomials=polynomials).move(3.0, True)
    y, u = b["step"]
    assert a["step"].t == pytest.approx(np.linspace(0, 30, 500))
    for i, side in enumerate((a["step"].setpoint, a["step"].load)):
        np.testing.assert_allclose(side.y, y[i], atol=1e-9)
        np.testing.assert_allclose(side.u, u[i], atol=1e-8)
    GM, PM, _, w180, wc, _ = b["margins"][0]
    m = a["margins"]
    assert m.GM == pytest.approx(min(GM, key=lambda g: abs(math.log(g))), rel=1e-6)
    assert m.PM_deg == pytest.approx(PM[0], abs=1e-5)
    assert m.omega_180 == pytest.approx(w180[-1], rel=1e-6)
    assert m.omega_c == pytest.approx(wc[0], rel=1e-6)
    assert m.Ms == pytest.approx(b["margins"][1], rel=1e-3)
    for mine, (magnitude, phase) in zip(a["bode"], b["bode"], strict=True):
        np.testing.assert_allclose(mine.mag_dB, magnitude, atol=1e-8)
        turn = (mine.phase_deg - phase) / 360
        np.testing.assert_allclose(turn, np.round(turn), atol=1e-8)
    assert a["nyquist"][1].N == b["nyquist"].count
    np.testing.assert_allclose(
        np.sort_complex(np.round(a["poles"].poles, 6)), np.sort_complex(np.round(b["poles"], 6)), atol=2e-6
    )
    assert a["root_locus"].branches.shape[0] == b["root_locus"].loci.shape[1]


@pytest.mark.parametrize("locus", loci.LOCI, ids=lambda locus: locus.name)
def test_both_draw_the_locus_of_one_system(locus: loci.Locus) -> None:
    """Where python-control's branches pass, the gain of looplab's open loop is the one it was drawn for."""
    mine, other = locus.ours(1.0), locus.peer(1.0)
    given = np.sort_complex(np.array(locus.poles))
    np.testing.assert_allclose(np.sort_complex(mine.open_loop_poles), given, atol=1e-12)
    size = max(mine.view[1][1], -mine.view[0][0])
    K, s = (values.ravel() for values in np.broadcast_arrays(other.gains[:, None], other.loci))
    roots = np.array([*locus.zeros, *locus.poles])
    apart = np.abs(s[:, None] - roots).min(axis=1) > 1e-2
    # Within half a dead time's turn the fraction is as good as exact.
    near = apart & (np.abs(s) < (0.5 / locus.theta if locus.theta else size)) & (K > 0)
    K, s = K[near], s[near]
    assert s.size > 20
    L = locus.gain * np.exp(-locus.theta * s)
    for zero in locus.zeros:
        L = L * (s - zero)
    for pole in locus.poles:
        L = L / (s - pole)
    np.testing.assert_allclose(K * L, -1.0, atol=1e-3)
    assert mine.complete


@pytest.mark.parametrize("delay", [0, 10])
def test_both_do_the_same_saturated_loop(delay: int) -> None:
    np.testing.assert_allclose(saturated.ours(delay)(4.3), saturated.by_control(delay)(4.3), atol=1e-13)


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda s: s.name)
@pytest.mark.parametrize("sampled", [True, False])
def test_both_do_the_same_control_loop(scenario: ControlScenario, sampled: bool) -> None:
    short = replace(scenario, samples=60)
    peer_work = (nonlinear_loops.by_scipy if sampled else nonlinear_loops.by_control)(short)
    found, theirs = nonlinear_loops.ours(short, sampled)(scenario.Kc), peer_work(scenario.Kc)
    np.testing.assert_allclose(found, theirs, atol=2e-5 * np.abs(theirs).max())
    assert np.ptp(found) > 1e-2


@pytest.mark.parametrize("controlled", [False, True])
def test_the_column_is_the_same_for_all(controlled: bool) -> None:
    work = column.Column(controlled)
    value = column.SETPOINT if controlled else 129.0
    found = work.ours(value)
    for other in (work.scipy, work.control):
        np.testing.assert_allclose(found, other(value), rtol=2e-5)


def test_no_gain_is_timed_twice() -> None:
    """A gain seen before would be answered from memory."""
    gains = [k for series in range(len(moves.COMPARISONS)) for k in DELAY_FREE.gains(43, series)]
    assert len(set(gains)) == len(gains)


def test_its_reference_is_the_exact_one() -> None:
    known = {case["name"]: case for case in reference("delayed_loops")["cases"]}
    for case, name in zip(accuracy.CASES, ("fopdt_PI_cohen_coon", "fopdt_PID_cohen_coon"), strict=True):
        for side in ("setpoint", "load"):
            for signal in ("y", "u"):
                assert case[side][signal] == known[name][side][signal]
