"""What ``analysis.threads`` promises: how many threads, results in order, an end when it fails."""

import os
import threading

import pytest

from analysis.threads import SETTING, spread, thread_count
from hardware.description.errors import ConfigurationError
from pmm.parallel import one_thread


@pytest.mark.parametrize(
    ("stated", "count"), [("1", 1), (" 3 ", 3), ("4,2", 4), ("", 6), (None, 6)]
)
def test_the_setting_of_numerical_libraries_counts(
    stated: str | None, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As OpenMP reads it; the first number of a list is that of the outermost level."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(6)), raising=False)
    if stated is None:
        monkeypatch.delenv(SETTING, raising=False)
    else:
        monkeypatch.setenv(SETTING, stated)
    assert thread_count() == count


@pytest.mark.parametrize("stated", ["0", "-2", "two", "1.5", ",", "²"])
def test_a_setting_that_is_no_number_is_refused(
    stated: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(SETTING, stated)
    with pytest.raises(ConfigurationError, match=f"{SETTING} = .*whole number above 0; unset it"):
        thread_count()


@pytest.mark.parametrize(("stated", "count"), [(None, 1), ("3", 3)])
def test_a_worker_process_takes_one_thread_unless_told_otherwise(
    stated: str | None, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", SETTING):
        monkeypatch.setenv(name, "" if stated is None else stated)
        if stated is None:
            monkeypatch.delenv(name)
    one_thread()
    assert thread_count() == count


@pytest.mark.parametrize("threads", [1, 2, 7])
def test_results_come_in_the_tasks_order(threads: int) -> None:
    """Though the first task ends after the second, where there are two threads."""
    second_done = threading.Event()

    def work(task: int) -> int:
        if threads > 1 and task == 0:
            assert second_done.wait(10.0)
        if task == 1:
            second_done.set()
        return task**2

    assert spread(work, range(20), threads) == [task**2 for task in range(20)]


def test_one_task_stays_in_the_calling_thread() -> None:
    assert spread(lambda _: threading.get_ident(), [0], 8) == [threading.get_ident()]


def test_after_an_error_what_was_not_begun_is_not_done() -> None:
    begun = []
    lock = threading.Event()

    def work(task: int) -> None:
        begun.append(task)
        if task == 0:
            lock.set()
            raise ValueError("the first one fails")
        assert lock.wait(10.0)

    with pytest.raises(ValueError, match="the first one fails"):
        spread(work, range(10_000), 2)
    assert len(begun) < 10_000
