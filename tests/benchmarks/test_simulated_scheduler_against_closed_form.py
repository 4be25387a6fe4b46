"""The simulated scheduler where the answer is known without it."""

import pytest

from benchmarks.cluster import Cost, Workers, efficiency


@pytest.mark.parametrize("workers", [1, 7, 100])
def test_equal_tasks_without_any_cost_keep_all_workers_busy(workers: int) -> None:
    assert efficiency([2.0] * 10 * workers, Workers(workers), 3 * workers, Cost()) == pytest.approx(
        1.0
    )


def test_half_as_many_tasks_in_hand_as_workers_starve_half_of_them() -> None:
    assert efficiency([1.0] * 10_000, Workers(1000), 500, Cost()) == pytest.approx(0.5)


def test_one_task_in_hand_waits_for_its_way() -> None:
    """Each worker stands still while a result travels: t / (t + way)."""
    assert efficiency([1.0] * 400, Workers(4), 4, Cost(way_s=0.25)) == pytest.approx(0.8, rel=0.01)
    assert efficiency([1.0] * 400, Workers(4), 8, Cost(way_s=0.25)) == pytest.approx(1.0, rel=0.01)


def test_no_cluster_is_faster_than_tasks_are_sent() -> None:
    """1000 workers could do 1000 a second; one process that sends 100 a second keeps 100 busy."""
    assert efficiency([1.0] * 5000, Workers(1000), 3000, Cost(0.01)) == pytest.approx(0.1, rel=0.05)


def test_several_tasks_in_a_message_keep_as_many_times_more_workers_busy() -> None:
    """Twenty tasks of 1 s in a message of 10 ms, once the first have told how long they take."""
    workers = Workers(1000, round_s=20.0)
    assert efficiency([1.0] * 10**6, workers, 3000, Cost(0.01)) == pytest.approx(1.0, rel=0.02)
