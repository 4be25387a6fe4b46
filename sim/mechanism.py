"""The mechanism: from the shaft's rotation to the motion of the two struts."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hardware.description.errors import ConfigurationError
from sim import signals
from sim.signals import FloatArray, Signal, Signals
from sim.stage import Block

_WRITES = {
    "aft": (signals.DISPLACEMENT_AFT, signals.VELOCITY_AFT, signals.ACCELERATION_AFT),
    "fore": (signals.DISPLACEMENT_FORE, signals.VELOCITY_FORE, signals.ACCELERATION_FORE),
}


@dataclass(frozen=True)
class Mechanism:
    """A scotch yoke, or a crank with a connecting rod, on each strut.

    The aft strut follows the shaft angle, the fore strut is ``strut_phase_rad`` ahead of it. A
    strut's displacement at its crank angle th is

        d = e sin(th)                                         scotch yoke
        d = e sin(th) + sqrt(L^2 - e^2 cos^2(th)) - L         crank with a rod of length L

    Velocity and acceleration follow by the chain rule from the shaft's speed and acceleration; no
    samples are differenced.

    Attributes
    ----------
    rod_length_m
        ``L``; ``None`` for a scotch yoke.

    Raises
    ------
    ConfigurationError
        If the rod is not longer than the eccentricity: the crank could not turn.
    """

    eccentricity_m: float
    strut_phase_rad: float = 0.0
    rod_length_m: float | None = None

    name: ClassVar[str] = "mechanism"
    reads: ClassVar[tuple[Signal, ...]] = (
        signals.SHAFT_ANGLE,
        signals.SHAFT_SPEED,
        signals.SHAFT_ACCELERATION,
    )
    writes: ClassVar[tuple[Signal, ...]] = _WRITES["aft"] + _WRITES["fore"]

    def __post_init__(self) -> None:
        if self.rod_length_m is not None and self.rod_length_m <= self.eccentricity_m:
            raise ConfigurationError(
                f"rod_length_m = {self.rod_length_m:g} must exceed "
                f"eccentricity_m = {self.eccentricity_m:g}: the crank could not turn"
            )

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: the struts follow the shaft at once."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:  # noqa: ARG002
        """Return displacement, velocity and acceleration of both struts over the block."""
        angle = inputs[signals.SHAFT_ANGLE.name]
        speed = inputs[signals.SHAFT_SPEED.name]
        acceleration = inputs[signals.SHAFT_ACCELERATION.name]
        written: dict[str, FloatArray] = {}
        for strut, phase_rad in (("aft", 0.0), ("fore", self.strut_phase_rad)):
            d, slope, curvature = self.displacement(angle + phase_rad)
            values = (d, slope * speed, curvature * speed**2 + slope * acceleration)
            written |= {one.name: v for one, v in zip(_WRITES[strut], values, strict=True)}
        return state, written

    def displacement(self, angle: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return a strut's displacement and its first two derivatives by the crank angle.

        Parameters
        ----------
        angle
            Crank angle of this strut in radians, any shape.

        Returns
        -------
        displacement, slope, curvature
            In m, m/rad and m/rad^2.
        """
        e = self.eccentricity_m
        sine, cosine = np.sin(angle), np.cos(angle)
        yoke = (e * sine, e * cosine, -e * sine)
        if self.rod_length_m is None:
            return yoke
        rod = np.sqrt(self.rod_length_m**2 - (e * cosine) ** 2)
        rod_slope = e**2 * sine * cosine / rod
        rod_curvature = (e**2 * (cosine**2 - sine**2) - rod_slope**2) / rod
        return (
            yoke[0] + (rod - self.rod_length_m),
            yoke[1] + rod_slope,
            yoke[2] + rod_curvature,
        )
