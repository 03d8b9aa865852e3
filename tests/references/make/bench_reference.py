"""Copies two loops of ../delayed_loops.json to where the installed package's benchmark finds them."""

import json
from fractions import Fraction

from _exact import OUT

NAMES = ("fopdt_PI_cohen_coon", "fopdt_PID_cohen_coon")
TARGET = OUT.parents[1] / "server" / "looplab" / "bench" / "reference.json"


def main():
    source = json.loads((OUT / "delayed_loops.json").read_text())
    cases = []
    for case in source["cases"]:
        if case["name"] in NAMES:
            sides = {side: {k: case[side][k] for k in ("y", "u")} for side in ("setpoint", "load")}
            name = "exp(-0.1 s)/(0.5 s + 1), " + case["name"].split("_")[1]
            cases.append(
                {
                    "name": name,
                    "tau": 0.5,
                    "theta": case["theta"],
                    "controller": case["controller"],
                    "t": case["t"],
                    "subdivide": Fraction(case["step"]).numerator,
                    **sides,
                }
            )
    document = {"made_by": "tests/references/make/bench_reference.py", "method": source["method"], "cases": cases}
    TARGET.write_text(json.dumps(document) + "\n")
    print(TARGET, len(cases))


if __name__ == "__main__":
    main()
