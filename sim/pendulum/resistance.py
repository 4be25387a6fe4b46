"""What a body meets as it swings: resistance to its motion, and the air around it."""

from dataclasses import dataclass, fields

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class Air:
    """What the air does beside damping.

    Attributes
    ----------
    buoyancy_ratio
        Density of the air over the body's: g' = g (1 - ratio).
    added_mass_ratio
        Mass of air that moves along, over the body's mass.
    added_inertia_ratio
        The same for rotation, over the body's moments of inertia.
    """

    buoyancy_ratio: float = 0.0
    added_mass_ratio: float = 0.0
    added_inertia_ratio: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class Resistance:
    """Loads on one coordinate: N for a displacement, N m for an angle; v is its rate.

    Attributes
    ----------
    viscous
        ``viscous * v``.
    quadratic
        ``quadratic * |v| v``.
    cubic
        ``cubic * v^3``.
    power, exponent
        ``power * |v|^exponent sgn(v)``; an exponent of 1.3 makes the time constant grow as
        amplitude^-0.3.
    coulomb
        Dry friction: opposes sliding with this, holds at rest up to it.
    restoring_abs, restoring_cubic, restoring_quintic
        ``restoring_abs * |q| q + restoring_cubic * q^3 + restoring_quintic * q^5``; negative ones
        soften.
    """

    viscous: float = 0.0
    quadratic: float = 0.0
    cubic: float = 0.0
    power: float = 0.0
    exponent: float = 1.3
    coulomb: float = 0.0
    restoring_abs: float = 0.0
    restoring_cubic: float = 0.0
    restoring_quintic: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        for name in ("viscous", "quadratic", "cubic", "power", "exponent", "coulomb"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0.0):
                raise ConfigurationError(
                    f"{name} = {value:g} of a resistance must be finite and not negative"
                )

    @property
    def linear(self) -> bool:
        """Whether it is viscous and dry friction only, which the step carries exactly."""
        beyond = (self.quadratic, self.cubic, self.power)
        return not any((*beyond, self.restoring_abs, self.restoring_cubic, self.restoring_quintic))

    @property
    def row(self) -> FloatArray:
        """The attributes in their order."""
        return np.array([float(getattr(self, field.name)) for field in fields(self)])
