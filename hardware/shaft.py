"""The drive shaft on a CiA 402 drive in profile velocity."""

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hardware.cia402 import Mode, StatusWord
from hardware.command_limits import check_enabled, check_speed
from hardware.description.channels import SHAFT_ANGLE, Channel
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Range
from hardware.dictionary import Entry
from hardware.drive import (
    CONTROL_WORD,
    MODE,
    PROBE_PDO,
    STATE_PDOS,
    STEP_CYCLES,
    TARGET_VELOCITY,
    Drive,
    motor_speed,
)
from hardware.drive_state_machine import Goal
from hardware.driver import Driver, NodePlan, Services, gap_cycles, join
from hardware.limits import RAMP_MARGIN, SHAFT_REST_SHARE, check_above_0, check_quick_stop
from hardware.motion import EncoderMotion
from hardware.roles import Cycle, Role, Sample, SampleBlock, blocks

_TURN = 2.0 * math.pi
_SPEED_SHARE = 0.02  # of the commanded frequency: within it the speed is reached


@dataclass(frozen=True)
class ShaftSettings:
    """Settings of the drive shaft.

    Attributes
    ----------
    node
        Node id of its drive.
    counts_per_turn
        Increments of 6064 in one turn of the shaft, gears included; negative if the drive counts
        against the shaft's positive sense.
    velocity_per_count
        Units of 606C and 60FF for one count per second.
    following_error_turns
        Window outside of which the drive faults.
    max_motor_speed_rpm
        The motor's own limit, before any gear (6080); not written where it is not given.
    touch_probe
        The photocell is wired to the drive's touch probe 1: maps its objects.
    """

    node: int
    counts_per_turn: float
    highest_frequency_hz: float
    acceleration_hz_per_s: float
    quick_stop_hz_per_s: float
    lowest_frequency_hz: float = 0.0
    velocity_per_count: float = 1.0
    following_error_turns: float = 0.1
    following_error_ms: int = 20
    touch_probe: bool = False
    max_motor_speed_rpm: float | None = None
    eds: str = "cia402-drive.eds"

    def __post_init__(self) -> None:
        check_above_0(self, "highest_frequency_hz", "acceleration_hz_per_s", "quick_stop_hz_per_s")
        check_quick_stop(
            self.highest_frequency_hz, self.quick_stop_hz_per_s, "Hz", "quick_stop_hz_per_s"
        )
        if self.counts_per_turn == 0.0:
            raise ConfigurationError("counts_per_turn = 0: the shaft would never move")


class DriveShaft:
    """A :class:`hardware.roles.Shaft`.

    Attributes
    ----------
    drive
        Its drive, for the touch probe and for diagnosis.
    """

    channels: tuple[Channel, ...] = (SHAFT_ANGLE,)

    def __init__(self, name: str, settings: ShaftSettings, services: Services) -> None:
        self.name = name
        self.settings = settings
        self.sample_rate_hz = services.sample_rate_hz
        self.frequency_hz = Range(settings.lowest_frequency_hz, settings.highest_frequency_hz)
        self.motion = EncoderMotion(
            settings.counts_per_turn,
            "Hz",
            SHAFT_REST_SHARE * settings.highest_frequency_hz,
            services.sample_rate_hz,
            gap_cycles(services),
        )
        self.drive = Drive(
            join(nodes(name, settings)[0], services), (Mode.PROFILE_VELOCITY,), self.motion
        )
        self._target_hz = 0.0
        self._track: deque[tuple[int, int]] = deque(maxlen=4)
        self._samples: list[Sample] = []

    @property
    def enabled(self) -> bool:
        """Whether it holds or turns under power."""
        return self.drive.enabled

    @property
    def counts(self) -> int:
        """Position in counts since the start, never wrapping."""
        return self.motion.counts or 0

    @property
    def measured_frequency_hz(self) -> float:
        """Turns per second by the encoder, positive in the shaft's sense; NaN if not known."""
        return self.motion.speed

    @property
    def moving(self) -> bool:
        """Whether the shaft turns by its encoder, or is commanded to."""
        return not self.motion.at_rest or self._target_hz != 0.0

    @property
    def at_speed(self) -> bool:
        """Whether drive and measured speed say that the commanded speed is reached."""
        off = abs(self.measured_frequency_hz - self._target_hz)
        near = off <= _SPEED_SHARE * self._target_hz
        return self.enabled and near and StatusWord.TARGET_REACHED in self.drive.status

    def enable(self) -> None:
        """Put the shaft under power at rest."""
        self._aim(0.0)
        self.drive.head_for(Goal.ENABLED)

    def disable(self) -> None:
        """Take the power off as soon as the shaft is at rest: by quick stop if it turns."""
        self._aim(0.0)
        self.drive.head_for(Goal.DISABLED)

    def turn(self, frequency_hz: float) -> None:
        """Run up or down to a speed.

        Raises
        ------
        LimitError
            If it lies outside the limits.
        NotReadyError
            If the shaft is not enabled.
        """
        check_speed(self, frequency_hz)
        check_enabled(self)
        self._aim(frequency_hz)
        self.drive.set_deadline(self._cycles(frequency_hz), f"run-up to {frequency_hz:g} Hz")

    def stop(self) -> None:
        """Decelerate along the profile, then stand under power."""
        self._aim(0.0)
        if self.enabled:
            self.drive.set_deadline(self._cycles(0.0), "profile stop")

    def quick_stop(self) -> None:
        """Decelerate on the quick-stop ramp."""
        self._aim(0.0)
        self.drive.head_for(Goal.QUICK_STOPPED)

    def reset_fault(self) -> None:
        """Reset the drive's fault; it stays disabled."""
        self._aim(0.0)
        self.drive.reset_fault()

    def prepare(self) -> None:
        """Write limits and ramps to the drive."""
        counts = abs(self.settings.counts_per_turn)
        per_hz = abs(self._velocity_per_hz)
        self.drive.prepare(
            (
                (Entry(0x607F), round(per_hz * self.settings.highest_frequency_hz)),
                (Entry(0x6083), round(per_hz * self.settings.acceleration_hz_per_s)),
                (Entry(0x6084), round(per_hz * self.settings.acceleration_hz_per_s)),
                (Entry(0x6085), round(per_hz * self.settings.quick_stop_hz_per_s)),
                (Entry(0x6065), round(counts * self.settings.following_error_turns)),
                (Entry(0x6066), self.settings.following_error_ms),
                *motor_speed(self.settings.max_motor_speed_rpm),
            )
        )

    @property
    def notes(self) -> tuple[str, ...]:
        """What its drive lacks, a sentence each."""
        return self.drive.notes

    def tick(self, cycle: Cycle) -> None:
        """Take the cycle's positions and keep the drive going."""
        for number, counts in self.drive.listen(cycle.number):
            self._track.append((number, counts))
            angle = _TURN * counts / self.settings.counts_per_turn
            self._samples.append((number, (angle,)))
        if self.at_speed or not self.moving:
            self.drive.cancel_deadline()
        self.drive.tick()

    def take(self) -> tuple[SampleBlock, ...]:
        """Return the shaft angles since the last call."""
        taken, self._samples = self._samples, []
        return blocks(taken)

    def carried(self) -> dict[str, Any]:
        """Return the count and the latest of its way; see :mod:`hardware.carry_over`."""
        return {"counts": self.motion.counts, "track": list(self._track)}

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Count on from there."""
        self.motion.counts = carried["counts"]
        self._track.extend((number, counts) for number, counts in carried["track"])

    def position_near(self, raw: int) -> int:
        """Return the count, never wrapping, of a 32-bit position near the present one."""
        return self.motion.near(raw)

    def last_two(self, number: int) -> tuple[tuple[int, int], tuple[int, int]]:
        """Return (number, count) at SYNC ``number`` and at the one known before it."""
        points = [point for point in self._track if point[0] <= number] or [(number, self.counts)]
        return (points[-2] if len(points) > 1 else points[-1]), points[-1]

    def close(self) -> None:
        """Nothing to let go of: the bus is the master's."""

    @property
    def _velocity_per_hz(self) -> float:
        return self.settings.counts_per_turn * self.settings.velocity_per_count

    def _cycles(self, target_hz: float) -> float:
        """Return how many cycles a ramp to a speed may take, seen by an encoder."""
        measured_hz = self.measured_frequency_hz
        from_hz = measured_hz if math.isfinite(measured_hz) else -self.settings.highest_frequency_hz
        ramp_s = abs(target_hz - from_hz) / self.settings.acceleration_hz_per_s
        return STEP_CYCLES + RAMP_MARGIN * ramp_s * self.sample_rate_hz

    def _aim(self, frequency_hz: float) -> None:
        if self._target_hz and not frequency_hz:
            self.motion.disturb()  # the encoder has not shown yet what the drive was told last
        self._target_hz = frequency_hz
        self.drive.cancel_deadline()
        self.drive.node.put(TARGET_VELOCITY, round(frequency_hz * self._velocity_per_hz))


def nodes(name: str, settings: ShaftSettings) -> tuple[NodePlan, ...]:
    """Return what the shaft's drive wants of the bus."""
    tpdos = (*STATE_PDOS, PROBE_PDO) if settings.touch_probe else STATE_PDOS
    rpdo = (CONTROL_WORD, MODE, TARGET_VELOCITY)
    return (NodePlan(name, settings.node, settings.eds, tpdos, (rpdo,)),)


DRIVER = Driver(Role.SHAFT, ShaftSettings, DriveShaft, nodes)
