"""Print the lock: what this environment has, with a marker where a package is not for every system."""

import re
import sys
from importlib import metadata

# Asked for on one system only; pip reads the whole file on all of them.
MARKERS = {"uvloop": "sys_platform != 'win32'", "colorama": "sys_platform == 'win32'"}
# What a Unix environment cannot show: Windows' own needs.
ELSEWHERE = {"colorama": "0.4.6"}
NOT_LOCKED = {"looplab", "pip", "setuptools", "wheel"}

HEADER = """\
# The versions looplab is tested with, test tools included: pip install -c requirements.lock .
# Written by `make lock`. Versions only: no hashes and no addresses, so that any index serves them.
"""


def main() -> None:
    found = {re.sub(r"[-_.]+", "-", d.name).lower(): d.version for d in metadata.distributions()}
    lines = []
    for name, version in sorted({**found, **ELSEWHERE}.items()):
        if name not in NOT_LOCKED:
            marker = f" ; {MARKERS[name]}" if name in MARKERS else ""
            lines.append(f"{name}=={version}{marker}\n")
    sys.stdout.write(HEADER + "".join(lines))


if __name__ == "__main__":
    main()
