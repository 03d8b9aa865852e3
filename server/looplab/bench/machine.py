"""What the figures were measured on."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from looplab import __version__

PACKAGES = ("control", "numpy", "scipy", "uvicorn", "fastapi")
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def describe() -> dict[str, Any]:
    """Interpreter, packages, cores and the BLAS threads in force."""
    return {
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "cores": os.cpu_count(),
        "packages": {"looplab": __version__, **{name: _version(name) for name in PACKAGES}},
        "blas_threads": {name: os.environ.get(name, "not set") for name in THREADS},
    }
