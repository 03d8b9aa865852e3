"""Crossovers, margins and sensitivity peaks of open loops, by root finding at 40 digits.

L is kept in factors. ln|L| is an even function of omega, arg L a sum of arctangents minus omega theta; both are scanned
on a fine grid (logarithmic, and linear where the dead time turns) and every change of sign is refined by mpmath's
bracketed Illinois method. Phase crossovers are the zeros of Im L with Re L < 0. Peaks are refined by a golden search to
1e-18. The closed loop's right-half-plane poles are counted by the argument principle on
D + N exp(-theta s).
"""

import sys
from pathlib import Path

from _exact import save
from mpmath import arg, cos, degrees, findroot, log, log10, mp, mpc, mpf, pi, sin, sqrt

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from independent import rhp_closed_loop_poles

mp.dps = 40


def zpk(zeros, poles, gain, theta="0"):
    def root(r):
        return mpc(*map(mpf, r)) if isinstance(r, tuple) else mpf(r)

    return [root(z) for z in zeros], [root(p) for p in poles], mpf(gain), mpf(theta)


def pair(re, im):
    return [(re, im), (re, "-" + im)]


def pi_times(Kc, tau_I, zeros, poles, gain, theta="0"):
    z, p, k, th = zpk(zeros, poles, gain, theta)
    return [*z, -1 / mpf(tau_I)], [*p, mpf(0)], k * mpf(Kc), th


def pid_times(Kc, tau_I, tau_D, alpha, zeros, poles, gain, theta="0"):
    z, p, k, th = zpk(zeros, poles, gain, theta)
    Kc, tau_I, tau_D, alpha = map(mpf, (Kc, tau_I, tau_D, alpha))
    a, b = tau_I * tau_D * (1 + alpha), tau_I + alpha * tau_D
    disc = sqrt(mpc(b * b - 4 * a))
    lead = [(-b + disc) / (2 * a), (-b - disc) / (2 * a)]
    return [*z, *lead], [*p, mpf(0), -1 / (alpha * tau_D)], k * Kc * (1 + alpha) / alpha, th


R3 = sqrt(mpf(3))
PU = 2 * pi / R3
CASES = [
    ("zn_P", zpk([], ["-1"] * 3, 4)),
    ("zn_PI", pi_times("3.6", PU / mpf("1.2"), [], ["-1"] * 3, 1)),
    ("zn_PID", pid_times("4.8", PU / 2, PU / 8, "0.1", [], ["-1"] * 3, 1)),
    ("zn_near_limit", zpk([], ["-1"] * 3, "7.999")),
    ("fopdt_unit", zpk([], ["-2"], 2, "0.1")),
    ("fopdt_5dB", zpk([], ["-2"], mpf(2) * mpf("4.7810"), "0.1")),
    ("fopdt_5dB_longer_dead_time", zpk([], ["-2"], mpf(2) * mpf("4.7810"), "0.15")),
    ("fopdt_PM30", zpk([], ["-2"], mpf(2) * mpf("6.136"), "0.1")),
    ("fopdt_PM30_longer_dead_time", zpk([], ["-2"], mpf(2) * mpf("6.136"), "0.15")),
    ("fopdt_PM30_faster", zpk([], ["-4"], mpf(4) * mpf("6.136"), "0.1")),
    ("integrator_dead_time", zpk([], ["0"], "0.5", "1")),
    ("two_integrators_lead", zpk(["-3"], ["0", "0", "-2"], "0.3", "0.1")),
    ("unstable_plant_dead_time", zpk([], ["1"], "2", "0.2")),
    ("unstable_plant_PI", pi_times("3", "2", [], ["1"], 1)),
    ("conditionally_stable", zpk(["-1", "-1"], ["0"] * 3, 2)),
    ("conditionally_stable_two_sides", zpk(["-1", "-1"], ["0", "0", "0", "-50", "-50"], 5000)),
    ("conditionally_stable_unstable_now", zpk(["-1", "-1"], ["0"] * 3, "0.4")),
    (
        "three_gain_crossovers",
        pi_times(
            "0.05",
            "0.5",
            [],
            [(mpf("-0.01"), sqrt(1 - mpf("0.0001"))), (mpf("-0.01"), -sqrt(1 - mpf("0.0001")))],
            1,
            "0.25",
        ),
    ),
    (
        "three_gain_crossovers_stable",
        zpk(
            [(mpf("-0.05"), sqrt(mpf("0.8075"))), (mpf("-0.05"), -sqrt(mpf("0.8075")))],
            ["0", (mpf("-0.01"), sqrt(mpf("0.9999"))), (mpf("-0.01"), -sqrt(mpf("0.9999")))],
            "0.5",
        ),
    ),
    ("no_crossover", zpk([], ["-1"], "0.5")),
    ("no_phase_crossover", zpk([], ["-1"], 2)),
    ("type_one", zpk([], ["0", "-1"], 1)),
    ("pure_dead_time", zpk([], [], "0.5", "1")),
    ("inverse_response_PI", pi_times("1.14", "12.7", ["0.5"], ["-0.2", "-0.1"], "-0.12")),
    ("ten_equal_poles", zpk([], ["-1"] * 10, "1.5")),
    ("negative_gain", zpk([], ["-1"], "-0.5")),
    ("positive_feedback", zpk([], ["-1"], "-2")),
    ("biproper_dead_time", zpk(["-0.5"], ["-1"], "0.6", "1")),
    ("undamped_poles", zpk(["-0.5"], [("0", "1"), ("0", "-1")], "1.5")),
    ("zero_at_origin", zpk(["0"], ["-1", "-1"], "3")),
    ("long_dead_time", zpk([], ["-1"], "0.8", "100")),
    ("long_dead_time_unstable", zpk([], ["-1"], "1.5", "100")),
    (
        "astrom_murray_poor_Ms",
        zpk(
            [(mpf("-0.05"), sqrt(mpf("0.5475"))), (mpf("-0.05"), -sqrt(mpf("0.5475")))],
            ["0", "-1", (mpf("-0.03"), sqrt(mpf("0.4991"))), (mpf("-0.03"), -sqrt(mpf("0.4991")))],
            "0.38",
        ),
    ),
    ("fast_and_slow", zpk([], ["-1e-3", "-1", "-1e3"], "5e2")),
    ("root_locus_example", zpk(["-1"], ["0", "4"], "6")),
]


class Loop:
    def __init__(self, zeros, poles, gain, theta):
        self.z, self.p, self.k, self.theta = zeros, poles, gain, theta

    def __call__(self, w):
        s, out = mpc(0, w), mpc(self.k)
        for z in self.z:
            out *= s - z
        for p in self.p:
            out /= s - p
        return out * mpc(cos(w * self.theta), -sin(w * self.theta))

    def ln(self, w):
        return log(abs(self(w)))

    def grid(self):
        size = [abs(r) for r in [*self.z, *self.p] if r != 0] or [mpf(1)]
        low, high = min(size) / mpf("10234.567"), max(size) * mpf("9876.543")  # no crossing sits on a grid point
        n = 1600
        points = [low * (high / low) ** (mpf(i) / n) for i in range(n + 1)]
        for r in [*self.z, *self.p]:
            if r.imag > 0:
                width = max(abs(r.real), r.imag / 10**4)
                points += [r.imag + width * (mpf(i) / 25 + mpf("0.00123")) for i in range(-200, 201)]
        if self.theta:
            top = max(mpf("79.87") / self.theta, 3 * max(size)) if self.p else mpf("79.87") / self.theta
            n = int(15 * top * self.theta)
            points = [w for w in points if w < top] + [top * mpf(i + 1) / n for i in range(n)]
        return sorted(w for w in set(points) if w > 0)


def crossings(f, grid):
    values = [f(w) for w in grid]
    out = []
    for a, b, fa, fb in zip(grid, grid[1:], values, values[1:], strict=False):
        if fa * fb < 0:
            out.append(findroot(f, (a, b), solver="illinois", tol=mpf(10) ** -36, verify=False))
    return out


def peak(f, grid):
    """(value, omega) of the largest interior maximum of f, or None when the largest sample is at an end."""
    values = [f(w) for w in grid]
    i = max(range(len(grid)), key=values.__getitem__)
    if i in (0, len(grid) - 1):
        return None
    a, b = grid[i - 1], grid[i + 1]
    g = (sqrt(mpf(5)) - 1) / 2
    c, d = b - g * (b - a), a + g * (b - a)
    while b - a > mpf(10) ** -15 * b:
        if f(c) > f(d):
            b, d = d, c
            c = b - g * (b - a)
        else:
            a, c = c, d
            d = a + g * (b - a)
    w = (a + b) / 2
    return f(w), w


def limits(L):
    """|S| and |T| for omega to 0 and to infinity (with dead time and |L(inf)| > 0: the supremum)."""
    order = sum(p == 0 for p in L.p) - sum(z == 0 for z in L.z)
    ends = {}
    if order:
        ends["0"] = (mpf(0), mpf(1)) if order > 0 else (mpf(1), mpf(0))
    else:
        at_zero = L(mpf(0)) if not any(p == 0 for p in L.p) else None
        if at_zero is not None:
            ends["0"] = (abs(1 / (1 + at_zero)), abs(at_zero / (1 + at_zero)))
    if len(L.z) < len(L.p):
        ends["inf"] = (mpf(1), mpf(0))
    elif L.theta:
        ends["inf"] = (1 / (1 - abs(L.k)), abs(L.k) / (1 - abs(L.k)))
    else:
        ends["inf"] = (abs(1 / (1 + L.k)), abs(L.k / (1 + L.k)))
    return ends


def supremum(inside, ends, which):
    """The larger of the interior peak and the limits; omega is "0" or "inf" for a limit, None where they tie."""
    end = max(ends, key=lambda w: ends[w][which])
    value = ends[end][which]
    if inside is None or value > inside[0] * (1 + mpf(10) ** -12):
        tie = any(abs(v[which] - value) < mpf(10) ** -12 * value for w, v in ends.items() if w != end)
        return {"value": value, "omega": None if tie else end}
    if abs(inside[0] - value) < mpf(10) ** -12 * value:
        return {"value": value, "omega": None}
    return {"value": inside[0], "omega": inside[1]}


def one(name, system):
    L = Loop(*system)
    grid = L.grid()
    gain = crossings(L.ln, grid)
    phase = [
        w for w in crossings(lambda w: L(w).imag, grid) if L(w).real < 0 and abs(L(w).imag / L(w).real) < mpf(10) ** -20
    ]

    def PM(w):
        v = degrees(arg(-L(w)))
        return v

    Z = rhp_closed_loop_poles([complex(z) for z in L.z], [complex(p) for p in L.p], float(L.k), float(L.theta))
    # theta may shrink or grow: the delay margin is the least extra dead time that puts a crossover on -1
    delay = [(arg(-L(w)) % (2 * pi)) / w for w in gain]
    S, T = (lambda w: abs(1 / (1 + L(w)))), (lambda w: abs(L(w) / (1 + L(w))))
    ends = limits(L)
    Ms, Mt = supremum(peak(S, grid), ends, 0), supremum(peak(T, grid), ends, 1)
    return {
        "name": name,
        "zeros": [[z.real, z.imag] for z in L.z],
        "poles": [[p.real, p.imag] for p in L.p],
        "gain": L.k,
        "theta": L.theta,
        "rhp_poles": Z,
        "gain_crossovers": [{"omega": w, "PM_deg": PM(w)} for w in gain],
        "phase_crossovers": [{"omega": w, "GM": 1 / abs(L(w)), "GM_dB": -20 * log10(abs(L(w)))} for w in phase[:8]],
        "phase_crossovers_beyond_the_list": len(phase) > 8 or bool(L.theta),
        "delay_margin": min(delay) if delay and Z == 0 else None,
        "Ms": Ms,
        "Mt": Mt,
    }


def main():
    out = []
    for name, system in CASES:
        out.append(one(name, system))
        row = out[-1]
        print(name, row["rhp_poles"], len(row["gain_crossovers"]), len(row["phase_crossovers"]), flush=True)
    save("margins", __doc__.strip(), out)


if __name__ == "__main__":
    main()
