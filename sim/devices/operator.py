"""The operator of a simulated rig: does with the simulation what a rig asks its operator for."""

import json
from collections.abc import Callable
from typing import Final

from hardware.demand import Demand
from hardware.description.lines import Line
from hardware.description.setpoint import ANGLE_KEYS, Medium
from hardware.driver import Prompt
from sim.devices.faults import inject
from sim.devices.world import World

_TURN: Final = 6.283185307179586
_BY_HAND_RAD_S2: Final = 2.0
_DIALS: Final = ("eccentricity", "phase", "shaft")


class SimulatedOperator:
    """Answers questions and does what they ask for, at once.

    Carriage, medium, angles, propeller, masses and loads need no person. A dial is read by the
    person, if there is one who answers; what was read is then where the linkage stands. Whatever
    else is to be done and confirmed is taken for done where nobody is there to confirm it.

    Parameters
    ----------
    person
        How a person is asked. A person who has no answer *yet* returns ``None``; one who will never
        have any has the attribute ``absent = True``.
    """

    def __init__(self, world: World, person: Prompt) -> None:
        self._world, self._person = world, person

    def __call__(self, question: str) -> str | None:
        """Return the answer, once there is one."""
        if not isinstance(question, Demand):
            return self._person(question)
        if question.part in _DIALS or question.part in self._world.dials:
            return self._dial(question)
        doing = _DOING.get(question.part)
        if doing is None or question.value is None:
            answer = self._person(question)
            return "" if answer is None and self._nobody else answer
        doing(self._world, question)
        return str(question.value)

    def _dial(self, question: Demand) -> str | None:
        answer = self._person(question)
        if answer is None and self._nobody:
            answer = str(self._wanted(question) * question.per_unit)
        if answer is not None:
            self._set(question, answer)
        return answer

    @property
    def _nobody(self) -> bool:
        return bool(getattr(self._person, "absent", False))

    def _wanted(self, question: Demand) -> float:
        """Return what is asked for; where something is only to be read, where it stands."""
        if question.value is not None:
            return float(question.value)
        plant = self._world.plant
        if question.part in ANGLE_KEYS:
            return float(getattr(plant.conditions, ANGLE_KEYS[question.part]))
        eccentricity_m, phase_rad = plant.linkage
        return {"eccentricity": eccentricity_m, "phase": phase_rad}.get(question.part, 0.0)

    def _set(self, question: Demand, answer: str) -> None:
        """Put the linkage where the person says that it is; words that are no number do nothing."""
        try:
            value = float(answer.strip().replace(",", ".")) / question.per_unit
        except ValueError:
            return
        plant = self._world.plant
        if question.part == "eccentricity":
            plant.set_linkage(eccentricity_m=value)
        elif question.part == "phase":
            plant.set_linkage(strut_phase_rad=value)
        elif question.part in ANGLE_KEYS:
            plant.surround(**{ANGLE_KEYS[question.part]: value})
        else:
            plant.turn(_TURN * value, _BY_HAND_RAD_S2)


def _setting(key: str) -> Callable[[World, Demand], None]:
    """Return what sets one of the plant's conditions to what is asked for."""

    def doing(world: World, question: Demand) -> None:
        world.plant.surround(**{key: float(question.value or 0.0)})

    return doing


def _tow(world: World, question: Demand) -> None:
    world.plant.surround(
        carriage_speed_m_s=float(question.value or 0.0),
        turn_rate_rad_s=question.turn_rate_rad_s,
    )


def _immerse(world: World, question: Demand) -> None:
    world.plant.surround(medium=Medium(str(question.value)))


def _load(world: World, question: Demand) -> None:
    inject(world, f"push {question.channel} {question.value}")


def _ballast(world: World, question: Demand) -> None:
    world.plant.load(float(question.value or 0.0), question.at_m)


def _wave(world: World, question: Demand) -> None:
    world.plant.surround(**json.loads(str(question.value)))


def _follow(world: World, question: Demand) -> None:
    world.plant.surround(lines=tuple(Line(**line) for line in json.loads(str(question.value))))


_DOING: Final[dict[str, Callable[[World, Demand], None]]] = {
    "carriage": _tow,
    "medium": _immerse,
    "load": _load,
    "mass": _ballast,
    "lines": _follow,
    "waves": _wave,
    "drift": _setting("drift_rad"),
    "rudder": _setting("rudder_angle_rad"),
    "propeller": _setting("revolutions_hz"),
    "heel": _setting("heel_rad"),
    "release": _setting("release_rad"),
}
