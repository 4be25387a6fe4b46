"""The loop around a goal that says what it is told to, against what has to come of it, in order."""

import io
from collections.abc import Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import cast

import pytest

from hardware.description.errors import ConfigurationError
from hardware.description.kinds import Motion, RunKind
from hardware.description.setpoint import SetPoint
from pmm.plan.run_plan import RunPlan
from pmm.run.operator import OperatorAnswers
from pmm.run.session import RunJob
from pmm.sequential.approval import approval_of
from pmm.sequential.course import CampaignCourse
from pmm.sequential.look import (
    DECISIONS,
    Ending,
    KnownTarget,
    Look,
    keep_decision,
    read_decisions,
)

ONE = RunPlan("", RunKind.OSCILLATION, Motion.HEAVE, SetPoint(1.0, 0.01), periods=4)
FIRST = Look((), 0.0, (), proposed=(ONE,), left_s=10.0, remark="the first plan")
KEPT = Look(("a",), 10.0, (), kept_runs=(ONE,), left_s=10.0)
LAST = Look(("a", "b"), 20.0, (KnownTarget("Z_w", "N s/m", 1.0, 0.1, 0.2),), ending=Ending.MET)


class Scripted:
    """A goal with a list of looks; it notes what it was asked, and what was kept by then."""

    def __init__(self, folder: Path, looks: Sequence[Look], wait: Event | None = None) -> None:
        self.folder, self.looks, self.wait = folder, list(looks), wait
        self.planned: list[int] = []

    def look(self) -> Look:
        if self.wait is not None:
            assert self.wait.wait(10.0)
        return self.looks.pop(0)

    def plan(self, look: Look) -> tuple[str, ...]:
        self.planned.append(len(read_decisions(self.folder)))
        return () if look.ending else ("next",)


def _course(
    goal: Scripted, typed: str, approve: str | None = None, executor: Executor | None = None
) -> CampaignCourse:
    def opened(names: Sequence[str]) -> RunJob:
        return cast("RunJob", tuple(names))

    answers = OperatorAnswers(io.StringIO(typed))
    approval = approval_of(approve, simulated=True)
    return CampaignCourse(goal, goal.folder, approval, answers, lambda _: None, opened, executor)


def _jobs(course: CampaignCourse) -> list[object]:
    return [job for job in course.jobs() if job is not None]


def test_a_change_is_asked_for_once_and_what_stays_is_not(tmp_path: Path) -> None:
    goal = Scripted(tmp_path, [FIRST, KEPT, LAST])
    course = _course(goal, "what?\n\nY\n")
    assert _jobs(course) == [("next",), ("next",)]
    assert [one.approved for one in read_decisions(tmp_path)] == ["the operator", "", ""]
    assert course.ended is not None
    assert course.ended.ending == "all targets are met"
    assert goal.planned == [1, 2, 3]  # a decision is kept before the plan is written


def test_a_no_ends_it_and_writes_no_plan(tmp_path: Path) -> None:
    goal = Scripted(tmp_path, [FIRST])
    course = _course(goal, "n\n")
    assert _jobs(course) == []
    assert goal.planned == []
    assert course.ended is not None
    assert course.ended.ending == "the operator did not approve"


def test_the_plan_stays_as_it_was_on_demand(tmp_path: Path) -> None:
    other = Look(("a",), 10.0, (), proposed=(ONE, ONE), left_s=20.0, before=(ONE,), before_s=9.0)
    goal = Scripted(tmp_path, [FIRST, other, LAST])
    assert _jobs(_course(goal, "k\ny\nk\n")) == [("next",), ("next",)]  # no k at the first plan
    kept = read_decisions(tmp_path)[1]
    assert (kept.added, len(kept.kept), kept.left_s) == ((), 1, 9.0)
    assert kept.approved == "the operator"


def test_runs_are_left_out_and_put_in_another_order(tmp_path: Path) -> None:
    two, three = (replace(ONE, periods=n) for n in (2, 3))
    offer = Look((), 0.0, (), proposed=(ONE, two, three), costs_s=(9.0, 5.0, 7.0), left_s=21.0)
    goal = Scripted(tmp_path, [offer, LAST])
    # A number that is not offered, and one that stands twice, are asked for again.
    typed = "y 4\ny 1 1\ny1\ny -1\ny 1 x\nyellow\ny 3, 1\n"
    assert _jobs(_course(goal, typed)) == [("next",)]
    (decided,) = [one for one in read_decisions(tmp_path) if one.added]
    assert [one.rpartition(", ")[2] for one in decided.added] == ["3 periods", "4 periods"]
    assert decided.left_s == 16.0


def test_what_was_proposed_is_kept_before_it_is_answered(tmp_path: Path) -> None:
    course = _course(Scripted(tmp_path, [KEPT, FIRST]), "")
    assert next(course.jobs()) == ("next",)
    course = _course(Scripted(tmp_path, [replace(FIRST, runs=("a", "b"))]), "")
    assert next(course.jobs()) is None
    waiting = read_decisions(tmp_path)[-1]
    assert (waiting.runs, waiting.is_decided) == (("a", "b"), False)
    assert _jobs(_course(Scripted(tmp_path, [replace(FIRST, runs=("a", "b")), LAST]), "y\n"))
    assert [one.is_decided for one in read_decisions(tmp_path)] == [True, True]


def test_who_does_not_attend_gets_no_envelope(tmp_path: Path) -> None:
    path = tmp_path / "envelope.toml"
    path.write_text(
        "minutes = 5.0\nfrequency_hz = [0.5, 2.0]\namplitude_mm = [0.0, 20.0]\n", encoding="utf-8"
    )
    goal = Scripted(tmp_path, [FIRST, LAST])
    assert _jobs(_course(goal, "n\n", str(path))) == []
    assert len(goal.looks) == 2
    assert _jobs(_course(goal, "y\n", str(path))) == [("next",)]
    assert read_decisions(tmp_path)[0].approved == "within envelope.toml"


def test_the_loop_goes_on_while_a_look_is_taken(tmp_path: Path) -> None:
    wait = Event()
    goal = Scripted(tmp_path, [FIRST, LAST], wait)
    with ThreadPoolExecutor(1) as executor:
        jobs = _course(goal, "", "all", executor).jobs()
        assert [next(jobs) for _ in range(100)] == [None] * 100
        wait.set()
        assert [job for job in jobs if job is not None] == [("next",)]


def test_what_is_decided_again_takes_the_place_of_what_was(tmp_path: Path) -> None:
    for look in (FIRST, KEPT, LAST, KEPT):
        keep_decision(tmp_path, look.decision())
    assert [len(one.runs) for one in read_decisions(tmp_path)] == [0, 1]
    assert read_decisions(tmp_path)[1] == KEPT.decision()


def test_who_is_interrupted_before_the_next_run_keeps_what_was_decided(tmp_path: Path) -> None:
    keep_decision(tmp_path, FIRST.decision("the operator"))
    keep_decision(tmp_path, Look((), 0.0, (), kept_runs=(ONE,), left_s=10.0).decision())
    assert read_decisions(tmp_path) == (FIRST.decision("the operator"),)
    ended = Look((), 0.0, (), ending=Ending.EXHAUSTED).decision()
    keep_decision(tmp_path, ended)
    keep_decision(tmp_path, FIRST.decision("all, beforehand"))
    assert read_decisions(tmp_path) == (FIRST.decision("all, beforehand"),)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"decisions": [{"runs": 3}]}'])
def test_damaged_decisions_are_said(tmp_path: Path, text: str) -> None:
    (tmp_path / DECISIONS).write_text(text, encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"decisions\.json"):
        read_decisions(tmp_path)
