"""What a run was told to do."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from hardware.description.lines import Line, peak_of
from hardware.description.oscillator import Oscillator

_WHOLE = 1.01  # of the eccentricity: a peak that is found on a finer grid is still it


ANGLE_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {"drift": "drift_rad", "heel": "heel_rad", "rudder": "rudder_angle_rad"}
)
"""Angles that stay during a run, by what sets them: the axis's table, and the set-point's key."""


class Medium(StrEnum):
    """What surrounds the model during a run."""

    WATER = "water"
    AIR = "air"


@dataclass(frozen=True)
class SetPoint:
    """The settings of one run.

    Attributes
    ----------
    frequency_hz
        Of the shaft; of a motion of many lines the base frequency.
    eccentricity_m
        Amplitude ``e`` of each strut's motion (half the stroke), the peak of all lines together.
    strut_phase_rad
        Phase ``phi`` of the fore strut ahead of the aft strut: 0 gives pure heave or sway, pi pure
        pitch or yaw about the midpoint.
    carriage_speed_m_s
        Forward speed ``U``; with ``steady_ahead`` that of the model along itself.
    drift_rad
        Steady heading of the model against the carriage's way, positive for the bow to starboard
        (trim: bow up), set as the oscillator's ``drift_by`` says.
    rudder_angle_rad
        Of the rudder against the model's midline, positive to turn to starboard.
    revolutions_hz
        Rate of the propeller, positive to drive ahead; 0 where it stands or there is none.
    heel_rad
        Heel at which the model is fixed, or rests where it is free to roll; positive to starboard.
    lines
        Of a motion of many frequencies, each with its own strut phase, and what makes a motion
        exact; empty for a single sine.
    turn_rate_rad_s
        Of the way of the midpoint between the struts, a circle of radius ``U / abs(r)`` that is
        driven at the carriage speed; positive to starboard, 0 for a straight way.
    release_rad
        Heel off its rest from which the model is let go to roll by itself; 0 where nobody does.
    wave_frequency_hz, wave_amplitude_m, wave_heading_rad
        Of the wave maker, 0 in calm water; amplitude is half the height, the heading that of the
        waves' way against the carriage's: 0 from astern, pi from ahead.
    steady_ahead
        Whether the carriage's speed follows the struts' path
        (:mod:`hardware.description.carriage_path`), so that the model's speed along itself is
        steady at any heading.
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
    lines: tuple[Line, ...] = ()
    turn_rate_rad_s: float = 0.0
    release_rad: float = 0.0
    wave_frequency_hz: float = 0.0
    wave_amplitude_m: float = 0.0
    wave_heading_rad: float = math.pi
    steady_ahead: bool = False

    @property
    def every_line(self) -> tuple[Line, ...]:
        """The lines of the motion: one of a single sine."""
        return self.lines or (Line(1, strut_phase_rad=self.strut_phase_rad),)

    @property
    def own_orders(self) -> tuple[int, ...]:
        """Harmonics that each are a frequency of their own; empty for a single one, the shaft's."""
        orders = tuple(line.order for line in self.lines if not line.correction)
        return () if orders == (1,) else orders

    @classmethod
    def read(cls, fields: Mapping[str, Any]) -> "SetPoint":
        """Return the set-point of a document's fields, as :func:`dataclasses.asdict` makes them."""
        medium = Medium(fields.get("medium", Medium.WATER))
        lines = tuple(Line(**line) for line in fields.get("lines", ()))
        return cls(**{**fields, "medium": medium, "lines": lines})


def check_within(oscillator: Oscillator, set_point: SetPoint) -> None:
    """Refuse a set-point that the oscillator cannot run.

    Raises
    ------
    ConfigurationError
        If the frequency or the eccentricity lies outside the oscillator's limits; the message gives
        each value and its limits.
    """
    faults = []
    orders = set_point.own_orders or (1,)
    for name, value, allowed in (
        *(
            (
                "frequency_hz" if n == 1 else f"line {n}",
                n * set_point.frequency_hz,
                oscillator.frequency_hz,
            )
            for n in (min(orders), max(orders))
        ),
        ("eccentricity_m", set_point.eccentricity_m, oscillator.eccentricity_m),
    ):
        if value not in allowed:
            faults.append(
                f"{name} = {value:g} is outside {allowed.low:g} to {allowed.high:g} "
                f"of the {oscillator.plane} oscillator"
            )
    faults += _line_faults(oscillator, set_point)
    if faults:
        raise ConfigurationError("; ".join(dict.fromkeys(faults)))


def _line_faults(oscillator: Oscillator, set_point: SetPoint) -> list[str]:
    if not set_point.lines:
        return []
    faults = []
    peak = peak_of(set_point.lines)
    if peak > _WHOLE:
        faults.append(
            f"the lines together reach {peak:.4g} times eccentricity_m, which is their peak; "
            "lower their shares"
        )
    faults += path_faults(oscillator)
    return faults


def path_faults(oscillator: Oscillator) -> list[str]:
    """Return why struts cannot follow lines, or an exact path; empty where they can."""
    if oscillator.rod_length_m is not None:
        return ["lines are followed by position-controlled struts, not by a crank with a rod"]
    if oscillator.paths is False:
        return ["lines are followed by struts with drives of their own: oscillator.paths is false"]
    return []
