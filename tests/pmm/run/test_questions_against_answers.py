"""What people were asked for is so when they have said so, and not before."""

import math

import pytest

from hardware.demand import Demand
from hardware.description.oscillator import VERTICAL_1963
from hardware.errors import NotAtRestError
from pmm.run.questions import Questions
from pmm.run.states import Command, State
from pmm.run.surroundings import Surroundings
from tests.pmm.run.harness import bench, oscillation

RUN = oscillation(medium="air")
IN_AIR = "medium: bring the model into air; press Enter"


class Operator:
    """Answers as many demands as it is allowed to."""

    def __init__(self, answers: int) -> None:
        self.left, self.done = answers, list[str]()

    def prompt(self, _: Demand) -> str | None:
        self.left -= 1
        return "" if self.left >= 0 else None

    def answered(self, demand: Demand, _: str) -> None:
        self.done.append(str(demand))

    def questions(self) -> Questions:
        return Questions(self.prompt, self.answered)


def test_what_is_withdrawn_is_asked_for_again() -> None:
    around, operator = Surroundings(), Operator(0)
    questions = operator.questions()
    questions.ask(around.before(RUN, VERTICAL_1963))
    assert not questions.ask_on()
    assert (questions.present, around.medium) == (IN_AIR, "water")
    questions.withdraw()
    assert questions.present == ""
    assert questions.ask_on()
    operator.left = 9
    questions.ask(around.before(RUN, VERTICAL_1963))
    assert questions.ask_on()
    assert (operator.done, around.medium) == ([IN_AIR], "air")
    questions.ask(around.before(RUN, VERTICAL_1963))
    assert questions.present == ""


def test_demands_come_in_turn_and_what_is_answered_stays_when_the_rest_is_withdrawn() -> None:
    around, operator = Surroundings(), Operator(1)
    questions = operator.questions()
    questions.ask(around.before(RUN, VERTICAL_1963))
    questions.ask(around.tow(1.2))
    assert not questions.ask_on()
    assert questions.present.startswith("carriage: tow at 1.2 m/s")
    questions.withdraw()
    assert around.medium == "air"
    assert math.isnan(around.carriage_speed_m_s)  # it may have begun to run


def test_a_carriage_that_people_drove_is_not_believed_after_a_stop() -> None:
    around = Surroundings()
    assert not around.forget_carriage()  # it stood, and stands
    assert list(around.tow(0.0)) == []
    assert len(list(around.tow(1.0))) == 1
    assert list(around.tow(1.0)) == []
    assert around.forget_carriage()
    assert math.isnan(around.carriage_speed_m_s)
    assert len(list(around.tow(1.0))) == 1


STOPS = {
    "asked to quick-stop": lambda control: control.request(Command.QUICK_STOP),
    "in a fault": lambda control: control.fail(NotAtRestError("shaft", "moves")),
}


@pytest.mark.parametrize("state", [State.STARTING, State.ARMED])
@pytest.mark.parametrize("way", STOPS)
def test_people_who_drive_the_carriage_are_told_to_stop_it(
    tmp_path, way: str, state: State
) -> None:
    """From when they are asked to run it up, whether they have answered or not."""

    def people(question: str) -> str | None:
        return None if state is State.STARTING and "tow" in question else ""

    with bench(tmp_path, [oscillation(speed_m_s=1.0)], prompt=people) as one:
        one.until(state)
        for _ in range(3):
            one.control.step()
        STOPS[way](one.control)
        one.finish()
        told = [said for said in one.control.status().alarms if said.startswith("carriage")]
        assert told == ["carriage: stop it now; people drive it and nothing else does"]


@pytest.mark.parametrize("way", STOPS)
def test_nobody_is_told_to_stop_a_carriage_that_stands(tmp_path, way: str) -> None:
    with bench(tmp_path, [oscillation()]) as one:
        one.until(State.ARMED)
        STOPS[way](one.control)
        one.finish()
        assert not [said for said in one.control.status().alarms if "carriage" in said]
