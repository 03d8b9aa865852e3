"""Shared by all tests: the repository's folder and a running `looplab serve`."""

import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from serving import environment, serving

REPOSITORY = Path(__file__).resolve().parents[1]

# The same examples on every machine, no deadline a busy one misses; --hypothesis-profile=default looks further.
settings.register_profile("looplab", deadline=None, derandomize=True, database=None)
settings.load_profile("looplab")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    # The long files first: at the end no worker waits for another. Pages take longest.
    many = Counter(item.path for item in items)
    items.sort(key=lambda item: ("browser" not in item.path.parts, -many[item.path]))


@pytest.fixture(scope="session")
def repository() -> Path:
    return REPOSITORY


@pytest.fixture(scope="session")
def server_url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a `looplab serve` started for this session from another folder than the repository."""
    program = [sys.executable, "-m", "looplab"]
    env = environment(PYTHONPATH=str(REPOSITORY / "server"))
    with serving(program, tmp_path_factory.mktemp("server"), env) as url:
        yield url
