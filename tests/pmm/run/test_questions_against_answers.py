"""What people were asked for is so when they have said so, and not before."""

import math

from hardware.demand import Demand
from hardware.description.oscillator import VERTICAL_1963
from pmm.run.questions import Questions
from pmm.run.surroundings import Surroundings
from tests.pmm.run.harness import oscillation

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
    assert (around.medium, around.carriage_speed_m_s) == ("air", 0.0)


def test_a_carriage_that_people_drove_is_not_believed_after_a_stop() -> None:
    around = Surroundings()
    around.forget_carriage()  # it stood, and stands
    assert list(around.tow(0.0)) == []
    assert len(list(around.tow(1.0))) == 1
    assert list(around.tow(1.0)) == []
    around.forget_carriage()
    assert math.isnan(around.carriage_speed_m_s)
    assert len(list(around.tow(1.0))) == 1
