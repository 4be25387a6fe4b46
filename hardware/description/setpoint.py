"""What a run was told to do."""

from dataclasses import dataclass
from enum import StrEnum

from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Oscillator


class Medium(StrEnum):
    """What surrounds the model during a run."""

    WATER = "water"
    AIR = "air"


@dataclass(frozen=True)
class SetPoint:
    """The settings of one run.

    Attributes
    ----------
    eccentricity_m
        Amplitude ``e`` of each strut's motion (half the stroke).
    strut_phase_rad
        Phase ``phi`` of the fore strut ahead of the aft strut: 0 gives pure heave or sway, pi pure
        pitch or yaw about the midpoint.
    carriage_speed_m_s
        Forward speed ``U``.
    drift_rad
        Steady heading of the model against the carriage's way, positive for the bow to starboard
        (trim: bow up), set as the oscillator's ``drift_by`` says.
    rudder_angle_rad
        Of the rudder against the model's midline, positive to turn to starboard.
    revolutions_hz
        Rate of the propeller, positive to drive ahead; 0 where it stands or there is none.
    heel_rad
        Heel at which the model is fixed, or rests where it is free to roll; positive to starboard.
    """

    frequency_hz: float
    eccentricity_m: float
    strut_phase_rad: float = 0.0
    carriage_speed_m_s: float = 0.0
    medium: Medium = Medium.WATER
    drift_rad: float = 0.0
    rudder_angle_rad: float = 0.0
    revolutions_hz: float = 0.0
    heel_rad: float = 0.0


def check_within(oscillator: Oscillator, set_point: SetPoint) -> None:
    """Refuse a set-point that the oscillator cannot run.

    Raises
    ------
    ConfigurationError
        If the frequency or the eccentricity lies outside the oscillator's limits; the message gives
        each value and its limits.
    """
    faults = []
    for name, value, allowed in (
        ("frequency_hz", set_point.frequency_hz, oscillator.frequency_hz),
        ("eccentricity_m", set_point.eccentricity_m, oscillator.eccentricity_m),
    ):
        if value not in allowed:
            faults.append(
                f"{name} = {value:g} is outside {allowed.low:g} to {allowed.high:g} "
                f"of the {oscillator.plane} oscillator"
            )
    if faults:
        raise ConfigurationError("; ".join(faults))
