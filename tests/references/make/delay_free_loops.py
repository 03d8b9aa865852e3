"""Exact responses of loops without dead time, by residues at 80 digits.

Each signal is N(s)/(s D(s)) with D = Dc Dp + Nc Np expanded in exact fractions; its poles come from mpmath.polyroots
(they must be simple, which is asserted) and y(t) = sum N(p)/(d/ds)(s D)(p) e^{pt}. dy/dt multiplies each term by p.
A loop with equal closed-loop poles is summed from a contour integral around all of them instead.
"""

from fractions import Fraction

from _exact import add, mul, pid, poly, power, save, to_mp, value
from mpmath import exp, expj, mp, mpf, pi, polyroots

mp.dps = 80
s1 = poly(1, 1)
ZN = {
    "P": dict(Kc="4"),
    "PI": dict(Kc="3.6", tau_I="3.0229989403903630"),
    "PID": dict(Kc="4.8", tau_I="1.8137993642342178", tau_D="0.4534498410585544", alpha="0.1"),
}

CASES = [
    ("zn_P", "1/(s+1)^3", poly(1), power(s1, 3), "30", ZN["P"]),
    ("zn_PI", "1/(s+1)^3", poly(1), power(s1, 3), "30", ZN["PI"]),
    ("zn_PID", "1/(s+1)^3", poly(1), power(s1, 3), "30", ZN["PID"]),
    ("zn_marginal", "1/(s+1)^3", poly(1), power(s1, 3), "30", dict(Kc="8")),
    ("unstable_by_gain", "1/(s+1)^3", poly(1), power(s1, 3), "20", dict(Kc="12")),
    ("series_PID", "1/(s+1)^3", poly(1), power(s1, 3), "30", {**ZN["PID"], "form": "series"}),
    ("ten_equal_poles_P", "(s+1)^-10", poly(1), power(s1, 10), "80", dict(Kc="0.8")),
    ("ten_equal_poles_PI", "(s+1)^-10", poly(1), power(s1, 10), "120", dict(Kc="0.5", tau_I="5")),
    ("twenty_equal_poles_PI", "(s+1)^-20", poly(1), power(s1, 20), "200", dict(Kc="0.4", tau_I="10")),
    (
        "two_clusters_PI",
        "1/((s+1)^5 (s+1.001)^5)",
        poly(1),
        mul(power(s1, 5), power(poly(1, "1.001"), 5)),
        "100",
        dict(Kc="0.5", tau_I="5"),
    ),
    ("complex_poles_PI", "(s+2)/(s^2+2s+10)", poly(1, 2), poly(1, 2, 10), "12", dict(Kc="3", tau_I="0.4")),
    (
        "resonance_PID",
        "1/(s^2+0.02s+1)",
        poly(1),
        poly(1, "0.02", 1),
        "60",
        dict(Kc="0.5", tau_I="2", tau_D="1.5", alpha="0.05"),
    ),
    ("resonance_I_like", "1/(s^2+0.02s+1)", poly(1), poly(1, "0.02", 1), "100", dict(Kc="0.01", tau_I="1")),
    (
        "inverse_response_PI",
        "3(1-2s)/((5s+1)(10s+1))",
        poly(-6, 3),
        mul(poly(5, 1), poly(10, 1)),
        "100",
        dict(Kc="1.14", tau_I="12.7"),
    ),
    ("unstable_plant_PI", "1/(s-1)", poly(1), poly(1, -1), "10", dict(Kc="3", tau_I="2")),
    ("double_integrator_PD", "1/s^2", poly(1), poly(1, 0, 0), "20", dict(Kc="1", tau_D="1.5", alpha="0.1")),
    ("integrator_PI", "0.2/s", poly("0.2"), poly(1, 0), "40", dict(Kc="2", tau_I="8")),
    ("zero_at_origin_PI", "s/(s+1)^2", poly(1, 0), power(s1, 2), "20", dict(Kc="3", tau_I="1.5")),
    ("pure_gain_PI", "2", poly(2), poly(1), "10", dict(Kc="0.7", tau_I="1.3")),
    ("pure_gain_P", "2", poly(2), poly(1), "10", dict(Kc="0.7")),
    ("biproper_P", "(2s+1)/(s+1)", poly(2, 1), poly(1, 1), "10", dict(Kc="3")),
    (
        "stiff_PI",
        "1/((1000s+1)(0.01s+1))",
        poly(1),
        mul(poly(1000, 1), poly("0.01", 1)),
        "60",
        dict(Kc="200", tau_I="5"),
    ),
    (
        "conditionally_stable_P",
        "(s+1)^2/(s^3 (0.02s+1)^2)",
        power(s1, 2),
        mul(poly(1, 0, 0, 0), power(poly("0.02", 1), 2)),
        "30",
        dict(Kc="2"),
    ),
    ("critically_damped_P", "1/(s(s+2))", poly(1), poly(1, 2, 0), "15", dict(Kc="1")),
    ("tiny_time_scale_PI", "1/(1e-6 s + 1)", poly(1), poly("1e-6", 1), "2e-5", dict(Kc="2", tau_I="1e-6")),
    ("huge_time_scale_PI", "1/(1e6 s + 1)", poly(1), poly("1e6", 1), "2e7", dict(Kc="2", tau_I="1e6")),
]


def by_residues(num, den, times):
    """Values and slopes of the inverse transform of num/den (strictly proper)."""
    if len(num) == 1 and num[0] == 0:
        return [(mp.zero, mp.zero)] * len(times)
    roots = polyroots(list(reversed(to_mp(den))), maxsteps=500, extraprec=800) if len(den) > 1 else []
    gap = min((abs(a - b) for i, a in enumerate(roots) for b in roots[:i]), default=mp.one)
    size = max(abs(r) for r in roots)
    if gap < size * mpf(10) ** -20:
        return by_contour(num, den, times, size)
    slope = [i * c for i, c in enumerate(to_mp(den))][1:]
    terms = [(p, value(to_mp(num), p) / value(slope, p)) for p in roots]
    return [(sum(r * exp(p * t) for p, r in terms).real, sum(r * p * exp(p * t) for p, r in terms).real) for t in times]


def by_contour(num, den, times, size):
    R = 2 * size
    mp.dps = 80 + int(R * max(times) / 2)
    points, num, den = 300 + int(6 * R * max(times)), to_mp(num), to_mp(den)
    nodes = [R * expj(2 * pi * (mpf(k) + mpf(1) / 2) / points) for k in range(points)]
    weights = [value(num, s) / value(den, s) * s / points for s in nodes]
    out = [
        (
            sum(w * exp(s * t) for s, w in zip(nodes, weights, strict=True)).real,
            sum(w * s * exp(s * t) for s, w in zip(nodes, weights, strict=True)).real,
        )
        for t in times
    ]
    mp.dps = 80
    return out


def main():
    out = []
    for name, text, pn, pd, horizon, settings in CASES:
        cn, cd = pid(**settings)
        closed, s = add(mul(pd, cd), mul(pn, cn)), poly(1, 0)
        T, CS, PS = mul(pn, cn), mul(cn, pd), mul(pn, cd)
        times = [Fraction(horizon) * i / 60 for i in range(61)]
        mp_times = [mpf(t.numerator) / t.denominator for t in times]
        den = mul(closed, s)
        y, yd = by_residues(T, den, mp_times), by_residues(PS, den, mp_times)
        u = by_residues(CS, den, mp_times)
        case = {
            "name": name,
            "plant": text,
            "horizon": float(Fraction(horizon)),
            "t": list(map(float, times)),
            "controller": {k: v if k == "form" else float(v) for k, v in settings.items()},
        }
        case["setpoint"] = {
            "y": [float(a) for a, _ in y],
            "u": [float(a) for a, _ in u],
            "dy": [float(b) for _, b in y],
        }
        case["load"] = {"y": [float(a) for a, _ in yd], "u": [-float(a) for a, _ in y], "dy": [float(b) for _, b in yd]}
        out.append(case)
    save("delay_free_loops", __doc__.strip(), out)


if __name__ == "__main__":
    main()
