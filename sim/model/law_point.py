"""Where a force law acts on the model."""

from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar

from sim.model.force_law import ForceLaw
from sim.model.laws import AnyLaw


class Point(StrEnum):
    """Where a law acts, and so which motion it depends on."""

    AFT = "aft"
    FORE = "fore"
    TRANSLATION = "translation"
    ROTATION = "rotation"
    THROUGH_WATER = "through_water"  # translation; its velocity includes U times the rotation


@dataclass(frozen=True)
class Acting:
    """A law and the point of the model at which it acts.

    Attributes
    ----------
    law
        One of :mod:`sim.model.laws` where it comes from a configuration file, else any.
    in_water
        True for a law of the water, which a run in air does not have.
    """

    law: AnyLaw | ForceLaw
    point: Point = Point.TRANSLATION
    in_water: bool = False

    __pydantic_config__: ClassVar = {"extra": "forbid", "arbitrary_types_allowed": True}
