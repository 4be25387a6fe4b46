"""How the model hangs: the stiffness of the gauges, and of the frame that holds the struts."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED


class Elastic(NamedTuple):
    """Elastic deflections p, r coordinates: ``model at the struts = strut motion + shape p``.

    ``mass p'' + damping p' + stiffness p = - shape^T (force of the struts on the model)``.
    """

    shape: FloatArray  # (2, r)
    mass: FloatArray  # (r, r), as the others
    damping: FloatArray
    stiffness: FloatArray


@dataclass(frozen=True)
class StrutJoint:
    """The last joint of each strut, with a clearance that only forces take up.

    Attributes
    ----------
    half_play_m
        Clearance to either side of its middle.
    preload_n
        Force that presses it to one side, or to the other where it is negative: it opens where the
        strut's force is larger, and at rest lies at that side.
    unlike
        By which share the aft joint has more clearance than that, and the fore one less.
    """

    half_play_m: float
    preload_n: float = 0.0
    unlike: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        if not (self.half_play_m > 0.0 and math.isfinite(self.preload_n)):
            raise ConfigurationError(
                f"joint: half_play_m = {self.half_play_m:g} must be positive and "
                f"preload_n = {self.preload_n:g} a number; leave the joint out for none"
            )


@dataclass(frozen=True)
class Mounting:
    """Springs between the model and what moves it.

    The gauge of each strut, a set of flexures, is a spring and a damper along the strut's motion;
    so the model, with the water, is what resonates on both. The frame carries both struts: it
    yields to the sum of their forces, and has a mass of its own.

    Attributes
    ----------
    gauge_stiffness_n_m, gauge_damping_n_s_m
        Of each strut's gauge; a stiffness of ``None`` for rigid ones.
    gauge_unlike
        By which share the aft gauge gives way more than that, and the fore one less.
    frame_stiffness_n_m, frame_damping_n_s_m, frame_mass_kg
        Of the frame; a stiffness of ``None`` for a rigid one.
    joint
        A clearance in a row with each gauge; ``None`` for joints without play.

    Raises
    ------
    ConfigurationError
        If a stiffness or the frame's mass is not positive, or a joint has play on rigid gauges:
        what meets in it would never come to rest.
    """

    gauge_stiffness_n_m: float | None = None
    gauge_damping_n_s_m: float = 0.0
    frame_stiffness_n_m: float | None = None
    frame_damping_n_s_m: float = 0.0
    frame_mass_kg: float = 500.0
    joint: StrutJoint | None = None
    gauge_unlike: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        if not abs(self.gauge_unlike) < 1.0:
            raise ConfigurationError(
                f"gauge_unlike = {self.gauge_unlike:g} must be between -1 and 1: "
                "no gauge is rigid, nor pushes back"
            )
        for key in ("gauge_stiffness_n_m", "frame_stiffness_n_m", "frame_mass_kg"):
            value = getattr(self, key)
            if value is not None and not value > 0.0:
                raise ConfigurationError(
                    f"{key} = {value:g} must be positive; leave it out for a rigid part"
                )
        if self.joint is not None and self.gauge_stiffness_n_m is None:
            raise ConfigurationError(
                "joint: its clearance is in a row with the gauges, which are rigid; "
                "give gauge_stiffness_n_m"
            )

    @property
    def elastic(self) -> Elastic:
        """The coordinates of what gives way: two gauges, and the frame."""
        shapes: list[tuple[float, float]] = []
        properties: list[tuple[float, float, float]] = []
        if self.gauge_stiffness_n_m is not None:
            shapes += [(1.0, 0.0), (0.0, 1.0)]
            for more in (1.0 + self.gauge_unlike, 1.0 - self.gauge_unlike):
                stiffness = self.gauge_stiffness_n_m / more
                properties.append((0.0, self.gauge_damping_n_s_m, stiffness))
        if self.frame_stiffness_n_m is not None:
            shapes += [(1.0, 1.0)]
            properties += [(self.frame_mass_kg, self.frame_damping_n_s_m, self.frame_stiffness_n_m)]
        diagonal = [np.diag([triple[i] for triple in properties]) for i in range(3)]
        return Elastic(np.array(shapes).reshape(-1, 2).T, *diagonal)
