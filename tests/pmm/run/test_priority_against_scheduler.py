"""The loop's priority, held against what the operating system says of its threads."""

import gc
import os
import subprocess
import sys
import threading

import pytest

from pmm.real_time import LoopScheduling, Priority, before_others, step_back
from tests.sim.devices.benches import ROOT

linux = pytest.mark.skipif(not hasattr(os, "sched_getscheduler"), reason="needs Linux's scheduler")


def _policy() -> tuple[int, int]:
    return os.sched_getscheduler(0), os.sched_getparam(0).sched_priority


@pytest.mark.slow
@linux
def test_threads_of_the_loop_go_with_it_and_all_is_as_before_afterwards() -> None:
    before, seen = _policy(), []

    def helper() -> None:
        seen.append(_policy())
        step_back()
        seen.append(_policy())

    with before_others() as found:
        if found.priority is not Priority.REAL_TIME:
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
        assert found.priority is wanted
    assert asked == ([-10, 0] if nice else [])


@pytest.mark.slow
def test_what_was_there_before_is_not_searched_for_garbage() -> None:
    before = len(gc.get_objects())
    with before_others():
        assert len(gc.get_objects()) < before / 10
    assert len(gc.get_objects()) > before / 2


@pytest.mark.parametrize(
    ("priority", "locked", "said"),
    [
        (Priority.REAL_TIME, True, []),
        (Priority.REAL_TIME, False, ["'* - memlock unlimited'"]),
        (Priority.RAISED, True, ["raised priority", "'* - rtprio 10'"]),
        (Priority.ORDINARY, False, ["ordinary priority", "rtprio 10", "memlock unlimited"]),
    ],
)
def test_what_is_not_allowed_is_said_in_a_line(
    priority: Priority, locked: bool, said: list[str]
) -> None:
    advice = LoopScheduling(priority, locked).advice
    assert bool(advice) == bool(said)
    assert all(one in advice for one in said)
    assert "\n" not in advice


LOCKING = """
import resource, sys
from pathlib import Path
from pmm.real_time import before_others
def locked_kb():
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(one.split()[1]) for one in lines if one.startswith("VmLck"))
limit = resource.RLIM_INFINITY if sys.argv[1] == "unlimited" else 1 << 20
resource.setrlimit(resource.RLIMIT_MEMLOCK, (limit, limit))
with before_others() as found:
    print(found.memory_locked, locked_kb() > 0)
print(found.memory_locked, locked_kb() > 0)
"""


@linux
@pytest.mark.parametrize(
    ("limit", "said"), [("unlimited", "True True\nTrue False"), ("little", "False False\n" * 2)]
)
def test_memory_is_locked_only_where_no_limit_could_fail_an_allocation(
    limit: str, said: str
) -> None:
    command = [sys.executable, "-c", LOCKING, limit]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if "not allowed" in done.stderr:
        pytest.skip("this user may not raise the limit of locked memory")
    assert done.stdout.strip() == said.strip(), done.stderr
