"""Processor time that a gain move costs the server, against a bare POST that carries as many bytes each way.

Three servers run side by side, each a uvicorn of one worker: looplab, a bare ASGI application, a bare FastAPI route.
The same client sends each the same number of requests in turn; processor time is read from the operating system for
each server's process, so that neither the client nor waiting counts.
"""

from __future__ import annotations

import http.client
import json
import os
import socket
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

PATH = "/api/v1/loop"
ROUNDS = 4
STEPS = 2 * ROUNDS
WANT = ["verdict", "step", "bode", "nyquist", "root_locus", "poles", "margins", "metrics"]
PLANTS = {"1/(s+1)^3": (4.8, 1.8138, 0.45345, 30.0), "exp(-0.5 s)/(s+1)^3": (2.0, 2.0, 0.5, 30.0)}


def processor_seconds(pid: int) -> float | None:
    """User and system time of a process so far [s]; None where the system has no /proc."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return None
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def resident_megabytes(pid: int) -> float | None:
    """Memory a process holds now [MB]; None where the system has no /proc."""
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except OSError:
        return None
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Running:
    """A server process and one kept-open connection to it."""

    def __init__(self, arguments: list[str], **environment: str) -> None:
        self.port = _free_port()
        command = [sys.executable, "-m", *arguments, "--host", "127.0.0.1", "--port", str(self.port)]
        self.process = subprocess.Popen(
            command, env={**os.environ, **environment}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        self.connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        deadline = time.monotonic() + 60
        while True:
            try:
                self.connection.connect()
                return
            except OSError:
                if self.process.poll() is not None or time.monotonic() > deadline:
                    self.close()
                    raise RuntimeError(f"no server came up: {' '.join(command)}") from None
                time.sleep(0.05)

    def post(self, body: bytes) -> bytes:
        """The answer's body; anything but 200 is an error."""
        self.connection.request("POST", PATH, body, {"Content-Type": "application/json"})
        answer = self.connection.getresponse()
        content = answer.read()
        if answer.status != 200:
            raise RuntimeError(f"status {answer.status}: {content[:300]!r}")
        return content

    def cost(self, bodies: list[bytes]) -> float | None:
        """Processor time per request [ms], over a new connection: uvicorn closes one that was idle for 5 s."""
        self.connection.close()
        before = processor_seconds(self.process.pid)
        for body in bodies:
            self.post(body)
        after = processor_seconds(self.process.pid)
        return None if before is None or after is None else 1e3 * (after - before) / len(bodies)

    def close(self) -> None:
        """Stop the process that this object started."""
        self.connection.close()
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def _body(plant: str, Kc: float, have: dict[str, str]) -> bytes:
    _, tau_I, tau_D, horizon = PLANTS[plant]
    controller = {"type": "pid", "form": "ideal", "Kc": Kc, "tau_I": tau_I, "tau_D": tau_D, "alpha": 0.1}
    loop = {"plant": {"type": "expr", "text": plant}, "controller": controller}
    request = {"loop": loop, "want": WANT, "have": have, "horizon": horizon, "points": 500, "arrays": "f4"}
    return json.dumps(request, separators=(",", ":")).encode()


def _compare(plant: str, requests: int, tick: Callable[[str], None]) -> dict[str, Any]:
    Kc = PLANTS[plant][0]
    ours = Running(["looplab", "serve"])
    others: dict[str, Running] = {}
    try:
        first = json.loads(ours.post(_body(plant, Kc, {})))
        # As the page does: the locus is held already, a moved gain does not change it.
        have = {name: panel["key"] for name, panel in first["panels"].items() if name == "root_locus"}
        answer = ours.post(_body(plant, 0.99 * Kc, have))
        size = {"LOOPLAB_BENCH_BYTES": str(len(answer))}
        others = {
            "bare_asgi": Running(["uvicorn", "looplab.bench.bare_server:app", "--log-level", "warning"], **size),
            "bare_fastapi": Running(["uvicorn", "looplab.bench.fastapi_server:app", "--log-level", "warning"], **size),
        }
        everyone = {"looplab": ours, **others}
        cost: dict[str, list[float]] = {name: [] for name in everyone}
        gains = iter(np.linspace(0.5 * Kc, 0.98 * Kc, (ROUNDS + 1) * requests))
        for turn in range(ROUNDS + 1):
            bodies = [_body(plant, float(next(gains)), have) for _ in range(requests if turn else requests // 4)]
            for name, running in everyone.items():
                spent = running.cost(bodies)
                if spent is not None and turn:  # the first turn warms up
                    cost[name].append(spent)
            if turn:
                tick(f"server: {plant}")
        if not cost["looplab"]:
            return {"plant": plant, "reason": "the system does not tell the processor time of another process"}
        middle = {name: statistics.median(values) for name, values in cost.items()}
        return {
            "plant": plant,
            "request_bytes": len(bodies[0]),
            "answer_bytes": len(answer),
            "requests": ROUNDS * requests,
            "cpu_ms": middle,
            "cpu_ms_each_round": cost,
            "ratio_to_bare_asgi": middle["looplab"] / middle["bare_asgi"],
            "ratio_to_bare_fastapi": middle["looplab"] / middle["bare_fastapi"],
            "worker_MB": resident_megabytes(ours.process.pid),
        }
    finally:
        for running in (ours, *others.values()):
            running.close()


def measure(requests: int, tick: Callable[[str], None]) -> list[dict[str, Any]]:
    """Processor time per request of the three servers, for a loop without and one with dead time."""
    return [_compare(plant, requests, tick) for plant in PLANTS]
