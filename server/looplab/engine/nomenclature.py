"""The one table of names: symbol -> LaTeX, unit and meaning. Every label in the project comes from it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Symbol:
    """One quantity: how it is typeset, its unit ("time" stands for the model's time unit) and what it is."""

    latex: str
    unit: str
    meaning: str


NOMENCLATURE: dict[str, Symbol] = {
    "K": Symbol("K", "output/input", "process gain"),
    "tau": Symbol(r"\tau", "time", "time constant"),
    "tau_1": Symbol(r"\tau_1", "time", "first time constant"),
    "tau_2": Symbol(r"\tau_2", "time", "second time constant"),
    "theta": Symbol(r"\theta", "time", "dead time"),
    "zeta": Symbol(r"\zeta", "-", "damping ratio"),
    "omega_n": Symbol(r"\omega_n", "rad/time", "natural frequency 1/tau of a second-order system"),
    "omega_d": Symbol(r"\omega_d", "rad/time", "damped frequency, imaginary part of the poles"),
    "period": Symbol("P", "time", "period of the oscillation"),
    "t_63": Symbol("t_{63}", "time", "time to 63.2 % of the final value"),
    "Kc": Symbol("K_c", "input/output", "controller gain, ideal and series form"),
    "tau_I": Symbol(r"\tau_I", "time", "integral time"),
    "tau_D": Symbol(r"\tau_D", "time", "derivative time"),
    "alpha": Symbol(r"\alpha", "-", "derivative filter time as a fraction of the derivative time"),
    "beta": Symbol(r"\beta", "-", "weight of the setpoint in the proportional part"),
    "Kp": Symbol("K_p", "input/output", "proportional gain, parallel form"),
    "Ki": Symbol("K_i", "input/output/time", "integral gain, parallel form"),
    "Kd": Symbol("K_d", "input/output*time", "derivative gain, parallel form"),
    "tau_c": Symbol(r"\tau_c", "time", "desired closed-loop time constant"),
    "Ku": Symbol("K_u", "input/output", "ultimate gain"),
    "Pu": Symbol("P_u", "time", "ultimate period"),
    "omega": Symbol(r"\omega", "rad/time", "angular frequency"),
    "omega_c": Symbol(r"\omega_c", "rad/time", "gain crossover frequency, |L| = 1"),
    "omega_180": Symbol(r"\omega_{180}", "rad/time", "phase crossover frequency, arg L = -180 deg"),
    "GM": Symbol(r"\mathrm{GM}", "-", "gain margin as a ratio"),
    "GM_dB": Symbol(r"\mathrm{GM}", "dB", "gain margin"),
    "PM_deg": Symbol(r"\mathrm{PM}", "deg", "phase margin"),
    "delay_margin": Symbol(r"\mathrm{DM}", "time", "dead time that can be added before instability"),
    "Ms": Symbol("M_s", "-", "peak of the sensitivity |S|"),
    "Mt": Symbol("M_t", "-", "peak of the complementary sensitivity |T|"),
    "omega_Ms": Symbol(r"\omega_{M_s}", "rad/time", "frequency of the peak of |S|"),
    "omega_Mt": Symbol(r"\omega_{M_t}", "rad/time", "frequency of the peak of |T|"),
    "S": Symbol("S", "-", "sensitivity 1/(1+PC)"),
    "PS": Symbol("PS", "output/input", "load sensitivity P/(1+PC)"),
    "CS": Symbol("CS", "input/output", "noise sensitivity C/(1+PC)"),
    "T": Symbol("T", "-", "complementary sensitivity PC/(1+PC)"),
    "r": Symbol("r", "output", "setpoint"),
    "e": Symbol("e", "output", "control error r - y"),
    "u": Symbol("u", "input", "controller output"),
    "d": Symbol("d", "input", "load disturbance at the plant input"),
    "n": Symbol("n", "output", "measurement noise"),
    "y": Symbol("y", "output", "controlled variable"),
    "final_value": Symbol(r"y(\infty)", "output", "value the response settles at"),
    "offset": Symbol(r"r - y(\infty)", "output", "error that remains"),
    "overshoot_pct": Symbol(r"\mathrm{OS}", "%", "overshoot over the final value"),
    "t_peak": Symbol("t_p", "time", "time of the largest excursion"),
    "peak": Symbol(r"y_{\max}", "output", "largest excursion"),
    "t_rise": Symbol("t_r", "time", "rise time, 10 % to 90 % of the final value"),
    "t_settle": Symbol("t_s", "time", "settling time into +-2 % of the final value"),
    "decay_ratio": Symbol(r"\mathrm{DR}", "-", "second overshoot over the first"),
    "IAE": Symbol(r"\mathrm{IAE}", "output*time", "integral of |e|"),
    "ISE": Symbol(r"\mathrm{ISE}", "output^2*time", "integral of e^2"),
    "ITAE": Symbol(r"\mathrm{ITAE}", "output*time^2", "integral of t|e|"),
    "TV": Symbol(r"\mathrm{TV}", "input", "total variation of u"),
    "max_deviation": Symbol(r"\max|y - \hat y|", "output", "largest distance of a model from the true step response"),
    "A": Symbol("A", "1/time", "state matrix, x' = A x + B u"),
    "B": Symbol("B", "state/input/time", "input matrix"),
    "C": Symbol("C", "output/state", "output matrix, y = C x + D u"),
    "D": Symbol("D", "output/input", "direct feedthrough"),
    "x": Symbol("x", "state", "state vector"),
    "h": Symbol("h", "output/input/time", "impulse response"),
    "Wc": Symbol("W_c", "state^2*time", "controllability Gramian"),
    "Wo": Symbol("W_o", "output^2*time/state^2", "observability Gramian"),
}
