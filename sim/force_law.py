"""What a force law is, and what it may depend on."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import ClassVar, Final, Self

import numpy as np

from hardware.description.errors import ConfigurationError
from sim.signals import FloatArray
from sim.stage import UNKNOWN_KEYS_REFUSED

# Below this speed friction builds up with the speed: at rest it has no sign of its own. It widens
# the turn of a motion with peak speed V, which takes (CREEP / V)^2 / 6 from the first harmonic.
CREEP_M_S: Final = 1e-4


@dataclass(frozen=True, eq=False)
class Motion:
    """What a law may depend on: one value per sample each.

    Attributes
    ----------
    position, velocity, acceleration
        At the law's point: m, or rad at :attr:`sim.acting.Point.ROTATION`.
    load
        What the linear parts of the model ask of the struts at that point: N, or N m.
    time_s
        Time of each sample.
    step_s
        Time from sample to sample, over which a law that jumps is averaged.
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
    jumps
        True where the law uses :attr:`Motion.direction`, so that it is a mean over a sample.
    periodic
        False for a force with a frequency of its own, which has no part in a periodic steady state.
    strengths
        The parameters that the force grows with in proportion, all of them together.
    """

    strengths: ClassVar[tuple[str, ...]] = ()
    jumps: ClassVar[bool] = False
    periodic: ClassVar[bool] = True
    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED

    @abstractmethod
    def force(self, motion: Motion) -> FloatArray:
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
