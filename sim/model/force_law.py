"""The interface of a force law: its inputs, and where it jumps or bends."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import ClassVar, Final, NamedTuple, Self

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim.stage import UNKNOWN_KEYS_REFUSED

# Below this speed friction builds up with the speed: at rest it has no sign of its own. It widens
# the turn of a motion with peak speed V, which takes (CREEP / V)^2 / 6 from the first harmonic.
CREEP_M_S: Final = 1e-4


class Argument(IntEnum):
    """What of a :class:`LawInput` a law may jump or bend over."""

    POSITION = 0
    VELOCITY = 1
    ACCELERATION = 2
    LOAD = 3


class Corner(NamedTuple):
    """Where a law jumps or bends: the argument passes the level, in that argument's unit."""

    argument: Argument
    level: float = 0.0


# The corners of a law that jumps where the motion turns: where friction ends to build up.
TURNS: Final = (Corner(Argument.VELOCITY, -CREEP_M_S), Corner(Argument.VELOCITY, CREEP_M_S))


@dataclass(frozen=True, eq=False)
class LawInput:
    """Inputs of a force law: one value a sample each.

    Attributes
    ----------
    position, velocity, acceleration
        At the law's point: m, or rad at :attr:`sim.model.law_point.Point.ROTATION`.
    load
        What the linear parts of the model ask of the struts at that point: N, or N m.
    time_s
        Time of each sample.
    step_s
        Time from sample to sample, over which a law that jumps is averaged; 0 at instants between
        which there are no samples.
    speed_m_s
        Carriage speed.
    """

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    load: FloatArray
    time_s: FloatArray
    step_s: float
    speed_m_s: FloatArray

    @property
    def half_change(self) -> FloatArray:
        """Half of what the velocity changes over the sample."""
        return np.hypot(self.acceleration * (self.step_s / 2.0), CREEP_M_S)

    @property
    def direction(self) -> FloatArray:
        """Sign of the velocity, averaged over the sample."""
        return np.minimum(np.maximum(self.velocity / self.half_change, -1.0), 1.0)


class ForceLaw(ABC):
    """A force that depends on the motion at once.

    Attributes
    ----------
    periodic
        False for a force with a frequency of its own, which has no part in a periodic steady state.
    strengths
        The parameters that the force grows with in proportion, all of them together.
    """

    strengths: ClassVar[tuple[str, ...]] = ()
    periodic: ClassVar[bool] = True
    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Where the law jumps or bends; a periodic steady state is integrated between them."""
        return ()

    @abstractmethod
    def force(self, motion: LawInput) -> FloatArray:
        """Return the force that has to be exerted, shape ``(samples,)``."""

    def scaled(self, factor: float) -> Self:
        """Return the law of a force that is larger by a factor.

        Raises
        ------
        ConfigurationError
            If the law does not say what its force grows with.
        """
        if not self.strengths:
            raise ConfigurationError(
                f"the law {type(self).__name__} cannot be scaled: name in its `strengths` the "
                f"parameters that its force grows with"
            )
        more = {name: factor * getattr(self, name) for name in self.strengths}
        return replace(self, **more)  # type: ignore[type-var]  # every law is a dataclass
