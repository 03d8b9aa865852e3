"""The delayed responses a second way, compared with ../delayed_loops.json.

y = sum_{n>=1} -(-L0)^n e^{-n theta s}/s and its like for u and for the load are inverted term by term; all terms that
have begun by time t go under one Bromwich integral bent into a circle around every pole (trapezoid rule, which
converges geometrically there). Terms that have not begun are left out exactly, so dead time is exact.
"""

import json
from fractions import Fraction
from math import floor

from _exact import OUT, value
from delayed_cases import CASES, controller, sample_times
from mpmath import exp, expj, mp, mpf, pi


def radius(p):
    """Fujiwara's bound on the size of a polynomial's roots."""
    n = len(p) - 1
    return 2 * max((float(abs(c / p[-1])) ** (1 / (n - i)) for i, c in enumerate(p[:-1])), default=0)


def inverse(F, t, R, points):
    total = mp.zero
    for k in range(points):
        s = R * expj(2 * pi * (mpf(k) + mpf(1) / 2) / points)
        total += (F(s) * s).real if k < points // 2 else 0
    return 2 * total / points  # conjugate halves


def circle(case):
    """A radius that holds every open-loop pole, with room."""
    return 1.3 * max(radius(case["den"]), radius(controller(case)[1])) + 0.3


def responses(case, t):
    """(y, u) to the setpoint step and y to the load step at time t (u to the load step is minus y to the setpoint)."""
    cn, cd = controller(case)
    pn, pd = case["num"], case["den"]
    theta = Fraction(case["theta"])
    begun = floor(t / theta)
    R = circle(case)
    th, tm = mpf(theta.numerator) / theta.denominator, mpf(t.numerator) / t.denominator
    mp.dps = int(60 + R * float(t) / 2.302 + 2 * begun)
    points = int(8 * R * float(t) + 60 * (begun + 6))
    points += points % 2

    def terms(s, first):
        C, P = value(cn, s) / value(cd, s), value(pn, s) / value(pd, s)
        q = -C * P * exp(-th * s)
        total, term = mp.zero, q**first
        for _ in range(first, begun + 1):
            total += term
            term *= q
        return C, P, total * exp(s * tm) / s

    return (
        -inverse(lambda s: terms(s, 1)[2], t, R, points),
        inverse(lambda s: terms(s, 0)[0] * terms(s, 0)[2], t, R, points),
        inverse(lambda s: -terms(s, 1)[2] / terms(s, 0)[0], t, R, points),
    )


def main():
    known = {c["name"]: c for c in json.loads((OUT / "delayed_loops.json").read_text())["cases"]}
    for case in CASES:
        R = circle(case)
        step = float(case["theta"]) * float(Fraction(case["step"]))
        picks = [i for i in (2, 7, 13, 24) if R * step * i < 200 and Fraction(case["step"]) * i < 60] or [
            1
        ]  # dear beyond
        worst = 0.0
        for i in picks:
            mp.dps = 60
            neutral = len(case["num"]) == len(case["den"])
            while neutral and (Fraction(case["step"]) * i).denominator == 1:  # at a jump the integral gives the middle
                i += 1
            t = sample_times(case)[i]
            y, u, yd = responses(case, t)
            ref = known[case["name"]]
            for mine, listed in (
                (y, ref["setpoint"]["y"][i]),
                (u, ref["setpoint"]["u"][i]),
                (yd, ref["load"]["y"][i]),
                (-y, ref["load"]["u"][i]),
            ):
                worst = max(worst, float(abs(mine - listed) / max(1, abs(listed))))
        print(f"{case['name']:28s} {worst:.1e}", flush=True)
        assert worst < 1e-15, case["name"]


if __name__ == "__main__":
    main()
