"""A disk that holds up whoever waits for it: the loop goes on, and no SYNC is lost."""

import json
import os
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path
from typing import Any

import can
import pytest

from pmm.run.states import Command, State
from tests.pmm.run.harness import Bench, bench, oscillation

SYNC_ID = 0x080
STALL_CYCLES = 300  # 3 s of a rig at 100 Hz: ten times what a drive waits for a heartbeat
_PATIENCE_S = 60.0  # of a disk that nobody releases, because the loop itself waits for it


class Disk:
    """Brings nothing to the disk while it is held."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self._free, self.waiting = threading.Event(), threading.Event()
        self.threads: set[threading.Thread] = set()
        self._free.set()
        for name in ("fsync", "fdatasync"):
            real = getattr(os, name, os.fsync)
            monkeypatch.setattr(os, name, lambda handle, real=real: self._sync(handle, real))

    def hold(self) -> None:
        self.waiting.clear()
        self._free.clear()

    def release(self) -> None:
        self._free.set()

    def _sync(self, handle: int, real: Any) -> None:
        self.threads.add(threading.current_thread())
        self.waiting.set()
        if not self._free.wait(_PATIENCE_S):
            raise OSError("nobody releases the disk: who waits for it holds up the loop")
        real(handle)


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch) -> Iterator[Disk]:
    one = Disk(monkeypatch)
    yield one
    one.release()


@pytest.fixture
def executor() -> Iterator[ThreadPoolExecutor]:
    with ThreadPoolExecutor(1) as one:
        yield one


def stalled(one: Bench, disk: Disk) -> None:
    """Step for some seconds of the rig while the disk holds up a thread."""
    assert disk.waiting.wait(_PATIENCE_S)
    before = one.rig.number
    for _ in range(STALL_CYCLES):
        one.control.step()
    assert one.rig.number == before + STALL_CYCLES
    assert one.control.fault is None


def check_whole(folder: Path) -> None:
    """Every SYNC of the bus has its sample, from the first to the last."""
    marker = json.loads((folder / "complete.json").read_text(encoding="utf-8"))
    assert (marker["outcome"], marker["missing"]) == ("complete", 0)
    with can.BLFReader(folder / "bus.blf") as reader:
        syncs = [one.timestamp for one in reader if one.arbitration_id == SYNC_ID]
    assert len(syncs) >= marker["samples"] > STALL_CYCLES
    # A sent frame bears the stamp of the last received one: before the first there is none.
    steps = {round(100.0 * (b - a)) for a, b in pairwise(syncs[1:])}
    assert steps == {1}, "a SYNC in every cycle"


@pytest.mark.slow
def test_nothing_moves_before_the_recorder_is_open_and_the_loop_goes_on(
    tmp_path: Path, disk: Disk, executor: ThreadPoolExecutor
) -> None:
    with bench(tmp_path, [oscillation()], executor=executor) as one:
        disk.hold()
        one.until(State.STARTING)
        stalled(one, disk)
        assert one.control.state is State.STARTING
        assert one.at_rest()
        disk.release()
        one.finish(within=1_000_000)
    check_whole(tmp_path / "heave")
    assert threading.main_thread() not in disk.threads


@pytest.mark.slow
def test_a_disk_that_stalls_while_the_gate_is_open_costs_no_sample(
    tmp_path: Path, disk: Disk, executor: ThreadPoolExecutor
) -> None:
    with bench(tmp_path, [oscillation(periods=8, max_periods=8)], executor=executor) as one:
        one.until(State.GATE_OPEN, within=1_000_000)
        disk.hold()
        for _ in range(100):  # a flush comes
            one.control.step()
        stalled(one, disk)
        disk.release()
        one.finish(within=1_000_000)
    check_whole(tmp_path / "heave")
    assert threading.main_thread() not in disk.threads


@pytest.mark.slow
def test_a_stop_while_the_disk_stalls_ends_the_run_when_it_can(
    tmp_path: Path, disk: Disk, executor: ThreadPoolExecutor
) -> None:
    with bench(tmp_path, [oscillation()], executor=executor) as one:
        disk.hold()
        one.until(State.STARTING)
        stalled(one, disk)
        one.control.request(Command.STOP)
        stalled(one, disk)
        assert one.control.state is State.STOPPED
        disk.release()
        one.finish(within=1_000_000)
    (outcome,) = one.control.outcomes
    assert outcome.outcome == "stopped"
    assert (tmp_path / "heave" / "run.nc").exists()


def test_a_run_for_which_there_is_no_room_moves_nothing_and_leaves_nothing(
    tmp_path: Path, executor: ThreadPoolExecutor
) -> None:
    with bench(tmp_path, [oscillation()], executor=executor, reserve_mb=1e9) as one:
        one.until(State.FAULT, within=1_000_000)
        assert one.at_rest()
        one.finish(within=1_000_000)
    (outcome,) = one.control.outcomes
    assert outcome.outcome == "fault"
    assert "make room or record to another disk" in outcome.reason
    assert "recover" not in outcome.reason, "there is nothing to recover"
    assert not (tmp_path / "heave").exists()
