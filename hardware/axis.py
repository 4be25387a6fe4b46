"""Eccentricity and strut phase on a CiA 402 drive: profile position and homing."""

from enum import Enum
from typing import ClassVar

from hardware.axis_settings import PositionAxisSettings
from hardware.cia402 import ControlWord, Mode, StatusWord
from hardware.command_limits import check_enabled, check_move
from hardware.description.oscillator import Range
from hardware.dictionary import Entry
from hardware.drive import (
    CONTROL_WORD,
    MODE,
    POSITION,
    STATE_PDOS,
    STEP_CYCLES,
    TARGET_POSITION,
    Drive,
    motor_speed,
)
from hardware.drive_state_machine import Goal
from hardware.driver import Driver, NodePlan, Services, gap_cycles, join
from hardware.errors import HomingError
from hardware.limits import AXIS_REST_SHARE, RAMP_MARGIN
from hardware.motion import EncoderMotion
from hardware.roles import Cycle, Reading, Role
from hardware.sdo import Number

_STALE_CYCLES = 10  # a homing that was over before is believed after so many


class _Step(Enum):
    """Where a move or homing stands."""

    IDLE = "idle"
    MODE = "waiting for the mode of operation"
    CLEAR = "waiting for the set-point acknowledge to fall"
    START = "waiting for the drive to take the command"
    UNDER_WAY = "on its way"


class DriveAxis:
    """A :class:`hardware.roles.PositionAxis`.

    Attributes
    ----------
    modes
        Modes of operation that the drive has to support.
    positions
        What came in the present cycle: number of the SYNC, counts.
    """

    modes: ClassVar[tuple[Mode, ...]] = (Mode.PROFILE_POSITION, Mode.HOMING)

    def __init__(self, name: str, settings: PositionAxisSettings, services: Services) -> None:
        self.name = name
        self.unit: str = settings.unit
        self.limits = Range(settings.low, settings.high)
        self.homed = False
        self.settled = False
        self.drive = Drive(
            join(nodes(name, settings)[0], services),
            self.modes,
            EncoderMotion(
                settings.counts_per_unit,
                f"{settings.unit}/s",
                AXIS_REST_SHARE * settings.speed,
                services.sample_rate_hz,
                gap_cycles(services),
            ),
        )
        self._settings = settings
        self._rate_hz = services.sample_rate_hz
        self._step = _Step.IDLE
        self._stale_cycles = 0
        self._target = 0
        self.positions: list[tuple[int, int]] = []

    @property
    def enabled(self) -> bool:
        """Whether it holds or moves under power."""
        return self.drive.enabled

    @property
    def moving(self) -> bool:
        """Whether the axis moves by its encoder, or a move or homing is under way."""
        return self._pursuing or not self.drive.motion.at_rest

    @property
    def homing(self) -> bool:
        """Whether it is looking for its reference position."""
        return self._pursuing and self.drive.mode is Mode.HOMING

    @property
    def _pursuing(self) -> bool:
        return self._step is not _Step.IDLE

    @property
    def position(self) -> float:
        """The drive's position in the axis's unit."""
        return self.drive.node.values[POSITION] / self._settings.counts_per_unit

    @property
    def reading(self) -> Reading | None:
        """Where the axis is; ``None`` before homing."""
        if not self.homed:
            return None
        return Reading(self.position, self._settings.standard_uncertainty, "encoder")

    def enable(self) -> None:
        """Put the axis under power at rest."""
        self._abandon()
        self.drive.head_for(Goal.ENABLED)

    def disable(self) -> None:
        """Take the power off as soon as the axis is at rest: by quick stop if it moves."""
        self._break_off()
        self.drive.head_for(Goal.DISABLED)

    def home(self) -> None:
        """Find the reference position.

        Raises
        ------
        NotReadyError
            If the axis is not enabled.
        """
        self._begin(Mode.HOMING, self._settings.homing_timeout_s, "homing")
        self.homed = False

    def move_to(self, position: float) -> None:
        """Go to a position.

        Raises
        ------
        LimitError
            If it lies outside the limits (or is no number).
        NotReadyError
            If the axis is not enabled or not homed.
        """
        check_move(self, position)
        speed, way = self._settings.speed, abs(position - self.position)
        time_s = way / speed + 2.0 * speed / self._settings.acceleration
        self._begin(Mode.PROFILE_POSITION, time_s, f"move to {position:g} {self.unit}")
        self._target = round(position * self._settings.counts_per_unit)
        self.drive.node.put(TARGET_POSITION, self._target)

    def stop(self) -> None:
        """Decelerate along the profile, then stand under power."""
        if self.moving:
            self._break_off()
            self.drive.extra = ControlWord.HALT

    def quick_stop(self) -> None:
        """Decelerate on the quick-stop ramp."""
        self._break_off()
        self.drive.head_for(Goal.QUICK_STOPPED)

    def reset_fault(self) -> None:
        """Reset the drive's fault; it stays disabled."""
        self._abandon()
        self.drive.reset_fault()

    def prepare(self) -> None:
        """Write limits, ramps and the homing's settings to the drive."""
        self.drive.prepare(self.objects())

    def objects(self) -> tuple[tuple[Entry, Number], ...]:
        """Return what is written to the drive."""
        settings, per_count = self._settings, abs(self._settings.counts_per_unit)
        per_unit = per_count * settings.velocity_per_count
        ends = sorted(
            round(end * settings.counts_per_unit) for end in (settings.low, settings.high)
        )
        return (
            (Entry(0x607D, 1), ends[0]),
            (Entry(0x607D, 2), ends[1]),
            (Entry(0x607F), round(per_unit * max(settings.speed, settings.homing_speed))),
            *motor_speed(settings.max_motor_speed_rpm),
            (Entry(0x6081), round(per_unit * settings.speed)),
            (Entry(0x6083), round(per_unit * settings.acceleration)),
            (Entry(0x6084), round(per_unit * settings.acceleration)),
            (Entry(0x6085), round(per_unit * settings.quick_stop)),
            (Entry(0x6065), round(per_count * settings.following_error)),
            (Entry(0x6066), settings.following_error_ms),
            (Entry(0x6067), round(per_count * settings.tolerance)),
            (Entry(0x607C), round(settings.counts_per_unit * settings.home_position)),
            (Entry(0x6098), settings.homing_method),
            (Entry(0x6099, 1), round(per_unit * settings.homing_speed)),
            (Entry(0x6099, 2), round(per_unit * settings.homing_speed)),
            (Entry(0x609A), round(per_unit * settings.acceleration)),
        )

    @property
    def notes(self) -> tuple[str, ...]:
        """What its drive lacks, a sentence each."""
        return self.drive.notes

    def tick(self, cycle: Cycle) -> None:
        """Pursue the move or the homing, one step a cycle.

        Raises
        ------
        HomingError
            If the drive reports one; other faults as in :meth:`hardware.drive.Drive.tick`.
        """
        self.positions = self.drive.listen(cycle.number)
        if self._pursuing and not self.enabled:
            self._abandon()
        try:
            if self._pursuing:
                self._pursue(self.drive.status)
        finally:
            self.drive.tick()

    def close(self) -> None:
        """Nothing to let go of: the bus is the master's."""

    def _begin(self, mode: Mode, time_s: float, event: str) -> None:
        check_enabled(self)
        self.settled = False
        self._stale_cycles = 0
        self.drive.mode, self.drive.extra = mode, ControlWord(0)
        self.drive.set_deadline(4 * STEP_CYCLES + RAMP_MARGIN * time_s * self._rate_hz, event)
        self._step = _Step.MODE

    def _break_off(self) -> None:
        """End what is under way; the encoder has not shown yet what the drive was told last."""
        if self._pursuing:
            self.drive.motion.disturb()
        self._abandon()

    def _abandon(self) -> None:
        self._step, self.drive.extra = _Step.IDLE, ControlWord(0)
        self.drive.cancel_deadline()

    def _pursue(self, status: StatusWord) -> None:
        if self._step is _Step.MODE and self.drive.in_mode:
            self._step = _Step.CLEAR
        homing = self.drive.mode is Mode.HOMING
        if self._step is _Step.CLEAR:
            if homing or StatusWord.SET_POINT_ACKNOWLEDGED not in status:
                self._step = _Step.START
                self.drive.extra = ControlWord.NEW_SET_POINT | (
                    ControlWord(0) if homing else ControlWord.CHANGE_AT_ONCE
                )
        elif homing:
            self._home(status)
        else:
            self._move(status)

    def _home(self, status: StatusWord) -> None:
        """Wait until the drive has begun (attained falls), then until it has finished."""
        if StatusWord.HOMING_ERROR in status:
            self._abandon()
            raise HomingError(self.name, f"homing failed (status word 0x{int(status):04X})")
        attained = StatusWord.HOMING_ATTAINED in status and StatusWord.TARGET_REACHED in status
        if self._step is _Step.START:
            # Bits of an earlier homing stand until the drive has taken the command.
            self._stale_cycles += 1
            if not attained or self._stale_cycles > _STALE_CYCLES:
                self._step = _Step.UNDER_WAY
        elif self._step is _Step.UNDER_WAY and attained and self.drive.motion.at_rest:
            self.homed = self.settled = True
            self._abandon()

    def _move(self, status: StatusWord) -> None:
        if self._step is _Step.START and StatusWord.SET_POINT_ACKNOWLEDGED in status:
            self._step, self.drive.extra = _Step.UNDER_WAY, ControlWord(0)
        elif self._step is _Step.UNDER_WAY and StatusWord.SET_POINT_ACKNOWLEDGED not in status:
            off = abs(int(self.drive.node.values[POSITION]) - self._target)
            near = off <= self._settings.tolerance * abs(self._settings.counts_per_unit)
            if near and StatusWord.TARGET_REACHED in status and self.drive.motion.at_rest:
                self.settled = True
                self._abandon()


def nodes(name: str, settings: PositionAxisSettings) -> tuple[NodePlan, ...]:
    """Return what the axis's drive wants of the bus."""
    rpdo = (CONTROL_WORD, MODE, TARGET_POSITION)
    return (NodePlan(name, settings.node, settings.eds, STATE_PDOS, (rpdo,)),)


DRIVER = Driver(Role.POSITION_AXIS, PositionAxisSettings, DriveAxis, nodes)
