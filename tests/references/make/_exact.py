"""What the reference scripts share: exact polynomials, PID as a ratio of polynomials, and the JSON writer.

Polynomials are lists of Fraction, lowest power first.
"""

import json
from fractions import Fraction
from pathlib import Path

from mpmath import mp, mpf

HERE = Path(__file__).resolve().parent
OUT = HERE.parent


def poly(*highest_first):
    """Coefficients as one writes them, highest power first: poly(1, "0.5") is s + 1/2."""
    return [Fraction(str(c)) for c in reversed(highest_first)]


def mul(*factors):
    out = [Fraction(1)]
    for f in factors:
        new = [Fraction(0)] * (len(out) + len(f) - 1)
        for i, a in enumerate(out):
            for j, b in enumerate(f):
                new[i + j] += a * b
        out = new
    return out


def power(f, n):
    return mul(*[f] * n)


def add(a, b):
    n = max(len(a), len(b))
    out = [(a[i] if i < len(a) else Fraction(0)) + (b[i] if i < len(b) else Fraction(0)) for i in range(n)]
    while len(out) > 1 and out[-1] == 0:
        out.pop()
    return out


def pid(Kc, tau_I=None, tau_D=None, alpha="0.1", form="ideal"):
    """(num, den) of Kc (1 + 1/(tau_I s) + tau_D s/(alpha tau_D s + 1)), or of the series form
    Kc (1 + 1/(tau_I s)) (tau_D s + 1)/(alpha tau_D s + 1)."""
    Kc = Fraction(str(Kc))
    s, one = poly(1, 0), poly(1)
    d = poly(1)
    I_num, I_den = (poly(tau_I, 1), poly(tau_I, 0)) if tau_I is not None else (one, one)
    if tau_D is not None:
        tau_D, alpha = Fraction(str(tau_D)), Fraction(str(alpha))
        d = [Fraction(1), alpha * tau_D]
        if form == "series":
            return mul([Kc], I_num, [Fraction(1), tau_D]), mul(I_den, d)
        return mul([Kc], add(mul(I_num, d), mul(I_den, mul([tau_D], s)))), mul(I_den, d)
    return mul([Kc], I_num), I_den


def to_mp(p):
    return [mpf(c.numerator) / c.denominator for c in p]


def value(p, s):
    """p(s) by Horner."""
    out = mp.zero
    for c in reversed(p):
        out = out * s + (mpf(c.numerator) / c.denominator if isinstance(c, Fraction) else c)
    return out


def save(name, method, cases, **more):
    """Write ../<name>.json; every number is the double nearest to the computed value."""
    path = OUT / f"{name}.json"
    doc = {"made_by": f"make/{name}.py", "method": method, **more, "cases": cases}
    path.write_text(json.dumps(doc, indent=1, allow_nan=False, default=float) + "\n")
    print(f"{path.name}: {len(cases)} cases, {path.stat().st_size} bytes")
