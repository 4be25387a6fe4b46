"""The photocell tested while somebody or something turns the shaft."""

from collections.abc import Callable
from dataclasses import dataclass

from hardware.description.errors import ConfigurationError
from hardware.errors import (
    HardwareError,
    PhotocellDeadError,
    PhotocellExtraError,
    PhotocellMissedError,
)
from hardware.rig import Rig
from hardware.roles import Pulse
from pmm.devices.pulses import Interval, judge_pulses

_PHOTOCELL_FAULTS = (PhotocellDeadError, PhotocellExtraError, PhotocellMissedError)


@dataclass(frozen=True)
class PhotocellRecord:
    """What a photocell said.

    Attributes
    ----------
    pulses, intervals
        The pulses, and what lies between them.
    driver_messages
        What its driver reported meanwhile.
    enough
        Whether as many pulses came as were asked for.
    """

    pulses: tuple[Pulse, ...]
    intervals: tuple[Interval, ...]
    driver_messages: tuple[str, ...]
    enough: bool

    @property
    def good(self) -> bool:
        """Whether all pulses came, and none too many."""
        return (
            self.enough
            and not self.driver_messages
            and not any(interval.verdict for interval in self.intervals)
        )


def watch(
    rig: Rig, count: int, within_s: float, on_pulse: Callable[[Pulse], None]
) -> PhotocellRecord:
    """Wait for so many pulses, and judge them.

    Parameters
    ----------
    on_pulse
        Called with each pulse as it comes.

    Raises
    ------
    ConfigurationError
        If the rig has no photocell.
    HardwareError
        If anything but the photocell reports a fault.
    """
    cell = rig.photocell
    if cell is None:
        raise ConfigurationError("the rig has no photocell; it needs a [photocell] table")
    pulses: list[Pulse] = []
    messages: list[str] = []
    cell.take()
    for _ in range(round(within_s * rig.configuration.sample_rate_hz)):
        try:
            rig.cycle()
        except HardwareError as error:
            if not isinstance(error, _PHOTOCELL_FAULTS):
                raise
            messages.append(str(error))
        for pulse in cell.take():
            pulses.append(pulse)
            on_pulse(pulse)
        if len(pulses) >= count:
            break
    return PhotocellRecord(
        tuple(pulses), judge_pulses(pulses), tuple(messages), len(pulses) >= count
    )
