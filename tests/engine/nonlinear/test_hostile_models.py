"""Models that no solver ends by itself: each is cut, with its reason, within its budget."""

import math
import time

import numpy as np
import pytest

from looplab.engine.nonlinear import compile_model
from looplab.engine.nonlinear.simulation import METHODS, call_budget, simulate_open_loop
from models import model

# equation -> (where the solution ends or None, how closely it is found by any method)
ENDS = {
    "x^2": (1.0, 0.03),
    "1000*x": (math.log(1e12) / 1000, 0.03),
    "sqrt(1 - t)*x": (1.0, 1e-4),
    "exp(x)": (math.exp(-1), 0.01),
    "exp(exp(t))": (None, 0),
    "-1/x": (0.5, 0.03),
    "-sqrt(x)": (2.0, 1e-3),
    "tan(t)": (math.pi / 2, 0.02),
    "-sign(x)": (1.0, 1e-3),
    "if(x > 0, -1, 1)*1e6": (1e-6, 1e-6),
    "1e6*cos(1e6*t)": (None, 0),
    "1e308*x": (0.0, 1e-6),
    "-1e9*(x - cos(t))": (None, 0),
    "sin(1/(x - 1.0000001))*1e9": (None, 0),
}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("equation", ENDS)
def test_it_is_cut_with_a_reason(equation, method):
    compiled = compile_model(model(equation))
    started = time.process_time()
    found = simulate_open_loop(compiled, np.linspace(0, 10, 501), method=method)
    # Busy time of this process: about a tenth of this by itself, and never a hang.
    assert time.process_time() - started < 10
    assert found.calls <= call_budget(compiled, method) + 1
    assert np.isfinite(found.x).all()
    assert (found.truncated_at is None) == (found.truncated_reason is None)
    end, tolerance = ENDS[equation]
    if end is not None:
        assert found.truncated_at == pytest.approx(end, abs=tolerance)
        assert found.t[-1] == found.truncated_at


def test_a_stiff_model_is_not_hostile_to_a_stiff_solver():
    t = np.linspace(0, 10, 501)
    for method in ("LSODA", "Radau", "BDF"):
        found = simulate_open_loop(compile_model(model("-1e9*(x - cos(t))")), t, method=method)
        assert found.truncated_at is None
        np.testing.assert_allclose(found.x[1:, 0], np.cos(t[1:]), atol=1e-7)


def test_the_budget_is_smaller_for_a_larger_model():
    small = compile_model(model("-x"))
    large = compile_model(model([" + ".join(f"sin({k}.5*x1)" for k in range(9 * i, 9 * i + 9)) for i in range(12)]))
    assert call_budget(large) < call_budget(small)
    found = simulate_open_loop(small, [0, 1000], budget=50)
    assert found.truncated_reason.startswith("the solver needs more than 50 evaluations")
    assert found.calls == 51
