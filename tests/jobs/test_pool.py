"""Workers: results and errors come back, what takes too long is ended, the others go on."""

import asyncio
import os
import pickle
import signal
import time
from collections.abc import Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

from looplab.engine.errors import NonFinite, ParseError
from looplab.jobs import Overloaded, TooSlow, WorkerPool


@pytest.fixture(scope="module")
def pool() -> Iterator[WorkerPool]:
    pool = WorkerPool(workers=2, budget=0.5, deadline=30.0, waiting=4)
    yield pool
    pool.close()


def double(values: np.ndarray) -> np.ndarray:
    return 2 * values


def process_id() -> int:
    return os.getpid()


def compute(seconds: float) -> str:
    until = time.process_time() + seconds
    while time.process_time() < until:
        pass
    return "done"


def compute_inside_lapack() -> None:
    np.linalg.svd(np.random.default_rng(0).standard_normal((3000, 3000)))


def rest(seconds: float) -> str:
    time.sleep(seconds)
    return "rested"


def fail() -> None:
    raise ParseError("no good", column=7, field="states[0].equation", hint="write it again")


def end_itself() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def finished(work: Coroutine[Any, Any, Any]) -> Any:
    """What comes of it, in a thread of its own: after page tests a loop of events runs in this one."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, work).result()


async def together(*tasks):
    return await asyncio.gather(*tasks, return_exceptions=True)


def test_a_result_comes_back(pool):
    found = finished(pool.run(double, np.arange(3.0)))
    assert found.tolist() == [0, 2, 4]
    assert finished(pool.run(process_id)) != os.getpid()


def test_an_error_comes_back_with_all_it_says(pool):
    with pytest.raises(ParseError) as caught:
        finished(pool.run(fail))
    error = caught.value
    assert (error.column, error.field, error.hint) == (7, "states[0].equation", "write it again")
    assert str(error) == "no good (column 7)"


@pytest.mark.parametrize("error", [NonFinite("bad", t=2.5, field="x"), TooSlow("slow", hint="less")])
def test_errors_survive_the_way_between_processes(error):
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert again.__dict__ == error.__dict__
    assert str(again) == str(error)


@pytest.mark.parametrize("task", [(compute, 60.0), (compute_inside_lapack,)], ids=["python", "lapack"])
def test_what_computes_too_long_is_ended_and_the_others_go_on(pool, task):
    slow, quick = finished(together(pool.run(*task), pool.run(compute, 0.05)))
    assert isinstance(slow, TooSlow)
    assert "0.5 s" in str(slow)
    assert quick == "done"
    assert finished(pool.run(compute, 0.01)) == "done"


def test_time_on_a_busy_machine_is_not_counted(pool):
    assert finished(pool.run(rest, 1.0)) == "rested"


def test_what_never_ends_is_ended_at_its_deadline():
    pool = WorkerPool(workers=1, budget=5.0, deadline=0.5)
    try:
        with pytest.raises(TooSlow):
            finished(pool.run(rest, 60.0))
        assert finished(pool.run(rest, 0.0)) == "rested"
    finally:
        pool.close()


def test_a_worker_that_dies_is_replaced(pool):
    with pytest.raises(Overloaded):
        finished(pool.run(end_itself))
    assert finished(pool.run(compute, 0.01)) == "done"


def test_more_than_can_wait_is_refused(pool):
    found = finished(together(*(pool.run(rest, 1.5) for _ in range(12))))
    assert found.count("rested") == 6
    assert sum(isinstance(each, Overloaded) for each in found) == 6


def test_workers_start_with_the_first_task_and_end_with_the_pool():
    pool = WorkerPool(workers=1)
    assert pool._pool is None
    worker = finished(pool.run(process_id))
    os.kill(worker, 0)
    pool.close()
    for _ in range(50):
        try:
            os.kill(worker, 0)
        except ProcessLookupError:
            return
        time.sleep(0.1)
    raise AssertionError("the worker outlives its pool")
