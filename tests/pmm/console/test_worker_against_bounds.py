"""Work beside the server: what takes too long, too much memory or its own life is one sentence."""

import asyncio
import math
import operator
import os
import sys
import time
from collections.abc import Callable, Coroutine
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from pmm.console import worker_process
from pmm.console.plans import Plans
from pmm.console.queued_plan import QueuedPlan, pack, unpack
from pmm.console.worker_process import (
    BusyError,
    NotWorkedOutError,
    SharedAnswer,
    WorkerProcess,
    WorkLimits,
)
from pmm.plan.rig_file import read_rig_file
from tests.pmm.console.chromium import plan, rig_in

BOUNDS = WorkLimits(seconds=120.0, memory_bytes=1 << 30, waiting=2)


def _with(bounds: WorkLimits, act: Callable[[WorkerProcess], Coroutine[Any, Any, None]]) -> None:
    async def run() -> None:
        one = WorkerProcess("work", bounds)
        try:
            await act(one)
        finally:
            one.close()

    asyncio.run(run())


def test_it_returns_what_the_work_returns_and_raises_what_it_raises() -> None:
    async def act(one: WorkerProcess) -> None:
        first, second = await one.run(os.getpid), await one.run(os.getpid)
        assert first == second != os.getpid()
        with pytest.raises(ValueError, match="math domain error"):
            await one.run(math.sqrt, -1.0)
        assert await one.run(os.getpid) == first

    _with(BOUNDS, act)


def test_what_takes_too_long_is_ended_and_the_next_work_is_done() -> None:
    async def act(one: WorkerProcess) -> None:
        with pytest.raises(NotWorkedOutError, match="work took longer than 1 s and was ended"):
            await one.run(time.sleep, 600.0)

    _with(replace(BOUNDS, seconds=0.2), act)


def test_what_takes_too_much_of_the_processor_is_ended_and_the_next_work_is_done(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(worker_process, "BY_THE_CLOCK", 1000.0)  # however busy the machine is

    async def act(one: WorkerProcess) -> None:
        said = r"work took more than 0\.5 s of the processor and was ended"
        with pytest.raises(NotWorkedOutError, match=said):
            await one.run(eval, "any(x for x in iter(int, 1))")
        assert await one.run(math.sqrt, 4.0) == 2.0

    _with(replace(BOUNDS, seconds=0.5), act)


@pytest.mark.skipif(sys.platform != "linux", reason="others cannot limit memory")
def test_what_takes_too_much_memory_is_told_so() -> None:
    async def act(one: WorkerProcess) -> None:
        with pytest.raises(NotWorkedOutError, match="work took more than 1024 MiB of memory"):
            await one.run(operator.mul, b"x", 3 << 30)
        assert await one.run(operator.mul, b"x", 3) == b"xxx"

    _with(BOUNDS, act)


def test_what_ends_its_process_ends_no_other() -> None:
    async def act(one: WorkerProcess) -> None:
        with pytest.raises(NotWorkedOutError, match=r"work ended its process \(status 3\)"):
            await one.run(os._exit, 3)
        assert await one.run(operator.mul, 2, 3) == 6

    _with(BOUNDS, act)


def test_no_more_wait_than_may_and_closing_waits_for_none() -> None:
    async def act(one: WorkerProcess) -> None:
        asked = [asyncio.ensure_future(one.run(time.sleep, 600.0)) for _ in range(2)]
        await asyncio.sleep(0)
        with pytest.raises(BusyError, match="work: 2 wait already, which is the limit"):
            await one.run(time.sleep, 0.0)
        for future in asked:
            future.cancel()

    began_s = time.monotonic()
    _with(BOUNDS, act)
    assert time.monotonic() - began_s < 300.0


def test_those_who_ask_meanwhile_share_the_next_answer() -> None:
    async def run() -> None:
        asked = 0

        async def answer() -> int:
            nonlocal asked
            asked += 1
            await asyncio.sleep(0.01)
            return asked

        one = SharedAnswer(answer)
        first = asyncio.ensure_future(one.get())
        await asyncio.sleep(0.001)
        others = await asyncio.gather(*(one.get() for _ in range(100)))
        assert await first == 1
        assert others == [2] * 100

    asyncio.run(run())


def test_a_plan_in_pieces_is_the_plan_again(tmp_path: Path) -> None:
    rig = rig_in(tmp_path / "rig")
    one = Plans(rig, read_rig_file(rig).hashes, rig.parent, tmp_path / "out")
    text = plan("p").replace("= 1.0", f"= {[round(0.5 + 0.001 * k, 3) for k in range(120)]}")
    found = one.check("", text).waiting
    given = QueuedPlan(7, found.plan, found.folder, found.runs[::3])
    packed = pack(given)
    assert len(packed.pieces) == 3
    assert max(map(len, packed.pieces)) < 50_000
    assert unpack(packed) == given
