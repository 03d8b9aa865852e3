"""Exact responses of loops with dead time: the method of steps with Taylor polynomials at 60 digits.

The delay sits at the plant's output: w = P0 (u + d), y(t) = w(t - theta), u = C (r - y). theta is cut into q equal
pieces h; on each piece every signal is a polynomial in local time, the delayed input is the stored polynomial of
q pieces before, and the state's coefficients follow from x_{k+1} = (A x_k + b v_k)/(k + 1). Terms are added until the
next would be below 1e-55, so nothing is approximated but the last digits. Values at a jump are those just after it.
The samples are `step` dead times apart.
"""

import json
import sys
from collections import deque
from fractions import Fraction
from math import ceil

from _exact import OUT, save, to_mp
from delayed_cases import CASES, controller, sample_times
from mpmath import mp, mpf

mp.dps = 60


class Block:
    """num/den in controllable canonical form; feeds one input polynomial through, piece after piece."""

    def __init__(self, num, den):
        n = len(den) - 1
        lead = to_mp(den)[-1]
        self.a = [c / lead for c in to_mp(den)[:n]]
        b = [c / lead for c in to_mp(num)] + [mp.zero] * (n + 1 - len(num))
        self.d = b[n]
        self.c = [b[i] - self.a[i] * self.d for i in range(n)]
        self.x = [mp.zero] * n
        self.rate = float(max([abs(c) ** (mpf(1) / (n - i)) for i, c in enumerate(self.a)], default=mp.zero)) * 2

    def run(self, v, h):
        """Output polynomial on this piece for the input polynomial v; leaves the state at its end."""
        n, out, x = len(self.a), [], list(self.x)
        end, hk = [mp.zero] * n, mp.one
        for k, vk in enumerate(v):
            out.append(mp.fdot(self.c, x) + self.d * vk)
            end = [e + xi * hk for e, xi in zip(end, x, strict=True)]
            hk *= h
            if n:
                x = [xi / (k + 1) for xi in [*x[1:], vk - mp.fdot(self.a, x)]]
        self.x = end
        return out


def at(p, t):
    y = dy = mp.zero
    for c in reversed(p):
        dy = dy * t + y
        y = y * t + c
    return y, dy


def respond(case, r, d):
    """Samples of (y, u, dy/dt) for constant r and d switched on at t = 0."""
    plant, ctrl = Block(case["num"], case["den"]), Block(*controller(case))
    theta = Fraction(case["theta"])
    rate = max(plant.rate, ctrl.rate, 1e-3)
    q = max(1, ceil(float(theta) * rate))
    h = theta / q
    hm = mpf(h.numerator) / h.denominator
    terms, bound = 4, mpf(rate * float(h)) ** 4 / 24
    while bound > mpf(10) ** -55:
        terms += 1
        bound *= mpf(rate * float(h)) / terms
    terms += 8
    past = deque([[mp.zero] * terms] * q)
    times = sample_times(case)
    rows, piece, next_sample = [], 0, 0
    while next_sample < len(times):
        y = past.popleft()
        e = [-c for c in y]
        e[0] += r
        u = ctrl.run(e, hm)
        v = list(u)
        v[0] += d
        past.append(plant.run(v, hm))
        while next_sample < len(times) and times[next_sample] < (piece + 1) * h:
            t = times[next_sample] - piece * h
            local = mpf(t.numerator) / t.denominator
            value, slope = at(y, local)
            rows.append((value, at(u, local)[0], slope))
            next_sample += 1
        piece += 1
    return zip(*rows, strict=True)


def main(names):
    """All cases, or the named ones anew and the others as they are."""
    out, kept = [], {}
    if names:
        kept = {
            c["name"]: c
            for c in json.loads((OUT / "delayed_loops.json").read_text())["cases"]
            if c["name"] not in names
        }
    for case in CASES:
        if case["name"] in kept:
            out.append(kept[case["name"]])
            continue
        answer = {
            "name": case["name"],
            "plant": case["text"],
            "why": case["why"],
            "theta": float(case["theta"]),
            "step": case["step"],
            "t": list(map(float, sample_times(case))),
            "controller": {k: v if k == "form" else float(v) for k, v in case["controller"].items()},
        }
        for signal, (r, d) in {"setpoint": (1, 0), "load": (0, 1)}.items():
            y, u, dy = respond(case, r, d)
            answer[signal] = {"y": list(map(float, y)), "u": list(map(float, u)), "dy": list(map(float, dy))}
        out.append(answer)
        print(case["name"], flush=True)
    save("delayed_loops", __doc__.strip(), out)


if __name__ == "__main__":
    main(sys.argv[1:])
