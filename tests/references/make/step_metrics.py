"""Metrics of delay-free setpoint and load steps, from the exact sum of exponentials.

y(t) = sum r e^{pt} from residues at 50 digits. Turning points and level crossings are bracketed on 6000 points and
refined by mpmath; integrals of |e|, e^2 and t|e| use closed antiderivatives between the zeros of e, over the horizon;
TV adds |u(0+)| and the distances between the turning points of u.
"""

import itertools

from _exact import add, mul, pid, poly, power, save, to_mp, value
from mpmath import exp, findroot, mp, mpf, polyroots

mp.dps = 50
s1 = poly(1, 1)
ZN = {
    "P": dict(Kc="4"),
    "PI": dict(Kc="3.6", tau_I="3.0229989403903630843"),
    "PID": dict(Kc="4.8", tau_I="1.8137993642342178506", tau_D="0.45344984105855446265", alpha="0.1"),
}
CASES = [
    ("zn_P", "1/(s+1)^3", poly(1), power(s1, 3), ZN["P"], 30),
    ("zn_PI", "1/(s+1)^3", poly(1), power(s1, 3), ZN["PI"], 40),
    ("zn_PID", "1/(s+1)^3", poly(1), power(s1, 3), ZN["PID"], 30),
    ("second_order", "1/(s(s+0.8))", poly(1), poly(1, "0.8", 0), dict(Kc="1"), 30),
    ("first_order_PI", "2/(3s+1)", poly(2), poly(3, 1), dict(Kc="1", tau_I="3"), 20),
    (
        "inverse_response_PI",
        "3(1-2s)/((5s+1)(10s+1))",
        poly(-6, 3),
        mul(poly(5, 1), poly(10, 1)),
        dict(Kc="0.5", tau_I="12"),
        200,
    ),
    ("overdamped_P", "1/((s+1)(5s+1))", poly(1), mul(s1, poly(5, 1)), dict(Kc="0.1"), 60),
    ("negative_gain", "-2/((s+1)(2s+1)^2)", poly(-2), mul(s1, power(poly(2, 1), 2)), dict(Kc="-1.5", tau_I="5"), 60),
]


class Exponentials:
    """sum r e^{pt}; derivative and antiderivatives are of the same kind."""

    def __init__(self, terms):
        self.terms = terms

    def __call__(self, t):
        return sum(r * exp(p * t) for p, r in self.terms).real

    def derivative(self):
        return Exponentials([(p, r * p) for p, r in self.terms if p != 0])

    def product(self, other):
        return Exponentials([(p + q, r * w) for p, r in self.terms for q, w in other.terms])

    def integral(self, a, b):
        return sum(
            r * (b - a) if abs(p) < mpf(10) ** -40 else r * (exp(p * b) - exp(p * a)) / p for p, r in self.terms
        ).real

    def first_moment(self, a, b):
        def F(p, r, t):
            return r * t * t / 2 if abs(p) < mpf(10) ** -40 else r * exp(p * t) * (t / p - 1 / p**2)

        return sum(F(p, r, b) - F(p, r, a) for p, r in self.terms).real


def signal(num, den):
    roots = polyroots(list(reversed(to_mp(den))), maxsteps=300, extraprec=400)
    roots = [mp.zero if abs(r) < mpf(10) ** -40 else r for r in roots]
    slope = [i * c for i, c in enumerate(to_mp(den))][1:]
    return Exponentials([(p, value(to_mp(num), p) / value(slope, p)) for p in roots])


def zeros(f, horizon, first=0):
    grid = [mpf(first) + (horizon - first) * mpf(i) / 6000 for i in range(6001)]
    v = [f(t) for t in grid]
    return [
        findroot(f, (a, b), solver="illinois", verify=False)
        for a, b, x, y in zip(grid, grid[1:], v, v[1:], strict=False)
        if x * y < 0
    ]


def metrics(y, u, r, final, horizon):
    horizon = mpf(horizon)
    dy, du = y.derivative(), u.derivative()
    tops = zeros(dy, horizon)
    e = Exponentials([*((p, -c) for p, c in y.terms), (mp.zero, mpf(r))])
    cuts = [mp.zero, *zeros(e, horizon), horizon]
    pairs = list(itertools.pairwise(cuts))
    turns = [mp.zero, *zeros(du, horizon), horizon]
    out = {
        "final_value": final,
        "offset": r - final,
        "IAE": sum(abs(e.integral(a, b)) for a, b in pairs),
        "ISE": e.product(e).integral(mp.zero, horizon),
        "ITAE": sum(abs(e.first_moment(a, b)) for a, b in pairs),
        "TV": abs(u(mp.zero)) + sum(abs(u(b) - u(a)) for a, b in itertools.pairwise(turns)),
    }
    if r and abs(final) > 1e-9:
        sign = 1 if final > 0 else -1
        height = [(t, sign * (y(t) - final)) for t in tops if sign * (y(t) - final) > mpf(10) ** -9 * abs(final)]
        edges = [t for b in ("1.02", "0.98") for t in zeros(lambda t, b=b: y(t) - final * mpf(b), horizon)]
        low, high = (zeros(lambda t, k=k: y(t) - final * mpf(k), horizon) for k in ("0.1", "0.9"))
        out |= {"overshoot_pct": mpf(0), "t_peak": None}
        if height:
            t, h = max(height, key=lambda p: p[1])
            out |= {"overshoot_pct": 100 * h / abs(final), "t_peak": t, "peak": y(t)}
        out["decay_ratio"] = height[1][1] / height[0][1] if len(height) > 1 else None
        out["t_rise"] = high[0] - low[0]
        out["t_settle"] = max(edges)
    else:
        t = max([*tops, horizon], key=lambda t: abs(y(t)))
        out |= {"peak": y(t), "t_peak": t}
        edges = [x for k in (-1, 1) for x in zeros(lambda x, k=k: y(x) - final - k * abs(y(t)) / 50, horizon)]
        out["t_settle"] = max(edges)
    return out


def limit(num, den):
    """num(0)/den(0)."""
    return mpf((num[0] / den[0]).numerator) / (num[0] / den[0]).denominator


def main():
    out = []
    for name, text, pn, pd, settings, horizon in CASES:
        cn, cd = pid(**settings)
        closed, s = add(mul(pd, cd), mul(pn, cn)), poly(1, 0)
        den = mul(closed, s)
        y, u, yd = signal(mul(pn, cn), den), signal(mul(cn, pd), den), signal(mul(pn, cd), den)
        ud = Exponentials([(p, -c) for p, c in y.terms])
        out.append(
            {
                "name": name,
                "plant": text,
                "controller": {k: float(v) for k, v in settings.items()},
                "horizon": horizon,
                "setpoint": metrics(y, u, 1, limit(mul(pn, cn), closed), horizon),
                "load": metrics(yd, ud, 0, limit(mul(pn, cd), closed), horizon),
            }
        )
        print(name, flush=True)
    save("step_metrics", __doc__.strip(), out)


if __name__ == "__main__":
    main()
