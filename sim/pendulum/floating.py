"""Free decay of a floating body: roll or heave."""

from dataclasses import dataclass, field

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim.pendulum.body import LINEAR
from sim.pendulum.coordinates import ROLL, Coordinate
from sim.pendulum.resistance import Resistance


@dataclass(frozen=True)
class Floating:
    """One free motion of a floating body in calm water.

    ``(I + A) q'' + B q' + ... + C q + ... = 0``, with constant added mass and damping.

    Attributes
    ----------
    inertia
        Mass in kg for heave; for roll moment of inertia in kg m2, of the body alone.
    added_inertia
        Of the water, in the same unit.
    restoring
        C: N/m for heave, N m/rad for roll (displacement weight times GM).
    """

    inertia: float
    added_inertia: float
    restoring: float
    resistance: Resistance = field(default_factory=Resistance)
    coordinate: Coordinate = ROLL

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED
    kind = LINEAR

    def __post_init__(self) -> None:
        if not (self.inertia + self.added_inertia > 0.0 and self.restoring > 0.0):
            raise ConfigurationError(
                f"a floating body with {self.inertia + self.added_inertia:g} of inertia and "
                f"{self.restoring:g} of restoring does not swing back; both must be above 0"
            )

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Roll or heave."""
        return (self.coordinate,)

    @property
    def resistances(self) -> tuple[Resistance, ...]:
        """That of the one coordinate."""
        return (self.resistance,)

    @property
    def mass(self) -> FloatArray:
        """I + A."""
        return np.array([[self.inertia + self.added_inertia]])

    @property
    def stiffness(self) -> FloatArray:
        """C."""
        return np.array([[self.restoring]])

    @property
    def parameters(self) -> FloatArray:
        """Nothing beyond the restoring terms of the resistance."""
        return np.zeros(10)

    @property
    def truth(self) -> dict[str, float]:
        """Inertia, the water's part, restoring, and the damping coefficients."""
        resistance = self.resistance
        return {
            "inertia": self.inertia,
            "added_inertia": self.added_inertia,
            "restoring": self.restoring,
            "viscous": resistance.viscous,
            "quadratic": resistance.quadratic,
            "cubic": resistance.cubic,
        }
