"""Exact step responses of loops with several dead times: the method of steps with Taylor polynomials at 60 digits.

A loop is a list of blocks num/den exp(-theta s) and sums. Time is cut into equal pieces of which every dead time is a
whole number; on each piece every signal is a polynomial in local time. What leaves a dead time is the stored polynomial
of that many pieces before, so each piece follows from earlier ones, block after block (`Block` of delayed_loops.py).
Terms are added until the next would be below 1e-55. Values at a jump are those just after it.
"""

from collections import deque
from fractions import Fraction
from math import ceil, gcd

from _exact import add, mul, pid, poly, save
from delayed_loops import Block, at
from mpmath import mp, mpf

mp.dps = 60
SAMPLES = 60


def block(name, inputs, num, den, theta="0"):
    """``inputs``: {signal: sign}; a signal is the name of a block, "r" or "d"."""
    return dict(name=name, inputs=inputs, num=num, den=den, theta=Fraction(theta))


def lag(gain, tau):
    return [Fraction(gain)], poly(tau, 1)


def feedback_loop(name, C, P, A=None, H=None, G=None, why="", horizon="20"):
    """Each of them (num, den, theta) or None; signals as in the engine: y, u, y_m."""
    one = ([Fraction(1)], [Fraction(1)], "0")
    A, H = A or one, H or one
    load = {"A": 1, "d": 1} if G is None else {"A": 1}
    blocks = [block("C", {"r": 1, "H": -1}, *C), block("A", {"C": 1}, *A), block("P", load, *P)]
    y = {"P": 1}
    if G is not None:
        blocks.append(block("G", {"d": 1}, *G))
        y = {"P": 1, "G": 1}
    blocks.append(block("H", y, *H))
    return dict(name=name, why=why, blocks=blocks, outputs={"y": y, "u": {"C": 1}, "y_m": {"H": 1}}, horizon=horizon)


def smith(name, C, ahead, theta_m, P, why="", horizon="20"):
    """u = C (r - y - (1 - exp(-theta_m s)) G u), the loop without dead time closed: u = C/(1 + C G) (r - y + late)."""
    (num, den), (num_G, den_G) = C, ahead
    inner = mul(num, den_G), add(mul(den, den_G), mul(num, num_G))
    blocks = [
        block("C", {"r": 1, "P": -1, "late": 1}, *inner),
        block("P", {"C": 1, "d": 1}, *P),
        block("late", {"C": 1}, *ahead, theta_m),
    ]
    return dict(name=name, why=why, blocks=blocks, outputs={"y": {"P": 1}, "u": {"C": 1}}, horizon=horizon)


PI = pid("1.2", "2.5")
CASES = [
    feedback_loop(
        "valve_and_sensor",
        (*PI, "0"),
        ([Fraction(1)], mul(poly(1, 1), poly(1, 1)), "1/2"),
        A=(*lag(1, "0.3"), "1/10"),
        H=(*lag(1, "0.1"), "1/4"),
    ),
    feedback_loop(
        "late_controller_and_disturbance",
        (*PI, "1/5"),
        (*lag(1, 1), "3/10"),
        G=(*lag(2, 3), "1/10"),
        why="the load comes earlier than the plant answers",
    ),
    feedback_loop(
        "sensor_without_dynamics",
        (*pid("0.8", "1.5"), "0"),
        ([Fraction(1)], mul(poly(1, 1), poly("0.5", 1)), "0"),
        H=([Fraction("1.25")], [Fraction(1)], "2/5"),
        why="gain of the sensor 1.25: y rests at 0.8",
    ),
    feedback_loop(
        "neutral",
        (*pid("0.3", "2"), "0"),
        (poly(2, 1), poly(1, 1), "2/5"),
        A=([Fraction(1)], [Fraction(1)], "3/5"),
        H=([Fraction(1)], [Fraction(1)], "1/4"),
        why="biproper: y, u and y_m jump again and again",
    ),
    feedback_loop(
        "unstable",
        (*pid("4"), "1/8"),
        ([Fraction(1)], mul(poly(1, 1), poly(1, 1)), "1/2"),
        A=(*lag(1, "0.2"), "1/4"),
        why="a growing oscillation",
    ),
    smith("smith_exact", pid("2", "1"), lag(1, 1), "1", (*lag(1, 1), "1")),
    smith("smith_mismatch", pid("2", "1"), lag(1, 1), "1", (*lag("1.1", "0.8"), "1.3")),
    smith("smith_late_model", pid("1", "1"), lag(1, 1), "1.5", (*lag("0.9", "1"), "1.1"), horizon="30"),
    smith("smith_biproper", pid("0.5", "2"), (poly(1, 2), poly(1, 1)), "1", (poly(1, "2.1"), poly(1, 1), "1.2")),
]


def added(signals, inputs, terms):
    out = [mp.zero] * terms
    for name, sign in inputs.items():
        out = [a + sign * b for a, b in zip(out, signals[name], strict=True)]
    return out


def respond(case, entry):
    """Samples of every output for a unit step of "r" or "d"."""
    horizon = Fraction(case["horizon"])
    times = [horizon * i / SAMPLES for i in range(SAMPLES + 1)]
    blocks = {b["name"]: Block(b["num"], b["den"]) for b in case["blocks"]}
    delays = [b["theta"] for b in case["blocks"] if b["theta"]]
    rate = max([b.rate for b in blocks.values()] + [1.0]) * 2
    base = Fraction(gcd(*(int(d * 1000) for d in delays)), 1000)
    assert all((d / base).denominator == 1 for d in delays)
    h = base / max(1, ceil(float(base) * rate))
    hm = mpf(h.numerator) / h.denominator
    terms, bound = 4, mpf(rate * float(h)) ** 4 / 24
    while bound > mpf(10) ** -55:
        terms += 1
        bound *= mpf(rate * float(h)) / terms
    terms += 8
    zero, step = [mp.zero] * terms, [mp.one] + [mp.zero] * (terms - 1)
    lines = {b["name"]: deque([zero] * int(b["theta"] / h)) for b in case["blocks"] if b["theta"]}
    rows = {name: [] for name in case["outputs"]}
    piece, done = 0, 0
    while done < len(times):
        signals = {"r": zero, "d": zero, entry: step}
        signals |= {name: line.popleft() for name, line in lines.items()}
        waiting = list(case["blocks"])
        raw = {}
        while waiting:
            ready = next(b for b in waiting if all(name in signals for name in b["inputs"]))
            waiting.remove(ready)
            raw[ready["name"]] = blocks[ready["name"]].run(added(signals, ready["inputs"], terms), hm)
            signals.setdefault(ready["name"], raw[ready["name"]])
        for name, line in lines.items():
            line.append(raw[name])
        while done < len(times) and times[done] < (piece + 1) * h:
            t = times[done] - piece * h
            local = mpf(t.numerator) / t.denominator
            for name, inputs in case["outputs"].items():
                rows[name].append(float(at(added(signals, inputs, terms), local)[0]))
            done += 1
        piece += 1
    return {"t": [float(t) for t in times]} | rows


def described(b):
    """Coefficients, highest power first."""
    num, den = ([float(c) for c in reversed(b[name])] for name in ("num", "den"))
    return {"num": num, "den": den, "theta": float(b["theta"])}


def main():
    out = []
    for case in CASES:
        answer = {name: case[name] for name in ("name", "why")}
        answer["blocks"] = {b["name"]: described(b) for b in case["blocks"]}
        for signal, entry in {"setpoint": "r", "load": "d"}.items():
            answer[signal] = respond(case, entry)
        out.append(answer)
        print(case["name"], flush=True)
    save("several_dead_times", __doc__.strip(), out)


if __name__ == "__main__":
    main()
