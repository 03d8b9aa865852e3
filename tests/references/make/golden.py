"""Worked values of a process control course, solved anew at 40 digits; `printed` is what a careful reader gets by hand.

Each value is derived from its definition (a root of arg L + pi, |L| - 1, a polynomial ...). The script asserts that it
rounds to the printed digits.
"""

from _exact import save
from mpmath import atan, degrees, findroot, log10, mp, mpf, pi, polyroots, sqrt

mp.dps = 40


def fopdt_crossover(tau, theta):
    """omega_180 of e^{-theta s}/(tau s + 1): the first root of atan(tau w) + theta w = pi."""
    return findroot(lambda w: atan(tau * w) + theta * w - pi, (mpf("0.5") * pi / theta, pi / theta), solver="illinois")


def fopdt_phase_margin(Kc, tau, theta):
    w = sqrt(Kc**2 - 1) / tau
    return 180 - degrees(atan(tau * w) + theta * w)


def check(value, printed):
    digits = len(printed.split(".")[1]) if "." in printed else 0
    assert mp.nstr(value, 25) and abs(value - mpf(printed)) <= mpf("0.5000001") * mpf(10) ** -digits, (value, printed)
    return {"value": value, "printed": float(printed)}


def main():
    tau, theta = mpf("0.5"), mpf("0.1")
    K, r = mpf(1), theta / tau
    w = fopdt_crossover(tau, theta)
    Ku = sqrt(1 + (tau * w) ** 2)
    Kc5 = Ku / mpf(10) ** (mpf(5) / 20)
    w15 = fopdt_crossover(tau, mpf("0.15"))
    Ku15 = sqrt(1 + (tau * w15) ** 2)
    w25 = fopdt_crossover(mpf("0.25"), theta)
    Ku25 = sqrt(1 + (mpf("0.25") * w25) ** 2)
    K30 = findroot(lambda k: fopdt_phase_margin(k, tau, theta) - 30, (mpf(4), mpf(8)), solver="illinois")
    # the largest gain that is still stable at theta = 0.15 has this phase margin at theta = 0.1
    enough = fopdt_phase_margin(Ku15, tau, theta)
    Pu = 2 * pi / sqrt(mpf(3))
    breaks = sorted(polyroots([1, 2, -4]), key=lambda s: -s)  # d/ds of s(s-4)/(2(s+1)): s^2 + 2s - 4 = 0
    gains = [-(s * (s - 4)) / (2 * (s + 1)) for s in breaks]
    inner = polyroots([1, 4, 3])  # 1 + GC = 0 of 3/(s(s+4)) and the hidden pole 4
    cases = [
        {
            "name": "ziegler_nichols_third_order",
            "plant": "1/(s+1)^3",
            "omega_180": check(sqrt(mpf(3)), "1.7321"),
            "Ku": check((1 + mpf(3)) ** mpf("1.5"), "8"),
            "Pu": check(Pu, "3.6276"),
            "P": {"Kc": check(mpf(4), "4")},
            "PI": {"Kc": check(mpf("3.6"), "3.6"), "tau_I": check(Pu / mpf("1.2"), "3.0230")},
            "PID": {
                "Kc": check(mpf("4.8"), "4.8"),
                "tau_I": check(Pu / 2, "1.8138"),
                "tau_D": check(Pu / 8, "0.45345"),
            },
            "closed_loop_printed": {
                "PI": {"overshoot_pct": 56.1, "GM": 1.52, "PM_deg": 14.8, "Ms": 4.93},
                "PID": {"overshoot_pct": 42.7, "PM_deg": 29.4, "Ms": 2.24, "t_settle": 9.19},
            },
        },
        {
            "name": "cohen_coon",
            "K": K,
            "tau": tau,
            "theta": theta,
            "P": {"Kc": check((1 / (K * r)) * (1 + r / 3), "5.333")},
            "PI": {
                "Kc": check((1 / (K * r)) * (mpf("0.9") + r / 12), "4.583"),
                "tau_I": check(theta * (30 + 3 * r) / (9 + 20 * r), "0.2354"),
            },
            "PID": {
                "Kc": check((1 / (K * r)) * (mpf(4) / 3 + r / 4), "6.917"),
                "tau_I": check(theta * (32 + 6 * r) / (13 + 8 * r), "0.2274"),
                "tau_D": check(theta * 4 / (11 + 2 * r), "0.03509"),
            },
        },
        {
            "name": "gain_margin_5dB",
            "plant": "exp(-0.1 s)/(0.5 s + 1)",
            "omega_180": check(w, "16.887"),
            "Ku": check(Ku, "8.502"),
            "Kc": check(Kc5, "4.781"),
            "PM_deg": check(fopdt_phase_margin(Kc5, tau, theta), "48.5"),
            "longer_dead_time": {
                "plant": "exp(-0.15 s)/(0.5 s + 1)",
                "GM_dB": check(20 * log10(Ku15 / Kc5), "1.81"),
                "PM_deg": check(fopdt_phase_margin(Kc5, tau, mpf("0.15")), "21.7"),
            },
        },
        {
            "name": "phase_margin_30",
            "plant": "exp(-0.1 s)/(0.5 s + 1)",
            "Kc": check(K30, "6.136"),
            "GM_dB": check(20 * log10(Ku / K30), "2.83"),
            "longer_dead_time": {
                "plant": "exp(-0.15 s)/(0.5 s + 1)",
                "Kc_limit": check(Ku15, "5.890"),
                "PM_deg_that_suffices": check(enough, "33.26"),
            },
            "faster_lag": {"plant": "exp(-0.1 s)/(0.25 s + 1)", "Kc_limit": check(Ku25, "4.587")},
        },
        {
            "name": "root_locus_breakaways",
            "plant": "2(s+1)/(s(s-4))",
            "breakaways": [
                {"s": check(breaks[0], "1.236"), "K": check(gains[0], "0.764")},
                {"s": check(breaks[1], "-3.236"), "K": check(gains[1], "5.236")},
            ],
            "stable_above": 2.0,
            "crossing_omega": 2.0,
        },
        {"name": "root_locus_never_stable", "plant": "(s+3)/(s^2*(s+2)*(s+4)*(s^2+2s+9)*(s^3+5))", "rhp_at_least": 2},
        {
            "name": "internal_stability",
            "plant": "3/((s+4)(s-4))",
            "controller": "(s-4)/s",
            "poles": sorted([4.0, *(float(p.real) for p in inner)]),
        },
        {
            "name": "routh_PI",
            "plant": "1/(s^2+2s+2)",
            "tau_I": [0.1, 0.25, 0.4],
            "Kc_limit": [4 / (1 / mpf(t) - 2) for t in ("0.1", "0.25", "0.4")],
            "unlimited_from_tau_I": 0.5,
        },
    ]
    save("golden", __doc__.strip(), cases)


if __name__ == "__main__":
    main()
