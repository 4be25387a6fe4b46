"""A campaign that plans itself under the console: stopped, failed, taken out, against its rest."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from pmm.console.messages import CampaignLook, LoopOrder, OrderKind, Reply
from pmm.console.queued_plan import QueuedPlan
from pmm.plan.plan import Plan
from pmm.run.states import State
from pmm.sequential.look import read_decisions
from sim.devices.faults import inject
from tests.pmm.console.test_station_against_runs import Shown, _shown
from tests.pmm.sequential.campaigns import written

HULL = "[believed]\nZ_wdot = -75.0\nZ_w = -190.0\nM_qdot = -22.0\nM_q = -55.0\n"


@pytest.fixture
def shown(tmp_path: Path) -> Iterator[Shown]:
    """A station of which a design is queued, its first plan proposed."""
    (tmp_path / "design").mkdir()
    written(tmp_path / "design", more=HULL)
    with _shown(tmp_path) as one:
        _queue(one, 1)
        yield one
        if one.station.control.state is State.SETTLING:
            _stop(one)


def _queue(one: Shown, number: int) -> None:
    files = [one.bench.folder / "design" / name for name in ("design.toml", "rig.toml")]
    plan = Plan("heave-pitch", *files, (), "", "0" * 64)
    queued = QueuedPlan(number, plan, one.bench.folder / "made", (), chooses=True)
    assert one.order(OrderKind.QUEUE, "0", plan=queued).carried_out


def _asked(one: Shown, within: int = 6000) -> str:
    """Step until something is asked, and return it."""
    for _ in range(within):
        one.station.step()
        if question := one.station._answers.question:
            return str(question)
    raise AssertionError(f"{one.station.control.state}: {one.heard.notices('alarm')}")


def _stop(one: Shown) -> None:
    assert one.order(OrderKind.COMMAND, "stop").carried_out
    one.until(State.STOPPED)


def _answer(one: Shown, answer: str) -> None:
    question = _asked(one)
    one.heard.waiting.append(
        LoopOrder(next(one.numbers), OrderKind.ANSWER, answer, question, None, 0)
    )
    one.station.step()
    assert [reply for reply in one.heard.told if isinstance(reply, Reply)][-1].carried_out


def _settings(one: Shown) -> list[str]:
    """Return the plan's runs as the folder has them, and what was decided."""
    folder = one.bench.folder / "made"
    return [(folder / "plan.toml").read_text(), *map(str, read_decisions(folder))]


@pytest.mark.slow
def test_a_stop_ends_at_rest_and_goes_on_only_when_told(shown: Shown) -> None:
    _answer(shown, "y")
    shown.until(State.SETTLING)
    _stop(shown)
    before = _settings(shown)
    assert _asked(shown) == "The campaign was stopped. Go on with it? y: yes"
    assert shown.bench.at_rest()
    _answer(shown, "n")
    for _ in range(50):
        shown.station.step()
    assert shown.station.control.state is State.STOPPED
    assert _settings(shown) == before
    _answer(shown, "y")
    shown.until(State.SETTLING)


@pytest.mark.slow
def test_taken_out_it_leaves_the_rig_and_its_folder_as_they_are(shown: Shown) -> None:
    _answer(shown, "y")
    shown.until(State.SETTLING)
    refused = shown.order(OrderKind.DROP, "1")
    assert refused.text == "heave-pitch is under way; stop it first"
    _stop(shown)
    while not shown.station.at_rest:
        shown.station.step()
    before = _settings(shown)
    assert shown.order(OrderKind.DROP, "1").text == "heave-pitch is taken out"
    for _ in range(50):
        shown.station.step()
    assert (shown.station._answers.question, shown.bench.at_rest()) == ("", True)
    assert _settings(shown) == before
    # Queued again it stands where it was, and moves nothing by that alone.
    _queue(shown, 2)
    assert _asked(shown) == "Begin with the runs that are planned? y: yes"
    assert shown.bench.at_rest()
    assert _settings(shown) == before
    _answer(shown, "y")
    shown.until(State.SETTLING)


def test_taken_out_while_it_asks_it_has_planned_nothing(shown: Shown) -> None:
    assert _asked(shown).startswith("Approve of these runs?")
    assert shown.order(OrderKind.DROP, "1").carried_out
    for _ in range(50):
        shown.station.step()
    assert shown.station._answers.question == ""
    assert not (shown.bench.folder / "made" / "plan.toml").exists()
    _queue(shown, 2)
    looks = [one.look for one in shown.heard.told if isinstance(one, CampaignLook)]
    assert _asked(shown).startswith("Approve of these runs?")
    assert looks[0].proposed


@pytest.mark.slow
def test_a_fault_of_the_rig_is_said_and_the_campaign_stands_where_it_was(shown: Shown) -> None:
    _answer(shown, "y")
    shown.until(State.SETTLING)
    before = _settings(shown)
    inject(shown.bench.world, "heartbeat phase")
    shown.until(State.FAULT)
    alarms = shown.heard.notices("alarm")
    assert len(alarms) == 1, alarms
    assert "\n" not in alarms[0]
    for _ in range(500):
        shown.station.step()
    assert _settings(shown) == before


@pytest.mark.slow
def test_a_run_that_is_left_for_the_next_is_made_again_where_it_is_still_due(shown: Shown) -> None:
    _answer(shown, "y")
    made = []
    for _ in range(3):  # a zero run, the run that it is for, and again
        shown.until(State.SETTLING)
        made.append(shown.station.control.status().run)
        if len(made) < 3:
            assert shown.order(OrderKind.COMMAND, "next").carried_out
            shown.until(State.DONE)
    assert made[2] == made[0] != made[1]
    assert shown.heard.notices("alarm") == []
