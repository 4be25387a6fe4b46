"""Geometry of a run's rig, from which kinematics and gauge readings are computed."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint, Pivot
from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import SetPoint

Waves = NDArray[Any]
"""Over instants, the last axis; complex only for :func:`analysis.kinematics.complex_step.slope`."""


@dataclass(frozen=True, eq=False)
class Geometry:
    """The rig of one run, or of many: each number may be an array that fits the waves' axes.

    Attributes
    ----------
    half_spacing_m
        The distance ``l``.
    speed_m_s
        Of the carriage; where its speed follows a path, of the model along itself.
    drift_rad
        Mean heading of the model, bow to starboard (bow up), set as ``arrangement.drift_by`` says.
    gauges_heel
        Whether the struts' gauges heel with the model.
    varies_m_s
        What the carriage's speed is besides at each instant.
    """

    plane: Plane
    half_spacing_m: Waves | float
    arrangement: Arrangement = field(default_factory=Arrangement)
    speed_m_s: Waves | float = 0.0
    drift_rad: Waves | float = 0.0
    gauges_heel: bool = False
    varies_m_s: Waves | float = 0.0

    @classmethod
    def of(cls, oscillator: Oscillator, set_point: SetPoint) -> "Geometry":
        """Return the geometry of an oscillator at a set-point's speed and drift angle."""
        return cls(
            oscillator.plane,
            oscillator.half_spacing_m,
            oscillator.arrangement,
            set_point.carriage_speed_m_s,
            set_point.drift_rad,
        )

    @property
    def side(self) -> float:
        """+1 where the rotation turns ahead into across (yaw), -1 for pitch, bow up."""
        return -1.0 if self.plane is Plane.VERTICAL else 1.0

    @property
    def has_table(self) -> bool:
        """Whether a turntable holds the model, not two struts."""
        return self.arrangement.joint is Joint.YAW_TABLE

    @property
    def pivot_sign(self) -> float:
        """+1 where the reference point is ahead of the pivot, -1 where it is behind it."""
        return 1.0 if self.arrangement.pivot is Pivot.AFT else -1.0

    @property
    def gauges_turn(self) -> bool:
        """Whether the dynamometers turn with the model."""
        return self.arrangement.gauges is Gauges.MODEL

    def turned(self, by: DriftBy) -> Waves | float:
        """Return the drift that is set in one way, ahead towards across; 0 if in another."""
        return self.side * self.drift_rad if self.arrangement.drift_by is by else 0.0

    @property
    def offset_m(self) -> Waves | float:
        """Offset of the fore strut's mean position from the rig's middle; the aft's is opposite."""
        angle = self.turned(DriftBy.STRUTS_OFFSET)
        on_model = self.arrangement.joint is Joint.SLIDES_ON_MODEL
        lever: Waves | float = np.tan(angle) if on_model else np.sin(angle)
        return self.half_spacing_m * lever
