"""The interface of a force law: its inputs, and where it jumps or bends.

:func:`sim.solve.compilation.compile_loop` takes the functions of an input as they stand here.
"""

import math
from abc import ABC, abstractmethod
from dataclasses import astuple, replace
from enum import IntEnum
from typing import Any, ClassVar, Final, NamedTuple, Protocol, Self, TypeAlias

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim.mechanism.geometry import Value

# Below this speed friction builds up with the speed: at rest it has no sign of its own. It widens
# the turn of a motion with peak speed V, which takes (CREEP / V)^2 / 6 from the first harmonic.
CREEP_M_S: Final = 1e-4


Parameters: TypeAlias = tuple[float, float, float, float]
"""The parameters of a law in the order of its class, NaN for one that is ``None`` or missing."""


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


class LawInput(NamedTuple):
    """Inputs of a force law: one value a sample each, or those of one instant in a compiled loop.

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

    position: Value
    velocity: Value
    acceleration: Value
    load: Value
    time_s: Value
    step_s: float
    speed_m_s: Value

    @property
    def direction(self) -> Value:
        """Sign of the velocity, averaged over the sample."""
        return direction(self)


def half_change(at: LawInput) -> Value:
    """Return half of what the velocity changes over the sample."""
    return np.sqrt((at.acceleration * (at.step_s / 2.0)) ** 2 + CREEP_M_S**2)


def direction(at: LawInput) -> Value:
    """Return the sign of the velocity, averaged over the sample."""
    return np.minimum(np.maximum(at.velocity / half_change(at), -1.0), 1.0)


def dynamic(reference_speed_m_s: float, at: LawInput) -> Value:
    """Return (U/U_0)^2, or 1 where the law does not depend on the speed."""
    return 1.0 if math.isnan(reference_speed_m_s) else (at.speed_m_s / reference_speed_m_s) ** 2


def error_function(x: Value) -> Value:
    """Return erf(x); in compiled loops it is :func:`math.erf`."""
    from scipy.special import erf

    return erf(x)


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
    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

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


class LawKernel(Protocol):
    """A law as a function of its parameters and of the motion, at one instant or an array."""

    def __call__(self, parameters: Parameters, at: LawInput, /) -> Value:
        """Return the force."""


class NumberedLaw(ForceLaw):
    """A law that the compiled loops have, by its number in :data:`sim.model.laws.LAWS`."""

    kernel: ClassVar[LawKernel]

    @property
    def parameters(self) -> Parameters:
        """Return the parameters in order, NaN for one that is ``None`` or missing."""
        values: tuple[Any, ...] = astuple(self)  # type: ignore[call-overload]  # all are dataclasses
        p, q, r, s, *_ = (math.nan if value is None else value for value in (*values, *[None] * 4))
        return p, q, r, s

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force that has to be exerted, shape ``(samples,)``."""
        force: FloatArray = self.kernel(self.parameters, motion)
        return force
