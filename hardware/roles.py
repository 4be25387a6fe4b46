"""What the parts of a rig can do: a protocol per role. A driver is a class that answers one.

Commands never wait: they set a goal, and :meth:`Device.tick`, called once per cycle, pursues it.
What goes wrong is raised as a :class:`hardware.errors.HardwareError` by the command (refusals) or
by ``tick`` (faults, each once).
"""

from collections.abc import Sequence
from enum import StrEnum
from typing import Protocol, runtime_checkable

from hardware.description.channels import Channel
from hardware.description.lines import Line
from hardware.description.oscillator import Range
from hardware.samples import Cycle as Cycle
from hardware.samples import Pulse as Pulse
from hardware.samples import Reading as Reading
from hardware.samples import Sample as Sample
from hardware.samples import SampleBlock as SampleBlock
from hardware.samples import blocks as blocks


class Role(StrEnum):
    """The places of a rig that a driver can fill; the names are those of ``rig.toml``."""

    SHAFT = "shaft"
    POSITION_AXIS = "position_axis"
    FORCES = "forces"
    PHOTOCELL = "photocell"
    INCLINOMETER = "inclinometer"
    CARRIAGE = "carriage"


@runtime_checkable
class Device(Protocol):
    """What a rig is made of: it is prepared, then ticked once a cycle, and closed."""

    name: str

    def prepare(self) -> None:
        """Write the device's settings to it; may wait for answers. Called once, before cycles."""
        ...

    def tick(self, cycle: Cycle) -> None:
        """Take what came in this cycle and pursue the goal, without waiting."""
        ...

    def reset_fault(self) -> None:
        """Clear a fault, on the operator's demand only; the device stays at rest, disabled."""
        ...

    def close(self) -> None:
        """Let go of whatever is held; may be called twice."""
        ...


@runtime_checkable
class Sampled(Device, Protocol):
    """A device that delivers samples of its channels at a fixed rate."""

    channels: tuple[Channel, ...]
    sample_rate_hz: float

    def take(self) -> tuple[SampleBlock, ...]:
        """Return the samples since the last call, oldest first."""
        ...


@runtime_checkable
class Reconnecting(Device, Protocol):
    """A device behind a port that may be lost and come back."""

    @property
    def is_answering(self) -> bool:
        """Whether the device at the port answers."""
        ...

    def reconnect(self) -> None:
        """Open its port again if it is lost, and begin to ask anew."""
        ...


@runtime_checkable
class Powered(Device, Protocol):
    """A device with a motor: it holds or moves under power."""

    @property
    def enabled(self) -> bool:
        """Whether it holds or moves under power."""
        ...

    @property
    def moving(self) -> bool:
        """Whether it moves by what measures it, or has been told to; not known is moving."""
        ...

    def enable(self) -> None:
        """Put it under power, at rest."""
        ...

    def disable(self) -> None:
        """Bring it to rest, then take the power off; what does not brake in time loses it so."""
        ...

    def stop(self) -> None:
        """Decelerate along the profile, then stand under power."""
        ...

    def quick_stop(self) -> None:
        """Decelerate as fast as is safe; enabling again takes :meth:`enable`."""
        ...


@runtime_checkable
class Shaft(Powered, Sampled, Protocol):
    """The drive shaft. Its channel, if it has an encoder, is the shaft angle in radians."""

    frequency_hz: Range

    @property
    def at_speed(self) -> bool:
        """Whether the commanded speed has been reached."""
        ...

    @property
    def measured_frequency_hz(self) -> float:
        """Turns per second now; NaN if nothing measures them."""
        ...

    def turn(self, frequency_hz: float) -> None:
        """Run up or down to a speed; 0 is refused: that is :meth:`stop`."""
        ...


@runtime_checkable
class PathFollower(Protocol):
    """A shaft that is a program: its struts follow a path that it can be told."""

    def follow(self, lines: Sequence[Line]) -> None:
        """Let the struts follow these lines from now on; a single sine without any."""
        ...

    def angle_at(self, number: int) -> float:
        """Return the master angle at a SYNC, of one to come that of the latest that is known."""
        ...


@runtime_checkable
class SpeedFollower(Protocol):
    """A carriage whose speed the program leads while it runs."""

    def lead(self, speed_m_s: float) -> None:
        """Go on at another speed, told anew in every cycle."""
        ...


@runtime_checkable
class PositionAxis(Powered, Protocol):
    """The eccentricity (``"m"``) or the strut phase (``"rad"``)."""

    unit: str
    limits: Range

    @property
    def homed(self) -> bool:
        """Whether positions are absolute; moving before is refused."""
        ...

    @property
    def settled(self) -> bool:
        """Whether the last move has arrived within the axis's tolerance."""
        ...

    @property
    def reading(self) -> Reading | None:
        """Where the axis is; ``None`` before it is known."""
        ...

    def home(self) -> None:
        """Find the reference position."""
        ...

    def move_to(self, position: float) -> None:
        """Go to a position in the axis's unit."""
        ...


@runtime_checkable
class Carriage(Powered, Sampled, Protocol):
    """The carriage along the tank, or one that drives circles.

    Its channels are the speed that it measures, and the rate of turn where it drives circles.

    Attributes
    ----------
    tolerance_m_s
        So near the speed asked for it is said to be at speed.
    """

    speed_m_s: Range
    tolerance_m_s: float

    @property
    def at_speed(self) -> bool:
        """Whether the commanded speed has been kept for as long as it takes to settle."""
        ...

    @property
    def measured_speed_m_s(self) -> float:
        """Speed now; NaN if it is not known."""
        ...

    @property
    def measured_turn_rate_rad_s(self) -> float:
        """Rate of turn now, positive to starboard; NaN if it is not known, 0 if it cannot turn."""
        ...

    @property
    def returns(self) -> bool:
        """Whether it can go back to the start of its track by itself."""
        ...

    def run_at(self, speed_m_s: float, turn_rate_rad_s: float = 0.0) -> None:
        """Run up to a speed along the track; 0 is refused: that is :meth:`stop`.

        With a rate of turn it drives a circle of that speed over it.
        """
        ...

    def go_back(self) -> None:
        """Go back to the start of the track and stand there; nothing where it stands there."""
        ...


@runtime_checkable
class ForceChannels(Sampled, Protocol):
    """Amplifiers of the dynamometers: any number of channels, in newtons or whatever they say."""

    def tare(self) -> None:
        """Take the present values for zero: from the next sample on."""
        ...


@runtime_checkable
class Photocell(Device, Protocol):
    """The photocell at the shaft: one pulse a turn, with its time."""

    def expect(self, frequency_hz: float | None) -> None:
        """Say how fast the shaft turns, so that missing pulses are noticed; ``None``: at rest."""
        ...

    def take(self) -> tuple[Pulse, ...]:
        """Return the pulses since the last call, oldest first."""
        ...


@runtime_checkable
class Inclinometer(Sampled, Protocol):
    """The inclinometer of the swing: one channel in radians, sampled by the device's own clock."""


PROTOCOLS: dict[Role, type] = {
    Role.SHAFT: Shaft,
    Role.POSITION_AXIS: PositionAxis,
    Role.FORCES: ForceChannels,
    Role.PHOTOCELL: Photocell,
    Role.INCLINOMETER: Inclinometer,
    Role.CARRIAGE: Carriage,
}
