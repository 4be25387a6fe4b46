"""Loads that are known beforehand: a weight or a push on a gauge, a mass on the model."""

from dataclasses import dataclass
from enum import StrEnum


class LoadDirection(StrEnum):
    """Whether a load step was reached by adding or by taking off: it shows hysteresis."""

    UP = "up"
    DOWN = "down"


@dataclass(frozen=True, slots=True)
class LoadStep:
    """A known load on one gauge: a check weight, or about what a push by hand is.

    Attributes
    ----------
    channel
        The gauge that is loaded, by its channel's name; the others show the cross-talk.
    force_n
        The load in newtons with the channel's sign, 0 for the empty gauge.
    direction
        How the step was reached.
    """

    channel: str
    force_n: float
    direction: LoadDirection = LoadDirection.UP


@dataclass(frozen=True, slots=True)
class KnownMass:
    """A mass added to the model for a run in air.

    Attributes
    ----------
    mass_kg
        What is added.
    x_m
        Where its centre lies, forward of the midpoint between the struts.
    own_inertia_kg_m2
        About its own centre.
    """

    mass_kg: float
    x_m: float = 0.0
    own_inertia_kg_m2: float = 0.0
