"""The air around a body that swings in it."""

from dataclasses import dataclass

from sim.stage import UNKNOWN_KEYS_REFUSED


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
