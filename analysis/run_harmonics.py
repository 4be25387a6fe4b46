"""First harmonics of one run's struts and gauges, as the checks across a campaign take them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.setpoint import SetPoint

CHECKED: Final = (*DISPLACEMENTS, *FORCES)


@dataclass(frozen=True)
class RunHarmonics:
    """First harmonics of one run, with its set-point.

    Attributes
    ----------
    frequency_hz
        Mean frequency over the first gate.
    first
        First harmonic ``S_1 + i C_1`` of each of :data:`CHECKED` that is there, in SI.
    """

    run: str
    set_point: SetPoint
    frequency_hz: float
    first: Mapping[str, complex]
