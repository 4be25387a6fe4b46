"""Every engine gives what one process gives, also when a worker is killed on the way."""

import math
import multiprocessing
from collections import deque
from collections.abc import Iterator
from concurrent.futures import Executor, Future
from typing import Any

import pytest

from hardware.description.errors import ConfigurationError, DataError
from pmm.cluster import ClusterWorkers
from pmm.parallel import InThisProcess, LocalProcesses, as_done, open_executor, tasks_each
from tests.clusters import cluster
from tests.pmm.coefficients.work import (
    always_dies,
    drawn,
    given_up,
    killed_once,
    refuses,
    refuses_four,
    squared,
    threads,
)

COUNT = 12
SQUARES = [number * number for number in range(COUNT)]


@pytest.fixture(autouse=True)
def _nothing_runs_on() -> Iterator[None]:
    yield
    assert multiprocessing.active_children() == []


def test_one_process_yields_each_result_when_it_is_there() -> None:
    seen: list[int] = []

    def noted(number: int) -> int:
        seen.append(number)
        return number

    with open_executor(jobs=1) as executor:
        results = executor.map(noted, range(3))
        assert next(results) == 0
        assert seen == [0]
        assert executor.submit(noted, 9).result() == 9
        with pytest.raises(ValueError, match="number 4"):
            executor.submit(refuses, 4).result()


@pytest.mark.slow
def test_two_processes_draw_the_same_numbers_in_the_same_order() -> None:
    with open_executor(jobs=2) as executor:
        assert list(executor.map(drawn, range(COUNT))) == [drawn(k) for k in range(COUNT)]
        assert set(executor.map(threads, range(4))) == {"1"}
        with pytest.raises(ValueError, match="number 3"):
            list(executor.map(refuses, [3]))


@pytest.mark.slow
def test_a_killed_process_costs_no_result(tmp_path) -> None:  # type: ignore[no-untyped-def]
    tasks = [(str(tmp_path), k) for k in range(COUNT)]
    with open_executor(jobs=2) as executor:
        assert list(executor.map(killed_once, tasks)) == [drawn(k) for k in range(COUNT)]
    assert (tmp_path / "killed").exists()


@pytest.mark.slow
def test_work_that_always_kills_is_given_up() -> None:
    executor = LocalProcesses(1, most_restarts=1)
    try:
        with pytest.raises(DataError, match="--jobs"):
            executor.submit(always_dies, 1).result(timeout=60)
    finally:
        executor.shutdown(cancel_futures=True)


@pytest.mark.slow
def test_what_is_left_is_not_begun_after_an_error() -> None:
    def stop_early() -> None:
        with open_executor(jobs=2) as executor:
            results = executor.map(squared, range(1000))
            assert next(results) == 0
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stop_early()


def test_in_this_process_a_task_is_done_when_its_result_is_asked_for() -> None:
    begun: list[int] = []
    with open_executor(jobs=1) as executor:
        results = as_done(executor, begun.append, range(3))
        for count in range(1, 4):
            assert next(results) is None
            assert begun == list(range(count))
        assert list(results) == []


@pytest.mark.slow
def test_no_more_tasks_than_allowed_are_in_hand() -> None:
    asked: list[int] = []

    def tasks() -> Iterator[int]:
        for number in range(COUNT):
            asked.append(number)
            yield number

    found = []
    with open_executor(jobs=2) as executor:
        for square in as_done(executor, squared, tasks(), most=3):
            found.append(square)
            assert len(asked) - len(found) < 3
    assert sorted(found) == SQUARES


class _Growing(Executor):
    """A cluster that answers its oldest task once each worker has three, and doubles halfway."""

    def __init__(self, workers: int) -> None:
        self.workers, self.begun, self.most = workers, 0, 0
        self._open: deque[tuple[Future[Any], Any]] = deque()

    def submit(self, fn, /, *args, **kwargs):  # type: ignore[no-untyped-def]
        future: Future[int] = Future()
        self.begun += 1
        self.workers *= 2 if self.begun == 3000 else 1
        self._open.append((future, fn(*args)))
        self.most = max(self.most, len(self._open))
        if len(self._open) >= 3 * self.workers or self.begun == 7000:
            while self._open:
                oldest, result = self._open.popleft()
                oldest.set_result(result)
        return future


@pytest.mark.slow
def test_tasks_in_hand_follow_the_size_of_the_cluster() -> None:
    cluster = _Growing(700)
    assert sum(1 for _ in as_done(cluster, squared, range(7000))) == 7000
    assert cluster.most == 3 * 1400


@pytest.mark.parametrize(
    ("workers", "task_s", "count"),
    [(2, 1.0, 1), (100, 2.0, 1), (1000, 1.5, 3), (1000, 0.01, 100), (1000, None, 1)],
)
def test_short_tasks_for_many_workers_go_together(
    workers: int, task_s: float | None, count: int
) -> None:
    """By hand: 4 ms a message, one to each of 1000 workers in 4 s, two tasks and two thirds."""
    many = ClusterWorkers(_Sized(workers))
    assert tasks_each(many, task_s) == count
    assert tasks_each(LocalProcesses(1), task_s) == 1


class _Sized:
    """A client of so many workers."""

    def __init__(self, workers: int) -> None:
        self._workers = workers

    def get_executor(self, *, pure: bool) -> None:
        pass

    def ncores(self) -> dict[str, int]:
        return {str(k): 1 for k in range(self._workers)}


class _Together(InThisProcess):
    """A cluster whose messages take so long that as many tasks as may go in one."""

    workers, round_s = 2, math.inf

    def __init__(self) -> None:
        self.sent: list[int] = []

    def submit(self, fn, /, *args, **kwargs):  # type: ignore[no-untyped-def]
        self.sent.append(len(args[1]))
        return super().submit(fn, *args, **kwargs)


def test_tasks_that_go_together_come_back_one_by_one_up_to_the_first_that_fails() -> None:
    executor = _Together()
    assert list(as_done(executor, squared, range(250))) == [k * k for k in range(250)]
    assert executor.sent == [1, 100, 100, 49]
    found = as_done(executor, refuses_four, range(6))
    assert [next(found) for _ in range(4)] == [0, 1, 2, 3]
    with pytest.raises(ValueError, match="number 4"):
        next(found)


@pytest.mark.slow
def test_an_error_ends_what_comes_as_it_is_done() -> None:
    with open_executor(jobs=2) as executor, pytest.raises(ValueError, match="number 3"):
        list(as_done(executor, refuses, [3]))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"jobs": 0}, "at least one"),
        ({"jobs": 2, "scheduler": "tcp://127.0.0.1:1"}, "not both"),
    ],
)
def test_impossible_engines_are_refused(options, message) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(ConfigurationError, match=message), open_executor(**options):
        pass


@pytest.mark.slow
def test_dask_gives_the_same_with_one_worker_killed(tmp_path) -> None:  # type: ignore[no-untyped-def]
    tasks = [(str(tmp_path), k) for k in range(COUNT)]
    with cluster(2) as address, open_executor(scheduler=address) as executor:
        assert list(executor.map(killed_once, tasks)) == [drawn(k) for k in range(COUNT)]
        assert sorted(as_done(executor, squared, range(COUNT), most=3)) == SQUARES
    assert (tmp_path / "killed").exists()


@pytest.mark.slow
def test_what_a_cluster_cannot_do_is_said() -> None:
    with cluster() as address:
        with (
            pytest.raises(DataError, match="cannot import elsewhere"),
            open_executor(scheduler=address, module="elsewhere"),
        ):
            pass
        with (
            pytest.raises(DataError, match="the scheduler ended"),
            open_executor(scheduler=address) as executor,
        ):
            next(as_done(executor, given_up, [address]))


def test_a_scheduler_without_workers_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pmm.cluster._TIMEOUT", "1s")
    with (
        cluster(0) as address,
        pytest.raises(DataError, match=rf"no workers there within 1s.*'dask worker {address}'"),
        open_executor(scheduler=address),
    ):
        pass


@pytest.mark.slow
def test_a_scheduler_that_is_not_there_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("pmm.cluster._TIMEOUT", "1s")
    with (
        pytest.raises(DataError, match=r"127\.0\.0\.1:9: no Dask scheduler"),
        open_executor(scheduler="tcp://127.0.0.1:9"),
    ):
        pass
