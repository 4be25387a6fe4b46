"""The loop's priority, held against what the operating system says of its threads."""

import os
import threading

import pytest

from pmm.console.priority import Priority, before_others, step_back

linux = pytest.mark.skipif(not hasattr(os, "sched_getscheduler"), reason="needs Linux's scheduler")


def _policy() -> tuple[int, int]:
    return os.sched_getscheduler(0), os.sched_getparam(0).sched_priority


@linux
def test_threads_of_the_loop_go_with_it_and_all_is_as_before_afterwards() -> None:
    before, seen = _policy(), []

    def helper() -> None:
        seen.append(_policy())
        step_back()
        seen.append(_policy())

    with before_others() as found:
        if found is not Priority.REAL_TIME:
            pytest.skip("this user may not ask for real-time priority")
        assert _policy()[0] == os.SCHED_FIFO
        thread = threading.Thread(target=helper)
        thread.start()
        thread.join()
        raised = _policy()
    assert seen == [raised, (os.SCHED_FIFO, raised[1] - 1)]
    assert _policy() == before


@linux
@pytest.mark.parametrize(("nice", "wanted"), [(True, Priority.RAISED), (False, Priority.ORDINARY)])
def test_a_user_who_may_not_gets_what_there_is(
    monkeypatch: pytest.MonkeyPatch, nice: bool, wanted: Priority
) -> None:
    asked: list[int] = []

    def refuse(*_: object) -> None:
        raise PermissionError("not permitted")

    def take(_which: int, _who: int, value: int) -> None:
        asked.append(value)

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    monkeypatch.setattr(os, "setpriority", take if nice else refuse)
    with before_others() as found:
        assert found is wanted
    assert asked == ([-10, 0] if nice else [])
