"""Worked examples as printed in papers and textbooks, to the digits printed.

Cited by edition and chapter or table: page numbers differ between printings.
"""

import pytest

from looplab.engine.frequency import margins
from looplab.engine.loop import PID
from looplab.engine.systems import FOPDT, parse_transfer_function
from looplab.engine.tuning import RULES, KnownPlant, Options

# S. Skogestad, J. Process Control 13 (2003) 291-309, Table 4: PI as Kc, tau_I, Ms; PID in series form.
SKOGESTAD = {
    "1/((s+1)(0.2s+1))": ("5.50", "0.8", "1.56", None),
    "2(15s+1)/((20s+1)(s+1)(0.1s+1)^2)": ("2.33", "1.05", "1.55", ("6.67", "0.4", "0.15")),
    "1/(s+1)^4": ("0.30", "1.5", "1.46", ("0.50", "1.5", "1.0")),
    "1/((s+1)(0.2s+1)(0.04s+1)(0.008s+1))": ("3.72", "1.1", "1.59", ("17.9", "0.224", "0.22")),
    "(-2s+1)/(s+1)^3": ("0.214", "1.5", None, ("0.30", "1.5", "1.0")),
    "1/(s(s+1)^2)": ("0.33", "12", None, ("1.0", "4.0", "1.5")),
    "exp(-s)/(s+1)^2": ("0.50", "1.5", "1.61", ("0.50", "1.0", "1.0")),
    "exp(-s)/((20s+1)(2s+1))": ("5.25", "16", "1.72", ("10.0", "8", "2")),
    "(-s+1)exp(-s)/((6s+1)(2s+1)^2)": ("0.70", "7", "1.63", ("1.0", "6", "3")),
    "(6s+1)(3s+1)exp(-0.3s)/((10s+1)(8s+1)(s+1))": ("7.41", "1", "1.66", None),
}


def printed(value: float | None, text: str) -> bool:
    """Whether a number is the printed one, to its digits."""
    decimals = len(text.partition(".")[2])
    return value is not None and f"{value:.{decimals}f}" == text


@pytest.mark.parametrize("text", SKOGESTAD)
def test_skogestad(text: str) -> None:
    Kc, tau_I, Ms, series = SKOGESTAD[text]
    P = parse_transfer_function(text)
    known = KnownPlant.of(P)
    PI = known.tune(RULES["simc"], "PI")
    assert printed(PI.Kc, Kc)
    assert printed(PI.tau_I, tau_I)
    if Ms:
        assert printed(margins(PID(PI.Kc, PI.tau_I).to_transfer_function() * P).Ms, Ms)
    if series:
        found = known.tune(RULES["simc"], "PID").published
        assert found is not None
        assert all(printed(v, t) for v, t in zip((found.Kc, found.tau_I, found.tau_D), series, strict=True))


@pytest.mark.parametrize(
    ("K", "tau", "theta", "PI", "PID_"),
    [
        # K. J. Åström, T. Hägglund, J. Process Control 14 (2004) 635-650, examples 1 (lag dominated) and 2 (balanced).
        (1, 1.04, 0.075, ("4.13", "0.539"), ("6.44", "0.361", "0.0367")),
        (1, 2.9, 1.42, ("0.414", "2.66"), ("1.12", "2.40", "0.619")),
        # The same authors, Advanced PID Control, ISA 2006, ch. 7, the example ruled by dead time.
        (1, 0.0932, 1.01, None, ("0.242", "0.474", "0.119")),
    ],
)
def test_amigo(K: float, tau: float, theta: float, PI: tuple[str, ...] | None, PID_: tuple[str, ...]) -> None:
    known = KnownPlant(model=FOPDT(K, tau, theta))
    if PI is not None:
        found = known.tune(RULES["amigo"], "PI")
        assert all(printed(v, t) for v, t in zip((found.Kc, found.tau_I), PI, strict=True))
    found = known.tune(RULES["amigo"], "PID")
    assert all(printed(v, t) for v, t in zip((found.Kc, found.tau_I, found.tau_D), PID_, strict=True))


def test_seborg_controller_settings_compared() -> None:
    """D. E. Seborg et al., Process Dynamics and Control, 2nd ed. 2004, ch. 12, the example 10 e^{-s}/(2s+1), PI."""
    known = KnownPlant.of(parse_transfer_function("10 exp(-s)/(2s+1)"))
    imc = known.tune(RULES["imc"], "PI", Options(tau_c=2 / 3))
    setpoint, load = (known.tune(RULES[name], "PI") for name in ("itae_setpoint", "itae_load"))
    assert (f"{imc.Kc:.2f}", f"{imc.tau_I:.1f}") == ("0.12", "2.0")
    assert (f"{setpoint.Kc:.2f}", f"{setpoint.tau_I:.1f}") == ("0.11", "2.1")
    assert (f"{load.Kc:.3f}", f"{load.tau_I:.2f}") == ("0.169", "1.85")


def test_seborg_continuous_cycling() -> None:
    """D. E. Seborg et al., 2nd ed. 2004, ch. 12, the example 4 e^{-3.5 s}/(7s+1), Ku = 0.95, Pu = 12."""
    point = KnownPlant.of(parse_transfer_function("4 exp(-3.5s)/(7s+1)")).ultimate()
    assert f"{point.Ku:.2f}" == "0.95"
    assert f"{point.Pu:.0f}" == "12"
    rounded = KnownPlant(ultimate=point.of(0.95, 12.0))
    zn, tl = (rounded.tune(RULES[name], "PID") for name in ("ziegler_nichols", "tyreus_luyben"))
    assert (f"{zn.Kc:.2f}", f"{zn.tau_I:.1f}", f"{zn.tau_D:.1f}") == ("0.57", "6.0", "1.5")
    assert (f"{tl.Kc:.2f}", f"{tl.tau_I:.1f}", f"{tl.tau_D:.1f}") == ("0.43", "26.4", "1.9")
