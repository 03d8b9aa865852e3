"""The tabulated values are what their scripts say: a second method on a few samples, and closed forms."""

import importlib.util
import sys
from collections.abc import Iterator
from fractions import Fraction
from math import factorial
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from references import FOLDER, reference

MAKE = FOLDER / "make"


@pytest.fixture(scope="module")
def crosscheck() -> Iterator[ModuleType]:
    """make/crosscheck.py, which imports its neighbours by name."""
    before = set(sys.modules)
    sys.path.insert(0, str(MAKE))
    try:
        spec = importlib.util.spec_from_file_location("crosscheck", MAKE / "crosscheck.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        yield module
    finally:
        sys.path.remove(str(MAKE))
        for name in set(sys.modules) - before:
            if str(getattr(sys.modules[name], "__file__", "")).startswith(str(MAKE)):
                del sys.modules[name]


@pytest.mark.parametrize(
    ("name", "sample"), [("fopdt_PI_cohen_coon", 3), ("rhp_zero_PI", 5), ("biproper_PI", 4), ("unstable_plant_P", 7)]
)
def test_a_contour_integral_gives_the_same(crosscheck: ModuleType, name: str, sample: int) -> None:
    case = next(c for c in crosscheck.CASES if c["name"] == name)
    known = next(c for c in reference("delayed_loops")["cases"] if c["name"] == name)
    y, u, load = crosscheck.responses(case, crosscheck.sample_times(case)[sample])
    assert known["setpoint"]["y"][sample] == pytest.approx(float(y), rel=1e-15, abs=1e-15)
    assert known["setpoint"]["u"][sample] == pytest.approx(float(u), rel=1e-15, abs=1e-15)
    assert known["load"]["y"][sample] == pytest.approx(float(load), rel=1e-15, abs=1e-15)
    assert known["load"]["u"][sample] == pytest.approx(-float(y), rel=1e-15, abs=1e-15)


@pytest.mark.parametrize(
    ("name", "Kc"), [("integrator_P", "0.5"), ("integrator_P_unstable", "1.8"), ("high_gain_integrator", "100")]
)
def test_the_integrator_is_its_piecewise_polynomial(name: str, Kc: str) -> None:
    known = next(c for c in reference("delayed_loops")["cases"] if c["name"] == name)
    step, gain = Fraction(known["step"]), Fraction(Kc)
    for i, y in enumerate(known["setpoint"]["y"]):
        t = step * i
        e = sum((-gain) ** k * (t - k) ** k / Fraction(factorial(k)) for k in range(int(t) + 1))
        assert y == pytest.approx(float(1 - e), rel=1e-15, abs=1e-15)


@pytest.mark.parametrize("file", ["delayed_loops", "delay_free_loops"])
def test_what_every_loop_obeys(file: str) -> None:
    """u to a load is minus y to a setpoint (both are L/(1+L)); nothing passes before the dead time."""
    for case in reference(file)["cases"]:
        y, u = np.array(case["setpoint"]["y"]), np.array(case["load"]["u"])
        np.testing.assert_allclose(u, -y, rtol=1e-14, atol=1e-25)
        early = np.array(case["t"]) < case.get("theta", 0.0)
        assert not y[early].any()


def test_every_file_says_how_it_was_made() -> None:
    for path in sorted(FOLDER.glob("*.json")):
        document = reference(path.stem)
        assert (FOLDER / document["made_by"]).is_file()
        assert len(document["method"]) > 60
        assert document["cases"]
    assert not list(Path(MAKE).glob("*looplab*"))
    for script in MAKE.glob("*.py"):
        assert "import looplab" not in script.read_text()
        assert "from looplab" not in script.read_text()
