"""Pictures of plans are kept for what the frames tell of, however many were queued and ran."""

from collections import deque
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pmm.console.encoding import EncodedText
from pmm.console.limits import MOST_WAITING
from pmm.console.queued_plan import PackedPlan, QueuedPlan
from pmm.console.worker_tasks import QueuedPlans, ReadyPlan
from pmm.plan.plan import Plan
from tests.pmm.console.serving import OWN, SESSION, served

_PLAN = Plan("plan", Path(), Path(), (), "", "")


def _ready(folder: str) -> ReadyPlan:
    return ReadyPlan(
        PackedPlan(QueuedPlan(0, _PLAN, Path(folder), ()), (b"runs",)), EncodedText("{}")
    )


@pytest.mark.parametrize("seed", range(20))
def test_what_a_frame_tells_of_is_kept_and_the_rest_is_bounded(seed: int) -> None:
    """A queue that takes, begins and drops plans at random; its frames come late or not at all."""
    generator = np.random.default_rng(seed)
    queued, waiting, present, frame = QueuedPlans(), deque[int](), 0, (0,)
    for count in range(1000):
        kind = generator.choice(["queue", "begin", "drop"], p=[0.5, 0.3, 0.2])
        if kind == "queue" and len(waiting) < MOST_WAITING:
            waiting.append(queued.add(_ready(f"campaign-{count}")))
            queued.at_hand(frame)
        elif kind == "begin" and waiting:
            present = waiting.popleft()
        elif kind == "drop" and waiting:
            number = waiting[int(generator.integers(len(waiting)))]
            waiting.remove(number)
            queued.drop(number)
        if generator.random() < 0.5:
            frame = (present, *waiting)
        pictures = {int(one) for one in queued.pictures()}
        assert {*waiting, present} - {0} <= pictures
        assert all(queued.folder(one) is not None for one in waiting)
        assert len(pictures) <= 2 * (MOST_WAITING + 1)


def test_a_finished_plan_leaves_its_folder_alone() -> None:
    queued = QueuedPlans()
    for folder in ("first", "second", "first"):
        queued.add(_ready(folder))
    queued.at_hand((2, 3))
    assert list(queued.pictures()) == ["2", "3"]
    assert queued.folder(1) is None
    assert queued.folders() == [Path("first"), Path("second")]


def test_a_plan_that_is_taken_out_is_told_of_no_more(tmp_path: Path) -> None:
    with served(tmp_path) as one:
        one.post("/api/take-control", {"confirm": True})
        for _ in range(2):
            assert one.post("/api/plans/queue", {"name": "plan.toml", "text": ""})[0] == 200
        assert _told_plans(one.browser, one.stream) == ["1", "2"]
        assert one.post("/api/plans/drop", {"number": 1})[0] == 200
        assert _told_plans(one.browser, one.stream) == ["2"]


def _told_plans(browser: Any, stream: str) -> list[str]:
    """Return the numbers of the plans that a page learns of when it opens."""
    with browser.websocket_connect(f"{stream}?session={SESSION}", headers={"origin": OWN}) as one:
        return list(one.receive_json()["plans"])
