"""A server for tests: start a command that serves looplab, wait until it answers, stop it, read its log."""

import os
import socket
import subprocess
import time
import urllib.error
import urllib.request
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

START_LIMIT = 60.0


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def environment(**changes: str) -> dict[str, str]:
    """This process's environment less what would lead a Python to other packages than its own."""
    kept = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    return kept | changes


@contextmanager
def serving(looplab: Sequence[str], folder: Path, env: Mapping[str, str]) -> Iterator[str]:
    """The address of `looplab serve`, run in `folder`; it must answer, and log no traceback.

    Parameters
    ----------
    looplab : sequence of str
        The program: `["/path/to/looplab"]` or `[python, "-m", "looplab"]`
    folder : Path
        Where it is started, and where its log goes
    env : mapping
        Its environment
    """
    log = folder / "serve.log"
    port = free_port()
    with log.open("wb") as output:
        server = subprocess.Popen(
            [*looplab, "serve", "--host", "127.0.0.1", "--port", str(port)],
            cwd=folder,
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
    url = f"http://127.0.0.1:{port}"
    try:
        _wait_until_healthy(url, server, log)
        yield url
    finally:
        server.terminate()
        try:
            server.wait(10)
        except subprocess.TimeoutExpired:
            server.kill()
            server.wait()
    text = log.read_text(errors="replace")
    assert "Traceback" not in text, f"the server logged an error:\n{text[-4000:]}"


def read(url: str) -> bytes:
    with urllib.request.urlopen(url, timeout=10) as answer:
        body: bytes = answer.read()
        return body


def _wait_until_healthy(url: str, server: subprocess.Popen[bytes], log: Path) -> None:
    deadline = time.monotonic() + START_LIMIT
    while time.monotonic() < deadline and server.poll() is None:
        try:
            read(f"{url}/api/v1/health")
            return
        except urllib.error.HTTPError as error:
            error.close()
            break
        except OSError:
            time.sleep(0.05)
    raise AssertionError(f"no healthy looplab at {url}:\n{log.read_text(errors='replace')[-4000:]}")
