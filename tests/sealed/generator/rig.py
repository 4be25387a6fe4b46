"""What a rig, a run and a record are in the sealed reality: plain values."""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tests.sealed.generator.parameters import FloatArray

Kind = Literal["oscillation", "rest", "check-weight", "injection"]
Medium = Literal["water", "air"]

CHANNELS = (
    "shaft_angle",
    "displacement_aft",
    "displacement_fore",
    "force_aft",
    "force_fore",
    "carriage_speed",
)
UNITS = ("rad", "m", "m", "N", "N", "m/s")

# Jitter of the encoder's own light, in steps; without it an even speed makes lines of the steps.
DITHER = 0.5


@dataclass(frozen=True)
class Noise:
    """Noise of the sensors: root mean squares, SI units.

    ``coloured_n`` is exponentially correlated over ``colour_s``, as the zero's ``wander_n`` is over
    ``wander_s``; the converter's step of the force channels is ``step_n``, that of the encoder
    ``step_rad``, that of the strut sensors ``step_m`` (0: none).
    """

    white_n: float
    coloured_n: float
    colour_s: float
    step_n: float
    displacement_m: float
    step_rad: float = 9.587379924285257e-5
    carriage_m_s: float = 1e-3
    wander_n: float = 0.0
    wander_s: float = 100.0
    step_m: float = 0.0


@dataclass(frozen=True)
class Rig:
    """What does not change from run to run.

    Attributes
    ----------
    arrangement
        Joint, pivot and gauges of a rig that goes to large angles; ``None`` for small ones, in the
        arrangement that a campaign file has by itself.
    still_reads_zero
        Whether the carriage's channel is exactly 0 where it stands.
    noise_stated
        Whether the campaign's file tells the noise of the forces.
    """

    plane: Literal["vertical", "horizontal"]
    half_spacing_m: float
    rod_length_m: float | None
    sample_rate_hz: float
    sensors: tuple[str, ...]
    noise: Noise
    full_scale_n: float = 500.0
    arrangement: tuple[str, str, str] | None = None
    drift_by: str = "rig_turned"
    still_reads_zero: bool = False
    noise_stated: bool = True


@dataclass(frozen=True)
class Run:
    """One run as it is set; ``hour`` and ``waited_s`` place it in the campaign."""

    name: str
    frequency_hz: float = 0.0
    eccentricity_m: float = 0.0
    strut_phase_rad: float = 0.0
    carriage_speed_m_s: float = 0.0
    medium: Medium = "water"
    periods: int = 8
    hour: float = 0.0
    waited_s: float = 300.0
    kind: Kind = "oscillation"
    preload_n: float = 0.0
    weight_n: float = 0.0
    strut: Literal["aft", "fore"] = "aft"
    force_n: float = 0.0
    drift_rad: float = 0.0
    drift_by: str = "rig_turned"
    loud: float = 1.0  # this run's noise of the forces, in that of the rig

    @property
    def turns(self) -> bool:
        """Whether the shaft turns."""
        return self.kind == "oscillation"

    @property
    def duration_s(self) -> float:
        """Length of the record: the periods and one more, or 20 s."""
        return (self.periods + 1) / self.frequency_hz if self.turns else 20.0


@dataclass(frozen=True)
class Record:
    """What was recorded, with all channels, or what would have been without noise."""

    sample_rate_hz: float
    channels: FloatArray  # (6, samples) in the order of CHANNELS
    edges_s: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))

    @property
    def times_s(self) -> FloatArray:
        """Times of the samples."""
        return np.arange(self.channels.shape[1]) / self.sample_rate_hz
